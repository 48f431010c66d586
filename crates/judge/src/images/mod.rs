//! Stacks of pictures: test of the means of a renderer's passes, tile by tile.
//!
//! A pass is an independent render. All passes of a pixel have the same distribution, which may differ between pixels.
//!
//! ```text
//! values      a number that is not finite, out of the range, or off where there is no spread:   fail
//! passes      independent of each other (`order`, `repeats`), at α_d/3 each:       else inconclusive
//! pixels      of a pass independent of each other (`order`), at α_d/3:             else averages of passes
//! variance    not larger than claimed (`variance`), at α/5:                        else fail
//! tiles       of N, 2N, 4N … pixels: the mean of each, in each channel (`tiles`), by Holm at 3α/5: else fail
//! whole       the mean of the picture, in each channel, at α/5:                    else fail
//! pass        the whole and every tile exclude a bias of ε, at error probability β each; s²/V is 1.1 at most
//! ```
//!
//! `α_d` is α, but not below 1e-4. The list of suspect tiles is by e-BH: on average at most 5 % of it are false.
//!
//! ```
//! use trueflight_judge::images::{Claim, ImageOptions, Level, Size, Stack, judge};
//! use gate::stats::verdict::Verdict;
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
//! assert_eq!(judge(&stack, &claim, &ImageOptions::default())?.verdict, Verdict::Pass);
//! let claim = Claim { range: Some([0.0, 1.0]), ..Claim::of_truth(Level::All(0.52)) };
//! assert_eq!(judge(&stack, &claim, &ImageOptions::default())?.verdict, Verdict::Fail);
//! # Ok::<(), trueflight_judge::images::ImageError>(())
//! ```

pub mod against;
mod claim;
pub mod files;
pub mod judgement;
mod noisy;
mod order;
mod picture;
mod promises;
mod repeats;
mod shown;
mod tails;
mod tiles;
mod variance;
mod verdict;

pub use claim::{Claim, ImageError, Level};
pub use judgement::Judgement;
pub use picture::{Picture, Size, Stack};

use self::claim::Pixels;
use self::judgement::{Dependence, Refuted, Tile, Variance};
use self::tiles::{Part, Terms};
use crate::{Levels, SIDE_SHARE, decide_together, is_by_spread, main_share};
use gate::stats::gate::{Evidence, VARIANCE_MARGIN};
use theory::parallel;

/// Smallest level for tests of dependence, for which random orders of passes are drawn.
const MIN_DEPENDENCE_ALPHA: f64 = 1e-4;
/// Number of values, over all passes, in the smallest tiles, unless their size is given: then all tiles can pass.
const VALUES: usize = 2048;
/// Number of such values if the passes must show a variance, too.
const NOISY_VALUES: usize = 8192;

/// Options of a verdict.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImageOptions {
    /// Rows and columns of the smallest tiles; `None` for the smallest power of 2 with 2048 values in all passes, or with
    /// 8192 and a bound on the variance of every tile if the variance is an estimate.
    pub tile: Option<usize>,
    /// ε of the whole and of each tile, in units of the picture's mean truth; absolute if that is 0. `None` for the
    /// bias that the passes can show, at most 5 % for the whole.
    pub tolerance: Option<f64>,
    /// Probability that correct passes fail.
    pub alpha: f64,
}

impl Default for ImageOptions {
    fn default() -> Self {
        Self { tile: None, tolerance: None, alpha: 1e-3 }
    }
}

