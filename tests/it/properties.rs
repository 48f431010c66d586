//! Laws that random media, rays, σ̂ and controls obey; random case files are read, or refused with a message.
//!
//! The random numbers are proptest's with a fixed seed: every run tests the same cases.

use crate::common::mutated::{mutated, reads_or_names_the_place};
use crate::common::{case, medium, options, shipped_texts};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use trueflight::numeric::Span;
use trueflight::plan::Plan;
use trueflight::plan::PlannedExperiment;
use trueflight::record::Verdict;
use trueflight::record::build;

/// Tests a property on a number of random inputs, the same in every run.
fn always<S: Strategy>(
    cases: u32,
    inputs: &S,
    law: impl Fn(S::Value) -> Result<(), TestCaseError>,
) {
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    if let Err(error) = TestRunner::new_with_rng(config, rng).run(inputs, law) {
        panic!("{error}");
    }
}

/// Returns a positive number of any size between two powers of ten.
fn sized(least: f64, most: f64) -> impl Strategy<Value = f64> + Clone {
    (least..most).prop_map(|power| 10f64.powf(power))
}

/// Returns ascending numbers from 0, and one value for each but the first.
fn steps() -> impl Strategy<Value = (Vec<f64>, Vec<f64>)> {
    let piece = (sized(-3.0, 1.0), prop_oneof![1 => Just(0.0), 5 => sized(-4.0, 2.0)]);
    prop::collection::vec(piece, 1..7).prop_map(|pieces| {
        let mut knots = vec![0.0];
        knots.extend(pieces.iter().scan(0.0, |end, piece| {
            *end += piece.0;
            Some(*end)
        }));
        (knots, pieces.into_iter().map(|piece| piece.1).collect())
    })
}

/// Returns a field in 1-D with its span.
fn line() -> impl Strategy<Value = String> {
    let span = (-5.0..5.0f64, sized(-9.0, 3.0)).prop_map(|(from, length)| [from, from + length]);
    let spanned =
        |field: String, [from, to]: [f64; 2]| format!("medium.{field}\nspan = [{from:e}, {to:e}]");
    prop_oneof![
        (sized(-12.0, 3.0), span.clone()).prop_map(move |(sigma, span)| spanned(
            format!("constant.extinction = {sigma:e}"),
            span
        )),
        (steps(), -0.5..0.5f64).prop_map(move |((knots, values), beyond)| {
            let end = knots[knots.len() - 1];
            let field =
                format!("piecewise-constant = {{ breaks = {knots:?}, values = {values:?} }}");
            spanned(field, [-beyond * end, end * (1.0 + beyond)])
        }),
        steps().prop_map(move |(knots, mut values)| {
            values.push(values[0]);
            let end = knots[knots.len() - 1];
            let field = format!("piecewise-linear = {{ knots = {knots:?}, values = {values:?} }}");
            spanned(field, [0.0, end])
        }),
        (sized(-6.0, 3.0), -30.0..30.0f64, 0.0..3.0).prop_map(move |(sigma, rate, length)| {
            spanned(
                format!("exponential = {{ extinction = {sigma:e}, rate = {rate:e} }}"),
                [0.0, length],
            )
        }),
        (sized(-6.0, 3.0), -9.0..9.0f64, sized(-6.0, 2.0), span.clone()).prop_map(
            move |(peak, centre, width, span)| {
                let place = format!("centre = {centre:e}, width = {width:e}");
                spanned(format!("gaussian = {{ peak = {peak:e}, {place} }}"), span)
            }
        ),
        (0.5..3.0f64, 0.1..60.0f64, 0.1..60.0, 0.0..6.3f64, 0.0..9.0).prop_map(
            move |(base, slow, fast, phase, length)| {
                let waves = format!("frequencies = [{slow:e}, {fast:e}], phases = [0, {phase:e}]");
                let field =
                    format!("sines = {{ base = {base:e}, amplitudes = [0.25, -0.25], {waves} }}");
                spanned(field, [0.0, length])
            }
        ),
    ]
}

