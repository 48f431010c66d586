//! The gate on estimators that no sample statistic can be trusted with: signed weights, means that
//! cancel, kurtoses of 1e5, weights that overflow. Correct ones must not fail and biased ones must not
//! pass; to be inconclusive, underpowered or refused is right for either.
//!
//! ```text
//! correct   each run at α = 1e-7: a fail is wrong
//! biased    midpoint marching, off by more than the tolerance that its check promises to see, and
//!           honest walks judged against an answer that is off by as much: a pass is wrong
//! ```

use super::{Effort, Row, text};
use crate::case::Case;
use crate::checks::Kind;
use crate::draw::run;
use crate::plan::Amount;
use crate::plan::Options;
use crate::plan::Plan;
use crate::record::evaluate;
use crate::record::verdict;
use crate::record::{Row as Found, Verdict};
use theory::parallel;

/// The run-level α of each.
const ALPHA: f64 = 1e-7;

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    vec![
        correct(effort, seed),
        explained(effort, seed),
        marching(effort, seed),
        shifted(effort, seed),
    ]
}

/// Correct estimators at their worst: what they are, and the case.
const WILD: [(&str, &str); 8] = [
    (
        "w > 2σ_t on a short ray",
        "medium.constant.extinction = 1\nspan = [0, 1]\nsampling.constant.value = 0.2\n\
         estimators = [{ ratio = {} }, { single = { rule = \"non-terminating\", albedo = 0.7 } }, \
         { next-flight = {} }, { single.rule = \"clamped\" }]",
    ),
    (
        "w > 2σ_t on a long ray",
        "medium.constant.extinction = 1\nspan = [0, 12]\nsampling.constant.value = 0.4\n\
         estimators = [{ ratio = {} }, { single = { rule = \"non-terminating\", albedo = 0.7 } }, \
         { weighted-delta = {} }, { unidirectional-mis = {} }]",
    ),
    (
        "kurtosis 2.5e5",
        "volume.eq21 = {}\nray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }\n\
         sampling.constant.value = 0.4\nestimators = [{ ratio = {} }, \
         { single = { rule = \"non-terminating\", albedo = 0.7 } }, { single.rule = \"clamped\" }]",
    ),
    (
        "kurtosis beyond 1e12",
        "medium.constant.extinction = 2\nspan = [0, 10]\nsampling.constant.value = 0.5\n\
         estimators = [{ ratio = {} }, { single = { rule = \"adaptive\", albedo = 1 } }]",
    ),
    (
        "cancelling signs, r = 2",
        "medium.constant.extinction = 2\nspan = [0, 4]\nsampling.constant.value = 1\n\
         estimators = [{ ratio = {} }, { single.rule = \"terminating\" }, { weighted-delta = {} }]",
    ),
    (
        "cancelling signs, r = 2.000001",
        "medium.constant.extinction = 2.000001\nspan = [0, 8]\nsampling.constant.value = 1\n\
         estimators = [{ ratio = {} }, { single.rule = \"clamped\" }, { next-flight = {} }]",
    ),
    (
        "weights that grow: a control far above σ_t",
        "medium.constant.extinction = 0.1\nspan = [0, 10]\nsampling.constant.value = 3\n\
         estimators = [{ double.control.constant.value = 5 }, { double.control.constant.value = 60 }, \
         { single = { rule = \"clamped\", control.constant.value = 2 } }]",
    ),
    (
        "weights that overflow",
        "medium.constant.extinction = 1000\nspan = [0, 10]\nsampling.constant.value = 1\n\
         estimators = [{ ratio = {} }, { weighted-delta = {} }, { single.rule = \"clamped\" }, \
         { double.control.constant.value = 2000 }]",
    ),
];

fn case(problem: &str) -> Option<[Case; 1]> {
    text::case(&format!("title = \"t\"\n[problem.transmittance]\n{problem}")).map(|case| [case])
}

fn options(seed: u64, draws: u64) -> Options {
    Options { seed, draws: Amount::Exactly(draws), alpha: ALPHA, ..Options::default() }
}

fn judged(problem: &str, seed: u64, draws: u64) -> Vec<Found> {
    let Some(cases) = case(problem) else { return Vec::new() };
    let plan = Plan::new(&cases, &options(seed, draws));
    let record = verdict::judged(&plan, &run::draw(&plan, &|_| {}), 0.0);
    record.results.cases.into_iter().flat_map(|case| case.rows).collect()
}

/// All runs of a list of cases, for so many seeds and two lengths each.
fn runs(effort: Effort, seed: u64, cases: &[(&str, &str)]) -> Vec<(String, Vec<Found>)> {
    let mut runs = Vec::new();
    for (name, problem) in cases {
        for number in 0..effort.of(1, 24) {
            for draws in [2_000, 40_000] {
                runs.push((*name, *problem, seed + number, draws));
            }
        }
    }
    parallel::map(&runs, |&(name, problem, seed, draws)| {
        (format!("{name}, seed {seed}, {draws} draws"), judged(problem, seed, draws))
    })
}

