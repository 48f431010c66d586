//! Estimators and cases at the edge: signed weights, means that cancel, kurtoses beyond 1e12, weights that overflow,
//! extreme depths and majorants, breaks at the same places. Correct estimators never fail, and biased ones never pass.
//! Each experiment has a finite prediction or is refused with a message.

use crate::common::{case, none, rows_of};
use trueflight::case::Case;
use trueflight::draw::run;
use trueflight::plan::{Amount, Options, Plan, PlannedExperiment};
use trueflight::record::{Row, Verdict, build, evaluate};
use trueflight::stats::ties;

/// α of each run: a correct estimator that fails is a bug.
const ALPHA: f64 = 1e-7;

/// Correct estimators in their worst cases: a name, the case, its estimators.
const WILD: [(&str, &str, &str); 8] = [
    (
        "w > 2σ_t on a short ray",
        "medium.constant.extinction = 1\nspan = [0, 1]\nsampling.constant.value = 0.2",
        "{ ratio = {} }, { single = { rule = \"non-terminating\", albedo = 0.7 } }, { next-flight = {} }, \
         { single.rule = \"clamped\" }",
    ),
    (
        "w > 2σ_t on a long ray",
        "medium.constant.extinction = 1\nspan = [0, 12]\nsampling.constant.value = 0.4",
        "{ ratio = {} }, { single = { rule = \"non-terminating\", albedo = 0.7 } }, { weighted-delta = {} }, \
         { unidirectional-mis = {} }",
    ),
    (
        "kurtosis 2.5e5",
        "volume.eq21 = {}\nray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }\n\
         sampling.constant.value = 0.4",
        "{ ratio = {} }, { single = { rule = \"non-terminating\", albedo = 0.7 } }, { single.rule = \"clamped\" }",
    ),
    (
        "kurtosis beyond 1e12",
        "medium.constant.extinction = 2\nspan = [0, 10]\nsampling.constant.value = 0.5",
        "{ ratio = {} }, { single = { rule = \"adaptive\", albedo = 1 } }",
    ),
    (
        "cancelling signs, r = 2",
        "medium.constant.extinction = 2\nspan = [0, 4]\nsampling.constant.value = 1",
        "{ ratio = {} }, { single.rule = \"terminating\" }, { weighted-delta = {} }",
    ),
    (
        "cancelling signs, r = 2.000001",
        "medium.constant.extinction = 2.000001\nspan = [0, 8]\nsampling.constant.value = 1",
        "{ ratio = {} }, { single.rule = \"clamped\" }, { next-flight = {} }",
    ),
    (
        "weights that grow: a control far above σ_t",
        "medium.constant.extinction = 0.1\nspan = [0, 10]\nsampling.constant.value = 3",
        "{ double.control.constant.value = 5 }, { double.control.constant.value = 60 }, \
         { single = { rule = \"clamped\", control.constant.value = 2 } }",
    ),
    (
        "weights that overflow",
        "medium.constant.extinction = 1000\nspan = [0, 10]\nsampling.constant.value = 1",
        "{ ratio = {} }, { weighted-delta = {} }, { single.rule = \"clamped\" }, { double.control.constant.value = 2000 }",
    ),
];

/// Ray marching with few steps, with a bias of 0.5 to 30 %.
const BIASED: [(&str, &str, &str); 2] = [
    (
        "a blob between the steps",
        "medium.gaussian = { peak = 3, centre = 1.1, width = 0.2 }\nspan = [0, 3]",
        "{ ray-marching.steps = 3 }, { ray-marching.steps = 5 }, { ray-marching = { steps = 3, jitter = true } }",
    ),
    (
        "a jump between the steps",
        "medium.piecewise-constant = { breaks = [0, 1.2, 3], values = [2, 0.1] }\nspan = [0, 3]",
        "{ ray-marching.steps = 4 }, { ray-marching = { steps = 4, jitter = true } }",
    ),
];

fn read(problem: &str, lines: &str, estimators: &str) -> Case {
    case(
        "wild",
        &format!("title = \"t\"\n[problem.{problem}]\n{lines}\nestimators = [{estimators}]"),
    )
}

fn options(seed: u64, draws: u64) -> Options {
    Options { seed, draws: Amount::Exactly(draws), alpha: ALPHA, ..Options::default() }
}

fn judged(case: &Case, seed: u64, draws: u64) -> Vec<Row<'static>> {
    let plan = Plan::new(std::slice::from_ref(case), &options(seed, draws));
    let record = build::judged(&plan, &run::draw(&plan, &|_| {}), 0.0);
    rows_of(record)
}

