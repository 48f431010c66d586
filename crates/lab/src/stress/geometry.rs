//! Chords of spheres and boxes: rays that graze, that start far away, that are very long or short.

use std::sync::Arc;

use super::fields::crossed;
use super::prelude::*;
use media::constant::Constant;
use numeric::double_double::{two_prod, two_sum};
use numeric::geometry::{Aabb, Bounds, Point, Ray};

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let trials = [640, 80_000];
    let mut rows = Vec::new();
    for (range, away, depth) in [
        ("origins 0 … 10 radii away", [-3.0, 1.0], [-3.0, 0.0]),
        ("origins up to 1e6 radii away", [1.0, 6.0], [-3.0, 0.0]),
        ("grazing within 1e-12 … 1e-2 of R", [-3.0, 6.0], [-12.0, -2.0]),
    ] {
        let row = TrialRow::stated("ends of a chord", range);
        let [away, depth] = [away, depth].map(|[low, high]| sized(low, high));
        rows.extend(run.fill(trials, [row], || (depth, Scene::any(away)), sphere));
    }
    let range = "passing at R(1 ± 1e-12 … 1e-2), up to 1e6 R away";
    let row = TrialRow::wrong("hits and misses, wrong", range);
    let depth = sized(-12.0, -2.0);
    rows.extend(run.fill(trials, [row], || (sign(), depth, Scene::any(sized(-1.0, 6.0))), miss));
    let range = "grazing within 1e-12 … 1 of R, up to 1e6 R away";
    let row = TrialRow::stated("optical depth of a chord", range);
    let chord = || (sized(-12.0, 0.0), Scene::any(sized(0.5, 6.0)));
    rows.extend(run.fill(trials.map(|count| count / 10), [row], chord, optical_depth));
    let range = "origins up to 1e6 sizes away, slopes 1e-12 … 1";
    rows.extend(run.fill(
        trials,
        [TrialRow::stated("ends of a chord, box", range)],
        Cuboid::any,
        cuboid,
    ));
    rows
}

parameters! {
    /// A ball and a ray past it; the depth of the chord is a parameter of its own.
    Scene(range: NumberStrategy) {
        radius: f64 = sized(-3.0, 3.0),
        centre: [f64; 3] = [between(-2.0, 2.0); 3],
        direction: [f64; 3] = [between(-1.0, 1.0); 3],
        side: [f64; 3] = [between(-1.0, 1.0); 3],
        away: f64 = range,
    }
}

/// A ball, and a ray that passes its centre at `(1 − depth)` radii.
struct BallChord {
    ball: Bounds,
    centre: Point,
    radius: f64,
    ray: Ray,
}

impl Scene {
    fn chord(&self, depth: f64) -> Option<BallChord> {
        let radius = self.radius;
        let centre = Point(self.centre) * radius;
        let direction = Point(self.direction).normalised()?;
        let other = Point(self.side);
        let aside = (other - direction * other.dot(direction)).normalised()?;
        let away = self.away * radius;
        let origin = centre + aside * (radius * (1.0 - depth)) - direction * away;
        let ray = Ray::new(origin, direction, 2.0 * away + 4.0 * radius)?;
        Some(BallChord { ball: Bounds::Sphere { centre, radius }, centre, radius, ray })
    }
}

impl BallChord {
    /// Both ends of the chord on the line of the ray; `None` for a miss.
    fn exact(&self) -> Option<[DoubleDouble; 2]> {
        let axes = [0, 1, 2].map(|i| {
            (
                two_sum(self.centre.0[i], -self.ray.origin.0[i]),
                DoubleDouble::from(self.ray.direction.0[i]),
            )
        });
        let square: DoubleDouble = self.ray.direction.0.iter().map(|&d| two_prod(d, d)).sum();
        let along = axes.iter().map(|&(v, d)| v * d).sum::<DoubleDouble>();
        // |v × d|², which does not cancel where v is along d.
        let cross = |i: usize, j: usize| axes[i].0 * axes[j].1 - axes[j].0 * axes[i].1;
        let offset: DoubleDouble =
            [cross(0, 1), cross(1, 2), cross(2, 0)].iter().map(|&c| c * c).sum();
        let left = two_prod(self.radius, self.radius) * square - offset;
        let half = left.sqrt();
        let ends = [along - half, along + half].map(|end| end / square);
        (left.high > 0.0).then_some(ends)
    }
}

