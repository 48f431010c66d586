//! `report.html` of a bench: times of all experiments, decrease of their errors, changes.

use crate::report::html::template::html;

use super as files;
use super::tables::BenchEntry;
use crate::bench::record::Bench;
use crate::bench::stored::BenchComparison;
use crate::report::ReportError;
use crate::report::fields::{Shown, shown};
use crate::report::html as shared;
use crate::report::html::drawing::{Plot, definitions, plot};
use crate::report::html::listing::{page, section};
use numeric::digits::{count, fixed, time};

/// Columns of the page, beside the case.
const COLUMNS: &[Shown] = shown!(BenchEntry:
    "estimator", "sampling", "sampling_kind", "swept", "control", "channel", "ns_per_draw", "ns_per_draw_least",
    "ns_per_draw_most", "ns_per_lookup", "seconds_to_1e-3", "efficiency", "fom", "speedup", "scaling", "reason"
);

/// Returns the bench as a page of HTML.
pub fn text(bench: &Bench) -> Result<String, ReportError> {
    let rows: Vec<_> = files::tables::joined(bench).collect();
    let plots = files::plotted(bench).enumerate().map(|(place, case)| {
        let label = format!("{}: measured error against time and against lookups", case.name);
        Ok(vec![plot(format!("error-{place}"), label, &files::plot::figure(bench, case)?)])
    });
    let plots: Vec<Vec<Plot>> = plots.collect::<Result<_, ReportError>>()?;
    let is_worse = bench.comparison.as_ref().is_some_and(BenchComparison::fails);
    let timed = rows.iter().filter(|one| one.row.is_first && one.row.times.is_some()).count();
    let line = if is_worse {
        "fail: something became slower than the baseline".to_owned()
    } else {
        format!("{timed} experiments timed")
    };
    let sections = html! {
        (definitions(&plots))
        @if let Some(comparison) = &bench.comparison { (files::diff::changes(comparison).section()) }
        (section("Experiments", "case", |one| ("", one.case.name.clone()), COLUMNS, &rows, |one| one.case.name.clone()))
        section aria-labelledby="errors" {
            h2 #errors { "Error against time and lookups" }
            @for plot in plots.iter().flatten() { (plot.show()) }
        }
    };
    let class = if is_worse { "fail" } else { "pass" };
    Ok(page("run time against error", (class, &line), &shared::facts(facts(bench)), &sections))
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
