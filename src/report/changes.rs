//! Changes since a stored run or bench: their table `changes.csv`, and their part of consoles and pages.

use std::fmt::{Display, Write};

use crate::report::html::template::{Markup, html};

use crate::report::fields::{self, Shown, Table, shown, table};
use crate::report::html as page;
use crate::report::html::words::UNKNOWN;
use crate::report::layout::{Paint, Pen};
use crate::report::lists::{joined, left_out};
use crate::report::{Artifact, ReportError};
use numeric::digits::fixed;

/// Changes since a stored run or bench.
pub struct Changes {
    /// Name of what was stored.
    pub name: String,
    /// All changes, those for the worse first.
    pub all: Vec<Difference>,
    /// Extent of the comparison, its conditions, and the experiments that were left out.
    pub remarks: Vec<String>,
}

/// Change of a quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// True if it became worse.
    pub is_worse: bool,
    /// Experiment.
    pub experiment: String,
    /// Quantity; for evidence that grew over several runs the check.
    pub quantity: String,
    /// Values before and now, with their errors and units in words; the first is missing for evidence.
    pub values: [Option<(f64, String)>; 2],
    /// Value now over that before.
    pub ratio: Option<f64>,
    /// Interval of the true ratio.
    pub interval: Option<[f64; 2]>,
    /// Size of the change, in words.
    pub extent: String,
    /// Command that repeats the experiment; empty for none.
    pub command: String,
}

table! {
    impl for Difference {
        "change": "worse or better" = |one| one.word();
        "experiment": "Identity of the experiment" = |one| &one.experiment;
        "quantity": "Variance, lookups or time of a draw; or the check whose evidence grew over several runs" = |one| &one.quantity;
        "before": "Stored value; of times in ns" = |one| one.value(0).map(|value| value.0);
        "now": "Value now, or ln E of all runs together" = |one| one.value(1).map(|value| value.0);
        "ratio": "Value now over that before" = |one| one.ratio;
        "ratio_low": "Lower end of the interval of the true ratio; empty for times" = |one| one.interval.map(|ends| ends[0]);
        "ratio_high": "Upper end" = |one| one.interval.map(|ends| ends[1]);
        "repeat": "Command that repeats it" = |one| &one.command;
    }
}

/// Columns of the page.
const COLUMNS: &[Shown] =
    shown!(Difference: "change", "experiment", "quantity", "before", "now", "ratio", "repeat");

impl Difference {
    fn word(&self) -> &'static str {
        if self.is_worse { "worse" } else { "better" }
    }

    fn value(&self, side: usize) -> Option<&(f64, String)> {
        self.values[side].as_ref()
    }

    fn text(&self, side: usize) -> &str {
        self.value(side).map_or(UNKNOWN, |value| &value.1)
    }

    /// Returns the change with its numbers.
    pub fn what(&self) -> String {
        let Self { quantity, extent, .. } = self;
        match self.values[0] {
            Some(_) => format!("{quantity} {} → {}, {extent}", self.text(0), self.text(1)),
            None => format!("{quantity}: {extent}"),
        }
    }

    /// Returns everything but the command, on one line.
    pub fn line(&self) -> String {
        format!("{}: {}", self.experiment, self.what())
    }

    fn row(&self) -> Markup {
        let class = if self.is_worse { "fail" } else { "pass" };
        // A ratio that was infinite may be missing in a record that was read.
        let mark = match self.ratio {
            None => "✗ fails over all runs".to_owned(),
            Some(ratio) => format!("{} {}", if ratio < 1.0 { "↓" } else { "↑" }, self.word()),
        };
        html! { tr {
            td { span class={ "verdict " (class) } { (mark) } }
            th scope="row" { (self.experiment) }
            td { (self.quantity) }
            td.number { (self.text(0)) }
            td.number { (self.text(1)) }
            td class={ "change " (class) } { (self.range()) }
            td { @if self.is_worse { (page::command(Some(("", &self.command)))) } }
        } }
    }

    /// Returns the ratio with its interval, and a picture of both beside 1, on a logarithmic axis from a quarter to 4.
    fn range(&self) -> Markup {
        let Some(ratio) = self.ratio else { return html! { (UNKNOWN) } };
        let number = |x: f64| if x.is_finite() { fixed(x, 4) } else { UNKNOWN.to_owned() };
        let place = |ratio: f64| (90.0 + 45.0 * ratio.log2().clamp(-2.0, 2.0)).round();
        let ends = self.interval.unwrap_or([ratio; 2]);
        let ([low, high], at) = (ends.map(place), place(ratio));
        html! {
            (number(ratio)) ", "
            @if self.interval.is_some() { "[" (ends.map(number).join(", ")) "]" } @else { "interval unknown" }
            @if [low, high, at].iter().all(|x| x.is_finite()) {
                svg viewBox="0 0 180 20" aria-hidden="true" {
                    path.mark d="M90 0V20M0 10H180" {}
                    path d={ "M" (low) " 10H" (high) "M" (at) " 4V16" } {}
                }
            }
        }
    }
}

