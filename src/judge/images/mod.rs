//! Stacks of pictures: whether the passes of a renderer have the right means, tile by tile.
//!
//! A pass is an independent render. All passes of a pixel have one law, other pixels may have others.
//!
//! ```text
//! values      a number that is not finite, out of the range, or off where there is no spread:   fail
//! passes      independent of each other (`order`, `repeats`), at α_d/3 each:       else inconclusive
//! pixels      of a pass independent of each other (`neighbours`), at α_d/3:        else averages of passes
//! variance    not larger than claimed (`spread`), at α/5:                          else fail
//! tiles       of N, 2N, 4N … pixels: the mean of each, in each channel (`tiles`), by Holm at 3α/5: else fail
//! whole       the mean of the picture, in each channel, at α/5:                    else fail
//! pass        the whole and every tile exclude a bias of ε, with chance β each; s²/V is 1.1 at most
//! ```
//!
//! `α_d` is α, but not below 1e-4. The list of tiles that are off is by e-BH: 5 % of it are false at most, on average.
//!
//! ```
//! use trueflight::judge::images::{Claim, Level, Size, Stack, Wanted, judge};
//! use trueflight::stats::verdict::Verdict;
//!
//! // 64 passes of 32 × 32 pixels, each the mean of four fair coins.
//! let size = Size { rows: 32, columns: 32, channels: 1 };
//! let coins = (0..64 * size.pixels() as u64).map(|number| {
//!     // SplitMix64.
//!     let bits = number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
//!     let bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
//!     let bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
//!     f64::from((bits >> 60).count_ones()) / 4.0
//! });
//! let stack = Stack::new(64, size, coins.collect())?;
//! let claim = Claim { range: Some([0.0, 1.0]), ..Claim::of_truth(Level::All(0.5)) };
//! assert_eq!(judge(&stack, &claim, &Wanted::default())?.verdict, Verdict::Pass);
//! let claim = Claim { range: Some([0.0, 1.0]), ..Claim::of_truth(Level::All(0.52)) };
//! assert_eq!(judge(&stack, &claim, &Wanted::default())?.verdict, Verdict::Fail);
//! # Ok::<(), trueflight::judge::images::ImageError>(())
//! ```

pub mod against;
mod claim;
mod error;
mod estimate;
pub mod files;
pub mod judgement;
mod likely;
mod neighbours;
mod noisy;
mod order;
mod picture;
mod repeats;
mod same;
mod spread;
mod tiles;
mod verdict;

pub use claim::{Claim, Level};
pub use error::ImageError;
pub use judgement::Judgement;
pub use picture::{Picture, Size, Stack};

use self::claim::Pixels;
use self::judgement::{Dependence, Refuted, Tile, Variance, counts, worst};
use self::tiles::{Part, Terms};
use crate::judge::Levels;
use gate::stats::gate::VARIANCE_MARGIN;
use gate::stats::multiplicity::{e_benjamini_hochberg, holm};
use gate::stats::verdict::{MISS, Verdict};
use theory::parallel;

/// The shares of α: tiles, the whole, the variance.
const SHARES: [f64; 3] = [0.6, 0.2, 0.2];
/// Dependence is looked for at α, but not below this level: orders of passes are drawn.
const LEAST: f64 = 1e-4;
/// The rate of false ones on the list of tiles.
const LISTED: f64 = 0.05;
/// A tile has so many values of all passes, unless its size is asked for: then all tiles can pass.
const VALUES: usize = 2048;
/// Number of values of a tile where the passes must show a variance, too.
const NOISY_VALUES: usize = 8192;

/// What is wanted of the verdict.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// Rows and columns of the smallest tiles; without it the least power of 2 that makes 2048 values of all passes.
    pub tile: Option<usize>,
    /// ε of the whole and of each tile, in units of the picture's mean truth; absolute where that is 0.
    /// Without it, what the passes can see, of the whole 5 % at most.
    pub tolerance: Option<f64>,
    /// The chance that correct passes fail.
    pub alpha: f64,
}

