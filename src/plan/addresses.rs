//! Where experiments find their random numbers: addresses made of names.

use crate::case::names::EstimatorName;
use crate::plan::id::ExperimentId;
use numeric::rng::{Address, name_hash};

pub use gate::stats::verdict::BLOCK;

/// Where order-free experiments of a case find their collisions, if these are as likely anywhere on
/// the same stretches: whatever the estimator, the control and σ̂.
pub fn shared(seed: u64, case: &str, stretches: &str) -> Address {
    let experiment = name_hash(&format!("{case}|places{stretches}"));
    Address { seed, experiment, block: 0, lane: 0 }
}

/// The address of an experiment's streams: made of names, so that it keeps its random numbers when
/// other experiments join or leave the run. An experiment that is another estimator by definition, its alias, makes
/// the draws of that one.
pub fn own(seed: u64, id: &ExperimentId, alias: Option<&EstimatorName>) -> Address {
    let ExperimentId { case, sampling, control, .. } = id;
    let estimator = alias.unwrap_or(&id.estimator);
    let kind = &sampling.kind;
    let constant = sampling.constant.map_or(String::new(), |value| value.to_string());
    let swept = id.swept.map_or(String::new(), |at| format!("{}={}", at.what.key(), at.value));
    let mut name = format!("{case}|{estimator}|{constant}|{kind}|{control}|{swept}");
    if id.namesake > 1 {
        name = format!("{name}|{}", id.namesake - 1);
    }
    Address { seed, experiment: name_hash(&name), block: 0, lane: 0 }
}
