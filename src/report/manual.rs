//! Page of the manual about all columns of files, consoles and pages.

use std::fmt::Write;

use crate::judge::images::judgement::Tile;
use crate::report::changes::Difference;
use crate::report::fields::{Table, described, markdown};
use crate::report::judge::images::MEANINGS;
use crate::report::run::summary_csv::SummaryRow;
use crate::report::run::totals::{NOT_NORMAL, VERDICTS};
use crate::report::run::{case_csv, checks_csv};
use crate::report::{advise, bench, render};

/// Returns the page as Markdown. Sections of tables that other programs write come last, each with its title.
pub fn columns(others: &[(&str, String)]) -> String {
    let mut text = String::from(
        "# Columns\n\nReference for the columns of all tables: the name in CSV and JSON, the heading on the console and on pages, the unit, the \
         meaning. An empty field or `null` is unknown. This page is generated: `UPDATE_GOLDEN=1 cargo test --release --test it golden::`.\n\n\
         Units are those of the case: lengths as in its medium, σ in 1/length. [Python](python.md) returns the rows of a run by the same names.\n\n## Verdicts\n\n| verdict | mark | meaning |\n|---|---|---|\n",
    );
    for known in VERDICTS {
        let _ = writeln!(text, "| {} | {} | {} |", known.verdict.word(), known.mark, known.meaning);
    }
    let mut add = |title: &str, table: &str| {
        let _ = write!(text, "\n## {title}\n\n{table}");
    };
    add("Rows of a run: `summary.csv`, `CASE.csv`, `--format csv|json`", &of_files::<SummaryRow>());
    add("On consoles and pages only", &markdown(&SummaryRow::fields()[SummaryRow::FILES..]));
    add("Error bars: `CASE.csv` only", &markdown(&case_csv::deviations()));
    add("Predicted curves of a sweep: `CASE.theory.csv`", &of_files::<case_csv::Predicted>());
    add("The ray of a case: `CASE.anatomy.csv`", &of_files::<case_csv::RayPoint>());
    add("Findings of checks: `checks.csv`", &of_files::<checks_csv::FindingRow>());
    add("Changes since a stored run or bench: `changes.csv`", &of_files::<Difference>());
    add("Times: `bench.csv`, `bench --format csv|json`", &of_files::<bench::tables::BenchEntry>());
    add("Error against time: `CASE.error.csv`", &of_files::<bench::tables::Priced>());
    add("Advice: `advise.csv`, `advise --format csv|json`", &of_files::<advise::AdviceRow>());
    add(
        "Images of a renderer: `judgement.json`, `judge --images --format json`; `order.lag` is `lag` in the object `order`",
        &described(MEANINGS),
    );
    add("Tiles of images: `tiles.csv` of `judge --images`", &of_files::<&Tile>());
    add("Images: `gallery.csv` of `render`", &of_files::<render::PictureImage>());
    for (title, table) in others {
        add(title, table);
    }
    text + "\nA z in parentheses: " + NOT_NORMAL.trim_start_matches("(z): ") + ".\n"
}

/// Returns the columns of a table of files as Markdown.
pub fn of_files<T: Table>() -> String {
    markdown(&T::of_files())
}
