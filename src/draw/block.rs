//! One block of one experiment, drawn and absorbed by its questions; and the totals of blocks, merged in the order of
//! their addresses.
//!
//! A block is 2¹⁴ draws, found by its address. Its draws are made buffer by buffer; every question
//! absorbs each buffer while it is in the second-level cache. P-values and z-scores see only the
//! draws below the plan's fixed number.

use std::cell::RefCell;

use cpu_time::ThreadTime;
use serde::{Deserialize, Serialize};

use crate::case::Ready;
use crate::plan::{PlannedCase, PlannedExperiment};
use checks::batch::Batch;
use checks::check::{BufferPlace, Observer, Total};
use estimators::DrawBuffer;
use gate::stats::Tally;
use gate::stats::verdict::BLOCK;
use numeric::rng::Streams;

/// Numbers of one block of one experiment.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Block {
    /// Number of draws.
    pub draws: u64,
    /// One tally per channel over the fixed draws, in units of the truth about the predicted mean.
    pub tallies: Vec<Tally>,
    /// The lookups of the fixed draws about their predicted mean.
    pub lookups: Tally,
    /// For each question the numbers of its check.
    pub answers: Vec<Vec<f64>>,
    /// Processor seconds.
    pub seconds: f64,
}

/// Draws `every` blocks one after the other and merges them into block number `number` of that size. `None` for a
/// refused experiment, or if `is_over` becomes true before the last block.
pub fn merged(
    planned: &PlannedExperiment,
    number: u64,
    every: u64,
    is_over: &dyn Fn() -> bool,
) -> Option<Block> {
    let mut result: Option<Block> = None;
    for block in number * every..(number + 1) * every {
        if block * BLOCK >= planned.horizon {
            break;
        }
        if is_over() {
            return None;
        }
        let next = Block::drawn(planned, block)?;
        match &mut result {
            Some(all) => all.merge(planned, &next),
            none => *none = Some(next),
        }
    }
    result
}

impl Block {
    /// Draws a block of an experiment; `None` if it is refused.
    pub fn drawn(planned: &PlannedExperiment, block: u64) -> Option<Self> {
        // Processor time, not wall time: other processes do not count.
        let begin = ThreadTime::now();
        let mut drawing = OpenBlock::begin(planned, block)?;
        while drawing.count() > 0 {
            drawing.fill();
            drawing.absorb();
        }
        Some(drawing.close(begin.elapsed().as_secs_f64()))
    }

    /// Adds the block that follows.
    fn merge(&mut self, planned: &PlannedExperiment, next: &Self) {
        self.draws += next.draws;
        self.seconds += next.seconds;
        self.lookups.merge(&next.lookups);
        self.tallies.iter_mut().zip(&next.tallies).for_each(|(tally, next)| tally.merge(next));
        let questions = planned.questions.iter().zip(&mut self.answers);
        for ((question, numbers), next) in questions.zip(&next.answers) {
            question.answer.join(numbers, next);
        }
    }
}

/// Scratch for draws and for the values that a question observes.
#[derive(Default)]
struct Scratch {
    buffer: DrawBuffer,
    y: Vec<f64>,
}

thread_local! {
    /// Memory that earlier blocks of the thread have left. Allocating it for each block would take as much time as some
    /// of the questions.
    static SCRATCH: RefCell<Vec<Scratch>> = const { RefCell::new(Vec::new()) };
}

impl Scratch {
    fn take(channels: usize) -> Self {
        let mut scratch: Self = SCRATCH.with_borrow_mut(Vec::pop).unwrap_or_default();
        scratch.buffer.set_channels(channels);
        scratch
    }

    fn leave(self) {
        SCRATCH.with_borrow_mut(|scratchs| scratchs.push(self));
    }
}

/// Block that is being drawn.
struct OpenBlock<'p> {
    planned: &'p PlannedExperiment,
    ready: &'p Ready,
    streams: Streams,
    /// Number of draws that the buffer takes.
    length: u64,
    scratch: Scratch,
    observers: Vec<Box<dyn Observer + 'p>>,
    tallies: Vec<Tally>,
    lookups: Tally,
    /// Numbers of its first draw, of the next one, and of the first one behind it.
    start: u64,
    at: u64,
    end: u64,
}

impl<'p> OpenBlock<'p> {
    /// Starts at the first draw; `None` for a refused experiment.
    fn begin(planned: &'p PlannedExperiment, block: u64) -> Option<Self> {
        let ready = planned.outcome.as_ref().ok()?;
        let channels = ready.prediction.channels.len();
        let start = block * BLOCK;
        Some(Self {
            planned,
            ready,
            streams: planned.streams(block),
            length: DrawBuffer::length(channels) as u64,
            scratch: Scratch::take(channels),
            observers: planned.questions.iter().map(|q| q.answer.observe()).collect(),
            tallies: vec![Tally::default(); channels],
            lookups: Tally::default(),
            start,
            at: start,
            end: (start + BLOCK).min(planned.horizon),
        })
    }

