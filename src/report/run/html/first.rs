//! First screen: the verdict and the command, then pictures: the map of verdicts, the distribution of z, and cards of
//! what does not pass.

use crate::report::html::template::{Markup, html};

use super::{failing, map, scores};
use crate::record::scores as of_run;
use crate::record::{Record, Verdict};
use crate::report::html as page;
use crate::report::html::drawing;
use crate::report::html::words;
use crate::report::lists::joined;
use crate::report::run::totals::{self, VERDICTS};
use numeric::digits::{counted, percent, range, short, time};

/// Maximum number of suspects and of notes.
const MAX_LISTED: usize = 20;

/// Returns the first screen.
pub fn section(record: &Record) -> Markup {
    let verdict = totals::verdict(record);
    let counts = totals::counts(&record.results.cases);
    let map = map::map(record);
    let open = html! {
        (failing::section(record, Verdict::Fail, "What fails"))
        (failing::section(record, Verdict::Inconclusive, "What is inconclusive"))
    };
    html! {
        header class={ "run " (verdict.class) } {
            p.tool { (origin(record)) }
            h1 { (verdict.words()) }
            p { (verdict.meaning(record)) }
            ul.counts aria-label="Rows by verdict" {
                @for known in VERDICTS {
                    @if let Some((_, number)) = counts.iter().find(|count| count.0 == known.verdict) {
                        li title=(known.meaning) {
                            span class={ "cell " (known.verdict.word()) } aria-hidden="true" { @if known.verdict != Verdict::Pass { (known.mark) } }
                            b { (number) } " " span class={ "verdict " (known.verdict.word()) } { (known.verdict.word()) }
                        }
                    }
                }
            }
            (page::command(Some(("command", &record.timing.command))))
            nav aria-label="On this page" {
                @if record.comparison.is_some() { a href="#changes" { "Since the baseline" } }
                a href="#cases" { (counted(record.results.cases.len() as u64, "case")) " with plots" }
                a href="#experiments" { (counted(verdict.rows as u64, "experiment")) }
                a href="#facts" { "The run" }
                a href="#legend" { "Legend" }
            }
        }
        div.pictures {
            div {
                section aria-labelledby="map" {
                    h2 #map { "Verdicts" }
                    p.quiet {
                        "A cell is an experiment, and leads to its row."
                        @if map.is_dense { " Those of one estimator are side by side." }
                    }
                    (map.shown)
                }
                @if !map.is_dense { (open) }
            }
            (distribution(record))
        }
        @if map.is_dense { (open) }
        (suspects(record))
        (notes(record))
    }
}

/// Returns version, date, duration and machine.
fn origin(record: &Record) -> String {
    let (results, timing) = (&record.results, &record.timing);
    let parts = [
        format!("Trueflight {}", results.version),
        timing.date.clone(),
        format!("{} on {} threads ({})", time(timing.seconds), timing.threads, timing.level),
        format!("seed {}", results.seed),
    ];
    joined(parts, " · ")
}

fn distribution(record: &Record) -> Markup {
    let all = of_run::scores(&record.results);
    html! {
        @if !all.is_empty() {
            section aria-labelledby="scores" {
                h2 #scores { "Differences from theory" }
                p.quiet {
                    "Bars: all z-scores. Curve: the normal distribution of correct estimators. Grey: where 99 of 100 bars would end "
                    "if scores were independent. Those of one experiment are not, so an orange bar near 0 is no failure."
                }
                (drawing::inline(&scores::figure(&all), "Histograms of the z-scores of means, variances and lookups with the normal curve"))
            }
        }
    }
}

/// Returns the section of the run's levels and conditions.
pub fn facts(record: &Record) -> Markup {
    let results = &record.results;
    let gate = &results.gate;
    let biases = results.cases.iter().filter_map(|case| case.visible_bias.filter(words::is_known));
    let visible = biases.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
    let worst_bias = gate.worst_bias.filter(|bias| bias.is_finite()).map(percent);
    let assumed = (gate.variance_assumed > 0).then(|| gate.variance_assumed.to_string());
    let cut = |is_so: bool, by: &str| if is_so { by.to_owned() } else { String::new() };
    let by_time = "by a limit of time, or interrupted (then `trueflight run --resume` with its folder goes on): other machines will differ";
    let facts = [
        ("α, the probability of any false alarm", short(results.alpha, 3)),
        ("α is shared by", format!("{} scalars, {} distributions", gate.scalars, gate.laws)),
        ("β, the probability to miss a bias of ε", short(gate.beta, 3)),
        ("Largest evidence", strongest(record).unwrap_or_default()),
        ("ln of the mean e-value", words::number(gate.ln_mean_e, 3)),
        ("Visible bias of a mean, as planned", visible.map(range).unwrap_or_default()),
        ("No pass leaves room for a bias above", worst_bias.unwrap_or_default()),
        ("Passes with the variance assumed", assumed.unwrap_or_default()),
        ("Cut short", cut(results.cut_by_time, by_time)),
        ("Cut short", cut(results.cut_by_budget, "by the budget of draws")),
        ("Random numbers", results.streams.clone()),
    ];
    html! {
        section aria-labelledby="facts" {
            h2 #facts { "The run" }
            (page::facts(facts))
        }
    }
}

/// Returns the largest ln E of all checks without a declared bias, its limit, and its experiment.
fn strongest(record: &Record) -> Option<String> {
    let gated = record.results.rows().flat_map(|row| {
        let requested = row.findings().filter(|finding| !finding.expects_bias);
        requested.filter_map(move |finding| Some((finding.evidence()?, row, finding)))
    });
    // The first of equal ones.
    let (ln_e, row, finding) = gated.reduce(|a, b| if b.0 > a.0 { b } else { a })?;
    let limit = words::number(Some(finding.gate?.ln_e_limit), 3);
    let (ln_e, of) = (words::evidence(ln_e), row.name());
    Some(format!("ln E = {ln_e} of {limit}: {} of {}, {of}", finding.check, row.case.name))
}

fn suspects(record: &Record) -> Markup {
    let triage = totals::suspects(record);
    html! {
        @if !triage.is_empty() {
            section aria-labelledby="suspects" {
                h2 #suspects { "Look here first (e-BH)" }
                ol { @for suspect in triage.iter().take(MAX_LISTED) { li { (totals::suspect(suspect)) } } }
                (words::more(triage.len(), MAX_LISTED))
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
            section aria-labelledby="notes" {
                h2 #notes { "Notes" }
                ul { @for (case, note) in all.iter().take(MAX_LISTED) { li { (case.name) ": " (note) } } }
                (words::more(all.len(), MAX_LISTED))
            }
        }
    }
}
