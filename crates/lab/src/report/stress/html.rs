//! `stress/report.html`: every bound of the stress test, and where single precision fails.

use trueflight::report::html::template::html;

use crate::stress::{Stress, TrialRow};
use numeric::digits::time;
use trueflight::report::ReportError;
use trueflight::report::fields::{Shown, shown};
use trueflight::report::html::drawing::{definitions, plot};
use trueflight::report::html::listing::{page, section};

/// Columns of the page, beside the result.
const COLUMNS: &[Shown] = shown!(&TrialRow:
    "quantity", "range", "worst", "bound", "measure", "trials", "where"
);

/// Returns the stress test as a page of HTML.
pub fn text(stress: &Stress) -> Result<String, ReportError> {
    let rows: Vec<&TrialRow> = stress.rows.iter().collect();
    let broken = rows.iter().filter(|row| !row.holds()).count();
    let (class, line) = match broken {
        0 => ("pass", format!("pass: all {} bounds hold", rows.len())),
        broken => ("fail", format!("fail: {broken} of {} bounds are broken", rows.len())),
    };
    let label = "single precision: its bias beside the statistical error of 1e8 draws".to_owned();
    let plot = plot("single".to_owned(), label, &super::plot::figure(&stress.narrow.curves)?);
    let plots = [vec![plot]];
    let sections = html! {
        (definitions(&plots))
        (section("Bounds", "holds", |row| (if row.holds() { "pass" } else { "fail" }, word(row)), COLUMNS, &rows, |row| word(row)))
        section aria-labelledby="narrow" {
            h2 #narrow { "Single precision" }
            (plots[0][0].show())
        }
    };
    let head = html! { p { (time(stress.seconds)) } };
    Ok(page("numbers under stress", (class, &line), &head, &sections))
}

fn word(row: &TrialRow) -> String {
    if row.holds() { "✓ yes" } else { "✗ NO" }.to_owned()
}