    /// Returns whether the next draws are among those that the plan has fixed.
    fn is_fixed(&self) -> bool {
        self.at < self.planned.fixed
    }

    /// Returns the number of draws that the next buffer takes; 0 at the end.
    #[allow(clippy::cast_possible_truncation)] // at most a buffer's length
    fn count(&self) -> usize {
        let until = if self.is_fixed() { self.end.min(self.planned.fixed) } else { self.end };
        until.saturating_sub(self.at).min(self.length) as usize
    }

    fn fill(&mut self) {
        let count = self.count();
        self.ready.experiment.fill(&mut self.streams, count, &mut self.scratch.buffer);
    }

    /// Lets every question absorb the buffer.
    fn absorb(&mut self) {
        let (count, is_fixed) = (self.count(), self.is_fixed());
        let Scratch { buffer, y } = &mut self.scratch;
        let draws = Batch::new(buffer);
        #[allow(clippy::cast_possible_truncation)] // below a block's length
        let first = (self.at - self.start) as usize;
        for observer in &mut self.observers {
            observer.absorb(&draws, BufferPlace { first, is_fixed }, y);
        }
        if is_fixed {
            let prediction = &self.ready.prediction;
            let channels = self.tallies.iter_mut().zip(&prediction.channels);
            for (index, (tally, channel)) in channels.enumerate() {
                tally.merge(&draws.tally(index, channel.mean.value, channel.truth.value));
            }
            let expected =
                prediction.lookups.as_ref().map_or(0.0, |distribution| distribution.mean);
            self.lookups.merge(&draws.tally_of_lookups(expected));
        }
        self.at += count as u64;
    }

    fn close(self, seconds: f64) -> Block {
        #[allow(clippy::cast_possible_truncation)] // below a block's length
        let fixed = self.end.min(self.planned.fixed).saturating_sub(self.start) as usize;
        let Self { observers, tallies, lookups, .. } = self;
        let answers = observers.into_iter().map(|observer| observer.close(fixed)).collect();
        self.scratch.leave();
        Block { draws: self.end - self.start, tallies, lookups, answers, seconds }
    }
}

/// Draws of one experiment.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Drawn {
    /// Number of draws that all of its checks absorbed.
    pub draws: u64,
    /// One tally per channel over the fixed draws, in units of the truth about the predicted mean.
    pub tallies: Vec<Tally>,
    /// The lookups of the fixed draws, about their predicted mean.
    pub lookups: Tally,
    /// One total per question.
    pub totals: Vec<Total>,
    /// Processor seconds.
    pub seconds: f64,
    /// True if an earlier run drew it.
    #[serde(skip)]
    pub is_reused: bool,
}

/// Progress of an experiment: everything that further draws and decisions depend on.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// Draws so far.
    pub drawn: Drawn,
    /// Number of merged blocks.
    pub blocks: u64,
    /// Number of blocks after which the next look comes.
    pub look: u64,
    /// True if nothing is left to draw.
    pub is_done: bool,
}

impl Progress {
    /// Returns the progress before the first block.
    pub fn new(planned: &PlannedExperiment) -> Self {
        Self { drawn: Drawn::new(planned), look: 1, ..Self::default() }
    }
}

/// Experiment of a plan with its draws; no draws if it is refused.
#[derive(Clone)]
pub struct DrawnExperiment<'p> {
    /// The case.
    pub case: &'p PlannedCase<'p>,
    /// The experiment.
    pub planned: &'p PlannedExperiment,
    /// Its draws.
    pub drawn: Drawn,
}

/// Everything that a plan drew.
#[derive(Clone)]
pub struct Draws<'p> {
    /// The experiments, in the order of the plan.
    pub experiments: Vec<DrawnExperiment<'p>>,
    /// True if a time limit or a request to stop ended the drawing.
    pub cut_by_time: bool,
    /// True if the budget of draws ended the drawing.
    pub cut_by_budget: bool,
}

impl Drawn {
    /// Returns the sums without draws.
    pub fn new(planned: &PlannedExperiment) -> Self {
        let totals = planned.questions.iter().map(|question| question.answer.total());
        let channels = planned.outcome.as_ref().map_or(0, |ready| ready.prediction.channels.len());
        let tallies = vec![Tally::default(); channels];
        Self { totals: totals.collect(), tallies, ..Self::default() }
    }

    /// Adds the block that follows.
    pub fn merge(&mut self, planned: &PlannedExperiment, block: &Block, number: u64) {
        self.draws += block.draws;
        for (tally, other) in self.tallies.iter_mut().zip(&block.tallies) {
            tally.merge(other);
        }
        self.lookups.merge(&block.lookups);
        let questions = planned.questions.iter().zip(&mut self.totals);
        for ((question, total), numbers) in questions.zip(&block.answers) {
            question.answer.merge(total, numbers, number);
        }
        self.seconds += block.seconds;
    }
}
