//! The radiance that a ray gathers from a point light by single scattering.
//!
//! ```text
//! L = ∫ T(o, s) σ_t(s) a p(cos θ) Φ/(4π r²) T(p(s), l) ds
//! r = |p(s) − l|,   cos θ = ((p(s) − l)/r) · (−d)
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `volume` with `ray = { origin, direction, length }` | a field in space and the ray | required |
//! | `light = { position, power }` | a point light that shines alike in all directions and channels; length, power | power 1 |
//! | `albedo` | a above 0 and up to 1, the same everywhere | required |
//! | `phase.NAME = { … }` | p, see `trueflight list phases`; 1/sr | required |
//! | `sampling` | σ̂ of every estimator without its own | required unless swept |
//! | `control` | σ_c of every estimator that takes one and has none of its own | none |
//! | `sweep` | as in `transmittance`; of several channels `sampling`, `sampling-scale` | none |
//! | `estimators` | what is tested | required |
//!
//! **Several channels** (wavelengths): `volume` is a list of 1 to 8 fields within the same bounds; `albedos` and
//! `phases = [{ NAME = { … } }, …]` list one for each channel in place of `albedo` and `phase`; `sampling` is a constant σ̂
//! for all channels, or a list with one for each. `L_λ` is the radiance in the channel λ = 1 … N, and one lookup answers
//! σ_t of all channels.
//!
//! Light goes from l to p(s) and from there against the ray to its origin; `cos θ` is that between
//! the two directions of travel. Both stretches are clipped to the bounds of the volume. What comes
//! straight from beyond the ray's end, the first term of Eq. 22, is not part of L.
//!
//! A light on the line of the ray is refused: where it lies on the ray, L is infinite.
//!
//! The answer is a quadrature over s to 12 digits; the optical depths of both stretches are exact.
//! Along rays through more than 256 pieces, as in noise of many octaves, shadow rays are interpolated. The error is
//! then estimated from two resolutions, about 1e-5 of the answer.
//!
//! Sources: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! section 4.3, Eq. 22; channels: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of
//! Light Transport*, ACM Transactions on Graphics 38 (2019), section 5.
//!
//! ```toml
//! title = "An example of single-scattering"
//!
//! [problem.single-scattering]
//! volume = 0.8
//! ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 6 }
//! light.position = [0.5, 0, 2.5]
//! albedo = 0.9
//! phase = "isotropic"
//! sampling = 1
//! estimators = ["delta-tracking", "source-driven"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use std::f64::consts::PI;
use std::slice;
use std::sync::{Arc, OnceLock};

use super::channels::{Channel, read_channels};
use super::{ChannelValues, Problem, ProblemOption};
use media::catalogue::{Domain, Settings};
use media::phase::Phase;
use media::{Body, Medium, Volume};
use numeric::geometry::{Aabb, Point, Ray};
use numeric::{Known, Lane, Span, elementary};

/// A light nearer to the ray's line than this, relative to the ray's length, lies on it.
const ON_LINE: f64 = 1e-9;

/// Single scattering of a point light along a ray.
pub struct SingleScattering {
    volume: Arc<Volume>,
    ray: Ray,
    medium: Medium,
    light: PointLight,
    albedo: f64,
    phase: Phase,
    radiance: OnceLock<Known>,
}

/// A point light that shines alike in all directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lamp {
    /// Position.
    pub position: Point,
    /// Power Φ.
    pub power: f64,
}

/// Error: the light is too near to the line of the ray, at this distance. On the ray L is infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnTheLine(pub f64);

/// A point light as the ray sees it.
#[derive(Debug, Clone, Copy)]
struct PointLight {
    position: Point,
    power: f64,
    /// Distance from the ray's origin to the point of its line that is nearest to the light.
    foot: f64,
    /// Distance of the light from that point, > 0.
    distance: f64,
    /// The angles, seen from the light and measured from its foot, of the ends of the support.
    angles: Span,
    /// The angle between them.
    width: f64,
}

impl SingleScattering {
    /// Single scattering along a ray through a volume.
    ///
    /// # Errors
    ///
    /// The distance of a light that lies on the line of the ray.
    pub fn new(
        volume: Arc<Volume>,
        ray: Ray,
        lamp: Lamp,
        albedo: f64,
        phase: Phase,
    ) -> Result<Self, OnTheLine> {
        let support = volume.bounds().clip(&ray);
        let profile = volume.along(&ray, support);
        let medium = Medium::new(profile, ray.span(), support);
        let Lamp { position, power } = lamp;
        let [foot, distance] = lamp.seen_from(&ray)?;
        let ends = [support.from - foot, support.to - foot];
        let angle = |along: f64| elementary::atan(along / distance);
        let angles = Span::new(angle(ends[0]), angle(ends[1]));
        let width = if ends[0] * ends[1] > 0.0 {
            // Both angles are near a right one if the light is beyond either end.
            let apart = distance * support.length();
            elementary::atan(apart / (distance * distance + ends[0] * ends[1]))
        } else {
            angles.length()
        };
        let light = PointLight { position, power, foot, distance, angles, width };
        let radiance = OnceLock::new();
        Ok(Self { volume, ray, medium, light, albedo, phase, radiance })
    }

