//! Verdicts on one stack and on two, with their reasons; the order of the reasons is that of a session.

use super::claim::{Claim, Pixels};
use super::judgement::{ComparisonMethod, Judgement, Refuted, StackComparison, Tile};
use super::picture::Stack;
use super::promises::{guarantees, guarantees_against};
use crate::{Reasons, SIDE_SHARE};
use gate::deviation::{Deviation, DrawUnit, signed_percent};
use gate::stats::verdict::Verdict;
use numeric::digits::{enough, percent, short};

/// Relative difference from the number of passes of the factor by which a variance is too small, for which it is taken for
/// the variance of their mean.
const OF_MEAN: f64 = 0.1;

/// Decides about a stack, and adds the promises of the verdict.
pub(super) fn decide(judgement: &mut Judgement, stack: &Stack, pixels: &Pixels, claim: &Claim) {
    let refuted = judgement.refuted_by;
    let refuted = refuted.map(|refuted| fault(judgement, refuted, pixels));
    let mut failing: Vec<String> = too_small(judgement).into_iter().collect();
    // If the variance is refuted, no tile fails by it; the tile that stands out may show the cause.
    let strange = furthest(judgement.tiles.iter());
    let is_small = !failing.is_empty();
    if let Some(shown) = judgement.shown.as_ref().filter(|_| is_small) {
        failing.insert(
            0,
            format!(
                "the mean{} is plainly off by {}",
                in_channel(judgement, shown),
                by_itself(judgement, shown)
            ),
        );
        failing.push(format!(
            "of pixels that are hit or missed the variance moves with the mean; the mean is not judged by that variance{}",
            ranged(claim)
        ));
    } else if let Some(tile) = strange.filter(|_| judgement.counts.fail == 0 && is_small) {
        failing.push(format!(
            "what stands out most, {}: {} (not judged by that variance{})",
            place(judgement, tile),
            off(judgement, tile),
            ranged(claim)
        ));
    }
    failing.extend(means_off(judgement, judgement.worst.first()));
    let open = open(judgement, claim, is_flat(stack));
    finish(judgement, Reasons { refuted, failing, open, ..Reasons::default() });
    judgement.guarantees = guarantees(judgement, claim);
}

/// Decides about two stacks, and adds the promises of the verdict. `differing` is the number of tiles that differ by
/// the test of equal distributions alone.
pub(super) fn decide_against(
    judgement: &mut Judgement,
    comparison: &StackComparison,
    differing: usize,
) {
    let refuted = judgement.refuted_by.map(|refuted| {
        let Refuted { pass, row, column, value, .. } = refuted;
        let count = judgement.refuting;
        format!(
            "numeric: pass {pass}, row {row}, column {column} is {value}, all counted from 0; values like that: {count}"
        )
    });
    let mut failing = Vec::new();
    if comparison.is_same_distribution && comparison.spread_p <= SIDE_SHARE * judgement.alpha {
        let times = |x| format!("is {} times", short(x, 4));
        let spread = comparison.spread.map_or("differs from".to_owned(), times);
        let p = short(comparison.spread_p, 2);
        failing.push(format!(
            "the variance is off: that of the passes {spread} that of the reference (p = {p})"
        ));
    }
    let failed = judgement.tiles.iter().filter(|tile| tile.verdict == Verdict::Fail);
    failing.extend(means_off(judgement, furthest(failed)));
    let open = open_against(judgement, comparison, differing);
    finish(judgement, Reasons { refuted, failing, open, ..Reasons::default() });
    judgement.guarantees = guarantees_against(judgement, comparison);
}

/// Sets the verdict and its reason.
fn finish(judgement: &mut Judgement, reasons: Reasons) {
    let order = &judgement.order;
    let not_judged = || format!("{}; the means are not judged", order.reason);
    let (dependent, passing) = (order.is_refuted().then(not_judged), excluded(judgement));
    let reasons = Reasons { dependent, passing, ..reasons };
    (judgement.verdict, judgement.reason) = reasons.verdict();
}

/// Returns the tile with the largest |z|.
fn furthest<'a>(tiles: impl Iterator<Item = &'a Tile>) -> Option<&'a Tile> {
    let size = |tile: &&Tile| tile.z.map_or(0.0, f64::abs);
    tiles.max_by(|a, b| size(a).total_cmp(&size(b)))
}

/// Returns the reason if the variance is refuted.
fn too_small(judgement: &Judgement) -> Option<String> {
    let variance = judgement.variance.filter(|variance| variance.is_refuted)?;
    let passes = judgement.passes as f64;
    let is_of_mean = passes > 2.0 && (variance.about_mean / passes - 1.0).abs() < OF_MEAN;
    Some(format!(
        "the variance is too small: the passes vary {:.3} times as much, {} (ln E = {:.1} ≥ {:.1}){}",
        variance.about_mean,
        signed_percent(variance.about_mean - 1.0),
        variance.ln_e,
        variance.limit,
        match judgement.estimate {
            Some(_) => "",
            None if is_of_mean =>
                "; that is the number of passes: give the variance of one pass, not that of their mean",
            None => "; if it was estimated from N other passes, say so by --variance-passes N",
        }
    ))
}

