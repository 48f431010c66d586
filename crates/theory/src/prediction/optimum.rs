//! The best constant σ̂: where V·cost is smallest, or near its limit.
//!
//! The cost is `E[M] + S/n`: the n draws of a ray share its S setup lookups. The figure of merit is `1/(V·cost)`. An
//! estimator that may end early has a finite optimum. The double particle has none: its V·cost falls with σ̂ towards the
//! limit `T² ℓ ∫residual²`, ℓ the length of the support. The answer is then a smaller σ̂, at which V·cost is a given share
//! above the limit. Each channel has a variance of its own, and so a best σ̂ of its own.
//!
//! Source: Szirmay-Kalos et al. 2017, section 3.4, with the cost of the walk added.

use super::search::{Goal, PlaceKind};
use crate::{Prediction, parallel};

/// Share of the limit at which a rising figure of merit is reported.
const SHARE: f64 = 0.9;

/// The best constant σ̂ and the figure of merit there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Optimum {
    /// σ̂, 1/length.
    pub sampling: f64,
    /// `1/(V · (E[M] + S/n))` there; infinite where the variance is 0.
    pub figure_of_merit: f64,
    /// Limit of the figure of merit for σ̂ → ∞, if it rises to one.
    pub limit: Option<f64>,
    /// Kind of this σ̂.
    pub kind: PlaceKind,
}

/// Tolerance of the best `ln σ̂`.
const TOLERANCE: f64 = 1e-6;
/// Steps of the first, coarse search over σ̂/scale from 1e-2 to 1e3.
const COARSE: usize = 51;
/// Maximum relative gain of a figure of merit by a factor of ten of σ̂ near its limit.
const SETTLED: f64 = 1e-3;
/// Maximum relative gain by a coarse step near the limit, up to where the estimator is refused.
const FLAT: f64 = 1e-2;
/// Maximum number of factors of ten by which σ̂ follows a rising figure of merit.
const DECADES: usize = 8;
/// Factor by which the answer may lie below the σ̂ at which the limit is nearly reached.
const FURTHEST: f64 = 1e22;

/// Searches, for each channel, the constant σ̂ with the largest figure of merit around `scale`, the largest
/// residual. Empty where the estimator is refused everywhere.
///
/// `predict` returns `None` where the estimator is refused; a ray has `draws_per_ray` draws. A figure of merit that
/// still rises at the upper end is followed by factors of ten until it gains less than 0.1 %, and extrapolated to
/// its limit. The answer is then the σ̂ that reaches 90 % of the limit.
pub fn best_constants(
    scale: f64,
    draws_per_ray: u64,
    predict: impl Fn(f64) -> Option<Prediction> + Sync,
) -> Vec<Option<Optimum>> {
    if scale.is_nan() || scale <= 0.0 {
        return Vec::new();
    }
    let works = |share: f64| -> Vec<f64> {
        let Some(prediction) = predict(scale * share) else { return Vec::new() };
        let merit = |channel| prediction.figure_of_merit(channel, draws_per_ray);
        let work = |channel| merit(channel).map_or(f64::INFINITY, f64::recip);
        (0..prediction.channels.len()).map(work).collect()
    };
    let places: Vec<f64> = (0..COARSE).map(place).collect();
    let coarse: Vec<Vec<f64>> = parallel::map(&places, |log| works(log.exp()));
    let of = |works: &[f64], channel: usize| works.get(channel).copied().unwrap_or(f64::INFINITY);
    let channels = coarse.iter().map(Vec::len).max().unwrap_or(0);
    parallel::range(channels, |channel| {
        let known = places.iter().zip(&coarse).map(|(&log, works)| [log, of(works, channel)]);
        let goal = Goal::knowing(known.collect(), TOLERANCE, |x| of(&works(x), channel));
        best(&goal, &places).map(|best| Optimum { sampling: scale * best.sampling, ..best })
    })
}

/// Returns `ln(σ̂/scale)` at a step of the coarse search.
fn place(step: usize) -> f64 {
    let (low, high) = (1e-2f64.ln(), 1e3f64.ln());
    low + (high - low) / (COARSE - 1) as f64 * step as f64
}

/// Searches the least V·cost given coarse places, or the place near its limit; σ̂ is relative to the scale.
fn best(goal: &Goal, places: &[f64]) -> Option<Optimum> {
    let value = |step: usize| goal.at(places[step]);
    let last = COARSE - 1;
    let step = (0..COARSE).rev().min_by(|&a, &b| value(a).total_cmp(&value(b)))?;
    let result = |log: f64, kind| Optimum {
        sampling: log.exp(),
        figure_of_merit: goal.at(log).recip(),
        limit: None,
        kind,
    };
    if value(step).is_infinite() {
        return None;
    }
    if value(step) == 0.0 {
        return Some(result(places[step], PlaceKind::NoVariance));
    }
    if step == 0 {
        return Some(result(places[0], PlaceKind::EndOfSearch));
    }
    let before = places[step - 1];
    let (far, limit) = if step == last {
        match limit(goal, [before, places[last]]) {
            Some(result) => result,
            None => return Some(result(places[last], PlaceKind::EndOfSearch)),
        }
    } else {
        // A refused place beside the best one is a cliff that golden sections walk up to.
        let (log, _) = goal.between([before, places[step], places[step + 1]]);
        // Refused because of too many collisions, not of its domain: this is as near to the limit as draws can be made.
        let is_cliff = (step + 1..COARSE).all(|step| value(step).is_infinite());
        if !(is_cliff && value(step - 1) <= value(step) * (1.0 + FLAT)) {
            return Some(result(log, PlaceKind::Optimum));
        }
        (log, extrapolated(goal, [before, log]))
    };
    let edge = goal.edge(far.exp(), -1.0, limit / SHARE, FURTHEST);
    let near = |edge: f64| result(far + edge.ln(), PlaceKind::NearLimit);
    (edge > 0.0).then(|| Optimum { limit: Some(limit.recip()), ..near(edge) })
}

/// Follows a falling V·cost from its last two places to its limit; returns the last `ln σ̂` and the limit; `None` where
/// it falls without end.
fn limit(goal: &Goal, [mut last, mut now]: [f64; 2]) -> Option<(f64, f64)> {
    let falls = |[last, now]: [f64; 2], gain: f64| goal.at(last) > goal.at(now) * (1.0 + gain);
    for _ in 0..DECADES {
        let further = now + 10_f64.ln();
        if goal.at(further).is_infinite() {
            // Refused: too many collisions.
            break;
        }
        (last, now) = (now, further);
        if !falls([last, now], SETTLED) {
            return Some((now, extrapolated(goal, [last, now])));
        }
    }
    (!falls([last, now], FLAT)).then(|| (now, extrapolated(goal, [last, now])))
}

/// The limit of V·cost, of which the figure of merit is `F = L − c/σ̂` through two places.
fn extrapolated(goal: &Goal, logs: [f64; 2]) -> f64 {
    let merits = logs.map(|log| goal.at(log).recip());
    let gain = (merits[1] - merits[0]).max(0.0);
    let steps = (logs[1] - logs[0]).exp_m1();
    (if steps > 0.0 { merits[1] + gain / steps } else { merits[1] }).recip()
}
