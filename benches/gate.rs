//! Cost of the gate: the built-in suite drawn with and without it, in turn, in one process.
//!
//! ```text
//! cargo bench --bench gate              # or with -- WORD: the cases whose name has the word
//! ```
//!
//! Every round draws the same blocks of every experiment of the suite in each of these ways, on one thread, and
//! measures the processor time. The table shows medians over the rounds of the differences and ratios within a round.
//!
//! | way | what is done to each draw |
//! |---|---|
//! | kernels | drawn |
//! | statistics | mean, variance and lookups of the summary, too |
//! | gate | the quantities of the gate, too |
//! | all checks | the sums of the distribution tests and the bounds on every draw, too |
//!
//! A second table lists, one by one, the experiments that take less than 20 ns for a bare draw, with the time that all
//! checks together add.

use std::hint::black_box;

use cpu_time::{ProcessTime, ThreadTime};
use gate::stats::verdict::BLOCK;
use trueflight::case::Case;
use trueflight::case::suite;
use trueflight::draw::block;
use trueflight::draw::run;
use trueflight::estimators::DrawBuffer;
use trueflight::plan::Amount;
use trueflight::plan::Options;
use trueflight::plan::Plan;
use trueflight::plan::PlannedExperiment;

/// Draws per experiment.
const DRAWS: u64 = 2 * BLOCK;
/// Rounds; the median counts.
const ROUNDS: usize = 7;

/// Work that is done on each draw.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    Kernels,
    Statistics,
    Gate,
    All,
}

const WAYS: [Way; 4] = [Way::Kernels, Way::Statistics, Way::Gate, Way::All];

fn main() {
    let cases: Vec<Case> = suite::suite()
        .iter()
        .map(|source| Case::read(source).expect("the built-in cases have no mistakes"))
        .collect();
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    one.install(|| {
        if let Some(word) = std::env::args().skip(1).find(|argument| !argument.starts_with('-')) {
            let is_wanted = |name: &str| name.contains(&word);
            report(&format!("cases with `{word}`"), &cases, &is_wanted);
            return cheap(&cases, &is_wanted);
        }
        report("the built-in suite", &cases, &|_| true);
        cheap(&cases, &|_| true);
        // Walks so short that the time of the gate shows beside theirs.
        let short: Vec<Case> = suite::calibration()
            .iter()
            .map(|source| Case::read(source).expect("the built-in cases have no mistakes"))
            .collect();
        report("short walks", &short, &|_| true);
    });
}

/// Times all ways over the wanted cases.
fn report(title: &str, cases: &[Case], is_wanted: &dyn Fn(&str) -> bool) {
    let options = Options { draws: Amount::Exactly(DRAWS), fixed: true, ..Options::default() };
    let plans = WAYS.map(|way| plan(cases, &options, way, is_wanted));
    let draws: u64 = plans[0].experiments().map(|(_, planned)| planned.draws).sum();
    let mut rounds: Vec<[f64; 4]> = Vec::new();
    for _ in 0..ROUNDS {
        let mut seconds = [0.0; 4];
        for (i, way) in WAYS.into_iter().enumerate() {
            let begin = ProcessTime::now();
            if way == Way::Kernels {
                kernels(&plans[i]);
            } else {
                run::draw(&plans[i], &|_| {});
            }
            seconds[i] = begin.elapsed().as_secs_f64();
        }
        rounds.push(seconds);
    }
    let scalars: usize = plans[2].experiments().map(|(_, planned)| planned.questions.len()).sum();
    let experiments = plans[2].experiments().count();
    println!(
        "{title}: {draws} draws, {experiments} experiments, {scalars} scalars, medians of {ROUNDS} \
         rounds"
    );
    let names = ["kernels", "statistics", "gate", "all checks"];
    println!("{:<12} {:>9} {:>18} {:>20}", "", "ns/draw", "added to the last", "times the last");
    for (i, name) in names.into_iter().enumerate() {
        let per_draw = |seconds: f64| 1e9 * seconds / draws as f64;
        let total = median(rounds.iter().map(|round| per_draw(round[i])));
        let before = i.saturating_sub(1);
        let added = median(rounds.iter().map(|round| per_draw(round[i] - round[before])));
        let ratio = median(rounds.iter().map(|round| round[i] / round[before]));
        println!("{name:<12} {total:>9.1} {added:>18.2} {ratio:>20.3}");
    }
}