/// Returns the reasons by which means fail.
fn means_off(judgement: &Judgement, worst: Option<&Tile>) -> Vec<String> {
    let fails = |whole: &&Tile| whole.verdict == Verdict::Fail;
    let wholes: Vec<&Tile> = judgement.whole.iter().filter(fails).collect();
    let mut failing = match &*wholes {
        [] => Vec::new(),
        [whole] => vec![format!("the picture is off: {}", off(judgement, whole))],
        [first, ..] => {
            let maximum = furthest(wholes.iter().copied()).unwrap_or(first);
            let (count, channels) = (wholes.len(), judgement.size.channels);
            let maximum = off(judgement, maximum);
            vec![format!(
                "the picture is off in {count} of {channels} channels; the furthest: {maximum}"
            )]
        }
    };
    if judgement.counts.fail > 0 {
        let (fail, tiles) = (judgement.counts.fail, judgement.counts.tiles);
        let worst = worst.map_or(String::new(), |worst| {
            format!("; the worst, {}: {}", place(judgement, worst), off(judgement, worst))
        });
        failing.push(format!("{fail} of {tiles} tiles are off{worst}"));
    }
    if judgement.is_misplaced() {
        failing.extend(judgement.likely());
    }
    failing
}

/// Returns the reasons by which means are undecided.
fn means_open(judgement: &Judgement, is_flat: bool) -> Vec<String> {
    let (wholes, tiles) = (undecided(&judgement.whole), undecided(&judgement.tiles));
    let whole = wholes.first().map(|whole| {
        let more = more(judgement, &wholes);
        // Without it more passes are asked to exclude a smaller bias.
        let requested = whole
            .needed
            .and(whole.tolerance)
            .map(|tolerance| format!(" with --tolerance {}", short(tolerance, 3)));
        let requested = requested.unwrap_or_default();
        format!("the picture may be off {}; {more}{requested}", bias(whole))
    });
    let tile = tiles.first().map(|tile| {
        format!(
            "{} of {} tiles may be off, the first, {}, {}; {}, or give {}",
            tiles.len(),
            judgement.counts.tiles,
            place(judgement, tile),
            bias(tile),
            more(judgement, &tiles),
            larger(judgement)
        )
    });
    let constant =
        "if values never vary, as in an analog furnace, say so by --variance 0".to_owned();
    let constant = Some(constant).filter(|_| is_flat && (whole.is_some() || tile.is_some()));
    whole.into_iter().chain(tile).chain(constant).collect()
}

/// Returns the advice on a range by which a mean is judged whatever its variance is.
fn ranged(claim: &Claim) -> &'static str {
    match claim.range {
        None => "; give a range, too",
        Some([low, high]) if low.is_finite() && high.is_finite() => "",
        Some(_) => "; give a range with two finite ends",
    }
}

/// Returns the advice on the size of tiles: the smallest from which on all tiles pass, if there is one.
fn larger(judgement: &Judgement) -> String {
    let has_passed = |tiles: &[Tile]| tiles.iter().all(|tile| tile.verdict == Verdict::Pass);
    let longest = judgement.size.rows.max(judgement.size.columns);
    let sizes = judgement.tiles.chunk_by(|a, b| a.size == b.size).rev();
    let passing = sizes.take_while(|tiles| has_passed(tiles)).last().map(|tiles| tiles[0].size);
    match passing.or((judgement.tile < longest).then_some(longest)) {
        Some(size) if has_passed(&judgement.whole) => {
            format!("--tile {size}, with which these passes pass, or a wider --tolerance")
        }
        _ if judgement.tile == longest => "a wider --tolerance".to_owned(),
        _ => "a larger --tile or a wider --tolerance".to_owned(),
    }
}

/// Returns whether no value differs between passes.
fn is_flat(stack: &Stack) -> bool {
    (1..stack.passes).all(|pass| stack.pass(pass) == stack.pass(0))
}

fn undecided(tiles: &[Tile]) -> Vec<&Tile> {
    tiles.iter().filter(|tile| tile.verdict != Verdict::Pass).collect()
}

/// Returns the advice to render as many passes as decide all of these tiles, where their number is known.
fn more(judgement: &Judgement, undecided: &[&Tile]) -> String {
    let needed: Option<Vec<f64>> = undecided.iter().map(|tile| tile.needed).collect();
    let maximum = needed.map(|needed| needed.into_iter().fold(0.0, f64::max));
    maximum.map_or("render more passes".to_owned(), |maximum| {
        let passes = if maximum < 1e6 { maximum.to_string() } else { enough(maximum) };
        format!("render {passes} passes in place of {}", judgement.passes)
    })
}

