//! Transmittance by weights and chances at collisions and by other ways, and distances of free flights.
//!
//! The double particle model without a control is ratio tracking, with a constant one residual ratio
//! tracking; a transmittance curve is the same walk, read on its way.

use super::Entry;
use super::compare::{Estimator, Spread, Theory, flight, fly};
use super::precision::Precision;
use super::scene::{CELLS, Scene};
use super::trail::Trail;
use super::{EVERY, NO_STEPS};
use estimators::transmittance::next_flight::NextFlight;
use estimators::transmittance::unidirectional_mis::UnidirectionalMis;
use media::Extinction;
use theory::rules::{Collision, Null, Single, Weight};

/// All tentative collisions on the ray.
#[inline(always)]
fn collisions<P: Precision>(scene: &Scene, trail: &mut Trail, collide: impl FnMut(P)) {
    let ends = [scene.from, scene.from + 1.0, 1.0 / scene.collisions].map(P::of);
    fly(trail, ends, collide);
}

/// A rule with a control of a share of the mean σ_t.
struct Product<R> {
    rule: R,
    /// `σ_c/τ`.
    control: f64,
}

impl<R: Collision> Estimator for Product<R> {
    fn theory(&self, scene: &Scene) -> Theory {
        let control = self.control * scene.depth;
        let [variance, drawn] =
            [scene.of_product(control, &self.rule), scene.of_product(control, &Weight)];
        Theory::averaged(scene.transmittance(), variance, drawn)
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, trail: &mut Trail) -> f64 {
        let control = self.control * scene.depth;
        let path = P::of(1.0 / scene.collisions);
        let (mut weight, mut chance) = (P::of((-control).exp()), 1.0);
        collisions(scene, trail, |t: P| {
            let outcome = self.rule.at((scene.extinction(t) - control) * path);
            if R::DECIDES {
                chance *= outcome.survival.chance();
            }
            weight = weight * outcome.weight;
        });
        weight.double() * chance
    }
}

/// Decomposition tracking: a flight of the least σ_t, then null collisions through the rest.
struct Decomposed;

impl Estimator for Decomposed {
    fn theory(&self, scene: &Scene) -> Theory {
        let drawn = scene.of_product(scene.least(), &Weight);
        Theory::averaged(scene.transmittance(), scene.depth.exp_m1(), drawn)
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, trail: &mut Trail) -> f64 {
        let (control, path) = (scene.least(), P::of(1.0 / scene.collisions));
        let mut chance = passing::<P>(scene, control);
        collisions(scene, trail, |t: P| {
            chance *= Null.at((scene.extinction(t) - control) * path).survival.chance();
        });
        chance
    }
}

/// The chance that a flight through the control passes the end: the numbers for which it does are
/// those from some number on, which bisection finds.
fn passing<P: Precision>(scene: &Scene, control: f64) -> f64 {
    let [from, end, one, control] = [scene.from, scene.from + 1.0, 1.0, control].map(P::of);
    let passes = |word: u64| {
        let flown = -(one - P::uniform(word)).ln() / control;
        !(from + flown).below(end)
    };
    let (mut low, mut high) = (0, u64::MAX);
    if passes(0) {
        return 1.0;
    }
    while high - low > 1 {
        let middle = low.midpoint(high);
        if passes(middle) { high = middle } else { low = middle }
    }
    // Words from `high` on pass; the first of them is a multiple of the precision's grain.
    1.0 - high as f64 / 18_446_744_073_709_551_616.0
}

/// A rule by majorants of [`CELLS`] cells, crossed one by one.
struct Cells<R>(R);

impl<R: Collision> Estimator for Cells<R> {
    fn theory(&self, scene: &Scene) -> Theory {
        let drawn = scene.of_cells();
        let variance = if R::DECIDES { scene.depth.exp_m1() } else { drawn };
        Theory::averaged(scene.transmittance(), variance, drawn)
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, trail: &mut Trail) -> f64 {
        let (mut t, mut weight, mut chance) = (P::of(scene.from), P::of(1.0), 1.0);
        let mut left = flight::<P>(trail);
        for (cell, majorant) in scene.majorants.into_iter().enumerate() {
            let sampling = P::of(majorant);
            let edge = P::of(scene.from + (cell + 1) as f64 / CELLS as f64);
            loop {
                let reach = (edge - t) * sampling;
                if !left.below(reach) {
                    (left, t) = (left - reach, edge);
                    break;
                }
                t = t + left / sampling;
                let outcome = self.0.at(scene.extinction(t) / sampling);
                if R::DECIDES {
                    chance *= outcome.survival.chance();
                }
                weight = weight * outcome.weight;
                left = flight(trail);
            }
        }
        weight.double() * chance
    }
}

/// The distance to the first real collision, at most the ray's length.
struct Distance;

impl Estimator for Distance {
    fn theory(&self, scene: &Scene) -> Theory {
        let [truth, variance] = scene.of_distance();
        Theory::averaged(truth, variance, variance)
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, trail: &mut Trail) -> f64 {
        let [from, end, path] = [scene.from, scene.from + 1.0, 1.0 / scene.collisions].map(P::of);
        let (mut alive, mut distance) = (1.0, 0.0);
        fly(trail, [from, end, path], |t: P| {
            let survives = Null.at(scene.extinction(t) * path).survival.chance();
            distance += alive * (1.0 - survives) * (t - from).double();
            alive *= survives;
        });
        distance + alive * (end - from).double()
    }
}

/// Both ways to arrive at the end: next-flight, the chance to fly straight there, added at every collision;
/// or unidirectional MIS, weighted by the balance heuristic.
struct Arriving {
    is_shared: bool,
}

