//! Which constant σ̂ is best.
//!
//! The figure of merit is `1/(V · E[M])`. An estimator that may end early has a finite optimum,
//! found by a one-dimensional search on log σ̂. The double particle has none: its figure of merit
//! rises towards the limit `1/(T² S ∫residual²)`, and what is reported is where it reaches 90 %.
//! Each channel has a variance of its own, and so a σ̂ of its own that is best for it.
//!
//! Source: Szirmay-Kalos et al. 2017, section 3.4, with the cost of the walk added.

use super::Prediction;
use crate::numeric::parallel;
use crate::numeric::roots;

/// The best constant σ̂ and the figure of merit there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Optimum {
    /// σ̂, 1/length.
    pub sampling: f64,
    /// `1/(V · E[M])` there.
    pub figure_of_merit: f64,
}

/// How near the best `ln σ̂` is found.
const TOLERANCE: f64 = 1e-6;
/// Steps of the first, coarse search over σ̂/scale from 1e-2 to 1e3.
const COARSE: usize = 51;

/// Searches, for each channel, the constant σ̂ with the largest figure of merit around `scale`, the largest
/// residual. Empty where the estimator is refused everywhere.
///
/// `predict` answers `None` where the estimator is refused. Where the figure of merit still rises
/// at the upper end, it is followed by factors of ten until it gains less than 0.1 %, and the answer
/// is the σ̂ that reaches 90 % of that limit.
pub fn best_constants(
    scale: f64,
    predict: impl Fn(f64) -> Option<Prediction> + Sync,
) -> Vec<Option<Optimum>> {
    if scale.is_nan() || scale <= 0.0 {
        return Vec::new();
    }
    let merits = |log: f64| -> Vec<f64> {
        predict(scale * log.exp()).map_or_else(Vec::new, |prediction| {
            (0..prediction.channels.len())
                .map(|channel| prediction.figure_of_merit(channel).unwrap_or(0.0))
                .collect()
        })
    };
    let of = |merits: &[f64], channel: usize| merits.get(channel).copied().unwrap_or(0.0);
    let coarse: Vec<Vec<f64>> = parallel::range(COARSE, |i| merits(at(i)));
    let channels = coarse.iter().map(Vec::len).max().unwrap_or(0);
    let best = |channel: usize| {
        let coarse: Vec<f64> = coarse.iter().map(|all| of(all, channel)).collect();
        let merit = |log: f64| of(&merits(log), channel);
        best_log(&coarse, merit)
            .map(|(log, merit)| Optimum { sampling: scale * log.exp(), figure_of_merit: merit })
    };
    parallel::range(channels, best)
}

/// `ln(σ̂/scale)` at a step of the coarse search.
fn at(step: usize) -> f64 {
    let (low, high) = (1e-2f64.ln(), 1e3f64.ln());
    low + (high - low) / (COARSE - 1) as f64 * step as f64
}

/// Where a figure of merit is largest, or reaches 90 % of its limit, as `ln(σ̂/scale)`; and what it is there.
fn best_log(coarse: &[f64], merit: impl Fn(f64) -> f64) -> Option<(f64, f64)> {
    let (best, &largest) = coarse.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    if largest <= 0.0 {
        return None;
    }
    if best == COARSE - 1 {
        let (far, limit) = limit(at(best), largest, &merit);
        let below = coarse.iter().rposition(|&fom| fom < 0.9 * limit)?;
        let above = if below + 1 < COARSE { at(below + 1) } else { far };
        let log = roots::root(at(below), above, |log| merit(log) - 0.9 * limit);
        Some((log, merit(log)))
    } else {
        // A refused neighbour (figure of merit 0) is a cliff that golden sections walk up to.
        let around = [best.saturating_sub(1), best, best + 1].map(at);
        let (log, least) = roots::least(around, -largest, TOLERANCE, |log| -merit(log));
        Some((log, -least))
    }
}

/// Follows a rising figure of merit to its limit.
fn limit(from: f64, reached: f64, merit: impl Fn(f64) -> f64) -> (f64, f64) {
    let (mut log, mut best) = (from, reached);
    for _ in 0..8 {
        let further = merit(log + 10f64.ln());
        if further <= best * 1.001 {
            break;
        }
        (log, best) = (log + 10f64.ln(), further);
    }
    (log, best)
}