impl Default for Wanted {
    fn default() -> Self {
        Self { tile: None, tolerance: None, alpha: 1e-3 }
    }
}

impl Wanted {
    fn check(&self) -> Result<(), ImageError> {
        let number = |what, value, wanted| Err(ImageError::Number { what, value, wanted });
        match *self {
            Self { tolerance: Some(x), .. } if !(x > 0.0 && x.is_finite()) => {
                number("tolerance", x, "a finite number above 0")
            }
            Self { alpha, .. } if !(alpha > 0.0 && alpha < 1.0) => {
                number("alpha", alpha, "a probability above 0 and below 1")
            }
            Self { tile: Some(0), .. } => number("tile", 0.0, "a number of pixels above 0"),
            _ => Ok(()),
        }
    }

    /// N, at most the picture.
    fn tile(&self, size: Size, passes: usize, values: usize) -> usize {
        let chosen = || {
            let sizes = std::iter::successors(Some(1_usize), |size| Some(2 * size));
            let mut enough = sizes.filter(|size| size * size * passes >= values);
            enough.next().unwrap_or(1)
        };
        self.tile.unwrap_or_else(chosen).min(size.rows.max(size.columns))
    }
}

/// Judges a stack.
///
/// # Errors
///
/// What is claimed or wanted makes no sense, or is of another size than the passes.
pub fn judge(stack: &Stack, claim: &Claim, wanted: &Wanted) -> Result<Judgement, ImageError> {
    wanted.check()?;
    let pixels = Pixels::new(claim, stack, wanted.tolerance)?;
    let (size, alpha) = (stack.size, wanted.alpha);
    let tile = match &pixels.estimate {
        Some(found) => wanted.tile(size, stack.passes.min(found.passes), NOISY_VALUES),
        None => wanted.tile(size, stack.passes, VALUES),
    };
    let (refuted_by, refuting) = refuted(stack, &pixels);
    let neighbours = neighbours_of(stack, alpha);
    let is_free = !neighbours.is_refuted();
    // Passes without spread are one image where they should be.
    let is_certain = (0..size.values()).all(|index| pixels.is_certain(index));
    let (mut order, repeated) = order_of(stack, is_certain || pixels.is_flat(), alpha);
    if let Some(reason) = own(stack, &pixels, claim) {
        order.reason = reason;
    }
    let (parts, whole) = (tiles::parts(size, tile, pixels.estimate.is_some()), tiles::wholes(size));
    let q = |parts: &[Part]| match pixels.estimate.as_ref().filter(|_| refuting == 0) {
        Some(found) => {
            let stacks: Vec<&Stack> = found.stack.iter().chain([stack]).collect();
            estimate::all_q(&stacks, parts, claim.kurtosis)
        }
        None => vec![0.0; parts.len()],
    };
    let (q_tiles, q_whole) = (q(&parts), q(&whole));
    let is_noisy = pixels.estimate.is_some() || pixels.truth_share > 0.0;
    let variance = match (refuting, is_noisy) {
        (0, false) => spread::squares(stack, &pixels, is_free)
            .map(|found| variance_of(found, alpha, VARIANCE_MARGIN)),
        (0, true) => {
            let q = q_whole.iter().copied().fold(0.0, f64::max);
            spread::pairs(stack, &pixels, q, is_free, SHARES[2] * alpha)
                .map(|(found, excess)| variance_of(found, alpha, VARIANCE_MARGIN * excess))
        }
        _ => None,
    };
    let has_variance = !variance.is_some_and(|variance| variance.is_refuted);
    let terms = terms([is_free, has_variance], wanted, parts.len());
    let whole_terms = Terms {
        is_capped: true,
        count: 1,
        levels: Levels::new(SHARES[1] * alpha, whole.len()),
        ..terms
    };
    let all = |parts: &[Part], terms: Terms, q: &[f64]| {
        // Averages of pixels that depend on each other have a range alone.
        let is_possible =
            |part: &Part| is_free || pixels.truth_share > 0.0 || part.height * part.width == 1;
        let one = |i: usize| {
            if is_noisy && is_possible(&parts[i]) {
                noisy::tile(stack, &pixels, parts[i], terms, q[i])
            } else {
                tiles::tile(stack, &pixels, parts[i], terms)
            }
        };
        parallel::range(if refuting == 0 { parts.len() } else { 0 }, one)
    };
    let (mut tiles, mut whole) = (all(&parts, terms, &q_tiles), all(&whole, whole_terms, &q_whole));
    let estimate =
        pixels.estimate.as_ref().map(|found| found.told(claim, size, tile, &parts, &q_tiles));
    let is_judged = !order.is_refuted();
    decide(&mut tiles, SHARES[0] * alpha, is_judged);
    decide(&mut whole, SHARES[1] * alpha, is_judged);
    let mut judgement = Judgement {
        verdict: Verdict::Inconclusive,
        reason: String::new(),
        guarantees: Vec::new(),
        alpha,
        beta: MISS,
        listed_rate: LISTED,
        passes: stack.passes,
        size,
        tile,
        refuted_by,
        refuting,
        order,
        neighbours,
        repeated,
        variance,
        estimate,
        truth_passes: claim.truth_passes,
        comparison: None,
        worst: worst(&tiles),
        counts: counts(&tiles),
        whole,
        tiles,
    };
    verdict::decide(&mut judgement, &pixels, claim);
    Ok(judgement)
}

