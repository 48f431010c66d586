//! Correct estimators at the resolution of doubles: none of them may fail.

use crate::common::{case, judged, options, rows, verdict};
use trueflight::plan::Amount;
use trueflight::plan::Options;
use trueflight::record::{Row, Verdict};

fn no_fail(what: &str, rows: &[Row]) {
    for row in rows {
        assert_ne!(
            verdict(row),
            Verdict::Fail,
            "{what}, {}: {}",
            row.experiment.label,
            row.reason()
        );
    }
}

#[test]
fn a_spread_near_rounding_goes_through_the_gate() {
    for digits in 10..=16 {
        // r = 10^{−digits}: relative spreads from 1e-10 down to 1e-16 and to 0.
        let control = format!("0.{}", "9".repeat(digits));
        let text = format!(
            "title = \"t\"\n[problem.transmittance]\nmedium.constant.extinction = 1\nspan = [0, 3]\n\
             sampling.constant.value = 1\n\
             estimators = [{{ residual-ratio.control.constant.value = {control} }},\n\
             {{ double.control.constant.value = {control} }}]"
        );
        let rows = rows(&text, 200_000);
        no_fail(&control, &rows);
        assert!(rows.iter().all(|row| verdict(row) == Verdict::Pass), "{control}");
    }
}

#[test]
fn steps_of_a_curve_without_spread_join_the_next() {
    for control in
        ["control.explorers.points = 7", "control.explorers.points = 4", "control.none = {}"]
    {
        let text = format!(
            "title = \"t\"\n[problem.transmittance]\n\
             medium.piecewise-linear = {{ knots = [0, 1, 2, 3], values = [0.2, 1, 0.5, 0.1] }}\n\
             span = [0, 3]\ndistances = 6\nsampling.constant.value = 1.2\n\
             estimators = [{{ double.{control} }}]"
        );
        no_fail(control, &rows(&text, 200_000));
    }
}

#[test]
fn a_short_last_block_says_nothing_about_streams() {
    let text = "title = \"t\"\n[problem.transmittance]\nmedium.constant.extinction = 0.5\n\
                span = [0, 2]\nsampling.constant.value = 1\n\
                estimators = [{ woodcock = {} }, { ratio = {} }]";
    let cases = [case("t", text)];
    for draws in [65_540, 65_600, 66_000, 82_000] {
        for seed in 1..=4 {
            let draws = Amount::Exactly(draws);
            // The usual level of users: no p-value may be 1e-6 or 4e-11.
            let options = Options { seed, draws, fixed: true, ..Options::default() };
            let record = judged(&cases, &options);
            no_fail(&format!("{draws:?}, seed {seed}"), &record.results.rows().collect::<Vec<_>>());
        }
    }
}

#[test]
fn distances_far_from_the_origin_may_tie() {
    for (from, to, sigma) in [(9_999.9, 1e4, 6e3), (99_999.99, 1e5, 6e4)] {
        let text = format!(
            "title = \"t\"\n[problem.free-flight]\n\
             medium.piecewise-constant = {{ breaks = [0, {from}, {to}], values = [0, {sigma}] }}\n\
             span = [0, {to}]\nsampling.constant.value = {sigma}\n\
             estimators = [{{ inversion = {{}} }}, {{ woodcock.sampling.piecewise-constant = \
             {{ breaks = [0, {from}, {to}], values = [0, {sigma}] }} }}]"
        );
        let cases = [case("t", &text)];
        for seed in 1..=6 {
            let record = judged(&cases, &options(seed, 100_000));
            no_fail(&format!("{from}, seed {seed}"), &record.results.rows().collect::<Vec<_>>());
        }
    }
}
