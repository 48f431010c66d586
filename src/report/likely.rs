//! Likely causes of an experiment's failures: the words that the console and the reports share.

use crate::record::{Row, Verdict};
use gate::causes::{Pattern, Place};

/// The fewest swept values that have an end.
const FEWEST: usize = 3;

/// The likely causes of a failing row, line by line; empty for a row that does not fail.
pub fn lines(row: &Row) -> Vec<String> {
    pattern(row).lines()
}

/// Which checks of a row fail, on which side, and where along the sweep.
pub fn pattern(row: &Row) -> Pattern {
    let mut pattern = Pattern::default();
    if row.verdict != Some(Verdict::Fail) {
        return pattern;
    }
    // A declared bias that is not shown has no bug behind it.
    let failing = row.findings().filter(|f| f.verdict == Verdict::Fail && !f.expects_bias);
    for finding in failing {
        // Draws without chance fail by themselves, without the gate.
        let measured = || row.mean.zip(row.truth).map(|(mean, truth)| mean - truth);
        let off = finding.gate.map(|gate| gate.mean);
        pattern
            .note(&finding.check, off.or_else(|| measured().filter(|_| finding.check == "mean")));
    }
    pattern.place = place(row);
    pattern
}

/// Whether an estimator fails at one end of a sweep of σ̂ only.
fn place(row: &Row) -> Place {
    let is_of_sampling = |what: &str| ["sampling", "sampling-scale"].contains(&what);
    if !row.case.sweep.as_ref().is_some_and(|sweep| is_of_sampling(&sweep.what)) {
        return Place::Anywhere;
    }
    let is_same = |other: &Row| {
        (other.experiment.listed, &other.channel) == (row.experiment.listed, &row.channel)
            && other.verdict != Some(Verdict::Refused)
    };
    let along = row.case.rows().filter(is_same).filter_map(|other| {
        Some((other.experiment.swept()?, other.verdict == Some(Verdict::Fail)))
    });
    let mut along: Vec<(f64, bool)> = along.collect();
    along.sort_by(|a, b| a.0.total_cmp(&b.0));
    // One change from failing to not failing, or back.
    let changes = along.windows(2).filter(|pair| pair[0].1 != pair[1].1).count();
    match (along.len() >= FEWEST && changes == 1, along.first()) {
        (true, Some((_, true))) => Place::LowEnd,
        (true, Some((_, false))) => Place::HighEnd,
        _ => Place::Anywhere,
    }
}
