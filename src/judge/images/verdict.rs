//! Verdicts on one stack and on two, with their reasons; the order of the reasons is that of a session.

use super::claim::{Claim, Pixels};
use super::judgement::{Comparison, Judgement, Refuted, Tile};
use crate::judge::{Reasons, SIDE_SHARE};
use gate::deviation::{Deviation, signed_percent};
use gate::stats::verdict::Verdict;
use numeric::digits::{enough, percent, short};

/// Decides about a stack, and adds the promises of the verdict.
pub(super) fn decide(judgement: &mut Judgement, pixels: &Pixels, claim: &Claim) {
    let refuted = judgement.refuted_by;
    let refuted = refuted.map(|refuted| fault(judgement, refuted, pixels));
    let mut failing: Vec<String> = too_small(judgement).into_iter().collect();
    // If the variance is refuted, no tile fails by it; the tile that stands out may show the cause.
    let strange = furthest(judgement.tiles.iter());
    if let Some(tile) = strange.filter(|_| judgement.counts.fail == 0 && !failing.is_empty()) {
        failing.push(format!(
            "what stands out most, {}: {} (not judged by that variance; give a range, too)",
            place(judgement, tile),
            off(judgement, tile)
        ));
    }
    failing.extend(means_off(judgement, judgement.worst.first()));
    let open = open(judgement, claim);
    finish(judgement, Reasons { refuted, failing, open, ..Reasons::default() });
    judgement.guarantees = guarantees(judgement, claim);
}

/// Decides about two stacks, and adds the promises of the verdict. `differing` is the number of tiles that differ by
/// the test of equal distributions alone.
pub(super) fn decide_against(judgement: &mut Judgement, comparison: &Comparison, differing: usize) {
    let refuted = judgement.refuted_by.map(|refuted| {
        let Refuted { pass, row, column, value, .. } = refuted;
        let count = judgement.refuting;
        format!(
            "numeric: pass {pass}, row {row}, column {column} is {value}, all counted from 0; values like that: {count}"
        )
    });
    let mut failing = Vec::new();
    if comparison.is_same_distribution && comparison.spread_p <= SIDE_SHARE * judgement.alpha {
        let times = |x| format!("{} times as wide", short(x, 4));
        let spread = comparison.spread.map_or("differently".to_owned(), times);
        let p = short(comparison.spread_p, 2);
        failing.push(format!(
            "the variance is off: the passes spread {spread} as those of the reference (p = {p})"
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
    Some(format!(
        "the variance is too small: values spread {:.3} times as wide, {} (ln E = {:.1} ≥ {:.1}){}",
        variance.about_mean,
        signed_percent(variance.about_mean - 1.0),
        variance.ln_e,
        variance.limit,
        match judgement.estimate {
            Some(_) => "",
            None => "; if it was estimated from N other passes, say so by --variance-passes N",
        }
    ))
}

/// Returns the reasons by which means fail.
fn means_off(judgement: &Judgement, worst: Option<&Tile>) -> Vec<String> {
    let fails = |whole: &&Tile| whole.verdict == Verdict::Fail;
    let whole = |whole| format!("the picture is off: {}", off(judgement, whole));
    let mut failing: Vec<String> = judgement.whole.iter().filter(fails).map(whole).collect();
    if judgement.counts.fail > 0 {
        let (fail, tiles) = (judgement.counts.fail, judgement.counts.tiles);
        let worst = worst.map_or(String::new(), |worst| {
            format!("; the worst, {}: {}", place(judgement, worst), off(judgement, worst))
        });
        failing.push(format!("{fail} of {tiles} tiles are off{worst}"));
    }
    failing
}

/// Returns the reasons by which means are undecided.
fn means_open(judgement: &Judgement) -> Vec<String> {
    let (wholes, tiles) = (undecided(&judgement.whole), undecided(&judgement.tiles));
    let whole = wholes.first().map(|whole| {
        let more = more(judgement, &wholes);
        format!("the picture may be off {}; {more}{}", bias(whole), constant(whole))
    });
    let tile = tiles.first().map(|tile| {
        format!(
            "{} of {} tiles may be off, the first, {}, {}; {}, or give a larger --tile or a wider --tolerance{}",
            tiles.len(),
            judgement.counts.tiles,
            place(judgement, tile),
            bias(tile),
            more(judgement, &tiles),
            constant(tile)
        )
    });
    whole.into_iter().chain(tile).collect()
}

fn undecided(tiles: &[Tile]) -> Vec<&Tile> {
    tiles.iter().filter(|tile| tile.verdict != Verdict::Pass).collect()
}

/// Returns the advice to render as many passes as decide all of these tiles, where their number is known.
fn more(judgement: &Judgement, undecided: &[&Tile]) -> String {
    let needed: Option<Vec<f64>> = undecided.iter().map(|tile| tile.needed).collect();
    let most = needed.map(|needed| needed.into_iter().fold(0.0, f64::max));
    most.map_or("render more passes".to_owned(), |most| {
        let passes = if most < 1e6 { most.to_string() } else { enough(most) };
        format!("render {passes} passes in place of {}", judgement.passes)
    })
}

/// Returns the cure for values without a measured spread, of which passes prove nothing however many.
fn constant(tile: &Tile) -> &'static str {
    match tile.tolerance {
        None | Some(0.0) => {
            "; if values never vary, as in an analog furnace, say so by --variance 0"
        }
        Some(_) => "",
    }
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
        let place = judgement.tiles.iter().find(|found| found.tolerance == Some(tile));
        let place =
            place.map_or(String::new(), |found| format!(" ({})", self::place(judgement, found)));
        said.push(format!(
            "but only a bias above {} of the picture's mean is excluded in every tile{place}, above {} in the whole; render \
             more passes or give a larger --tile to exclude less",
            percent(tile),
            percent(whole)
        ));
    }
    let unknown = judgement.estimate.map_or(0, |found| found.unknown);
    if unknown > 0 {
        said.push(format!("{unknown} values without a variance are not judged"));
    }
    said
}

/// Returns the reasons why a picture that does not fail does not pass.
fn open(judgement: &Judgement, claim: &Claim) -> Vec<String> {
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
             blends pixels, give --range LOW,HIGH{rest}",
            judgement.neighbours.reason
        ));
    }
    if let Some(variance) =
        judgement.variance.filter(|variance| variance.about_mean > variance.margin)
    {
        open.push(format!(
            "the values spread {:.3} times as wide as the variance says",
            variance.about_mean
        ));
    }
    open.extend(means_open(judgement));
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

