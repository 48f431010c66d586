//! Predictions for single scattering in several channels, with draws that score all of them.
//!
//! ```text
//! independent    E[X_λ^k] = w_λ^{1−k} E[x_λ^k],  E[X_λ X_μ] = 0,  x a draw of the channel by itself
//! balanced       E[X_λ²] ≤ E[x_λ²]/w_λ
//! relative to the density of one walker    all moments, see [`relative`]
//! ```
//!
//! Lookups are those of the hero's walk; their distribution is the mixture over heroes.

pub mod relative;

use super::TechniqueMoments;
use crate::colours::{self, named};
use crate::prediction::raw::Raw;
use crate::{Channel, CountDistribution, Prediction};

/// The lookups of the walk of a hero, mixed over heroes.
pub fn lookups(alone: &[TechniqueMoments], heroes: &[f64]) -> Option<Raw> {
    let each =
        alone.iter().zip(heroes).map(|(points, probability)| Some((*probability, points.lookups?)));
    colours::mixed(each.collect::<Option<Vec<_>>>()?)
}

/// Mean number of lookups of shadow rays, mixed over heroes.
pub fn shadow_lookups(alone: &[TechniqueMoments], heroes: &[f64]) -> Option<f64> {
    alone
        .iter()
        .zip(heroes)
        .map(|(points, probability)| Some(points.shadow_lookups? * probability))
        .sum()
}

/// Prediction for one channel a draw: `E[X_λ^k] = w_λ^{1−k} E[x_λ^k]`, x a draw of that channel by itself.
pub fn independent(alone: &[TechniqueMoments], heroes: &[f64]) -> Prediction {
    let lookups = lookups(alone, heroes);
    let each = alone.iter().zip(heroes).map(|(points, probability)| {
        let raw = colours::independent(&points.raw, *probability);
        let prediction = TechniqueMoments { raw, lookups, ..*points }.prediction();
        ([raw.0[0].value, raw.0[1].value], prediction)
    });
    let (moments, predictions): (Vec<[f64; 2]>, Vec<Prediction>) = each.unzip();
    let covariances = colours::exclusive(&moments);
    let (channels, lookups) = joined(predictions.into_iter());
    let shadow_lookups = shadow_lookups(alone, heroes);
    let channels = named(channels);
    Prediction { channels, lookups, shadow_lookups, covariances, ..Prediction::default() }
}

/// The channels of several predictions, and the lookups of the first.
fn joined(each: impl Iterator<Item = Prediction>) -> (Vec<Channel>, Option<CountDistribution>) {
    let (mut channels, mut lookups) = (Vec::new(), None);
    for result in each {
        lookups = lookups.or(result.lookups);
        channels.extend(result.channels);
    }
    (channels, lookups)
}

/// Prediction for all channels by the balance heuristic: means, the lookups, and a bound on the variance.
///
/// ```text
/// p̄ = Σ_h w_h p_h ≥ w_λ p_λ,   E[X_λ²] = ∫ f_λ²/p̄ ≤ ∫ f_λ²/(w_λ p_λ) = E[x_λ²]/w_λ
/// ```
///
/// which is the second moment of one channel a draw.
pub fn balanced(alone: &[TechniqueMoments], heroes: &[f64]) -> Prediction {
    let of_first: Option<CountDistribution> = alone.first().and_then(|first| {
        TechniqueMoments { lookups: lookups(alone, heroes), ..*first }.prediction().lookups
    });
    let channel = |(points, probability): (&TechniqueMoments, &f64)| {
        let square = points.raw.second();
        Channel::bounded(points.truth, (square.value + square.error) / probability)
    };
    let channels = named(alone.iter().zip(heroes).map(channel).collect());
    let (lookups, shadow_lookups) = (of_first, shadow_lookups(alone, heroes));
    Prediction { channels, lookups, shadow_lookups, ..Prediction::default() }
}
