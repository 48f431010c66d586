//! What changed since a stored run, in words that the console and the summaries share.

use crate::harness::baseline::compare::{Change, Comparison, Drift, Quantity, Sequel};
use crate::report::number::{fixed, short};

/// Something that changed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Told<'a> {
    /// Whether it became worse.
    pub is_worse: bool,
    /// The experiment.
    pub experiment: &'a str,
    /// What changed, with the numbers.
    pub what: String,
    /// The command that repeats the experiment.
    pub command: &'a str,
}

impl Told<'_> {
    /// Everything on one line, but for the command.
    #[must_use]
    pub fn line(&self) -> String {
        format!("{}: {}", self.experiment, self.what)
    }
}

/// What was compared, and how.
#[must_use]
pub fn remarks(comparison: &Comparison) -> Vec<String> {
    let Comparison { name, rules, compared, blunt, .. } = comparison;
    let alpha = short(rules.alpha, 3);
    let mut remarks =
        vec![format!("baseline {name}: {compared} variances and lookups compared at α = {alpha}")];
    if *blunt > 0 {
        remarks.push(format!(
            "too few draws, or too heavy a tail, to compare the variance: {blunt} times"
        ));
    }
    remarks.push(match comparison.sequel {
        Sequel::Run(runs) => format!(
            "e-values multiplied with those stored, {runs} runs together: same program, new seed"
        ),
        Sequel::SameSeed => {
            "e-values not multiplied: the baseline has this seed already".to_owned()
        }
        Sequel::OtherProgram => {
            "e-values not multiplied: another program made the baseline".to_owned()
        }
    });
    for (what, ids) in [
        ("not in the baseline", &comparison.added),
        ("only in the baseline", &comparison.missing),
        ("not compared, the case was rewritten", &comparison.rewritten),
    ] {
        if !ids.is_empty() {
            remarks.push(format!("{what} ({}): {}", ids.len(), ids.join(", ")));
        }
    }
    if comparison.changes.is_empty() && comparison.drifts.is_empty() {
        remarks.push("no change".to_owned());
    }
    remarks
}

/// What changed: what became worse first.
#[must_use]
pub fn all(comparison: &Comparison) -> Vec<Told<'_>> {
    let mut told: Vec<Told> = comparison.drifts.iter().map(drift).collect();
    let tolerance = comparison.rules.time_tolerance;
    told.extend(comparison.changes.iter().map(|one| change(one, tolerance)));
    told.sort_by_key(|told| !told.is_worse);
    told
}

fn drift(drift: &Drift) -> Told<'_> {
    let Drift { id, check, ln_e, limit, command } = drift;
    let what = format!("{check}: ln E = {ln_e:.1} ≥ {limit:.1} of all runs together");
    Told { is_worse: true, experiment: id, what, command }
}

fn change(change: &Change, tolerance: f64) -> Told<'_> {
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
        None => format!("beyond the tolerance of {}, its error unknown", short(tolerance, 3)),
    };
    let (before, now) = (value(change.before), value(change.now));
    let ratio = fixed(change.ratio, 4);
    Told {
        is_worse: change.is_regression,
        experiment: &change.id,
        what: format!("{what} {before} → {now}, ratio {ratio} {interval}"),
        command: &change.command,
    }
}