impl Estimator for Arriving {
    fn theory(&self, scene: &Scene) -> Theory {
        let variance = if self.is_shared {
            scene.of_source(&UnidirectionalMis)
        } else {
            scene.of_source(&NextFlight)
        };
        variance.map_or(Theory::UNKNOWN, |v| Theory::averaged(scene.transmittance(), v, v))
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, trail: &mut Trail) -> f64 {
        let (end, sampling) = (P::of(scene.from + 1.0), P::of(scene.collisions));
        let straight = |t: P| (-(sampling * (end - t))).exp();
        let share = |t: P| {
            let v = straight(t);
            if self.is_shared { v / (v + 1.0) } else { v }
        };
        let (mut weight, mut here) = (P::of(1.0), share(P::of(scene.from)));
        let mut score = if self.is_shared { P::of(0.0) } else { here };
        collisions(scene, trail, |t: P| {
            let left = weight * (P::of(1.0) - scene.extinction(t) / sampling);
            if self.is_shared {
                score = score + weight * here;
            }
            (weight, here) = (left, share(t));
            if !self.is_shared {
                score = score + weight * here;
            }
        });
        if self.is_shared { (score + weight * here * 2.0).double() } else { score.double() }
    }
}

/// Ray marching with a jitter, in as many steps as others have collisions; beside the noise of ratio
/// tracking, for its own is next to none.
struct Marching {
    /// Whether each step has an exponential of its own: regular tracking through such segments.
    by_segments: bool,
}

impl Estimator for Marching {
    fn theory(&self, scene: &Scene) -> Theory {
        let variance = scene.of_product(0.0, &Weight);
        let known = Theory::averaged(scene.transmittance(), variance, variance);
        Theory { spread: Spread::Useless, ..known }
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, trail: &mut Trail) -> f64 {
        let u = trail.uniform::<P>();
        let steps = scene.collisions.round().max(3.0);
        let (from, width) = (P::of(scene.from), P::of(1.0 / steps));
        let (mut sum, mut weight, mut j) = (P::of(0.0), P::of(1.0), 0.0);
        while j < steps {
            let extinction = scene.extinction(from + (u + j) * width);
            if self.by_segments {
                weight = weight * (-(extinction * width)).exp();
            } else {
                sum = sum + extinction;
            }
            j += 1.0;
        }
        (weight * (-(sum * width)).exp()).double()
    }
}

/// Free flight by inversion: Newton's steps on the optical depth, kept within brackets.
struct Inversion;

/// Newton's steps, more than doubles need.
const STEPS: u32 = 16;

impl Estimator for Inversion {
    fn theory(&self, scene: &Scene) -> Theory {
        Distance.theory(scene)
    }

    fn cost(&self, _: &Scene) -> Option<f64> {
        Some(2.0 * f64::from(STEPS))
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, trail: &mut Trail) -> f64 {
        let depth = flight::<P>(trail);
        let (zero, mut low, mut high) = (P::of(0.0), P::of(0.0), P::of(1.0));
        let (from, end) = (P::of(scene.from), P::of(scene.from + 1.0));
        if scene.depth_to(high).at_most(depth) {
            return (end - from).double();
        }
        let mut s = (depth / P::of(scene.depth)).or_less(high);
        for _ in 0..STEPS {
            let off = scene.depth_to(s) - depth;
            if off.below(zero) {
                low = s;
            } else {
                high = s;
            }
            let next = s - off / scene.extinction(s + scene.from);
            let is_within = low.at_most(next) && next.at_most(high);
            s = if is_within { next } else { (low + high) * 0.5 };
        }
        ((from + s) - from).double()
    }
}

const fn rule<R>(rule: R) -> Product<R> {
    Product { rule, control: 0.0 }
}

/// Those of weights and chances at collisions.
pub const PRODUCTS: &[Entry] = &[
    ("ratio", &rule(Weight), EVERY),
    ("residual-ratio", &Product { rule: Weight, control: 1.0 }, EVERY),
    ("woodcock", &rule(Null), EVERY),
    ("decomposition", &Decomposed, EVERY),
    ("single (terminating)", &rule(Single::Terminating), EVERY),
    ("single (non-terminating, a = 0.7)", &rule(Single::NonTerminating { albedo: 0.7 }), EVERY),
    ("single (adaptive, a = 0.7)", &rule(Single::Adaptive { albedo: 0.7 }), EVERY),
    ("single (clamped)", &rule(Single::Clamped), EVERY),
    ("weighted-delta", &rule(Single::NonTerminating { albedo: 1.0 }), EVERY),
];

/// The others.
pub const OTHERS: &[Entry] = &[
    ("ratio, local majorants", &Cells(Weight), EVERY),
    ("woodcock, local majorants", &Cells(Null), EVERY),
    ("woodcock, distance", &Distance, EVERY),
    ("inversion, distance", &Inversion, NO_STEPS),
    ("next-flight", &Arriving { is_shared: false }, EVERY),
    ("unidirectional-mis", &Arriving { is_shared: true }, EVERY),
    ("regular", &Marching { by_segments: true }, EVERY),
    ("ray-marching", &Marching { by_segments: false }, EVERY),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::narrow::precision::LATTICE;
    use numeric::Narrow as F32;

    #[test]
    fn a_flight_through_the_control_passes_with_its_chance() {
        let scene = Scene::new(2.0, 9.0, 0.0);
        let control = scene.least();
        let exact = (-control).exp();
        assert!((passing::<f64>(&scene, control) - exact).abs() < 1e-15);
        let narrow = passing::<F32>(&scene, control);
        assert!((narrow - exact).abs() < 1e-6 && (narrow * LATTICE).fract() == 0.0, "{narrow}");
    }
}
