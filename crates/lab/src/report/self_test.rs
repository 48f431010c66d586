//! Tables of the self-test: promises, streams and mutants, on the screen and as CSV.

use std::fmt::Write;

use crate::mutants::Caught;
use crate::self_test::SelfTest;
use crate::self_test::calibration::{Calibration, Rate};
use crate::self_test::streams::{ALPHA, StreamVerdicts};
use numeric::digits::{count, short};
use trueflight::report::fields::{self, Shown, Table, grid, judged, shown, table};
use trueflight::report::layout::{LayoutField, Paint, Pen};
use trueflight::report::lists::joined;
use trueflight::report::{Artifact, ReportError};

/// Words for a promise.
const KEPT: [&str; 2] = ["kept", "BROKEN"];

/// Columns of the screen, each with its rank.
const RATES: &[Shown] = shown!(&Rate:
    "what", "count", "trials", "rate", "low_99", "high_99", "promise"
);
const STREAMS: &[Shown] = shown!(&StreamVerdicts: "law", "known", "pass", "fail", "inconclusive");
const MUTANTS: &[Shown] = shown!(&Caught: "mutant", "place" 1, "check", "draws", "others" 2);

/// Returns the tables for the screen.
pub fn table(self_test: &SelfTest, pen: Pen) -> String {
    let mut text = String::new();
    promises(&mut text, pen, &self_test.calibration);
    streams(&mut text, pen, &self_test.streams);
    mutants(&mut text, pen, &self_test.mutants);
    let verdict = if self_test.holds() {
        pen.paint(Paint::Green, "every promise is kept and every mutant is caught")
    } else {
        pen.paint(Paint::Red, "a promise is broken or a mutant escapes")
    };
    let _ = writeln!(text, "{verdict} · {} s", short(self_test.seconds, 3));
    text
}

fn promises(text: &mut String, pen: Pen, calibration: &Calibration) {
    let Calibration { runs, scalars, laws, draws, .. } = calibration;
    let title = format!(
        "calibration: {runs} independent runs of {scalars} scalars and {laws} distributions"
    );
    let _ = writeln!(text, "{} · {} draws", pen.paint(Paint::Bold, &title), count(*draws));
    let rates: Vec<&Rate> = rates(calibration).collect();
    text.push_str(&judged(&rates, RATES, ("", KEPT), |rate| rate.is_kept, pen));
    let uniform = calibration.uniformity.iter();
    let uniform =
        uniform.filter_map(|check| Some(format!("{} {}", check.check, short(check.p?, 2))));
    let uniform = joined(uniform, ", ");
    if !uniform.is_empty() {
        let said = format!("p-values against the uniform law, Anderson–Darling p: {uniform}");
        pen.say(text, Paint::Dim, &said);
    }
    text.push('\n');
}

fn streams(text: &mut String, pen: Pen, streams: &[StreamVerdicts]) {
    let failed: u64 = streams.iter().map(|verdicts| verdicts.failed).sum();
    let all: u64 = streams.iter().map(|verdicts| verdicts.streams).sum();
    let title = format!(
        "foreign draws: {failed} of {all} verdicts on correct streams of difficult distributions fail"
    );
    let _ = writeln!(text, "{}", pen.paint(Paint::Bold, &title));
    let rows: Vec<&StreamVerdicts> = streams.iter().collect();
    let table = judged(&rows, STREAMS, ("", KEPT), |verdicts| verdicts.is_kept(), pen);
    let _ = writeln!(text, "{table}");
}

/// Returns all rates with a promise.
fn rates(calibration: &Calibration) -> impl Iterator<Item = &Rate> {
    let shares = calibration.uniformity.iter().flat_map(|check| &check.below);
    calibration.rates.iter().chain(shares)
}

fn share(rate: &Rate) -> f64 {
    if rate.trials == 0 { 0.0 } else { rate.count as f64 / rate.trials as f64 }
}

