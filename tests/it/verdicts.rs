//! The gate: passes, failures, runs that are too short, and experiments that are not drawn.

use crate::common::{case, finding, judged, options, row, rows, verdict};
use trueflight::gate::CheckId;
use trueflight::record::Record;
use trueflight::record::{Results, Score, Verdict};
use trueflight::report::layout::Pen;
use trueflight::report::run::console::{self, TableView};
use trueflight::report::run::summary_csv as joined;

/// Dense layer between thin ones, T = e⁻²·⁸⁵: asymmetric, and not zero at the ends.
const LAYERS: &str = "
    medium.piecewise-constant = { breaks = [0, 1, 2.5, 4], values = [0.2, 1.5, 0.4] }
    span = [0, 4]";

fn transmittance(estimators: &str) -> String {
    format!(
        "title = \"t\"\n[problem.transmittance]\n{LAYERS}\n\
         sampling.constant.value = 1.6\nestimators = [{estimators}]"
    )
}

#[test]
fn correct_estimators_pass() {
    let text = transmittance(
        "{ woodcock = {} }, { ratio = {} }, { residual-ratio.sampling.constant.value = 4.0 }, { next-flight = {} }, \
         { unidirectional-mis = {} }, { single.rule = \"terminating\" }, { closed-form = {} }, \
         { single = { rule = \"non-terminating\", albedo = 0.5 } }, { regular = {} }, \
         { double = { control.explorers.points = 9, sampling.constant.value = 8.0 } }, { decomposition = {} }, \
         { local-majorant.sampling.local-majorants.segments = 8 }",
    );
    for row in rows(&text, 1_000_000) {
        assert_eq!(verdict(&row), Verdict::Pass, "{}: {}", row.experiment.label, row.reason());
    }
}

#[test]
fn a_biased_estimator_that_claims_to_be_fair_is_caught() {
    // Theory knows the bias of ray marching; the truth is not its mean.
    let rows = rows(
        &transmittance(
            "{ ray-marching.steps = 3 }, { ray-marching = { steps = 3, jitter = true } }",
        ),
        100_000,
    );
    for row in &rows {
        assert_eq!(verdict(row), Verdict::Fail, "{}", row.experiment.label);
        assert_eq!(finding(row, CheckId::Mean).verdict, Verdict::Fail);
        assert!(row.reason().contains("off by"), "{}", row.reason());
    }
}

#[test]
fn a_declared_bias_passes_once_it_is_seen() {
    let rows = rows(
        &transmittance(
            "{ ray-marching = { steps = 3, expect = \"biased\" } }, \
             { woodcock = { sampling.constant.value = 0.9, expect = \"biased\" } }",
        ),
        200_000,
    );
    for row in &rows {
        assert_eq!(verdict(row), Verdict::Pass, "{}: {}", row.experiment.label, row.reason());
        assert!(row.reason().contains("biased-as-expected"), "{}", row.reason());
    }
    // Woodcock tracking below the majorant has min(σ_t, σ̂): T = exp(−.2 − .9·1.5 − .4·1.5).
    let forced = row(&rows, "woodcock");
    let (mean, error) = (forced.mean.expect("a mean"), forced.standard_error.expect("an error"));
    assert!((mean - (-2.15f64).exp()).abs() < 5.0 * error, "{mean} ± {error}");
    assert_eq!((forced.predicted_variance, forced.experiment.predicted_lookups), (None, None));
}

#[test]
fn a_declared_bias_that_does_not_show_fails() {
    let rows = rows(&transmittance("{ ratio.expect = \"biased\" }"), 1_000_000);
    assert_eq!(verdict(&rows[0]), Verdict::Fail);
    assert!(rows[0].reason().contains("expected a bias"), "{}", rows[0].reason());
}

#[test]
fn a_run_that_is_too_short_says_how_long_it_should_be() {
    let text = transmittance("{ woodcock = {} }");
    let short = rows(&text, 1_000);
    assert_eq!(verdict(&short[0]), Verdict::Inconclusive);
    let reason = short[0].reason();
    let words: Vec<&str> = reason.split_whitespace().collect();
    let needed: f64 = words
        .windows(2)
        .find(|pair| pair[1].starts_with("draws"))
        .and_then(|pair| pair[0].parse().ok())
        .unwrap_or_else(|| panic!("no number of draws in {reason}"));
    assert!(needed > 1_000.0);
    // The number is rounded to two digits; slightly more than that is enough.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of draws")]
    let enough = rows(&text, (1.1 * needed) as u64);
    assert_eq!(finding(&enough[0], CheckId::Mean).verdict, Verdict::Pass);
}

#[test]
fn a_case_may_allow_what_is_too_short() {
    let text = format!("underpowered = \"allow\"\n{}", transmittance("{ woodcock = {} }"));
    assert_eq!(verdict(&rows(&text, 1_000)[0]), Verdict::Underpowered);
}

#[test]
fn a_tighter_tolerance_needs_more_draws() {
    let text = transmittance("{ ratio = {} }");
    assert_eq!(finding(&rows(&text, 200_000)[0], CheckId::Mean).verdict, Verdict::Pass);
    let tight = format!("{text}\n[tolerance]\nmean = 1e-5");
    assert_eq!(finding(&rows(&tight, 200_000)[0], CheckId::Mean).verdict, Verdict::Inconclusive);
}

