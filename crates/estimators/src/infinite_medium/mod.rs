//! Walks from a point source in an infinite medium.

pub mod particle;

use crate::recipes::inequality;
use crate::space::tally::CollisionTally;
use crate::space::{ParticleSettings, Tally, Walked};
use crate::{Draw, Refusal, Setup, estimators};
use numeric::Lane;
use numeric::geometry::Point;
use numeric::rng::Random;
use theory::problems::infinite_medium::{MAX_RADII, Values};
use theory::problems::{InfiniteMedium, Scene};
use theory::space::predict;
use theory::{ParticleRule, Prediction};

/// Maximum expected number of collisions in a walk; more are a mistake in the case.
const MAX_COLLISIONS: f64 = 1e5;

/// The probability that a tentative collision ends the walk, if it is equal for all of them.
fn end(setup: &Setup<InfiniteMedium>, particle: &ParticleSettings) -> Option<f64> {
    let plain = *particle == ParticleSettings::of(particle.rule);
    let probabilities = particle.rule.probabilities(ratio(setup)?, setup.problem.albedo());
    plain.then_some(1.0 - probabilities.transmit - probabilities.scatter)
}

/// `r`, if it is constant.
fn ratio(setup: &Setup<InfiniteMedium>) -> Option<f64> {
    Some(setup.problem.extinction / setup.fields.single_value()?)
}

impl Walked for InfiniteMedium {
    type Tally<'a> = Within<'a>;

    /// Checks that walks end and that no weight grows.
    fn domain(setup: &Setup<Self>, particle: &ParticleSettings) -> Result<(), Refusal> {
        use ParticleRule::{Analog, Terminating};
        let albedo = setup.problem.albedo();
        if albedo >= 1.0 {
            return Err(Refusal::mismatch("an albedo below 1", "nothing is ever absorbed"));
        }
        let Some(ratio) = ratio(setup) else {
            return Err(Refusal::mismatch("a constant σ̂", "it varies"));
        };
        if 1.0 / ((1.0 - albedo) * ratio) > MAX_COLLISIONS {
            let needs = "at most 1e5 tentative collisions a walk";
            return Err(Refusal::mismatch(needs, format!("a = {albedo} and r = {ratio}")));
        }
        let limit = particle.rule.limits(albedo)[1];
        if ratio > limit * (1.0 + 1e-12) {
            let actual = format!("σ_t is {ratio:.6} times σ̂");
            return Err(Refusal::mismatch(inequality(particle.rule.range()), actual));
        }
        let ends = matches!(particle.rule, Terminating | Analog);
        if !ends && particle.roulette.is_none() {
            let needs = "walks that end: `terminating`, `analog`, or `roulette`";
            return Err(Refusal::mismatch(needs, format!("`{}` never does", particle.rule.name())));
        }
        if ends && end(setup, particle).is_some_and(|end| end * MAX_COLLISIONS < 1.0) {
            return Err(Refusal::mismatch("r < 2/(a + 1)", "the walk hardly ever ends"));
        }
        let grows = ratio > 1.0 && particle.rule != Terminating;
        if grows {
            let needs = "σ̂ ≥ σ_t, where weights do not grow";
            return Err(Refusal::mismatch(needs, format!("σ_t is {ratio:.6} times σ̂")));
        }
        Ok(())
    }

    fn predict(setup: &Setup<Self>, particle: &ParticleSettings) -> Prediction {
        predict::infinite(&setup.problem, end(setup, particle), ratio(setup))
    }

    fn scene(&self) -> &Scene {
        &self.scene
    }

    fn tally<'a>(setup: &'a Setup<Self>, _: &ParticleSettings) -> Result<Within<'a>, Draw<Values>> {
        Ok(Within(&setup.problem))
    }
}

/// Maximum number of sums of a draw.
const SUMS: usize = MAX_RADII + 2;

/// Collisions within each radius, then the squared distance and the collisions.
pub struct Within<'a>(&'a InfiniteMedium);

impl Tally for Within<'_> {
    type Found<L: Lane> = [L; SUMS];

    #[inline(always)]
    fn nothing<L: Lane>(&self, zero: L) -> [L; SUMS] {
        [zero; SUMS]
    }

    #[inline(always)]
    fn channels(&self) -> usize {
        self.0.radii.len() + 2
    }

    #[inline(always)]
    fn value<L: Lane>(&self, sums: &[L; SUMS], channel: usize) -> L {
        let radii = self.0.radii.len();
        L::one_of(sums, if channel < radii { channel } else { MAX_RADII + channel - radii })
    }

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> [[L; 3]; 2] {
        [Point([0.0; 3]).each(one), Point([0.0, 0.0, 1.0]).each(one)]
    }

    fn begins_turned(&self) -> bool {
        true
    }

    #[inline(always)]
    fn collided<L: Lane>(&self, sums: &mut [L; SUMS], at: &CollisionTally<L>) {
        let real = at.weight * at.ratio;
        let [x, y, z] = at.place;
        let square = x * x + y * y + z * z;
        // A constant number of steps, so that the compiler resolves the indices: a variable index needs memory.
        for (number, sum) in sums.iter_mut().enumerate().take(MAX_RADII) {
            if let Some(radius) = self.0.radii.get(number) {
                sum.add_where(at.inside & square.below(square.each(radius * radius)), real);
            }
        }
        sums[MAX_RADII].add_where(at.inside, real * at.albedo.one_minus() * square);
        sums[MAX_RADII + 1].add_where(at.inside, real);
    }
}

estimators! {
    InfiniteMedium on Space:
    particle::Walker,
}
