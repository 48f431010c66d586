//! Series of a sweep: the rows and the curve that belong together.

use crate::record::{
    CaseRecord, Compared, CurvePoint, Digits, PredictedCurve, Row, Sweep, Verdict,
};
use crate::report::lists::joined;
use crate::report::plots::legend::LegendEntry;
use crate::report::plots::style::Style;
use estimators::Knowledge;
use numeric::digits::count;
use std::ops::RangeInclusive;

/// Estimator of the case along the sweep, one channel of its value.
pub struct Series<'a> {
    /// Estimator, with control, σ̂ and channel where needed: no two series of a plot have the same label.
    pub label: String,
    /// Style.
    pub style: Style,
    /// Rows.
    pub rows: Vec<Row<'a>>,
    /// Predicted curve, if there is one.
    pub curve: Option<&'a PredictedCurve>,
}

impl Series<'_> {
    /// Returns whether it is drawn once, outside of the sweep.
    pub fn is_fixed(&self) -> bool {
        is_fixed(&self.rows, self.curve)
    }

    /// Returns the predicted line, through the curve's points, or through the rows' own predictions without a curve.
    pub fn theory(
        &self,
        of_point: fn(&CurvePoint) -> f64,
        of_row: fn(&Row) -> Compared,
    ) -> Vec<(f64, f64)> {
        match self.curve.filter(|curve| !curve.points.is_empty()) {
            Some(curve) => curve.points.iter().map(|point| (point.x, of_point(point))).collect(),
            None => self
                .rows
                .iter()
                .filter_map(|row| Some((row.experiment.swept()?, of_row(row).theory?)))
                .collect(),
        }
    }

    /// Returns the range of the setup lookups of its rows; `None` if all are 0 or unknown.
    pub fn setup_lookups(&self) -> Option<RangeInclusive<u64>> {
        let counts = || self.rows.iter().filter_map(|row| row.experiment.setup_lookups);
        let maximum = counts().max().filter(|&maximum| maximum > 0)?;
        Some(counts().min().unwrap_or(maximum)..=maximum)
    }

    /// Returns the entry of the legend: the label, and what the estimator needs.
    pub fn entry(&self) -> LegendEntry {
        let Style { colour, dash, marker } = self.style;
        let measured = self.rows.iter().any(|row| row.experiment.draws.is_some());
        let mut needs = self.rows.iter().map(|row| &row.experiment.needs);
        let needs = needs.find(|needs| !needs.is_empty());
        let needs = needs.map_or_else(String::new, |needs| Knowledge::list(needs));
        let marks = marks(&needs, self.setup_lookups(), self.is_fixed());
        LegendEntry {
            label: format!("{}{marks}", self.label),
            line: Some((dash, 2.0)),
            marker: measured.then_some(marker),
            colour,
        }
    }
}

/// Returns notes on refusals and on variances of 0, which plots cannot show.
pub fn notes(series: &[Series]) -> Vec<String> {
    let list = |head: &str, of: &dyn Fn(&Series) -> Option<String>| {
        let said = joined(series.iter().filter_map(of), "; ");
        (!said.is_empty()).then(|| format!("{head}: {said}"))
    };
    let refused = |one: &Series| {
        let refused = one.rows.iter().filter(|row| row.verdict == Some(Verdict::Refused)).count();
        (refused > 0).then(|| format!("{} at {refused} of {}", one.label, one.rows.len()))
    };
    let exact = |row: &Row| row.variance.or(row.predicted_variance) == Some(0.0);
    let exact = |one: &Series| one.rows.iter().any(exact).then(|| one.label.clone());
    [list("Refused", &refused), list("Variance 0, which a logarithmic axis cannot show", &exact)]
        .into_iter()
        .flatten()
        .collect()
}

fn is_fixed(rows: &[Row], curve: Option<&PredictedCurve>) -> bool {
    curve.is_none() && rows.iter().all(|row| row.experiment.swept().is_none())
}

/// Rows of one estimator of the case, one channel of its value.
pub(super) struct SeriesGroup<'a> {
    /// Number of the estimator.
    listed: usize,
    pub(super) channel: &'a str,
    pub(super) rows: Vec<Row<'a>>,
    pub(super) curve: Option<&'a PredictedCurve>,
}

/// Number of series above which a plot shows only the last channel of each estimator, as the luminance of chromatic
/// media.
const CROWD: usize = 12;