#[test]
fn a_sigma_hat_of_zero_is_welcome_where_nothing_is_left_to_sample() {
    // The control equals σ_t on [1, 2.5], and σ̂ is zero there.
    let text = transmittance(
        "{ double = { \
         control.field.medium.constant.extinction = 1.5, \
         sampling.piecewise-constant = { breaks = [0, 1, 2.5, 4], values = [1, 0, 1] } } }",
    );
    let rows = rows(&text, 200_000);
    assert_ne!(verdict(&rows[0]), Verdict::Refused, "{}", rows[0].reason());
    assert_ne!(verdict(&rows[0]), Verdict::Fail, "{}", rows[0].reason());
}

#[test]
fn only_the_refused_member_of_a_sweep_is_refused() {
    let rows = rows(
        &format!(
            "title = \"t\"\n[problem.transmittance]\n{LAYERS}\n\
             sweep.sampling.values = [1.4, 2]\nestimators = [{{ woodcock = {{}} }}, {{ ratio = {{}} }}]"
        ),
        500_000,
    );
    let verdicts: Vec<Verdict> = rows.iter().map(verdict).collect();
    assert_eq!(verdicts, [Verdict::Refused, Verdict::Pass, Verdict::Pass, Verdict::Pass]);
    assert_eq!((rows[0].experiment.draws, rows[0].mean), (None, None), "it was drawn");
}

#[test]
fn steep_decays_are_resolved() {
    // Free flight through σ_t = 600 on [0, 1]: mean depth (1 − e⁻⁶⁰⁰)/600. Walks end after two lookups on average: σ̂ =
    // 2σ_t.
    let text = "title = \"t\"\n[problem.free-flight]\nmedium.constant.extinction = 600\n\
                span = [0, 1]\nestimators = [{ woodcock.sampling.constant.value = 1200 }]";
    let row = &rows(text, 200_000)[0];
    assert!((row.truth.expect("known") * 600.0 - 1.0).abs() < 1e-12);
    assert!((row.experiment.predicted_lookups.expect("known") - 2.0).abs() < 1e-10);
    assert_eq!(verdict(row), Verdict::Pass, "{}", row.reason());
}

/// Ratio tracking and the double particle without a control are the same estimator.
#[test]
fn what_is_the_same_by_definition_is_drawn_once() {
    let text = |estimators: &str| {
        format!(
            "title = \"same\"\n[problem.transmittance]
            medium.piecewise-constant = {{ breaks = [0, 1, 2], values = [0.4, 0.9] }}\nspan = [0, 2]
            sampling.constant.value = 1.5\nestimators = [{estimators}]"
        )
    };
    let double = "{ double = {} }";
    let rows = crate::common::rows(
        &text(&format!("{{ ratio = {{}} }}, {double}, {{ residual-ratio = {{}} }}")),
        100_000,
    );
    let alone = crate::common::rows(&text(double), 100_000);
    assert_eq!(
        [
            &rows[0].experiment.same_as(),
            &rows[1].experiment.same_as(),
            &rows[2].experiment.same_as()
        ],
        ["", "ratio", ""]
    );
    assert_eq!(alone[0].experiment.same_as(), "", "there is no other");
    for row in [&rows[1], &alone[0]] {
        assert_eq!(
            (row.mean, row.variance, row.experiment.drawn),
            (rows[0].mean, rows[0].variance, rows[0].experiment.drawn)
        );
        assert_eq!(row.verdict, rows[0].verdict);
    }
    assert_ne!(rows[2].mean, rows[0].mean, "its control is the mean");
}

/// `E[X^k] = exp(0.8((−1.5)^k − 1))` at σ̂ = 0.4: κ = 3.5, but `E[X⁸]/E[X⁴]²` = 5.4e5, so that a sample variance
/// of fewer than 5.4e7 draws is far from normal. At σ̂ = 4 both are below 20.
#[test]
fn a_z_whose_law_is_not_near_normal_is_marked() {
    let text = "title = \"t\"\n[problem.transmittance]\nmedium.constant.extinction = 1\nspan = [0, 2]\n\
                sweep.sampling.values = [0.4, 4]\nestimators = [{ ratio = {} }]";
    let marks = |draws: u64| {
        let record = judged(&[case("test", text)], &options(1, draws));
        let found = record.results.cases[0].rows().map(|row| row.not_normal.clone()).collect();
        (record, found)
    };
    let (record, found): (_, Vec<_>) = marks(400_000);
    assert_eq!(found, [vec![Score::Variance], vec![]]);
    let shown = console::table(&record, TableView::Run, Pen { width: 200, colour: false });
    let lines: Vec<&str> = shown.lines().filter(|line| line.starts_with("ratio")).collect();
    assert!(lines[0].matches('(').count() == 1 && !lines[1].contains('('), "{shown}");
    assert_eq!(shown.lines().filter(|line| line.starts_with("(z)")).count(), 1, "{shown}");
    let csv = joined::csv(&record).expect("a table");
    let columns: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    let last = columns[0].iter().position(|&name| name == "not_normal").expect("a column");
    assert_eq!((columns[1][last], columns[2][last]), ("z_variance", ""));
    // 100 κ = 350 draws make a mean normal.
    let (_, found): (_, Vec<_>) = marks(300);
    assert_eq!(found[0], [Score::Mean, Score::Variance, Score::Lookups]);
    let (record, _): (_, Vec<Vec<Score>>) = marks(400_000);
    let record = Record { results: Results { cases: vec![], ..record.results }, ..record };
    let shown = console::table(&record, TableView::Run, Pen { width: 200, colour: false });
    assert!(!shown.contains("(z)"), "{shown}");
}
