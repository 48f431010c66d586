//! Estimators of single scattering of a point light in several channels, all of them by one draw.

pub mod independent;
pub mod spectral_mis;
pub mod walk;

use crate::catalogue::{Settings, rounded};
use crate::estimators::single_scattering::delta_tracking::{Absorption, DeltaTracking};
use crate::estimators::{Refusal, Setup, estimators};
use crate::media::Control;
use crate::problems::SpectralSingleScattering;
use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::theory::prediction::Covariance;
use crate::theory::single::{Points, Tracking};
use crate::theory::{Channel, CountLaw, Prediction, Tails};

/// How shadow rays are tracked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shadow {
    /// Their transmittance is known.
    Exact,
    /// By ratio tracking through the σ̂ of the hero.
    Ratio,
}

impl Shadow {
    fn read(settings: &Settings) -> Option<Self> {
        let word = settings.word_or("shadow", &["exact", "ratio"], "exact")?;
        Some(if word == "ratio" { Self::Ratio } else { Self::Exact })
    }

    fn label(self, heroes: &Heroes) -> String {
        let words = if self == Self::Ratio { "ratio shadow" } else { "exact shadow" };
        let heroes = heroes.label();
        if heroes.is_empty() { words.into() } else { format!("{words}, {heroes}") }
    }
}

/// One hero probability and a constant σ̂ ≥ σ_t for each channel, on the ray and on shadow rays that are tracked.
fn realisable(
    setup: &Setup<SpectralSingleScattering>,
    heroes: &Heroes,
    shadow: Shadow,
) -> Result<(), Refusal> {
    heroes.require(setup.channels.len())?;
    channels::require_constants(&setup.channels)?;
    channels::require_majorants(&setup.channels)?;
    if shadow == Shadow::Exact {
        return Ok(());
    }
    for (number, (channel, lit)) in (1..).zip(setup.channels.iter().zip(&setup.problem.channels)) {
        let bound = lit.shadow_majorant();
        if channel.majorant < bound * (1.0 - 1e-12) {
            let [majorant, bound] = [channel.majorant, bound].map(rounded);
            let found = format!("σ̂ = {majorant} and σ_t is bounded by {bound} in channel {number}");
            return Err(Refusal::mismatch("σ̂ ≥ σ_t on every shadow ray", found));
        }
    }
    Ok(())
}

/// The moments of analog tracking of each channel by itself.
fn alone(setup: &Setup<SpectralSingleScattering>, shadow: Shadow) -> Vec<Points> {
    let each = setup.channels.iter().zip(&setup.problem.channels);
    let points = each.map(|(channel, problem)| {
        let shadow = match shadow {
            Shadow::Exact => Tracking::Exact,
            Shadow::Ratio => Tracking::Ratio { sampling: channel.majorant, control: 0.0 },
        };
        let (mesh, sampling) = (channel.mesh.clone(), Some(channel.sampling.clone()));
        let own = Setup::new(problem.clone(), mesh, sampling, Control::None);
        DeltaTracking { absorption: Absorption::Analog, shadow }.points(&own)
    });
    points.collect()
}

/// The lookups of the walk of a hero, mixed over heroes.
fn lookups(alone: &[Points], heroes: &[f64]) -> Option<[f64; 5]> {
    let mut mixed = [0.0; 5];
    for (points, chance) in alone.iter().zip(heroes) {
        for (sum, number) in mixed.iter_mut().zip(points.lookups?) {
            *sum += chance * number;
        }
    }
    Some(mixed)
}

/// What theory says of one channel a draw: `E[X_λ^k] = w_λ^{1−k} E[x_λ^k]`, x a draw of that channel by itself.
fn predict_independent(alone: &[Points], heroes: &[f64]) -> Prediction {
    let lookups = lookups(alone, heroes);
    let each = alone.iter().zip(heroes).map(|(points, chance)| {
        let mut scaled =
            Points { lookups, eighth: points.eighth.map(|x| x / chance.powi(7)), ..*points };
        for (k, power) in (0..).zip(&mut scaled.powers) {
            *power *= if k > 0 { chance.powi(1 - k) } else { 1.0 };
        }
        (scaled.powers, scaled.prediction())
    });
    let (powers, predictions): (Vec<[f64; 5]>, Vec<Prediction>) = each.unzip();
    let covariance = |next: usize| {
        let of = |k: usize| [powers[next - 1][k], powers[next][k]];
        Covariance::of_raw([next - 1, next], of(1), of(2), [0.0; 4])
    };
    let covariances = (1..powers.len()).map(covariance).collect();
    let lookups = predictions.first().and_then(|found| found.lookups.clone());
    let channels = predictions.into_iter().flat_map(|found| found.channels);
    Prediction { channels: named(channels), lookups, covariances, ..Prediction::default() }
}

/// What theory says of all channels by the balance heuristic: means, the lookups, and a bound on the variance.
///
/// ```text
/// p̄ = Σ_h w_h p_h ≥ w_λ p_λ,   E[X_λ²] = ∫ f_λ²/p̄ ≤ ∫ f_λ²/(w_λ p_λ) = E[x_λ²]/w_λ
/// ```
///
/// which is the second moment of one channel a draw.
fn predict_balanced(alone: &[Points], heroes: &[f64]) -> Prediction {
    let of_first: Option<CountLaw> = alone.first().and_then(|first| {
        Points { lookups: lookups(alone, heroes), ..*first }.prediction().lookups
    });
    let channel = |(points, chance): (&Points, &f64)| {
        let mean = points.truth.value;
        let bound = points.powers[2] * (1.0 + points.error) / chance - mean * mean;
        let unknown = Channel::unbiased(points.truth, None, Tails::LIGHT);
        Channel { most_variance: Some(bound.max(0.0)), ..unknown }
    };
    let channels = named(alone.iter().zip(heroes).map(channel));
    Prediction { channels, lookups: of_first, ..Prediction::default() }
}

fn named(channels: impl Iterator<Item = Channel>) -> Vec<Channel> {
    let mut channels: Vec<Channel> = channels.collect();
    if channels.len() > 1 {
        for (number, channel) in (1..).zip(&mut channels) {
            channel.name = format!("channel {number}");
        }
    }
    channels
}

estimators! {
    SpectralSingleScattering:
    independent::Independent,
    spectral_mis::SpectralMis,
}