/// Returns the series of a case, in the order of its rows; a curve without rows is a series, too.
pub fn collect<'a>(case: &'a CaseRecord, sweep: &'a Sweep) -> Vec<Series<'a>> {
    let mut groups: Vec<SeriesGroup> = Vec::new();
    for row in case.rows() {
        group(&mut groups, row.experiment.listed, &row.values.channel).rows.push(row);
    }
    join_refused(&mut groups);
    for curve in &sweep.curves {
        group(&mut groups, curve.listed, &curve.channel).curve.get_or_insert(curve);
    }
    if groups.len() > CROWD {
        keep_last_channels(&mut groups);
    }
    let labels = labels(&groups, Digits::of(case));
    let series = groups.into_iter().zip(labels).enumerate().map(|(i, (group, label))| {
        let SeriesGroup { rows, curve, .. } = group;
        Series { label, style: Style::of(i), rows, curve }
    });
    series.collect()
}

/// Returns the group of an estimator and a channel, which is added if it is new.
fn group<'a, 'b>(
    groups: &'b mut Vec<SeriesGroup<'a>>,
    listed: usize,
    channel: &'a str,
) -> &'b mut SeriesGroup<'a> {
    let finding = groups.iter().position(|g| (g.listed, g.channel) == (listed, channel));
    let at = finding.unwrap_or_else(|| {
        groups.push(SeriesGroup { listed, channel, rows: Vec::new(), curve: None });
        groups.len() - 1
    });
    &mut groups[at]
}

/// Joins a refused experiment, which has no channels, to the first channel of others of its estimator.
fn join_refused(groups: &mut Vec<SeriesGroup>) {
    let mut index = 0;
    while index < groups.len() {
        let SeriesGroup { listed, channel, .. } = groups[index];
        let home = groups.iter().position(|g| g.listed == listed && !g.channel.is_empty());
        match home.filter(|_| channel.is_empty()) {
            Some(home) => {
                let refused = std::mem::take(&mut groups[index].rows);
                groups[home].rows.extend(refused);
                groups.remove(index);
            }
            None => index += 1,
        }
    }
}

/// Keeps the last channel of each estimator, with the experiments that are refused.
fn keep_last_channels(groups: &mut Vec<SeriesGroup>) {
    for index in 0..groups.len() {
        let listed = groups[index].listed;
        let last = groups.iter().rposition(|g| g.listed == listed).unwrap_or(index);
        if last != index {
            let rows = std::mem::take(&mut groups[index].rows);
            groups[last].rows.extend(rows.into_iter().filter(|row| row.channel.is_empty()));
        }
    }
    let listed: Vec<usize> = groups.iter().map(|group| group.listed).collect();
    let mut index = 0..;
    groups.retain(|group| {
        let at = index.next().unwrap_or_default();
        !listed[at + 1..].contains(&group.listed)
    });
}

/// Returns labels of the series, no two alike: the estimator, its control, its σ̂ if others of its name have another,
/// and the channel if there are several.
fn labels(groups: &[SeriesGroup], digits: Digits) -> Vec<String> {
    let estimator = |group: &SeriesGroup| match (group.rows.first(), group.curve) {
        (Some(row), _) => row.experiment.label.clone(),
        (None, Some(curve)) => curve.estimator.clone(),
        (None, None) => String::new(),
    };
    let names: Vec<[String; 2]> =
        groups.iter().map(|group| [estimator(group), sampling(group, digits)]).collect();
    let one = only_channel(groups.iter().map(|group| group.channel)).is_some();
    let mut labels: Vec<String> = Vec::new();
    for (group, [estimator, sampling]) in groups.iter().zip(&names) {
        let is_shared = names.iter().any(|other| other[0] == *estimator && other[1] != *sampling);
        let sampling = if is_shared { sampling.clone() } else { String::new() };
        let channel = if one { String::new() } else { group.channel.to_owned() };
        labels.push(joined([estimator.clone(), control(group), sampling, channel], ", "));
    }
    numbered(labels)
}

/// Returns the one channel of those that have a name.
pub fn only_channel<'a>(channels: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let mut named = channels.filter(|channel| !channel.is_empty());
    let first = named.next()?;
    named.all(|channel| channel == first).then_some(first)
}

/// Returns texts, numbered if an earlier one is equal.
pub fn numbered(texts: Vec<String>) -> Vec<String> {
    let mut numbered: Vec<String> = Vec::with_capacity(texts.len());
    for text in texts {
        let mut names = std::iter::once(text.clone()).chain((2..).map(|n| format!("{text} #{n}")));
        let name = names.find(|name| !numbered.contains(name));
        numbered.push(name.unwrap_or(text));
    }
    numbered
}

