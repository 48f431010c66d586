//! Cards of checks that fail or are inconclusive, one for each check of an estimator, with the measured values over those
//! of theory.

use crate::report::html::template::{Markup, html};
use plotters::style::RGBAColor;

use crate::record::{Compared, Record, Row, Score, Verdict};
use crate::report::html as page;
use crate::report::html::drawing;
use crate::report::html::words;
use crate::report::lists::grouped;
use crate::report::plots::style::{GREY, Marker, ink};
use crate::report::plots::{Axis, Panel};
use crate::report::run::failures::{self, Failure, failing};
use ::drawing::Sheet;
use gate::deviation::signed_percent;

/// Maximum number of cards; the table has all failures.
const MAX_CARDS: usize = 12;

/// Returns the cards of a verdict.
pub fn section(record: &Record, verdict: Verdict, title: &str) -> Markup {
    let groups = grouped(failing(record, verdict), |one, other| key(one) == key(other));
    html! {
        @if !groups.is_empty() {
            section.failing aria-labelledby=(verdict.word()) {
                h2 #(verdict.word()) { (title) }
                div.cards { @for group in groups.iter().take(MAX_CARDS) { (card(group)) } }
                (words::more(groups.len(), MAX_CARDS))
            }
        }
    }
}

/// Returns what the failures of a group share: case, estimator, check.
fn key<'a>(one: &Failure<'a>) -> [&'a str; 3] {
    [&one.row.case.name, &one.row.experiment.label, one.check_name()]
}

/// Returns the card of failures of one check of an estimator of a case.
fn card(failures: &[Failure]) -> Markup {
    let first = &failures[0];
    let (row, check) = (first.row, first.check_name());
    let others = failures.len() - 1;
    let label = format!("{}, {}: measured over theory", row.case.name, first.experiment());
    html! {
        article {
            h3 {
                span.quiet { (row.case.name) } " "
                a href={ "#" (words::anchor(&row)) } { (first.experiment()) }
            }
            p {
                @if !check.is_empty() { b { (check) } ": " }
                (first.reason()) " (" (first.place()) ")"
                @if others > 0 { span.quiet { ", and " (others) " more of this estimator" } }
            }
            @if let Some(sheet) = figure(first) { (drawing::inline(&sheet, &label)) }
            (page::command(row.next_command()))
            (page::causes(&failures::causes(&row)))
        }
    }
}

const PASS: RGBAColor = ink(0x17, 0x80, 0x4A);
const FAIL: RGBAColor = ink(0xB3, 0x12, 0x1D);

/// Returns the plot: along the sweep the points of the estimator, else all experiments of the case side by side. `None`
/// without at least one measured value.
fn figure(failure: &Failure) -> Option<Sheet> {
    let row = failure.row;
    let of_check = |score: &Score| Some(score.check()) == failure.check();
    let score = Score::ALL.into_iter().find(of_check).unwrap_or(Score::Mean);
    let name = score.quantity();
    let along = row.experiment.swept().and(row.case.sweep.as_ref());
    let is_shown = |other: &Row| {
        let is_own = other.experiment.listed == row.experiment.listed;
        other.channel == row.channel && (is_own || along.is_none())
    };
    let mut points: Vec<(f64, Row, [f64; 2])> = Vec::new();
    for (place, other) in row.case.rows().filter(is_shown).enumerate() {
        let Compared { measured: Some(measured), deviation, theory: Some(theory), .. } =
            other.compared(score)
        else {
            continue;
        };
        let x = if along.is_some() { other.experiment.swept() } else { Some((place + 1) as f64) };
        let point = [measured / theory, 2.0 * deviation.unwrap_or(0.0) / theory.abs()];
        if let Some(x) = x.filter(|_| point.iter().all(|v| v.is_finite())) {
            points.push((x, other, point));
        }
    }
    if points.is_empty() {
        return None;
    }
    let ends = points.iter().flat_map(|(_, _, [ratio, bar])| [ratio - bar, ratio + bar]);
    let y = Axis::around("measured / theory", false, 0.1, ends.chain([1.0]));
    let (title, log) =
        along.map_or(("experiments of the case", false), |s| (s.axis.as_str(), s.log));
    let x = Axis::around(title, log, 0.06, points.iter().map(|point| point.0));
    let mut sheet = Sheet::new(580.0, 250.0);
    let panel = Panel { left: 92.0, top: 28.0, right: 566.0, bottom: 196.0, x, y };
    panel.grid(&mut sheet);
    panel.line(&mut sheet, [panel.x.low, panel.x.high].map(|x| (x, 1.0)), (&[], 1.6, GREY));
    for (x, other, [ratio, bar]) in points {
        let Some(spot) = panel.spot(x, ratio) else { continue };
        let (marker, colour) = match other.verdict {
            Some(Verdict::Fail) => (Marker::Cross, FAIL),
            Some(Verdict::Pass) => (Marker::Disc, PASS),
            _ => (Marker::Diamond, GREY),
        };
        panel.bar(&mut sheet, spot[0], [ratio - bar, ratio, ratio + bar], (4.5, 1.4, colour));
        panel.point(&mut sheet, spot, marker, 5.0, colour);
        sheet.tip(spot, tip(&other, score, ratio));
    }
    panel.frame(&mut sheet, &format!("{name}: measured over theory, bars of two standard errors"));
    Some(sheet)
}

fn tip(row: &Row, score: Score, ratio: f64) -> String {
    let Compared { measured, deviation, theory, .. } = row.compared(score);
    let [measured, deviation, theory] =
        [(measured, 6), (deviation, 2), (theory, 6)].map(|(x, digits)| words::number(x, digits));
    let (off, word, name) =
        (signed_percent(ratio - 1.0), words::word(row.verdict), score.quantity());
    format!("{}: {word}; {name} {measured} ± {deviation}, theory {theory} ({off})", row.name())
}
