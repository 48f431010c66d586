//! Page of the manual about all columns of files, consoles and pages.

use std::fmt::Write;

use crate::report::fields::markdown;
use crate::report::run::totals::{NOT_NORMAL, VERDICTS};
use crate::report::{advise, bench, run, self_test, stress};

/// Returns the page as Markdown.
pub fn columns() -> String {
    let mut text = String::from(
        "# Columns\n\nReference for the columns of all tables: the name in CSV and JSON, the heading on the console and on pages, the unit, the \
         meaning. An empty field or `null` is unknown. This page is generated: `UPDATE_GOLDEN=1 cargo test --release --test it golden::`.\n\n\
         Units are those of the case: lengths as in its medium, σ in 1/length. [Python](python.md) returns the rows of a run by the same names.\n\n## Verdicts\n\n| verdict | mark | meaning |\n|---|---|---|\n",
    );
    for known in VERDICTS {
        let _ = writeln!(text, "| {} | {} | {} |", known.verdict.word(), known.mark, known.meaning);
    }
    let mut add = |title: &str, table: String| {
        let _ = write!(text, "\n## {title}\n\n{table}");
    };
    add(
        "Rows of a run: `summary.csv`, `CASE.csv`, `--format csv|json`",
        markdown(&run::fields::of_files()),
    );
    add("On consoles and pages only", markdown(&run::fields::of_screens()));
    add("Findings of checks: `checks.csv`", markdown(&run::checks_csv::of_findings()));
    add("Times: `bench.csv`, `bench --format csv|json`", markdown(&bench::tables::of_rows()));
    add("Advice: `advise.csv`, `advise --format csv|json`", markdown(&advise::of_rows()));
    add("Error against time: `CASE.error.csv`", markdown(&bench::tables::of_errors()));
    add("Promised rates: `self-test/calibration.csv`", markdown(&self_test::of_rates()));
    add("Foreign streams: `self-test/foreign-streams.csv`", markdown(&self_test::of_streams()));
    add("Known bugs: `self-test/mutants.csv`", markdown(&self_test::of_mutants()));
    add("Bounds: `stress/stress.csv`", markdown(&stress::of_rows()));
    add("Single precision: `stress/single-precision.csv`", markdown(&stress::of_points()));
    text + "\nA z in parentheses: " + NOT_NORMAL.trim_start_matches("(z): ") + ".\n"
}
