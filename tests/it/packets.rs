//! Draws made eight at a time are the draws made one by one, to the bit.
//!
//! On every level of vector hardware that this machine has and that fuses multiplication and
//! addition: values, lookups, defects, and where the streams are left. Below those levels the same
//! kernels round differently and are judged like any estimator.

use crate::common::{case, none, options, shipped};
use fearless_simd::Level;
use trueflight::estimators::{DrawBuffer, Kernel, Order};
use trueflight::harness::plan::Planned;
use trueflight::harness::record::{Row, Verdict};
use trueflight::harness::{Case, Filter, Options, Plan};
use trueflight::numeric::pack::fuses;

/// Draws of several requests in a row, which no number of lanes divides.
const REQUESTS: [usize; 6] = [1, 3, 8, 100, 257, 5];

/// The media that the shipped cases do not combine with every estimator, σ̂ and control.
const MEDIA: [(&str, &str); 14] = [
    ("constant", "medium.constant.extinction = 0.7\nspan = [1, 4]"),
    (
        "steps",
        "medium.piecewise-constant = { breaks = [0, 1, 2.5, 4], values = [0.2, 1.5, 0.4] }
        span = [0, 4]",
    ),
    (
        "lines",
        "medium.piecewise-linear = { knots = [0, 1, 2.5, 4], values = [0.2, 1.4, 0, 1] }
        span = [0, 4]",
    ),
    ("exponential", "medium.exponential = { extinction = 1.4, rate = 0.7 }\nspan = [0, 3]"),
    ("gaussian", "medium.gaussian = { peak = 1.4, centre = 2, width = 0.7 }\nspan = [0, 4]"),
    (
        "sines",
        "medium.sines = { base = 0.8, amplitudes = [0.4, -0.2], frequencies = [2, 5] }
        span = [0, 4]",
    ),
    (
        "radial",
        "volume.radial = { centre = [2, 2, 2], radius = 1.9, coefficients = [0.3, 2, -1.5, -0.6] }
        ray = { origin = [-1, 0.4, 0.9], direction = [4.2, 2.2, 1.9], length = 9 }",
    ),
    (
        "eq21",
        "volume.eq21 = {}
        ray = { origin = [1, 0, -3], direction = [0, 0.1, 1], length = 30 }",
    ),
    (
        "noise",
        "volume.noise = { extinction = 1.2, octaves = 3, seed = 5 }
        ray = { origin = [0.3, 0.7, -0.4], direction = [0.6, 0.5, 0.4], length = 5 }",
    ),
    (
        "grid",
        "volume.grid = { random = { size = [5, 5, 5], seed = 7 },
                         bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }
        ray = { origin = [-1, 0.4, 0.9], direction = [4.2, 2.2, 1.9], length = 9 }",
    ),
    (
        "many-steps",
        "medium.piecewise-constant = {
            breaks = [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.01, 1.02, 1.03, 1.04, 1.05,
                      2, 2.5, 3, 4],
            values = [1, 0, 1, 0.5, 1.2, 0, 1, 0.7, 0.4, 1.4, 1, 0.2, 0, 1, 1, 0.4, 1.3, 0.1, 0.9] }
        span = [0, 4]",
    ),
    (
        "gaps",
        "medium.piecewise-constant = { breaks = [0, 1, 1.5, 2, 3, 4, 5],
                                       values = [0, 0.7, 1.1, 0, 0.5, 0] }
        span = [0, 5]",
    ),
    (
        "cubic-noise",
        "volume.noise = { extinction = 1.2, octaves = 7, seed = 4294967294, fade = \"cubic\" }
        ray = { origin = [3, -0.7, 90.4], direction = [-0.6, 0, 0.4], length = 5 }",
    ),
    (
        "nearest-grid",
        "volume.grid = { random = { size = [9, 8, 7], seed = 7 }, interpolation = \"nearest\",
                         bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }
        ray = { origin = [5, 5, 5], direction = [-1, -1, -1], length = 9 }",
    ),
];

