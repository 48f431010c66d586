//! What opens below an experiment: its plots, all its numbers, its checks and the command that repeats it.

use maud::{Markup, html};

use super::plots::Plot;
use super::{page, sparks, words};
use crate::record::{Finding, Row, Verdict};
use crate::report::likely;
use crate::report::rows::JoinedRow;

/// Everything that is known of a row.
pub fn of(joined: &JoinedRow, plots: &[Plot]) -> Markup {
    let JoinedRow { case, row, .. } = joined;
    html! {
        @if !row.reason.is_empty() { p.reason { (row.reason) } }
        @if !row.decide.is_empty() { (page::command(Some(("decide", &row.decide)))) }
        (page::command(Some(("repeat", &row.command))))
        (page::causes(&likely::lines(case, row)))
        p { a href={ "#" (words::anchor(case, row)) } { "Address of this row" } }
        @if row.verdict != Some(Verdict::Refused) { (numbers(row)) (sparks::evidence(&row.findings)) }
        dl.facts {
            div { dt { "Problem and medium" } dd { (case.problem) ", " (case.medium) } }
            @for (name, value) in facts(joined) { div { dt { (name) } dd { (value) } } }
        }
        @for course in &row.courses { (sparks::course(course)) }
        @for plot in plots { (plot.show()) }
    }
}

/// A line of the table of numbers.
struct Line<'a> {
    name: &'static str,
    measured: Option<f64>,
    deviation: Option<f64>,
    theory: Option<f64>,
    z: String,
    finding: Option<&'a Finding>,
}

/// The titles of that table.
const TITLES: [&str; 10] =
    ["", "measured", "± 1 σ", "theory", "z or p", "says", "ln E", "ln P of +ε, −ε", "draws", "why"];

/// What was measured and what theory says of it, with what each check found: those of the gate and those that do
/// not pass line by line, the others in one.
fn numbers(row: &Row) -> Markup {
    let lines = lines(row);
    let is_told = |finding: &&Finding| {
        lines.iter().filter_map(|line| line.finding).any(|other| std::ptr::eq(other, *finding))
    };
    let rest = row.findings.iter().filter(|finding| !is_told(finding));
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

/// The three that every experiment is asked for, and the figure of merit, as far as they are known.
fn lines(row: &Row) -> Vec<Line<'_>> {
    let found = |check: &str| {
        row.findings.iter().find(|finding| finding.check == check && !finding.expects_bias)
    };
    let z = |name: &str, z: Option<f64>| words::z(row, name, z);
    let has_setup = row.setup_lookups.is_some_and(|lookups| lookups > 0);
    let lines = [
        Line {
            name: "mean",
            measured: row.mean,
            deviation: row.standard_error,
            theory: row.truth,
            z: z("z_mean", row.z_mean),
            finding: found("mean"),
        },
        Line {
            name: "variance V",
            measured: row.variance,
            deviation: row.variance_deviation,
            theory: row.predicted_variance,
            z: z("z_variance", row.z_variance),
            finding: found("variance"),
        },
        Line {
            name: "lookups per draw",
            measured: row.lookups_per_draw,
            deviation: row.lookups_deviation,
            theory: row.predicted_lookups,
            z: z("z_lookups", row.z_lookups),
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

/// The verdict of a check and what it rests on.
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

/// A check's name, what it is about where that says more, and the channel.
fn name(finding: &Finding) -> String {
    let Finding { check, what, channel, .. } = finding;
    let what = if what.ends_with(check.as_str()) { "" } else { what };
    let names = [check.as_str(), what, channel].into_iter().filter(|name| !name.is_empty());
    names.collect::<Vec<_>>().join(": ")
}

/// A check that passes without a word, on a line with others.
fn passing(finding: &Finding) -> String {
    let words = [finding.check.clone(), finding.p.map_or_else(String::new, p)];
    words.into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

fn p(p: f64) -> String {
    format!("p {}", words::number(Some(p), 3))
}

/// Other facts, by name; what is unknown is left out.
fn facts(joined: &JoinedRow) -> Vec<(&'static str, String)> {
    let row = joined.row;
    let number = |value: Option<f64>| words::number(value, 5);
    let sampling =
        if row.sampling.is_some() { number(row.sampling) } else { row.sampling_kind.clone() };
    let mut facts = vec![
        ("σ\u{302}", sampling),
        ("Control", row.control.clone()),
        ("Swept value", number(row.swept.filter(|_| row.swept != row.sampling))),
        ("ε", words::number(row.detectable_bias, 3)),
        ("Draws of the statistics", words::count(row.draws)),
        ("Draws to the verdict", words::count(row.drawn)),
        ("p of the law", number(row.p_law)),
        ("Skewness in theory", number(row.predicted_skewness)),
        ("Kurtosis in theory", number(row.predicted_kurtosis)),
        ("Setup lookups of a ray", words::count(row.setup_lookups.filter(|&count| count > 0))),
        ("n, draws of a ray", words::count(joined.case.draws_per_ray.filter(|&n| n > 1))),
        ("Needs", row.needs.clone()),
        ("Best σ\u{302}", number(row.best_sampling)),
        ("Best σ\u{302} is", row.best_kind.clone()),
        ("Best figure of merit", number(row.best_fom)),
        ("Limit of the figure of merit", number(row.best_limit)),
        ("Kernel", row.kernel.clone()),
        ("Stream", row.stream.map_or_else(String::new, |stream| stream.to_string())),
        ("Drawn as", row.same_as.clone()),
        ("All values in units of exp(−u), u", number(row.log_unit)),
        ("Processor time [s]", words::number(joined.seconds, 3)),
        ("Draws", if joined.is_reused { "of an earlier run".to_owned() } else { String::new() }),
    ];
    facts.retain(|(_, value)| !value.is_empty() && value != words::UNKNOWN);
    facts
}
