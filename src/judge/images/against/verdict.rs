//! What is said of two stacks, and in which order.

use super::super::judgement::{Comparison, Judgement, Tile};
use super::super::verdict::{bias, excluded, off, place};
use super::SHARES;
use gate::stats::verdict::Verdict;
use numeric::digits::short;

/// The verdict of the whole; `differing` is how many tiles differ by the test of equal distributions alone.
pub(super) fn decide(judgement: &mut Judgement, differing: usize) {
    let Some(comparison) = judgement.comparison.clone() else { return };
    (judgement.verdict, judgement.reason) = said(judgement, &comparison, differing);
    judgement.guarantees = guarantees(judgement, &comparison);
}

fn said(judgement: &Judgement, comparison: &Comparison, differing: usize) -> (Verdict, String) {
    if let Some(refuted) = judgement.refuted_by {
        let (pass, row, column, value) = (refuted.pass, refuted.row, refuted.column, refuted.value);
        let count = judgement.refuting;
        return (
            Verdict::Fail,
            format!(
                "numeric: pass {pass}, row {row}, column {column} is {value}, all counted from 0; values like that: {count}"
            ),
        );
    }
    if judgement.order.is_refuted() {
        let reason = format!("{}; the means are not judged", judgement.order.reason);
        return (Verdict::Inconclusive, reason);
    }
    let mut failing = Vec::new();
    let spread = comparison
        .spread
        .map_or("differently".to_owned(), |x| format!("{} times as wide", short(x, 4)));
    if comparison.is_same_law && comparison.spread_p <= SHARES[1] * judgement.alpha {
        let p = short(comparison.spread_p, 2);
        failing.push(format!(
            "the variance is off: the passes spread {spread} as those of the reference (p = {p})"
        ));
    }
    for whole in judgement.whole.iter().filter(|whole| whole.verdict == Verdict::Fail) {
        failing.push(format!("the picture is off: {}", off(judgement, whole)));
    }
    if judgement.counts.fail > 0 {
        let (fail, tiles) = (judgement.counts.fail, judgement.counts.tiles);
        let size = |tile: &&Tile| tile.z.map_or(0.0, f64::abs);
        let failed = judgement.tiles.iter().filter(|tile| tile.verdict == Verdict::Fail);
        let worst = failed.max_by(|a, b| size(a).total_cmp(&size(b)));
        let worst = worst.map_or(String::new(), |worst| {
            format!("; the worst, {}: {}", place(judgement, worst), off(judgement, worst))
        });
        failing.push(format!("{fail} of {tiles} tiles are off{worst}"));
    }
    if !failing.is_empty() {
        return (Verdict::Fail, failing.join("; "));
    }
    let open = open(judgement, comparison, differing);
    if open.is_empty() {
        (Verdict::Pass, excluded(judgement))
    } else {
        (Verdict::Inconclusive, open.join("; "))
    }
}

fn open(judgement: &Judgement, comparison: &Comparison, differing: usize) -> Vec<String> {
    let mut open = Vec::new();
    if differing > 0 {
        let p = short(comparison.p, 2);
        let (why, cure) = if judgement.neighbours.is_refuted() {
            (
                "pixels depend on each other, so that nothing follows for means of different laws",
                "judge averages of blocks wider than the filter by --average N",
            )
        } else {
            (
                "with the kurtosis of these values it may be the shape of the law and not its mean",
                "render more passes",
            )
        };
        let all = judgement.tiles.len() + judgement.whole.len();
        open.push(format!(
            "the stacks have different laws in {differing} of {all} tiles and wholes (p = {p}), but {why}; {cure}, or claim by \
             --same-law that both renderers have one law in each pixel"
        ));
    }
    if comparison.method == "none" {
        open.push(
            "the passes are too few to be exchanged, and pixels depend on each other; render 8 passes or more of each stack"
                .to_owned(),
        );
    }
    let undecided = |tile: &&Tile| tile.verdict != Verdict::Pass;
    if let Some(whole) = judgement.whole.iter().find(undecided) {
        open.push(format!("the picture may be off {}; render more passes", bias(whole)));
    }
    let count = judgement.tiles.iter().filter(undecided).count();
    if let Some(tile) = judgement.tiles.iter().find(undecided) {
        open.push(format!(
            "{count} of {} tiles may be off, the first, {}, {}; render more passes, or give a larger --tile or a wider \
             --tolerance",
            judgement.counts.tiles,
            place(judgement, tile),
            bias(tile)
        ));
    }
    open
}

fn guarantees(judgement: &Judgement, comparison: &Comparison) -> Vec<String> {
    let alpha = judgement.alpha;
    let pixels = if comparison.method == "signs" { ", and pixels are independent," } else { "" };
    let mut said = vec![format!(
        "if both stacks have one law in every pixel{pixels} they fail with chance {alpha} at most: exact, for any law and \
         number of passes"
    )];
    if !comparison.is_same_law {
        let kurtosis = comparison
            .kurtosis
            .map_or(String::new(), |k| format!(" ({} as measured)", short(k, 3)));
        said.push(format!(
            "if only their means are equal the level {alpha} is nominal: it assumes independent pixels and that no tile has a \
             larger kurtosis than these passes show{kurtosis}; rare values that neither stack drew may carry a mean"
        ));
    }
    said.push(format!(
        "a picture, or a tile, that is off by its tolerance passes with chance {} at most: nominal, by averages that are near \
         normal",
        judgement.beta
    ));
    if judgement.neighbours.is_refuted() {
        said.push(format!("{}: averages of whole passes are judged", judgement.neighbours.reason));
    }
    if !judgement.order.is_tested {
        said.push(
            "the passes are too few to see whether each depends on the one before".to_owned(),
        );
    }
    said
}
