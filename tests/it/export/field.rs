//! The truth is that of the samples, by arithmetic of the test itself.

use trueflight::export::Target;
use trueflight::media::grid_file::{self, GridChoice};

use super::{Scene, scene};

/// A `.vol` file, read byte by byte.
struct Vol {
    size: [usize; 3],
    low: [f64; 3],
    high: [f64; 3],
    values: Vec<f32>,
    /// True if samples beyond the box are zero; otherwise they are those of its border.
    zero: bool,
}

impl Vol {
    fn read(scene: &Scene, zero: bool) -> Self {
        let bytes = std::fs::read(scene.path("density.vol")).expect("a field");
        assert_eq!(&bytes[..4], b"VOL\x03");
        let word = |n: usize| <[u8; 4]>::try_from(&bytes[4 + 4 * n..8 + 4 * n]).expect("a word");
        let integer = |n| usize::try_from(i32::from_le_bytes(word(n))).expect("a size");
        let real = |n| f64::from(f32::from_le_bytes(word(n)));
        assert_eq!((integer(0), integer(4)), (1, 1), "float32, one channel");
        let size = [1, 2, 3].map(integer);
        let count = size.iter().product::<usize>();
        assert_eq!(bytes.len(), 48 + 4 * count);
        let values = (0..count).map(|n| f32::from_le_bytes(word(11 + n))).collect();
        Self { size, low: [5, 6, 7].map(real), high: [8, 9, 10].map(real), values, zero }
    }

    fn sample(&self, at: [i64; 3]) -> f64 {
        let mut index = [0; 3];
        for axis in 0..3 {
            let last = i64::try_from(self.size[axis]).expect("small") - 1;
            let inside = at[axis].clamp(0, last);
            if self.zero && inside != at[axis] {
                return 0.0;
            }
            index[axis] = usize::try_from(inside).expect("not negative");
        }
        let [x, y, z] = index;
        f64::from(self.values[(z * self.size[1] + y) * self.size[0] + x])
    }

    #[allow(clippy::cast_possible_truncation)] // places are in a small grid
    fn at(&self, place: [f64; 3]) -> f64 {
        let (mut cell, mut rest) = ([0; 3], [0.0; 3]);
        for axis in 0..3 {
            let share = (place[axis] - self.low[axis]) / (self.high[axis] - self.low[axis]);
            if !(0.0..=1.0).contains(&share) {
                return 0.0;
            }
            let u = share * self.size[axis] as f64 - 0.5;
            (cell[axis], rest[axis]) = (u.floor() as i64, u - u.floor());
        }
        let mut sum = 0.0;
        for corner in 0..8 {
            let bit = |axis: usize| i64::from(corner >> axis & 1 == 1);
            let weight = |axis: usize| if bit(axis) == 1 { rest[axis] } else { 1.0 - rest[axis] };
            let at = [0, 1, 2].map(|axis| cell[axis] + bit(axis));
            sum += weight(0) * weight(1) * weight(2) * self.sample(at);
        }
        sum
    }

    /// Returns the places where a line from `origin` enters and leaves the box.
    fn crossing(&self, origin: [f64; 3], direction: [f64; 3]) -> [[f64; 3]; 2] {
        let (mut from, mut to) = (0.0f64, f64::INFINITY);
        for axis in (0..3).filter(|&axis| direction[axis] != 0.0) {
            let at = |face: f64| (face - origin[axis]) / direction[axis];
            let (one, other) = (at(self.low[axis]), at(self.high[axis]));
            (from, to) = (from.max(one.min(other)), to.min(one.max(other)));
        }
        [from, to].map(|t| [0, 1, 2].map(|axis| origin[axis] + t * direction[axis]))
    }

    /// Returns `∫ σ_t` from a place to another, by `steps` midpoints.
    fn depth(&self, from: [f64; 3], to: [f64; 3], steps: u32) -> f64 {
        let way = [0, 1, 2].map(|axis| to[axis] - from[axis]);
        let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
        let value = |n: u32| {
            let share = (f64::from(n) + 0.5) / f64::from(steps);
            self.at([0, 1, 2].map(|axis| from[axis] + share * way[axis]))
        };
        (0..steps).map(value).sum::<f64>() * length / f64::from(steps)
    }
}

