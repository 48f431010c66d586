//! Cases: verdicts, visible bias, plots; and the changes since a stored run.

use crate::record::baseline::{Change, Comparison, Drift};
use crate::record::{CaseRecord, Record};
use crate::report::html as page;
use crate::report::html::drawing::Plot;
use crate::report::html::words;
use crate::report::run::diff;
use crate::report::run::totals;
use maud::{Markup, html};
use numeric::digits::{fixed, range, short};

/// Returns a line for each case; those with plots open.
pub fn section(record: &Record, plots: &[Vec<Plot>]) -> Markup {
    let cases = &record.results.cases;
    html! {
        section aria-labelledby="cases" {
            h2 #cases { "Cases" }
            p.quiet { "Each opens to its title, what it could have seen, and its plots." }
            div.cases { @for (place, (case, plots)) in cases.iter().zip(plots).enumerate() {
                details.case #{ "case-" (place) } data-problem=(case.problem) data-medium=(case.medium) {
                    summary { b { (case.name) } " " span.quiet { (totals::words(case)) } }
                    p { (case.title) }
                    @for note in &case.notes { p { b { "Note: " } (note) } }
                    @for fact in &case.facts { p.quiet { (fact) } }
                    dl.facts { @for (name, value) in facts(case) { div { dt { (name) } dd { (value) } } } }
                    @for plot in plots { (plot.show()) }
                }
            } }
        }
    }
}

fn facts(case: &CaseRecord) -> Vec<(&'static str, String)> {
    let mut facts = vec![
        ("Problem", case.problem.clone()),
        ("Medium", case.medium.clone()),
        ("File", case.path.clone()),
        ("Draws", totals::draws(case)),
        ("Visible bias", case.visible_bias.filter(words::is_known).map(range).unwrap_or_default()),
        ("Time to verdict, in units of 17 V/ε² draws", words::number(case.pace, 3)),
    ];
    facts.retain(|(_, value)| !value.is_empty() && value != words::UNKNOWN);
    facts
}

/// Returns the comparison: regressions first, each with its ratio and the interval of it.
pub fn changes(comparison: &Comparison) -> Markup {
    let Comparison { changes, drifts, .. } = comparison;
    let (worse, better): (Vec<_>, Vec<_>) = changes.iter().partition(|one| one.is_regression);
    html! {
        section aria-labelledby="changes" {
            h2 #changes { "Since baseline " (comparison.name) }
            @if !(changes.is_empty() && drifts.is_empty()) {
                div.wide tabindex="0" role="group" aria-labelledby="changes" {
                    table.changes {
                        thead { tr {
                            @for head in ["change", "experiment", "quantity", "before", "now", "ratio, with its interval", "repeat"] {
                                th scope="col" { (head) }
                            }
                        } }
                        tbody {
                            @for one in drifts { (drift(one)) }
                            @for one in worse { (change(one)) }
                            @for one in better { (change(one)) }
                        }
                    }
                }
            }
            ul { @for remark in diff::remarks(comparison) { li { (remark) } } }
        }
    }
}

fn drift(drift: &Drift) -> Markup {
    let Drift { id, check, ln_e, limit, command } = drift;
    html! { tr {
        td { span.verdict.fail { "✗ fails over all runs" } }
        th scope="row" { (id) }
        td { (check) }
        td colspan="3" { "ln E = " (words::evidence(*ln_e)) " ≥ " (short(*limit, 3)) }
        td { (page::command(Some(("", command)))) }
    } }
}

fn change(change: &Change) -> Markup {
    let [before, now] = diff::values(change);
    let (class, word) = if change.is_regression { ("fail", "worse") } else { ("pass", "better") };
    let number = |value: f64, digits| {
        if value.is_finite() { fixed(value, digits) } else { words::UNKNOWN.to_owned() }
    };
    // A ratio that was infinite may be missing in a record that was read.
    let arrow = if change.ratio < 1.0 { "↓" } else { "↑" };
    html! { tr {
        td { span class={ "verdict " (class) } { (arrow) " " (word) } }
        th scope="row" { (change.id) }
        td { (diff::name(change.quantity)) }
        td.number { (before) }
        td.number { (now) }
        td class={ "change " (class) } {
            (number(change.ratio, 4)) ", "
            @match change.interval {
                Some([low, high]) => { "[" (number(low, 4)) ", " (number(high, 4)) "]" }
                None => { "interval unknown" }
            }
            (beside_one(change))
        }
        td { @if change.is_regression { (page::command(Some(("", &change.command)))) } }
    } }
}

/// Returns a picture of a ratio with its interval beside 1, on a logarithmic axis from a quarter to 4.
fn beside_one(change: &Change) -> Markup {
    let place = |ratio: f64| (90.0 + 45.0 * ratio.log2().clamp(-2.0, 2.0)).round();
    let [low, high] = change.interval.unwrap_or([change.ratio; 2]).map(place);
    let at = place(change.ratio);
    html! {
        @if [low, high, at].iter().all(|x| x.is_finite()) {
            svg viewBox="0 0 180 20" aria-hidden="true" {
                path.mark d="M90 0V20M0 10H180" {}
                path d={ "M" (low) " 10H" (high) "M" (at) " 4V16" } {}
            }
        }
    }
}
