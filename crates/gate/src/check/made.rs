//! Draws that closures make, block by block, on one thread or several.

use std::any::Any;
use std::num::NonZero;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

use super::builder::Check;
use super::outcome::{CheckError, CheckFault, Outcome, assert_pass};
use super::pushed::{BlockPlan, BlockRequest};
use super::sample::{Closure, Factory, Sample};
use crate::session::Block;
use numeric::rng::Stream;

/// Message of a closure's panic, and its draw in the block.
struct Panic {
    draw: u64,
    message: String,
}

/// Makes the draws of a block.
fn block<T: Sample>(
    request: BlockRequest,
    draw: &mut impl FnMut(&mut Stream) -> T,
) -> Result<Block, Panic> {
    let count = request.draws;
    let mut block = Block::new(T::VALUES);
    block.columns.iter_mut().for_each(|column| column.reserve(count));
    let mut stream = request.stream();
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
        draw: request.first() + block.columns.first().map_or(0, |c| c.len() as u64),
        message: message(&*panic),
    })?;
    Ok(block)
}

/// Message of a panic.
fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "no message".to_owned())
}

impl Check<()> {
    /// Judges the blocks of a source until the verdict is decided or the maximum number of draws is reached.
    fn judged<T: Sample>(
        self,
        mut source: impl FnMut(BlockRequest) -> Result<Block, Panic>,
    ) -> Result<Outcome, CheckError> {
        let (name, seed, length) = (self.name.clone(), self.said.seed, self.said.options.maximum);
        let mut pushed = self.begun(T::VALUES, T::HAS_LOOKUPS, length)?;
        pushed.drive(|pushed, request| {
            let block = source(request).map_err(|Panic { draw, message }| {
                CheckFault::Panicked { draw, seed, message }.of(&name)
            })?;
            pushed.absorb_block(&block);
            Ok(true)
        })?;
        pushed.verdict()
    }
}

impl<S> Check<S> {
    /// Splits into the source of draws and the rest of the check.
    fn parted(self) -> (S, Check<()>) {
        (self.source, Check { name: self.name, source: (), said: self.said })
    }
}

impl<T: Sample, F: FnMut(&mut Stream) -> T> Check<Closure<F>> {
    /// Draws and judges.
    ///
    /// # Errors
    ///
    /// The properties of the draws are invalid, or the closure panics.
    pub fn verdict(self) -> Result<Outcome, CheckError> {
        let (Closure { mut draw }, check) = self.parted();
        check.judged::<T>(|request| block(request, &mut draw))
    }

    /// Draws and judges; panics unless the estimator passes.
    ///
    /// # Panics
    ///
    /// The verdict is fail or inconclusive, or an error.
    #[track_caller]
    pub fn assert_pass(self) {
        assert_pass(&self.verdict());
    }
}

impl<T: Sample, F: FnMut(&mut Stream) -> T, M: Fn() -> F + Sync> Check<Factory<M>> {
    /// Number of threads; the default is one for each processor. The verdict does not depend on it.
    pub fn threads(mut self, threads: usize) -> Self {
        self.source.threads = Some(threads.max(1));
        self
    }

    /// Draws and judges.
    ///
    /// # Errors
    ///
    /// The properties of the draws are invalid, or a closure panics.
    pub fn verdict(self) -> Result<Outcome, CheckError> {
        let (Factory { make, threads }, check) = self.parted();
        let threads = threads.or_else(|| thread::available_parallelism().map(NonZero::get).ok());
        let threads = threads.unwrap_or(1);
        thread::scope(|scope| {
            let mut blocks: Vec<Receiver<Result<Block, Panic>>> = Vec::new();
            check.judged::<T>(|request| {
                if blocks.is_empty() {
                    blocks.extend((0..threads).map(|first| {
                        let (sender, receiver) = sync_channel(AHEAD);
                        let (make, plan) = (&make, request.plan);
                        scope.spawn(move || work::<T, F>(plan, make, first..threads, &sender));
                        receiver
                    }));
                }
                let turn = usize::try_from(request.block % threads as u64).unwrap_or(0);
                blocks[turn].recv().unwrap_or_else(|_| {
                    let message = "its thread ended before its time".to_owned();
                    Err(Panic { draw: request.first(), message })
                })
            })
        })
    }

    /// Draws and judges; panics unless the estimator passes.
    ///
    /// # Panics
    ///
    /// The verdict is fail or inconclusive, or an error.
    #[track_caller]
    pub fn assert_pass(self) {
        assert_pass(&self.verdict());
    }
}

/// Maximum number of blocks by which a thread is ahead of the gate.
const AHEAD: usize = 2;

/// Makes every `turn.end`-th block from `turn.start` on, until no receiver is left.
fn work<T: Sample, F: FnMut(&mut Stream) -> T>(
    plan: BlockPlan,
    make: &impl Fn() -> F,
    turn: Range<usize>,
    blocks: &SyncSender<Result<Block, Panic>>,
) {
    let mut requests = plan.requests().skip(turn.start).step_by(turn.end);
    let mut draw = match catch_unwind(AssertUnwindSafe(make)) {
        Ok(draw) => draw,
        Err(panic) => {
            let (draw, message) = (requests.next().map_or(0, |r| r.first()), message(&*panic));
            let _ = blocks.send(Err(Panic { draw, message }));
            return;
        }
    };
    for request in requests {
        let block = block(request, &mut draw);
        let is_last = block.is_err();
        if blocks.send(block).is_err() || is_last {
            return;
        }
    }
}
