//! Numbers and verdicts as text of the page.

use crate::record::{Row, Score, Verdict};
use numeric::digits::{short, signed};

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

/// Returns a z-score, in parentheses if it is not to be read as normal.
pub fn z(row: &Row, score: Score, z: Option<f64>) -> String {
    match z.filter(|z| z.is_finite()) {
        None => UNKNOWN.to_owned(),
        Some(z) if row.not_normal.contains(&score) => format!("({})", signed(z)),
        Some(z) => signed(z),
    }
}

/// Returns whether both ends of a range are finite.
pub fn is_known(range: &[f64; 2]) -> bool {
    range.iter().all(|end| end.is_finite())
}

/// Returns evidence for sorting: infinite evidence is above all other.
pub fn ordered(ln_e: f64) -> f64 {
    if ln_e.is_finite() { ln_e } else { f64::INFINITY }
}

/// Returns evidence in words.
pub fn evidence(ln_e: f64) -> String {
    if ln_e.is_finite() { short(ln_e, 4) } else { "∞".to_owned() }
}

/// Returns a verdict: its mark and its word. Its colour comes from the surrounding element.
pub fn verdict(verdict: Option<Verdict>) -> String {
    verdict.map_or_else(
        || "· undecided".to_owned(),
        |verdict| format!("{} {}", mark(verdict), verdict.word()),
    )
}

/// Returns a mark that distinguishes verdicts without colours.
fn mark(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "✓",
        Verdict::Fail => "✗",
        Verdict::Inconclusive => "?",
        Verdict::Underpowered => "~",
        Verdict::Refused => "⊘",
    }
}