fn mutants(text: &mut String, pen: Pen, mutants: &[Caught]) {
    let caught = mutants.iter().filter(|mutant| mutant.is_right()).count();
    let title = format!("mutants: {caught} of {} caught, each control passes", mutants.len());
    let _ = writeln!(text, "{}", pen.paint(Paint::Bold, &title));
    let rows: Vec<&Caught> = mutants.iter().collect();
    let mut grid = grid(&rows, MUTANTS);
    for (field, mutant) in grid.columns[3].fields.iter_mut().zip(mutants) {
        match mutant.draws {
            Some(_) if mutant.twin_passes => {}
            Some(_) => *field = LayoutField::judged(false, ["", "THE CONTROL FAILS"]),
            None => *field = LayoutField::judged(false, ["", "ESCAPES"]),
        }
    }
    grid.fit(pen.width);
    let _ = writeln!(text, "{}", grid.render(pen));
}

/// Returns the checks that fail beside the one that must.
fn others(mutant: &Caught) -> String {
    joined(
        mutant.failed.iter().filter(|check| **check != mutant.check).map(|check| check.name()),
        ", ",
    )
}

table! {
    impl<'a> for &'a Rate {
        "what": "Kind of error" = |rate| &rate.what;
        "count": "Number of errors" = |rate| rate.count;
        "trials" ["of", "", Plain]: "Number of trials" = |rate| rate.trials;
        "low_99" ["at least", "", Short(2)]: "Lower end of the 99 % interval of the rate" = |rate| rate.limits[0];
        "high_99" ["at most (99 %)", "", Short(2)]: "Upper end" = |rate| rate.limits[1];
        "promise" ["promised", "", Short(2)]: "Promised bound on the rate" = |rate| rate.promise;
        "kept": "Whether the interval allows the promise" = |rate| rate.is_kept;
    } screens {
        "rate" ["rate", "", Short(2)]: "Number of errors over the number of trials" = |rate| share(rate);
    }
}

table! {
    impl<'a> for &'a StreamVerdicts {
        "law": "Distribution of the draws" = |verdicts| &verdicts.distribution;
        "known": "What the check is told of it" = |verdicts| &verdicts.known;
        "streams": "Number of streams" = |verdicts| verdicts.streams;
        "pass": "Number that pass" = |verdicts| verdicts.passed;
        "fail": "Number that fail" = |verdicts| verdicts.failed;
        "inconclusive": "Number that are inconclusive" = |verdicts| verdicts.inconclusive;
        "promise": "Promised bound on the rate" = |_verdicts| ALPHA;
        "kept": "Whether the interval allows the promise" = |verdicts| verdicts.is_kept();
    }
}

table! {
    impl<'a> for &'a Caught {
        "mutant": "Name of the known bug" = |mutant| mutant.name;
        "bug": "Description of the bug" = |mutant| mutant.bug;
        "case": "Case that it is put into" = |mutant| mutant.case;
        "estimator": "Estimator that has it" = |mutant| &mutant.estimator;
        "check" ["caught by", "", Plain]: "Check that must catch it" = |mutant| mutant.check.name();
        "draws": "Number of draws until it was caught; empty if it escaped" = |mutant| mutant.draws;
        "failed": "All checks that fail" = |mutant| joined(mutant.failed.iter().map(|check| check.name()), " ");
        "twin_passes": "Whether the correct estimator passes with the same draws" = |mutant| mutant.twin_passes;
    } screens {
        "place" ["on", "", Plain]: "Case and estimator, as in `rod/known-bugs: analog`" = |mutant| format!("{}: {}", mutant.case, mutant.estimator);
        "others" ["also by", "", Plain]: "Other checks that fail" = |mutant| others(mutant);
    }
}

/// Returns the tables as CSV files.
pub fn artifacts(self_test: &SelfTest) -> Result<Vec<Artifact>, ReportError> {
    Ok(vec![
        fields::artifact(
            "self-test/calibration.csv",
            &<&Rate>::of_files(),
            rates(&self_test.calibration),
        )?,
        fields::artifact(
            "self-test/foreign-streams.csv",
            &<&StreamVerdicts>::fields(),
            &self_test.streams,
        )?,
        fields::artifact("self-test/mutants.csv", &<&Caught>::of_files(), &self_test.mutants)?,
    ])
}
