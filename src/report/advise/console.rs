//! Table of the advice on the screen: a block for each group, the lines for a case, and what the advice rests on.

use std::fmt::Write;

use super::AdviceRow;
use crate::advise::{Advice, Group, Row, Target};
use crate::report::fields::{Shown, grid, shown};
use crate::report::layout::{Paint, Pen, end_elided};
use crate::report::lists::joined;
use numeric::digits::{fixed, percent, short, time};
use theory::prediction::search::MAX_FACTOR;

/// Columns, each with its rank, before and after the goal.
const FIRST: &[Shown] = shown!(AdviceRow: "rank_marked", "estimator", "sampling_marked");
const LAST: &[Shown] = shown!(AdviceRow:
    "control" 1, "relative_deviation" 3, "lookups_per_draw" 4, "setup" 7, "draws" 8, "margins" 2, "least_sampling" 6,
    "kurtosis" 7, "needs" 2
);

/// Columns of the goal: a time, another cost, or an error.
const GOALS: &[Shown] = shown!(AdviceRow: "time", "cost", "error_percent");

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
pub fn margins([low, high]: [f64; 2]) -> String {
    let low = if low > 0.0 { fixed(low, 2) } else { "0".to_owned() };
    let high = if high < MAX_FACTOR { fixed(high, 2) } else { "∞".to_owned() };
    format!("{low}–{high}")
}

/// Returns the problem, the medium and the goal.
pub fn facts(advice: &Advice) -> String {
    let goal = match (advice.target, advice.unit()) {
        (Target::Error(error), _) => format!("to a standard error of {}", percent(error)),
        (Target::Budget(budget), "s") => format!("within {}", time(budget)),
        (Target::Budget(budget), _) => format!("within {} lookups", short(budget, 4)),
    };
    let rays = (advice.rays > 1).then(|| format!("{} rays, each", advice.rays));
    joined([&*advice.problem, &advice.medium, &rays.unwrap_or_default(), &goal], " · ")
}

/// Returns the table.
pub fn table(advice: &Advice, pen: Pen) -> String {
    let mut text = String::new();
    pen.heading(&mut text, &advice.case, &advice.title);
    let _ = writeln!(text, "{}", pen.paint(Paint::Dim, &end_elided(&facts(advice), pen.width)));
    let mut dropped: Vec<&str> = Vec::new();
    for group in [Group::Ranked, Group::Bounded, Group::Informed] {
        let rows: Vec<AdviceRow> =
            super::joined(advice).filter(|of| of.row.group == group).collect();
        if rows.is_empty() {
            continue;
        }
        let words = match group {
            Group::Ranked => None,
            Group::Bounded => Some("with a variance that theory only bounds"),
            Group::Informed => Some("with knowledge from which the answer follows"),
        };
        if let Some(words) = words {
            let _ = writeln!(text, "{}", pen.paint(Paint::Dim, words));
        }
        let goal = match (advice.target, advice.unit()) {
            (Target::Error(_), "s") => GOALS[0],
            (Target::Error(_), _) => GOALS[1],
            (Target::Budget(_), _) => GOALS[2],
        };
        let mut grid = grid(&rows, &[FIRST, &[goal], LAST].concat());
        dropped.extend(grid.fit(pen.width));
        text.push_str(&grid.render(pen));
    }
    dropped.sort_unstable();
    dropped.dedup();
    let narrow = format!("left out on a console this narrow: {}", dropped.join(", "));
    for note in notes(advice).into_iter().chain((!dropped.is_empty()).then_some(narrow)) {
        pen.note(&mut text, &note, ("", Paint::Plain));
    }
    if let Some(best) = advice.best() {
        let _ = writeln!(text, "\n{}", pen.paint(Paint::Bold, "advice: put into the case"));
        for line in best.lines.lines() {
            let _ = writeln!(text, "  {}", pen.paint(Paint::Cyan, line));
        }
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
    notes.extend(advice.warning.clone());
    notes
}
