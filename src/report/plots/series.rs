//! The series of a sweep: which rows and which curve belong together.

use std::ops::RangeInclusive;

use crate::record::{CaseRecord, Curve, CurvePoint, Row, Sweep, Verdict};
use crate::report::labels::Labels;
use crate::report::plots::legend::Entry;
use crate::report::plots::names::{labels, marks};
use crate::report::plots::style::Style;

/// One estimator of the case along the sweep, one channel of its value.
pub struct Series<'a> {
    /// The estimator, with control, σ̂ and channel where needed: no two series of a plot have the same label.
    pub label: String,
    /// How it looks.
    pub style: Style,
    /// Its rows.
    pub rows: Vec<&'a Row>,
    /// What theory says, if it says anything.
    pub curve: Option<&'a Curve>,
}

impl Series<'_> {
    /// Whether it is drawn once, outside of the sweep.
    pub fn is_fixed(&self) -> bool {
        is_fixed(&self.rows, self.curve)
    }

    /// Theory's line, through the curve's points, or through the rows' own predictions where there
    /// is no curve.
    pub fn theory(
        &self,
        of_point: fn(&CurvePoint) -> f64,
        of_row: fn(&Row) -> Option<f64>,
    ) -> Vec<(f64, f64)> {
        match self.curve.filter(|curve| !curve.points.is_empty()) {
            Some(curve) => curve.points.iter().map(|point| (point.x, of_point(point))).collect(),
            None => self.rows.iter().filter_map(|row| Some((row.swept?, of_row(row)?))).collect(),
        }
    }

    /// Range of the setup lookups of its rows; `None` if all are 0 or unknown.
    pub fn setup_lookups(&self) -> Option<RangeInclusive<u64>> {
        let counts = || self.rows.iter().filter_map(|row| row.setup_lookups);
        let most = counts().max().filter(|&most| most > 0)?;
        Some(counts().min().unwrap_or(most)..=most)
    }

    /// The entry of the legend: the label, and what the estimator needs.
    pub fn entry(&self) -> Entry {
        let Style { colour, dash, marker } = self.style;
        let measured = self.rows.iter().any(|row| row.draws.is_some());
        let needs = self.rows.iter().map(|row| row.needs.as_str()).find(|needs| !needs.is_empty());
        let marks = marks(needs.unwrap_or_default(), self.setup_lookups(), self.is_fixed());
        Entry {
            label: format!("{}{marks}", self.label),
            line: Some((dash, 2.0)),
            marker: measured.then_some(marker),
            colour,
        }
    }
}

/// Notes on refusals and on variances of 0, which plots cannot show.
pub fn notes(series: &[Series]) -> Vec<String> {
    let list = |head: &str, of: &dyn Fn(&Series) -> Option<String>| {
        let said: Vec<String> = series.iter().filter_map(of).collect();
        (!said.is_empty()).then(|| format!("{head}: {}", said.join("; ")))
    };
    let refused = |one: &Series| {
        let refused = one.rows.iter().filter(|row| row.verdict == Some(Verdict::Refused)).count();
        (refused > 0).then(|| format!("{} at {refused} of {}", one.label, one.rows.len()))
    };
    let exact = |row: &&Row| row.variance.or(row.predicted_variance) == Some(0.0);
    let exact = |one: &Series| one.rows.iter().any(exact).then(|| one.label.clone());
    [list("Refused", &refused), list("Variance 0, which a logarithmic axis cannot show", &exact)]
        .into_iter()
        .flatten()
        .collect()
}

fn is_fixed(rows: &[&Row], curve: Option<&Curve>) -> bool {
    curve.is_none() && rows.iter().all(|row| row.swept.is_none())
}

/// The rows of one estimator of the case, one channel of its value.
pub(super) struct Group<'a> {
    /// The number of the estimator.
    listed: usize,
    pub(super) channel: &'a str,
    pub(super) rows: Vec<&'a Row>,
    pub(super) curve: Option<&'a Curve>,
}

/// Of more series than these a plot shows the last channel of each estimator, as the luminance of chromatic media.
const CROWD: usize = 12;

/// The series of a case, in the order of its rows; a curve without rows is a series, too.
pub fn collect<'a>(case: &'a CaseRecord, sweep: &'a Sweep) -> Vec<Series<'a>> {
    let (of_rows, of_curves) = numbers(case, sweep);
    let mut groups: Vec<Group> = Vec::new();
    for (row, listed) in case.rows.iter().zip(of_rows) {
        group(&mut groups, listed, &row.channel).rows.push(row);
    }
    join_refused(&mut groups);
    for (curve, listed) in sweep.curves.iter().zip(of_curves) {
        group(&mut groups, listed, &curve.channel).curve.get_or_insert(curve);
    }
    if groups.len() > CROWD {
        keep_last_channels(&mut groups);
    }
    let labels = labels(&groups, Labels::of(case));
    let series = groups.into_iter().zip(labels).enumerate().map(|(i, (group, label))| {
        let Group { rows, curve, .. } = group;
        Series { label, style: Style::of(i), rows, curve }
    });
    series.collect()
}

