//! Details of an experiment, which open below it: plots, all numbers, checks and the command that repeats it.

use maud::{Markup, html};

use super::sparks;
use crate::record::{Finding, Row, Score, Verdict};
use crate::report::html as page;
use crate::report::html::drawing::Plot;
use crate::report::html::words;
use crate::report::run::failures;

/// Returns everything that is known of a row.
pub fn of(row: &Row, plots: &[Plot]) -> Markup {
    let case = row.case;
    html! {
        @if !row.reason.is_empty() { p.reason { (row.reason) } }
        @if !row.decide.is_empty() { (page::command(Some(("decide", &row.decide)))) }
        (page::command(Some(("repeat", &row.experiment.command))))
        (page::causes(&failures::causes(row)))
        p { a href={ "#" (words::anchor(row)) } { "Address of this row" } }
        @if row.verdict != Some(Verdict::Refused) { (numbers(row)) (sparks::evidence(&row.findings().collect::<Vec<_>>())) }
        dl.facts {
            div { dt { "Problem and medium" } dd { (case.problem) ", " (case.medium) } }
            @for (name, value) in facts(row) { div { dt { (name) } dd { (value) } } }
        }
        @for course in &row.experiment.courses { (sparks::course(course)) }
        @for plot in plots { (plot.show()) }
    }
}

/// Line of the table of numbers.
struct Line<'a> {
    name: &'static str,
    measured: Option<f64>,
    deviation: Option<f64>,
    theory: Option<f64>,
    z: String,
    finding: Option<&'a Finding>,
}

/// Titles of that table.
const TITLES: [&str; 10] =
    ["", "measured", "± 1 σ", "theory", "z or p", "says", "ln E", "ln P of +ε, −ε", "draws", "why"];

/// Returns the measured and the predicted numbers, with the findings of the checks: findings of the gate and those that
/// do not pass line by line, the others in one.
fn numbers(row: &Row) -> Markup {
    let lines = lines(row);
    // The first finding of each of the three quantities is in its own line.
    let mut open: Vec<&str> = lines
        .iter()
        .filter_map(|line| line.finding)
        .map(|finding| finding.check.as_str())
        .collect();
    let rest = row.findings().filter(|finding| {
        let at = open.iter().position(|check| *check == finding.check && !finding.expects_bias);
        at.map(|at| open.remove(at)).is_none()
    });
    let (told, plain): (Vec<_>, Vec<_>) = rest.partition(|finding| {
        finding.gate.is_some() || !finding.reason.is_empty() || finding.verdict != Verdict::Pass
    });
    html! {
        div.wide tabindex="0" role="group" aria-label="numbers" {
            table.small {
                thead { tr { @for title in TITLES {
                    @if title.is_empty() { td {} } @else { th { (title) } }
                } } }
                tbody {
                    @for line in &lines { (numbers_of(line)) }
                    @for finding in told { tr {
                        th colspan="4" { (name(finding)) @if finding.expects_bias { " (bias declared)" } }
                        td { (finding.p.map_or_else(String::new, p)) }
                        (says(finding))
                    } }
                    @if !plain.is_empty() { tr {
                        th { "others" }
                        td.words colspan="4" { (plain.into_iter().map(passing).collect::<Vec<_>>().join(", ")) }
                        td.verdict.pass { (words::verdict(Some(Verdict::Pass))) }
                    } }
                }
            }
        }
    }
}

/// Returns mean, variance and lookups, which every experiment has, and the figure of merit, as far as they are known.
fn lines<'a>(row: &Row<'a>) -> Vec<Line<'a>> {
    let found = |check: &str| {
        row.findings().find(|finding| finding.check == check && !finding.expects_bias)
    };
    let z = |score: Score, z: Option<f64>| words::z(row, score, z);
    let has_setup = row.experiment.setup_lookups.is_some_and(|lookups| lookups > 0);
    let lines = [
        Line {
            name: "mean",
            measured: row.mean,
            deviation: row.standard_error,
            theory: row.truth,
            z: z(Score::Mean, row.z_mean),
            finding: found("mean"),
        },
        Line {
            name: "variance V",
            measured: row.variance,
            deviation: row.variance_deviation,
            theory: row.predicted_variance,
            z: z(Score::Variance, row.z_variance),
            finding: found("variance"),
        },
        Line {
            name: "lookups per draw",
            measured: row.experiment.lookups_per_draw,
            deviation: row.experiment.lookups_deviation,
            theory: row.experiment.predicted_lookups,
            z: z(Score::Lookups, row.experiment.z_lookups),
            finding: found("lookups"),
        },
        Line {
            name: if has_setup { "1/(V · (lookups + setup/n))" } else { "1/(V · lookups)" },
            measured: row.fom,
            deviation: None,
            theory: row.predicted_fom,
            z: String::new(),
            finding: None,
        },
    ];
    let is_known = |line: &Line| {
        let numbers = [line.measured, line.theory];
        line.finding.is_some() || numbers.into_iter().flatten().any(f64::is_finite)
    };
    lines.into_iter().filter(is_known).collect()
}

