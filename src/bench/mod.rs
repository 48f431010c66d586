//! Run time against error: what each estimator's draws cost, and how soon they reach an error.
//!
//! ```text
//! time to ε   V/(ε²T²) · time of a draw      until the standard error is ε of the truth
//! efficiency  1/(V · time of a draw)
//! fom         1/(V · lookups of a draw, with its share of the setup lookups)
//! speedup     time of a draw of the plain loop / time of a draw
//! ```
//!
//! V is the variance in theory, or the sample's where theory has none. The plain loop makes the same
//! draws one after the other, as a textbook would. Both are timed in turn in every round (`clock`), so
//! that a ratio is taken within its round; the rounds go over all experiments again and again, so that
//! what drifts on the machine drifts for all of them. Medians are reported, with the least and the
//! most of the rounds.
//!
//! What was drawn is the same for any number of threads on any machine; the times are not, and are
//! kept apart ([`record::Times`]).

pub mod clock;
pub mod compare;
pub mod comparison;
pub mod curve;
pub mod figures;
pub mod record;
pub mod rows;
pub mod spread;
pub mod stored;

use std::time::Instant;

use fearless_simd::Level;

use self::clock::{Clock, Stopwatch};
use self::curve::Sample;
use self::record::{Bench, BenchCase, Conditions};
use self::rows::Laps;
use self::spread::Spread;
use crate::plan::{Plan, PlannedCase};
#[cfg(doc)]
use numeric::pack;

/// How much is timed, and with what.
#[derive(Debug, Clone, Copy)]
pub struct Amounts {
    /// Draws of an experiment in a round.
    pub draws: u64,
    /// Rounds.
    pub rounds: u32,
    /// The vector hardware that is used, one of [`pack::levels`].
    pub level: Level,
}

/// Times every experiment of a plan on the threads of the pool in which it is called; `progress` is
/// told after each experiment of each round how many draws were timed.
///
/// With one thread it times by processor time, with several by elapsed time.
pub fn measure(plan: &Plan, amounts: Amounts, progress: &dyn Fn(u64)) -> Bench {
    let begin = Instant::now();
    let threads = rayon::current_num_threads();
    let stopwatch = Stopwatch { clock: Clock::of(threads), level: amounts.level, threads };
    let timed =
        || plan.experiments().filter_map(|(_, planned)| planned.outcome.is_ok().then_some(planned));
    let mut all: Vec<(Laps, Sample)> =
        timed().map(|planned| (Laps::default(), Sample::of(planned, amounts.draws))).collect();
    for round in 0..amounts.rounds {
        for (planned, (laps, sample)) in timed().zip(&mut all) {
            laps.push(stopwatch.lap(planned, round, amounts.draws, sample));
            progress(amounts.draws);
        }
    }
    let mut found = all.into_iter();
    let cases: Vec<BenchCase> = plan.cases.iter().map(|case| case_of(case, &mut found)).collect();
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
            level: stopwatch.level_name(),
            seconds: begin.elapsed().as_secs_f64(),
            speedup: Spread::of(speedups.map(|times| times.speedup.median)),
        },
        cases,
        comparison: None,
    }
}

fn case_of(planned: &PlannedCase, found: &mut impl Iterator<Item = (Laps, Sample)>) -> BenchCase {
    let case = planned.case;
    let (mut rows, mut estimators) = (Vec::new(), Vec::new());
    for experiment in &planned.experiments {
        match &experiment.outcome {
            Err(refusal) => rows.push(rows::refused(experiment, refusal)),
            Ok(ready) => {
                // In the order in which they were timed.
                let Some((laps, sample)) = found.next() else { continue };
                rows.extend(rows::measured(experiment, ready, &laps, &sample));
            }
        }
        estimators.resize(rows.len(), experiment.estimator);
    }
    rows::choose(&mut rows, &estimators);
    BenchCase {
        name: case.name.clone(),
        title: case.title.clone(),
        problem: case.problem.clone(),
        medium: case.scenario.medium().to_owned(),
        digest: format!("{:016x}", case.digest),
        swept: case.sweep.as_ref().map(|axis| axis.what.key().to_owned()),
        rows,
    }
}