/// The terms of tiles.
fn terms([is_free, has_variance]: [bool; 2], wanted: &Wanted, count: usize) -> Terms {
    Terms {
        is_free,
        has_variance,
        tolerance: wanted.tolerance,
        is_capped: false,
        count,
        levels: Levels::new(SHARES[0] * wanted.alpha, count),
    }
}

/// Why images that were made of the passes judged are no grounds.
fn own(stack: &Stack, pixels: &Pixels, claim: &Claim) -> Option<String> {
    if same::is_own_truth(stack, pixels) {
        return Some(
            "the truth image is the mean of these very passes; give that of others".to_owned(),
        );
    }
    if let Some(other) = &claim.variance_stack {
        let [p, q] = same::shared(stack, other)?;
        return Some(format!(
            "pass {p} and pass {q} of the stack of the variance share values, counted from 0; give passes with \
             seeds of their own"
        ));
    }
    let is_own = pixels.estimate.is_some() && same::is_own_variance(stack, pixels);
    is_own.then(|| {
        "the variance image is that of these very passes; give that of others, or a bound on the kurtosis by \
         --kurtosis instead of it"
            .to_owned()
    })
}

/// The first value that refutes the claim by itself, and how many do.
fn refuted(stack: &Stack, pixels: &Pixels) -> (Option<Refuted>, u64) {
    let size = stack.size;
    let range = pixels.widened().unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    // What no value may be further away from than.
    let bounds: Vec<f64> = (0..size.values())
        .map(|i| if pixels.is_certain(i) { pixels.bound(i) } else { f64::MAX })
        .collect();
    let (mut first, mut count) = (None, 0);
    for pass in 0..stack.passes {
        for (index, &value) in stack.pass(pass).iter().enumerate() {
            let is_near = (value - pixels.truth[index]).abs() <= bounds[index];
            if is_near && range[0] <= value && value <= range[1] {
                continue;
            }
            count += 1;
            first.get_or_insert_with(|| Refuted::at(size, pass, index, value));
        }
    }
    (first, count)
}