fn numbers_of(line: &Line) -> Markup {
    html! { tr {
        th { (line.name) }
        td { (words::number(line.measured, 7)) }
        td { (words::number(line.deviation, 3)) }
        td { (words::number(line.theory, 7)) }
        td { (line.z) }
        @if let Some(finding) = line.finding { (says(finding)) }
    } }
}

/// Returns the verdict of a check and its grounds.
fn says(finding: &Finding) -> Markup {
    let Finding { verdict, gate, .. } = finding;
    let number = |value| words::number(Some(value), 4);
    html! {
        td class={ "verdict " (verdict.word()) } { (words::verdict(Some(*verdict))) }
        @if let Some(gate) = gate {
            td { (words::evidence(gate.ln_e))
                 @if finding.expects_bias { " of " (words::number(Some(gate.ln_e_limit), 3)) } }
            td { (number(gate.ln_p[0])) ", " (number(gate.ln_p[1])) }
            td { (words::count(Some(gate.draws))) }
        } @else if !finding.reason.is_empty() { td {} td {} td {} }
        @if !finding.reason.is_empty() { td.words { (finding.reason) } }
    }
}

/// Returns a check's name, its quantity if that adds something, and the channel.
fn name(finding: &Finding) -> String {
    let Finding { check, what, channel, .. } = finding;
    let what = if what.ends_with(check.as_str()) { "" } else { what };
    let names = [check.as_str(), what, channel].into_iter().filter(|name| !name.is_empty());
    names.collect::<Vec<_>>().join(": ")
}

/// Returns a check that passes without a remark, on a line with others.
fn passing(finding: &Finding) -> String {
    let words = [finding.check.clone(), finding.p.map_or_else(String::new, p)];
    words.into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

fn p(p: f64) -> String {
    format!("p {}", words::number(Some(p), 3))
}

/// Returns other facts, by name; unknown ones are left out.
fn facts(row: &Row) -> Vec<(&'static str, String)> {
    let number = |value: Option<f64>| words::number(value, 5);
    let sampling = if row.experiment.sampling().is_some() {
        number(row.experiment.sampling())
    } else {
        row.experiment.id.sampling.kind.clone()
    };
    let mut facts = vec![
        ("σ\u{302}", sampling),
        ("Control", row.experiment.id.control.clone()),
        (
            "Swept value",
            number(
                row.experiment
                    .swept()
                    .filter(|_| row.experiment.swept() != row.experiment.sampling()),
            ),
        ),
        ("ε", words::number(row.detectable_bias, 3)),
        ("Draws of the statistics", words::count(row.experiment.draws)),
        ("Draws to the verdict", words::count(row.experiment.drawn)),
        ("p of the law", number(row.experiment.p_law)),
        ("Skewness in theory", number(row.predicted_skewness)),
        ("Kurtosis in theory", number(row.predicted_kurtosis)),
        (
            "Setup lookups of a ray",
            words::count(row.experiment.setup_lookups.filter(|&count| count > 0)),
        ),
        ("n, draws of a ray", words::count(row.case.draws_per_ray.filter(|&n| n > 1))),
        ("Needs", row.experiment.needs.clone()),
        ("Best σ\u{302}", number(row.best_sampling())),
        ("Best σ\u{302} is", row.best_kind().to_owned()),
        ("Best figure of merit", number(row.best_fom())),
        ("Limit of the figure of merit", number(row.best_limit())),
        ("Stream", row.experiment.stream.map_or_else(String::new, |stream| stream.to_string())),
        ("Drawn as", row.experiment.same_as()),
        ("All values in units of exp(−u), u", number(row.log_unit)),
        ("Processor time [s]", words::number(row.experiment.spent.seconds, 3)),
        (
            "Draws",
            if row.experiment.spent.is_reused {
                "of an earlier run".to_owned()
            } else {
                String::new()
            },
        ),
    ];
    facts.retain(|(_, value)| !value.is_empty() && value != words::UNKNOWN);
    facts
}
