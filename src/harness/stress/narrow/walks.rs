//! The estimators' draws, generic over the precision.
//!
//! Where a number decides whether a walk goes on, the walk goes on with the chance that it does: the
//! mean over all decisions at these collisions, exactly as the precision decides.
//!
//! ```text
//! X = weight · ∏ P(u < q),   in single precision P(u < q) = ⌈2²⁴ q⌉/2²⁴
//! ```

use super::precision::Precision;
use super::scene::{CELLS, Scene};
use crate::estimators::rules::{Collision, Null, Single, Weight};
use crate::estimators::transmittance::next_flight::NextFlight;
use crate::estimators::transmittance::unidirectional_mis::UnidirectionalMis;
use crate::harness::stress::Dice;
use crate::media::Extinction;
use crate::numeric::Narrow as F32;

/// What theory says of a draw.
#[derive(Debug, Clone, Copy)]
pub struct Known {
    /// The mean.
    pub truth: f64,
    /// `V/truth²` of the estimator.
    pub variance: f64,
    /// The same of what is drawn here, at most; `None` for biased ones.
    pub drawn: Option<f64>,
}

/// An estimator in either precision.
pub trait Estimator: Sync {
    /// What theory says; `None` where it has lost the variance.
    fn known(&self, scene: &Scene) -> Option<Known>;
    /// A draw, with decisions averaged.
    fn draw<P: Precision>(&self, scene: &Scene, dice: &mut Dice) -> f64;
}

/// A flight of an optical depth of mean 1; 1 − u lies in (0, 1].
#[inline(always)]
fn flight<P: Precision>(dice: &mut Dice) -> P {
    let u = P::uniform(dice.word());
    -(u.each(1.0) - u).ln()
}

/// All tentative collisions of a constant σ̂.
#[inline(always)]
fn fly<P: Precision>(scene: &Scene, dice: &mut Dice, mut collide: impl FnMut(P)) {
    let start = P::uniform(0);
    let (end, path) = (start.each(scene.from + 1.0), start.each(1.0 / scene.collisions));
    let mut t = start.each(scene.from);
    loop {
        t = t + flight::<P>(dice) * path;
        if !t.below(end) {
            return;
        }
        collide(t);
    }
}

/// A rule with a control of a share of the mean σ_t.
pub struct Product<R> {
    /// The rule.
    pub rule: R,
    /// `σ_c/τ`.
    pub control: f64,
}

impl<R: Collision> Estimator for Product<R> {
    fn known(&self, scene: &Scene) -> Option<Known> {
        let control = self.control * scene.depth;
        Some(Known {
            truth: (-scene.depth).exp(),
            variance: scene.of_product(control, &self.rule),
            drawn: Some(scene.of_product(control, &Weight)),
        })
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, dice: &mut Dice) -> f64 {
        let control = self.control * scene.depth;
        let start = P::uniform(0);
        let path = start.each(1.0 / scene.collisions);
        let (mut weight, mut chance) = (start.each((-control).exp()), 1.0);
        fly(scene, dice, |t: P| {
            let outcome = self.rule.at((scene.extinction(t) - control) * path);
            if R::DECIDES {
                chance *= outcome.survival.chance();
            }
            weight = weight * outcome.weight;
        });
        weight.double() * chance
    }
}

/// Ratio tracking by majorants of [`CELLS`] cells, crossed one by one.
pub struct Cells;

impl Estimator for Cells {
    fn known(&self, scene: &Scene) -> Option<Known> {
        let variance = scene.of_cells();
        Some(Known { truth: (-scene.depth).exp(), variance, drawn: Some(variance) })
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, dice: &mut Dice) -> f64 {
        let start = P::uniform(0);
        let majorants = scene.majorants();
        let (mut t, mut weight) = (start.each(scene.from), start.each(1.0));
        let mut left = flight::<P>(dice);
        for (cell, majorant) in majorants.into_iter().enumerate() {
            let sampling = start.each(majorant);
            let edge = start.each(scene.from + (cell + 1) as f64 / CELLS as f64);
            loop {
                let reach = (edge - t) * sampling;
                if !left.below(reach) {
                    (left, t) = (left - reach, edge);
                    break;
                }
                t = t + left / sampling;
                weight = weight * (start.each(1.0) - scene.extinction(t) / sampling);
                left = flight(dice);
            }
        }
        weight.double()
    }
}

