//! Cameras, and the volume in their view.

use std::f64::consts::PI;
use std::sync::Arc;

use super::budget::MAX_CHANNELS;
use media::catalogue::{Domain, Settings};
use media::reader::{read_volume, read_volumes};
use media::{Body, Volume};
use numeric::Lane;
use numeric::geometry::{Aabb, Point, Ray};
use theory::problems::Sky;

/// Maximum number of pixels along a side; more are a mistake.
const MAX_SIDE: u64 = 4096;

/// Pinhole camera: one ray through the middle of each pixel.
///
/// Its axes are right-handed: `right = forward × up`. Row 0 is the top row, column 0 the left one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    position: Point,
    forward: Point,
    /// Half the picture's width and height at distance 1, along the axes to the right and upwards.
    right: Point,
    up: Point,
    size: [usize; 2],
}

impl Camera {
    /// Places a camera at a position, aimed at a target, with the angle between the directions of the picture's lower
    /// and upper edge in degrees. `None` if `up` points along the view, or position and target are equal.
    pub fn new(
        position: Point,
        target: Point,
        up: Point,
        degrees: f64,
        size: [usize; 2],
    ) -> Option<Self> {
        let forward = (target - position).normalised()?;
        let right = forward.cross(up.normalised()?);
        if right.norm() < 1e-9 {
            return None;
        }
        let right = right.normalised()?;
        let half = 0.5 * degrees * PI / 180.0;
        let half = Lane::sin(half) / Lane::cos(half);
        let [width, height] = size.map(|n| n as f64);
        let up = right.cross(forward) * half;
        Some(Self { position, forward, right: right * (half * width / height), up, size })
    }

    /// Reads `camera`.
    pub fn read(settings: &Settings, size: Option<[usize; 2]>) -> Option<Self> {
        let camera = settings.table("camera")?;
        let (position, target) = (camera.triple("position"), camera.triple("target"));
        let up = camera.triple_or("up", [0.0, 1.0, 0.0]);
        let angle = camera.number_or("angle", Domain::Positive, 40.0);
        camera.close();
        let (position, target, up, angle) = (position?, target?, up?, angle?);
        if angle >= 179.0 {
            let help = "the angle between the lower and the upper edge is below 179 degrees";
            camera.fault("angle", format!("`angle` is {angle}"), help);
            return None;
        }
        let actual = Self::new(Point(position), Point(target), Point(up), angle, size?);
        if actual.is_none() {
            let help = "`target` is not `position`, and `up` points aside of the view";
            settings.fault("camera", "this camera has no direction", help);
        }
        actual
    }

    /// Returns the beginning of all rays.
    pub fn position(&self) -> Point {
        self.position
    }

    /// Returns the direction of the ray through the middle of a pixel.
    pub fn direction(&self, column: usize, row: usize) -> Option<Point> {
        let [width, height] = self.size.map(|n| n as f64);
        let x = 2.0 * (column as f64 + 0.5) / width - 1.0;
        let y = 1.0 - 2.0 * (row as f64 + 0.5) / height;
        (self.forward + self.right * x + self.up * y).normalised()
    }
}

/// Volume in the view of a camera.
pub struct View {
    /// The fields' names in the catalogue, without repetition.
    pub medium: String,
    /// The field: one, or those of red, green and blue light within the same bounds.
    pub volumes: Vec<Arc<Volume>>,
    /// Sky behind it.
    pub sky: Sky,
    /// Number of columns and rows.
    pub size: [usize; 2],
    /// Number of columns and rows of pixels that share a control that takes lookups.
    pub shared_control: usize,
    /// True if the sky is visible beside the volume; otherwise it is black there.
    pub shows_sky: bool,
    camera: Camera,
    /// Length of all rays, beyond the far side of the volume.
    length: f64,
}

impl View {
    /// Reads `size`, `camera`, `volume` (three fields for a coloured picture) and, if it is visible, `sky`.
    pub fn read(settings: &Settings, shows_sky: bool, is_coloured: bool) -> Option<Self> {
        let size = read_size(settings);
        let camera = Camera::read(settings, size);
        let black = Sky::Constant { radiance: 0.0 };
        let sky = if shows_sky { Sky::read(settings) } else { Some(black) };
        let shared = settings.count_or("shared-control", 1..=1024, 1);
        let fields = if is_coloured { read_colours(settings) } else { read_one(settings) };
        let (medium, volumes) = fields?;
        let Some(about) = volumes[0].bounds().enclosing_box() else {
            let help = "add `bounds.sphere = { centre, radius }` or `bounds.box = { low, high }`";
            settings.fault("volume", "this volume fills all of space", help);
            return None;
        };
        let camera = camera?;
        let length = furthest(&about, camera.position);
        let (sky, size) = (sky?, size?);
        let shared_control = usize::try_from(shared?).ok()?;
        Some(Self { medium, volumes, sky, size, shared_control, shows_sky, camera, length })
    }

    /// Returns the field of each channel with a ray.
    pub fn bodies(&self, ray: Ray) -> Vec<Body> {
        let body = |volume: &Arc<Volume>| {
            let (name, volume) = (self.medium.clone(), volume.clone());
            Body::Volume { name, volume, ray }
        };
        self.volumes.iter().map(body).collect()
    }

