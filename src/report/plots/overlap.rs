//! Lines that lie on each other: classes of them, and styles that keep all of them visible.
//!
//! Equal lines are drawn as one striped line: each has every n-th stripe. A line that coincides with a part of a longer
//! one is drawn over it with gaps.

use crate::report::lists::{grouped, joined};

/// Length of a stripe, in pixels.
const STRIPE: f64 = 9.0;
/// Relative difference below which values are equal: the same formulas differ by rounding.
const SAME: f64 = 1e-9;

/// Line of a panel.
#[derive(Debug, Clone, PartialEq)]
pub enum PlotLine {
    /// Line through points, ascending in x.
    Points(Vec<(f64, f64)>),
    /// Constant.
    Level(f64),
    /// No line.
    None,
}

impl PlotLine {
    /// Returns whether all of this line lies on another.
    fn lies_on(&self, other: &Self) -> bool {
        let same = |a: f64, b: f64| a == b || (a - b).abs() <= SAME * a.abs().max(b.abs());
        match (self, other) {
            (Self::Points(own), Self::Points(points)) => own.iter().all(|&(x, y)| {
                points.iter().any(|&(other_x, other_y)| x == other_x && same(y, other_y))
            }),
            (Self::Points(own), Self::Level(level)) => own.iter().all(|&(_, y)| same(y, *level)),
            (Self::Level(own), Self::Level(level)) => same(*own, *level),
            _ => false,
        }
    }

    /// Returns the number of points; levels are longest.
    fn length(&self) -> usize {
        match self {
            Self::Points(points) => points.len(),
            Self::Level(_) => usize::MAX,
            Self::None => 0,
        }
    }
}

/// Class of equal lines, by their numbers, and the longer lines that they lie on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Class {
    /// Lines, ascending.
    pub members: Vec<usize>,
    /// First line of each class of longer lines below.
    pub hosts: Vec<usize>,
}

/// Returns the classes of equal lines, in the order of drawing: longer ones first, and among equally long ones solid
/// ones first, so that dashes stay visible where two lines coincide. `dashes` are those of the lines.
pub fn classes(lines: &[PlotLine], dashes: &[&[f64]]) -> Vec<Class> {
    let on = |a: usize, b: usize| lines[a].lies_on(&lines[b]);
    let drawn = (0..lines.len()).filter(|&index| lines[index].length() > 0);
    let members = grouped(drawn, |&first, &index| on(index, first) && on(first, index));
    let mut classes: Vec<Class> = members
        .iter()
        .map(|class| {
            let others = members.iter().map(|other| other[0]);
            let hosts = others.filter(|&other| other != class[0] && on(class[0], other)).collect();
            Class { members: class.clone(), hosts }
        })
        .collect();
    let gaps =
        |class: &Class| if class.members.len() > 1 { 0.0 } else { gaps(dashes[class.members[0]]) };
    classes.sort_by(|a, b| {
        let [long, other] = [a, b].map(|class| lines[class.members[0]].length());
        other.cmp(&long).then(gaps(a).total_cmp(&gaps(b)))
    });
    classes
}

/// Returns the share of a dashed line that is gaps.
fn gaps(dash: &[f64]) -> f64 {
    let gaps: f64 = dash.iter().skip(1).step_by(2).sum();
    if gaps > 0.0 { gaps / dash.iter().sum::<f64>() } else { 0.0 }
}

impl Class {
    /// Returns the dashes of a member: stripes if the class has several members, else its own.
    pub fn dash(&self, member: usize, own: &[f64]) -> Vec<f64> {
        let slots = self.members.len() + usize::from(!self.hosts.is_empty());
        let is_gap_enough = self.members.len() == 1 && !own.is_empty();
        if slots == 1 || is_gap_enough {
            return own.to_vec();
        }
        let before = self.members.iter().position(|&other| other == member).unwrap_or(0);
        let after = slots - 1 - before;
        let [before, after] = [before, after].map(|count| count as f64 * STRIPE);
        if before > 0.0 { vec![0.0, before, STRIPE, after] } else { vec![STRIPE, after] }
    }
}

/// Returns notes on lines that lie on each other, from the classes of each panel with its letter and the names of the
/// lines.
pub fn notes(panels: &[(char, Vec<Class>)], names: &[&str]) -> Vec<String> {
    let names_of = |list: &[usize], by: &str| joined(list.iter().map(|&index| names[index]), by);
    let equal = |class: &Class| (class.members.len() > 1).then(|| names_of(&class.members, " = "));
    let upon = |Class { members, hosts }: &Class| {
        let names = || format!("{} on {}", names[members[0]], names_of(hosts, ", "));
        (!hosts.is_empty()).then(names)
    };
    let note = |head: &str, words: &dyn Fn(&Class) -> Option<String>| {
        let said = panels.iter().flat_map(|(panel, classes)| {
            classes.iter().filter_map(|class| Some((panel.to_string(), words(class)?)))
        });
        let lines = grouped(said, |one, other| one.1 == other.1).into_iter().map(|alike| {
            format!("({}) {}", joined(alike.iter().map(|one| &one.0), ", "), alike[0].1)
        });
        let lines = joined(lines, "; ");
        (!lines.is_empty()).then(|| format!("{head}: {lines}"))
    };
    let notes = [
        note("Equal in theory, one striped line", &equal),
        note("Equal in theory where both are drawn, one line on the other", &upon),
    ];
    notes.into_iter().flatten().collect()
}

