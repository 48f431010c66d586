//! First screen: the verdict, the counts, the levels, and the most important findings with their commands.

use maud::{Markup, html};

use crate::record::baseline::Comparison;
use crate::record::{Record, Verdict};
use crate::report::html as page;
use crate::report::html::words;
use crate::report::run::failures::{self, Failure, failing};
use crate::report::run::totals;
use numeric::digits::{percent, range, short, time};

/// Maximum number of findings of a kind on the first screen; the table has all.
const MOST: usize = 20;
/// Maximum number of suspects on the first screen.
const SUSPECTS: usize = 5;

/// Verdict on the whole run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RunVerdict {
    /// Style class, which gives the colour.
    pub class: &'static str,
    failing: usize,
    open: usize,
    is_worse: bool,
    rows: usize,
}

/// Returns the verdict on a run: a failure, or a regression against a stored run, precedes inconclusive results.
pub fn verdict(record: &Record) -> RunVerdict {
    let counts = totals::counts(&record.results.cases);
    let number =
        |verdict| counts.iter().find(|count| count.0 == verdict).map_or(0, |count| count.1);
    let [failing, open, passing] =
        [Verdict::Fail, Verdict::Inconclusive, Verdict::Pass].map(number);
    let is_worse = record.comparison.as_ref().is_some_and(Comparison::fails);
    let class = match (failing > 0 || is_worse, open > 0, passing > 0) {
        (true, ..) => "fail",
        (_, true, _) => "inconclusive",
        (.., true) => "pass",
        _ => "refused",
    };
    let rows = record.results.rows().count();
    RunVerdict { class, failing, open, is_worse, rows }
}

impl RunVerdict {
    /// Returns it in one line.
    pub fn words(&self) -> String {
        let Self { failing, open, is_worse, rows, class } = *self;
        let mut parts = Vec::new();
        if failing > 0 {
            parts.push(format!("{failing} of {rows} fail"));
        }
        if is_worse {
            parts.push("something became worse than the baseline".to_owned());
        }
        if open > 0 {
            parts.push(format!("{open} of {rows} are inconclusive"));
        }
        match class {
            "pass" => format!("pass: nothing of {rows} fails or is inconclusive"),
            "refused" => format!("nothing was tested: none of {rows} passes or fails"),
            word => format!("{word}: {}", parts.join(", ")),
        }
    }
}

/// Returns the first screen.
pub fn section(record: &Record) -> Markup {
    let verdict = verdict(record);
    let counts = totals::counts(&record.results.cases);
    html! {
        header class={ "run " (verdict.class) } {
            p.tool { "Trueflight " (record.results.version) }
            h1 { (verdict.words()) }
            ul.counts aria-label="Rows by verdict" {
                @for (verdict, number) in &counts {
                    li { b { (number) } " " span class={ "verdict " (verdict.word()) } { (words::verdict(Some(*verdict))) } }
                }
            }
            nav aria-label="On this page" {
                @if record.comparison.is_some() { a href="#changes" { "Since the baseline" } }
                a href="#cases" { (record.results.cases.len()) " cases and their plots" }
                a href="#experiments" { (verdict.rows) " experiments" }
            }
        }
        (suspects(record))
        @for (verdict, title) in [(Verdict::Fail, "What fails"), (Verdict::Inconclusive, "What is inconclusive")] {
            (failures(title, &failing(record, verdict)))
        }
        (notes(record))
        section aria-labelledby="facts" {
            h2 #facts { "The run" }
            dl.facts { @for (name, value) in facts(record) { div { dt { (name) } dd { (value) } } } }
        }
    }
}