/// Lists the rows of cases with a wrong verdict, for few draws and many.
fn wrong(cases: &[(&str, &str, &str)], seeds: u64, is_wrong: impl Fn(&Row) -> bool) -> Vec<String> {
    let mut wrong = Vec::new();
    for (name, lines, estimators) in cases {
        let case = read("transmittance", lines, estimators);
        for (seed, draws) in (1..=seeds).flat_map(|seed| [(seed, 2_000), (seed, 40_000)]) {
            for row in judged(&case, seed, draws).into_iter().filter(&is_wrong) {
                wrong.push(format!(
                    "{name}, seed {seed}, {}: {}",
                    row.experiment.label,
                    row.reason()
                ));
            }
        }
    }
    wrong
}

fn fails(row: &Row) -> bool {
    row.verdict == Some(Verdict::Fail)
}

fn passes(row: &Row) -> bool {
    row.verdict == Some(Verdict::Pass)
}

#[test]
fn wild_estimators_do_not_fail_and_say_why_they_are_undecided() {
    none(&wrong(&WILD, 1, |row| fails(row) || !passes(row) && row.reason().is_empty()));
}

#[test]
#[ignore = "long: 24 seeds, a minute"]
fn wild_estimators_do_not_fail_with_any_seed() {
    none(&wrong(&WILD, 24, fails));
}

#[test]
fn ray_marching_with_few_steps_does_not_pass() {
    none(&wrong(&BIASED, 2, passes));
}

/// Unbiased draws, each observation shifted by its tolerance: at most one in a hundred passes.
#[test]
fn answers_that_are_off_by_the_tolerance_pass_once_in_a_hundred() {
    let (mut passed, mut asked) = (0_usize, 0_usize);
    for (number, (_, lines, estimators)) in (1..).zip(WILD) {
        let case = read("transmittance", lines, estimators);
        let mut plan = Plan::new(std::slice::from_ref(&case), &options(number, 40_000));
        let sign = if number % 2 == 0 { 1.0 } else { -1.0 };
        for planned in plan.cases.iter_mut().flat_map(|case| &mut case.experiments) {
            for question in &mut planned.questions {
                question.answer.shift(sign);
            }
        }
        let drawn = run::draw(&plan, &|_| {});
        for finding in evaluate::run(&plan, &drawn).into_iter().flat_map(|one| one.findings) {
            // A check that could not pass anyway promises nothing.
            if finding.gate.is_some_and(|gate| gate.needed.is_none()) {
                asked += 1;
                passed += usize::from(finding.verdict == Verdict::Pass);
            }
        }
    }
    // P(N ≥ passed) of a binomial number with probability 1 %, by its Poisson bound.
    assert!(asked > 10 && ties::p_value(passed, 0.01 * asked as f64) > 1e-6, "{passed} of {asked}");
}

/// All estimators of the transmittance that take σ̂.
const ALL: &str = "{ woodcock = {} }, { ratio = {} }, { residual-ratio = {} }, \
    { double.control.explorers.points = 5 }, { single.rule = \"terminating\" }, \
    { single = { rule = \"non-terminating\", albedo = 0.6 } }, \
    { single = { rule = \"adaptive\", albedo = 0.6 } }, { single.rule = \"clamped\" }, \
    { weighted-delta = {} }, { decomposition = {} }, { next-flight = {} }, { unidirectional-mis = {} }, \
    { closed-form = {} }, { regular = {} }";

/// Returns the fault of the prediction of an experiment: neither finite nor a refusal with a message.
fn trouble(planned: &PlannedExperiment) -> Option<String> {
    let name = planned.id.label();
    let prediction = match &planned.outcome {
        Err(refusal) => {
            let is_silent = refusal.to_string().len() < 10;
            return is_silent.then(|| format!("{name}: refused without a reason"));
        }
        Ok(ready) => &ready.prediction,
    };
    for channel in &prediction.channels {
        let truth = channel.truth;
        if !(truth.value > 0.0 && truth.value.is_finite() && truth.error >= 0.0) {
            return Some(format!("{name}: the answer is {truth:?}"));
        }
        let moments = channel.moments.map_or([0.0; 3], |moments| moments.relative);
        if moments.iter().any(|x| x.is_nan()) || moments[0] < 0.0 {
            return Some(format!("{name}: moments {moments:?}"));
        }
    }
    let lookups = prediction.lookups.as_ref().map_or(0.0, |law| law.mean.min(law.variance));
    (lookups.is_nan() || lookups < 0.0).then(|| format!("{name}: lookups {lookups:e}"))
}

/// Lists the faults of a case: predictions and, if it is drawn, verdicts.
fn at_the_edge(case: &Case, what: &str, is_drawn: bool) -> Vec<String> {
    let plan = Plan::new(std::slice::from_ref(case), &options(1, 1 << 13));
    let mut wrong: Vec<String> =
        plan.experiments().filter_map(|(_, planned)| trouble(planned)).collect();
    if is_drawn {
        let failing = judged(case, 1, 1 << 13).into_iter().filter(fails);
        wrong.extend(failing.map(|row| format!("{}: {}", row.experiment.label, row.reason())));
    }
    wrong.into_iter().map(|wrong| format!("{what}, {wrong}")).collect()
}

