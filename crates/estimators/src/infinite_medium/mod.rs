//! Walks from a point source in an infinite medium.

pub mod particle;

use crate::space::tally::Collision;
use crate::space::{Particle, Tally, Walked};
use crate::{Draw, Refusal, Setup, estimators};
use numeric::geometry::Point;
use numeric::rng::Random;
use numeric::{Grade, Known, Lane};
use theory::problems::infinite_medium::{MOST_RADII, Values};
use theory::problems::{InfiniteMedium, Scene};
use theory::space::infinite;
use theory::{Channel, CountLaw, Moments, ParticleRule, Prediction, Tails};

/// Maximum expected number of collisions in a walk; more are a mistake in the case.
const MOST_COLLISIONS: f64 = 1e5;

/// The probability that a tentative collision ends the walk, if it is equal for all of them.
fn end(setup: &Setup<InfiniteMedium>, particle: &Particle) -> Option<f64> {
    let plain = *particle == Particle::of(particle.rule);
    let odds = particle.rule.odds(ratio(setup)?, setup.problem.albedo());
    plain.then_some(1.0 - odds.transmit - odds.scatter)
}

/// `r`, if it is constant.
fn ratio(setup: &Setup<InfiniteMedium>) -> Option<f64> {
    Some(setup.problem.extinction / setup.fields.single_value()?)
}

/// Moments of a multiple of the number of collisions up to one that ends the walk, with probability p each:
/// mean 1/p, variance (1 − p)/p², skewness (2 − p)/√(1 − p), kurtosis 9 + p²/(1 − p).
fn geometric(mean: f64, end: f64) -> Moments {
    let rest = 1.0 - end;
    let relative = [rest, (2.0 - end) * rest, (9.0 * rest + end * end) * rest];
    Moments { scale: mean, relative, error: 1e-14, grade: Grade::Proven }
}

impl Walked for InfiniteMedium {
    type Tally<'a> = Within<'a>;

    /// Checks that walks end and that no weight grows.
    fn domain(setup: &Setup<Self>, particle: &Particle) -> Result<(), Refusal> {
        use ParticleRule::{Analog, Terminating};
        let albedo = setup.problem.albedo();
        if albedo >= 1.0 {
            return Err(Refusal::mismatch("an albedo below 1", "nothing is ever absorbed"));
        }
        let Some(ratio) = ratio(setup) else {
            return Err(Refusal::mismatch("a constant σ̂", "it varies"));
        };
        if 1.0 / ((1.0 - albedo) * ratio) > MOST_COLLISIONS {
            let needs = "at most 1e5 tentative collisions a walk";
            return Err(Refusal::mismatch(needs, format!("a = {albedo} and r = {ratio}")));
        }
        let limit = particle.rule.limits(albedo)[1];
        if ratio > limit * (1.0 + 1e-12) {
            let found = format!("σ_t is {ratio:.6} times σ̂");
            return Err(Refusal::mismatch(particle.rule.needs(), found));
        }
        let ends = matches!(particle.rule, Terminating | Analog);
        if !ends && particle.roulette.is_none() {
            let needs = "walks that end: `terminating`, `analog`, or `roulette`";
            return Err(Refusal::mismatch(needs, format!("`{}` never does", particle.rule.name())));
        }
        if ends && end(setup, particle).is_some_and(|end| end * MOST_COLLISIONS < 1.0) {
            return Err(Refusal::mismatch("r < 2/(a + 1)", "the walk hardly ever ends"));
        }
        let grows = ratio > 1.0 && particle.rule != Terminating;
        if grows {
            let needs = "σ̂ ≥ σ_t, where weights do not grow";
            return Err(Refusal::mismatch(needs, format!("σ_t is {ratio:.6} times σ̂")));
        }
        Ok(())
    }

    fn predict(setup: &Setup<Self>, particle: &Particle) -> Prediction {
        let problem = &setup.problem;
        let (sigma, albedo) = (problem.extinction, problem.albedo());
        let unknown = |name: String, truth: Known| {
            let certain = Channel::unbiased(truth, Moments::certain(truth.value), Tails::LIGHT);
            Channel { name, moments: None, pilot_variance_allowed: true, ..certain }
        };
        let rounded = |value: f64| Known::new(value, infinite::ROUNDING * value.abs());
        let mut channels: Vec<Channel> = problem
            .radii
            .iter()
            .map(|&radius| {
                let truth = infinite::collisions_within(albedo, sigma * radius);
                unknown(format!("collisions within {radius}"), truth)
            })
            .collect();
        let cosine = problem.scene.phase.moment(1);
        let square = infinite::square_at_absorption(albedo, cosine) / (sigma * sigma);
        channels.push(unknown("squared distance".to_owned(), rounded(square)));
        let collisions = unknown("collisions".to_owned(), rounded(1.0 / (1.0 - albedo)));
        // Where every collision is real and nothing is scattered, there is exactly one.
        let is_certain = albedo == 0.0 && ratio(setup) == Some(1.0);
        let end =
            if is_certain { Some(1.0) } else { end(setup, particle).filter(|&end| end > 0.0) };
        let is_majorant = ratio(setup).is_some_and(|ratio| ratio <= 1.0);
        // A real collision counts r: then the score of a walk depends only on its length.
        channels.push(match end.filter(|_| is_majorant) {
            Some(end) => {
                let truth = collisions.truth;
                Channel {
                    moments: Some(geometric(truth.value, end)),
                    pilot_variance_allowed: false,
                    ..collisions
                }
            }
            None => collisions,
        });
        let lookups = end.map(|end| {
            let moments = geometric(1.0 / end, end);
            let (variance, kurtosis) = (moments.variance(), moments.kurtosis().unwrap_or(1.0));
            let pmf = Vec::new();
            CountLaw { mean: 1.0 / end, variance, error: 1e-14, kurtosis, poisson: false, pmf }
        });
        let lookups =
            lookups.map(|law| if law.variance > 0.0 { law } else { CountLaw::always(1.0) });
        Prediction { channels, lookups, ..Prediction::default() }
    }

    fn scene(&self) -> &Scene {
        &self.scene
    }

    fn tally<'a>(setup: &'a Setup<Self>, _: &Particle) -> Result<Within<'a>, Draw<Values>> {
        Ok(Within(&setup.problem))
    }
}

/// Maximum number of sums of a draw.
const SUMS: usize = MOST_RADII + 2;

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
        L::one_of(sums, if channel < radii { channel } else { MOST_RADII + channel - radii })
    }

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> [[L; 3]; 2] {
        [Point([0.0; 3]).each(one), Point([0.0, 0.0, 1.0]).each(one)]
    }

    fn begins_turned(&self) -> bool {
        true
    }

    #[inline(always)]
    fn collided<L: Lane>(&self, sums: &mut [L; SUMS], at: &Collision<L>) {
        let real = at.weight * at.ratio;
        let [x, y, z] = at.place;
        let square = x * x + y * y + z * z;
        // A constant number of steps, so that the compiler resolves the indices: a variable index needs memory.
        for (number, sum) in sums.iter_mut().enumerate().take(MOST_RADII) {
            if let Some(radius) = self.0.radii.get(number) {
                sum.add_where(at.inside & square.below(square.each(radius * radius)), real);
            }
        }
        sums[MOST_RADII].add_where(at.inside, real * at.albedo.one_minus() * square);
        sums[MOST_RADII + 1].add_where(at.inside, real);
    }
}

estimators! {
    InfiniteMedium on Space:
    particle::Walker,
}