/// Returns the control, if all rows have the same.
fn control(group: &SeriesGroup) -> String {
    let first = group.rows.first().map(|row| &row.experiment.id.control);
    let first = first.or(group.curve.map(|curve| &curve.control));
    let same =
        first.filter(|first| group.rows.iter().all(|row| row.experiment.id.control == **first));
    same.cloned().unwrap_or_default()
}

/// Returns σ̂ in words; empty if it is swept.
fn sampling(group: &SeriesGroup, digits: Digits) -> String {
    let drawn = || group.rows.iter().filter(|row| !row.experiment.id.sampling.kind.is_empty());
    if drawn().any(|row| {
        row.experiment.swept().is_some() && row.experiment.swept() == row.experiment.sampling()
    }) {
        return String::new();
    }
    let Some(first) = drawn().next() else { return String::new() };
    let ends = drawn().filter_map(|row| row.experiment.sampling()).map(|value| [value; 2]);
    let ends = ends.reduce(|[low, high], [value, _]| [low.min(value), high.max(value)]);
    match ends {
        Some([low, high]) if low < high => {
            format!("σ\u{302} {} to {}", digits.text(low), digits.text(high))
        }
        Some([value, _]) => format!("σ\u{302} {}", digits.text(value)),
        None => first.experiment.id.sampling.kind.clone(),
    }
}

