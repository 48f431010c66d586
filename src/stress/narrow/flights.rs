//! Transmittance by other ways, and distances of free flights.

use super::compare::{Averaged, Drawn, Known, compare, flight, fly};
use super::precision::Precision;
use super::scene::{CELLS, Scene};
use super::{Entry, NO_STEPS, entry};
use crate::estimators::rules::{Collision, Null, Weight};
use crate::estimators::transmittance::next_flight::NextFlight;
use crate::estimators::transmittance::unidirectional_mis::UnidirectionalMis;
use crate::media::Extinction;
use crate::stress::Dice;

/// A rule by majorants of [`CELLS`] cells, crossed one by one.
pub struct Cells<R>(R);

impl<R: Collision> Averaged for Cells<R> {
    fn known(&self, scene: &Scene) -> Option<Known> {
        let drawn = scene.of_cells();
        let variance = if R::DECIDES { scene.depth.exp_m1() } else { drawn };
        Some(Known { truth: (-scene.depth).exp(), variance, drawn: Drawn::Within(drawn) })
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, dice: &mut Dice) -> f64 {
        let majorants = scene.majorants();
        let (mut t, mut weight, mut chance) = (P::of(scene.from), P::of(1.0), 1.0);
        let mut left = flight::<P>(dice);
        for (cell, majorant) in majorants.into_iter().enumerate() {
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
                left = flight(dice);
            }
        }
        weight.double() * chance
    }
}
/// The distance to the first real collision, at most the ray's length.
pub struct Distance;

impl Averaged for Distance {
    fn known(&self, scene: &Scene) -> Option<Known> {
        let [truth, variance] = scene.of_distance();
        Some(Known { truth, variance, drawn: Drawn::Within(variance) })
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, dice: &mut Dice) -> f64 {
        let start = P::uniform(0);
        let (from, path) = (start.each(scene.from), start.each(1.0 / scene.collisions));
        let (mut alive, mut distance) = (1.0, 0.0);
        fly(scene, dice, |t: P| {
            let survives = Null.at(scene.extinction(t) * path).survival.chance();
            distance += alive * (1.0 - survives) * (t - from).double();
            alive *= survives;
        });
        distance + alive * (start.each(scene.from + 1.0) - from).double()
    }
}
/// Next-flight: the chance to fly straight to the end, added at every collision.
pub struct Next;

impl Averaged for Next {
    fn known(&self, scene: &Scene) -> Option<Known> {
        let variance = scene.of_source(&NextFlight)?;
        Some(Known { truth: (-scene.depth).exp(), variance, drawn: Drawn::Within(variance) })
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, dice: &mut Dice) -> f64 {
        let start = P::uniform(0);
        let (end, sampling) = (start.each(scene.from + 1.0), start.each(scene.collisions));
        let straight = |t: P| (-(sampling * (end - t))).exp();
        let (mut weight, mut score) = (start.each(1.0), straight(start.each(scene.from)));
        fly(scene, dice, |t: P| {
            weight = weight * (start.each(1.0) - scene.extinction(t) / sampling);
            score = score + weight * straight(t);
        });
        score.double()
    }
}

/// Unidirectional MIS: both ways to arrive, weighted by the balance heuristic.
pub struct Shared;

impl Averaged for Shared {
    fn known(&self, scene: &Scene) -> Option<Known> {
        let variance = scene.of_source(&UnidirectionalMis)?;
        Some(Known { truth: (-scene.depth).exp(), variance, drawn: Drawn::Within(variance) })
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, dice: &mut Dice) -> f64 {
        let start = P::uniform(0);
        let (end, sampling) = (start.each(scene.from + 1.0), start.each(scene.collisions));
        let share = |t: P| {
            let v = (-(sampling * (end - t))).exp();
            v / (v + 1.0)
        };
        let (mut weight, mut score) = (start.each(1.0), start.each(0.0));
        let mut here = share(start.each(scene.from));
        fly(scene, dice, |t: P| {
            score = score + weight * here;
            weight = weight * (start.each(1.0) - scene.extinction(t) / sampling);
            here = share(t);
        });
        (score + weight * here * 2.0).double()
    }
}
/// Ray marching with a jitter, in as many steps as others have collisions; beside the noise of ratio
/// tracking, for its own is next to none.
pub struct Marching {
    /// Whether each step has an exponential of its own: regular tracking through such segments.
    by_segments: bool,
}

impl Averaged for Marching {
    fn known(&self, scene: &Scene) -> Option<Known> {
        let variance = scene.of_product(0.0, &Weight);
        Some(Known { truth: (-scene.depth).exp(), variance, drawn: Drawn::Biased })
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, dice: &mut Dice) -> f64 {
        let u = P::uniform(dice.word());
        let steps = scene.collisions.round().max(3.0);
        let (from, width) = (u.each(scene.from), u.each(1.0 / steps));
        let (mut sum, mut weight, mut j) = (u.each(0.0), u.each(1.0), 0.0);
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
pub struct Inversion;

impl Averaged for Inversion {
    fn known(&self, scene: &Scene) -> Option<Known> {
        Distance.known(scene)
    }

    fn cost(&self, _: &Scene) -> f64 {
        2.0 * f64::from(STEPS)
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, dice: &mut Dice) -> f64 {
        let depth = flight::<P>(dice);
        let (mut low, mut high) = (depth.each(0.0), depth.each(1.0));
        let (from, end) = (depth.each(scene.from), depth.each(scene.from + 1.0));
        if scene.depth_to(high).at_most(depth) {
            return (end - from).double();
        }
        let mut s = (depth / depth.each(scene.depth)).or_less(high);
        for _ in 0..STEPS {
            let off = scene.depth_to(s) - depth;
            if off.below(depth.each(0.0)) {
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

/// Newton's steps, more than doubles need.
const STEPS: u32 = 16;

/// All of them.
pub const ALL: &[Entry] = &[
    entry!("ratio, local majorants", |x| compare(&Cells(Weight), x)),
    entry!("woodcock, local majorants", |x| compare(&Cells(Null), x)),
    entry!("woodcock, distance", |x| compare(&Distance, x)),
    entry!("inversion, distance", |x| compare(&Inversion, x), NO_STEPS),
    entry!("next-flight", |x| compare(&Next, x)),
    entry!("unidirectional-mis", |x| compare(&Shared, x)),
    entry!("regular", |x| compare(&Marching { by_segments: true }, x)),
    entry!("ray-marching", |x| compare(&Marching { by_segments: false }, x)),
];