impl Changes {
    /// Returns the table as a file.
    pub fn artifact(self) -> Result<Artifact, ReportError> {
        fields::artifact("changes.csv", &Difference::fields(), self.all)
    }

    /// Adds the changes and the remarks to the text of a screen.
    pub fn write(&self, text: &mut String, pen: Pen) {
        text.push('\n');
        for change in &self.all {
            let (word, paint) = if change.is_worse {
                ("REGRESSION", Paint::Red)
            } else {
                ("improvement", Paint::Green)
            };
            pen.note(text, &format!("{word} {}", change.line()), (word, paint));
            if change.is_worse && !change.command.is_empty() {
                let _ = writeln!(text, "    repeat: {}", change.command);
            }
        }
        for remark in &self.remarks {
            pen.say(text, Paint::Dim, remark);
        }
    }

    /// Returns the section of a page.
    pub fn section(&self) -> Markup {
        let fields = Difference::fields();
        html! {
            section aria-labelledby="changes" {
                h2 #changes { "Since baseline " (self.name) }
                @if !self.all.is_empty() {
                    div.wide tabindex="0" role="group" aria-labelledby="changes" {
                        table.changes {
                            thead { tr { @for column in COLUMNS {
                                @let field = &fields[column.place];
                                th scope="col" title=(field.tip()) { (field.head) }
                            } } }
                            tbody { @for change in &self.all { (change.row()) } }
                        }
                    }
                }
                ul { @for remark in &self.remarks { li { (remark) } } }
            }
        }
    }
}

/// Experiments that were left out of a comparison, with the reason.
pub type LeftOut<'a, T> = (&'static str, &'a [T]);

/// Maximum length of lists of experiments in words; `record.json` has them whole.
const MAX_LISTED: usize = 8;

/// Returns the lists that are not empty.
pub fn not_empty<'a, T>(
    lists: impl IntoIterator<Item = (&'static str, &'a Vec<T>)>,
) -> Vec<LeftOut<'a, T>> {
    let lists = lists.into_iter().filter(|(_, ids)| !ids.is_empty());
    lists.map(|(why, ids)| (why, &ids[..])).collect()
}

/// Returns the lengths of lists.
pub fn counts<T>(lists: &[LeftOut<T>]) -> String {
    joined(lists.iter().map(|(why, ids)| format!("{why} ({})", ids.len())), "; ")
}

/// Returns the closing remarks: the lists, cut where they are long, and that nothing was compared or changed.
pub fn closing<T: Display>(
    lists: &[LeftOut<T>],
    nothing: Option<String>,
    has_changes: bool,
) -> Vec<String> {
    let list = |(why, ids): &LeftOut<T>| {
        let shown = joined(ids.iter().take(MAX_LISTED).map(ToString::to_string), ", ");
        let more = left_out(ids.len(), MAX_LISTED).map(|more| format!(" and {more} more"));
        format!("{why} ({}): {shown}{}", ids.len(), more.unwrap_or_default())
    };
    let same = (!has_changes).then(|| "no change in what was compared".to_owned());
    lists.iter().map(list).chain(nothing.or(same)).collect()
}
