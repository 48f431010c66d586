//! Draws of packets equal draws made one by one, to the bit.
//!
//! The comparison is made on every level of vector hardware of this machine with fused multiply-add: values, lookups,
//! defects, and the final states of the streams. Without fused multiply-add the same kernels round differently and are
//! judged like any estimator.

mod fields;
mod rays;
mod single_scattering;
mod space;

use crate::common::{none, options};
use fearless_simd::Level;
use trueflight::case::Case;
use trueflight::estimators::{DrawBuffer, Kernel};
use trueflight::numeric::pack::fuses;
use trueflight::plan::Plan;
use trueflight::plan::Planned;

/// Numbers of draws of consecutive requests, not multiples of any number of lanes.
const REQUESTS: [usize; 6] = [1, 3, 8, 100, 257, 5];

/// Returns all draws of an experiment, as bits, and its final streams.
fn drawn(planned: &Planned, kernel: Kernel) -> Vec<u64> {
    let ready = planned.outcome.as_ref().expect("it is not refused");
    let mut buffer = DrawBuffer::new(ready.prediction.channels.len());
    let mut streams = planned.streams(3);
    let mut bits = Vec::new();
    for count in REQUESTS {
        ready.experiment.fill_by(kernel, &mut streams, count, &mut buffer);
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

/// Returns every level with fused multiply-add, from the best down.
pub fn fusing_levels() -> Vec<Level> {
    let mut levels = vec![Level::new()];
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    levels.extend(Level::new().as_avx2().map(Level::Avx2));
    levels.retain(|&level| fuses(level));
    levels
}

/// Compares all experiments of cases on all levels; returns the number of comparisons.
pub fn compare(cases: &[Case]) -> usize {
    let plan = Plan::new(cases, &options(1, 1_000));
    let (mut wrong, mut compared) = (Vec::new(), 0);
    for (_, planned) in plan.experiments() {
        if planned.outcome.is_err() {
            continue;
        }
        let single = drawn(planned, Kernel::Single);
        for level in fusing_levels() {
            compared += 1;
            let packets = drawn(planned, Kernel::Packets(level));
            let differing = single.iter().zip(&packets).position(|(a, b)| a != b);
            if differing.is_some() || single.len() != packets.len() {
                let place = format!("{}, {level:?}", planned.id);
                wrong.push(format!("{place}: {differing:?}"));
            }
        }
    }
    println!("{compared} compared");
    none(&wrong);
    compared
}
