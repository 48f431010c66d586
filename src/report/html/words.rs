//! Numbers and verdicts as text of the page.

use crate::report::html::template::{Markup, html};

use crate::record::{Row, Verdict};
use crate::report::fields::Field;
use crate::report::run::totals::VERDICTS;
use numeric::digits::short;

/// Text for unknown or unbounded numbers.
pub const UNKNOWN: &str = "–";

/// Returns the anchor of a row in the page: the text of its identity, the same after every run of the case.
pub fn anchor(row: &Row) -> String {
    let id = &row.experiment.id;
    let comma = if row.channel.is_empty() { "" } else { ", " };
    format!("{id}{comma}{}", row.channel).replace(char::is_whitespace, "-")
}

/// Returns a number with this number of digits.
pub fn number(value: Option<f64>, digits: usize) -> String {
    let known = value.filter(|value| value.is_finite());
    known.map_or_else(|| UNKNOWN.to_owned(), |value| short(value, digits))
}

/// Returns a count.
pub fn count(value: Option<u64>) -> String {
    value.map_or_else(|| UNKNOWN.to_owned(), numeric::digits::count)
}

/// Returns a field of a row.
pub fn field<T>(field: &Field<T>, row: &T) -> String {
    Some(field.text(row)).filter(|text| !text.is_empty()).unwrap_or_else(|| UNKNOWN.to_owned())
}

/// Returns whether both ends of a range are finite.
pub fn is_known(range: &[f64; 2]) -> bool {
    range.iter().all(|end| end.is_finite())
}

/// Returns evidence in words.
pub fn evidence(ln_e: f64) -> String {
    if ln_e.is_finite() { short(ln_e, 4) } else { "∞".to_owned() }
}

/// Returns the word of a verdict, which is its style class, too.
pub fn word(verdict: Option<Verdict>) -> &'static str {
    verdict.map_or("undecided", Verdict::word)
}

/// Returns a verdict: its mark and its word. Its colour comes from the surrounding element.
pub fn verdict(verdict: Option<Verdict>) -> String {
    format!("{} {}", mark(verdict), word(verdict))
}

/// Returns a mark that distinguishes verdicts without colours.
pub fn mark(verdict: Option<Verdict>) -> &'static str {
    let known = VERDICTS.iter().find(|known| Some(known.verdict) == verdict);
    known.map_or("·", |known| known.mark)
}

/// Returns the rank of a verdict, the most serious first.
pub fn severity(verdict: Option<Verdict>) -> usize {
    VERDICTS.iter().position(|known| Some(known.verdict) == verdict).unwrap_or(VERDICTS.len())
}

/// Returns the number of things that are not shown.
pub fn more(all: usize, shown: usize) -> Markup {
    html! { @if all > shown { p { "and " (all - shown) " more, in the table below." } } }
}