    /// The volume.
    pub fn volume(&self) -> &Volume {
        &*self.volume
    }

    /// L, computed at its first use.
    pub fn radiance(&self, find: impl FnOnce() -> Known) -> Known {
        *self.radiance.get_or_init(find)
    }

    /// The albedo a.
    pub fn albedo(&self) -> f64 {
        self.albedo
    }

    /// Phase function.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// The light.
    pub fn lamp(&self) -> Lamp {
        Lamp { position: self.light.position, power: self.light.power }
    }

    /// Distance from the ray's origin to the point that is nearest to the light.
    pub fn foot(&self) -> f64 {
        self.light.foot
    }

    /// D, the distance of the light from the ray's line.
    pub fn distance(&self) -> f64 {
        self.light.distance
    }

    /// The squared distance of `p(s)` from the light.
    #[inline(always)]
    fn square<L: Lane>(&self, s: L) -> L {
        self.square_beyond(s - self.light.foot)
    }

    /// The squared distance of the light from the point that is this far beyond the foot.
    #[inline(always)]
    fn square_beyond<L: Lane>(&self, along: L) -> L {
        let across = self.light.distance;
        along * along + across * across
    }

    /// `a p(cos θ) Φ/(4π r²)`: what `σ_t` scatters at `p(s)` towards the ray's origin, but for the
    /// two transmittances.
    #[inline(always)]
    pub fn source<L: Lane>(&self, s: L) -> L {
        self.scattered(s, self.cosine(s))
    }

    /// `cos θ` of light that is scattered at `p(s)` towards the ray's origin.
    #[inline(always)]
    pub fn cosine<L: Lane>(&self, s: L) -> L {
        // (p − l)·d = s − foot: beyond the foot the light travels on along the ray.
        let cosine = (s.each(self.light.foot) - s) / self.square(s).root();
        cosine.or_more(s.each(-1.0)).or_less(s.each(1.0))
    }

    /// `a p(cos θ) Φ/(4π r²)` with r that of `p(s)`.
    #[inline(always)]
    pub fn scattered<L: Lane>(&self, s: L, cosine: L) -> L {
        let phase = self.phase.value(cosine);
        phase * self.albedo * self.light.power / (self.square(s) * (4.0 * PI))
    }

    /// The distance along the ray that the light sees at an angle from its foot, which lies between
    /// two right angles.
    #[inline(always)]
    pub fn at_angle<L: Lane>(&self, angle: L) -> L {
        Lane::sin(angle) / Lane::cos(angle) * self.light.distance + self.light.foot
    }

    /// The angles of the ends of the support.
    pub fn angles(&self) -> Span {
        self.light.angles
    }

    /// The density over distance of points with uniform angles: `D/(Δθ r²)`, 1/length.
    #[inline(always)]
    pub fn equiangular_density<L: Lane>(&self, s: L) -> L {
        self.equiangular_density_beyond(s - self.light.foot)
    }

    /// The equiangular density at a distance beyond the foot, 1/length: next to the light `s` does not hold the
    /// digits of this distance.
    #[inline(always)]
    pub fn equiangular_density_beyond<L: Lane>(&self, along: L) -> L {
        along.each(self.light.distance) / (self.square_beyond(along) * self.light.width)
    }

    /// `a p(cos θ) Φ/(4π r²)` at a distance beyond the foot, as [`source`](Self::source), and the relative error of
    /// rounding.
    ///
    /// ```text
    /// ε (4 + |d ln p/d cos θ|)
    /// ```
    pub fn source_beyond(&self, along: f64) -> [f64; 2] {
        const STEP: f64 = 1e-7;
        let square = self.square_beyond(along);
        let cosine = (-along / square.sqrt()).clamp(-1.0, 1.0);
        let phase = self.phase.value(cosine);
        let beside = self.phase.value(if cosine > 0.0 { cosine - STEP } else { cosine + STEP });
        let steep = if phase > 0.0 { (phase - beside).abs() / (STEP * phase) } else { 0.0 };
        let source = self.albedo * phase * self.light.power / (4.0 * PI * square);
        [source, f64::EPSILON * (4.0 + steep)]
    }

