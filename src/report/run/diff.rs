//! Changes since a stored run, in words that the console and the summaries share.

use crate::record::baseline::LeftOut;
use crate::record::baseline::{
    Change, ChannelId, ComparedQuantity, Comparison, Drift, MeasuredValue, Sequel,
};
use crate::report::changes::{Changes, Difference, closing, counts, not_empty};
use crate::report::html::words::evidence;
use numeric::digits::{fixed, short};

/// Returns the table of changes with its remarks.
pub fn changes(comparison: &Comparison) -> Changes {
    let remarks = remarks(comparison);
    Changes { name: comparison.name.clone(), all: all(comparison), remarks }
}

/// Returns the experiments that were left out, by the reason.
fn left_out(comparison: &Comparison) -> Vec<(&'static str, &[ChannelId])> {
    let LeftOut { relearned, blunt, unpredicted, uncounted, .. } = &comparison.left_out;
    let all = [
        ("variance not compared, too few draws or too heavy a tail", blunt),
        ("variance not compared, theory has no error of it", unpredicted),
        ("lookups not compared, theory has no error of them", uncounted),
        ("variance and lookups not compared, σ\u{302} learned from other pilot draws", relearned),
    ];
    not_empty(all.into_iter().chain(without_times(comparison)))
}

/// Returns the experiments of which no time was compared, by the reason.
fn without_times(comparison: &Comparison) -> [(&'static str, &Vec<ChannelId>); 4] {
    [
        ("time not compared, less than 0.1 s", &comparison.left_out.brief),
        ("not in the baseline", &comparison.added),
        ("only in the baseline", &comparison.missing),
        ("not compared, the case was rewritten", &comparison.rewritten),
    ]
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
    (comparison.times == 0)
        .then(|| format!("no time was compared: {}", counts(&not_empty(without_times(comparison)))))
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
    let has_changes = !(comparison.changes.is_empty() && comparison.drifts.is_empty());
    remarks.extend(closing(&left_out(comparison), nothing(comparison), has_changes));
    remarks
}

/// Returns all changes, regressions first.
pub fn all(comparison: &Comparison) -> Vec<Difference> {
    let mut all: Vec<Difference> = comparison.drifts.iter().map(drift).collect();
    let tolerance = comparison.rules.time_tolerance;
    all.extend(comparison.changes.iter().map(|one| change(one, tolerance)));
    all.sort_by_key(|change| !change.is_worse);
    all
}

fn drift(Drift { id, check, what, ln_e, limit, command }: &Drift) -> Difference {
    let shown = format!("ln E = {} ≥ {}", evidence(*ln_e), short(*limit, 3));
    Difference {
        is_worse: true,
        experiment: id.to_string(),
        quantity: format!("{check}: {what}"),
        values: [None, Some((*ln_e, shown))],
        ratio: None,
        interval: None,
        extent: format!("ln E = {ln_e:.1} ≥ {limit:.1} of all runs together"),
        command: command.clone(),
    }
}

fn change(change: &Change, tolerance: Option<f64>) -> Difference {
    let (quantity, unit) = match change.quantity {
        ComparedQuantity::Variance => ("variance", ""),
        ComparedQuantity::Lookups => ("lookups per draw", ""),
        ComparedQuantity::Time => ("processor time per draw", " ns"),
    };
    let extent = if let Some([low, high]) = change.interval {
        format!("in [{}, {}]", fixed(low, 4), fixed(high, 4))
    } else {
        let tolerance = tolerance.map_or("∞".to_owned(), |tolerance| short(tolerance, 3));
        format!("beyond the tolerance of {tolerance}, its error unknown")
    };
    let value = |MeasuredValue { value, error }: MeasuredValue| {
        let error = error.map_or(String::new(), |error| format!(" ± {}", short(error, 2)));
        Some((value, format!("{}{error}{unit}", fixed(value, 5))))
    };
    Difference {
        is_worse: change.is_regression,
        experiment: change.id.to_string(),
        quantity: quantity.to_owned(),
        values: [change.before, change.now].map(value),
        ratio: Some(change.ratio),
        interval: change.interval,
        extent: format!("ratio {} {extent}", fixed(change.ratio, 4)),
        command: change.command.clone(),
    }
}
