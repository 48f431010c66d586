//! Transmittance by weights and chances at collisions.
//!
//! The double particle model without a control is ratio tracking, with a constant one residual ratio
//! tracking; a transmittance curve is the same walk, read on its way.

use super::compare::{Averaged, Drawn, Known, compare, fly};
use super::precision::Precision;
use super::scene::Scene;
use super::{Entry, entry};
use crate::estimators::rules::{Collision, Null, Single, Weight};
use crate::media::Extinction;
use crate::stress::Dice;

/// A rule with a control of a share of the mean σ_t.
pub struct Product<R> {
    /// The rule.
    pub rule: R,
    /// `σ_c/τ`.
    pub control: f64,
}

impl<R: Collision> Averaged for Product<R> {
    fn known(&self, scene: &Scene) -> Option<Known> {
        let control = self.control * scene.depth;
        Some(Known {
            truth: (-scene.depth).exp(),
            variance: scene.of_product(control, &self.rule),
            drawn: Drawn::Within(scene.of_product(control, &Weight)),
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

/// Decomposition tracking: a flight of the least σ_t, then null collisions through the rest.
pub struct Decomposed;

impl Averaged for Decomposed {
    fn known(&self, scene: &Scene) -> Option<Known> {
        Some(Known {
            truth: (-scene.depth).exp(),
            variance: scene.depth.exp_m1(),
            drawn: Drawn::Within(scene.of_product(scene.least(), &Weight)),
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

const fn rule<R>(rule: R) -> Product<R> {
    Product { rule, control: 0.0 }
}

/// All of them.
pub const ALL: &[Entry] = &[
    entry!("ratio", |x| compare(&rule(Weight), x)),
    entry!("residual-ratio", |x| compare(&Product { rule: Weight, control: 1.0 }, x)),
    entry!("woodcock", |x| compare(&rule(Null), x)),
    entry!("decomposition", |x| compare(&Decomposed, x)),
    entry!("single (terminating)", |x| compare(&rule(Single::Terminating), x)),
    entry!("single (non-terminating, a = 0.7)", |x| {
        compare(&rule(Single::NonTerminating { albedo: 0.7 }), x)
    }),
    entry!("single (adaptive, a = 0.7)", |x| {
        compare(&rule(Single::Adaptive { albedo: 0.7 }), x)
    }),
    entry!("single (clamped)", |x| compare(&rule(Single::Clamped), x)),
    entry!("weighted-delta", |x| compare(&rule(Single::NonTerminating { albedo: 1.0 }), x)),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::Narrow as F32;
    use crate::stress::narrow::Trial;
    use crate::stress::narrow::precision::LATTICE;

    #[test]
    fn long_walks_fail_in_single_precision_and_short_ones_do_not() {
        let at = |collisions: f64, walks: f64| {
            let scene = Scene { depth: 2.0, collisions, from: 0.0 };
            compare(&rule(Weight), Trial { scene, seed: 1, budget: walks * collisions })
        };
        let (short, long) = (at(10.0, 2000.0), at(1e5, 8.0));
        assert!(short.bias.abs() < 1e-5, "{short:?}");
        assert!(long.bias.abs() > long.noise, "{long:?}");
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