/// Widest ε, in units of the picture's mean, of a pass without remark.
const WIDE: f64 = 0.05;

/// Returns remarks on a pass that excludes only a large bias: the widest ε of all tiles and of the whole.
fn excluded(judgement: &Judgement) -> Vec<String> {
    let widest =
        |tiles: &[Tile]| tiles.iter().filter_map(|tile| tile.tolerance).fold(0.0, f64::max);
    let (tile, whole) = (widest(&judgement.tiles), widest(&judgement.whole));
    let mut said = Vec::new();
    if tile.max(whole) > WIDE {
        let place = judgement.tiles.iter().find(|finding| finding.tolerance == Some(tile));
        let place = place
            .map_or(String::new(), |finding| format!(" ({})", self::place(judgement, finding)));
        said.push(format!(
            "but only a bias above {} of the picture's mean is excluded in every tile{place}, above {} in the whole; render \
             more passes or give a larger --tile to exclude a smaller bias",
            percent(tile),
            percent(whole)
        ));
    }
    let unknown = judgement.estimate.map_or(0, |finding| finding.unknown);
    if unknown > 0 {
        said.push(format!("{unknown} values without a variance are not judged"));
    }
    said
}

/// Returns the reasons why a picture that does not fail does not pass.
fn open(judgement: &Judgement, claim: &Claim, is_flat: bool) -> Vec<String> {
    let has_spread = judgement.whole.iter().any(|whole| whole.tolerance != Some(0.0));
    let has_variance = has_variance(claim);
    if !has_variance && claim.range.is_none() && claim.kurtosis.is_none() && has_spread {
        return vec![
            "what a pixel's values may be is not known: rare ones that were not drawn may carry the \
             mean; give --variance, --variance-image, --variance-stack, --kurtosis K or --range LOW,HIGH"
                .to_owned(),
        ];
    }
    if !has_variance && claim.range.is_none() && claim.truth_passes.is_some() {
        return vec![
            "how far the mean of the truth's passes is off is not known; give the variance of one pass by \
             --variance-image or --variance-stack"
                .to_owned(),
        ];
    }
    let is_endless = claim.range.is_some_and(|[low, high]| !(high - low).is_finite());
    if !has_variance && claim.kurtosis.is_none() && is_endless && has_spread {
        return vec![
            "nothing passes by a range with an infinite end: rare values that were not drawn may carry the \
             mean; give both ends, --variance or --variance-image"
                .to_owned(),
        ];
    }
    let mut open = Vec::new();
    if judgement.neighbours.is_refuted() && claim.range.is_none() {
        let rest = if judgement.tile == 1 { "" } else { ", or judge single pixels by --tile 1" };
        open.push(format!(
            "{}, so that averages of pixels have no known variance; render without a filter that \
             blends pixels, judge averages of blocks wider than the filter by --average N and --variance-stack, give \
             --range LOW,HIGH{rest}",
            judgement.neighbours.reason
        ));
    }
    if let Some(variance) =
        judgement.variance.filter(|variance| variance.about_mean > variance.margin)
    {
        open.push(format!(
            "the passes vary {:.3} times as much as the variance says",
            variance.about_mean
        ));
    }
    open.extend(too_large(judgement, claim));
    open.extend(judgement.shown.as_ref().map(|shown| looks_off(judgement, claim, shown)));
    open.extend(means_open(judgement, is_flat));
    open
}

/// Returns ε in words.
fn bias(tile: &Tile) -> String {
    tile.tolerance.map_or("by any amount".to_owned(), |tolerance| {
        format!("by {:.2} % of the picture's mean or more", 100.0 * tolerance)
    })
}

/// Returns the place of a tile in words.
fn place(judgement: &Judgement, tile: &Tile) -> String {
    let span = |what: &str, first: usize, count: usize| match count {
        1 => format!("{what} {first}"),
        _ => format!("{what}s {first} to {}", first + count - 1),
    };
    let rows = span("row", tile.row, tile.height);
    let columns = span("column", tile.column, tile.width);
    format!("{rows}, {columns}{}", channel(judgement, tile.channel))
}

/// Returns the channel in words; empty for pictures of one.
pub(super) fn channel(judgement: &Judgement, channel: usize) -> String {
    if judgement.size.channels > 1 { format!(", channel {channel}") } else { String::new() }
}

fn in_channel(judgement: &Judgement, tile: &Tile) -> String {
    channel(judgement, tile.channel).replacen(", ", " in ", 1)
}

fn deviation(judgement: &Judgement, tile: &Tile) -> Deviation {
    let text = Deviation::new(tile.mean, tile.truth, judgement.passes as u64)
        .with_z(tile.z.unwrap_or(f64::NAN));
    Deviation { unit: DrawUnit::Passes, ..text }
}

