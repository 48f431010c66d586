//! Details of an experiment, which open below it: its numbers, the path of the evidence, its plots, and how to repeat it.

use crate::report::html::template::{Markup, html};
use checks::check::CheckResult;
use gate::CheckId;

use super::sparks;
use crate::record::{Compared, Finding, Row, Score, Verdict};
use crate::report::fields::{Cell, Field, Print, Shown as Column, shown};
use crate::report::html as page;
use crate::report::html::drawing::Plot;
use crate::report::html::words;
use crate::report::lists::joined;
use crate::report::run::failures;
use crate::report::run::summary_csv::SummaryRow as Joined;
use gate::deviation::signed_percent;

/// Content of the page that all rows share.
pub struct SharedContent<'a> {
    /// Seed of the run.
    pub seed: u64,
    /// Plots of each case.
    pub plots: &'a [Vec<Plot>],
    /// Fields of rows.
    pub fields: Vec<Field<Joined<'a>>>,
}

impl<'a> SharedContent<'a> {
    /// Returns a row with the seed of the run.
    pub fn line(&self, row: Row<'a>) -> Joined<'a> {
        Joined { row, seed: self.seed }
    }
}

/// Fields that are listed below the numbers.
const FACTS: &[Column] = shown!(Joined:
    "draws", "p_law", "predicted_skewness", "predicted_kurtosis", "setup_lookups", "needs", "best_sampling",
    "best_kind", "best_fom", "best_limit", "same_as", "log_unit", "seconds"
);

/// Returns everything that is known of a row of the case with this number.
pub fn of<'a>(row: &Row<'a>, shown: &SharedContent<'a>, place: usize) -> Markup {
    let findings: Vec<&Finding> = row.findings().collect();
    html! {
        @if !row.reason().is_empty() { p.reason { (row.reason()) } }
        (page::causes(&failures::causes(row)))
        @if row.verdict != Some(Verdict::Refused) { (numbers(row)) }
        div.both {
            @if row.verdict != Some(Verdict::Refused) { (sparks::evidence(&findings)) }
            @for course in &row.experiment.courses { (sparks::course(course)) }
            (page::facts(facts(row, shown)))
        }
        p.quiet { (row.case.problem) ", " (row.case.medium) ": " a href={ "#case-" (place) } { "the case" } ", "
            a href={ "#" (words::anchor(row)) } { "address of this row" } }
        @if !row.decide.is_empty() { (page::command(Some(("decide", &row.decide)))) }
        (page::command(Some(("how to repeat", &row.experiment.command))))
        @for plot in &shown.plots[place] { (plot.show()) }
    }
}

/// Returns further fields that are known, with their texts.
fn facts<'a>(row: &Row<'a>, shown: &SharedContent<'a>) -> Vec<(&'static str, String)> {
    let line = shown.line(*row);
    let all = FACTS.iter().map(|column| &shown.fields[column.place]);
    all.map(|field| (field.head, field.text(&line))).filter(|(_, text)| text != "0").collect()
}

/// Line of the table of numbers.
struct NumberLine<'a> {
    name: &'static str,
    values: Compared,
    z: String,
    finding: Option<&'a Finding>,
}

impl NumberLine<'_> {
    /// Returns the measured value minus that of theory in percent; empty if one is unknown.
    fn difference(&self) -> String {
        let Compared { measured, theory, .. } = self.values;
        let ratio = measured.zip(theory).map(|(measured, theory)| measured / theory - 1.0);
        ratio.filter(|ratio| ratio.is_finite()).map(signed_percent).unwrap_or_default()
    }
}

/// Titles of that table.
const TITLES: [&str; 11] = [
    "",
    "measured",
    "± 1 σ",
    "theory",
    "difference",
    "z or p",
    "verdict",
    "ln E",
    "ln P of +ε, −ε",
    "draws",
    "why",
];

