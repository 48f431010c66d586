//! Common parts of the reference values of emitters behind rods and slabs.

use super::{none, predicted};
use trueflight::record::{Row, Verdict};
use trueflight::theory::Prediction;
use trueflight::theory::light::{Combination, Densities, Heuristic, Shadow, Techniques};

/// Returns the techniques of a reference value.
pub fn techniques(what: &str) -> Techniques {
    use Combination::{Mis, NextEvent, Unidirectional};
    let (what, heuristic) = match what.strip_suffix("-power") {
        Some(what) => (what, Heuristic::Power),
        None => (what, Heuristic::Balance),
    };
    let weighted = |densities| Mis(densities, heuristic);
    let (shadow, combination) = match what {
        "uni" | "mean" => (None, Unidirectional),
        "nee-ratio" => (Some(Shadow::Ratio), NextEvent),
        "nee-delta" => (Some(Shadow::Delta), NextEvent),
        "nee-analytic" => (Some(Shadow::Exact), NextEvent),
        "mis-directional" => (Some(Shadow::Delta), weighted(Densities::Directional)),
        "mis-analytic" => (Some(Shadow::Exact), weighted(Densities::Full)),
        "mis-full" => (Some(Shadow::Ratio), weighted(Densities::Full)),
        other => panic!("{other}"),
    };
    Techniques { shadow, combination }
}

/// Compares mean or variance of a prediction with a reference value. Returns a message if they differ by more than the
/// reference's error, or by more than both errors, or if the prediction's error is above a bound.
pub fn differs(
    (what, value, uncertainty): (&str, f64, f64),
    prediction: &Prediction,
    bound: f64,
) -> Option<String> {
    let channel = &prediction.channels[0];
    let (found, error) = if what == "mean" {
        (channel.truth.value, channel.truth.error)
    } else {
        let moments = channel.moments.expect("a variance");
        (moments.variance(), moments.error * moments.variance())
    };
    let off = (found - value).abs();
    let is_wrong = off > uncertainty || off > error + uncertainty || error > bound;
    is_wrong.then(|| format!("{what}: {found} ± {error:e} against {value}"))
}

/// Returns the number of experiments of extreme cases, each with its place in words, that are predicted by possible
/// numbers; all others must be refused in words.
pub fn predictions(cases: &[(String, String)], can_be: impl Fn(&Row, f64, f64) -> bool) -> usize {
    let (mut count, mut wrong) = (0, Vec::new());
    for (place, text) in cases {
        for row in predicted(text) {
            let place = format!("{}: {place}", row.experiment.label);
            if row.verdict == Some(Verdict::Refused) {
                wrong.extend((row.reason().len() < 10).then_some(place));
                continue;
            }
            count += 1;
            let truth = row.truth.unwrap_or(f64::NAN);
            let variance = row.predicted_variance.unwrap_or(0.0);
            let lookups = row.experiment.predicted_lookups.unwrap_or(f64::NAN);
            let is_fine = truth > 0.0 && truth <= 1.0 && variance >= 0.0 && lookups >= 0.0;
            if !is_fine || !can_be(&row, truth, variance) {
                wrong.push(format!("{place}: {truth:e}, {variance:e}, {lookups:e}"));
            }
        }
    }
    none(&wrong);
    count
}

/// Every estimator of a problem with an emitter.
pub const ESTIMATORS: &str = "{ unidirectional = {} }, { next-event.shadow = \"exact\" },
    { next-event.shadow = \"delta\" }, { next-event = {} }, { directional-mis = {} },
    { full-mis.shadow = \"exact\" }, { full-mis = {} }, { full-mis.heuristic = \"power\" }";