/// Returns the three numbers after a key of `case.toml`.
fn triple(scene: &Scene, key: &str) -> [f64; 3] {
    let text = scene.text("case.toml");
    let rest = text.split(&format!("{key} = [")).nth(1).expect("the key");
    let list = rest.split(']').next().expect("a list");
    let numbers: Vec<f64> = list.split(',').map(|x| x.trim().parse().expect("a number")).collect();
    numbers.try_into().expect("three numbers")
}

#[test]
fn transmittances_are_those_of_the_samples_read_linearly() {
    let cases = [
        ("transmittance/eq21-overview", Some(16)),
        ("transmittance/layers-with-gap", None),
        ("transmittance/eq21-inside", None),
        ("transmittance/grid-trilinear-centres", None),
        ("transmittance/layers-slant", Some(64)),
    ];
    for (case, cells) in cases {
        for (target, zero) in [(Target::Mitsuba, false), (Target::Pbrt, true)] {
            let scene = scene(case, target, cells).expect("exported");
            let vol = Vol::read(&scene, zero);
            let (origin, direction) = (triple(&scene, "origin"), triple(&scene, "direction"));
            let [from, to] = vol.crossing(origin, direction);
            let truth = (-vol.depth(from, to, 200_000)).exp();
            let stated = scene.exported.truth.questions[0].mean;
            assert!((stated / truth - 1.0).abs() < 1e-6, "{case}: {stated} and {truth}");
        }
    }
}

#[test]
fn single_scattering_is_that_of_the_samples() {
    let scene = scene("single-scattering/grid", Target::Mitsuba, None).expect("exported");
    let vol = Vol::read(&scene, false);
    let [origin, direction, lamp] =
        ["origin", "direction", "position"].map(|key| triple(&scene, key));
    let norm = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let number = |key: &str| -> f64 {
        let text = scene.text("case.toml");
        let rest = text.split(&format!("{key} = ")).nth(1).expect("the key");
        let end = rest.find([' ', '\n']).expect("an end");
        rest[..end].parse().expect("a number")
    };
    let (albedo, power, g) = (number("albedo"), number("power"), number("g"));
    let [from, to] = vol.crossing(origin, direction);
    let (steps, length) = (2_000, norm([0, 1, 2].map(|axis| to[axis] - from[axis])));
    let sphere = 4.0 * std::f64::consts::PI;
    let scattered = |n: u32| {
        let share = (f64::from(n) + 0.5) / f64::from(steps);
        let place = [0, 1, 2].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        let way = [0, 1, 2].map(|axis| place[axis] - lamp[axis]);
        let distance = norm(way);
        // Light travels from the lamp to the place, and from there against the ray.
        let cosine = -(0..3).map(|axis| way[axis] * direction[axis]).sum::<f64>() / distance;
        let phase = (1.0 - g * g) / (sphere * (1.0 + g * g - 2.0 * g * cosine).powf(1.5));
        let [_, leaves] = vol.crossing(place, way.map(|x| -x / distance));
        let depth = vol.depth(from, place, 1_000) + vol.depth(place, leaves, 1_000);
        vol.at(place) * albedo * phase * power / (sphere * distance * distance) * (-depth).exp()
    };
    let truth = (0..steps).map(scattered).sum::<f64>() * length / f64::from(steps);
    let stated = scene.exported.truth.questions[0].mean;
    assert!((stated / truth - 1.0).abs() < 1e-5, "{stated} and {truth}");
}

#[test]
fn a_field_file_is_read_back_as_it_was_written() {
    let scene =
        scene("transmittance/grid-trilinear-centres", Target::Mitsuba, None).expect("exported");
    let vol = Vol::read(&scene, false);
    let read = grid_file::read(&scene.path("density.vol"), &GridChoice::default()).expect("a grid");
    assert_eq!(read.size, [8, 6, 5], "a grid keeps its own samples");
    assert_eq!(read.size, vol.size);
    assert!(read.values.iter().zip(&vol.values).all(|(read, own)| *read == f64::from(*own)));
    let bounds = read.bounds.expect("corners");
    assert_eq!((bounds.low.0, bounds.high.0), (vol.low, vol.high));
    let field = scene.exported.truth.field.as_ref().expect("samples");
    assert_eq!((field.size, field.low, field.high), (vol.size, vol.low, vol.high));
    let peak = read.values.iter().copied().fold(0.0, f64::max);
    assert_eq!(field.peak, peak);
}