/// Returns a ray that starts near or far, and may miss.
fn ray() -> impl Strategy<Value = String> {
    let direction = prop::array::uniform3(-1.0..1.0f64);
    let target = prop::array::uniform3(-6.0..6.0f64);
    (direction, target, prop_oneof![0.0..20.0, sized(2.0, 6.0)], sized(-1.0, 6.3)).prop_map(
        |(direction, target, back, length)| {
            let norm = direction.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-3);
            let origin: Vec<f64> =
                target.iter().zip(direction).map(|(at, along)| at - back * along / norm).collect();
            let direction: Vec<f64> = direction.iter().map(|x| x / norm).collect();
            format!("{{ origin = {origin:?}, direction = {direction:?}, length = {length:e} }}")
        },
    )
}

/// Returns a field in 3-D with its ray.
fn volume() -> impl Strategy<Value = String> {
    let cube = "bounds.box = { low = [-4, -4, -4], high = [4, 4, 4] }";
    let ball = "bounds.sphere = { centre = [1, -1, 2], radius = 5 }";
    let field = prop_oneof![
        sized(-6.0, 2.0).prop_map(move |sigma| format!("constant = {{ extinction = {sigma:e}, {ball} }}")),
        (sized(-4.0, 2.0), -2.0..2.0f64).prop_map(move |(sigma, rate)| {
            format!("exponential = {{ extinction = {sigma:e}, rate = {rate:e}, axis = [1, 2, 2], {cube} }}")
        }),
        (sized(-4.0, 2.0), sized(-3.0, 1.0)).prop_map(move |(peak, width)| {
            format!("gaussian = {{ peak = {peak:e}, centre = [1, 0.5, -1], width = {width:e}, {ball} }}")
        }),
        Just("eq21 = {}".to_owned()),
        (1..5u32, sized(-2.0, 1.0), any::<u16>()).prop_map(move |(octaves, sigma, seed)| {
            format!("noise = {{ extinction = {sigma:e}, octaves = {octaves}, seed = {seed}, {cube} }}")
        }),
        (1..6u32, 2..6u32, any::<bool>(), any::<u16>()).prop_map(move |(x, y, near, seed)| {
            let how = if near { "nearest" } else { "trilinear" };
            let random = format!("random = {{ size = [{x}, {y}, 4], seed = {seed} }}");
            format!("grid = {{ {random}, interpolation = \"{how}\", {cube} }}")
        }),
    ];
    (field, ray()).prop_map(|(field, ray)| format!("volume.{field}\nray = {ray}"))
}

fn field() -> impl Strategy<Value = String> {
    prop_oneof![line(), volume()]
}

fn check(holds: bool, words: impl FnOnce() -> String) -> Result<(), TestCaseError> {
    if holds { Ok(()) } else { Err(TestCaseError::fail(words())) }
}

#[test]
fn optical_depth_is_additive_and_transmittance_in_range() {
    always(2000, &(field(), prop::collection::vec(0.0..1.0f64, 1..4)), |(text, cuts)| {
        let medium = medium(&text);
        let span = medium.span();
        let whole = medium.optical_depth(span);
        check(whole.value >= 0.0 && whole.value.is_finite(), || format!("{whole:?}"))?;
        let transmittance = whole.exp_neg();
        check((0.0..=1.0).contains(&transmittance.value), || format!("{transmittance:?}"))?;
        let mut ends: Vec<f64> = cuts.iter().map(|cut| span.from + cut * span.length()).collect();
        ends.extend([span.from, span.to]);
        ends.sort_by(f64::total_cmp);
        let parts: Vec<_> =
            ends.windows(2).map(|pair| medium.optical_depth(Span::new(pair[0], pair[1]))).collect();
        let sum: f64 = parts.iter().map(|part| part.value).sum();
        let floor = whole.error + parts.iter().map(|part| part.error).sum::<f64>();
        let off = (sum - whole.value).abs();
        check(off <= 1e-13 * whole.value + floor, || {
            format!("off by {off:e}: {whole:?}, {parts:?}")
        })?;
        let monotonous = parts.iter().all(|part| part.value >= -part.error);
        check(monotonous, || format!("{parts:?}"))
    });
}