    /// Returns the number of pixels.
    pub fn pixels(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// Returns the ray of a pixel, row after row from the top.
    pub fn ray(&self, pixel: usize) -> Option<Ray> {
        let [width, _] = self.size;
        let direction = self.camera.direction(pixel % width, pixel / width)?;
        Ray::new(self.camera.position, direction, self.length)
    }

    /// Returns the ray of a pixel if it hits the volume.
    pub fn covered(&self, pixel: usize) -> Option<Ray> {
        self.ray(pixel).filter(|ray| !self.volumes[0].bounds().clip(ray).is_empty())
    }

    /// Returns the pixel to which the control of this pixel is fitted: the middle one of its block, if the volume
    /// covers that.
    pub fn leader(&self, pixel: usize) -> usize {
        let ([width, height], block) = (self.size, self.shared_control);
        let middle = |at: usize, end: usize| (at / block * block + block / 2).min(end - 1);
        let leader = middle(pixel / width, height) * width + middle(pixel % width, width);
        if self.covered(leader).is_some() { leader } else { pixel }
    }

    /// Returns the radiance at a pixel that the volume does not cover.
    pub fn background(&self, pixel: usize) -> f64 {
        if self.shows_sky { self.behind(pixel) } else { 0.0 }
    }

    /// Returns the radiance of the sky behind a pixel.
    pub fn behind(&self, pixel: usize) -> f64 {
        self.ray(pixel).map_or(0.0, |ray| self.sky.radiance(ray.direction))
    }
}

fn read_one(settings: &Settings) -> Option<(String, Vec<Arc<Volume>>)> {
    read_volume(settings, Some("volume")).map(|(name, volume)| (name, vec![volume]))
}

fn read_colours(settings: &Settings) -> Option<(String, Vec<Arc<Volume>>)> {
    let fields = read_volumes(settings)?;
    if fields.len() != MAX_CHANNELS {
        let actual = format!("`volume` lists {} channels", fields.len());
        settings.fault("volume", actual, "a coloured picture takes three: red, green and blue");
        return None;
    }
    let (mut names, volumes): (Vec<String>, Vec<Arc<Volume>>) = fields.into_iter().unzip();
    if volumes.iter().any(|volume| volume.bounds() != volumes[0].bounds()) {
        let actual = "the channels do not fill the same part of space";
        settings.fault("volume", actual, "give all of them the same `bounds`");
        return None;
    }
    names.dedup();
    Some((names.join(", "), volumes))
}

/// Returns slightly more than the distance of the furthest corner.
pub fn furthest(about: &Aabb, from: Point) -> f64 {
    let reach: [f64; 3] = std::array::from_fn(|i| {
        (about.low.0[i] - from.0[i]).abs().max((about.high.0[i] - from.0[i]).abs())
    });
    1.01 * Point(reach).norm()
}

fn read_size(settings: &Settings) -> Option<[usize; 2]> {
    let required = "columns and rows, as in [128, 128]";
    let list = settings.numbers("size", Domain::Positive, 2)?;
    let is_size = |&x: &f64| x.fract() == 0.0 && x <= MAX_SIDE as f64;
    if list.len() != 2 || !list.iter().all(is_size) {
        let actual = format!("`size` is {list:?}");
        settings.fault("size", actual, format!("it takes {required}, {MAX_SIDE} at most"));
        return None;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked just before
    let size = [list[0] as usize, list[1] as usize];
    Some(size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(size: [usize; 2]) -> Camera {
        let (from, to) = (Point([0.0, 0.0, 5.0]), Point([0.0; 3]));
        Camera::new(from, to, Point([0.0, 1.0, 0.0]), 90.0, size).expect("a direction")
    }

    #[test]
    fn the_middle_ray_goes_straight_to_the_target() {
        let middle = camera([3, 5]).direction(1, 2).expect("a direction");
        assert!((middle - Point([0.0, 0.0, -1.0])).norm() < 1e-15);
    }

    /// Looking along −z with y upwards, x grows to the right, as in a right-handed drawing.
    #[test]
    fn right_is_right_and_row_0_is_the_top() {
        let camera = camera([4, 2]);
        let corner = camera.direction(3, 0).expect("a direction");
        // At distance 1 the picture reaches to ±2 across and ±1 in height; pixel centres a half inwards.
        let expected = Point([1.5, 0.5, -1.0]).normalised().expect("a direction");
        assert!((corner - expected).norm() < 1e-15, "{corner:?}");
        let other = camera.direction(0, 1).expect("a direction");
        assert!((other - Point([-expected.0[0], -expected.0[1], expected.0[2]])).norm() < 1e-15);
    }

    #[test]
    fn a_camera_without_a_direction_is_refused() {
        let (o, z) = (Point([0.0; 3]), Point([0.0, 0.0, 1.0]));
        assert!(Camera::new(o, o, z, 40.0, [2, 2]).is_none());
        assert!(Camera::new(o, z, z, 40.0, [2, 2]).is_none());
    }
}