    /// The way from `p(s)` to the light for points side by side: their coordinates, and direction and length of
    /// the rays of [`Self::shadow`].
    #[inline(always)]
    pub fn to_light<L: Lane>(&self, s: L) -> ([L; 3], [L; 3], L) {
        let (Point(origin), Point(direction)) = (self.ray.origin, self.ray.direction);
        let Point(light) = self.light.position;
        let [mut from, mut way] = [[s; 3]; 2];
        for axis in 0..3 {
            from[axis] = s * direction[axis] + origin[axis];
            way[axis] = s.each(light[axis]) - from[axis];
        }
        let [x, y, z] = way;
        let largest = x.size().or_more(y.size()).or_more(z.size());
        let scale = s.each(1.0) / largest;
        let [x, y, z] = [x * scale, y * scale, z * scale];
        let unit = s.each(1.0) / (x * x + y * y + z * z).root();
        (from, [x * unit, y * unit, z * unit], self.square(s).root())
    }

    /// The ray from `p(s)` to the light, and its stretch within the bounds of the volume; `None`
    /// where that is empty.
    pub fn shadow(&self, s: f64) -> Option<(Ray, Span)> {
        let from = self.ray.at(s);
        let length = self.square(s).sqrt();
        let ray = Ray::new(from, self.light.position - from, length)?;
        let inside = self.volume.bounds().clip(&ray);
        (!inside.is_empty()).then_some((ray, inside))
    }

    /// The field along the ray from `p(s)` to the light; `None` where that is outside the bounds.
    pub fn shadow_medium(&self, s: f64) -> Option<Medium> {
        let (ray, inside) = self.shadow(s)?;
        Some(Medium::new(self.volume.along(&ray, inside), ray.span(), inside))
    }

    /// A number that σ_t exceeds on no shadow ray: the volume's majorant over the box about the
    /// lit stretch and the light.
    pub fn shadow_majorant(&self) -> f64 {
        let support = self.medium.support();
        let ends = [self.ray.at(support.from), self.ray.at(support.to), self.light.position];
        let extreme = |of: fn(f64, f64) -> f64| {
            Point(std::array::from_fn(|i| {
                ends[1..].iter().fold(ends[0].0[i], |m, p| of(m, p.0[i]))
            }))
        };
        let about = Aabb { low: extreme(f64::min), high: extreme(f64::max) };
        match self.volume.bounds().enclosing_box() {
            None => self.volume.majorant(&about),
            Some(bounds) => bounds.intersect(&about).map_or(0.0, |b| self.volume.majorant(&b)),
        }
    }
}

/// A light, and how the medium scatters it.
#[derive(Debug, Clone, Copy)]
pub struct Lit {
    /// Light.
    pub lamp: Lamp,
    /// a, above 0.
    pub albedo: f64,
    /// Phase function.
    pub phase: Phase,
}

impl Lit {
    /// Reads `light`, `albedo` and `phase`.
    pub fn read(settings: &Settings) -> Option<Self> {
        let lamp = Lamp::read(settings);
        let albedo = settings.number("albedo", Domain::Unit);
        let phase = Phase::read(settings);
        let (lamp, albedo, phase) = (lamp?, albedo?, phase?);
        if albedo <= 0.0 {
            settings.fault("albedo", "nothing is scattered", "the albedo is above 0");
            return None;
        }
        Some(Self { lamp, albedo, phase })
    }
}

impl Lamp {
    /// Reads `light = { position, power }`.
    pub fn read(settings: &Settings) -> Option<Self> {
        let light = settings.table("light")?;
        let position = light.triple("position");
        let power = light.number_or("power", Domain::Positive, 1.0);
        light.close();
        Some(Self { position: Point(position?), power: power? })
    }

    /// Distance from a ray's origin to the point of its line that is nearest to the light, and the distance between both.
    ///
    /// # Errors
    ///
    /// The distance of a light that lies on the line.
    pub fn seen_from(&self, ray: &Ray) -> Result<[f64; 2], OnTheLine> {
        let (foot, offset) = ray.nearest_to(self.position);
        let distance = offset.norm();
        let is_on_line = distance <= ON_LINE * ray.length.max(foot.abs());
        if is_on_line { Err(OnTheLine(distance)) } else { Ok([foot, distance]) }
    }
}