/// The group of an estimator and a channel, which is added if it is new.
fn group<'a, 'b>(
    groups: &'b mut Vec<Group<'a>>,
    listed: usize,
    channel: &'a str,
) -> &'b mut Group<'a> {
    let found = groups.iter().position(|g| (g.listed, g.channel) == (listed, channel));
    let at = found.unwrap_or_else(|| {
        groups.push(Group { listed, channel, rows: Vec::new(), curve: None });
        groups.len() - 1
    });
    &mut groups[at]
}

/// The numbers of the estimators that rows and curves are of. Records from before they were kept have names only: which
/// of the experiments with the same names at the same value of the sweep a row is tells twins apart.
fn numbers(case: &CaseRecord, sweep: &Sweep) -> (Vec<usize>, Vec<usize>) {
    let of_rows: Option<Vec<usize>> = case.rows.iter().map(|row| row.listed).collect();
    let of_curves: Option<Vec<usize>> = sweep.curves.iter().map(|curve| curve.listed).collect();
    if let (Some(of_rows), Some(of_curves)) = (of_rows, of_curves) {
        return (of_rows, of_curves);
    }
    let mut names: Vec<(&str, bool, usize)> = Vec::new();
    let mut numbered = |name| {
        names.iter().position(|other| *other == name).unwrap_or_else(|| {
            names.push(name);
            names.len() - 1
        })
    };
    let rows = case.rows.iter().enumerate().map(|(i, row)| {
        let same = |other: &&Row| {
            (&other.estimator, &other.channel, other.swept)
                == (&row.estimator, &row.channel, row.swept)
        };
        let earlier = case.rows[..i].iter().filter(same).count();
        numbered((row.estimator.as_str(), row.swept.is_some(), earlier))
    });
    let rows: Vec<usize> = rows.collect();
    let curves = sweep.curves.iter().enumerate().map(|(i, curve)| {
        let same = |other: &&Curve| {
            (&other.estimator, &other.channel) == (&curve.estimator, &curve.channel)
        };
        let earlier = sweep.curves[..i].iter().filter(same).count();
        numbered((curve.estimator.as_str(), true, earlier))
    });
    let curves = curves.collect();
    (rows, curves)
}

