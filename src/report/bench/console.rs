//! Table of a bench on the screen: one block per case, then a summary.

use std::fmt::Write;

use super::diff;
use crate::bench::record::{Bench, BenchCase, BenchRow, Spread, Times};
use crate::record::Digits;
use crate::report::layout::{Column, Grid, Paint, Pen, Spec, end_elided, wrapped};
use crate::report::run::console::views::swept_apart;
use numeric::digits::{count, fixed, short, time};

/// Heading of σ̂; constant ones have as many digits as distinguish them.
const SAMPLING: &str = "σ\u{302}";

const COLUMNS: &[Spec<BenchRow>] = &[
    ("estimator", false, 0, |row| row.id.label()),
    (SAMPLING, true, 1, |row| row.id.sampling.kind.clone()),
    ("control", false, 5, |row| row.id.control.clone()),
    ("channel", false, 1, |row| row.channel.clone()),
    ("ns/draw", true, 1, |row| {
        spread(row, |times| Some(times.ns_per_draw), |s| fixed(s.median, 3))
    }),
    ("least–most", true, 6, |row| spread(row, |times| Some(times.ns_per_draw), range)),
    ("draws/s", true, 7, |row| figure(row, |times| Some(fixed(times.draws_per_second, 3)))),
    ("ns/lookup", true, 4, |row| figure(row, |times| Some(fixed(times.ns_per_lookup?, 3)))),
    ("to 1e-2", true, 3, |row| figure(row, |times| Some(time(times.seconds_to?[0])))),
    ("to 1e-3", true, 2, |row| figure(row, |times| Some(time(times.seconds_to?[1])))),
    ("to 1e-4", true, 3, |row| figure(row, |times| Some(time(times.seconds_to?[2])))),
    ("1/Vt", true, 4, |row| figure(row, |times| Some(fixed(times.efficiency?, 3)))),
    ("Vt", true, 8, |row| figure(row, |times| Some(time(times.ttuv()?)))),
    ("1/VN", true, 5, |row| row.fom.map(|fom| fixed(fom, 3)).unwrap_or_default()),
    ("speedup", true, 1, |row| spread(row, |times| Some(times.speedup), |s| fixed(s.median, 3))),
    ("least–most", true, 6, |row| spread(row, |times| Some(times.speedup), range)),
    ("scaling", true, 2, |row| spread(row, |times| times.scaling, |s| fixed(s.median, 3))),
];

fn figure(row: &BenchRow, text: impl Fn(&Times) -> Option<String>) -> String {
    row.times.as_ref().and_then(text).unwrap_or_default()
}

fn spread(row: &BenchRow, of: fn(&Times) -> Option<Spread>, text: fn(Spread) -> String) -> String {
    figure(row, |times| of(times).map(text))
}

/// Returns the minimum and the maximum of the rounds.
fn range(spread: Spread) -> String {
    format!("{}–{}", fixed(spread.least, 3), fixed(spread.most, 3))
}

/// Returns the table, `width` columns wide, with ANSI colours if asked for.
pub fn table(bench: &Bench, pen: Pen) -> String {
    let mut text = String::new();
    for case in &bench.cases {
        block(&mut text, pen, case);
        text.push('\n');
    }
    closing(&mut text, pen, bench);
    text
}

fn block(text: &mut String, pen: Pen, case: &BenchCase) {
    pen.heading(text, &case.name, &case.title);
    let facts = format!("{} · {}", case.problem, case.medium);
    let _ = writeln!(text, "{}", pen.paint(Paint::Dim, &end_elided(&facts, pen.width)));
    let labels = labels(case);
    let mut grid = Grid::of(&case.rows, COLUMNS);
    let sampling = grid.columns.iter_mut().find(|column| column.head == SAMPLING);
    for (field, row) in
        sampling.into_iter().flat_map(|column| column.fields.iter_mut().zip(&case.rows))
    {
        if let Some(sampling) = row.sampling() {
            field.text = labels.text(sampling);
        }
    }
    if let Some(head) = swept_apart(case.swept.as_deref()) {
        let text =
            |row: &BenchRow| row.id.swept_value().map(|x| labels.text(x)).unwrap_or_default();
        grid.columns.insert(2, Column::of(&case.rows, (head, true, 1), text));
    }
    grid.fit(pen.width);
    text.push_str(&grid.render(pen));
    notes(text, pen, case);
}

/// Returns the digits of σ̂ and swept values of a case.
pub(super) fn labels(case: &BenchCase) -> Digits {
    Digits::new(case.rows.iter().flat_map(|row| [row.sampling(), row.id.swept_value()]))
}

/// Adds the reasons why numbers are missing: each reason once, with its rows.
fn notes(text: &mut String, pen: Pen, case: &BenchCase) {
    let mut notes: Vec<(&BenchRow, Vec<String>)> = Vec::new();
    for row in case.rows.iter().filter(|row| !row.reason.is_empty()) {
        let place = row.id.swept_value().map(|x| labels(case).text(x));
        let same = |note: &&mut (&BenchRow, Vec<String>)| {
            note.0.reason == row.reason && note.0.id.label() == row.id.label()
        };
        match notes.iter_mut().find(same) {
            Some(note) => note.1.extend(place),
            None => notes.push((row, place.into_iter().collect())),
        }
    }
    for (row, mut places) in notes {
        places.dedup();
        let at =
            if places.is_empty() { String::new() } else { format!(" ({})", places.join(", ")) };
        let word = if row.is_refused { "refused" } else { "note" };
        let note = format!("{word} {}{at}: {}", row.id.label(), row.reason);
        pen.note(text, &note, ("", Paint::Plain));
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
    let Some(comparison) = &bench.comparison else { return };
    text.push('\n');
    for (is_worse, line) in diff::all(comparison) {
        let (word, paint) =
            if is_worse { ("REGRESSION", Paint::Red) } else { ("improvement", Paint::Green) };
        for (i, line) in wrapped(&line, pen.width.saturating_sub(14)).into_iter().enumerate() {
            let head = if i == 0 { pen.paint(paint, word) } else { "   ".to_owned() };
            let _ = writeln!(text, "  {head} {line}");
        }
    }
    for remark in diff::remarks(comparison) {
        pen.say(text, Paint::Dim, &remark);
    }
}
