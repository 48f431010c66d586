//! What the reference values of emitters behind rods and slabs have in common.

use trueflight::theory::Prediction;
use trueflight::theory::lit_rod::{Combination, Densities, Heuristic, Shadow, Techniques};

/// The techniques that a reference value is of.
pub fn techniques(what: &str) -> Techniques {
    use Combination::{Mis, NextEvent, Unidirectional};
    let balanced = |densities| Mis(densities, Heuristic::Balance);
    let (shadow, combination) = match what {
        "uni" | "mean" => (None, Unidirectional),
        "nee-ratio" => (Some(Shadow::Ratio), NextEvent),
        "nee-delta" => (Some(Shadow::Delta), NextEvent),
        "nee-analytic" => (Some(Shadow::Exact), NextEvent),
        "mis-directional" => (Some(Shadow::Delta), balanced(Densities::Directional)),
        "mis-analytic" => (Some(Shadow::Exact), balanced(Densities::Full)),
        "mis-full" => (Some(Shadow::Ratio), balanced(Densities::Full)),
        other => panic!("{other}"),
    };
    Techniques { shadow, combination }
}

/// The mean or the variance of a prediction against a reference value and its error, as a message if they differ
/// by more than that, or by more than both errors, or if the prediction's is above a bound.
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

/// Every estimator of such a problem.
pub const ESTIMATORS: &str = "{ unidirectional = {} }, { next-event.shadow = \"exact\" },
    { next-event.shadow = \"delta\" }, { next-event = {} }, { directional-mis = {} },
    { full-mis.shadow = \"exact\" }, { full-mis = {} }, { full-mis.heuristic = \"power\" }";