fn see_ends(seen: &mut Seen, computed: [Known; 2], exact: [DoubleDouble; 2]) {
    for (computed, exact) in computed.into_iter().zip(exact) {
        seen.see(0, over(off(computed.value, exact), computed.error));
    }
}

fn sphere((depth, scene): &(f64, Scene), seen: &mut Seen) -> Option<()> {
    let chord = scene.chord(*depth)?;
    let length = chord.ray.length;
    let exact = chord.exact()?.map(|end| match end.high {
        before if before < 0.0 => DoubleDouble::default(),
        beyond if beyond > length => DoubleDouble::from(length),
        _ => end,
    });
    see_ends(seen, chord.ball.ends(&chord.ray), exact);
    Some(())
}

/// Rays that pass outside, even by 1e-12 of the radius, miss; those that pass inside hit.
fn miss((sign, depth, scene): &(f64, f64, Scene), seen: &mut Seen) -> Option<()> {
    let chord = scene.chord(sign * depth)?;
    let inside = chord.ball.clip(&chord.ray);
    let exact = chord.exact();
    // A chord shorter than the grain of its distances may vanish.
    let grain = 4.0 * f64::EPSILON * chord.ray.length;
    let is_short = exact.is_some_and(|[a, b]| (b - a).value() < grain);
    seen.wrong(0, exact.is_none() != inside.is_empty() && !is_short);
    Some(())
}

/// The optical depth of such a chord: the error of its ends is part of the stated one.
fn optical_depth((depth, scene): &(f64, Scene), seen: &mut Seen) -> Option<()> {
    let chord = scene.chord(*depth)?;
    let medium = crossed(Arc::new(Constant::within(1.0, chord.ball)), chord.ray);
    let [from, to] = chord.exact()?;
    let computed = medium.optical_depth(medium.span());
    let rounding = 0.5 * f64::EPSILON * computed.value;
    seen.see(0, (off(computed.value, to - from) - rounding).max(0.0) / computed.error);
    Some(())
}

parameters! {
    /// A box, and a ray through it, obliquely or along a face.
    Cuboid {
        size: f64 = sized(-3.0, 3.0),
        low: [f64; 3] = [between(-2.0, 1.0); 3],
        edges: [f64; 3] = [between(0.1, 1.0); 3],
        target: [f64; 3] = [between(0.0, 1.0); 3],
        slopes: [(f64, f64); 2] = [(), ()].map(|()| (sign(), sized(-12.0, 0.0))),
        turn: usize = 0..3_usize,
        away: f64 = sized(0.0, 6.0),
    }
}

fn cuboid(cuboid: &Cuboid, seen: &mut Seen) -> Option<()> {
    let Cuboid { size, low, edges, target, slopes, turn, away } = cuboid;
    let low = Point(*low) * *size;
    let high = low + Point(*edges) * *size;
    let cube = Aabb { low, high };
    let target = Point([0, 1, 2].map(|i| low.0[i] + (high.0[i] - low.0[i]) * target[i]));
    let [one, other] = slopes.map(|(sign, slope)| sign * slope);
    let axes = [1.0, one, other];
    let unit = Point([0, 1, 2].map(|i| axes[(i + turn) % 3])).normalised()?;
    let away = away * size;
    let ray = Ray::new(target - unit * away, unit, 3.0 * away + 9.0 * size)?;
    let mut exact = [DoubleDouble::default(), DoubleDouble::from(ray.length)];
    for i in 0..3 {
        let end = |face: f64| two_sum(face, -ray.origin.0[i]) / ray.direction.0[i];
        let (a, b) = (end(low.0[i]), end(high.0[i]));
        let (near, far) = if (a - b).high < 0.0 { (a, b) } else { (b, a) };
        let [from, to] = exact;
        exact = [
            if (near - from).high > 0.0 { near } else { from },
            if (far - to).high < 0.0 { far } else { to },
        ];
    }
    let computed = Bounds::Box(cube).ends(&ray);
    let is_short = (exact[1] - exact[0]).high <= 1e-9 * ray.length;
    if is_short || Span::new(computed[0].value, computed[1].value).is_empty() {
        return None;
    }
    see_ends(seen, computed, exact);
    Some(())
}
