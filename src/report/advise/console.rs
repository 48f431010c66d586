//! Table of the advice on the screen: a block for each group, the lines for a case, and what the advice rests on.

use std::fmt::Write;

use crate::advise::search::WIDEST;
use crate::advise::{Advice, Group, Row, Target};
use crate::report::layout::{Grid, Paint, Pen, Spec, end_elided};
use numeric::digits::{fixed, percent, short, time};

const COLUMNS: &[Spec<Row>] = &[
    ("", true, 0, rank),
    ("estimator", false, 0, |row| row.estimator.clone()),
    ("σ\u{302}", true, 1, sampling),
    ("control", false, 5, |row| row.control.clone()),
    ("s.d./T", true, 3, |row| fixed(row.deviation, 3)),
    ("lookups", true, 4, |row| fixed(row.lookups, 3)),
    ("setup", true, 7, |row| {
        if row.setup_lookups > 0.0 { short(row.setup_lookups, 3) } else { String::new() }
    }),
    ("draws", true, 8, |row| short(row.draws, 2)),
    ("σ\u{302} ×", true, 2, |row| row.margins.map(margins).unwrap_or_default()),
    ("least σ\u{302}", true, 6, |row| row.least.map(|least| short(least, 3)).unwrap_or_default()),
    ("kurtosis", true, 7, |row| {
        row.kurtosis.map(|kurtosis| short(kurtosis, 3)).unwrap_or_default()
    }),
    ("needs", false, 2, |row| row.needs.clone()),
];

/// Place of the column of the goal.
const GOAL: usize = 3;

/// Returns the rank, with a mark of a tie.
pub fn rank(row: &Row) -> String {
    format!("{}{}", if row.is_tie { "=" } else { "" }, row.rank)
}

/// Returns σ̂ in words.
pub fn sampling(row: &Row) -> String {
    match (row.constant, row.factor) {
        (Some(value), _) => short(value, 4),
        (_, Some(factor)) => format!("{} × {}", short(factor, 4), row.sampling),
        (_, None) => row.sampling.clone(),
    }
}

/// Returns the range of factors on σ̂ within which the cost stays below its double.
fn margins([low, high]: [f64; 2]) -> String {
    let low = if low > 0.0 { fixed(low, 2) } else { "0".to_owned() };
    let high = if high < WIDEST { fixed(high, 2) } else { "∞".to_owned() };
    format!("{low}–{high}")
}

/// Returns the problem, the medium and the goal.
pub fn facts(advice: &Advice) -> String {
    let goal = match (advice.target, advice.unit()) {
        (Target::Error(error), _) => format!("to a standard error of {}", percent(error)),
        (Target::Budget(budget), "s") => format!("within {}", time(budget)),
        (Target::Budget(budget), _) => format!("within {} lookups", short(budget, 4)),
    };
    let rays = format!("{} rays, each", advice.rays);
    let rays = Some(rays).filter(|_| advice.rays > 1);
    let words = [Some(advice.problem.clone()), Some(advice.medium.clone()), rays, Some(goal)];
    words.into_iter().flatten().collect::<Vec<_>>().join(" · ")
}

/// Returns the table.
pub fn table(advice: &Advice, pen: Pen) -> String {
    let mut text = String::new();
    pen.heading(&mut text, &advice.case, &advice.title);
    let _ = writeln!(text, "{}", pen.paint(Paint::Dim, &end_elided(&facts(advice), pen.width)));
    for group in [Group::Ranked, Group::Bounded, Group::Informed] {
        let rows: Vec<Row> = advice.rows.iter().filter(|row| row.group == group).cloned().collect();
        if rows.is_empty() {
            continue;
        }
        let words = match group {
            Group::Ranked => "",
            Group::Bounded => "with a variance that theory only bounds",
            Group::Informed => "with knowledge from which the answer follows",
        };
        if !words.is_empty() {
            let _ = writeln!(text, "{}", pen.paint(Paint::Dim, words));
        }
        let spec: Spec<Row> = match (advice.target, advice.unit()) {
            (Target::Error(_), "s") => ("time", true, 0, |row| time(row.time)),
            (Target::Error(_), _) => ("cost", true, 0, |row| short(row.time, 3)),
            (Target::Budget(_), _) => ("error", true, 0, |row| percent(row.error)),
        };
        let mut grid = Grid::of(&rows, COLUMNS);
        grid.columns.splice(GOAL..GOAL, Grid::of(&rows, &[spec]).columns);
        grid.fit(pen.width);
        text.push_str(&grid.render(pen));
    }
    if let Some(best) = advice.best() {
        let _ = writeln!(text, "\n{}", pen.paint(Paint::Bold, "advice: put into the case"));
        for line in best.lines.lines() {
            let _ = writeln!(text, "  {}", pen.paint(Paint::Cyan, line));
        }
    }
    for note in notes(advice) {
        pen.note(&mut text, &note, ("", Paint::Plain));
    }
    text
}

/// Returns what the advice rests on and what it leaves open, a sentence each.
pub fn notes(advice: &Advice) -> Vec<String> {
    let mut notes = Vec::new();
    if let Some(best) = advice.best() {
        if !best.kind.words().is_empty() {
            notes.push(format!("σ\u{302} of the advice: {}", best.kind.words()));
        }
        let ties =
            advice.rows.iter().filter(|row| row.rank == 1 && row.group == best.group).count();
        if ties > 1 {
            let error = percent(best.cost_error.max(1e-3));
            notes.push(format!("{ties} estimators are a tie: costs are known to {error}"));
        }
    }
    notes.extend(advice.profiles.iter().map(|profile| {
        let local =
            profile.over_local.map(|gain| format!(", {} over local majorants", short(gain, 3)));
        let (gain, name) = (short(profile.over_constant, 3), &profile.estimator);
        format!(
            "the best σ\u{302}(t) of {name} gains a factor of {gain} over the best constant{}",
            local.unwrap_or_default()
        )
    }));
    let refused = advice.refused.iter();
    notes.extend(refused.map(|refused| format!("no {}: {}", refused.estimator, refused.reason)));
    notes
}