/// Places points side by side that would hide each other. Returns for each point in turn a shift to the right, at most
/// `maximum` in size; points closer than `apart` both ways hide each other.
pub fn side_by_side(points: &[[f64; 2]], apart: f64, maximum: f64) -> Vec<f64> {
    let mut placed: Vec<[f64; 2]> = Vec::with_capacity(points.len());
    let shifts = points.iter().map(|&[x, y]| {
        let is_free = |shift: &f64| {
            !placed
                .iter()
                .any(|other| (other[0] - x - shift).abs() < apart && (other[1] - y).abs() < apart)
        };
        let steps = (1..).map(|n| f64::from(n) * apart).take_while(|step| *step <= maximum);
        let mut shifts = std::iter::once(0.0).chain(steps.flat_map(|step| [step, -step]));
        let shift = shifts.find(is_free).unwrap_or(0.0);
        placed.push([x + shift, y]);
        shift
    });
    shifts.collect()
}

/// Returns the smallest distance between two of the places that are not above each other; infinite without such places.
pub fn smallest_step(places: impl Iterator<Item = f64>) -> f64 {
    let mut places: Vec<f64> = places.collect();
    places.sort_by(f64::total_cmp);
    let steps = places.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.5);
    steps.fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn through(points: &[(f64, f64)]) -> PlotLine {
        PlotLine::Points(points.to_vec())
    }

    #[test]
    fn equal_lines_are_striped_and_stretches_lie_on_longer_lines() {
        let lines = [
            through(&[(1.0, 2.0), (2.0, 3.0), (3.0, 4.0)]),
            through(&[(2.0, 3.0), (3.0, 4.0 * (1.0 + 1e-12))]),
            through(&[(1.0, 2.0), (2.0, 3.0), (3.0, 4.0)]),
            through(&[(1.0, 2.0), (2.0, 3.0), (3.0, 4.1)]),
            PlotLine::Level(5.0),
            PlotLine::None,
            PlotLine::Level(5.0),
            through(&[(1.0, 5.0), (2.0, 5.0)]),
        ];
        let solid: [&[f64]; 8] = [&[]; 8];
        let classes = classes(&lines, &solid);
        let class = |members: &[usize], hosts: &[usize]| Class {
            members: members.to_vec(),
            hosts: hosts.to_vec(),
        };
        let expected = [
            class(&[4, 6], &[]),
            class(&[0, 2], &[]),
            class(&[3], &[]),
            class(&[1], &[0]),
            class(&[7], &[4]),
        ];
        assert_eq!(classes, expected);
        assert_eq!(classes[0].dash(4, &[]), [9.0, 9.0]);
        assert_eq!(classes[0].dash(6, &[2.0, 3.0]), [0.0, 9.0, 9.0, 0.0]);
        assert_eq!(classes[2].dash(3, &[2.0, 3.0]), [2.0, 3.0]);
        // A solid line would hide the line below it, a dashed one does not.
        assert_eq!(classes[3].dash(1, &[]), [9.0, 9.0]);
        assert_eq!(classes[3].dash(1, &[2.0, 3.0]), [2.0, 3.0]);
        let notes = notes(
            &[('a', classes.clone()), ('b', classes)],
            &["A", "B", "C", "D", "E", "", "G", "H"],
        );
        let expected = [
            "Equal in theory, one striped line: (a, b) E = G; (a, b) A = C",
            "Equal in theory where both are drawn, one line on the other: (a, b) B on A; (a, b) H on E",
        ];
        assert_eq!(notes, expected);
    }

    #[test]
    fn dashes_are_drawn_over_solid_lines_of_their_length() {
        let lines = [through(&[(1.0, 2.0), (2.0, 3.0)]), through(&[(1.0, 2.0), (2.0, 5.0)])];
        let order = |dashes: [&[f64]; 2]| -> Vec<usize> {
            classes(&lines, &dashes).iter().map(|class| class.members[0]).collect()
        };
        assert_eq!(order([&[9.0, 4.0], &[]]), [1, 0]);
        assert_eq!(order([&[], &[9.0, 4.0]]), [0, 1]);
    }

    #[test]
    fn points_that_would_hide_each_other_stand_apart() {
        let points = [[50.0, 10.0], [50.0, 12.0], [50.0, 40.0], [50.0, 10.0], [90.0, 10.0]];
        assert_eq!(side_by_side(&points, 8.0, 20.0), [0.0, 8.0, 0.0, -8.0, 0.0]);
        // Without room they are not moved.
        assert_eq!(side_by_side(&points, 8.0, 4.0), [0.0; 5]);
    }
}