/// The first value that is NaN or infinite, and the number of such values.
fn not_finite(stack: &Stack) -> (Option<Refuted>, u64) {
    let (mut first, mut count) = (None, 0);
    for pass in 0..stack.passes {
        for (index, &value) in stack.pass(pass).iter().enumerate().filter(|(_, x)| !x.is_finite()) {
            count += 1;
            first.get_or_insert_with(|| Refuted::at(stack.size, pass, index, value));
        }
    }
    (first, count)
}

/// `ln(3/α_d)`.
fn limit(alpha: f64) -> f64 {
    (3.0 / alpha.max(LEAST)).ln()
}

fn neighbours_of(stack: &Stack, alpha: f64) -> Dependence {
    let (found, limit) = (neighbours::neighbours(stack), limit(alpha));
    let mut said = Dependence {
        evidence: found.ln_e,
        limit,
        correlation: Some(found.correlation),
        is_tested: stack.size.pixels() > 1,
        ..Dependence::default()
    };
    if found.ln_e >= limit {
        said.reason = format!(
            "the pixels of a pass are not independent: the correlation of neighbours is {:.2}",
            found.correlation
        );
    }
    said
}

/// Whether passes depend on each other, and which share values.
fn order_of(stack: &Stack, is_certain: bool, alpha: f64) -> (Dependence, Vec<u32>) {
    let limit = limit(alpha);
    let is_tested = stack.passes >= order::fewest((-limit).exp());
    let mut said = Dependence { limit, is_tested, ..Dependence::default() };
    if let Some(found) = order::order(stack) {
        said.evidence = -found.p.ln();
        (said.lag, said.correlation) = (Some(found.lag), Some(found.correlation));
        if said.evidence >= limit {
            said.reason = format!(
                "the passes are not independent: the correlation of passes that are {} apart is {:.2}",
                found.lag, found.correlation
            );
        }
    }
    let mut repeated = Vec::new();
    if let Some(found) = repeats::repeat(stack).filter(|found| found.ln_p <= -limit) {
        let names: Vec<String> = found.passes.iter().map(u32::to_string).collect();
        said.reason = format!(
            "the passes are not independent: passes {} share values, counted from 0; give each pass \
             and thread a seed of its own",
            names.join(", ")
        );
        repeated = found.passes;
    }
    if !is_certain && repeats::is_one_image(stack) {
        "all passes are one image: give each pass a seed of its own".clone_into(&mut said.reason);
        repeated = (0..).zip(0..stack.passes).map(|(pass, _)| pass).collect();
    }
    (said, repeated)
}

fn variance_of(found: spread::Squares, alpha: f64, margin: f64) -> Variance {
    let limit = -(SHARES[2] * alpha).ln();
    let spread::Squares { ln_e, about_truth, about_mean } = found;
    // Means that are off make squares about the truth large, but not those about the mean.
    let is_spread = about_mean - 1.0 >= 0.5 * (about_truth - 1.0);
    Variance {
        about_truth,
        about_mean,
        margin,
        ln_e,
        limit,
        is_refuted: ln_e >= limit && is_spread,
    }
}

/// Fail by Holm, pass by both sides, and the list.
fn decide(tiles: &mut [Tile], alpha: f64, is_judged: bool) {
    if !is_judged {
        return;
    }
    let ln_e: Vec<f64> = tiles.iter().map(|tile| tile.ln_e).collect();
    let p: Vec<f64> = ln_e.iter().map(|ln_e| (-ln_e).exp().min(1.0)).collect();
    let rejected = holm(&p, tiles.len(), alpha);
    for (tile, is_rejected) in tiles.iter_mut().zip(rejected) {
        let has_passed = tile.ln_p.iter().all(|&ln_p| ln_p >= -MISS.ln());
        tile.verdict = match (is_rejected, has_passed) {
            (true, _) => Verdict::Fail,
            (false, true) => Verdict::Pass,
            (false, false) => Verdict::Inconclusive,
        };
    }
    for index in e_benjamini_hochberg(&ln_e, LISTED) {
        tiles[index].is_listed = true;
    }
}
