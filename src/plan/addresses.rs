//! Where experiments find their random numbers: addresses made of names.

use crate::case::names::Names;
use crate::case::sweep::Variation;
use numeric::rng::{Address, name_hash};

pub use gate::stats::verdict::BLOCK;

/// Where order-free experiments of a case find their collisions, if these are as likely anywhere on
/// the same stretches: whatever the estimator, the control and σ̂.
pub fn shared(seed: u64, case: &str, stretches: &str) -> Address {
    let experiment = name_hash(&format!("{case}|places{stretches}"));
    Address { seed, experiment, block: 0, lane: 0 }
}

/// The address of an experiment's streams: made of names, so that it keeps its random numbers when
/// other experiments join or leave the run. `twins` come before it in the case under the same name.
pub fn own(seed: u64, case: &str, names: &Names, variation: Variation, twins: usize) -> Address {
    let Names { sampling, sampling_kind, control, .. } = names;
    // What is the same by definition makes the same draws.
    let estimator = names.alias.as_ref().unwrap_or(&names.estimator);
    let sampling = sampling.map_or(String::new(), |value| value.to_string());
    let swept = variation.map_or(String::new(), |(what, x)| format!("{}={x}", what.key()));
    let mut name = format!("{case}|{estimator}|{sampling}|{sampling_kind}|{control}|{swept}");
    if twins > 0 {
        name = format!("{name}|{twins}");
    }
    Address { seed, experiment: name_hash(&name), block: 0, lane: 0 }
}
