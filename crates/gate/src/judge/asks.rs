//! What is asked of foreign draws, and on which grounds.

use super::grounds::Spread;
use super::scalar::Ask;
use super::trial::{MEAN_CAP, Trial};
use crate::stats::gate::Design;

/// The widest ε of a variance that is chosen without being asked for.
pub const VARIANCE_CAP: f64 = 0.2;
/// The same of lookups.
const LOOKUPS_CAP: f64 = 0.02;
/// ε of a mean where neither the caller nor a number of draws says.
const USUAL: f64 = 0.01;

/// What is asked of the draws.
pub fn asks(trial: &Trial) -> Vec<Ask> {
    let Trial { claim, wanted, .. } = trial;
    let is_bounded = claim.range.is_some_and(|[low, high]| (high - low).is_finite());
    let mut asks = Vec::new();
    if !trial.is_certain() {
        let known = claim.variance.map(|v| v / claim.unit / claim.unit);
        let known = known.map(|v| Spread::Known(v * (1.0 + claim.variance_error)));
        let promised = claim.kurtosis.map(Spread::Kurtosis);
        let shown = (!is_bounded).then_some(Spread::Shown);
        let spread = known.or(promised).or(shown);
        asks.push(Ask {
            check: "mean",
            what: "mean",
            spread,
            // What draws show of their spread is no ground to fail them.
            is_hard: spread != Some(Spread::Shown),
            range: claim.widened().map(|range| range.map(|end| (end - claim.truth) / claim.unit)),
            tolerance: wanted.tolerance,
            usual: USUAL,
            cap: MEAN_CAP,
            floor: claim.floor(),
            must_pass: true,
        });
    }
    let is_asked = |&variance: &f64| variance > 0.0 && !trial.is_faint() && !trial.is_certain();
    if let Some(variance) = claim.variance.filter(is_asked) {
        let floor = claim.variance_floor(variance);
        // A kurtosis of 1 is known to rounding only.
        let excess = |kurtosis: f64| (kurtosis - 1.0).max(4.0 * f64::EPSILON);
        let known =
            claim.kurtosis.map(|k| Spread::Known(excess(k) * (1.0 + 4.0 * claim.variance_error)));
        let furthest = claim.widened().map_or(f64::INFINITY, |range| {
            range
                .map(|end| (end - claim.truth) / variance.sqrt())
                .into_iter()
                .fold(0.0, |most: f64, end| most.max(end * end))
        });
        let spread = known.or((!is_bounded).then_some(Spread::Shown));
        asks.push(Ask {
            check: "variance",
            what: "variance",
            spread,
            is_hard: spread != Some(Spread::Shown),
            // A square is never negative: it may be refuted as too large without any promise.
            range: (is_bounded || known.is_none()).then_some([-1.0, furthest - 1.0]),
            tolerance: wanted.variance_tolerance,
            usual: VARIANCE_CAP,
            cap: VARIANCE_CAP,
            floor,
            must_pass: false,
        });
    }
    if let Some(claimed) = claim.lookups.filter(|claimed| !claimed.is_fixed()) {
        let relative = |v: f64| v / (claimed.mean * claimed.mean) * (1.0 + claimed.error);
        let spread = claimed.variance.map_or(Spread::Shown, |v| Spread::Known(relative(v)));
        asks.push(Ask {
            check: "lookups",
            what: "number of lookups",
            spread: Some(spread),
            is_hard: spread != Spread::Shown,
            range: (spread == Spread::Shown).then_some([-1.0, f64::INFINITY]),
            tolerance: None,
            usual: LOOKUPS_CAP,
            cap: LOOKUPS_CAP,
            floor: claimed.error,
            must_pass: false,
        });
    }
    asks
}

/// n: the draws that the tolerances asked for need, at most those that there are.
pub fn planned(asks: &[Ask], length: Option<u64>) -> Option<f64> {
    let needs = |ask: &Ask, design: fn(f64, f64, f64) -> Design, tolerance: f64| {
        let Some(Spread::Known(variance)) = ask.spread else { return None };
        (variance > 0.0).then(|| design(variance, tolerance, 0.0).draws())
    };
    let length = length.map(|length| length as f64);
    let asked = asks.iter().filter_map(|ask| needs(ask, Design::asked, ask.tolerance?));
    match asked.reduce(f64::max) {
        Some(needed) => Some(length.map_or(needed, |length| needed.min(length))),
        None => length.or_else(|| needs(asks.first()?, Design::new, USUAL)),
    }
}