/// Returns the run's levels and conditions, by name.
fn facts(record: &Record) -> Vec<(&'static str, String)> {
    let (results, timing) = (&record.results, &record.timing);
    let gate = &results.gate;
    let biases = results.cases.iter().filter_map(|case| case.visible_bias.filter(words::is_known));
    let visible = biases.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
    let mut facts = vec![
        ("Seed", results.seed.to_string()),
        ("α, the chance of any false alarm", short(results.alpha, 3)),
        ("α is shared by", format!("{} scalars, {} laws", gate.scalars, gate.laws)),
        ("β, the chance to miss a bias of ε", short(gate.beta, 3)),
    ];
    let mut add = |name, value: Option<String>| facts.extend(value.map(|value| (name, value)));
    add("Largest evidence", strongest(record));
    add("ln of the mean e-value", Some(words::number(gate.ln_mean_e, 3)));
    add("Visible bias of a mean, as planned", visible.map(range));
    add(
        "No pass leaves room for a bias above",
        gate.worst_bias.filter(|b| b.is_finite()).map(percent),
    );
    let assumed = gate.variance_assumed;
    add("Passes with the variance assumed", (assumed > 0).then(|| assumed.to_string()));
    add("Machine", Some(format!("{}, threads: {}", timing.level, timing.threads)));
    add("Time", Some(time(timing.seconds)));
    let short_of = |what: &str, is_so: bool| is_so.then(|| what.to_owned());
    add(
        "Cut short",
        short_of(
            "by a limit of time, or interrupted (then `trueflight run --resume` with its folder goes on): other machines will differ",
            results.cut_by_time,
        ),
    );
    add("Cut short", short_of("by the budget of draws", results.cut_by_budget));
    facts.retain(|(_, value)| !value.is_empty() && value != words::UNKNOWN);
    facts
}

/// Returns the largest ln E of all checks without a declared bias, its limit, and its experiment.
fn strongest(record: &Record) -> Option<String> {
    let gated = record.results.rows().flat_map(|row| {
        let asked = row.findings().filter(|finding| !finding.expects_bias);
        asked.filter_map(move |finding| Some((words::ordered(finding.gate?.ln_e), row, finding)))
    });
    // The first of equal ones.
    let (ln_e, row, finding) = gated.reduce(|a, b| if b.0 > a.0 { b } else { a })?;
    let limit = words::number(Some(finding.gate?.ln_e_limit), 3);
    let (ln_e, of) = (words::evidence(ln_e), row.name());
    Some(format!("ln E = {ln_e} of {limit}: {} of {}, {of}", finding.check, row.case.name))
}

fn suspects(record: &Record) -> Markup {
    let triage = &record.results.gate.triage;
    html! {
        @if !triage.is_empty() {
            section aria-labelledby="suspects" {
                h2 #suspects { "Look here first (e-BH)" }
                ol {
                    @for suspect in triage.iter().take(SUSPECTS) {
                        li { (suspect.case) ": " (suspect.experiment) ": " (suspect.check)
                             " (ln E = " (words::evidence(suspect.ln_e)) ")" }
                    }
                }
                (more(triage.len(), SUSPECTS))
            }
        }
    }
}

/// Returns the notes on cases.
fn notes(record: &Record) -> Markup {
    let cases = record.results.cases.iter();
    let all: Vec<_> =
        cases.flat_map(|case| case.notes.iter().map(move |note| (case, note))).collect();
    html! {
        @if !all.is_empty() {
            section.findings {
                h2 { "Notes" }
                ul { @for (case, note) in all.iter().take(MOST) { li { (case.name) ": " (note) } } }
                (more(all.len(), MOST))
            }
        }
    }
}

fn failures(title: &str, failures: &[Failure]) -> Markup {
    html! {
        @if !failures.is_empty() {
            section.findings {
                h2 { (title) }
                @for failure in failures.iter().take(MOST) {
                    article {
                        h3 { a href={ "#" (words::anchor(&failure.row)) } { (failure.row.case.name) ": " (failure.experiment()) } }
                        p { @if !failure.check().is_empty() { b { (failure.check()) } ": " }
                            (failure.reason()) " (" (failure.place()) ")" }
                        (page::command(failure.row.next_command()))
                        (page::causes(&failures::causes(&failure.row)))
                    }
                }
                (more(failures.len(), MOST))
            }
        }
    }
}

fn more(all: usize, shown: usize) -> Markup {
    html! { @if all > shown { p { "and " (all - shown) " more, in the table below." } } }
}
