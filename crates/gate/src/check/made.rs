//! Draws that closures make, block by block, on one thread or several.

use std::any::Any;
use std::num::NonZero;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

use super::builder::{Check, MOST};
use super::error::CheckError;
use super::outcome::Outcome;
use super::sample::Sample;
use crate::judge::judgement::Stop;
use crate::judge::reading::Reading;
use crate::judge::trial::BUFFER;
use numeric::rng::{Address, Stream, name_hash};

/// A closure that makes one draw a call.
#[derive(Debug, Clone)]
pub struct Closure<F> {
    pub(super) draw: F,
}

/// A factory of such closures, one for each thread.
#[derive(Debug, Clone)]
pub struct Factory<M> {
    pub(super) make: M,
    pub(super) threads: Option<usize>,
}

/// The draws of a block.
struct Block {
    columns: Vec<Vec<f64>>,
    lookups: Vec<f64>,
}

/// What a closure said when it panicked, and in which draw of its block.
struct Panic {
    draw: u64,
    message: String,
}

/// Which draws are made.
#[derive(Clone, Copy)]
struct Plan {
    seed: u64,
    experiment: u64,
    most: u64,
}

impl Plan {
    fn blocks(self) -> u64 {
        self.most.div_ceil(BUFFER as u64)
    }

    /// Makes the draws of a block.
    fn draw<T: Sample>(
        self,
        number: u64,
        draw: &mut impl FnMut(&mut Stream) -> T,
    ) -> Result<Block, Panic> {
        let left = self.most - number * BUFFER as u64;
        let count = usize::try_from(left).map_or(BUFFER, |left| left.min(BUFFER));
        let column = || Vec::with_capacity(count);
        let mut block = Block { columns: vec![column(); T::VALUES], lookups: Vec::new() };
        // A clone of an empty column has no room of its own.
        block.columns.iter_mut().for_each(|column| column.reserve(count));
        let Self { seed, experiment, .. } = self;
        let mut stream = Address { seed, experiment, block: number, lane: 0 }.stream();
        let drawn = catch_unwind(AssertUnwindSafe(|| {
            for _ in 0..count {
                let sample = draw(&mut stream);
                if T::HAS_LOOKUPS {
                    block.lookups.push(sample.lookups());
                }
                sample.append(&mut block.columns);
            }
        }));
        drawn.map_err(|panic| Panic {
            draw: number * BUFFER as u64 + block.columns.first().map_or(0, |c| c.len() as u64),
            message: message(&*panic),
        })?;
        Ok(block)
    }
}

/// What a panic said.
fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "no message".to_owned())
}

impl Check<()> {
    /// Judges blocks as they come, until all is decided or there are no more.
    fn judged<T: Sample>(
        &self,
        mut next: impl FnMut(Plan, u64) -> Result<Block, Panic>,
    ) -> Result<Outcome, CheckError> {
        let (seed, experiment) = (self.said.seed, name_hash(&self.name));
        let plan = Plan { seed, experiment, most: self.said.draws.unwrap_or(MOST) };
        let mut readings = self.readings(T::VALUES, T::HAS_LOOKUPS, self.said.draws)?;
        let mut stopped = None;
        for number in 0..plan.blocks() {
            let block = next(plan, number).map_err(|Panic { draw, message }| {
                CheckError::Panicked { name: self.name.clone(), draw, seed, message }
            })?;
            let columns: Vec<&[f64]> = block.columns.iter().map(Vec::as_slice).collect();
            Reading::absorb_values(&mut readings, &columns, &block.lookups);
            let is_open = readings.iter().any(Reading::is_open);
            if self.said.draws.is_none() && !is_open {
                stopped = Some(Stop::Decided);
                break;
            }
        }
        if self.said.draws.is_none() && stopped.is_none() {
            stopped = Some(Stop::Limit);
        }
        Ok(self.outcome(readings, stopped))
    }

