//! The series of a sweep: which rows and which curve belong together.

use crate::harness::record::{CaseRecord, Curve, CurvePoint, Row, Sweep, Verdict};
use crate::report::plots::legend::Entry;
use crate::report::plots::style::Style;

/// One estimator along the sweep, one channel of its value.
pub struct Series<'a> {
    /// The estimator, and what tells it from its neighbours.
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
        self.curve.is_none() && self.rows.iter().all(|row| row.swept.is_none())
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

    /// The entry of the legend.
    pub fn entry(&self) -> Entry {
        let Style { colour, dash, marker } = self.style;
        let once = if self.is_fixed() { " (not swept)" } else { "" };
        let measured = self.rows.iter().any(|row| row.draws.is_some());
        Entry {
            label: format!("{}{once}", self.label),
            line: Some((dash, 2.0)),
            marker: measured.then_some(marker),
            colour,
        }
    }

    /// What the plots cannot show of it, in words.
    pub fn note(&self) -> Option<String> {
        let count = |test: fn(&Row) -> bool| self.rows.iter().filter(|row| test(row)).count();
        let refused = count(|row| row.verdict == Some(Verdict::Refused));
        let exact = count(|row| row.variance.or(row.predicted_variance) == Some(0.0));
        let all = self.rows.len();
        let mut notes = Vec::new();
        if refused > 0 {
            notes.push(format!("refused at {refused} of {all}"));
        }
        if exact > 0 {
            notes.push("variance 0, which a logarithmic axis cannot show".to_owned());
        }
        (!notes.is_empty()).then(|| format!("{}: {}", self.label, notes.join("; ")))
    }
}

/// What tells the series of one case apart: the estimator, the channel, and which of the
/// experiments with the same two at the same value of the sweep it is. The control does not, for it
/// may be what is swept.
type Key<'a> = (&'a str, &'a str, usize);

/// Of more series than these a plot shows the last channel of each estimator, as the luminance of chromatic media.
const CROWD: usize = 12;

/// The series of a case, in the order of its rows; a curve without rows is a series, too.
pub fn collect<'a>(case: &'a CaseRecord, sweep: &'a Sweep) -> Vec<Series<'a>> {
    let mut groups: Vec<(Key, Vec<&Row>)> = Vec::new();
    for row in &case.rows {
        let same = |other: &&&Row| {
            other.estimator == row.estimator
                && other.channel == row.channel
                && other.swept == row.swept
        };
        let earlier = groups.iter().flat_map(|(_, rows)| rows).filter(same).count();
        let key = (row.estimator.as_str(), row.channel.as_str(), earlier);
        match groups.iter_mut().find(|(other, _)| *other == key) {
            Some((_, rows)) => rows.push(row),
            None => groups.push((key, vec![row])),
        }
    }
    join_refused(&mut groups);
    let curves = |estimator: &str, channel: &str| -> Vec<&Curve> {
        let same = |curve: &&Curve| curve.estimator == estimator && curve.channel == channel;
        sweep.curves.iter().filter(same).collect()
    };
    for curve in &sweep.curves {
        let (estimator, channel) = (curve.estimator.as_str(), curve.channel.as_str());
        let twin = curves(estimator, channel).iter().position(|c| std::ptr::eq(*c, curve));
        let nth = twin.unwrap_or(0);
        if !groups.iter().any(|(key, _)| *key == (estimator, channel, nth)) {
            groups.push(((estimator, channel, nth), Vec::new()));
        }
    }
    if groups.len() > CROWD {
        keep_last_channels(&mut groups);
    }
    let series = groups.into_iter().enumerate().map(|(i, ((estimator, channel, nth), rows))| {
        let curve = curves(estimator, channel).get(nth).copied();
        let label = label(estimator, channel, &rows, curve);
        Series { label, style: Style::of(i), rows, curve }
    });
    series.collect()
}

/// A refused experiment has no channels: where others of its estimator have, it stands with their first.
fn join_refused<'a>(groups: &mut Vec<(Key<'a>, Vec<&'a Row>)>) {
    let mut index = 0;
    while index < groups.len() {
        let (estimator, channel, nth) = groups[index].0;
        let home = groups.iter().position(|((other, named, n), _)| {
            *other == estimator && !named.is_empty() && *n == nth
        });
        match home.filter(|_| channel.is_empty()) {
            Some(home) => {
                let refused = std::mem::take(&mut groups[index].1);
                groups[home].1.extend(refused);
                groups.remove(index);
            }
            None => index += 1,
        }
    }
}

/// Leaves the last channel of each estimator, with the experiments that are refused.
fn keep_last_channels<'a>(groups: &mut Vec<(Key<'a>, Vec<&'a Row>)>) {
    let keys: Vec<Key> = groups.iter().map(|(key, _)| *key).collect();
    let last = |key: &Key| keys.iter().rposition(|other| (other.0, other.2) == (key.0, key.2));
    for index in 0..keys.len() {
        if let Some(last) = last(&keys[index]).filter(|&last| last != index) {
            let rows = std::mem::take(&mut groups[index].1);
            groups[last].1.extend(rows.into_iter().filter(|row| row.channel.is_empty()));
        }
    }
    groups.retain(|(key, _)| last(key).is_some_and(|last| keys[last] == *key));
}

fn label(estimator: &str, channel: &str, rows: &[&Row], curve: Option<&Curve>) -> String {
    let first = rows.first().map(|row| row.control.as_str());
    let constant = rows.iter().all(|row| Some(row.control.as_str()) == first);
    let control = if constant { first.or(curve.map(|c| c.control.as_str())) } else { None };
    let parts = [estimator, control.unwrap_or_default(), channel];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
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
        assert_eq!(labels(twins), ["a, 8", "a, 8"]);
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
}
