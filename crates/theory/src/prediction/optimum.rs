//! The constant σ̂ with the largest figure of merit.
//!
//! The figure of merit is `1/(V · (E[M] + S/n))`: the n draws of a ray share its S setup lookups.
//! An estimator that may end early has a finite optimum, found by a one-dimensional search on log σ̂. The double
//! particle has no optimum: its figure of merit rises with σ̂ towards the limit `1/(T² ℓ ∫residual²)`, ℓ the length
//! of the support. The answer is then the σ̂ that reaches 90 % of the limit, with the limit. Each channel has a
//! variance of its own, and so a best σ̂ of its own.
//!
//! Source: Szirmay-Kalos et al. 2017, section 3.4, with the cost of the walk added.

use crate::{Prediction, parallel};
use numeric::roots;

/// Share of the limit at which a rising figure of merit is reported.
pub const SHARE: f64 = 0.9;

/// Kind of a reported σ̂.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// The figure of merit is largest there.
    Maximum,
    /// The figure of merit rises with σ̂ to a limit, and reaches 90 % of it there.
    ShareOfLimit {
        /// The limit, `1/(V · cost)` for σ̂ → ∞.
        limit: f64,
    },
    /// The variance is 0 there: the figure of merit is infinite.
    NoVariance,
    /// The figure of merit still rises at the end of the search, from 1e-2 of the largest residual to at least 1e3 of it.
    EndOfSearch,
}

impl Kind {
    /// The limit of a figure of merit that rises to one.
    pub fn limit(self) -> Option<f64> {
        match self {
            Self::ShareOfLimit { limit } => Some(limit),
            _ => None,
        }
    }
}

/// The best constant σ̂ and the figure of merit there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Optimum {
    /// σ̂, 1/length.
    pub sampling: f64,
    /// `1/(V · (E[M] + S/n))` there; infinite where the variance is 0.
    pub figure_of_merit: f64,
    /// Kind of this σ̂.
    pub kind: Kind,
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
    let merits = |log: f64| -> Vec<f64> {
        predict(scale * log.exp()).map_or_else(Vec::new, |prediction| {
            (0..prediction.channels.len())
                .map(|channel| prediction.figure_of_merit(channel, draws_per_ray).unwrap_or(0.0))
                .collect()
        })
    };
    let of = |merits: &[f64], channel: usize| merits.get(channel).copied().unwrap_or(0.0);
    let coarse: Vec<Vec<f64>> = parallel::range(COARSE, |i| merits(at(i)));
    let channels = coarse.iter().map(Vec::len).max().unwrap_or(0);
    let best = |channel: usize| {
        let coarse: Vec<f64> = coarse.iter().map(|all| of(all, channel)).collect();
        let merit = |log: f64| of(&merits(log), channel);
        let found = best_log(&coarse, merit)?;
        Some(Optimum {
            sampling: scale * found.log.exp(),
            figure_of_merit: found.merit,
            kind: found.kind,
        })
    };
    parallel::range(channels, best)
}

/// `ln(σ̂/scale)` at a step of the coarse search.
fn at(step: usize) -> f64 {
    let (low, high) = (1e-2f64.ln(), 1e3f64.ln());
    low + (high - low) / (COARSE - 1) as f64 * step as f64
}

/// A place on the axis of `ln(σ̂/scale)` and the figure of merit there.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    log: f64,
    merit: f64,
    kind: Kind,
}

/// Searches the maximum of a figure of merit, or 90 % of its limit.
fn best_log(coarse: &[f64], merit: impl Fn(f64) -> f64) -> Option<Candidate> {
    let (best, &largest) = coarse.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    if largest <= 0.0 {
        return None;
    }
    if largest.is_infinite() {
        return Some(Candidate { log: at(best), merit: largest, kind: Kind::NoVariance });
    }
    if best == 0 {
        return Some(Candidate { log: at(0), merit: largest, kind: Kind::EndOfSearch });
    }
    let before = coarse[best - 1];
    if best == COARSE - 1 {
        let Some((far, limit)) = limit([at(best - 1), at(best)], [before, largest], &merit) else {
            return Some(Candidate { log: at(best), merit: largest, kind: Kind::EndOfSearch });
        };
        return share_of_limit(coarse, far, limit, merit);
    }
    // A refused point beside the best one (figure of merit 0) is a cliff that golden sections walk up to.
    let around = [best - 1, best, best + 1].map(at);
    let (log, least) = roots::least(around, -largest, TOLERANCE, |log| -merit(log));
    let is_cliff = coarse[best + 1..].iter().all(|&fom| fom <= 0.0);
    if is_cliff && before > 0.0 && largest <= before * (1.0 + FLAT) {
        // Refused because of too many collisions, not of its domain: this is as near to the limit as draws can be
        // made.
        let limit = extrapolated([at(best - 1), log], [before, -least]);
        return share_of_limit(coarse, log, limit, merit);
    }
    Some(Candidate { log, merit: -least, kind: Kind::Maximum })
}

/// Searches 90 % of the limit of a rising figure of merit, which is nearly reached at `far`. In thin media the answer lies
/// below the range of the coarse search.
fn share_of_limit(
    coarse: &[f64],
    far: f64,
    limit: f64,
    merit: impl Fn(f64) -> f64,
) -> Option<Candidate> {
    let lacking = |log: f64| merit(log) - SHARE * limit;
    let [low, high] = match coarse.iter().rposition(|&fom| fom < SHARE * limit) {
        Some(below) if below + 1 < COARSE => [at(below), at(below + 1).min(far)],
        Some(below) => [at(below), far],
        None => {
            let mut logs = (0..=DECADES).map(|decade| at(0) - decade as f64 * 10f64.ln());
            let below = logs.find(|&log| lacking(log) < 0.0)?;
            [below, below + 10f64.ln()]
        }
    };
    let log = roots::root(low, high, lacking);
    // A root at the edge of the domain may lie on its other side.
    let inside = [log, log + TOLERANCE].into_iter().find(|&log| merit(log) > 0.0)?;
    Some(Candidate { log: inside, merit: merit(inside), kind: Kind::ShareOfLimit { limit } })
}

/// Follows a rising figure of merit from its last two values to its limit; returns the last `ln σ̂` and the limit;
/// `None` where it rises without end.
fn limit(logs: [f64; 2], merits: [f64; 2], merit: impl Fn(f64) -> f64) -> Option<(f64, f64)> {
    let [mut last, mut now] = [(logs[0], merits[0]), (logs[1], merits[1])];
    for _ in 0..DECADES {
        let log = now.0 + 10f64.ln();
        let further = merit(log);
        if further <= 0.0 {
            // Refused: too many collisions.
            break;
        }
        (last, now) = (now, (log, further));
        if further <= last.1 * (1.0 + SETTLED) {
            return Some((now.0, extrapolated([last.0, now.0], [last.1, now.1])));
        }
    }
    let is_flat = now.1 <= last.1 * (1.0 + FLAT);
    is_flat.then(|| (now.0, extrapolated([last.0, now.0], [last.1, now.1])))
}

/// The limit of `F = L − c/σ̂` through two points on the axis of `ln σ̂`.
fn extrapolated(logs: [f64; 2], merits: [f64; 2]) -> f64 {
    let gain = (merits[1] - merits[0]).max(0.0);
    let steps = (logs[1] - logs[0]).exp_m1();
    if steps > 0.0 { merits[1] + gain / steps } else { merits[1] }
}