fn swept(depths: &[f64], ratios: &[f64], lengths: &[f64]) -> Vec<String> {
    let mut wrong = Vec::new();
    for (&depth, &ratio, &length) in depths
        .iter()
        .flat_map(|d| ratios.iter().flat_map(move |r| lengths.iter().map(move |l| (d, r, l))))
    {
        let sigma = depth / length;
        let constant = format!("medium.constant.extinction = {sigma:e}");
        let [peak, centre, width] = [1.6 * sigma, 0.4 * length, 0.25 * length];
        let blob = format!(
            "medium.gaussian = {{ peak = {peak:e}, centre = {centre:e}, width = {width:e} }}"
        );
        for medium in [constant, blob] {
            let lines = format!(
                "{medium}\nspan = [0, {length:e}]\nsampling.constant.value = {:e}",
                ratio * sigma
            );
            let curve = format!("{lines}\ndistances = 4");
            let what = format!("τ = {depth:e}, σ̂/σ_t = {ratio:e}, ℓ = {length:e}");
            for (problem, lines, estimators) in [
                ("transmittance", &lines, ALL),
                ("free-flight", &lines, "{ woodcock = {} }, { inversion = {} }"),
                ("transmittance", &curve, "{ double = {} }"),
            ] {
                let case = read(problem, lines, estimators);
                // Experiments with more expected collisions are predicted and not drawn.
                wrong.extend(at_the_edge(&case, &what, depth * ratio <= 100.0));
            }
        }
    }
    wrong
}

#[test]
fn extreme_depths_and_majorants_are_predicted_or_refused_and_not_refuted() {
    none(&swept(&[1e-12, 1.0, 310.0, 1e9], &[1e-9, 0.5, 1.7, 1e9], &[1.0]));
}

#[test]
#[ignore = "long: 160 media, a minute"]
fn all_extreme_depths_and_majorants_are_predicted_or_refused_and_not_refuted() {
    let depths = [1e-12, 1e-6, 1e-3, 1.0, 30.0, 299.0, 301.0, 690.0, 710.0, 1e9];
    let ratios = [1e-9, 1e-3, 0.49, 0.51, 1.0, 1.7, 1e3, 1e9];
    none(&swept(&depths, &ratios, &[1e-9, 1e9]));
}

#[test]
fn breaks_at_the_same_places_do_no_harm() {
    none(&at_breaks(5));
}

#[test]
#[ignore = "long: 72 cases"]
fn all_breaks_at_the_same_places_do_no_harm() {
    none(&at_breaks(1));
}

/// Lists the faults of every `step`-th case with kinks of medium, σ̂ and control at the same places, with empty
/// stretches, and with controls that leave nothing to sample.
fn at_breaks(step: usize) -> Vec<String> {
    let media = [
        "medium.piecewise-constant = { breaks = [0, 1, 2, 3, 4], values = [1, 0, 2, 0] }\nspan = [0, 4]",
        "medium.piecewise-linear = { knots = [0, 1, 2, 3], values = [0, 2, 0, 0] }\nspan = [0, 3]",
        "medium.constant.extinction = 0\nspan = [0, 2]",
        "medium.constant.extinction = 3\nspan = [2, 2]",
    ];
    let samplings = [
        "constant.value = 2",
        "piecewise-constant = { breaks = [0, 1, 2, 3, 4], values = [2, 1, 3, 1] }",
        "piecewise-linear = { knots = [0, 1, 2, 3, 4], values = [2, 3, 3, 2, 2] }",
    ];
    let controls = [
        "none = {}",
        "mean = {}",
        "minimum = {}",
        "explorers.points = 2",
        "explorers.points = 5",
        "explorers.points = 2000",
    ];
    let mut cases = Vec::new();
    for medium in media {
        for sampling in samplings {
            for control in controls {
                let lines = format!("{medium}\nsampling.{sampling}");
                let estimators = format!(
                    "{{ double.control.{control} }}, {{ single = {{ rule = \"clamped\", control.{control} }} }}, \
                     {{ single = {{ rule = \"adaptive\", albedo = 1, control.{control} }} }}, \
                     {{ woodcock = {{}} }}, \
                     {{ next-flight.sampling.constant.value = 2 }}, {{ decomposition = {{}} }}"
                );
                cases.push((lines, control, estimators));
            }
        }
    }
    let edge = |(lines, control, estimators): &(String, &str, String)| {
        at_the_edge(&read("transmittance", lines, estimators), &format!("{lines}, {control}"), true)
    };
    cases.iter().step_by(step).flat_map(edge).collect()
}
