//! Table of a bench on the screen: one block per case, then a summary.

use std::fmt::Write;

use super::diff;
use super::tables::BenchEntry;
use crate::bench::record::{Bench, BenchCase, BenchRow, Conditions};
use crate::plan::Plan;
use crate::report::fields::{Shown, grid, shown};
use crate::report::layout::{Column, Paint, Pen, end_elided};
use crate::report::lists::grouped;
use crate::report::run::console::subjects;
use crate::report::run::console::views::swept_apart;
use numeric::digits::{count, counted, fixed, short};

/// Columns, each with its rank.
const COLUMNS: &[Shown] = shown!(BenchEntry:
    "estimator", "sampling_marked" 1, "control" 5, "channel" 1, "ns_per_draw" 1, "ns_per_draw_range" 6,
    "draws_per_second" 7, "ns_per_lookup" 4, "seconds_to_1e-2" 3, "seconds_to_1e-3" 2, "seconds_to_1e-4" 3,
    "efficiency" 4, "ttuv" 8, "fom" 5, "speedup" 1, "speedup_range" 6, "scaling" 2
);

/// Returns the table, `width` columns wide, with ANSI colours if asked for.
pub fn table(bench: &Bench, pen: Pen) -> String {
    let mut text = String::new();
    for case in &bench.cases {
        block(&mut text, pen, bench, case);
        text.push('\n');
    }
    closing(&mut text, pen, bench);
    text
}

fn block(text: &mut String, pen: Pen, bench: &Bench, case: &BenchCase) {
    pen.heading(text, &case.name, &case.title);
    let facts = format!("{} · {}", case.problem, case.medium);
    let _ = writeln!(text, "{}", pen.paint(Paint::Dim, &end_elided(&facts, pen.width)));
    let rows: Vec<BenchEntry> =
        case.rows.iter().map(|row| BenchEntry { bench, case, row }).collect();
    let mut grid = grid(&rows, COLUMNS);
    if let Some(head) = swept_apart(case.swept) {
        let digits = case.digits();
        let text =
            |row: &BenchRow| row.id.swept_value().map(|x| digits.text(x)).unwrap_or_default();
        grid.columns.insert(2, Column::of(&case.rows, (head, true, 1), text));
    }
    grid.fit(pen.width);
    text.push_str(&grid.render(pen));
    notes(text, pen, case);
}

/// Adds the reasons why numbers are missing: each reason once, with its rows.
fn notes(text: &mut String, pen: Pen, case: &BenchCase) {
    let lacking = case.rows.iter().filter(|row| !row.reason.is_empty());
    let notes = grouped(lacking, |one, other| {
        one.reason == other.reason && one.id.label() == other.id.label()
    });
    for rows in notes {
        let (row, swept) = (rows[0], rows.iter().filter_map(|row| row.id.swept_value()));
        let mut places: Vec<String> = swept.map(|x| case.digits().text(x)).collect();
        places.dedup();
        let at =
            if places.is_empty() { String::new() } else { format!(" ({})", places.join(", ")) };
        let word = if row.is_refused { "refused" } else { "note" };
        let note = format!("{word} {}{at}: {}", row.id.label(), row.reason);
        pen.note(text, &note, ("", Paint::Plain));
    }
}

/// Returns the first line of a bench: what is timed.
pub fn opening(plan: &Plan, rounds: u32, draws: u64) -> String {
    let seed = plan.options.seed;
    let drawn = plan.experiments().filter(|(_, planned)| planned.outcome.is_ok()).count();
    let (cases, experiments) = (subjects(plan), counted(drawn as u64, "experiment"));
    let draws = counted(draws, "draw");
    format!("{cases}: {experiments}, {} of {draws}, seed {seed}\n", counted(rounds.into(), "round"))
}

/// Returns the meaning of the times, in a sentence.
pub fn meaning(bench: &Bench) -> String {
    let Conditions { level, threads, .. } = &bench.conditions;
    match &bench.comparison {
        Some(finding) if finding.fails() => {
            format!("fail: something became slower than baseline {}\n", finding.name)
        }
        Some(finding) if !finding.is_empty() => {
            format!("pass: nothing became slower than baseline {}\n", finding.name)
        }
        _ => format!(
            "Times hold for this machine ({level}, threads: {threads}); --save-baseline NAME keeps them to compare later ones with.\n"
        ),
    }
}

fn closing(text: &mut String, pen: Pen, bench: &Bench) {
    let conditions = &bench.conditions;
    let experiments = || bench.cases.iter().flat_map(BenchCase::experiments);
    let timed = experiments().filter(|row| row.times.is_some()).count();
    let refused = experiments().filter(|row| row.is_refused).count();
    let mut counts = format!("{timed} timed");
    if refused > 0 {
        let _ = write!(counts, " · {refused} refused");
    }
    let _ = writeln!(text, "{}", pen.paint(Paint::Bold, &counts));
    let mut facts = vec![
        format!("{} rounds of {} draws", bench.rounds, count(bench.draws)),
        format!("seed {}", bench.seed),
        format!("{} time", conditions.clock.word()),
        conditions.level.clone(),
        format!("{} s, threads: {}", short(conditions.seconds, 3), conditions.threads),
    ];
    if let Some(speedup) = conditions.speedup {
        let [median, least, most] =
            [speedup.median, speedup.least, speedup.most].map(|x| fixed(x, 3));
        facts.insert(
            0,
            format!("median speedup over the plain loop {median}, from {least} to {most}"),
        );
    }
    pen.say(text, Paint::Dim, &facts.join(" · "));
    if let Some(comparison) = &bench.comparison {
        diff::changes(comparison).write(text, pen);
    }
}
