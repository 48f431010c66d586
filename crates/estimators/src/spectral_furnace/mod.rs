//! Walks into a furnace in several channels, all of them by one draw.

pub mod hero;
pub mod independent;
pub mod spectral_mis;
pub mod spectral_tracking;
pub mod walk;

use fearless_simd::Level;

use self::walk::InFurnace;
use super::chromatic::{Chromatic, WalkEvents, WalkerWeights};
use crate::setup::walker::Walker;
use crate::walks::Walk;
use crate::{Refusal, Setup, estimators};
use ::theory::Prediction;
use ::theory::colours::rates::Rates;
use ::theory::problems::SpectralFurnace;
use ::theory::space::furnace as theory;
use media::Batches;
use numeric::digits::rounded;

/// Maximum expected number of collisions on a straight line through the volume; more are a mistake in the case.
const MAX_COLLISIONS: f64 = 1e4;
/// Relative increase of bounds on σ_t, because lookups are rounded.
const SLACK: f64 = 1e-9;

/// Checks that each channel has a constant σ̂ ≥ σ_t everywhere in the volume.
fn realisable(setup: &Setup<SpectralFurnace>) -> Result<(), Refusal> {
    let across = setup.problem.bounds.diameter();
    let within = setup.problem.bounds.enclosing_box();
    let channels = setup.fields.iter().zip(&setup.problem.channels);
    for (number, (channel, medium)) in (1..).zip(channels) {
        let maximum = within.map_or(f64::INFINITY, |within| medium.volume.majorant(&within));
        if maximum > channel.majorant * (1.0 + SLACK) {
            let [majorant, maximum] = [channel.majorant, maximum].map(rounded);
            let actual =
                format!("σ̂ = {majorant} and σ_t is bounded by {maximum} in channel {number}");
            return Err(Refusal::mismatch("σ̂ ≥ σ_t everywhere in the volume", actual));
        }
        let collisions = channel.majorant * across;
        if collisions.is_nan() || collisions > MAX_COLLISIONS {
            let actual = format!("it may be {collisions:e} in channel {number}");
            return Err(Refusal::mismatch("∫σ̂ ≤ 1e4 straight through the volume", actual));
        }
    }
    Ok(())
}

impl Chromatic for SpectralFurnace {
    #[inline(always)]
    fn walk<'a>(
        steps: impl WalkEvents,
        by: WalkerWeights<'a>,
        setup: &'a Setup<Self>,
        fields: &'a [Batches<'a>],
    ) -> impl Walk {
        InFurnace::new(steps, by, setup, fields)
    }

    fn fields(setup: &Setup<Self>, level: Level) -> Vec<Batches<'_>> {
        setup.problem.channels.iter().map(|own| own.volume.batches(level, false)).collect()
    }

    fn require(setup: &Setup<Self>, walker: &Walker) -> Result<(), Refusal> {
        walker.require(&setup.fields)?;
        let phases: Vec<_> = setup.problem.channels.iter().map(|channel| channel.phase).collect();
        walker.require_phases(&phases)?;
        realisable(setup)
    }

    fn second_moment_bounds(setup: &Setup<Self>, walker: &Walker) -> Result<Vec<f64>, Refusal> {
        let problem = &setup.problem;
        let values = problem.channels.iter().map(|channel| channel.volume.facts().single_value);
        let Some(extinctions) = values.collect::<Option<Vec<f64>>>() else {
            let needs = "one σ_t in each channel: of fields, theory does not bound the variance";
            return Err(Refusal::mismatch(needs, "σ_t varies"));
        };
        let majorants = setup.fields.iter().map(|channel| channel.majorant).collect();
        let rates = Rates { majorants, albedos: problem.albedos.clone() };
        let phases: Vec<_> = problem.channels.iter().map(|channel| channel.phase).collect();
        walker.second_moment_bounds(&phases, |walk, channel, phi| {
            theory::second_moment_bound(problem, &rates, &extinctions, (walk, channel, phi))
        })
    }

    fn predict_independent(_: &Setup<Self>, heroes: &[f64]) -> Prediction {
        theory::independent(heroes)
    }

    fn predict_balanced(_: &Setup<Self>, heroes: &[f64]) -> Prediction {
        theory::balanced(heroes)
    }

    fn predict_relative(_: &Setup<Self>, _: &Walker, second_moment_bounds: &[f64]) -> Prediction {
        theory::relative(second_moment_bounds)
    }
}

estimators! {
    SpectralFurnace on ChannelMedia:
    independent::Independent,
    hero::Hero,
    spectral_tracking::SpectralTracking,
    spectral_mis::SpectralMis,
}