fn correct(effort: Effort, seed: u64) -> Row {
    let range = "w > 2σ_t, kurtosis > 1e12, cancelling, overflowing";
    let mut row = Row::wrong("correct estimators that fail", range);
    for (name, rows) in runs(effort, seed, &WILD) {
        row.count(rows.is_empty(), || format!("{name}: not read"));
        for found in rows {
            let is_wrong = found.verdict == Some(Verdict::Fail);
            row.count(is_wrong, || format!("{name}, {}: {}", found.estimator, found.reason));
        }
    }
    row
}

/// What is not decided says why.
fn explained(effort: Effort, seed: u64) -> Row {
    let range = "the same, one seed";
    let mut row = Row::wrong("undecided without a reason", range);
    for (name, problem) in WILD {
        for found in judged(problem, seed, effort.of(2_000, 20_000)) {
            let is_silent = found.verdict != Some(Verdict::Pass) && found.reason.is_empty();
            row.count(is_silent, || format!("{name}, {}", found.estimator));
        }
    }
    row
}

/// Marching with few steps, off by 0.5 to 30 % and saying that it is not.
fn marching(effort: Effort, seed: u64) -> Row {
    let range = "ray marching off by 0.5 … 30 %, 2e3 and 4e4 draws";
    let mut row = Row::wrong("biased estimators that pass", range);
    let cases = [
        (
            "a blob between the steps",
            "medium.gaussian = { peak = 3, centre = 1.1, width = 0.2 }\nspan = [0, 3]\n\
             estimators = [{ ray-marching.steps = 3 }, { ray-marching.steps = 5 }, \
             { ray-marching = { steps = 3, jitter = true } }]",
        ),
        (
            "a jump between the steps",
            "medium.piecewise-constant = { breaks = [0, 1.2, 3], values = [2, 0.1] }\nspan = [0, 3]\n\
             estimators = [{ ray-marching.steps = 4 }, { ray-marching = { steps = 4, jitter = true } }]",
        ),
    ];
    for (name, rows) in runs(effort, seed, &cases) {
        for found in rows {
            let is_wrong = found.verdict == Some(Verdict::Pass);
            row.count(is_wrong, || format!("{name}, {}", found.estimator));
        }
    }
    row
}

/// Honest draws, each observation moved by its tolerance: the promise is that at most one in a hundred
/// passes.
fn shifted(effort: Effort, seed: u64) -> Row {
    let range = "the same, moved by ±ε; promised: 1 % pass";
    let mut row = Row::improbable("scalars off by ε that pass", range);
    let mut jobs = Vec::new();
    for (name, problem) in WILD {
        for number in 0..effort.of(1, 32) {
            jobs.push((name, problem, seed + number, if number % 2 == 0 { 1.0 } else { -1.0 }));
        }
    }
    let counts: Vec<(&str, Option<[u64; 2]>)> =
        parallel::map(&jobs, |&(name, problem, seed, sign)| (name, passes(problem, seed, sign)));
    let (mut passed, mut asked) = (0, 0);
    for (name, counts) in counts {
        match counts {
            Some([c, d]) => (passed, asked) = (passed + c, asked + d),
            None => row.skip(|| format!("{name}: not read")),
        }
    }
    // P(N ≥ passed) of a binomial number with chance 1 %, by its Poisson bound.
    let mean = 0.01 * asked as f64;
    let p = gate::stats::ties::p_value(usize::try_from(passed).unwrap_or(usize::MAX), mean);
    row.see(-p.log10(), || format!("{passed} of {asked} passed"));
    row.trials = asked;
    row
}

/// How many scalars passed although they were moved by their tolerance, and how many there were.
fn passes(problem: &str, seed: u64, sign: f64) -> Option<[u64; 2]> {
    let cases = case(problem)?;
    let mut plan = Plan::new(&cases, &options(seed, 40_000));
    for planned in plan.cases.iter_mut().flat_map(|case| &mut case.experiments) {
        for question in &mut planned.questions {
            if let Kind::Scalar(scalar) = &mut question.kind {
                scalar.bias = sign * scalar.design.tolerance;
            }
        }
    }
    let drawn = run::draw(&plan, &|_| {});
    let mut counts = [0, 0];
    for finding in evaluate::run(&plan, &drawn).into_iter().flatten().flatten() {
        // What could not pass anyway promises nothing.
        if finding.gate.is_some_and(|gate| gate.needed.is_none()) {
            counts[1] += 1;
            counts[0] += u64::from(finding.verdict == Verdict::Pass);
        }
    }
    Some(counts)
}
