//! Chords of spheres and boxes: rays that graze, that start far away, that are very long or short.

use super::{Dice, Effort, Measure, Row, beyond, in_parts, text};
use crate::geometry::{Aabb, Bounds, Point, Ray};
use crate::numeric::double_double::{two_prod, two_sum};
use crate::numeric::{Span, Wide};

const PARTS: u64 = 16;

/// All rows.
#[must_use]
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(40, 5000);
    in_parts(PARTS, |part| {
        let dice = &mut Dice::new(seed, "geometry", part);
        vec![
            spheres(dice, trials, "origins 0 … 10 radii away", [-3.0, 1.0], [-3.0, 0.0]),
            spheres(dice, trials, "origins up to 1e6 radii away", [1.0, 6.0], [-3.0, 0.0]),
            spheres(dice, trials, "grazing within 1e-12 … 1e-2 of R", [-3.0, 6.0], [-12.0, -2.0]),
            misses(dice, trials),
            depths(dice, trials / 10),
            boxes(dice, trials),
        ]
    })
}

/// A ball and a ray that passes its centre at `(1 − depth)` radii.
struct Scene {
    centre: Point,
    radius: f64,
    ray: Ray,
}

impl Scene {
    fn new(dice: &mut Dice, away: [f64; 2], depth: f64) -> Option<Self> {
        let radius = dice.sized(-3.0, 3.0);
        let centre = Point([0; 3].map(|_| radius * dice.between(-2.0, 2.0)));
        let direction = Point([0; 3].map(|_| dice.between(-1.0, 1.0))).normalised()?;
        let other = Point([0; 3].map(|_| dice.between(-1.0, 1.0)));
        let aside = (other - direction * other.dot(direction)).normalised()?;
        let away = dice.sized(away[0], away[1]) * radius;
        let origin = centre + aside * (radius * (1.0 - depth)) - direction * away;
        let ray = Ray::new(origin, direction, 2.0 * away + 4.0 * radius)?;
        Some(Self { centre, radius, ray })
    }

    /// Both ends of the chord on the line of the ray; `None` for a miss.
    fn exact(&self) -> Option<[Wide; 2]> {
        let axes = [0, 1, 2].map(|i| {
            (two_sum(self.centre.0[i], -self.ray.origin.0[i]), Wide::from(self.ray.direction.0[i]))
        });
        let square: Wide = self.ray.direction.0.iter().map(|&d| two_prod(d, d)).sum();
        let along = axes.iter().map(|&(v, d)| v * d).sum::<Wide>();
        // |v × d|², which does not cancel where v is along d.
        let cross = |i: usize, j: usize| axes[i].0 * axes[j].1 - axes[j].0 * axes[i].1;
        let offset: Wide = [cross(0, 1), cross(1, 2), cross(2, 0)].iter().map(|&c| c * c).sum();
        let left = two_prod(self.radius, self.radius) * square - offset;
        if left.high <= 0.0 {
            return None;
        }
        let half = left.sqrt();
        Some([along - half, along + half].map(|end| end / square))
    }

    fn text(&self) -> String {
        let Self { centre, radius, ray } = self;
        let Ray { origin, direction, length } = ray;
        let ball = format!("bounds.sphere = {{ centre = {:?}, radius = {radius:e} }}", centre.0);
        let ray = format!(
            "{{ origin = {:?}, direction = {:?}, length = {length:e} }}",
            origin.0, direction.0
        );
        format!("volume.constant = {{ extinction = 1, {ball} }}\nray = {ray}")
    }
}

fn inside(ends: [Wide; 2], length: f64) -> [Wide; 2] {
    ends.map(|end| {
        if end.high < 0.0 {
            Wide::default()
        } else if end.high > length {
            Wide::from(length)
        } else {
            end
        }
    })
}

fn spheres(dice: &mut Dice, trials: u32, what: &str, away: [f64; 2], depth: [f64; 2]) -> Row {
    let mut row = Row::new("ends of a chord", what, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let depth = dice.sized(depth[0], depth[1]);
        let scene = Scene::new(dice, away, depth);
        let Some((exact, scene)) = scene.and_then(|scene| Some((scene.exact()?, scene))) else {
            row.skip(|| format!("depth {depth:e} of R"));
            continue;
        };
        let ball = Bounds::Sphere { centre: scene.centre, radius: scene.radius };
        let found = ball.ends(&scene.ray);
        for (found, exact) in found.into_iter().zip(inside(exact, scene.ray.length)) {
            let off = (Wide::from(found.value) - exact).abs().value();
            let error = if off == 0.0 { 0.0 } else { off / found.error };
            row.see(error, || scene.text().replace('\n', ", "));
        }
    }
    row
}

