//! What changed since a stored run, on the screen: only what did.

use std::fmt::Write;

use super::layout::wrapped;
use crate::harness::baseline::compare::{Change, Comparison, Quantity, Rules, Sequel};
use crate::report::number::{fixed, short};

/// The section below the table, `width` columns wide.
#[must_use]
pub fn section(comparison: &Comparison, name: &str, rules: &Rules, width: usize) -> String {
    let mut text = String::new();
    let mut line = |words: &str| {
        for part in wrapped(words, width.max(40)) {
            let _ = writeln!(text, "{part}");
        }
    };
    let alpha = short(rules.alpha, 3);
    let compared = comparison.compared;
    line(&format!("baseline {name}: {compared} variances and lookups compared at α = {alpha}"));
    line(match comparison.sequel {
        Sequel::Run(_) => "e-values multiplied with those stored: same program, new seed",
        Sequel::SameSeed => "e-values not multiplied: the baseline has this seed already",
        Sequel::OtherProgram => "e-values not multiplied: another program made the baseline",
    });
    if comparison.blunt > 0 {
        line(&format!("{} variances not compared: too few draws", comparison.blunt));
    }
    for change in &comparison.changes {
        line(&told(change, rules));
    }
    for drift in &comparison.drifts {
        line(&format!(
            "DRIFT over runs: {}, {}: ln E = {:.1} ≥ {:.1} of all runs together; {}",
            drift.id, drift.check, drift.ln_e, drift.limit, drift.command
        ));
    }
    for (what, ids) in [
        ("not in the baseline", &comparison.added),
        ("only in the baseline", &comparison.missing),
        ("not compared, the case was rewritten", &comparison.rewritten),
    ] {
        if !ids.is_empty() {
            line(&format!("{what} ({}): {}", ids.len(), ids.join(", ")));
        }
    }
    if comparison.changes.is_empty() && comparison.drifts.is_empty() {
        line("no change");
    }
    text
}

fn told(change: &Change, rules: &Rules) -> String {
    let word = if change.is_regression { "REGRESSION" } else { "improvement" };
    let Change { id, ratio, command, .. } = change;
    let (what, unit) = match change.quantity {
        Quantity::Variance => ("variance", ""),
        Quantity::Lookups => ("lookups per draw", ""),
        Quantity::Time => ("processor time per draw", " ns"),
    };
    let value = |[value, error]: [f64; 2]| {
        let error = if error.is_nan() { String::new() } else { format!(" ± {}", short(error, 2)) };
        format!("{}{error}{unit}", fixed(value, 5))
    };
    let interval = match change.interval {
        Some([low, high]) => format!("in [{}, {}]", fixed(low, 4), fixed(high, 4)),
        None => {
            format!("beyond the tolerance of {}, its error unknown", short(rules.time_tolerance, 3))
        }
    };
    let (before, now, ratio) = (value(change.before), value(change.now), fixed(*ratio, 4));
    format!("{word}: {id}, {what}: {before} → {now}, ratio {ratio} {interval}; {command}")
}
