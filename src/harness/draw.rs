//! One block of one experiment, drawn and absorbed by its questions.
//!
//! A block is 2¹⁴ draws, found by its address. Its draws are made buffer by buffer; every question
//! absorbs each buffer while it is in the second-level cache. P-values and z-scores see only the
//! draws below the plan's fixed number.

use cpu_time::ThreadTime;

use super::checks::Kind;
use super::plan::{BLOCK, Planned};
use crate::estimators::DrawBuffer;
use crate::stats::Tally;
use crate::stats::gate::{GateSums, SUMS};

/// What a block found.
#[derive(Debug, Clone)]
pub struct Block {
    /// How many draws.
    pub draws: u64,
    /// One tally per channel over the fixed draws, in units of the truth about the predicted mean.
    pub tallies: Vec<Tally>,
    /// The lookups of the fixed draws about their predicted mean.
    pub lookups: Tally,
    /// One answer per question.
    pub answers: Vec<Answer>,
    /// Processor seconds.
    pub seconds: f64,
}

/// What a block says to one question.
#[derive(Debug, Clone)]
pub enum Answer {
    /// The sums of ψ, and of y itself.
    Gate {
        /// The sums of ψ.
        psi: [f64; SUMS],
        /// The sum of y.
        y: f64,
    },
    /// The sums of a law over the fixed draws.
    Law(Vec<f64>),
    /// The largest value.
    Largest(f64),
    /// Nothing.
    Silent,
}

/// A question's accumulator while the block is drawn.
enum Absorber {
    Gate(Box<GateSums>, f64),
    Law(Vec<f64>),
    Largest(f64),
    Silent,
}

/// Draws a block.
#[must_use]
pub fn block(planned: &Planned, block: u64) -> Option<Block> {
    // Processor time, not wall time: other processes do not count.
    let begin = ThreadTime::now();
    let ready = planned.outcome.as_ref().ok()?;
    let prediction = &ready.prediction;
    let mut streams = planned.streams(block);
    let mut buffer = DrawBuffer::new(prediction.channels.len());
    let mut absorbers: Vec<Absorber> =
        planned.questions.iter().map(|question| Absorber::new(&question.kind)).collect();
    let mut tallies = vec![Tally::default(); prediction.channels.len()];
    let mut lookups = Tally::default();
    let expected_lookups = prediction.lookups.as_ref().map_or(0.0, |law| law.mean);
    let (start, end) = (block * BLOCK, ((block + 1) * BLOCK).min(planned.horizon));
    let mut at = start;
    let (mut y, mut counts) = (Vec::new(), Vec::new());
    while at < end {
        let is_fixed = at < planned.fixed;
        let until = if is_fixed { end.min(planned.fixed) } else { end };
        #[allow(clippy::cast_possible_truncation)] // at most a buffer's length
        let count = (until - at).min(DrawBuffer::LENGTH as u64) as usize;
        ready.experiment.fill(&mut streams, count, &mut buffer);
        #[allow(clippy::cast_possible_truncation)] // below a block's length
        let first = (at - start) as usize;
        for (question, absorber) in planned.questions.iter().zip(&mut absorbers) {
            absorber.absorb(&question.kind, &buffer, first, is_fixed, &mut y);
        }
        if is_fixed {
            for ((tally, channel), values) in
                tallies.iter_mut().zip(&prediction.channels).zip(&buffer.values)
            {
                tally.merge(&Tally::of(values, channel.mean.value, channel.truth.value));
            }
            counts.clear();
            counts.extend(buffer.lookups.iter().map(|&lookups| f64::from(lookups)));
            lookups.merge(&Tally::of(&counts, expected_lookups, 1.0));
        }
        at += count as u64;
    }
    #[allow(clippy::cast_possible_truncation)] // below a block's length
    let fixed = end.min(planned.fixed).saturating_sub(start) as usize;
    let answers = planned
        .questions
        .iter()
        .zip(absorbers)
        .map(|(question, absorber)| absorber.answer(&question.kind, fixed))
        .collect();
    let seconds = begin.elapsed().as_secs_f64();
    Some(Block { draws: end - start, tallies, lookups, answers, seconds })
}

impl Absorber {
    fn new(kind: &Kind) -> Self {
        match kind {
            Kind::Scalar(_) => Self::Gate(Box::default(), 0.0),
            Kind::Law(law) => Self::Law(vec![0.0; law.size()]),
            Kind::Always(_) => Self::Largest(0.0),
            Kind::Inspection(_) | Kind::Untestable(_) => Self::Silent,
        }
    }

    fn absorb(
        &mut self,
        kind: &Kind,
        buffer: &DrawBuffer,
        first: usize,
        is_fixed: bool,
        y: &mut Vec<f64>,
    ) {
        match (self, kind) {
            (Self::Gate(sums, total), Kind::Scalar(scalar)) => {
                y.clear();
                (scalar.observe)(buffer, y);
                sums.absorb(y, &scalar.design.arguments());
                *total += sum(y);
            }
            (Self::Law(sums), Kind::Law(law)) if is_fixed => law.add(buffer, first, sums),
            (Self::Largest(most), Kind::Always(always)) => {
                *most = larger(*most, (always.largest)(buffer));
            }
            _ => {}
        }
    }

    fn answer(self, kind: &Kind, fixed: usize) -> Answer {
        match (self, kind) {
            (Self::Gate(sums, y), _) => Answer::Gate { psi: sums.totals(), y },
            (Self::Law(mut sums), Kind::Law(law)) => {
                if fixed > 0 {
                    law.close(fixed, &mut sums);
                }
                Answer::Law(sums)
            }
            (Self::Largest(most), _) => Answer::Largest(most),
            _ => Answer::Silent,
        }
    }
}

/// The sum in eight lanes, whose additions need not wait for each other.
fn sum(y: &[f64]) -> f64 {
    let (rows, rest) = y.as_chunks::<8>();
    let mut lanes = [0.0; 8];
    for row in rows {
        for (lane, y) in lanes.iter_mut().zip(row) {
            *lane += y;
        }
    }
    lanes.iter().sum::<f64>() + rest.iter().sum::<f64>()
}

/// The larger of two, or not a number where one is none.
#[must_use]
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}