/// Returns the measured and the predicted numbers, with the findings of the checks: findings of the gate and those that
/// do not pass line by line, the others in one.
fn numbers(row: &Row) -> Markup {
    let lines = lines(row);
    // The first finding of each of the three quantities is in its own line.
    let own = lines.iter().filter_map(|line| line.finding);
    let mut open: Vec<CheckId> = own.map(|finding| finding.check).collect();
    let rest = row.findings().filter(|finding| {
        let at = open.iter().position(|check| *check == finding.check && !finding.expects_bias);
        at.map(|at| open.remove(at)).is_none()
    });
    let (detailed, plain): (Vec<_>, Vec<_>) = rest.partition(|finding| {
        finding.gate.is_some() || finding.reason.is_some() || finding.verdict != Verdict::Pass
    });
    html! {
        div.wide tabindex="0" role="group" aria-label="numbers" {
            table.small {
                thead { tr { @for title in TITLES {
                    @if title.is_empty() { td {} } @else { th { (title) } }
                } } }
                tbody {
                    @for line in &lines { (numbers_of(line)) }
                    @for finding in detailed { tr {
                        th colspan="5" { (name(finding)) @if finding.expects_bias { " (bias declared)" } }
                        td { (finding.p.map_or_else(String::new, p)) }
                        (says(finding))
                    } }
                    @if !plain.is_empty() { tr {
                        th { "others" }
                        td.words colspan="5" { (plain.into_iter().map(passing).collect::<Vec<_>>().join(", ")) }
                        td.verdict.pass { (words::verdict(Some(Verdict::Pass))) }
                    } }
                }
            }
        }
    }
}

/// Returns mean, variance and lookups, which every experiment has, and the figure of merit, as far as they are known.
fn lines<'a>(row: &Row<'a>) -> Vec<NumberLine<'a>> {
    let result =
        |score: Score| row.findings().find(|one| one.check == score.check() && !one.expects_bias);
    let of_score = |score| {
        let values = row.compared(score);
        let name = match score {
            Score::Mean => "mean",
            Score::Variance => "variance V",
            Score::Lookups => "lookups per draw",
        };
        let z = Print::Signed.text(&Cell::Score(values.z, row.is_normal(score)));
        NumberLine { name, values, z, finding: result(score) }
    };
    let has_setup = row.experiment.setup_lookups.is_some_and(|lookups| lookups > 0);
    let (measured, theory) = (row.fom, row.predicted_fom);
    let merit = NumberLine {
        name: if has_setup { "1/(V · (lookups + setup/n))" } else { "1/(V · lookups)" },
        values: Compared { measured, deviation: None, theory, z: None },
        z: String::new(),
        finding: None,
    };
    let lines = Score::ALL.into_iter().map(of_score).chain([merit]);
    let is_known = |line: &NumberLine| {
        let numbers = [line.values.measured, line.values.theory];
        line.finding.is_some() || numbers.into_iter().flatten().any(f64::is_finite)
    };
    lines.filter(is_known).collect()
}

fn numbers_of(line: &NumberLine) -> Markup {
    html! { tr {
        th { (line.name) }
        td { (words::number(line.values.measured, 7)) }
        td { (words::number(line.values.deviation, 3)) }
        td { (words::number(line.values.theory, 7)) }
        td { (line.difference()) }
        td { (line.z) }
        @if let Some(finding) = line.finding { (says(finding)) }
    } }
}

/// Returns the verdict of a check and its grounds.
fn says(finding: &Finding) -> Markup {
    let CheckResult { verdict, gate, .. } = &finding.result;
    let number = |value| words::number(Some(value), 4);
    html! {
        td class={ "verdict " (verdict.word()) } { (words::verdict(Some(*verdict))) }
        @if let Some(gate) = gate {
            td { (words::evidence(gate.ln_e))
                 @if finding.expects_bias { " of " (words::number(Some(gate.ln_e_limit), 3)) } }
            td { (number(gate.ln_p[0])) ", " (number(gate.ln_p[1])) }
            td { (words::count(Some(gate.draws))) }
        } @else if finding.reason.is_some() { td {} td {} td {} }
        @if finding.reason.is_some() { td.words { (finding.words()) } }
    }
}

/// Returns a check's name, its quantity if that adds something, and the channel.
fn name(finding: &Finding) -> String {
    let Finding { check, what, channel, .. } = finding;
    let what = if what.ends_with(check.name()) { "" } else { what };
    joined([check.name(), what, channel], ": ")
}

/// Returns a check that passes without a remark, on a line with others.
fn passing(finding: &Finding) -> String {
    joined([finding.check.to_string(), finding.p.map_or_else(String::new, p)], " ")
}

fn p(p: f64) -> String {
    format!("p {}", words::number(Some(p), 3))
}
