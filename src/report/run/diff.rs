//! Changes since a stored run, in words that the console and the summaries share.

use std::fmt::Display;

use crate::record::baseline::{
    Change, ChannelId, Comparison, Drift, LeftOut, Measured, Quantity, Sequel,
};
use numeric::digits::{fixed, short};

/// Change of a quantity.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference<'a> {
    /// True if it became worse.
    pub is_worse: bool,
    /// The experiment.
    pub experiment: String,
    /// Description of the change, with the numbers.
    pub what: String,
    /// The command that repeats the experiment.
    pub command: &'a str,
}

impl Difference<'_> {
    /// Returns everything but the command, on one line.
    pub fn line(&self) -> String {
        format!("{}: {}", self.experiment, self.what)
    }
}

/// Maximum length of lists of experiments in words; `record.json` has them whole.
const MAX_LISTED: usize = 8;

/// Returns the experiments that were left out, by the reason.
fn left_out(comparison: &Comparison) -> Vec<(&'static str, &[ChannelId])> {
    let LeftOut { relearned, blunt, unpredicted, uncounted, brief } = &comparison.left_out;
    let all = [
        ("variance not compared, too few draws or too heavy a tail", blunt),
        ("variance not compared, theory has no error of it", unpredicted),
        ("lookups not compared, theory has no error of them", uncounted),
        ("variance and lookups not compared, σ\u{302} learned from other pilot draws", relearned),
        ("time not compared, less than 0.1 s", brief),
        ("not in the baseline", &comparison.added),
        ("only in the baseline", &comparison.missing),
        ("not compared, the case was rewritten", &comparison.rewritten),
    ];
    not_empty(all)
}

/// Returns the lists of experiments that are not empty, each with its reason.
pub(in crate::report) fn not_empty<'a, T>(
    lists: impl IntoIterator<Item = (&'static str, &'a Vec<T>)>,
) -> Vec<(&'static str, &'a [T])> {
    let lists = lists.into_iter().filter(|(_, ids)| !ids.is_empty());
    lists.map(|(why, ids)| (why, &ids[..])).collect()
}

/// Returns the lengths of lists of experiments, each with its reason.
pub(in crate::report) fn counts<T>(lists: &[(&'static str, &[T])]) -> String {
    let counts: Vec<_> = lists.iter().map(|(why, ids)| format!("{why} ({})", ids.len())).collect();
    counts.join("; ")
}

/// Returns the closing sentence: nothing was compared, or nothing changed.
pub(in crate::report) fn ending(nothing: Option<String>, has_changes: bool) -> Option<String> {
    let same = (!has_changes).then(|| "no change in what was compared".to_owned());
    nothing.or(same)
}

/// Returns a list of experiments, cut if it is long.
pub(in crate::report) fn listed(why: &str, ids: &[impl Display]) -> String {
    let shown: Vec<String> = ids.iter().take(MAX_LISTED).map(ToString::to_string).collect();
    let shown = shown.join(", ");
    let more = match ids.len().saturating_sub(MAX_LISTED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("{why} ({}): {shown}{more}", ids.len())
}

/// Returns the reason why nothing was compared; `None` if something was.
pub fn nothing(comparison: &Comparison) -> Option<String> {
    comparison.is_empty().then(|| {
        let counts = counts(&left_out(comparison));
        let why = if counts.is_empty() { "no experiments on either side" } else { &counts };
        format!("nothing was compared: {why}")
    })
}

/// Returns the reason why no time was compared; `None` if one was.
pub fn no_times(comparison: &Comparison) -> Option<String> {
    let is_about_all = |why: &str| !why.starts_with("variance") && !why.starts_with("lookups");
    (comparison.times == 0).then(|| {
        let mut lists = left_out(comparison);
        lists.retain(|(why, _)| is_about_all(why));
        format!("no time was compared: {}", counts(&lists))
    })
}

/// Returns the extent of the comparison, its conditions, and the experiments that were left out.
pub fn remarks(comparison: &Comparison) -> Vec<String> {
    let Comparison { name, rules, compared, times, .. } = comparison;
    let alpha = short(rules.alpha, 3);
    let times = match rules.time_tolerance {
        Some(tolerance) => format!("{times} times at a tolerance of {}", short(tolerance, 3)),
        None => "no times, as any is tolerated".to_owned(),
    };
    let mut remarks = vec![format!(
        "baseline {name}: {compared} variances and lookups compared at α = {alpha}, {times}"
    )];
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
    remarks.extend(left_out(comparison).into_iter().map(|(why, ids)| listed(why, ids)));
    let has_changes = !(comparison.changes.is_empty() && comparison.drifts.is_empty());
    remarks.extend(ending(nothing(comparison), has_changes));
    remarks
}

/// Returns all changes, regressions first.
pub fn all(comparison: &Comparison) -> Vec<Difference<'_>> {
    let mut told: Vec<Difference> = comparison.drifts.iter().map(drift).collect();
    let tolerance = comparison.rules.time_tolerance;
    told.extend(comparison.changes.iter().map(|one| change(one, tolerance)));
    told.sort_by_key(|told| !told.is_worse);
    told
}

fn drift(drift: &Drift) -> Difference<'_> {
    let Drift { id, check, ln_e, limit, command } = drift;
    let what = format!("{check}: ln E = {ln_e:.1} ≥ {limit:.1} of all runs together");
    Difference { is_worse: true, experiment: id.to_string(), what, command }
}

/// Returns a quantity in words.
pub fn name(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Variance => "variance",
        Quantity::Lookups => "lookups per draw",
        Quantity::Time => "processor time per draw",
    }
}

/// Returns the values before and now, with their errors.
pub fn values(change: &Change) -> [String; 2] {
    let unit = if change.quantity == Quantity::Time { " ns" } else { "" };
    [change.before, change.now].map(|Measured { value, error }| {
        let error = error.map_or(String::new(), |error| format!(" ± {}", short(error, 2)));
        format!("{}{error}{unit}", fixed(value, 5))
    })
}

fn change(change: &Change, tolerance: Option<f64>) -> Difference<'_> {
    let what = name(change.quantity);
    let interval = if let Some([low, high]) = change.interval {
        format!("in [{}, {}]", fixed(low, 4), fixed(high, 4))
    } else {
        let tolerance = tolerance.map_or("∞".to_owned(), |tolerance| short(tolerance, 3));
        format!("beyond the tolerance of {tolerance}, its error unknown")
    };
    let [before, now] = values(change);
    let ratio = fixed(change.ratio, 4);
    Difference {
        is_worse: change.is_regression,
        experiment: change.id.to_string(),
        what: format!("{what} {before} → {now}, ratio {ratio} {interval}"),
        command: &change.command,
    }
}
