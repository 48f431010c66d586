//! Whole cases at the edge: each experiment is predicted in numbers or refused in words, and none of
//! those that are drawn is refuted.
//!
//! ```text
//! τ 1e-12 … 1e9, σ̂/σ_t 1e-9 … 1e9, rays 1e-9 … 1e9 long; empty stretches, breaks of medium, σ̂ and
//! control at the same places, explorers on top of each other, controls that are the medium
//! ```

use super::text::{self, one_line};
use super::{Effort, Row, joined};
use crate::draw::run;
use crate::plan::Amount;
use crate::plan::Options;
use crate::plan::Plan;
use crate::plan::Planned;
use crate::record::Verdict;
use crate::record::verdict;
use theory::parallel;

/// Draws of an experiment: enough that a wrong answer shows.
const DRAWS: u64 = 1 << 13;
/// More expected collisions than these are predicted and not drawn.
const COSTLY: f64 = 100.0;

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let mut rows = swept(effort, seed);
    rows.push(at_breaks(effort, seed));
    rows
}

/// All estimators of the transmittance that take σ̂.
const ESTIMATORS: &str = "{ woodcock = {} }, { ratio = {} }, { residual-ratio = {} }, \
    { double.control.explorers.points = 5 }, { single.rule = \"terminating\" }, \
    { single = { rule = \"non-terminating\", albedo = 0.6 } }, \
    { single = { rule = \"adaptive\", albedo = 0.6 } }, { single.rule = \"clamped\" }, \
    { weighted-delta = {} }, { decomposition = {} }, { next-flight = {} }, \
    { unidirectional-mis = {} }, { closed-form = {} }, { regular = {} }, \
    { ratio.kernel = \"order-free\" }";

