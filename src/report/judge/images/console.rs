//! Judgement of a stack of images on the screen: a small block of lines.

use crate::judge::images::Judgement;
use crate::judge::images::judgement::{
    ComparisonMethod, Dependence, StackComparison, Tile, Variance,
};
use crate::record::Verdict;
use numeric::digits::{fixed, percent, short, signed};

/// Returns the block, `width` columns wide.
pub fn block(judgement: &Judgement, name: &str, width: usize) -> String {
    let passes = format!("{} passes of {} in {name}", judgement.passes, judgement.size);
    let mut lines = vec![("images", passes)];
    lines.extend(judgement.whole.iter().map(|whole| ("whole", whole_line(judgement, whole))));
    lines.extend(judgement.comparison.iter().map(|finding| ("against", against_line(finding))));
    lines.extend(judgement.estimate.map(|finding| {
        let source = if finding.is_given { "as given" } else { "measured" };
        let what = format!(
            "the variance is that of {} passes; kurtosis {} at most ({source}); {} negative, {} no numbers",
            finding.passes,
            short(finding.kurtosis, 3),
            finding.negative,
            finding.unknown
        );
        ("estimate", what)
    }));
    lines.extend(judgement.variance.map(|variance| ("variance", variance_line(&variance))));
    if judgement.counts.tiles > 0 {
        lines.push(("tiles", tiles(judgement)));
    }
    lines.extend(judgement.worst.iter().map(|worst| ("worst", worst_line(judgement, worst))));
    let order = dependence(&judgement.order, "ln 1/p", "there are too few to tell");
    lines.extend([
        ("passes", order),
        ("pixels", dependence(&judgement.neighbours, "ln E", "there is one")),
    ]);
    lines.extend(judgement.guarantees.iter().map(|promise| ("promise", promise.clone())));
    let why =
        if judgement.reason.is_empty() { String::new() } else { format!(": {}", judgement.reason) };
    lines.push(("verdict", format!("{}{why}", judgement.verdict.word())));
    lines.extend(judgement.likely().into_iter().map(|likely| ("likely", likely)));
    super::super::lines(&lines, width)
}

fn channel(judgement: &Judgement, tile: &Tile) -> String {
    if judgement.size.channels > 1 { format!("channel {}: ", tile.channel) } else { String::new() }
}

/// Returns the comparison of two stacks and its method.
fn against_line(comparison: &StackComparison) -> String {
    let method = match comparison.method {
        ComparisonMethod::Permutation => {
            format!("{} permutations of passes", comparison.permutations)
        }
        ComparisonMethod::Signs => "signs of differences".to_owned(),
        ComparisonMethod::None => {
            "no test: too few passes of pixels that depend on each other".to_owned()
        }
    };
    let spread = comparison.spread.map_or(String::new(), |ratio| {
        let p = if comparison.permutations > 0 {
            format!(" (p = {})", short(comparison.spread_p, 2))
        } else {
            String::new()
        };
        let word = if comparison.is_same_distribution { "" } else { "; reported only" };
        format!("; variance {} times that of the reference{p}{word}", fixed(ratio, 4))
    });
    format!(
        "{} passes of the reference; equal distributions: p = {} ({method}){spread}",
        comparison.passes,
        short(comparison.p, 3)
    )
}

/// Returns mean, error, truth and z.
fn numbers(judgement: &Judgement, tile: &Tile) -> String {
    let truth = if judgement.comparison.is_some() { "reference" } else { "truth" };
    let z = tile.z.map_or(String::new(), |z| format!(", z = {}", signed(z)));
    let (mean, error) = (fixed(tile.mean, 8), short(tile.standard_error, 3));
    let p = tile.p.map_or(String::new(), |p| format!(", p = {}", short(p, 2)));
    format!("{mean} ± {error}, {truth} {}{z}{p}, ln E = {:.1}", short(tile.truth, 10), tile.ln_e)
}

/// Returns s²/V, and what the evidence is about.
fn variance_line(variance: &Variance) -> String {
    let &Variance { about_truth, about_mean, ln_e, limit, is_refuted, .. } = variance;
    let (ratio, finding) = (fixed(about_mean, 5), format!("ln E = {ln_e:.1} of {limit:.1}"));
    let biased =
        if ln_e >= limit && !is_refuted { ": mostly because the means are off" } else { "" };
    // An estimate is compared with pairs of passes, without the truth.
    let squares = if (about_truth - about_mean).abs() < 1e-12 {
        String::new()
    } else {
        format!("; (x − truth)²/V = {}", fixed(about_truth, 5))
    };
    format!("s²/V = {ratio}{squares}, {finding} against V as the largest{biased}")
}

fn whole_line(judgement: &Judgement, whole: &Tile) -> String {
    let tolerance = whole.tolerance.map_or(String::new(), |x| format!(", ε = {}", percent(x)));
    let channel = channel(judgement, whole);
    let word = if judgement.is_unjudged() { "not judged" } else { whole.verdict.word() };
    format!("{channel}{}{tolerance}: {word}", numbers(judgement, whole))
}

fn tiles(judgement: &Judgement) -> String {
    let (counts, size) = (judgement.counts, judgement.tile);
    let tiles = format!("{} of {size} × {size} pixels and larger", counts.tiles);
    if judgement.is_unjudged() {
        return format!("{tiles}: not judged");
    }
    let passing = judgement.tiles.iter().filter(|tile| tile.verdict == Verdict::Pass);
    let widest = passing.filter_map(|tile| tile.tolerance).reduce(f64::max);
    let widest = widest.map_or(String::new(), |widest| {
        format!(" (ε up to {} of the picture's mean)", percent(widest))
    });
    format!("{tiles}: {} pass{widest}, {} fail, {} listed", counts.pass, counts.fail, counts.listed)
}

fn worst_line(judgement: &Judgement, tile: &Tile) -> String {
    let Tile { row, column, height, width, .. } = tile;
    let (channel, word) = (channel(judgement, tile), tile.verdict.word());
    let is_other = |other: &&Tile| {
        let is_off = other.verdict == Verdict::Fail || other.is_listed;
        is_off && other.channel != tile.channel && other.is_at(tile)
    };
    let others = judgement.tiles.iter().filter(is_other);
    let others: Vec<String> = others.map(|other| other.channel.to_string()).collect();
    let others = match others.len() {
        0 => String::new(),
        1 => format!("; channel {}, too", others[0]),
        _ => format!("; channels {}, too", others.join(", ")),
    };
    format!(
        "{height} × {width} at row {row}, column {column}: {channel}{}: {word}{others}",
        numbers(judgement, tile)
    )
}

fn dependence(finding: &Dependence, evidence: &str, untested: &str) -> String {
    if finding.is_refuted() {
        return finding.reason.clone();
    }
    if !finding.is_tested {
        return format!("not tested for dependence: {untested}");
    }
    format!(
        "{evidence} = {:.1} of {:.1} against independence: nothing found",
        finding.evidence, finding.limit
    )
}
