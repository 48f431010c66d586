//! Numbers and verdicts as they stand on the page.

use crate::record::{Row, Score, Verdict};
use numeric::digits::{short, signed};

/// What is unknown, or without bound.
pub const UNKNOWN: &str = "–";

/// Anchor of a row in the page: the text of its identity, the same after every run of the case.
pub fn anchor(row: &Row) -> String {
    let id = &row.experiment.id;
    let comma = if row.channel.is_empty() { "" } else { ", " };
    format!("{id}{comma}{}", row.channel).replace(char::is_whitespace, "-")
}

/// A number in so many digits.
pub fn number(value: Option<f64>, digits: usize) -> String {
    let known = value.filter(|value| value.is_finite());
    known.map_or_else(|| UNKNOWN.to_owned(), |value| short(value, digits))
}

/// A count.
pub fn count(value: Option<u64>) -> String {
    value.map_or_else(|| UNKNOWN.to_owned(), numeric::digits::count)
}

/// A z-score, in parentheses where it is not to be read as normal.
pub fn z(row: &Row, score: Score, z: Option<f64>) -> String {
    match z.filter(|z| z.is_finite()) {
        None => UNKNOWN.to_owned(),
        Some(z) if row.not_normal.contains(&score) => format!("({})", signed(z)),
        Some(z) => signed(z),
    }
}

/// Whether both ends of a range are numbers.
pub fn is_known(range: &[f64; 2]) -> bool {
    range.iter().all(|end| end.is_finite())
}

/// Evidence, which may be beyond all numbers: then it is above all others.
pub fn ordered(ln_e: f64) -> f64 {
    if ln_e.is_finite() { ln_e } else { f64::INFINITY }
}

/// Evidence in words.
pub fn evidence(ln_e: f64) -> String {
    if ln_e.is_finite() { short(ln_e, 4) } else { "∞".to_owned() }
}

/// A verdict: its mark and its word. Its colour is of the element about it.
pub fn verdict(verdict: Option<Verdict>) -> String {
    verdict.map_or_else(
        || "· undecided".to_owned(),
        |verdict| format!("{} {}", mark(verdict), verdict.word()),
    )
}

/// A mark that tells verdicts apart without colours.
fn mark(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "✓",
        Verdict::Fail => "✗",
        Verdict::Inconclusive => "?",
        Verdict::Underpowered => "~",
        Verdict::Refused => "⊘",
    }
}
