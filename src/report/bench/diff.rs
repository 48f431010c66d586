//! Changes since a stored bench, in words.

use crate::bench::record::Spread;
use crate::bench::stored::{BenchComparison, TimeChange};
use crate::case::id::ExperimentId;
use crate::report::changes::{Changes, Difference, LeftOut, closing, counts, not_empty};
use numeric::digits::{fixed, short};

/// Returns the table of changes with its remarks; slower experiments come first.
pub fn changes(comparison: &BenchComparison) -> Changes {
    let mut all: Vec<Difference> = comparison.changes.iter().map(difference).collect();
    all.sort_by_key(|change| !change.is_worse);
    Changes { name: comparison.name.clone(), all, remarks: remarks(comparison) }
}

/// Returns the extent of the comparison, and its conditions.
fn remarks(comparison: &BenchComparison) -> Vec<String> {
    let BenchComparison { name, tolerance, compared, .. } = comparison;
    let tolerance = short(*tolerance, 3);
    let mut remarks = vec![format!(
        "baseline {name}: {compared} times per draw compared; a change is one whose rounds do not \
         overlap and whose ratio is beyond the tolerance of {tolerance}"
    )];
    if let Some([before, now]) = &comparison.levels {
        remarks.push(format!("the vector hardware differs: {before} then, {now} now"));
    }
    let has_changes = !comparison.changes.is_empty();
    remarks.extend(closing(&left_out(comparison), nothing(comparison), has_changes));
    remarks
}

/// Returns the experiments that were left out, by the reason.
fn left_out(comparison: &BenchComparison) -> Vec<LeftOut<'_, ExperimentId>> {
    not_empty([
        ("not in the baseline", &comparison.added),
        ("only in the baseline", &comparison.missing),
        ("not compared, the case was rewritten", &comparison.rewritten),
    ])
}

/// Returns the reason why nothing was compared; `None` if something was.
pub fn nothing(comparison: &BenchComparison) -> Option<String> {
    let is_empty = comparison.is_empty();
    is_empty.then(|| format!("nothing was compared: {}", counts(&left_out(comparison))))
}

fn difference(change: &TimeChange) -> Difference {
    let value = |of: Spread| Some((of.median, format!("{} ns", of_rounds(of))));
    let [earlier, later] = change.speedup.map(of_rounds);
    let ratio = fixed(change.ratio, 3);
    Difference {
        is_worse: change.is_regression,
        experiment: change.id.to_string(),
        quantity: "time per draw".to_owned(),
        values: change.ns_per_draw.map(value),
        ratio: Some(change.ratio),
        interval: None,
        extent: format!("ratio {ratio}; speedup over the plain loop {earlier} → {later}"),
        command: String::new(),
    }
}

/// Returns the median with the minimum and the maximum of the rounds.
fn of_rounds(spread: Spread) -> String {
    let [median, least, most] = [spread.median, spread.least, spread.most].map(|x| short(x, 3));
    format!("{median} [{least}, {most}]")
}
