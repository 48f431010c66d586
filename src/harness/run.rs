//! Drawing: blocks of draws by address, merged in the order of their addresses.

use std::time::Instant;

use cpu_time::ThreadTime;
use rayon::prelude::*;

use super::plan::{Plan, Planned};
use crate::estimators::DrawBuffer;
use crate::numeric::sum::Sum;
use crate::rng::Address;
use crate::stats::Tally;

/// Draws per block, always.
pub const BLOCK: u64 = 1 << 14;
/// Blocks drawn between two looks at the clock; results do not depend on it.
const BATCH: usize = 256;

/// What one experiment drew.
#[derive(Debug, Clone, Default)]
pub struct Drawn {
    /// One tally per channel, in units of the truth about the predicted mean.
    pub tallies: Vec<Tally>,
    /// The lookups, about their predicted mean.
    pub lookups: Tally,
    /// For each check, its sums.
    pub sums: Vec<Vec<Sum>>,
    /// Processor seconds.
    pub seconds: f64,
}

/// Everything that a plan drew.
#[derive(Debug, Clone)]
pub struct Draws {
    /// Per case, per experiment; empty tallies for refused ones.
    pub cases: Vec<Vec<Drawn>>,
    /// Whether the time limit came first.
    pub cut_by_time: bool,
}

/// One block of one experiment.
#[derive(Clone, Copy)]
struct Unit<'p> {
    case: usize,
    index: usize,
    block: u64,
    planned: &'p Planned,
}

/// Draws a plan; `progress` is told after each block how many draws it made.
pub fn draw(plan: &Plan, progress: &(dyn Fn(u64) + Sync)) -> Draws {
    let begin = Instant::now();
    let mut cases: Vec<Vec<Drawn>> =
        plan.cases.iter().map(|case| vec![Drawn::default(); case.experiments.len()]).collect();
    let mut cut_by_time = false;
    // Block by block over all experiments: a time limit then cuts all of them alike.
    let expired =
        || plan.options.seconds.is_some_and(|limit| begin.elapsed().as_secs_f64() >= limit);
    for batch in units(plan).chunks(BATCH) {
        let drawn: Vec<Option<Drawn>> = batch
            .par_iter()
            .map(|unit| {
                if expired() {
                    return None;
                }
                let drawn = draw_block(unit);
                progress(drawn.lookups.draws);
                Some(drawn)
            })
            .collect();
        for (unit, block) in batch.iter().zip(&drawn) {
            // What comes after a missing block is left out: an experiment keeps its first blocks.
            let tally = &mut cases[unit.case][unit.index];
            match block {
                Some(block) if tally.lookups.draws == unit.block * BLOCK => tally.merge(block),
                _ => cut_by_time = true,
            }
        }
        if cut_by_time {
            break;
        }
    }
    Draws { cases, cut_by_time }
}

fn units<'p>(plan: &'p Plan) -> Vec<Unit<'p>> {
    let mut units: Vec<Unit> = Vec::new();
    for (case, planned_case) in plan.cases.iter().enumerate() {
        for (index, planned) in planned_case.experiments.iter().enumerate() {
            if planned.outcome.is_ok() {
                let blocks = 0..planned.draws.div_ceil(BLOCK);
                units.extend(blocks.map(|block| Unit { case, index, block, planned }));
            }
        }
    }
    units.sort_by_key(|unit| unit.block);
    units
}

fn draw_block(unit: &Unit) -> Drawn {
    // Processor time, not wall time: other processes do not count.
    let begin = ThreadTime::now();
    let planned = unit.planned;
    let Ok(ready) = &planned.outcome else { return Drawn::default() };
    let prediction = &ready.prediction;
    let mut rng = Address { block: unit.block, ..planned.address }.stream();
    let mut buffer = DrawBuffer::new(prediction.channels.len());
    let sums: Vec<Vec<f64>> = planned
        .statistics
        .iter()
        .map(|statistic| vec![0.0; statistic.as_ref().map_or(0, |statistic| statistic.size())])
        .collect();
    let mut block = Block {
        tallies: vec![Tally::default(); prediction.channels.len()],
        lookups: Tally::default(),
        sums,
    };
    let expected_lookups = prediction.lookups.as_ref().map_or(0.0, |law| law.mean);
    let mut left = (planned.draws - unit.block * BLOCK).min(BLOCK);
    let mut counts = Vec::with_capacity(DrawBuffer::LENGTH);
    while left > 0 {
        let count = left.min(DrawBuffer::LENGTH as u64);
        #[allow(clippy::cast_possible_truncation)] // at most a buffer's length
        ready.experiment.fill(&mut rng, count as usize, &mut buffer);
        for ((tally, channel), values) in
            block.tallies.iter_mut().zip(&prediction.channels).zip(&buffer.values)
        {
            tally.merge(&Tally::of(values, channel.mean.value, channel.truth.value));
        }
        counts.clear();
        counts.extend(buffer.lookups.iter().map(|&lookups| f64::from(lookups)));
        block.lookups.merge(&Tally::of(&counts, expected_lookups, 1.0));
        for (statistic, sums) in planned.statistics.iter().zip(&mut block.sums) {
            if let Some(statistic) = statistic {
                statistic.add(&buffer, sums);
            }
        }
        left -= count;
    }
    let sums = block.sums.iter().map(|sums| sums.iter().map(|&x| Sum::from_iter([x])).collect());
    Drawn {
        tallies: block.tallies,
        lookups: block.lookups,
        sums: sums.collect(),
        seconds: begin.elapsed().as_secs_f64(),
    }
}

struct Block {
    tallies: Vec<Tally>,
    lookups: Tally,
    sums: Vec<Vec<f64>>,
}

impl Drawn {
    fn merge(&mut self, later: &Self) {
        if self.tallies.is_empty() {
            *self = later.clone();
            return;
        }
        for (tally, other) in self.tallies.iter_mut().zip(&later.tallies) {
            tally.merge(other);
        }
        self.lookups.merge(&later.lookups);
        for (sums, others) in self.sums.iter_mut().zip(&later.sums) {
            for (sum, other) in sums.iter_mut().zip(others) {
                sum.merge(other);
            }
        }
        self.seconds += later.seconds;
    }
}
