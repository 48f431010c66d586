//! Draws in any order: of one law with the ordered ones, and the same draws on every level.

use super::fields::{ESTIMATORS, MEDIA, Matrix, cases};
use super::{drawn, fusing_levels};
use crate::common::{case, none, options};
use fearless_simd::Level;
use trueflight::case::Case;
use trueflight::estimators::{Kernel, Order};
use trueflight::plan::Filter;
use trueflight::plan::Options;
use trueflight::plan::Plan;
use trueflight::record::{Row, Verdict};

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
    cases[0].draw_by(Order::Free);
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
    let draws = trueflight::draw::run::draw(&plan, &|_| {});
    let record = trueflight::record::build::judged(&plan, &draws, 0.0);
    let failed = record.results.rows();
    let failed: Vec<String> = failed
        .filter(|row| row.verdict == Some(Verdict::Fail))
        .map(|row| format!("{}: {}", row.experiment.label, row.reason))
        .collect();
    none(&failed);
}

/// The cases above, drawn order-free where that can be.
fn order_free(matrix: Matrix) -> Vec<Case> {
    let mut cases = cases(matrix);
    cases.retain(|case| case.problem == "transmittance");
    for case in &mut cases {
        case.draw_by(Order::Free);
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
    for (_, planned) in plan.experiments() {
        let Ok(ready) = &planned.outcome else { continue };
        if let [best, others @ ..] = &levels[..]
            && ready.experiment.order() == Order::Free
        {
            let draws = drawn(planned, Kernel::Packets(*best));
            for level in others {
                let same = draws == drawn(planned, Kernel::Packets(*level));
                assert!(same, "{}, {level:?}", planned.id);
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
    let rows: Vec<Row> = record.results.rows().collect();
    let failed: Vec<String> = rows
        .iter()
        // So few draws need not show a bias that a case declares.
        .filter(|row| row.findings().all(|finding| !finding.expects_bias))
        .filter(|row| row.verdict == Some(Verdict::Fail))
        .map(|row| {
            format!(
                "{}, {}: {}",
                row.experiment.command, row.experiment.id.sampling.kind, row.reason
            )
        })
        .collect();
    none(&failed);
    let passed = |row: &&Row| {
        row.experiment.label.contains("order-free") && row.verdict == Some(Verdict::Pass)
    };
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
    let names: Vec<&str> = rows.iter().map(|row| row.experiment.label.as_str()).collect();
    assert_eq!(
        names,
        ["ratio (order-free)", "ratio", "single (clamped, order-free)", "next-flight"]
    );
    let asked = |row: &Row, check: &str| row.findings().any(|finding| finding.check == check);
    for check in ["invariant", "streams"] {
        assert!(!asked(&rows[0], check) && asked(&rows[1], check), "{check}");
    }
    assert!(asked(&rows[0], "counts") && asked(&rows[2], "counts"));
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
    let all: Vec<Row> = all.results.rows().collect();
    let mut shared = 0;
    for pattern in ["*:ratio*", "*:double*", "*:woodcock*", "*:single*"] {
        let filter = Filter::new(pattern);
        let filter = Some(filter.expect("a pattern"));
        let alone = crate::common::judged(&sweep, &Options { filter, ..options(3, 90_000) });
        for row in alone.results.rows() {
            let same = |other: &&Row| {
                (
                    &other.experiment.label,
                    &other.experiment.id.sampling.kind,
                    other.experiment.swept(),
                ) == (
                    &row.experiment.label,
                    &row.experiment.id.sampling.kind,
                    row.experiment.swept(),
                )
            };
            let together = all.iter().find(same).expect("the same experiment");
            assert_eq!(row.mean, together.mean, "{}", row.experiment.command);
            assert_eq!(row.variance, together.variance);
            assert_eq!(row.experiment.lookups_per_draw, together.experiment.lookups_per_draw);
            assert!(
                row.experiment.sharing.is_none()
                    || row.experiment.sharing < together.experiment.sharing
            );
            shared += usize::from(together.experiment.sharing.is_some());
        }
    }
    assert!(shared >= 14, "only {shared} shared their lookups");
}
