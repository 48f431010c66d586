//! `report.html` of a bench: times of all experiments, decrease of their errors, changes.

use maud::{Markup, html};

use super as files;
use crate::bench::record::{Bench, BenchCase, BenchRow, Times};
use crate::bench::stored::Comparison;
use crate::report::ReportError;
use crate::report::html as page;
use crate::report::html::drawing::{Plot, definitions, plot};
use crate::report::html::listing::{self, Cell, Column, table};
use numeric::digits::{count, fixed, time};

/// Row with its case.
type Joined<'a> = (&'a BenchCase, &'a BenchRow);

/// Makes a column for a figure of the times.
macro_rules! timed {
    ($title:literal, $figure:expr) => {
        Column {
            title: $title,
            cell: Cell::Number(|(_, row)| {
                let figure: fn(&Times) -> Option<f64> = $figure;
                row.times.as_ref().and_then(figure)
            }),
        }
    };
}

fn columns<'a>() -> [Column<Joined<'a>>; 15] {
    [
        Column { title: "case", cell: Cell::Text(|(case, _)| case.name.clone()) },
        Column { title: "estimator", cell: Cell::Text(|(_, row)| row.id.label()) },
        Column { title: "σ\u{302}", cell: Cell::Text(sampling) },
        Column { title: "control", cell: Cell::Text(|(_, row)| row.id.control.clone()) },
        Column { title: "channel", cell: Cell::Text(|(_, row)| row.channel.clone()) },
        timed!("ns/draw", |times| Some(times.ns_per_draw.median)),
        timed!("least", |times| Some(times.ns_per_draw.least)),
        timed!("most", |times| Some(times.ns_per_draw.most)),
        timed!("ns/lookup", |times| times.ns_per_lookup),
        timed!("s to 1e-3", |times| Some(times.seconds_to?[1])),
        timed!("1/Vt", |times| times.efficiency),
        Column { title: "1/VN", cell: Cell::Number(|(_, row)| row.fom) },
        timed!("speedup", |times| Some(times.speedup.median)),
        timed!("scaling", |times| Some(times.scaling?.median)),
        Column { title: "note", cell: Cell::Text(|(_, row)| row.reason.clone()) },
    ]
}

/// Returns σ̂ and the swept value.
fn sampling((_, row): &Joined) -> String {
    let (constant, swept) = (row.sampling(), row.id.swept_value());
    let numbers = [constant, swept.filter(|_| swept != constant)];
    let numbers = numbers.into_iter().flatten().map(|x| fixed(x, 4));
    let kind = Some(row.id.sampling.kind.clone()).filter(|_| constant.is_none());
    kind.into_iter().chain(numbers).filter(|word| !word.is_empty()).collect::<Vec<_>>().join(", ")
}

/// Returns the bench as a page of HTML.
///
/// # Errors
///
/// A plot cannot be drawn.
pub fn text(bench: &Bench) -> Result<String, ReportError> {
    let rows: Vec<Joined> =
        bench.cases.iter().flat_map(|case| case.rows.iter().map(move |row| (case, row))).collect();
    let plots = files::plotted(bench).enumerate().map(|(place, case)| {
        let label = format!("{}: measured error against time and against lookups", case.name);
        Ok(vec![plot(format!("error-{place}"), label, &files::plot::figure(bench, case)?)])
    });
    let plots: Vec<Vec<Plot>> = plots.collect::<Result<_, ReportError>>()?;
    let is_worse = bench.comparison.as_ref().is_some_and(Comparison::fails);
    let timed = rows.iter().filter(|(_, row)| row.is_first && row.times.is_some()).count();
    let line = if is_worse {
        "fail: something became slower than the baseline".to_owned()
    } else {
        format!("{timed} experiments timed")
    };
    let choices = [("group", rows.iter().map(|(case, _)| case.name.clone()).collect())];
    let body = html! {
        (definitions(&plots))
        header class={ "run " (if is_worse { "fail" } else { "pass" }) } {
            p.tool { "Trueflight " (bench.version) ", run time against error" }
            h1 { (line) }
            dl.facts { @for (name, value) in facts(bench) { div { dt { (name) } dd { (value) } } } }
        }
        @if let Some(comparison) = &bench.comparison { (changes(comparison)) }
        section aria-labelledby="experiments" {
            h2 #experiments { "Experiments" }
            (listing::form(&choices, rows.len()))
            (table(&columns(), &rows, |_| "", |(case, _)| case.name.clone()))
        }
        section aria-labelledby="errors" {
            h2 #errors { "Error against time and lookups" }
            @for plot in plots.iter().flatten() { (plot.show()) }
        }
    };
    Ok(page::document(&format!("Trueflight: {line}"), &body))
}

fn facts(bench: &Bench) -> Vec<(&'static str, String)> {
    let conditions = &bench.conditions;
    let mut facts = vec![
        ("Rounds", format!("{} of {} draws", bench.rounds, count(bench.draws))),
        ("Seed", bench.seed.to_string()),
        ("Machine", format!("{}, threads: {}", conditions.level, conditions.threads)),
        ("Times are", format!("{} time", conditions.clock.word())),
        ("Time of the bench", time(conditions.seconds)),
    ];
    facts.extend(conditions.speedup.map(|speedup| {
        let [median, least, most] =
            [speedup.median, speedup.least, speedup.most].map(|x| fixed(x, 3));
        ("Speedup over the plain loop", format!("{median}, from {least} to {most}"))
    }));
    facts
}

fn changes(comparison: &Comparison) -> Markup {
    html! {
        section aria-labelledby="changes" {
            h2 #changes { "Since baseline " (comparison.name) }
            ul { @for (is_worse, line) in files::diff::all(comparison) {
                li {
                    span class={ "verdict " (if is_worse { "fail" } else { "pass" }) } {
                        (if is_worse { "↑ slower" } else { "↓ faster" })
                    }
                    " " (line)
                }
            } }
            ul { @for remark in files::diff::remarks(comparison) { li { (remark) } } }
        }
    }
}
