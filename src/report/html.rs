//! `report.html`: the whole record as one page that needs no network and no other file.
//!
//! The verdict and what to look at first, then what changed since a stored run, the cases with their plots,
//! and a table of all experiments, each of which opens. Filters and sorting need JavaScript, nothing else does.
//! All words of a record go through the template's escapes: a title is text, whatever is in it.

pub mod bench;
mod cases;
mod changes;
mod details;
mod drawing;
mod experiments;
mod filters;
mod first;
pub mod gallery;
mod listing;
pub mod page;
mod plots;
mod sparks;
pub mod stress;
mod words;

use maud::html;

use crate::record::Record;
use crate::report::{Artifact, ReportError};

/// The record as a page.
///
/// # Errors
///
/// Where a plot cannot be drawn.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    Ok(vec![Artifact::text("report.html", text(record)?)])
}

/// The record as a page of HTML.
///
/// # Errors
///
/// Where a plot cannot be drawn.
pub fn text(record: &Record) -> Result<String, ReportError> {
    let plots = plots::all(record)?;
    let title = format!("Trueflight: {}", first::verdict(record).words());
    let body = html! {
        (plots::definitions(&plots))
        (first::section(record))
        @if let Some(comparison) = &record.comparison { (changes::section(comparison)) }
        (cases::section(record, &plots))
        (experiments::section(record, &plots))
    };
    Ok(page::document(&title, &body))
}