/// Returns an obvious deviation in words.
fn by_itself(judgement: &Judgement, shown: &Tile) -> String {
    format!("{}, by the passes' own spread", deviation(judgement, shown))
}

/// Returns the reason why an obvious deviation does not fail, with the ground that would decide it.
fn looks_off(judgement: &Judgement, claim: &Claim, shown: &Tile) -> String {
    let has_end = claim.range.is_some_and(|[low, _]| low.is_finite());
    let cure = match (shown.mean > shown.truth, has_end) {
        _ if judgement.neighbours.is_refuted() => {
            "averages of pixels that depend on each other have no known variance"
        }
        (true, false) => {
            "the tails do not let it fail; if values are never negative, as radiance, --range 0,inf decides it"
        }
        (true, true) => {
            "the range and the tails do not let it fail; give a bound by --kurtosis K, or more passes"
        }
        (false, _) => {
            "rare bright values that were not drawn may make up for it; give a bound by --kurtosis K or --range LOW,HIGH, \
             or more passes"
        }
    };
    let channel = in_channel(judgement, shown);
    format!("the mean{channel} looks off by {}, but {cure}", by_itself(judgement, shown))
}

/// Returns the question about a variance that is plainly too large.
fn too_large(judgement: &Judgement, claim: &Claim) -> Option<String> {
    let variance = judgement.variance.filter(|variance| variance.is_too_large)?;
    let (ratio, times) = (short(variance.about_mean, 3), short(1.0 / variance.about_mean, 3));
    let than = if claim.variance_stack.is_some() {
        "those of --variance-stack: have these as many samples each, of the same renderer?"
    } else {
        "the variance given: is it that of one sample instead of a pass, or a standard deviation?"
    };
    Some(format!(
        "the passes vary {times} times less than {than} (s²/V = {ratio}; rare values that were not drawn may carry it)"
    ))
}

fn off(judgement: &Judgement, tile: &Tile) -> String {
    let text = deviation(judgement, tile);
    let is_whole = (tile.height, tile.width) == (judgement.size.rows, judgement.size.columns);
    let channel = if is_whole { in_channel(judgement, tile) } else { String::new() };
    let p = match (&judgement.comparison, tile.p) {
        (Some(_), Some(p)) => format!("p = {}, ", short(p, 2)),
        _ => String::new(),
    };
    format!("the mean{channel} is off by {text} ({p}ln E = {:.1})", tile.ln_e)
}

/// Returns the fault of a value in words.
fn fault(judgement: &Judgement, refuted: Refuted, pixels: &Pixels) -> String {
    let Refuted { pass, row, column, channel: c, value } = refuted;
    let place = format!("pass {pass}, row {row}, column {column}{}", channel(judgement, c));
    let size = judgement.size;
    let truth = pixels.truth[(row * size.columns + column) * size.channels + c];
    let said = match pixels.range {
        _ if !value.is_finite() => format!("numeric: {place} is {value}, all counted from 0"),
        Some([low, high]) if !(low..=high).contains(&value) => {
            format!("range: {place} is {value:e}, outside of {low} to {high}")
        }
        _ => format!("{place} is {value:e}, not {truth:e}, and there should be no spread"),
    };
    match judgement.refuting {
        1 => said,
        count => format!("{said}; {count} values are like that"),
    }
}

/// Returns whether a variance is claimed.
pub(super) fn has_variance(claim: &Claim) -> bool {
    claim.variance.is_some() || claim.variance_stack.is_some()
}

/// Returns the reasons why two stacks that do not fail do not pass.
fn open_against(
    judgement: &Judgement,
    comparison: &StackComparison,
    differing: usize,
) -> Vec<String> {
    let mut open = Vec::new();
    if differing > 0 {
        let p = short(comparison.p, 2);
        let (why, cure) = if judgement.neighbours.is_refuted() {
            (
                "pixels depend on each other, so that nothing follows for means of different distributions",
                "judge averages of blocks wider than the filter by --average N",
            )
        } else {
            (
                "with the kurtosis of these values it may be the shape of the distribution and not its mean",
                "render more passes",
            )
        };
        let all = judgement.tiles.len() + judgement.whole.len();
        open.push(format!(
            "the stacks have different distributions in {differing} of {all} tiles and wholes (p = {p}), but {why}; {cure}, or claim by \
             --same-distribution that both renderers have one distribution in each pixel"
        ));
    }
    if comparison.method == ComparisonMethod::None {
        open.push(
            "the passes are too few to be exchanged, and pixels depend on each other; render 8 passes or more of each stack"
                .to_owned(),
        );
    }
    // `--variance 0` says nothing about two stacks.
    open.extend(means_open(judgement, false));
    open
}
