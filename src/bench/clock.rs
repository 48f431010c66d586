//! One round of one experiment, each way of drawing timed in turn.
//!
//! Only the filling of buffers is timed. Before the first lap of each way a buffer is filled and discarded, so that no
//! way is charged for memory that is read or mapped for the first time. Every other round takes the ways in reverse
//! order, so that no way always comes second.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use cpu_time::ThreadTime;
use fearless_simd::Level;
use gate::stats::verdict::BLOCK;
use serde::{Deserialize, Serialize};

use super::curve::BenchDraws;
use crate::plan::PlannedExperiment;
use estimators::{DrawBuffer, Kernel};

/// Clock of the times.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Clock {
    /// The time that the drawing thread had a processor: other processes hardly count.
    Processor,
    /// Wall-clock time, the only clock that shows the gain by several threads.
    Elapsed,
}

impl Clock {
    /// Returns the clock for a number of threads.
    pub fn of(threads: usize) -> Self {
        if threads > 1 { Self::Elapsed } else { Self::Processor }
    }

    /// Returns the word in tables and files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Processor => "processor",
            Self::Elapsed => "elapsed",
        }
    }

    /// Returns the seconds that a call takes.
    fn time(self, f: impl FnOnce()) -> f64 {
        match self {
            Self::Processor => {
                let begin = ThreadTime::now();
                f();
                begin.elapsed().as_secs_f64()
            }
            Self::Elapsed => {
                let begin = Instant::now();
                f();
                begin.elapsed().as_secs_f64()
            }
        }
    }
}

/// Times of one experiment in one round, in seconds per draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lap {
    /// One thread, as a run draws.
    pub single: f64,
    /// All threads together; `None` with one thread.
    pub together: Option<f64>,
    /// One thread, one draw after the other.
    pub plain: f64,
}

/// Timer of the ways of drawing.
#[derive(Debug, Clone, Copy)]
pub struct Stopwatch {
    /// Clock of the times.
    pub clock: Clock,
    /// Vector hardware.
    pub level: Level,
    /// Number of threads that draw at once.
    pub threads: usize,
}

impl Stopwatch {
    /// Times a round of an experiment; `sample` absorbs its draws. Rounds make different draws; the ways of drawing
    /// make the same draws.
    pub fn lap(
        &self,
        planned: &PlannedExperiment,
        round: u32,
        draws: u64,
        sample: &mut BenchDraws,
    ) -> Lap {
        let mut lap = Lap { single: 0.0, together: None, plain: 0.0 };
        let mut ways = [Way::Packets, Way::Together, Way::Plain];
        if round % 2 == 1 {
            ways.reverse();
        }
        sample.begin();
        for way in ways {
            match way {
                Way::Packets => {
                    let kernel = Kernel::Packets(self.level);
                    let look = |buffer: &DrawBuffer| sample.absorb(buffer);
                    lap.single = self.alone(planned, kernel, (round, draws), look);
                }
                Way::Together if self.threads > 1 => {
                    lap.together = Some(self.together(planned, round, draws));
                }
                Way::Together => {}
                Way::Plain => {
                    lap.plain = self.alone(planned, Kernel::Single, (round, draws), |_| {});
                }
            }
        }
        sample.end();
        lap
    }

    /// Returns the seconds per draw on this thread; `look` receives each buffer, untimed.
    fn alone(
        &self,
        planned: &PlannedExperiment,
        kernel: Kernel,
        (round, draws): (u32, u64),
        mut look: impl FnMut(&DrawBuffer),
    ) -> f64 {
        let mut seconds = 0.0;
        let first = u64::from(round) * draws.div_ceil(BLOCK);
        let mut buffer = warm(planned, kernel, draws);
        each_buffer(planned, kernel, (first, draws), |fill| {
            seconds += self.clock.time(|| fill(&mut buffer));
            look(&buffer);
        });
        seconds / draws as f64
    }

    /// Returns the seconds per draw on all threads of the pool. Each thread adds the same number of draws to the work,
    /// and a free thread takes the next block, as in a run. The clock starts when all threads are awake.
    fn together(&self, planned: &PlannedExperiment, round: u32, draws: u64) -> f64 {
        let (kernel, threads) = (Kernel::Packets(self.level), self.threads as u64);
        let (blocks, each) = (threads * draws.div_ceil(BLOCK), draws.min(BLOCK));
        let first = u64::from(round) * blocks;
        let (next, awake) = (AtomicU64::new(first), AtomicU64::new(0));
        let times = rayon::broadcast(|_| {
            let mut buffer = warm(planned, kernel, draws);
            awake.fetch_add(1, Ordering::Relaxed);
            while awake.load(Ordering::Relaxed) < threads {
                std::thread::yield_now();
            }
            let begin = Instant::now();
            loop {
                let block = next.fetch_add(1, Ordering::Relaxed);
                if block >= first + blocks {
                    return [begin, Instant::now()];
                }
                each_buffer(planned, kernel, (block, each), |fill| fill(&mut buffer));
            }
        });
        let begin = times.iter().map(|[begin, _]| *begin).min();
        let end = times.iter().map(|[_, end]| *end).max();
        let seconds = begin.zip(end).map_or(0.0, |(begin, end)| (end - begin).as_secs_f64());
        seconds / (blocks * each) as f64
    }
}

/// Way of drawing.
#[derive(Clone, Copy)]
enum Way {
    Packets,
    Together,
    Plain,
}

/// Returns a buffer that has been filled once.
fn warm(planned: &PlannedExperiment, kernel: Kernel, draws: u64) -> DrawBuffer {
    let channels = planned.outcome.as_ref().map_or(0, |ready| ready.prediction.channels.len());
    let mut buffer = DrawBuffer::new(channels);
    let draws = draws.min(DrawBuffer::length(channels) as u64);
    each_buffer(planned, kernel, (0, draws), |fill| fill(&mut buffer));
    buffer
}

/// Calls `f` for each buffer of the draws from block `first` on, with a function that fills the buffer.
fn each_buffer(
    planned: &PlannedExperiment,
    kernel: Kernel,
    (first, draws): (u64, u64),
    mut f: impl FnMut(&mut dyn FnMut(&mut DrawBuffer)),
) {
    let Ok(ready) = &planned.outcome else { return };
    let length = DrawBuffer::length(ready.prediction.channels.len()) as u64;
    for block in 0..draws.div_ceil(BLOCK) {
        let mut streams = planned.streams(first + block);
        let mut left = (draws - block * BLOCK).min(BLOCK);
        while left > 0 {
            #[allow(clippy::cast_possible_truncation)] // at most a buffer's length
            let count = left.min(length) as usize;
            f(&mut |buffer| ready.experiment.fill_by(kernel, &mut streams, count, buffer));
            left -= count as u64;
        }
    }
}