impl Problem for SingleScattering {
    type Value = [f64; 1];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let lit = Lit::read(settings);
        let Body::Volume { volume, ray, .. } = body? else {
            let help = "write `volume` instead of `medium`, and give a `ray`";
            settings.fault("medium", "a light needs a field in space", help);
            return None;
        };
        let Lit { lamp, albedo, phase } = lit?;
        off_the_line(settings, Self::new(volume.clone(), *ray, lamp, albedo, phase))
    }

    fn media(&self) -> &[Medium] {
        slice::from_ref(&self.medium)
    }
}

/// Reports a light on the line of the ray.
fn off_the_line<T>(settings: &Settings, result: Result<T, OnTheLine>) -> Option<T> {
    if let Err(OnTheLine(distance)) = result {
        let result = format!("the light is {distance:e} away from the line of the ray");
        settings.fault("light", result, "move it off the line: on the ray L is infinite");
    }
    result.ok()
}

/// Single scattering of a point light in several channels.
pub struct SpectralSingleScattering {
    /// Each channel by itself.
    pub channels: Vec<Arc<SingleScattering>>,
    /// Albedos of the channels.
    pub albedos: Vec<f64>,
    media: Vec<Medium>,
}

impl Problem for SpectralSingleScattering {
    type Value = ChannelValues;

    const OPTIONS: &'static [ProblemOption] = &[ProblemOption::Albedos, ProblemOption::Media];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let (lamp, scatterers) = (Lamp::read(settings), read_channels(body, settings));
        let (lamp, scatterers) = (lamp?, scatterers?);
        if let Some(dark) = scatterers.iter().position(|channel| channel.albedo <= 0.0) {
            let actual = format!("nothing is scattered in channel {}", dark + 1);
            settings.fault("albedos", actual, "every albedo is above 0");
            return None;
        }
        let Body::Volume { ray, .. } = &body?.channels()[0] else { return None };
        let channel = |of: &Channel| {
            SingleScattering::new(of.volume.clone(), *ray, lamp, of.albedo, of.phase).map(Arc::new)
        };
        let channels: Result<Vec<_>, OnTheLine> = scatterers.iter().map(channel).collect();
        let channels = off_the_line(settings, channels)?;
        let media = channels.iter().map(|channel| channel.medium.clone()).collect();
        let albedos = scatterers.iter().map(|channel| channel.albedo).collect();
        Some(Self { channels, albedos, media })
    }

    fn media(&self) -> &[Medium] {
        &self.media
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use media::constant::Constant;
    use media::phase::{henyey_greenstein::HenyeyGreenstein, isotropic::Isotropic};
    use numeric::geometry::Bounds;

    fn lit(phase: Phase, [distance, foot]: [f64; 2]) -> SingleScattering {
        let field = Constant::within(1.0, Bounds::Everywhere);
        let ray = Ray::new(Point([0.0; 3]), Point([0.0, 0.0, 1.0]), 1.0).expect("a direction");
        let lamp = Lamp { position: Point([distance, 0.0, foot]), power: 1.0 };
        SingleScattering::new(Arc::new(field), ray, lamp, 1.0, phase).expect("off the line")
    }

    #[test]
    fn a_narrow_angle_keeps_its_digits() {
        // Seen from 1e-6 beside the line and 1 before the ray: Δθ = D(1 − 1/2) − D³(1 − 1/8)/3.
        let problem = lit(Phase::Isotropic(Isotropic), [1e-6, -1.0]);
        let exact = 1e-6 / ((0.5e-6 - 0.875e-18 / 3.0) * (1.0 + 1e-12));
        assert!((problem.equiangular_density_beyond(1.0) / exact - 1.0).abs() < 2e-15);
        assert!((problem.angles().length() / 0.5e-6 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn next_to_the_light_the_distance_from_its_foot_counts() {
        let problem = lit(Phase::Isotropic(Isotropic), [1e-8, 0.7]);
        let [source, error] = problem.source_beyond(1e-8);
        let exact = 1.0 / (16.0 * PI * PI * 2e-16);
        assert!((source / exact - 1.0).abs() < error && error < 1e-15);
        assert!((problem.source(0.7 + 1e-8) / exact - 1.0).abs() > 1e-10);
        assert_eq!(problem.source(0.5), problem.source_beyond(0.5 - problem.foot())[0]);
    }

    #[test]
    fn steep_phase_functions_round_more() {
        let sharp = HenyeyGreenstein::new(0.99).expect("in range");
        let problem = lit(Phase::HenyeyGreenstein(sharp), [1e-3, 0.5]);
        // d ln p/d cos θ = 3g/(1 + g² − 2g cos θ), 3e4 straight ahead.
        let [_, error] = problem.source_beyond(-0.5);
        assert!(error > 2e4 * f64::EPSILON && error < 4e4 * f64::EPSILON, "{error:e}");
    }
}