/// Rays that pass outside, be it by 1e-12 of the radius, see nothing; those that pass inside do.
fn misses(dice: &mut Dice, trials: u32) -> Row {
    let range = "passing at R(1 ± 1e-12 … 1e-2), up to 1e6 R away";
    let mut row = Row::new("hits and misses, wrong", range, Measure::Count, 0.0);
    for _ in 0..trials {
        let depth = dice.sign() * dice.sized(-12.0, -2.0);
        let Some(scene) = Scene::new(dice, [-1.0, 6.0], depth) else {
            row.skip(|| format!("depth {depth:e} of R"));
            continue;
        };
        let ball = Bounds::Sphere { centre: scene.centre, radius: scene.radius };
        let inside = ball.clip(&scene.ray);
        let exact = scene.exact();
        // A chord shorter than the grain of its distances may vanish.
        let grain = 4.0 * f64::EPSILON * scene.ray.length;
        let is_short = exact.is_some_and(|[a, b]| (b - a).value() < grain);
        let is_wrong = exact.is_none() != inside.is_empty() && !is_short;
        row.count(is_wrong, || scene.text().replace('\n', ", "));
    }
    row
}

/// The optical depth of what such a ray sees: the chord's own error is part of the stated one.
fn depths(dice: &mut Dice, trials: u32) -> Row {
    let range = "grazing within 1e-12 … 1 of R, up to 1e6 R away";
    let mut row = Row::new("optical depth of a chord", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let depth = dice.sized(-12.0, 0.0);
        let chord = Scene::new(dice, [0.5, 6.0], depth).and_then(|scene| {
            let medium = text::medium(&scene.text())?;
            // Reading the direction normalises it once more: the ray is the one that was read.
            let direction = scene.ray.direction.normalised()?;
            let ray = Ray { direction, ..scene.ray };
            Some((medium, (Scene { ray, ..scene }).exact()?))
        });
        let Some((medium, [from, to])) = chord else {
            row.skip(|| format!("depth {depth:e} of R"));
            continue;
        };
        let found = medium.optical_depth(medium.span());
        let off = (Wide::from(found.value) - (to - from)).abs().value();
        let rounding = 0.5 * f64::EPSILON * found.value;
        row.see(beyond(off, rounding) / found.error, || format!("depth {depth:e} of R"));
    }
    row
}

/// Boxes, entered obliquely and along their faces.
fn boxes(dice: &mut Dice, trials: u32) -> Row {
    let range = "origins up to 1e6 sizes away, slopes 1e-12 … 1";
    let mut row = Row::new("ends of a chord, box", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let size = dice.sized(-3.0, 3.0);
        let low = Point([0; 3].map(|_| size * dice.between(-2.0, 1.0)));
        let high = low + Point([0; 3].map(|_| size * dice.between(0.1, 1.0)));
        let cube = Aabb { low, high };
        let target = Point([0, 1, 2].map(|i| dice.between(low.0[i], high.0[i])));
        let axes =
            [1.0, dice.sign() * dice.sized(-12.0, 0.0), dice.sign() * dice.sized(-12.0, 0.0)];
        let turn = dice.below(3);
        let direction = Point([0, 1, 2].map(|i| axes[(i + turn) % 3]));
        let away = dice.sized(0.0, 6.0) * size;
        let ray = direction
            .normalised()
            .and_then(|unit| Ray::new(target - unit * away, unit, 3.0 * away + 9.0 * size));
        let Some(ray) = ray else {
            row.skip(|| format!("{direction:?} to {cube:?}"));
            continue;
        };
        let mut exact = [Wide::default(), Wide::from(ray.length)];
        for i in 0..3 {
            let end = |face: f64| two_sum(face, -ray.origin.0[i]) / Wide::from(ray.direction.0[i]);
            let (a, b) = (end(low.0[i]), end(high.0[i]));
            let (near, far) = if (a - b).high < 0.0 { (a, b) } else { (b, a) };
            let [from, to] = exact;
            exact = [
                if (near - from).high > 0.0 { near } else { from },
                if (far - to).high < 0.0 { far } else { to },
            ];
        }
        let chord = exact[1] - exact[0];
        let found = Bounds::Box(cube).ends(&ray);
        if chord.high <= 1e-9 * ray.length || Span::new(found[0].value, found[1].value).is_empty() {
            row.skip(|| format!("{ray:?} in {cube:?}"));
            continue;
        }
        for (found, exact) in found.into_iter().zip(exact) {
            let off = (Wide::from(found.value) - exact).abs().value();
            let place = || format!("{ray:?} in {cube:?}");
            row.see(if off == 0.0 { 0.0 } else { off / found.error }, place);
        }
    }
    row
}
