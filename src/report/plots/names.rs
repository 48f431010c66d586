//! Names of series in legends: no two of a plot are alike.

use std::ops::RangeInclusive;

use crate::record::Digits;
use crate::report::plots::series::Group;
use numeric::digits::count;

/// Labels of the series, no two alike: the estimator, its control, its σ̂ where others of its name have another, and
/// the channel.
pub(super) fn labels(groups: &[Group], digits: Digits) -> Vec<String> {
    let estimator = |group: &Group| match (group.rows.first(), group.curve) {
        (Some(row), _) => row.experiment.label.clone(),
        (None, Some(curve)) => curve.estimator.clone(),
        (None, None) => String::new(),
    };
    let names: Vec<[String; 2]> =
        groups.iter().map(|group| [estimator(group), sampling(group, digits)]).collect();
    let mut labels: Vec<String> = Vec::new();
    for (group, [estimator, sampling]) in groups.iter().zip(&names) {
        let is_shared = names.iter().any(|other| other[0] == *estimator && other[1] != *sampling);
        let sampling = if is_shared { sampling.clone() } else { String::new() };
        let parts = [estimator.clone(), control(group), sampling, group.channel.to_owned()];
        let label = parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>();
        labels.push(label.join(", "));
    }
    numbered(labels)
}

/// Texts with numbers behind those that have come before.
pub fn numbered(texts: Vec<String>) -> Vec<String> {
    let mut numbered: Vec<String> = Vec::with_capacity(texts.len());
    for text in texts {
        let mut names = std::iter::once(text.clone()).chain((2..).map(|n| format!("{text} #{n}")));
        let name = names.find(|name| !numbered.contains(name));
        numbered.push(name.unwrap_or(text));
    }
    numbered
}

/// The control, where all rows have the same.
fn control(group: &Group) -> String {
    let first = group.rows.first().map(|row| &row.experiment.id.control);
    let first = first.or(group.curve.map(|curve| &curve.control));
    let same =
        first.filter(|first| group.rows.iter().all(|row| row.experiment.id.control == **first));
    same.cloned().unwrap_or_default()
}

/// σ̂ in words; empty where it is what is swept.
fn sampling(group: &Group, digits: Digits) -> String {
    let drawn = || group.rows.iter().filter(|row| !row.experiment.id.sampling.kind.is_empty());
    if drawn().any(|row| {
        row.experiment.swept().is_some() && row.experiment.swept() == row.experiment.sampling()
    }) {
        return String::new();
    }
    let Some(first) = drawn().next() else { return String::new() };
    let ends = drawn().filter_map(|row| row.experiment.sampling()).fold(None, |ends, value| {
        let [low, high] = ends.unwrap_or([value; 2]);
        Some([f64::min(low, value), f64::max(high, value)])
    });
    match ends {
        Some([low, high]) if low < high => {
            format!("σ\u{302} {} to {}", digits.text(low), digits.text(high))
        }
        Some([value, _]) => format!("σ\u{302} {}", digits.text(value)),
        None => first.experiment.id.sampling.kind.clone(),
    }
}

/// Remarks behind a label, in parentheses: knowledge that the estimator needs, its number of setup lookups, and whether it is
/// outside of the sweep.
pub fn marks(needs: &str, setup: Option<RangeInclusive<u64>>, is_fixed: bool) -> String {
    let mut marks = Vec::new();
    if !needs.is_empty() {
        marks.push(format!("needs {}", needs.replace("_t", "ₜ")));
    }
    if let Some((least, most)) = setup.map(RangeInclusive::into_inner).filter(|ends| ends.1 > 0) {
        let from = if least < most { format!("{} to ", count(least)) } else { String::new() };
        marks.push(format!("{from}{} setup lookups", count(most)));
    }
    if is_fixed {
        marks.push("not swept".to_owned());
    }
    if marks.is_empty() { String::new() } else { format!(" ({})", marks.join("; ")) }
}