/// Returns remarks behind a label, in parentheses: knowledge that the estimator needs, its number of setup lookups, and
/// whether it is outside of the sweep.
pub fn marks(needs: &str, setup: Option<RangeInclusive<u64>>, is_fixed: bool) -> String {
    let mut marks = Vec::new();
    if !needs.is_empty() {
        marks.push(format!("needs {}", needs.replace("_t", "ₜ")));
    }
    if let Some((minimum, maximum)) =
        setup.map(RangeInclusive::into_inner).filter(|ends| ends.1 > 0)
    {
        let from =
            if minimum < maximum { format!("{} to ", count(minimum)) } else { String::new() };
        marks.push(format!("{from}{} setup lookups", count(maximum)));
    }
    if is_fixed {
        marks.push("not swept".to_owned());
    }
    if marks.is_empty() { String::new() } else { format!(" ({})", marks.join("; ")) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::id::{Number, SamplingName, SweepPoint};
    use crate::case::sweep::SweptQuantity;
    use crate::plan::ExperimentId;
    use crate::record::{ChannelRecord, ExperimentRecord};

    /// Returns an experiment of one channel; the estimator is listed under the number.
    fn one(listed: usize, estimator: &str, control: &str, swept: Option<f64>) -> ExperimentRecord {
        let value =
            swept.map(|value| SweepPoint { what: SweptQuantity::Sampling, value: Number(value) });
        let id = ExperimentId { control: control.to_owned(), swept: value, ..Default::default() };
        let (label, channels) = (estimator.to_owned(), vec![ChannelRecord::default()]);
        ExperimentRecord { id, label, listed, channels, ..ExperimentRecord::default() }
    }

    /// Returns the experiment with channels of these names.
    fn with_channels(one: ExperimentRecord, names: &[&str]) -> ExperimentRecord {
        let channel =
            |name: &&str| ChannelRecord { channel: (*name).to_owned(), ..ChannelRecord::default() };
        ExperimentRecord { channels: names.iter().map(channel).collect(), ..one }
    }

    fn case(experiments: Vec<ExperimentRecord>) -> CaseRecord {
        CaseRecord { experiments, ..CaseRecord::default() }
    }

    fn sweep() -> Sweep {
        let (what, axis) = (SweptQuantity::Density, String::new());
        Sweep { what, axis, log: false, z_limit: None, curves: vec![] }
    }

    fn labels_of(case: &CaseRecord) -> Vec<(String, usize)> {
        let sweep = sweep();
        let series = collect(case, &sweep).into_iter();
        series.map(|series| (series.label, series.rows.len())).collect()
    }

    fn are(finding: &[(String, usize)], expected: &[(&str, usize)]) {
        let finding: Vec<(&str, usize)> = finding.iter().map(|(label, n)| (&**label, *n)).collect();
        assert_eq!(finding, expected);
    }

    #[test]
    fn of_a_crowd_each_estimator_shows_its_last_channel() {
        let names = ["1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13"];
        let with = |listed, name, count: usize| {
            with_channels(one(listed, name, "", Some(1.0)), &names[..count])
        };
        assert_eq!(labels_of(&case(vec![with(0, "a", 8), with(1, "b", 4)])).len(), 12);
        are(&labels_of(&case(vec![with(0, "a", 8), with(1, "b", 5)])), &[("a, 8", 1), ("b, 5", 1)]);
        // Two experiments of one name are two series, each with its last channel.
        let twins = case(vec![with(0, "a", 8), with(1, "a", 8)]);
        are(&labels_of(&twins), &[("a", 1), ("a #2", 1)]);
        // A refused experiment joins others of its estimator.
        let crowd = case(vec![one(0, "a", "", Some(2.0)), with(0, "a", 13)]);
        are(&labels_of(&crowd), &[("a", 2)]);
    }

    #[test]
    fn twins_are_kept_apart_and_swept_controls_together() {
        let twins = case(vec![
            one(0, "residual", "constant 1", Some(1.0)),
            one(1, "residual", "constant 2", Some(1.0)),
            one(0, "residual", "constant 1", Some(2.0)),
            one(1, "residual", "constant 2", Some(2.0)),
            one(2, "regular", "", None),
        ]);
        let expected = [("residual, constant 1", 2), ("residual, constant 2", 2), ("regular", 1)];
        are(&labels_of(&twins), &expected);
        let walk = with_channels(one(0, "walk", "", Some(2.0)), &["R", "T"]);
        let refused = case(vec![one(0, "walk", "", Some(1.0)), walk]);
        are(&labels_of(&refused), &[("walk, R", 2), ("walk, T", 1)]);
        let swept =
            case(vec![one(0, "r", "constant 1", Some(1.0)), one(0, "r", "constant 2", Some(2.0))]);
        are(&labels_of(&swept), &[("r", 2)]);
    }

    #[test]
    fn each_experiment_is_a_series_and_labels_are_distinct() {
        let at = |one: ExperimentRecord, constant: Option<f64>, kind: &str| {
            let sampling = SamplingName { constant: constant.map(Number), kind: kind.to_owned() };
            let id = ExperimentId { sampling, ..one.id.clone() };
            ExperimentRecord { id, ..one }
        };
        let finding = labels_of(&case(vec![
            // The same name swept in its control, and beside the sweep.
            at(one(0, "decomposition", "constant 0.1", Some(0.1)), Some(0.9), "constant"),
            at(one(0, "decomposition", "constant 0.2", Some(0.2)), Some(0.9), "constant"),
            at(one(1, "decomposition", "minimum", None), Some(0.6), "constant"),
            // Names that differ in σ̂ alone.
            at(one(2, "local-majorant", "", None), None, "local majorants, 10 segments"),
            at(one(3, "local-majorant", "", None), None, "piecewise-constant"),
            // Equal in everything that a label has.
            at(one(4, "ratio", "", None), Some(2.0), "constant"),
            at(one(5, "ratio", "", None), Some(2.0), "constant"),
        ]));
        let expected = [
            ("decomposition, σ\u{302} 0.9", 2),
            ("decomposition, minimum, σ\u{302} 0.6", 1),
            ("local-majorant, local majorants, 10 segments", 1),
            ("local-majorant, piecewise-constant", 1),
            ("ratio", 1),
            ("ratio #2", 1),
        ];
        are(&finding, &expected);
    }

    #[test]
    fn what_an_estimator_needs_stands_in_the_legend() {
        let with =
            |listed, name: &str, needs: Option<Knowledge>, setup: u64, swept: Option<f64>| {
                let (needs, setup_lookups) = (needs.into_iter().collect(), Some(setup));
                ExperimentRecord { needs, setup_lookups, ..one(listed, name, "", swept) }
            };
        let case = case(vec![
            with(0, "a", Some(Knowledge::OpticalDepth), 0, Some(1.0)),
            with(1, "b", Some(Knowledge::Minimum), 0, None),
            with(2, "c", None, 4, Some(1.0)),
            with(2, "c", None, 20, Some(2.0)),
            with(3, "d", None, 0, Some(1.0)),
        ]);
        let labels: Vec<String> =
            collect(&case, &sweep()).iter().map(|series| series.entry().label).collect();
        let expected =
            ["a (needs τ)", "b (needs min σₜ; not swept)", "c (4 to 20 setup lookups)", "d"];
        assert_eq!(labels, expected);
    }
}
