//! Run time against error: cost of the draws of each estimator, and time until they reach an error.
//!
//! ```text
//! time to ε   V/(ε²T²) · time of a draw      until the standard error is ε of the truth
//! efficiency  1/(V · time of a draw)
//! fom         1/(V · lookups of a draw, with its share of the setup lookups)
//! speedup     time of a draw of the plain loop / time of a draw
//! ```
//!
//! V is the variance in theory, or that of the sample where theory has none. The plain loop makes the same draws one
//! after the other, as a textbook would. Both are timed in turn in every round (`clock`), so that a ratio is taken
//! within its round. The rounds go over all experiments again and again, so that a drift of the machine's speed affects
//! all of them. Medians are reported, with the minimum and the maximum of the rounds.
//!
//! The draws are the same for any number of threads on any machine; the times are not, and are kept apart
//! ([`record::Times`]).

pub mod clock;
mod curve;
pub mod record;
mod rows;
pub mod stored;

use std::time::Instant;

use fearless_simd::Level;

use self::clock::{Clock, Lap, Stopwatch};
use self::curve::BenchDraws;
use self::record::{Bench, BenchCase, Conditions, Spread};
use crate::plan::{Plan, PlannedCase, PlannedExperiment};
use numeric::pack;

/// Amount of draws that are timed, and the hardware.
#[derive(Debug, Clone, Copy)]
pub struct Amounts {
    /// Draws of an experiment in a round.
    pub draws: u64,
    /// Rounds.
    pub rounds: u32,
    /// The vector hardware that is used, one of [`pack::levels`].
    pub level: Level,
}

/// Times every experiment of a plan on the threads of the pool in which it is called. After each experiment of each
/// round, `progress` receives the number of draws that were timed.
///
/// With one thread it times by processor time, with several by elapsed time.
pub fn measure(plan: &Plan, amounts: Amounts, progress: &dyn Fn(u64)) -> Bench {
    let begin = Instant::now();
    let threads = rayon::current_num_threads();
    let stopwatch = Stopwatch { clock: Clock::of(threads), level: amounts.level, threads };
    let all = plan.experiments().map(|(case, planned)| {
        let sample = BenchDraws::of(planned, amounts.draws);
        TimedExperiment { case, planned, laps: Vec::new(), sample }
    });
    let mut all: Vec<TimedExperiment> = all.collect();
    for round in 0..amounts.rounds {
        for one in all.iter_mut().filter(|one| one.planned.outcome.is_ok()) {
            one.laps.push(stopwatch.lap(one.planned, round, amounts.draws, &mut one.sample));
            progress(amounts.draws);
        }
    }
    let cases = all.chunk_by(|a, b| a.planned.id.case == b.planned.id.case);
    let cases: Vec<BenchCase> = cases.map(case_of).collect();
    let speedups =
        cases.iter().flat_map(BenchCase::experiments).filter_map(|row| row.times.as_ref());
    Bench {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: plan.options.seed,
        draws: amounts.draws,
        rounds: amounts.rounds,
        conditions: Conditions {
            threads,
            clock: stopwatch.clock,
            level: pack::word(amounts.level),
            seconds: begin.elapsed().as_secs_f64(),
            speedup: Spread::of(speedups.map(|times| times.speedup.median)),
        },
        cases,
        comparison: None,
    }
}

/// Experiment with its times and draws.
struct TimedExperiment<'p> {
    case: &'p PlannedCase<'p>,
    planned: &'p PlannedExperiment,
    /// Times of each round; empty for a refused experiment.
    laps: Vec<Lap>,
    sample: BenchDraws,
}

fn case_of(measured: &[TimedExperiment]) -> BenchCase {
    let case = measured[0].case.case;
    let mut rows: Vec<_> = measured.iter().flat_map(rows::of).collect();
    rows::choose(&mut rows);
    BenchCase {
        name: case.name.clone(),
        title: case.title.clone(),
        problem: case.problem.clone(),
        medium: case.scenario.medium().to_owned(),
        digest: format!("{:016x}", case.digest),
        swept: case.sweep.as_ref().map(|axis| axis.what),
        rows,
    }
}
