//! What changed since a stored run.

use maud::{Markup, html};

use super::{page, words};
use crate::record::baseline::{Change, Comparison, Drift, Measured, Quantity};
use crate::report::diff;
use numeric::digits::{fixed, short};

/// The comparison: what became worse first, each with its ratio and where that may be.
pub fn section(comparison: &Comparison) -> Markup {
    let Comparison { changes, drifts, .. } = comparison;
    let (worse, better): (Vec<_>, Vec<_>) = changes.iter().partition(|one| one.is_regression);
    html! {
        section aria-labelledby="changes" {
            h2 #changes { "Since baseline " (comparison.name) }
            @if !(changes.is_empty() && drifts.is_empty()) {
                div.wide tabindex="0" role="group" aria-labelledby="changes" {
                    table {
                        thead { tr {
                            @for head in ["change", "experiment", "quantity", "before", "now", "ratio", "interval", "repeat"] {
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
        td colspan="4" { "ln E = " (words::evidence(*ln_e)) " ≥ " (short(*limit, 3)) }
        td { (page::command(Some(("repeat", command)))) }
    } }
}

fn change(change: &Change) -> Markup {
    let (name, unit) = match change.quantity {
        Quantity::Variance => ("variance", ""),
        Quantity::Lookups => ("lookups per draw", ""),
        Quantity::Time => ("time per draw", " ns"),
    };
    let (class, word) = if change.is_regression { ("fail", "worse") } else { ("pass", "better") };
    let number = |value: f64, digits| {
        if value.is_finite() { fixed(value, digits) } else { words::UNKNOWN.to_owned() }
    };
    // A ratio without bound is as good as none in a record that was read.
    let arrow = if change.ratio < 1.0 { "↓" } else { "↑" };
    let value = |Measured { value, error }: Measured| {
        let error = error.map_or(String::new(), |error| format!(" ± {}", short(error, 2)));
        format!("{}{error}{unit}", number(value, 5))
    };
    html! { tr {
        td { span class={ "verdict " (class) } { (arrow) " " (word) } }
        th scope="row" { (change.id) }
        td { (name) }
        td.number { (value(change.before)) }
        td.number { (value(change.now)) }
        td.number { (number(change.ratio, 4)) }
        td.number {
            @match change.interval {
                Some([low, high]) => { "[" (number(low, 4)) ", " (number(high, 4)) "]" }
                None => { "unknown" }
            }
        }
        td { @if change.is_regression { (page::command(Some(("repeat", &change.command)))) } }
    } }
}