#[test]
fn free_flight_inverts_optical_depth() {
    always(2000, &(field(), 0.0..1.0f64), |(text, share)| {
        let medium = medium(&text);
        let whole = medium.optical_depth(medium.span());
        let depth = share * whole.value;
        let beyond = 1.000_001 * (whole.value + whole.error) + 1e-300;
        check(medium.free_flight(beyond).is_none(), || format!("{beyond:e} of {whole:?}"))?;
        if whole.value < 1e-290 {
            return Ok(());
        }
        let Some(s) = medium.free_flight(depth) else {
            return Err(TestCaseError::fail(format!("{depth:e} of {whole:?} is not reached")));
        };
        let support = medium.support();
        let inverse = medium.inverse();
        check(inverse.free_flight(beyond).is_none(), || format!("{beyond:e} of {whole:?}"))?;
        for s in [Some(s), inverse.free_flight(depth)] {
            let Some(s) = s.filter(|s| (support.from..=support.to).contains(s)) else {
                return Err(TestCaseError::fail(format!("{s:?} outside {support:?}")));
            };
            let back = medium.optical_depth(Span::new(support.from, s));
            // The distance is rounded.
            let grain = f64::EPSILON * s.abs().max(support.from.abs()) * medium.extinction(s);
            let off = (back.value - depth).abs();
            let allowed = 1e-12 * whole.value + back.error + 2.0 * grain;
            check(off <= allowed, || {
                format!("{depth:e} became {back:?}, off by {off:e} at {s:e}")
            })?;
        }
        Ok(())
    });
}

/// Returns estimators of the transmittance, each with a control and σ̂ of its own choice.
fn estimators() -> impl Strategy<Value = String> {
    let control = prop_oneof![
        Just("control.none = {}".to_owned()),
        Just("control.mean = {}".to_owned()),
        Just("control.minimum = {}".to_owned()),
        sized(-6.0, 3.0).prop_map(|value| format!("control.constant.value = {value:e}")),
        (2..40u32).prop_map(|points| format!("control.explorers.points = {points}")),
    ];
    let rule = prop_oneof![
        Just("terminating"),
        Just("non-terminating"),
        Just("adaptive"),
        Just("clamped"),
    ];
    (control, rule, 0.0..1.0f64).prop_map(|(control, rule, albedo)| {
        let albedo = if rule.ends_with("ing") && !rule.starts_with("non") || rule == "clamped" {
            String::new()
        } else {
            format!(", albedo = {albedo}")
        };
        format!(
            "{{ woodcock = {{}} }}, {{ ratio = {{}} }}, {{ double = {{ {control} }} }}, \
             {{ residual-ratio = {{}} }}, {{ single = {{ rule = \"{rule}\"{albedo}, {control} }} }}, \
             {{ weighted-delta = {{}} }}, {{ decomposition = {{}} }}, {{ next-flight = {{}} }}, \
             {{ unidirectional-mis = {{}} }}, {{ closed-form = {{}} }}, {{ regular = {{}} }}, \
             {{ ray-marching = {{ steps = 7, jitter = true }} }}"
        )
    })
}