/// Decomposition tracking: a flight of the least σ_t, then null collisions through the rest.
pub struct Decomposed;

impl Estimator for Decomposed {
    fn known(&self, scene: &Scene) -> Option<Known> {
        Some(Known {
            truth: (-scene.depth).exp(),
            variance: scene.depth.exp_m1(),
            drawn: Some(scene.of_product(scene.least(), &Weight)),
        })
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, dice: &mut Dice) -> f64 {
        let start = P::uniform(0);
        let (control, path) = (scene.least(), start.each(1.0 / scene.collisions));
        let mut chance = passing::<P>(scene, control);
        fly(scene, dice, |t: P| {
            chance *= Null.at((scene.extinction(t) - control) * path).survival.chance();
        });
        chance
    }
}

/// The chance that a flight through the control passes the end: the numbers for which it does are
/// those from some number on, which bisection finds.
fn passing<P: Precision>(scene: &Scene, control: f64) -> f64 {
    let start = P::uniform(0);
    let end = start.each(scene.from + 1.0);
    let passes = |word: u64| {
        let u = P::uniform(word);
        let flown = -(u.each(1.0) - u).ln() / u.each(control);
        !(u.each(scene.from) + flown).below(end)
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

/// The distance to the first real collision, at most the ray's length.
pub struct Distance;

impl Estimator for Distance {
    fn known(&self, scene: &Scene) -> Option<Known> {
        let [truth, variance] = scene.of_distance();
        Some(Known { truth, variance, drawn: Some(variance) })
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

impl Estimator for Next {
    fn known(&self, scene: &Scene) -> Option<Known> {
        let variance = scene.of_source(&NextFlight)?;
        Some(Known { truth: (-scene.depth).exp(), variance, drawn: Some(variance) })
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

impl Estimator for Shared {
    fn known(&self, scene: &Scene) -> Option<Known> {
        let variance = scene.of_source(&UnidirectionalMis)?;
        Some(Known { truth: (-scene.depth).exp(), variance, drawn: Some(variance) })
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
pub struct Marching;

impl Estimator for Marching {
    fn known(&self, scene: &Scene) -> Option<Known> {
        let variance = scene.of_product(0.0, &Weight);
        Some(Known { truth: (-scene.depth).exp(), variance, drawn: None })
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, dice: &mut Dice) -> f64 {
        let u = P::uniform(dice.word());
        let steps = scene.collisions.round().max(3.0);
        let (from, width) = (u.each(scene.from), u.each(1.0 / steps));
        let (mut sum, mut j) = (u.each(0.0), 0.0);
        while j < steps {
            sum = sum + scene.extinction(from + (u + j) * width);
            j += 1.0;
        }
        (-(sum * width)).exp().double()
    }
}

/// What walks from the same words gave.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sums {
    /// How many.
    pub walks: f64,
    /// Σ X/truth in doubles.
    pub double: f64,
    /// Σ (X₂₄ − X₅₃)/truth and its square.
    pub difference: [f64; 2],
}

/// Compares both precisions on a scene, from a seed, over so many walks.
pub type Comparison = fn(Scene, u64, u64) -> (Option<Known>, Sums);

fn compare<E: Estimator>(
    estimator: &E,
    scene: Scene,
    seed: u64,
    walks: u64,
) -> (Option<Known>, Sums) {
    let known = estimator.known(&scene);
    let truth = known.map_or(1.0, |known| known.truth);
    let mut sums = Sums::default();
    for number in 0..walks {
        let dice = || Dice::new(seed, "narrow", number);
        let double = estimator.draw::<f64>(&scene, &mut dice()) / truth;
        let off = estimator.draw::<F32>(&scene, &mut dice()) / truth - double;
        sums.walks += 1.0;
        sums.double += double;
        sums.difference[0] += off;
        sums.difference[1] += off * off;
    }
    (known, sums)
}

const fn rule<R>(rule: R) -> Product<R> {
    Product { rule, control: 0.0 }
}

/// Every estimator.
pub const ESTIMATORS: [(&str, Comparison); 14] = [
    ("ratio", |scene, seed, walks| compare(&rule(Weight), scene, seed, walks)),
    ("residual-ratio", |scene, seed, walks| {
        compare(&Product { rule: Weight, control: 1.0 }, scene, seed, walks)
    }),
    ("ratio, local majorants", |scene, seed, walks| compare(&Cells, scene, seed, walks)),
    ("woodcock", |scene, seed, walks| compare(&rule(Null), scene, seed, walks)),
    ("woodcock, distance", |scene, seed, walks| compare(&Distance, scene, seed, walks)),
    ("decomposition", |scene, seed, walks| compare(&Decomposed, scene, seed, walks)),
    ("single (terminating)", |scene, seed, walks| {
        compare(&rule(Single::Terminating), scene, seed, walks)
    }),
    ("single (non-terminating, a = 0.7)", |scene, seed, walks| {
        compare(&rule(Single::NonTerminating { albedo: 0.7 }), scene, seed, walks)
    }),
    ("single (adaptive, a = 0.7)", |scene, seed, walks| {
        compare(&rule(Single::Adaptive { albedo: 0.7 }), scene, seed, walks)
    }),
    ("single (clamped)", |scene, seed, walks| compare(&rule(Single::Clamped), scene, seed, walks)),
    ("weighted-delta", |scene, seed, walks| {
        compare(&rule(Single::NonTerminating { albedo: 1.0 }), scene, seed, walks)
    }),
    ("next-flight", |scene, seed, walks| compare(&Next, scene, seed, walks)),
    ("unidirectional-mis", |scene, seed, walks| compare(&Shared, scene, seed, walks)),
    ("ray-marching", |scene, seed, walks| compare(&Marching, scene, seed, walks)),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::harness::stress::narrow::DRAWS;
    use crate::harness::stress::narrow::precision::LATTICE;

    #[test]
    fn long_walks_fail_in_single_precision_and_short_ones_do_not() {
        let at = |collisions: f64, walks| {
            let scene = Scene { depth: 2.0, collisions, from: 0.0 };
            compare(&rule(Weight), scene, 1, walks)
        };
        let ((_, short), (known, long)) = (at(10.0, 2000), at(1e5, 6));
        let bias = |sums: &Sums| (sums.difference[0] / sums.walks).abs();
        assert!(bias(&short) < 1e-5, "{short:?}");
        let noise = known.expect("known").variance.sqrt() / DRAWS.sqrt();
        assert!(bias(&long) > noise, "{long:?}");
    }

    #[test]
    fn doubles_find_the_mean_of_every_unbiased_estimator() {
        for depth in [0.3, 4.0] {
            let scene = Scene { depth, collisions: 9.0 * depth, from: 2.0 };
            for (name, comparison) in ESTIMATORS {
                let (known, sums) = comparison(scene, 7, 4000);
                let Some(Known { drawn: Some(variance), .. }) = known else {
                    assert_eq!(name, "ray-marching");
                    continue;
                };
                let z = (sums.double / sums.walks - 1.0) / (variance / sums.walks).sqrt();
                assert!(z.abs() < 5.0, "{name} at τ = {depth}: {z}");
            }
        }
    }

    #[test]
    fn a_flight_through_the_control_passes_with_its_chance() {
        let scene = Scene { depth: 2.0, collisions: 9.0, from: 0.0 };
        let control = scene.least();
        let exact = (-control).exp();
        assert!((passing::<f64>(&scene, control) - exact).abs() < 1e-15);
        let narrow = passing::<F32>(&scene, control);
        assert!((narrow - exact).abs() < 1e-6 && (narrow * LATTICE).fract() == 0.0, "{narrow}");
    }
}