    /// What is said in the end.
    pub(super) fn outcome(&self, readings: Vec<Reading>, stopped: Option<Stop>) -> Outcome {
        let channels = self.said.names(readings.len());
        let values = readings.into_iter().map(|reading| reading.close(stopped)).collect();
        Outcome { name: self.name.clone(), alpha: self.said.alpha, channels, values }
    }
}

impl<S> Check<S> {
    /// The source of draws, and all else.
    fn parted(self) -> (S, Check<()>) {
        (self.source, Check { name: self.name, source: (), said: self.said })
    }
}

impl<T: Sample, F: FnMut(&mut Stream) -> T> Check<Closure<F>> {
    /// Draws and judges.
    ///
    /// # Errors
    ///
    /// What was said of the draws makes no sense, or the closure panics.
    pub fn verdict(self) -> Result<Outcome, CheckError> {
        let (Closure { mut draw }, check) = self.parted();
        check.judged::<T>(|plan, number| plan.draw(number, &mut draw))
    }

    /// Draws and judges; panics unless the estimator passes.
    ///
    /// # Panics
    ///
    /// The verdict is fail or inconclusive, or there is none.
    #[track_caller]
    pub fn assert_pass(self) {
        assert_pass(&self.verdict());
    }
}

impl<T: Sample, F: FnMut(&mut Stream) -> T, M: Fn() -> F + Sync> Check<Factory<M>> {
    /// So many threads; without it one for each processor. The verdict does not depend on it.
    pub fn threads(mut self, threads: usize) -> Self {
        self.source.threads = Some(threads.max(1));
        self
    }

    /// Draws and judges.
    ///
    /// # Errors
    ///
    /// What was said of the draws makes no sense, or a closure panics.
    pub fn verdict(self) -> Result<Outcome, CheckError> {
        let (Factory { make, threads }, check) = self.parted();
        let threads = threads.or_else(|| thread::available_parallelism().map(NonZero::get).ok());
        let threads = threads.unwrap_or(1);
        thread::scope(|scope| {
            let mut blocks: Vec<Receiver<Result<Block, Panic>>> = Vec::new();
            check.judged::<T>(|plan, number| {
                if blocks.is_empty() {
                    blocks.extend((0..threads).map(|first| {
                        let (sender, receiver) = sync_channel(AHEAD);
                        let make = &make;
                        scope.spawn(move || work::<T, F>(plan, make, first..threads, &sender));
                        receiver
                    }));
                }
                let turn = usize::try_from(number % threads as u64).unwrap_or(0);
                blocks[turn].recv().unwrap_or_else(|_| {
                    let message = "its thread ended before its time".to_owned();
                    Err(Panic { draw: number * BUFFER as u64, message })
                })
            })
        })
    }

    /// Draws and judges; panics unless the estimator passes.
    ///
    /// # Panics
    ///
    /// The verdict is fail or inconclusive, or there is none.
    #[track_caller]
    pub fn assert_pass(self) {
        assert_pass(&self.verdict());
    }
}

/// So many blocks a thread is ahead of the gate at most.
const AHEAD: usize = 2;

/// Makes every `turn.end`-th block from `turn.start` on, until nobody wants more.
fn work<T: Sample, F: FnMut(&mut Stream) -> T>(
    plan: Plan,
    make: &impl Fn() -> F,
    turn: Range<usize>,
    blocks: &SyncSender<Result<Block, Panic>>,
) {
    let first = turn.start as u64;
    let mut draw = match catch_unwind(AssertUnwindSafe(make)) {
        Ok(draw) => draw,
        Err(panic) => {
            let (draw, message) = (first * BUFFER as u64, message(&*panic));
            let _ = blocks.send(Err(Panic { draw, message }));
            return;
        }
    };
    for number in (first..plan.blocks()).step_by(turn.end) {
        let block = plan.draw(number, &mut draw);
        let is_last = block.is_err();
        if blocks.send(block).is_err() || is_last {
            return;
        }
    }
}

/// Panics unless a check passes.
#[track_caller]
pub(super) fn assert_pass(outcome: &Result<Outcome, CheckError>) {
    match outcome {
        Ok(outcome) => outcome.assert_pass(),
        Err(error) => panic!("{error}"),
    }
}