fn plan<'a>(
    cases: &'a [Case],
    options: &Options,
    way: Way,
    is_wanted: &dyn Fn(&str) -> bool,
) -> Plan<'a> {
    let mut plan = Plan::new(cases, options);
    for case in &mut plan.cases {
        let is_wanted = is_wanted(&case.case.name);
        // Deterministic estimators draw one block only: they are left out.
        case.experiments
            .retain(|planned| is_wanted && planned.outcome.is_ok() && planned.draws == DRAWS);
        for planned in &mut case.experiments {
            planned.questions.retain(|question| match way {
                Way::Kernels | Way::Statistics => false,
                Way::Gate => question.answer.scalar().is_some(),
                Way::All => true,
            });
        }
    }
    plan
}

/// Makes the draws alone.
fn kernels(plan: &Plan) {
    for (_, planned) in plan.experiments() {
        let Ok(ready) = &planned.outcome else { continue };
        let mut buffer = DrawBuffer::new(ready.prediction.channels.len());
        for block in 0..planned.draws / BLOCK {
            bare(planned, block, &mut buffer);
        }
    }
}

/// Makes the draws of a block alone.
fn bare(planned: &PlannedExperiment, block: u64, buffer: &mut DrawBuffer) {
    let Ok(ready) = &planned.outcome else { return };
    let mut streams = planned.streams(block);
    for _ in 0..BLOCK / DrawBuffer::LENGTH as u64 {
        ready.experiment.fill(&mut streams, DrawBuffer::LENGTH, buffer);
        black_box(&buffer);
    }
}

/// Prints experiments so fast that the time of their checks shows, the largest relative cost first.
fn cheap(cases: &[Case], is_wanted: &dyn Fn(&str) -> bool) {
    const FAST: f64 = 20.0;
    let options = Options { draws: Amount::Exactly(DRAWS), fixed: true, ..Options::default() };
    let plan = plan(cases, &options, Way::All, is_wanted);
    let per_draw = |work: &mut dyn FnMut(u64)| {
        let begin = ThreadTime::now();
        (0..DRAWS / BLOCK).for_each(work);
        1e9 * begin.elapsed().as_secs_f64() / DRAWS as f64
    };
    let mut rows = Vec::new();
    for (case, planned) in plan.experiments() {
        let Ok(ready) = &planned.outcome else { continue };
        let mut buffer = DrawBuffer::new(ready.prediction.channels.len());
        let mut rounds = Vec::new();
        while rounds.len() < 3 * ROUNDS
            && rounds.iter().all(|&[bare, _]: &[f64; 2]| bare < 2.0 * FAST)
        {
            let alone = per_draw(&mut |block| bare(planned, block, &mut buffer));
            let whole = per_draw(&mut |block| drop(black_box(block::Block::drawn(planned, block))));
            rounds.push([alone, whole]);
        }
        let alone = median(rounds.iter().map(|round| round[0]));
        if alone < FAST && rounds.len() == 3 * ROUNDS {
            let whole = median(rounds.iter().map(|round| round[1]));
            let ratio = median(rounds.iter().map(|round| round[1] / round[0]));
            rows.push((ratio, alone, whole, format!("{} {}", case.case.name, planned.id.label())));
        }
    }
    rows.sort_by(|a, b| b.0.total_cmp(&a.0));
    println!("\n{} experiments below {FAST} ns a draw, ns bare and with all checks", rows.len());
    for (ratio, alone, whole, name) in &rows {
        println!("{ratio:>6.2}× {alone:>7.1} {whole:>7.1}  {name}");
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