/// A refused experiment has no channels: where others of its estimator have, it stands with their first.
fn join_refused(groups: &mut Vec<Group>) {
    let mut index = 0;
    while index < groups.len() {
        let Group { listed, channel, .. } = groups[index];
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

/// Leaves the last channel of each estimator, with the experiments that are refused.
fn keep_last_channels(groups: &mut Vec<Group>) {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn row(estimator: &str, control: &str, swept: Option<f64>) -> Row {
        let (estimator, control) = (estimator.to_owned(), control.to_owned());
        Row { estimator, control, swept, ..Row::default() }
    }

    fn case(rows: Vec<Row>) -> CaseRecord {
        let [name, title, problem, medium] = [const { String::new() }; 4];
        CaseRecord { name, title, problem, medium, rows, ..CaseRecord::default() }
    }

    #[test]
    fn of_a_crowd_each_estimator_shows_its_last_channel() {
        let empty = String::new;
        let sweep =
            Sweep { what: empty(), axis: empty(), log: false, z_limit: None, curves: vec![] };
        let channels = |estimator: &str, count: usize| -> Vec<Row> {
            let channel = |i| Row { channel: format!("{i}"), ..row(estimator, "", Some(1.0)) };
            (1..=count).map(channel).collect()
        };
        let labels = |rows: Vec<Row>| -> Vec<String> {
            collect(&case(rows), &sweep).into_iter().map(|one| one.label).collect()
        };
        assert_eq!(labels([channels("a", 8), channels("b", 4)].concat()).len(), 12);
        assert_eq!(labels([channels("a", 8), channels("b", 5)].concat()), ["a, 8", "b, 5"]);
        // Two experiments of one name are two series, of which each shows its last channel.
        let twins = [channels("a", 8), channels("a", 8)].concat();
        assert_eq!(labels(twins), ["a, 8", "a, 8 #2"]);
        // What is refused stands with it.
        let crowd = case([vec![row("a", "", Some(2.0))], channels("a", 13)].concat());
        let series = collect(&crowd, &sweep);
        assert_eq!((series.len(), series[0].label.as_str(), series[0].rows.len()), (1, "a, 13", 2));
    }

    #[test]
    fn twins_are_kept_apart_and_swept_controls_together() {
        let empty = String::new;
        let sweep =
            Sweep { what: empty(), axis: empty(), log: false, z_limit: None, curves: vec![] };
        let twins = case(vec![
            row("residual", "constant 1", Some(1.0)),
            row("residual", "constant 2", Some(1.0)),
            row("residual", "constant 1", Some(2.0)),
            row("residual", "constant 2", Some(2.0)),
            row("regular", "", None),
        ]);
        let labels: Vec<_> = collect(&twins, &sweep).into_iter().map(|s| s.label).collect();
        assert_eq!(labels, ["residual, constant 1", "residual, constant 2", "regular"]);
        let channel = |channel: &str| Row { channel: channel.into(), ..row("walk", "", Some(2.0)) };
        let refused = case(vec![row("walk", "", Some(1.0)), channel("R"), channel("T")]);
        let series = collect(&refused, &sweep);
        let labels: Vec<_> = series.iter().map(|s| (s.label.as_str(), s.rows.len())).collect();
        assert_eq!(labels, [("walk, R", 2), ("walk, T", 1)]);
        let swept =
            case(vec![row("r", "constant 1", Some(1.0)), row("r", "constant 2", Some(2.0))]);
        let series = collect(&swept, &sweep);
        assert_eq!((series.len(), series[0].label.as_str()), (1, "r"));
    }

    #[test]
    fn each_experiment_is_a_series_and_labels_are_distinct() {
        let empty = String::new;
        let sweep =
            Sweep { what: empty(), axis: empty(), log: false, z_limit: None, curves: vec![] };
        let at = |listed: usize, row: Row, sampling: Option<f64>, kind: &str| Row {
            listed: Some(listed),
            sampling,
            sampling_kind: kind.to_owned(),
            ..row
        };
        let rows = vec![
            // The same name swept in its control, and beside the sweep.
            at(0, row("decomposition", "constant 0.1", Some(0.1)), Some(0.9), "constant"),
            at(0, row("decomposition", "constant 0.2", Some(0.2)), Some(0.9), "constant"),
            at(1, row("decomposition", "minimum", None), Some(0.6), "constant"),
            // Names that differ in σ̂ alone.
            at(2, row("local-majorant", "", None), None, "local majorants, 10 segments"),
            at(3, row("local-majorant", "", None), None, "piecewise-constant"),
            // Twins in everything that a row tells.
            at(4, row("ratio", "", None), Some(2.0), "constant"),
            at(5, row("ratio", "", None), Some(2.0), "constant"),
        ];
        let case = case(rows);
        let series = collect(&case, &sweep);
        let labels: Vec<_> = series.iter().map(|s| (s.label.as_str(), s.rows.len())).collect();
        let expected = [
            ("decomposition, σ\u{302} 0.9", 2),
            ("decomposition, minimum, σ\u{302} 0.6", 1),
            ("local-majorant, local majorants, 10 segments", 1),
            ("local-majorant, piecewise-constant", 1),
            ("ratio", 1),
            ("ratio #2", 1),
        ];
        assert_eq!(labels, expected);
        // A record from before there were numbers: the swept and the other are told apart all the same.
        let mut old = case.clone();
        old.rows.iter_mut().for_each(|row| row.listed = None);
        assert_eq!(collect(&old, &sweep).len(), 6);
    }

    #[test]
    fn what_an_estimator_needs_stands_in_the_legend() {
        let empty = String::new;
        let sweep =
            Sweep { what: empty(), axis: empty(), log: false, z_limit: None, curves: vec![] };
        let with = |estimator: &str, needs: &str, setup: u64, swept: Option<f64>| Row {
            needs: needs.to_owned(),
            setup_lookups: Some(setup),
            ..row(estimator, "", swept)
        };
        let case = case(vec![
            with("a", "τ", 0, Some(1.0)),
            with("b", "min σ_t", 0, None),
            with("c", "", 4, Some(1.0)),
            with("c", "", 20, Some(2.0)),
            with("d", "", 0, Some(1.0)),
        ]);
        let labels: Vec<String> =
            collect(&case, &sweep).iter().map(|series| series.entry().label).collect();
        let expected =
            ["a (needs τ)", "b (needs min σₜ; not swept)", "c (4 to 20 setup lookups)", "d"];
        assert_eq!(labels, expected);
    }
}
