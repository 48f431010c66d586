//! Draws of packets equal draws made one by one, to the bit.
//!
//! The comparison is made on every level of vector hardware of this machine: values, lookups, defects, and the final states
//! of the streams. Draws need no prediction, so that all combinations take seconds.

mod rays;
mod single_scattering;
mod space;

use crate::common::none;
use trueflight::case::Case;
use trueflight::estimators::{DrawBuffer, Experiment, Kernel};
use trueflight::numeric::pack::levels;
use trueflight::rng::Address;

/// Numbers of draws of consecutive requests, not multiples of any number of lanes.
const REQUESTS: [usize; 6] = [1, 3, 8, 100, 257, 5];

/// More channels than a draw has.
const MANY: usize = 64;

/// Returns the number of channels of an experiment's draws.
fn channels(experiment: &dyn Experiment, address: Address) -> usize {
    let mut buffer = DrawBuffer::new(MANY);
    // What a draw does not overwrite is not of its channels.
    buffer.values.fill(vec![f64::NAN]);
    experiment.fill_by(Kernel::Single, &mut address.streams(), 1, &mut buffer);
    buffer.values.iter().filter(|channel| !channel[0].is_nan()).count()
}

/// Returns all draws of an experiment, as bits, and its final streams.
fn drawn(experiment: &dyn Experiment, kernel: Kernel, address: Address) -> Vec<u64> {
    let mut buffer = DrawBuffer::new(channels(experiment, address));
    let (mut streams, mut bits) = (address.streams(), Vec::new());
    for count in REQUESTS {
        experiment.fill_by(kernel, &mut streams, count, &mut buffer);
        assert_eq!(buffer.lookups.len(), count);
        for channel in &buffer.values {
            bits.extend(channel.iter().map(|value| value.to_bits()));
        }
        bits.extend(buffer.lookups.iter().map(|&lookups| u64::from(lookups)));
        bits.extend(buffer.defects.iter().map(|defect| defect.to_bits()));
    }
    bits.push(streams.turn as u64);
    bits.extend(streams.words().take(16));
    bits
}

/// Compares every estimator of cases, at the first point of a sweep, on all levels that the processor has. More than `least`
/// comparisons must be made on each.
pub fn compare(cases: &[Case], least: usize) {
    let (levels, mut wrong, mut compared) = (levels(), Vec::new(), 0);
    for case in cases {
        let swept = case.sweep.as_ref().map(|axis| (axis.what, axis.values[0]));
        for estimator in 0..case.scenario.estimators() {
            let variation = swept.filter(|&(what, _)| case.scenario.depends_on(estimator, what));
            let address = case.address(1, estimator, variation);
            let at = case.at(variation).expect("a point of the sweep");
            let Ok(experiment) = at.join(estimator, address) else { continue };
            let single = drawn(&*experiment, Kernel::Single, address);
            for &level in &levels {
                compared += 1;
                let packets = drawn(&*experiment, Kernel::Packets(level), address);
                let differing = single.iter().zip(&packets).position(|(a, b)| a != b);
                if differing.is_some() || single.len() != packets.len() {
                    wrong.push(format!("{}, {level:?}: {differing:?}", at.id(estimator)));
                }
            }
        }
    }
    none(&wrong);
    assert!(compared >= (least + 1) * levels.len(), "only {compared} compared on {levels:?}");
}