/// Every product estimator, with every form of σ̂ and of control.
const ESTIMATORS: &str = "
    { woodcock = {} }, { woodcock.sampling.local-majorants.segments = 5 },
    { ratio = {} }, { ratio.sampling.local-majorants.segments = 5 },
    { residual-ratio = {} }, { weighted-delta = {} },
    { single.rule = \"terminating\" }, { single.rule = \"clamped\" },
    { single = { rule = \"non-terminating\", albedo = 0.7 } },
    { single = { rule = \"adaptive\", albedo = 0.2 } },
    { single = { rule = \"clamped\", control.constant.value = 0.9, sampling.constant.value = 0.6 } },
    { single = { rule = \"adaptive\", albedo = 0.2, control.explorers.points = 5 } },
    { double.control.explorers.points = 5 }, { double.control.explorers.points = 40 }, { double.control.constant.value = 0.9 },
    { double.sampling.constant.value = 0.4 },";

/// The other estimators of transmittance that are drawn in packets.
const OTHERS: &str = "
    { next-flight = {} }, { unidirectional-mis = {} }, { next-flight.sampling.constant.value = 0.4 },
    { unidirectional-mis.sampling.constant.value = 300 },
    { decomposition = {} }, { decomposition.control.constant.value = 0 },
    { decomposition.sampling.local-majorants.segments = 5 },
    { decomposition.sampling.piecewise-linear = { knots = [0, 2, 30], values = [1.5, 2, 1.5] } },
    { local-majorant = {} }, { local-majorant.sampling.local-majorants.segments = 5 },
    { local-majorant.sampling.local-majorants.segments = 70 },";

/// What is compared: every estimator in every field, or every estimator in one field and one estimator of
/// each kind in every field, since kernels and fields are compiled apart.
#[derive(Clone, Copy, PartialEq)]
enum Matrix {
    Full,
    Cross,
}

/// The field with every estimator in [`Matrix::Cross`].
const CENTRE: &str = "eq21";

/// Slabs with a medium for each channel, in both lights.
fn slabs_of_media() -> [Case; 2] {
    let slab = include_str!("../../cases/chromatic-slab/three-colours.toml");
    let diffuse = slab.replace("collimated = { cosine = 0.6 }", "diffuse = {}");
    assert_ne!(slab, diffuse);
    [case("colours", slab), case("colours-diffuse", &diffuse)]
}

fn cases(matrix: Matrix) -> Vec<Case> {
    let mut cases = if matrix == Matrix::Full { shipped() } else { Vec::new() };
    cases.push(case("layers", include_str!("../../cases/spectral-transmittance/layers.toml")));
    cases.push(case("smooth", include_str!("../../cases/spectral-transmittance/smooth.toml")));
    cases.push(case("hero", include_str!("../../cases/spectral-transmittance/hero-delta.toml")));
    for (name, text) in [
        ("three-colours", include_str!("../../cases/spectral-lit-rod/three-colours.toml")),
        ("extinctions", include_str!("../../cases/spectral-lit-rod/extinctions.toml")),
        ("phases", include_str!("../../cases/spectral-lit-rod/phases.toml")),
        ("forward", include_str!("../../cases/spectral-lit-rod/forward.toml")),
        ("as-printed", include_str!("../../cases/spectral-lit-rod/as-printed.toml")),
        ("one-medium", include_str!("../../cases/spectral-lit-rod/one-medium.toml")),
        ("connected", include_str!("../../cases/bidirectional-rod/magnet.toml")),
        ("unscattered", include_str!("../../cases/bidirectional-rod/unscattered.toml")),
        ("reflected", include_str!("../../cases/bidirectional-rod/reflected.toml")),
    ] {
        cases.push(case(name, text));
    }
    cases.extend(slabs_of_media());
    for (name, medium) in MEDIA {
        if matrix == Matrix::Cross && name != CENTRE {
            let text = format!(
                "title = \"{name}\"\n[problem.transmittance]\n{medium}\nsampling.constant.value = 1.5
                estimators = [{{ ratio = {{}} }}, {{ ratio.sampling.local-majorants.segments = 5 }},
                    {{ single.rule = \"clamped\" }}, {{ double.control.explorers.points = 5 }}]"
            );
            cases.push(case(name, &text));
            continue;
        }
        let transmittance = format!(
            "title = \"{name}\"\n[problem.transmittance]\n{medium}\nsampling.constant.value = 1.5
            estimators = [{ESTIMATORS} {OTHERS}
                {{ ray-marching = {{ steps = 10, jitter = true, expect = \"biased\" }} }},
                {{ ray-marching = {{ steps = 3, expect = \"biased\" }} }},
                {{ woodcock = {{ sampling.constant.value = 0.3, expect = \"biased\" }} }},
                {{ ratio.sampling.piecewise-linear = {{ knots = [0, 2, 30], values = [0.5, 2, 1] }} }}]"
        );
        let flight = format!(
            "title = \"{name}, flight\"\n[problem.free-flight]\n{medium}
            sampling.constant.value = 1.5
            estimators = [{{ woodcock = {{}} }}, {{ woodcock.sampling.local-majorants.segments = 5 }}]"
        );
        let curve = format!(
            "title = \"{name}, curve\"\n[problem.transmittance-curve]\n{medium}\ndistances = 5
            sampling.constant.value = 1.5
            estimators = [{{ double = {{}} }}, {{ double.control.explorers.points = 40 }},
                {{ double = {{ control.mean = {{}}, sampling.local-majorants.segments = 5 }} }},
                {{ double.sampling.piecewise-linear = {{ knots = [0, 2, 30], values = [0.5, 2, 1] }} }}]"
        );
        let rod = format!(
            "title = \"{name}, rod\"\n[problem.rod]\n{medium}\nforward = 0.7\nabsorbed = true
            albedo.piecewise-linear = {{ knots = [0, 4], values = [0.9, 0.6] }}\norders = 2\nflux = 3
            sampling.constant.value = 1.6
            estimators = [{{ terminating = {{}} }}, {{ non-terminating = {{}} }}, {{ adaptive = {{}} }},
                {{ adaptive.sampling.constant.value = 0.7 }}, {{ analog = {{}} }}, {{ weighted = {{}} }},
                {{ weighted.sampling.local-majorants.segments = 5 }}]"
        );
        cases.push(case(name, &transmittance));
        cases.push(case(&format!("{name}-curve"), &curve));
        if matches!(name, "constant" | "lines" | "sines" | "eq21" | "gaps") {
            cases.push(case(&format!("{name}-rod"), &rod));
            // The emitter is in the field.
            let medium = medium.replace("length = 30", "length = 12");
            let lit = format!(
                "title = \"{name}, lit\"\n[problem.lit-rod]\n{medium}\nforward = 0.7
                albedo.piecewise-linear = {{ knots = [0, 4], values = [0.9, 0.6] }}
                sampling.constant.value = 1.6
                estimators = [{{ unidirectional = {{}} }}, {{ next-event.shadow = \"exact\" }},
                    {{ next-event.shadow = \"delta\" }}, {{ next-event = {{}} }}, {{ directional-mis = {{}} }},
                    {{ full-mis.shadow = \"exact\" }}, {{ full-mis = {{}} }}, {{ full-mis.heuristic = \"power\" }},
                    {{ full-mis.sampling.local-majorants.segments = 5 }},
                    {{ directional-mis.sampling.piecewise-linear = {{ knots = [0, 2, 30], values = [1.5, 2.5, 1.5] }} }}]"
            );
            cases.push(case(&format!("{name}-lit"), &lit));
            cases.extend(lit_slabs(name, &medium));
            cases.extend(coloured(name, &medium));
            let roulette = format!(
                "title = \"{name}, roulette\"\n[problem.rod]\n{medium}\nforward = 0.7\nalbedo = 0.8\norders = 1
                sampling.constant.value = 1.6
                estimators = [{{ roulette = {{}} }}, {{ roulette.below = 0.6 }},
                    {{ roulette.sampling.local-majorants.segments = 5 }}]"
            );
            cases.push(case(&format!("{name}-roulette"), &roulette));
            for (light, phase) in [
                ("collimated.cosine = 0.8", "isotropic = {}"),
                ("diffuse = {}", "isotropic = {}"),
                ("diffuse = {}", "rayleigh = {}"),
                ("collimated.cosine = 1", "henyey-greenstein = { g = 0.6 }"),
            ] {
                let slab = format!(
                    "title = \"{name}, slab\"\n[problem.slab]\n{medium}\nalbedo = 0.8
                    incidence.{light}\nphase.{phase}\nsampling.constant.value = 1.6
                    estimators = [{{ terminating = {{}} }}, {{ non-terminating = {{}} }},
                        {{ adaptive = {{}} }}, {{ analog = {{}} }}, {{ weighted = {{}} }},
                        {{ weighted.sampling.local-majorants.segments = 5 }}]"
                );
                cases.push(case(&format!("{name}-slab"), &slab));
            }
        }
        cases.push(case(&format!("{name}-flight"), &flight));
    }
    cases
}

/// A field as a slab with each kind of light behind it.
fn lit_slabs(name: &str, medium: &str) -> Vec<Case> {
    let lights = [
        ("cap.cosine = 0.6", ", { unidirectional = {} }, { full-mis.heuristic = \"power\" }"),
        ("disc = { distance = 1, radius = 2 }", ", { unidirectional = {} }"),
        ("distant.cosine = 0.7", ""),
    ];
    let of = |(light, hits)| {
        let slab = format!(
            "title = \"{name}, lit slab\"\n[problem.lit-slab]\n{medium}\nalbedo = 0.9
            phase.henyey-greenstein = {{ g = 0.4 }}\nlight.{light}\nsampling.constant.value = 1.6
            estimators = [{{ next-event.shadow = \"exact\" }}, {{ next-event.shadow = \"delta\" }},
                {{ next-event = {{}} }}, {{ directional-mis = {{}} }}, {{ full-mis.shadow = \"exact\" }},
                {{ full-mis = {{}} }}, {{ full-mis.sampling.local-majorants.segments = 5 }}{hits}]"
        );
        case(&format!("{name}-lit-slab"), &slab)
    };
    lights.map(of).into()
}

/// A field as a rod and as slabs of coloured scatterers.
fn coloured(name: &str, medium: &str) -> Vec<Case> {
    let bodies = [
        ("rod", "forward = 0.7"),
        ("slab", "phase.isotropic = {}\nincidence.collimated.cosine = 0.8"),
        ("slab", "phase.henyey-greenstein = { g = 0.4 }\nincidence.diffuse = {}"),
    ];
    let of = |(body, settings)| {
        let text = format!(
            "title = \"{name}, coloured {body}\"\n[problem.spectral-{body}]\n{medium}\n{settings}
            albedos = [0.9, 0, 0.6]\nsampling.constant.value = 1.6
            estimators = [{{ independent = {{}} }}, {{ independent.hero = [0.1, 0.2, 0.7] }},
                {{ spectral-mis = {{}} }}, {{ spectral-mis.sampling.local-majorants.segments = 5 }},
                {{ spectral-tracking = {{}} }}, {{ spectral-tracking.probabilities = \"maximum\" }}]"
        );
        case(&format!("{name}-coloured-{body}"), &text)
    };
    bodies.map(of).into()
}

/// All that an experiment draws, as bits, and its streams afterwards.
fn drawn(planned: &Planned, kernel: Kernel) -> Vec<u64> {
    let ready = planned.outcome.as_ref().expect("it is not refused");
    let mut buffer = DrawBuffer::new(ready.prediction.channels.len());
    let mut streams = planned.streams(3);
    let mut bits = Vec::new();
    for count in REQUESTS {
        ready.experiment.fill_by(kernel, &mut streams, count, &mut buffer);
        assert_eq!(buffer.lookups.len(), count);
        for channel in &buffer.values {
            bits.extend(channel.iter().map(|value| value.to_bits()));
        }
        bits.extend(buffer.lookups.iter().map(|&lookups| u64::from(lookups)));
        bits.extend(buffer.defects.iter().map(|defect| defect.to_bits()));
    }
    bits.push(streams.turn as u64);
    bits.extend(streams.words().take(16));
    bits
}

/// Every level that fuses, from the best down.
fn fusing_levels() -> Vec<Level> {
    let mut levels = vec![Level::new()];
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    levels.extend(Level::new().as_avx2().map(Level::Avx2));
    levels.retain(|&level| fuses(level));
    levels
}

#[test]
fn packets_are_the_scalar_draws_at_every_level_that_fuses() {
    packets_are_the_scalar_draws(Matrix::Cross);
}

#[test]
#[ignore = "long: every estimator in every field, 40 s of two cores"]
fn packets_are_the_scalar_draws_in_every_field() {
    packets_are_the_scalar_draws(Matrix::Full);
}

fn packets_are_the_scalar_draws(matrix: Matrix) {
    let cases = cases(matrix);
    let plan = Plan::new(&cases, &options(1, 1_000));
    let (mut wrong, mut compared) = (Vec::new(), 0);
    for (case, planned) in plan.experiments().filter(|(_, planned)| planned.outcome.is_ok()) {
        let ready = planned.outcome.as_ref();
        if ready.is_ok_and(|ready| ready.experiment.order() == Order::Free) {
            continue; // Those are other draws.
        }
        let single = drawn(planned, Kernel::Single);
        for level in fusing_levels() {
            compared += 1;
            let packets = drawn(planned, Kernel::Packets(level));
            let differing = single.iter().zip(&packets).position(|(a, b)| a != b);
            if let Some(place) = differing {
                let name = &planned.names.estimator;
                let sampling = &planned.names.sampling_kind;
                wrong.push(format!("{}, {name}, {sampling}, {level:?}: {place}", case.case.name));
            }
        }
    }
    none(&wrong);
    let least = if matrix == Matrix::Full { 200 } else { 100 };
    assert!(fusing_levels().is_empty() || compared > least, "only {compared} compared");
}

/// The least machine's rounding, forced on this one, passes the gate. Such machines make ordered draws
/// one by one; only the order-free kernel has code for them.
#[test]
fn kernels_without_fused_instructions_are_judged_like_any_other() {
    let (_, medium) = MEDIA[7];
    let text = format!(
        "title = \"eq21\"\n[problem.transmittance]\n{medium}\nsampling.constant.value = 1.1
        estimators = [{ESTIMATORS}]"
    );
    let mut cases = [case("eq21", &text)];
    cases[0].scenario.draw_by(Order::Free);
    let mut plan = Plan::new(&cases, &options(1, 50_000));
    for planned in plan.cases.iter_mut().flat_map(|case| &mut case.experiments) {
        if let Ok(ready) = &mut planned.outcome {
            let experiment =
                std::mem::replace(&mut ready.experiment, Box::new(crate::common::Nothing));
            ready.experiment = Box::new(crate::common::At { experiment, level: Level::baseline() });
            // Each by itself: what is put in its place shares no lookups.
            planned.shared = None;
        }
    }
    let draws = trueflight::harness::run::draw(&plan, &|_| {});
    let record = trueflight::harness::verdict::judged(&plan, &draws, 0.0);
    let failed = record.results.cases.iter().flat_map(|case| &case.rows);
    let failed: Vec<String> = failed
        .filter(|row| row.verdict == Some(Verdict::Fail))
        .map(|row| format!("{}: {}", row.estimator, row.reason))
        .collect();
    none(&failed);
}

/// The cases above, drawn order-free where that can be.
fn order_free(matrix: Matrix) -> Vec<Case> {
    let mut cases = cases(matrix);
    cases.retain(|case| case.problem == "transmittance");
    for case in &mut cases {
        case.scenario.draw_by(Order::Free);
    }
    cases
}

#[test]
fn order_free_draws_do_not_depend_on_the_level() {
    order_free_draws_are_those_of_any_level(Matrix::Cross, 40);
}

#[test]
#[ignore = "long: every estimator in every field, 20 s of two cores"]
fn order_free_draws_do_not_depend_on_the_level_in_every_field() {
    order_free_draws_are_those_of_any_level(Matrix::Full, 150);
}

fn order_free_draws_are_those_of_any_level(matrix: Matrix, least: usize) {
    let levels = fusing_levels();
    let cases = order_free(matrix);
    let plan = Plan::new(&cases, &options(1, 1_000));
    let mut compared = 0;
    for (case, planned) in plan.experiments() {
        let Ok(ready) = &planned.outcome else { continue };
        if let [best, others @ ..] = &levels[..]
            && ready.experiment.order() == Order::Free
        {
            let draws = drawn(planned, Kernel::Packets(*best));
            for level in others {
                let same = draws == drawn(planned, Kernel::Packets(*level));
                assert!(same, "{}, {}, {level:?}", case.case.name, planned.names.estimator);
            }
            compared += 1;
        }
    }
    assert!(levels.is_empty() || compared > least, "only {compared} compared");
}

/// Means, variances, laws of lookups and of values: the same gate, the same theory.
#[test]
fn order_free_draws_have_the_law_of_the_ordered_ones() {
    order_free_draws_have_the_law(Matrix::Cross, 30);
}

#[test]
#[ignore = "long: every estimator in every field, 40 s of two cores"]
fn order_free_draws_have_the_law_of_the_ordered_ones_in_every_field() {
    order_free_draws_have_the_law(Matrix::Full, 100);
}

fn order_free_draws_have_the_law(matrix: Matrix, least: usize) {
    let cases = order_free(matrix);
    let record = crate::common::judged(&cases, &options(1, 60_000));
    let rows: Vec<&Row> = record.results.cases.iter().flat_map(|case| &case.rows).collect();
    let failed: Vec<String> = rows
        .iter()
        // So few draws need not show a bias that a case declares.
        .filter(|row| row.findings.iter().all(|finding| !finding.expects_bias))
        .filter(|row| row.verdict == Some(Verdict::Fail))
        .map(|row| format!("{}, {}: {}", row.command, row.sampling_kind, row.reason))
        .collect();
    none(&failed);
    let passed =
        |row: &&&Row| row.estimator.contains("order-free") && row.verdict == Some(Verdict::Pass);
    let passed = rows.iter().filter(passed).count();
    assert!(passed > least, "only {passed} passed");
}

/// Draws of one request come sorted; a sum over them does not care, and nothing else is asked.
#[test]
fn order_free_draws_say_so() {
    let text = "title = \"kernels\"\nkernel = \"order-free\"\n[problem.transmittance]
        medium.constant.extinction = 1.0\nspan = [0, 2]\nsampling.constant.value = 2.5
        estimators = [{ ratio = {} }, { ratio.kernel = \"ordered\" },
                      { single.rule = \"clamped\" }, { next-flight = {} }]";
    let rows = crate::common::rows(text, 1_000_000);
    let names: Vec<&str> = rows.iter().map(|row| row.estimator.as_str()).collect();
    assert_eq!(
        names,
        ["ratio (order-free)", "ratio", "single (clamped, order-free)", "next-flight"]
    );
    let asked = |row: &Row, check: &str| row.findings.iter().any(|finding| finding.check == check);
    for check in ["invariant", "streams"] {
        assert!(!asked(&rows[0], check) && asked(&rows[1], check), "{check}");
    }
    assert!(asked(&rows[0], "counts") && asked(&rows[2], "counts"));
}

#[test]
fn an_order_free_kernel_that_is_not_there_is_a_mistake() {
    let text = |kernel: &str| {
        format!(
            "title = \"k\"\n[problem.transmittance]\nmedium.constant.extinction = 1.0\nspan = [0, 2]
            sampling.constant.value = 1.5\nestimators = [{{ next-flight.kernel = \"{kernel}\" }}]"
        )
    };
    let message =
        |kernel: &str| crate::common::mistakes(&text(kernel)).map(|error| error.render(false));
    assert!(message("ordered").is_none());
    let missing = message("order-free").expect("a mistake");
    assert!(missing.contains("`next-flight` has no order-free kernel"), "{missing}");
    let unknown = message("free").expect("a mistake");
    assert!(unknown.contains("one of `ordered`, `order-free`"), "{unknown}");
}

/// A sweep of σ̂ and estimators of other controls and rules, all on the same lookups.
const SWEEP: &str = "title = \"sweep\"\nkernel = \"order-free\"\n[problem.transmittance]
    volume.eq21 = {}\nray = { origin = [1, 0, -3], direction = [0, 0.1, 1], length = 30 }
    sweep.sampling = { values = [0.7, 1.1, 1.6, 2.4] }
    estimators = [{ ratio = {} }, { double = { sampling.local-majorants.segments = 5 } },
        { double.control.explorers.points = 5 }, { woodcock = {} },
        { single = { rule = \"adaptive\", albedo = 0.3 } }]";

#[test]
fn shared_lookups_change_no_draw() {
    let sweep = [case("sweep", SWEEP)];
    let all = crate::common::judged(&sweep, &options(3, 90_000));
    let all = &all.results.cases[0].rows;
    let mut shared = 0;
    for pattern in ["*:ratio*", "*:double*", "*:woodcock*", "*:single*"] {
        let filter = Filter::new(pattern);
        let filter = Some(filter.expect("a pattern"));
        let alone = crate::common::judged(&sweep, &Options { filter, ..options(3, 90_000) });
        for row in &alone.results.cases[0].rows {
            let same = |other: &&Row| {
                (&other.estimator, &other.sampling_kind, other.swept)
                    == (&row.estimator, &row.sampling_kind, row.swept)
            };
            let together = all.iter().find(same).expect("the same experiment");
            assert_eq!(row.mean, together.mean, "{}", row.command);
            assert_eq!(row.variance, together.variance);
            assert_eq!(row.lookups_per_draw, together.lookups_per_draw);
            assert!(row.sharing.is_none() || row.sharing < together.sharing);
            shared += usize::from(together.sharing.is_some());
        }
    }
    assert!(shared >= 14, "only {shared} shared their lookups");
}

#[test]
fn order_free_draws_of_too_many_collisions_are_refused() {
    let text = "title = \"many\"\n[problem.transmittance]
        medium.constant.extinction = 5.0\nspan = [0, 4]\nsampling.constant.value = 1e6
        estimators = [{ woodcock.kernel = \"order-free\" }, { woodcock = {} }]";
    let rows = crate::common::predicted(text);
    assert_eq!(rows[0].verdict, Some(Verdict::Refused));
    assert!(rows[0].reason.contains("order-free"), "{}", rows[0].reason);
    assert_eq!(rows[1].verdict, None, "{}", rows[1].reason);
}