impl ImageOptions {
    fn check(&self) -> Result<(), ImageError> {
        let number = |what, value, required| Err(ImageError::Number { what, value, required });
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

    /// Returns N, at most the size of the picture.
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
/// The claim or the options make no sense, or the claim has another size than the passes.
pub fn judge(
    stack: &Stack,
    claim: &Claim,
    required: &ImageOptions,
) -> Result<Judgement, ImageError> {
    required.check()?;
    let pixels = Pixels::new(claim, stack, required.tolerance)?;
    let (size, alpha) = (stack.size, required.alpha);
    let mut judgement = Judgement::new(stack, alpha, required.tile(size, stack.passes, VALUES));
    judgement.truth_passes = claim.truth_passes;
    let range = pixels.widened().unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let bound = |i| if pixels.is_certain(i) { pixels.bound(i) } else { f64::MAX };
    let bounds: Vec<f64> = (0..size.values()).map(bound).collect();
    (judgement.refuted_by, judgement.refuting) = refuted(stack, |i, value| {
        let is_near = (value - pixels.truth[i]).abs() <= bounds[i];
        is_near && range[0] <= value && value <= range[1]
    });
    judgement.neighbours = neighbours_of(stack, alpha);
    // Passes without spread are supposed to be one image.
    let is_certain = (0..size.values()).all(|index| pixels.is_certain(index));
    (judgement.order, judgement.repeated) = order_of(stack, is_certain || pixels.is_flat(), alpha);
    if let Some(reason) = own(stack, &pixels, claim) {
        judgement.order.reason = reason;
    }
    let (is_free, is_whole) = (!judgement.neighbours.is_refuted(), judgement.refuting == 0);
    let stacks: Vec<&Stack> = match &pixels.estimate {
        Some(actual) => actual.stack.iter().chain([stack]).collect(),
        None => Vec::new(),
    };
    let mut share = 1.0;
    if let Some(actual) = &pixels.estimate {
        judgement.tile = required.tile(size, stack.passes.min(actual.passes), NOISY_VALUES);
        if required.tile.is_none() && claim.kurtosis.is_none() && is_whole {
            let chosen = tails::chosen(&stacks, size, judgement.tile, actual.passes);
            (judgement.tile, share) = (chosen.tile, chosen.share);
        }
    }
    let tile = judgement.tile;
    let (parts, wholes) =
        (tiles::parts(size, tile, pixels.estimate.is_some()), tiles::wholes(size));
    let q = |parts: &[Part]| match pixels.estimate.as_ref().filter(|_| is_whole) {
        Some(_) => variance::all_q(&stacks, parts, claim.kurtosis),
        None => vec![0.0; parts.len()],
    };
    let tiles_alpha = share * main_share(2) * alpha;
    let (q_tiles, q_whole) = (q(&parts), q(&wholes));
    judgement.estimate = pixels
        .estimate
        .as_ref()
        .map(|estimate| estimate.summary(claim, size, tile, &parts, &q_tiles));
    if is_whole {
        let q = q_whole.iter().copied().fold(0.0, f64::max);
        judgement.variance = variance_of(stack, &pixels, q, is_free, alpha);
        let terms = Terms {
            is_free,
            has_variance: !judgement.variance.is_some_and(|variance| variance.is_refuted),
            tolerance: required.tolerance,
            is_capped: false,
            count: parts.len(),
            levels: Levels::new(tiles_alpha, parts.len()),
        };
        let levels = Levels::new(SIDE_SHARE * alpha, wholes.len());
        let whole_terms = Terms { is_capped: true, count: 1, levels, ..terms };
        let mut tiles = evidence(stack, &pixels, &parts, terms, &q_tiles);
        let mut whole = evidence(stack, &pixels, &wholes, whole_terms, &q_whole);
        if !judgement.order.is_refuted() {
            decide(&mut tiles, tiles_alpha);
            decide(&mut whole, SIDE_SHARE * alpha);
        }
        judgement.take(tiles, whole);
        if !judgement.order.is_refuted() {
            judgement.shown = shown::mean(stack, &pixels, &judgement.whole, is_free);
        }
    }
    verdict::decide(&mut judgement, stack, &pixels, claim);
    Ok(judgement)
}

/// Returns whether the truth or the variance has an error.
fn is_noisy(pixels: &Pixels) -> bool {
    pixels.estimate.is_some() || pixels.truth_share > 0.0
}

/// Returns the evidence on parts of the picture.
fn evidence(stack: &Stack, pixels: &Pixels, parts: &[Part], terms: Terms, q: &[f64]) -> Vec<Tile> {
    // Averages of pixels that depend on each other have only a range.
    let is_possible =
        |part: Part| terms.is_free || pixels.truth_share > 0.0 || part.height * part.width == 1;
    parallel::range(parts.len(), |i| {
        if is_noisy(pixels) && is_possible(parts[i]) {
            noisy::tile(stack, pixels, parts[i], terms, q[i])
        } else {
            tiles::tile(stack, pixels, parts[i], terms)
        }
    })
}

/// Decides tiles that share `alpha`.
fn decide(tiles: &mut [Tile], alpha: f64) {
    let evidence: Vec<Evidence> = tiles.iter().map(Tile::evidence).collect();
    for (tile, joint) in tiles.iter_mut().zip(decide_together(&evidence, alpha)) {
        (tile.verdict, tile.is_listed) = (joint.verdict(), joint.is_listed);
    }
}

/// Returns the reason why images that were made from the judged passes cannot be used.
fn own(stack: &Stack, pixels: &Pixels, claim: &Claim) -> Option<String> {
    if repeats::is_own_truth(stack, pixels) {
        return Some(
            "the truth image is the mean of these very passes; give that of others".to_owned(),
        );
    }
    if let Some(other) = &claim.variance_stack {
        let [p, q] = repeats::shared(stack, other)?;
        return Some(format!(
            "pass {p} and pass {q} of the stack of the variance share values, counted from 0; give passes with \
             seeds of their own"
        ));
    }
    let is_own = pixels.estimate.is_some() && repeats::is_own_variance(stack, pixels);
    is_own.then(|| {
        "the variance image is that of these very passes; give that of others, or a bound on the kurtosis by \
         --kurtosis instead of it"
            .to_owned()
    })
}

/// Returns the first value that is wrong by itself, and the number of such values.
fn refuted(stack: &Stack, is_right: impl Fn(usize, f64) -> bool) -> (Option<Refuted>, u64) {
    let (mut first, mut count) = (None, 0);
    for pass in 0..stack.passes {
        for (index, &value) in stack.pass(pass).iter().enumerate() {
            if !is_right(index, value) {
                count += 1;
                first.get_or_insert_with(|| Refuted::at(stack.size, pass, index, value));
            }
        }
    }
    (first, count)
}

/// Returns `ln(3/α_d)`.
fn limit(alpha: f64) -> f64 {
    (3.0 / alpha.max(MIN_DEPENDENCE_ALPHA)).ln()
}

fn neighbours_of(stack: &Stack, alpha: f64) -> Dependence {
    let (actual, limit) = (order::neighbours(stack), limit(alpha));
    let mut said = Dependence {
        evidence: actual.ln_e,
        limit,
        correlation: Some(actual.correlation),
        is_tested: stack.size.pixels() > 1,
        ..Dependence::default()
    };
    if actual.ln_e >= limit {
        said.reason = format!(
            "the pixels of a pass are not independent: the correlation of neighbours is {:.2}",
            actual.correlation
        );
    }
    said
}

/// Tests passes for dependence on each other, and returns those that share values.
fn order_of(stack: &Stack, is_certain: bool, alpha: f64) -> (Dependence, Vec<u32>) {
    let limit = limit(alpha);
    let is_tested = stack.passes >= order::fewest((-limit).exp());
    let mut said = Dependence { limit, is_tested, ..Dependence::default() };
    if let Some(actual) = order::order(stack) {
        said.evidence = -actual.p.ln();
        (said.lag, said.correlation) = (Some(actual.lag), Some(actual.correlation));
        if said.evidence >= limit {
            said.reason = format!(
                "the passes are not independent: the correlation of passes that are {} apart is {:.2}",
                actual.lag, actual.correlation
            );
        }
    }
    let mut repeated = Vec::new();
    if let Some(actual) = repeats::repeat(stack).filter(|actual| actual.ln_p <= -limit) {
        let names: Vec<String> = actual.passes.iter().map(u32::to_string).collect();
        said.reason = format!(
            "the passes are not independent: passes {} share values, counted from 0; give each pass \
             and thread a seed of its own",
            names.join(", ")
        );
        repeated = actual.passes;
    }
    if !is_certain && repeats::is_one_image(stack) {
        "all passes are one image: give each pass a seed of its own".clone_into(&mut said.reason);
        repeated = (0..).zip(0..stack.passes).map(|(pass, _)| pass).collect();
    }
    (said, repeated)
}

/// Tests the claimed variance; `None` if it is unknown, or rounding hides it.
fn variance_of(
    stack: &Stack,
    pixels: &Pixels,
    q: f64,
    is_free: bool,
    alpha: f64,
) -> Option<Variance> {
    let level = SIDE_SHARE * alpha;
    let (actual, excess, error) = if is_noisy(pixels) {
        variance::pairs(stack, pixels, q, is_free, level)?
    } else {
        (variance::squares(stack, pixels, is_free)?, 1.0, 0.0)
    };
    let variance::Squares { ln_e, about_truth, about_mean } = actual;
    let (margin, limit) = (VARIANCE_MARGIN * excess, -level.ln());
    let is_refuted = ln_e >= limit && is_by_spread(about_truth, about_mean);
    let is_too_large = is_free && shown::is_too_large(stack, pixels, about_mean, error);
    Some(Variance { about_truth, about_mean, margin, ln_e, limit, is_refuted, is_too_large })
}