/// What is wrong with what theory says of an experiment; `None` where all is numbers, or refused in words.
fn trouble(planned: &Planned) -> Option<String> {
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

fn see(text: &str, what: &str, seed: u64, is_drawn: bool, rows: &mut [Row; 2]) {
    let [sound, fair] = rows;
    let Some(case) = text::case(text) else {
        sound.count(true, || format!("{what}: not read"));
        return;
    };
    let options =
        Options { seed, draws: Amount::Exactly(DRAWS), alpha: 1e-7, ..Options::default() };
    let plan = Plan::new(std::slice::from_ref(&case), &options);
    for (_, planned) in plan.experiments() {
        let trouble = trouble(planned);
        sound.count(trouble.is_some(), || format!("{what}: {}", trouble.unwrap_or_default()));
    }
    if !is_drawn {
        return;
    }
    let record = verdict::judged(&plan, &run::draw(&plan, &|_| {}), 0.0);
    for row in record.results.cases.iter().flat_map(|case| &case.rows) {
        let place = || format!("{what}, {}: {}", row.estimator, row.reason);
        match row.verdict {
            None | Some(Verdict::Refused) => fair.skip(place),
            Some(verdict) => fair.count(verdict == Verdict::Fail, place),
        }
    }
}

fn pair(range: &str) -> [Row; 2] {
    [
        Row::wrong("neither predicted nor refused", range),
        Row::wrong("correct experiments refuted", range),
    ]
}

fn swept(effort: Effort, seed: u64) -> Vec<Row> {
    let range = "τ = 1e-12 … 1e9, σ̂/σ_t = 1e-9 … 1e9, ℓ = 1e-9 … 1e9";
    let depths: &[f64] = effort.of(
        &[1e-12, 1.0, 310.0, 1e9],
        &[1e-12, 1e-6, 1e-3, 1.0, 30.0, 299.0, 301.0, 690.0, 710.0, 1e9],
    );
    let ratios: &[f64] =
        effort.of(&[1e-9, 0.5, 1.7, 1e9], &[1e-9, 1e-3, 0.49, 0.51, 1.0, 1.7, 1e3, 1e9]);
    let lengths: &[f64] = effort.of(&[1.0], &[1e-9, 1e9]);
    let mut cases = Vec::new();
    for &depth in depths {
        for &ratio in ratios {
            for &length in lengths {
                cases.push((depth, ratio, length));
            }
        }
    }
    let found = parallel::map(&cases, |&(depth, ratio, length)| {
        let mut rows = pair(range);
        let sigma = depth / length;
        let what = format!("τ = {depth:e}, σ̂/σ_t = {ratio:e}, ℓ = {length:e}");
        let is_drawn = depth * ratio <= COSTLY;
        let media = [
            format!("medium.constant.extinction = {sigma:e}\nspan = [0, {length:e}]"),
            format!(
                "medium.gaussian = {{ peak = {:e}, centre = {:e}, width = {:e} }}\nspan = [0, {length:e}]",
                1.6 * sigma,
                0.4 * length,
                0.25 * length
            ),
        ];
        for medium in media {
            let sampling = format!("sampling.constant.value = {:e}", ratio * sigma);
            for problem in [
                format!(
                    "[problem.transmittance]\n{medium}\n{sampling}\nestimators = [{ESTIMATORS}]"
                ),
                format!(
                    "[problem.free-flight]\n{medium}\n{sampling}\n\
                         estimators = [{{ woodcock = {{}} }}, {{ inversion = {{}} }}]"
                ),
                format!(
                    "[problem.transmittance-curve]\n{medium}\n{sampling}\ndistances = 4\n\
                         estimators = [{{ double = {{}} }}]"
                ),
            ] {
                see(&format!("title = \"t\"\n{problem}"), &what, seed, is_drawn, &mut rows);
            }
        }
        rows.to_vec()
    });
    joined(found)
}

/// Kinks of all parts of a problem at the same places, stretches on which nothing is, and controls that
/// leave nothing to sample.
fn at_breaks(effort: Effort, seed: u64) -> Row {
    let range = "layers, gaps and explorers at the same places";
    let layers = "medium.piecewise-constant = { breaks = [0, 1, 2, 3, 4], values = [1, 0, 2, 0] }\nspan = [0, 4]";
    let tent =
        "medium.piecewise-linear = { knots = [0, 1, 2, 3], values = [0, 2, 0, 0] }\nspan = [0, 3]";
    let nothing = "medium.constant.extinction = 0\nspan = [0, 2]";
    let point = "medium.constant.extinction = 3\nspan = [2, 2]";
    let samplings = [
        "sampling.constant.value = 2",
        "sampling.piecewise-constant = { breaks = [0, 1, 2, 3, 4], values = [2, 1, 3, 1] }",
        "sampling.piecewise-linear = { knots = [0, 1, 2, 3, 4], values = [2, 3, 3, 2, 2] }",
    ];
    let controls = [
        "control.none = {}",
        "control.mean = {}",
        "control.minimum = {}",
        "control.explorers.points = 2",
        "control.explorers.points = 5",
        "control.explorers.points = 2000",
    ];
    let mut texts = Vec::new();
    for medium in [layers, tent, nothing, point] {
        for sampling in samplings {
            for control in controls {
                texts.push(format!(
                    "title = \"t\"\n[problem.transmittance]\n{medium}\n{sampling}\nestimators = [\
                     {{ double = {{ {control} }} }}, {{ single = {{ rule = \"clamped\", {control} }} }}, \
                     {{ single = {{ rule = \"adaptive\", albedo = 1, {control} }} }}, \
                     {{ double = {{ {control}, kernel = \"order-free\" }} }}, \
                     {{ woodcock = {{}} }}, {{ next-flight.sampling.constant.value = 2 }}, \
                     {{ decomposition = {{}} }}]"
                ));
            }
        }
    }
    let texts: Vec<String> = texts.into_iter().step_by(effort.of(8, 1)).collect();
    let found = parallel::map(&texts, |text| {
        let mut rows = pair(range);
        see(text, &one_line(text), seed, true, &mut rows);
        rows.to_vec()
    });
    let both = joined(found).into_iter().reduce(Row::and);
    let both = both.unwrap_or_else(|| Row::wrong("", range));
    Row { quantity: "wrong at coinciding breaks".into(), ..both }
}
