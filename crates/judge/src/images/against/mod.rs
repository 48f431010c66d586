//! Two stacks against each other: test of equal means of a renderer and a reference, both of them noisy.
//!
//! Two tests of each tile, and of the whole, with different hypotheses:
//!
//! ```text
//! same        the passes of both stacks have one distribution in every pixel: an exact level α
//!             `stats::permutation` of passes, all tiles and the whole at one level; pixels may depend on each other
//!             `stats::normal` signs of differences where the passes are too few for that; independent pixels
//! same mean   distributions may differ (a better sampler, more samples a pass), means may not:
//!             `stats::estimated_variance` of x̄ − ȳ over the pixels of a tile, V by both stacks, with the kurtosis that
//!             they show; Holm at α
//! ```
//!
//! A tile fails if both tests reject. If the distributions are equal, the probability of that is at most α, for any
//! distribution. If only the means are equal, the level is nominal, for two reasons. V̂ and x̄ − ȳ come from the same
//! passes; and rare values that neither stack drew may carry the mean (Bahadur and Savage 1956). With `is_same_distribution` the
//! first test alone decides, and equal variances are tested, too.
//!
//! Source of the problem: A. Jung, J. Hanika, C. Dachsbacher, *Detecting Bias in Monte Carlo Renderers using Welch's
//! t-test*, Journal of Computer Graphics Techniques 9 (2020).

mod evidence;
pub mod permutation;

use self::evidence::PassSums;
use self::permutation::{Groups, distinct};
use super::judgement::{ComparisonMethod, Dependence, Judgement, StackComparison, Tile};
use super::{
    ImageError, ImageOptions, NOISY_VALUES, Stack, claim, repeats, tiles, variance, verdict,
};
use super::{neighbours_of, order_of, refuted};
use crate::{ROUNDING, SIDE_SHARE, decide_together, main_share};
use gate::stats::verdict::Verdict;

/// Claims about two stacks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Terms {
    /// True if both have the same distribution in each pixel, not only the same mean.
    pub is_same_distribution: bool,
    /// Bound on the rounding error of a value relative to its mean; at least that of the files.
    pub rounding: f64,
}

impl Default for Terms {
    fn default() -> Self {
        Self { is_same_distribution: false, rounding: ROUNDING }
    }
}

/// Judges a stack by a reference.
///
/// ```
/// use trueflight_judge::images::against::{Terms, compare};
/// use trueflight_judge::images::{ImageOptions, Size, Stack};
/// use gate::stats::verdict::Verdict;
///
/// // 16 passes of 16 × 16 pixels, each the mean of four fair coins, times a factor.
/// let size = Size { rows: 16, columns: 16, channels: 1 };
/// let stack = |seed: u64, factor: f64| {
///     let coins = (0..16 * size.pixels() as u64).map(|number| {
///         let bits = (seed << 32 | number).wrapping_mul(0x9e37_79b9_7f4a_7c15); // SplitMix64
///         let bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
///         let bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
///         factor * f64::from((bits >> 60).count_ones()) / 4.0
///     });
///     Stack::new(16, size, coins.collect())
/// };
/// let (reference, terms, wanted) = (stack(1, 1.0)?, Terms::default(), ImageOptions::default());
/// assert_ne!(compare(&stack(2, 1.0)?, &reference, terms, &wanted)?.verdict, Verdict::Fail);
/// assert_eq!(compare(&stack(2, 1.2)?, &reference, terms, &wanted)?.verdict, Verdict::Fail);
/// # Ok::<(), trueflight_judge::images::ImageError>(())
/// ```
///
/// # Errors
///
/// The options make no sense, the sizes differ, or a value of the reference is not finite.
pub fn compare(
    stack: &Stack,
    reference: &Stack,
    terms: Terms,
    required: &ImageOptions,
) -> Result<Judgement, ImageError> {
    required.check()?;
    check(stack, reference, terms)?;
    let (size, alpha) = (stack.size, required.alpha);
    let tile = required.tile(size, stack.passes.min(reference.passes), NOISY_VALUES);
    let mut judgement = Judgement::new(stack, alpha, tile);
    (judgement.refuted_by, judgement.refuting) = refuted(stack, |_, value| value.is_finite());
    judgement.neighbours = either([stack, reference].map(|stack| neighbours_of(stack, alpha)));
    let is_free = !judgement.neighbours.is_refuted();
    let is_flat = [stack, reference].iter().all(|stack| repeats::is_one_image(stack));
    let of = |stack| order_of(stack, is_flat, alpha);
    let ((one, repeated), (mut other, _)) = (of(stack), of(reference));
    if other.is_refuted() {
        other.reason = format!("the reference: {}", other.reason);
    }
    (judgement.order, judgement.repeated) = (either([one, other]), repeated);
    if let Some([p, q]) = repeats::shared(stack, reference) {
        judgement.order.reason = format!(
            "pass {p} and pass {q} of the reference share values, counted from 0: two stacks of the same passes say \
             nothing; give each stack seeds of its own"
        );
    }
    let mut comparison = StackComparison {
        passes: reference.passes,
        method: ComparisonMethod::None,
        permutations: 0,
        p: 1.0,
        is_same_distribution: terms.is_same_distribution,
        spread: None,
        spread_p: 1.0,
        kurtosis: None,
    };
    let mut differing = 0;
    if judgement.refuting == 0 && !judgement.order.is_refuted() {
        let evidence = PassSums::new(stack, reference, terms.rounding, required, is_free)?;
        differing = test([stack, reference], &evidence, &mut comparison, &mut judgement);
    }
    judgement.comparison = Some(comparison.clone());
    verdict::decide_against(&mut judgement, &comparison, differing);
    Ok(judgement)
}