/// Asserts a refusal with a message, or a truth in range with finite predictions.
fn finite_or_refused(planned: &PlannedExperiment, most: f64) -> Result<(), TestCaseError> {
    let name = planned.id.label();
    let prediction = match &planned.outcome {
        Ok(ready) => &ready.prediction,
        Err(refusal) => {
            let reason = refusal.to_string();
            return check(reason.len() > 10, || format!("{name}: refused by `{reason}`"));
        }
    };
    for channel in &prediction.channels {
        let truth = channel.truth;
        check(truth.value > 0.0 && truth.value <= most, || format!("{name}: {truth:?}"))?;
        check(truth.error >= 0.0 && truth.error.is_finite(), || format!("{name}: {truth:?}"))?;
        let Some(moments) = channel.moments else { continue };
        let [second, third, fourth] = moments.relative;
        let is_number = second >= 0.0 && !third.is_nan() && fourth >= 0.0;
        check(is_number, || format!("{name}: {moments:?}"))?;
    }
    let lookups = prediction.lookups.as_ref().map_or(0.0, |law| law.mean.min(law.variance));
    check(lookups >= 0.0, || format!("{name}: lookups {lookups:e}"))
}

#[test]
fn predictions_are_finite_or_refused() {
    predictions(40);
}

#[test]
#[ignore = "long: 400 random cases, 15 s of two cores"]
fn predictions_of_many_cases_are_finite_or_refused() {
    predictions(400);
}

fn predictions(count: u32) {
    let inputs = (field(), estimators(), sized(-9.0, 9.0), any::<bool>());
    always(count, &inputs, |(field, estimators, sampling, flies)| {
        let problem = if flies { "free-flight" } else { "transmittance" };
        let estimators = if flies { "{ woodcock = {} }, { inversion = {} }" } else { &estimators };
        let text = format!(
            "title = \"t\"\n[problem.{problem}]\n{field}\nsampling.constant.value = {sampling:e}\n\
             estimators = [{estimators}]"
        );
        let cases = [case("t", &text)];
        let plan = Plan::new(&cases, &options(1, 1000));
        let most = if flies { f64::INFINITY } else { 1.0 };
        plan.experiments().try_for_each(|(_, planned)| finite_or_refused(planned, most))
    });
}

#[test]
fn rods_and_slabs_are_predicted_or_refused() {
    let inputs = (sized(-6.0, 4.0), sized(-3.0, 3.0), 0.0..=1.0f64, 0.0..=1.0f64, any::<bool>());
    always(60, &inputs, |(depth, relative, albedo, forward, is_rod)| {
        let (problem, own) = if is_rod {
            ("rod", format!("forward = {forward}"))
        } else {
            ("slab", "phase.isotropic = {}".to_owned())
        };
        let text = format!(
            "title = \"t\"\n[problem.{problem}]\nmedium.constant.extinction = {depth:e}\nspan = [0, 1]\n\
             albedo = {albedo}\n{own}\nsampling.constant.value = {:e}\n\
             estimators = [{{ analog = {{}} }}, {{ non-terminating = {{}} }}]",
            relative * depth
        );
        let Some(case) = reads_or_names_the_place(&text) else { return Ok(()) };
        let cases = [case];
        let record = build::predicted(&Plan::new(&cases, &options(1, 1000)));
        for row in record.results.cases[0].rows().collect::<Vec<_>>() {
            if row.verdict == Some(Verdict::Refused) {
                check(row.reason().len() > 10, || format!("{}: no reason", row.experiment.label))?;
                continue;
            }
            let truth = row.truth.unwrap_or(f64::NAN);
            check((0.0..=1.0).contains(&truth), || format!("{}: {truth:e}", row.experiment.label))?;
            let variance = row.predicted_variance.unwrap_or(0.0);
            check(!variance.is_nan(), || format!("{}: variance {variance}", row.experiment.label))?;
        }
        Ok(())
    });
}

#[test]
fn ten_thousand_case_files_are_read_or_refused_with_the_place() {
    let texts = shipped_texts();
    let read = std::cell::Cell::new(0);
    always(10_000, &(0..texts.len(), any::<u64>()), |(index, seed)| {
        let case = reads_or_names_the_place(&mutated(&texts[index], seed));
        read.set(read.get() + u32::from(case.is_some()));
        Ok(())
    });
    // Both outcomes are frequent.
    assert!((500..9500).contains(&read.get()), "{}", read.get());
}