fn channel(judgement: &Judgement, channel: usize) -> String {
    if judgement.size.channels > 1 { format!(", channel {channel}") } else { String::new() }
}

fn off(judgement: &Judgement, tile: &Tile) -> String {
    let told = Deviation::new(tile.mean, tile.truth, judgement.passes as u64)
        .with_z(tile.z.unwrap_or(f64::NAN));
    let told = Deviation { unit: "passes", ..told };
    let is_whole = (tile.height, tile.width) == (judgement.size.rows, judgement.size.columns);
    let channel = if is_whole {
        channel(judgement, tile.channel).replacen(", ", " in ", 1)
    } else {
        String::new()
    };
    let p = match (&judgement.comparison, tile.p) {
        (Some(_), Some(p)) => format!("p = {}, ", short(p, 2)),
        _ => String::new(),
    };
    format!("the mean{channel} is off by {told} ({p}ln E = {:.1})", tile.ln_e)
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

fn has_variance(claim: &Claim) -> bool {
    claim.variance.is_some() || claim.variance_stack.is_some()
}

/// Returns the assumptions about a variance and a truth that are not exact.
fn estimated(judgement: &Judgement) -> Vec<String> {
    let mut said = Vec::new();
    if let Some(found) = judgement.estimate {
        let (kurtosis, passes) = (short(found.kurtosis, 3), found.passes);
        said.push(if found.is_given {
            format!(
                "the variance is an estimate of {passes} passes; its error is paid for: the levels hold if no tile has a \
                 kurtosis above {kurtosis}, as given"
            )
        } else {
            format!(
                "the variance is an estimate of {passes} passes; its error is paid for, at nominal levels: they assume that \
                 no tile has a larger kurtosis than these values show ({kurtosis} at most); a bound by --kurtosis K makes \
                 them hold"
            )
        });
        let (negative, unknown) = (found.negative, found.unknown);
        if let Some([row, column, channel]) = found.first {
            let place = format!("row {row}, column {column}{}", self::channel(judgement, channel));
            said.push(format!(
                "{negative} variances are negative and count as 0, {unknown} are no numbers and their values are not \
                 judged; the first: {place}"
            ));
        }
    }
    if let Some(passes) = judgement.truth_passes {
        said.push(format!("the truth is the mean of {passes} passes, and has the error of that"));
    }
    said
}

fn guarantees(judgement: &Judgement, claim: &Claim) -> Vec<String> {
    let mut said = Vec::new();
    let has_variance = has_variance(claim);
    let has_kurtosis = !has_variance && claim.kurtosis.is_some();
    let has_grounds = has_variance || has_kurtosis || claim.range.is_some();
    let is_free = judgement.neighbours.is_tested && !judgement.neighbours.is_refuted();
    let pixels = if is_free { " of independent pixels" } else { "" };
    let whose = match (has_variance, claim.kurtosis.filter(|_| has_kurtosis)) {
        (true, _) => " of that variance".to_owned(),
        (_, Some(kurtosis)) => format!(" of a kurtosis of {kurtosis} at most in every tile"),
        _ => String::new(),
    };
    if has_grounds {
        said.push(format!(
            "independent passes{pixels}{whose} fail with probability {} at most, all tiles and channels together",
            judgement.alpha
        ));
        let condition = if has_variance { " if the variance is right" } else { "" };
        said.push(format!(
            "a picture, or a tile, that is off by its tolerance passes with probability {} at most{condition}",
            judgement.beta
        ));
    } else {
        said.push("nothing fails or passes without a variance or a range".to_owned());
    }
    said.extend(estimated(judgement));
    if !judgement.neighbours.is_tested {
        said.push("there are no neighbours".to_owned());
    } else if judgement.neighbours.is_refuted() {
        said.push(format!(
            "{}: averages of whole passes are judged, by the range alone",
            judgement.neighbours.reason
        ));
    } else {
        said.push(
            "the pixels of a pass count as independent of each other; neighbours show nothing else"
                .to_owned(),
        );
    }
    if !judgement.order.is_tested {
        said.push(format!(
            "{} passes are too few to see whether each depends on the one before",
            judgement.passes
        ));
    }
    if judgement.counts.listed > 0 {
        said.push(format!(
            "of the {} tiles on the list, a share of {} at most is right, on average",
            judgement.counts.listed, judgement.listed_rate
        ));
    }
    said
}

/// Returns the reasons why two stacks that do not fail do not pass.
fn open_against(judgement: &Judgement, comparison: &Comparison, differing: usize) -> Vec<String> {
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
    if comparison.method == "none" {
        open.push(
            "the passes are too few to be exchanged, and pixels depend on each other; render 8 passes or more of each stack"
                .to_owned(),
        );
    }
    open.extend(means_open(judgement));
    open
}

fn guarantees_against(judgement: &Judgement, comparison: &Comparison) -> Vec<String> {
    let alpha = judgement.alpha;
    let pixels = if comparison.method == "signs" { ", and pixels are independent," } else { "" };
    let mut said = vec![format!(
        "if both stacks have one distribution in every pixel{pixels} they fail with probability {alpha} at most: exact, for any distribution and \
         number of passes"
    )];
    if !comparison.is_same_distribution {
        let kurtosis = comparison
            .kurtosis
            .map_or(String::new(), |k| format!(" ({} as measured)", short(k, 3)));
        said.push(format!(
            "if only their means are equal the level {alpha} is nominal: it assumes independent pixels and that no tile has a \
             larger kurtosis than these passes show{kurtosis}; rare values that neither stack drew may carry a mean"
        ));
    }
    said.push(format!(
        "a picture, or a tile, that is off by its tolerance passes with probability {} at most: nominal, by averages that are near \
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
