//! `stress/report.html`: every bound of the stress test, and where single precision fails.

use maud::html;

use crate::report::ReportError;
use crate::report::fields::places;
use crate::report::html as page;
use crate::report::html::drawing::{definitions, plot};
use crate::report::html::listing::{self, table};
use crate::stress::{Row, Stress};
use numeric::digits::time;

/// Columns of the page, beside the result.
const COLUMNS: [usize; 7] =
    places::<&Row, _>(["quantity", "range", "worst", "bound", "measure", "trials", "where"]);

/// Returns the stress test as a page of HTML.
pub fn text(found: &Stress) -> Result<String, ReportError> {
    let rows: Vec<&Row> = found.rows.iter().collect();
    let broken = rows.iter().filter(|row| !row.holds()).count();
    let (class, line) = match broken {
        0 => ("pass", format!("pass: all {} bounds hold", rows.len())),
        broken => ("fail", format!("fail: {broken} of {} bounds are broken", rows.len())),
    };
    let label = "single precision: its bias beside the statistical error of 1e8 draws".to_owned();
    let plot = plot("single".to_owned(), label, &super::plot::figure(&found.narrow.curves)?);
    let plots = [vec![plot]];
    let choices = [("group", rows.iter().map(|row| word(row).to_owned()).collect())];
    let body = html! {
        (definitions(&plots))
        header class={ "run " (class) } {
            p.tool { "Trueflight " (env!("CARGO_PKG_VERSION")) ", numbers under stress" }
            h1 { (line) }
            p { (time(found.seconds)) }
        }
        section aria-labelledby="experiments" {
            h2 #experiments { "Bounds" }
            (listing::form(&choices, rows.len()))
            (table("holds", |row| (if row.holds() { "pass" } else { "fail" }, word(row).to_owned()), &COLUMNS, &rows, |row| word(row).to_owned()))
        }
        section aria-labelledby="narrow" {
            h2 #narrow { "Single precision" }
            (plots[0][0].show())
        }
    };
    Ok(page::document(&format!("Trueflight: {line}"), &body))
}

fn word(row: &Row) -> &'static str {
    if row.holds() { "✓ yes" } else { "✗ NO" }
}