/// Makes both tests of all tiles and wholes. Returns how many are rejected for equal distributions alone.
fn test(
    stacks: [&Stack; 2],
    evidence: &PassSums,
    comparison: &mut StackComparison,
    judgement: &mut Judgement,
) -> usize {
    let Judgement { size, tile, alpha, .. } = *judgement;
    let mut parts = tiles::parts(size, tile, true);
    let count = parts.len();
    parts.extend(tiles::wholes(size));
    let smallest: Vec<_> = parts.iter().copied().filter(|part| part.size == tile).collect();
    let q = stacks.map(|stack| variance::all_q(&[stack], &smallest, None));
    let q = q.iter().flatten().copied().filter(|q| q.is_finite()).fold(0.0, f64::max);
    comparison.kurtosis = (q > 0.0).then(|| variance::kurtosis(q));
    comparison.spread = evidence.spread();
    let rows = stacks.map(|stack| stack.passes);
    let level = if comparison.is_same_distribution { main_share(1) * alpha } else { alpha };
    let (mut all, adjusted) = if distinct(rows[0], rows[1]) >= 2.0 / level {
        let (values, prior) = evidence.rows(&parts);
        let finding = Groups::new(values, rows, &prior).compare(level, 1);
        (comparison.method, comparison.permutations) =
            (ComparisonMethod::Permutation, finding.deals);
        let (values, prior) = evidence.spreads();
        let spread = Groups::new(values, rows, &[prior]).compare(SIDE_SHARE * alpha, 2);
        comparison.spread_p = spread.p[0];
        (evidence.tiles(&parts, count, Some(&finding.p)), finding.adjusted)
    } else {
        let all = evidence.tiles(&parts, count, None);
        if all.iter().any(|tile| tile.p.is_some()) {
            comparison.method = ComparisonMethod::Signs;
        }
        let times = all.len() as f64;
        let of = |tile: &Tile| tile.p.map_or(1.0, |p| (times * p).min(1.0));
        let adjusted = all.iter().map(of).collect();
        (all, adjusted)
    };
    comparison.p = adjusted.iter().copied().fold(1.0, f64::min);
    let differing = decide(&mut all, &adjusted, level, alpha, comparison.is_same_distribution);
    let whole = all.split_off(count);
    judgement.take(all, whole);
    differing
}

fn check(stack: &Stack, reference: &Stack, terms: Terms) -> Result<(), ImageError> {
    if reference.size != stack.size {
        return Err(ImageError::Differ {
            file: "the stack of the reference".to_owned(),
            actual: reference.size,
            other: "a pass".to_owned(),
            expected: stack.size,
        });
    }
    if !(terms.rounding >= 0.0 && terms.rounding.is_finite()) {
        let (what, value) = ("rounding", terms.rounding);
        return Err(ImageError::Number { what, value, required: "a finite number, 0 or more" });
    }
    let passes = 0..reference.passes;
    passes.into_iter().try_for_each(|pass| {
        claim::check(
            "reference",
            stack.size,
            reference.pass(pass),
            &f64::is_finite,
            "a finite number",
        )
    })
}

/// Returns the dependence of either stack, if one was found.
fn either([one, other]: [Dependence; 2]) -> Dependence {
    if other.is_refuted() && !one.is_refuted() || other.evidence > one.evidence && !one.is_refuted()
    {
        other
    } else {
        one
    }
}

/// Fails every tile that both tests reject. Returns how many are rejected for equal distributions alone.
fn decide(
    tiles: &mut [Tile],
    adjusted: &[f64],
    level: f64,
    alpha: f64,
    is_same_distribution: bool,
) -> usize {
    let evidence: Vec<_> = tiles.iter().map(Tile::evidence).collect();
    let joint = decide_together(&evidence, alpha);
    let mut differing = 0;
    for ((tile, &adjusted), joint) in tiles.iter_mut().zip(adjusted).zip(joint) {
        let is_different = adjusted <= level;
        differing += usize::from(is_different && !joint.is_off && !is_same_distribution);
        tile.verdict = match (is_different, joint.is_off || is_same_distribution, joint.has_passed)
        {
            (true, true, _) => Verdict::Fail,
            (false, _, true) => Verdict::Pass,
            _ => Verdict::Inconclusive,
        };
        tile.is_listed = joint.is_listed;
    }
    differing
}
