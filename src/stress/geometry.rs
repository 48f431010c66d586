//! Chords of spheres and boxes: rays that graze, that start far away, that are very long or short.

use super::text::{self, one_line};
use super::trial::{Dice, Trial, beyond, of_allowed, off};
use super::{Effort, Row, in_parts};
use numeric::double_double::{two_prod, two_sum};
use numeric::geometry::{Aabb, Bounds, Point, Ray};
use numeric::{Known, Span, Wide};

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(40, 5000);
    in_parts(16, "geometry", seed, |part| {
        for (range, away, depth) in [
            ("origins 0 … 10 radii away", [-3.0, 1.0], [-3.0, 0.0]),
            ("origins up to 1e6 radii away", [1.0, 6.0], [-3.0, 0.0]),
            ("grazing within 1e-12 … 1e-2 of R", [-3.0, 6.0], [-12.0, -2.0]),
        ] {
            part.run(trials, [Row::stated("ends of a chord", range)], |t| sphere(t, away, depth));
        }
        let range = "passing at R(1 ± 1e-12 … 1e-2), up to 1e6 R away";
        part.run(trials, [Row::wrong("hits and misses, wrong", range)], miss);
        let range = "grazing within 1e-12 … 1 of R, up to 1e6 R away";
        part.run(trials / 10, [Row::stated("optical depth of a chord", range)], depth);
        let range = "origins up to 1e6 sizes away, slopes 1e-12 … 1";
        part.run(trials, [Row::stated("ends of a chord, box", range)], cuboid);
    })
}

/// A ball and a ray that passes its centre at `(1 − depth)` radii.
struct Scene {
    centre: Point,
    radius: f64,
    ray: Ray,
}

fn anywhere(dice: &mut Dice) -> Point {
    Point([0; 3].map(|_| dice.between(-1.0, 1.0)))
}

impl Scene {
    fn new(dice: &mut Dice, [least, most]: [f64; 2], depth: f64) -> Option<Self> {
        let radius = dice.sized(-3.0, 3.0);
        let centre = Point([0; 3].map(|_| radius * dice.between(-2.0, 2.0)));
        let direction = anywhere(dice).normalised()?;
        let other = anywhere(dice);
        let aside = (other - direction * other.dot(direction)).normalised()?;
        let away = dice.sized(least, most) * radius;
        let origin = centre + aside * (radius * (1.0 - depth)) - direction * away;
        let ray = Ray::new(origin, direction, 2.0 * away + 4.0 * radius)?;
        Some(Self { centre, radius, ray })
    }

    fn ball(&self) -> Bounds {
        Bounds::Sphere { centre: self.centre, radius: self.radius }
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
        let half = left.sqrt();
        let ends = [along - half, along + half].map(|end| end / square);
        (left.high > 0.0).then_some(ends)
    }

    fn text(&self) -> String {
        let Self { centre: Point(centre), radius, ray } = self;
        let Ray { origin: Point(origin), direction: Point(direction), length } = ray;
        format!(
            "volume.constant = {{ extinction = 1, \
             bounds.sphere = {{ centre = {centre:?}, radius = {radius:e} }} }}\n\
             ray = {{ origin = {origin:?}, direction = {direction:?}, length = {length:e} }}"
        )
    }
}

fn see_ends(t: &mut Trial, found: [Known; 2], exact: [Wide; 2]) {
    for (found, exact) in found.into_iter().zip(exact) {
        t.see(0, of_allowed(off(found.value, exact), found.error));
    }
}

fn sphere(t: &mut Trial, away: [f64; 2], [least, most]: [f64; 2]) -> Option<()> {
    let depth = t.dice.sized(least, most);
    t.place = format!("depth {depth:e} of R");
    let scene = Scene::new(t.dice, away, depth)?;
    let length = scene.ray.length;
    let exact = scene.exact()?.map(|end| match end.high {
        before if before < 0.0 => Wide::default(),
        beyond if beyond > length => Wide::from(length),
        _ => end,
    });
    t.place = one_line(&scene.text());
    see_ends(t, scene.ball().ends(&scene.ray), exact);
    Some(())
}

/// Rays that pass outside, be it by 1e-12 of the radius, see nothing; those that pass inside do.
fn miss(t: &mut Trial) -> Option<()> {
    let depth = t.dice.sign() * t.dice.sized(-12.0, -2.0);
    t.place = format!("depth {depth:e} of R");
    let scene = Scene::new(t.dice, [-1.0, 6.0], depth)?;
    let inside = scene.ball().clip(&scene.ray);
    let exact = scene.exact();
    // A chord shorter than the grain of its distances may vanish.
    let grain = 4.0 * f64::EPSILON * scene.ray.length;
    let is_short = exact.is_some_and(|[a, b]| (b - a).value() < grain);
    t.place = one_line(&scene.text());
    t.count(0, exact.is_none() != inside.is_empty() && !is_short);
    Some(())
}

/// The optical depth of what such a ray sees: the chord's own error is part of the stated one.
fn depth(t: &mut Trial) -> Option<()> {
    let depth = t.dice.sized(-12.0, 0.0);
    t.place = format!("depth {depth:e} of R");
    let scene = Scene::new(t.dice, [0.5, 6.0], depth)?;
    let medium = text::medium(&scene.text())?;
    // Reading the direction normalises it once more: the ray is the one that was read.
    let ray = Ray { direction: scene.ray.direction.normalised()?, ..scene.ray };
    let [from, to] = Scene { ray, ..scene }.exact()?;
    let found = medium.optical_depth(medium.span());
    let rounding = 0.5 * f64::EPSILON * found.value;
    t.see(0, beyond(off(found.value, to - from), rounding) / found.error);
    Some(())
}

/// Boxes, entered obliquely and along their faces.
fn cuboid(t: &mut Trial) -> Option<()> {
    let dice = &mut *t.dice;
    let size = dice.sized(-3.0, 3.0);
    let low = Point([0; 3].map(|_| size * dice.between(-2.0, 1.0)));
    let high = low + Point([0; 3].map(|_| size * dice.between(0.1, 1.0)));
    let cube = Aabb { low, high };
    let target = Point([0, 1, 2].map(|i| dice.between(low.0[i], high.0[i])));
    let mut slope = || dice.sign() * dice.sized(-12.0, 0.0);
    let axes = [1.0, slope(), slope()];
    let turn = dice.below(3);
    let direction = Point([0, 1, 2].map(|i| axes[(i + turn) % 3]));
    let away = dice.sized(0.0, 6.0) * size;
    t.place = format!("{direction:?} to {cube:?}");
    let unit = direction.normalised()?;
    let ray = Ray::new(target - unit * away, unit, 3.0 * away + 9.0 * size)?;
    let mut exact = [Wide::default(), Wide::from(ray.length)];
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
    let found = Bounds::Box(cube).ends(&ray);
    t.place = format!("{ray:?} in {cube:?}");
    let is_short = (exact[1] - exact[0]).high <= 1e-9 * ray.length;
    if is_short || Span::new(found[0].value, found[1].value).is_empty() {
        return None;
    }
    see_ends(t, found, exact);
    Some(())
}
