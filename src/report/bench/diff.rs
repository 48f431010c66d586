//! Changes since a stored bench, in words.

use crate::bench::record::Spread;
use crate::bench::stored::{Change, Comparison};
use crate::case::id::ExperimentId;
use crate::report::run::diff::{counts, ending, listed, not_empty};
use numeric::digits::{fixed, short};

/// Returns the extent of the comparison, and its conditions.
pub fn remarks(comparison: &Comparison) -> Vec<String> {
    let Comparison { name, tolerance, compared, .. } = comparison;
    let tolerance = short(*tolerance, 3);
    let mut remarks = vec![format!(
        "baseline {name}: {compared} times per draw compared; a change is one whose rounds do not \
         overlap and whose ratio is beyond the tolerance of {tolerance}"
    )];
    if let Some([before, now]) = &comparison.levels {
        remarks.push(format!("the vector hardware differs: {before} then, {now} now"));
    }
    remarks.extend(left_out(comparison).into_iter().map(|(why, ids)| listed(why, ids)));
    remarks.extend(ending(nothing(comparison), !comparison.changes.is_empty()));
    remarks
}

/// Returns the experiments that were left out, by the reason.
fn left_out(comparison: &Comparison) -> Vec<(&'static str, &[ExperimentId])> {
    not_empty([
        ("not in the baseline", &comparison.added),
        ("only in the baseline", &comparison.missing),
        ("not compared, the case was rewritten", &comparison.rewritten),
    ])
}

/// Returns the reason why nothing was compared; `None` if something was.
pub fn nothing(comparison: &Comparison) -> Option<String> {
    let is_empty = comparison.is_empty();
    is_empty.then(|| format!("nothing was compared: {}", counts(&left_out(comparison))))
}

/// Returns all changes, slower experiments first: whether each became slower, and the numbers.
pub fn all(comparison: &Comparison) -> Vec<(bool, String)> {
    let mut told: Vec<_> =
        comparison.changes.iter().map(|change| (change.is_regression, line(change))).collect();
    told.sort_by_key(|(is_worse, _)| !is_worse);
    told
}

fn line(change: &Change) -> String {
    let [before, now] = change.ns_per_draw.map(of_rounds);
    let [earlier, later] = change.speedup.map(of_rounds);
    let ratio = fixed(change.ratio, 3);
    format!(
        "{}: time per draw {before} → {now} ns, ratio {ratio}; speedup over the plain loop \
         {earlier} → {later}",
        change.id
    )
}

/// Returns the median with the minimum and the maximum of the rounds.
fn of_rounds(spread: Spread) -> String {
    let [median, least, most] = [spread.median, spread.least, spread.most].map(|x| short(x, 3));
    format!("{median} [{least}, {most}]")
}
