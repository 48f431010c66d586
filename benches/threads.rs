//! Gain by a second thread on each medium of the built-in suite.
//!
//! ```text
//! cargo bench --bench threads
//! ```
//!
//! Windows of some milliseconds on one thread and on two take turns, in rounds over all experiments, so that a drift of
//! the machine's speed affects all of them. The last line is a loop of multiply-adds in registers, which shares
//! nothing. Where it gains less than twice, the machine or its host has no second processor free at the time.

use std::collections::{BTreeMap, BTreeSet};
use std::hint::black_box;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use gate::stats::verdict::BLOCK;
use trueflight::case::Case;
use trueflight::case::suite;
use trueflight::estimators::DrawBuffer;
use trueflight::plan::Options;
use trueflight::plan::Plan;
use trueflight::plan::PlannedExperiment;

/// Number of threads.
const THREADS: usize = 2;
/// Rounds; the median counts.
const ROUNDS: usize = 101;
/// Seconds of a window on one thread.
const WINDOW: f64 = 4e-3;

/// Work of a thread, given the thread's number and a count.
type Work<'a> = dyn Fn(usize, u64) + Sync + 'a;

/// Work that is timed.
struct Timed<'a> {
    medium: &'a str,
    name: String,
    work: Box<Work<'a>>,
    /// Count that fills a window.
    count: u64,
    gains: Vec<f64>,
}

impl<'a> Timed<'a> {
    fn new(medium: &'a str, name: String, work: Box<Work<'a>>) -> Self {
        let mut count = 64;
        while alone(&*work, count) < WINDOW {
            count *= 2;
        }
        Self { medium, name, work, count, gains: Vec::new() }
    }

    fn round(&mut self) {
        let [one, all] = [alone(&*self.work, self.count), together(&*self.work, self.count)];
        self.gains.push(THREADS as f64 * one / all);
    }
}

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(THREADS).build().expect("threads");
    let sources = suite::suite();
    let cases: Vec<Case> = sources
        .iter()
        .map(|source| Case::read(source).expect("the built-in cases have no mistakes"))
        .collect();
    let plan = Plan::new(&cases, &Options::default());
    pool.install(|| {
        let mut all =
            vec![Timed::new("–", "multiply-adds in registers".into(), Box::new(registers))];
        let mut seen = BTreeSet::new();
        for (case, planned) in plan.experiments() {
            let medium = case.case.scenario.medium();
            let has_chance = planned.outcome.is_ok() && planned.draws > BLOCK;
            if has_chance && seen.insert((medium, planned.id.label())) {
                let name = format!("{} {}", case.case.name, planned.id.label());
                let work = move |thread: usize, draws| bare(planned, thread, draws);
                all.push(Timed::new(medium, name, Box::new(work)));
            }
        }
        for _ in 0..ROUNDS {
            all.iter_mut().for_each(Timed::round);
        }
        report(all);
    });
}

/// Prints a line for each medium.
fn report(all: Vec<Timed>) {
    let mut media: BTreeMap<&str, Vec<(f64, String)>> = BTreeMap::new();
    for timed in all {
        media.entry(timed.medium).or_default().push((median(timed.gains), timed.name));
    }
    println!("{THREADS} threads, medians of {ROUNDS} rounds");
    println!("{:<20} {:>11} {:>7} {:>7}  least for", "medium", "experiments", "median", "least");
    for (medium, gains) in media {
        let typical = median(gains.iter().map(|(gain, _)| *gain).collect());
        let (minimum, name) =
            gains.iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("a medium has experiments");
        println!("{medium:<20} {:>11} {typical:>7.2} {minimum:>7.2}  {name}", gains.len());
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Makes multiply-adds that depend on no memory and on no other thread.
fn registers(_: usize, count: u64) {
    let mut values = [1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7];
    for _ in 0..count {
        for value in &mut values {
            *value = *value * 0.999_999 + 1e-7;
        }
    }
    black_box(values);
}

/// Draws alone; threads take blocks in turn.
fn bare(planned: &PlannedExperiment, thread: usize, draws: u64) {
    let Ok(ready) = &planned.outcome else { return };
    let mut buffer = DrawBuffer::new(ready.prediction.channels.len());
    let mut left = usize::try_from(draws).expect("as many as fit into a window");
    for block in (thread as u64..).step_by(THREADS) {
        let count = left.min(DrawBuffer::LENGTH);
        ready.experiment.fill(&mut planned.streams(block), count, &mut buffer);
        black_box(&buffer);
        left -= count;
        if left == 0 {
            return;
        }
    }
}

/// Returns the seconds on this thread.
fn alone(work: &Work, count: u64) -> f64 {
    let begin = Instant::now();
    work(0, count);
    begin.elapsed().as_secs_f64()
}

/// Returns the seconds until all threads have finished; the clock starts when all are awake.
fn together(work: &Work, count: u64) -> f64 {
    let awake = AtomicUsize::new(0);
    let times = rayon::broadcast(|context| {
        awake.fetch_add(1, Ordering::Relaxed);
        while awake.load(Ordering::Relaxed) < THREADS {
            std::hint::spin_loop();
        }
        let begin = Instant::now();
        work(context.index(), count);
        [begin, Instant::now()]
    });
    let begin = times.iter().map(|[begin, _]| *begin).min().expect("a thread");
    let end = times.iter().map(|[_, end]| *end).max().expect("a thread");
    (end - begin).as_secs_f64()
}
