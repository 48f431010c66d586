//! Variance of the pixels: the error of an estimated one, and a test whether the claimed one is too small.
//!
//! ```text
//! V_i   the sample variance of Q other passes in pixel i; below 0: 0, no number: the pixel is not judged
//! V̂     the mean of V_i over a tile
//! Y     (x_2k − x_2k+1)²/2 of consecutive passes: non-negative, of mean V_i
//! q     n ΣY²/(ΣY)² over the n Y of a tile, of the passes judged and of the stack of the variance;  (κ + 3)/2
//! r     max(q, the mean q of all tiles of that size)/(⌊Q/2⌋ pixels)         see `stats::estimated_variance`
//! ```
//!
//! A negative entry is noise of an estimate. Counting it as 0 makes V̂ larger, which weakens the evidence. An entry of
//! 0 means that Q passes did not vary, not that no pass would: it makes nothing fail. Rare bright values in one tile
//! make q large in all tiles.
//!
//! A variance that is too small is detected by squares over all pixels:
//!
//! ```text
//! y = (x − T)²/V − 1 ≥ −1      in the mean over a pixel's channels; blocks of passes as for tiles
//! E    bets against a mean of y above 0: squares need no kurtosis to be refuted as too large
//! s²/V the mean over pixels of what their passes show about their own mean
//! ```
//!
//! If the pixels of a pass depend on each other, a draw is the average of y over a pass.

use super::claim::{Claim, ImageError, Level, Pixels};
use super::judgement;
use super::picture::{Picture, Size, Stack};
use super::tiles::Part;
use crate::{AT_THE_END, Quantity, Scalar};
use gate::session::quantity::{VARIANCE_CAP, variance_floor};
use gate::stats::estimated_variance::Estimate;
use theory::parallel;

/// Estimated variance of the pixels.
pub(super) struct Estimated {
    /// Q.
    pub passes: usize,
    /// `true` for values with a variance that is NaN or infinite.
    pub is_unknown: Vec<bool>,
    pub negative: u64,
    pub unknown: u64,
    /// Index of the first entry that is negative or not finite.
    pub first: Option<usize>,
    /// Passes that it was estimated from, if these are known.
    pub stack: Option<Stack>,
}

impl Estimated {
    /// Returns the variances, none of them negative, and their estimate; `None` for an exact variance, or none.
    pub(super) fn of(claim: &Claim, size: Size) -> Result<Option<(Vec<f64>, Self)>, ImageError> {
        let (level, passes) = match (&claim.variance_stack, &claim.variance, claim.variance_passes)
        {
            (Some(stack), _, _) => {
                if stack.size != size {
                    return Err(ImageError::Differ {
                        file: "the stack of the variance".to_owned(),
                        actual: stack.size,
                        other: "a pass".to_owned(),
                        expected: size,
                    });
                }
                (Level::Each(variances(stack)?), stack.passes)
            }
            (None, Some(level), Some(passes)) => (level.clone(), passes),
            _ => return Ok(None),
        };
        let mut variance = level.spread("variance", size)?;
        let (mut negative, mut unknown, mut first) = (0, 0, None);
        let is_unknown: Vec<bool> = variance.iter().map(|v| !v.is_finite()).collect();
        for (index, value) in variance.iter_mut().enumerate() {
            if *value >= 0.0 && value.is_finite() {
                continue;
            }
            first.get_or_insert(index);
            let is_negative = value.is_finite();
            negative += u64::from(is_negative);
            unknown += u64::from(!is_negative);
            *value = 0.0;
        }
        let stack = claim.variance_stack.clone();
        Ok(Some((variance, Self { passes, is_unknown, negative, unknown, first, stack })))
    }

    /// Returns the summary of the estimate for a judgement.
    pub(super) fn summary(
        &self,
        claim: &Claim,
        size: Size,
        tile: usize,
        parts: &[Part],
        q: &[f64],
    ) -> judgement::VarianceEstimate {
        let smallest = parts.iter().zip(q).filter(|(part, _)| part.size == tile);
        judgement::VarianceEstimate {
            passes: self.passes,
            kurtosis: kurtosis(smallest.map(|(_, q)| *q).fold(0.0, f64::max)),
            is_given: claim.kurtosis.is_some(),
            negative: self.negative,
            unknown: self.unknown,
            first: self.first.map(|index| size.place(index)),
        }
    }
}

/// Returns the sample variances of the passes of each value.
pub(super) fn variances(stack: &Stack) -> Result<Picture, ImageError> {
    let of = |i: usize| stack.variance(i);
    Picture::new(stack.size, (0..stack.size.values()).map(of).collect())
}

/// Sums over the Y of a tile.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Pairs {
    pub count: f64,
    pub sum: f64,
    pub squares: f64,
}

impl Pairs {
    /// Adds the Y of the passes of a part.
    pub(super) fn add(&mut self, stack: &Stack, places: &(impl Iterator<Item = usize> + Clone)) {
        for first in (0..stack.passes - 1).step_by(2) {
            let (one, other) = (stack.pass(first), stack.pass(first + 1));
            for i in places.clone() {
                self.add_one(0.5 * (one[i] - other[i]).powi(2));
            }
        }
    }

    /// Adds one Y.
    pub(super) fn add_one(&mut self, y: f64) {
        self.count += 1.0;
        self.sum += y;
        self.squares += y * y;
    }

    /// Returns q; `None` if nothing varies.
    pub(super) fn q(&self) -> Option<f64> {
        let q = self.count * self.squares / (self.sum * self.sum);
        Some(q).filter(|q| q.is_finite())
    }
}

/// Returns q of each part: its own, or the mean of all parts of that size and channel, whichever is larger; infinite if
/// no such part varies.
pub(super) fn all_q(stacks: &[&Stack], parts: &[Part], kurtosis: Option<f64>) -> Vec<f64> {
    if let Some(kurtosis) = kurtosis {
        return vec![0.5 * (kurtosis + 3.0); parts.len()];
    }
    let own = parallel::map(parts, |part| {
        let mut pairs = Pairs::default();
        for stack in stacks {
            pairs.add(stack, &part.places(stack));
        }
        pairs.q()
    });
    let kind = |part: &Part| (part.size, part.channel);
    let mut means = std::collections::BTreeMap::<(usize, usize), (f64, f64)>::new();
    for (part, q) in parts.iter().zip(&own) {
        if let Some(q) = q {
            let mean = means.entry(kind(part)).or_default();
            *mean = (mean.0 + q, mean.1 + 1.0);
        }
    }
    let all = |part: &Part| means.get(&kind(part)).map_or(f64::INFINITY, |(sum, n)| sum / n);
    parts.iter().zip(own).map(|(part, q)| all(part).max(q.unwrap_or(0.0))).collect()
}

/// Returns the κ that corresponds to a q.
pub(super) fn kurtosis(q: f64) -> f64 {
    (2.0 * q - 3.0).max(1.0)
}

/// Returns the estimate of the variance of a tile of `pixels` pixels, V̂ above 0, from Q passes.
pub(super) fn of_tile(variance: f64, q: f64, passes: usize, pixels: f64) -> Estimate {
    Estimate { variance, error: q / ((passes / 2) as f64 * pixels) }
}

/// Evidence against the claimed variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Squares {
    /// ln E.
    pub ln_e: f64,
    /// 1 + the mean of y.
    pub about_truth: f64,
    /// s²/V.
    pub about_mean: f64,
}

/// Returns ln E of squares y against a variance that is not too small, and the sum of all y. `y` appends those of a
/// unit.
fn too_small(
    floor: f64,
    units: usize,
    is_free: bool,
    y: impl Fn(usize, &mut Vec<f64>),
) -> (f64, f64) {
    let mut sum = 0.0;
    let of_block = |first: usize, last: usize, to: &mut Vec<f64>| {
        for unit in first..last {
            let before = to.len();
            y(unit, to);
            let all: f64 = to[before..].iter().sum();
            sum += all;
            if !is_free {
                let draws = (to.len() - before) as f64;
                to.truncate(before);
                to.push(all / draws);
            }
        }
    };
    let range = Some([-1.0, f64::INFINITY]); // a square is never below 0
    let quantity = Quantity { range, ..Quantity::variance(None, floor) };
    let scalar = Scalar::of_all(quantity, None, AT_THE_END, units, of_block);
    (scalar.evidence.ln_e, sum)
}

/// Compares squares with the variance; `None` if none is claimed, or all are certain.
pub(super) fn squares(stack: &Stack, pixels: &Pixels, is_free: bool) -> Option<Squares> {
    let variance = pixels.variance.as_ref()?;
    let channels = stack.size.channels;
    let judged: Vec<usize> = (0..stack.size.pixels())
        .filter(|pixel| (0..channels).all(|c| !pixels.is_certain(pixel * channels + c)))
        .collect();
    if judged.is_empty() {
        return None;
    }
    let of_pixel = |pixel: usize, of: &dyn Fn(usize) -> f64| {
        let first = pixel * channels;
        (first..first + channels).map(|i| of(i) / variance[i]).sum::<f64>() / channels as f64
    };
    // Rounding hides a variance that is too small.
    let noise = |i: usize| variance_floor(variance[i], 0.0, pixels.floor(i));
    let floors = judged.iter().flat_map(|pixel| (0..channels).map(move |c| pixel * channels + c));
    let floor = floors.map(noise).sum::<f64>() / (judged.len() * channels) as f64;
    if floor > 0.25 * VARIANCE_CAP {
        return None;
    }
    let n = stack.passes as f64;
    let (ln_e, sum) = too_small(floor, stack.passes, is_free, |pass, y| {
        let values = stack.pass(pass);
        let square = |i: usize| (values[i] - pixels.truth[i]).powi(2);
        y.extend(judged.iter().map(|&pixel| of_pixel(pixel, &square) - 1.0));
    });
    let shown = |pixel: &usize| of_pixel(*pixel, &|i| stack.variance(i));
    let about_mean = judged.iter().map(shown).sum::<f64>();
    Some(Squares {
        ln_e,
        about_truth: 1.0 + sum / (n * judged.len() as f64),
        about_mean: about_mean / judged.len() as f64,
    })
}

/// Compares pairs of passes with an estimated variance, or for a truth that has an error.
///
/// ```text
/// y = (x_2k − x_2k+1)²/(2V) − 1 ≥ −1;   V of the pixel where it is exact, else a bound on the mean of all pixels:
///     V̂/(1 − √(2r ln(2/α_v)))    as of `stats::estimated_variance`, which takes half of the level α_v
/// ```
///
/// Returns the squares with that bound over V̂ and with r.
pub(super) fn pairs(
    stack: &Stack,
    pixels: &Pixels,
    q: f64,
    is_free: bool,
    level: f64,
) -> Option<(Squares, f64, f64)> {
    let variance = pixels.variance.as_ref()?;
    let is_judged = |&i: &usize| !pixels.is_certain(i) && pixels.is_known(i);
    let judged: Vec<usize> = (0..stack.size.values()).filter(is_judged).collect();
    let count = judged.len() as f64;
    let claimed = judged.iter().map(|&i| variance[i]).sum::<f64>() / count;
    if claimed.is_nan() || claimed <= 0.0 {
        return None;
    }
    // The channels of a pixel depend on each other: they are one draw.
    let pixel = |i: &usize| i / stack.size.channels;
    let groups: Vec<&[usize]> = judged.chunk_by(|i, j| pixel(i) == pixel(j)).collect();
    let draws = groups.len() as f64;
    let estimate = match &pixels.estimate {
        Some(actual) => of_tile(1.0, q, actual.passes, draws),
        None => Estimate { variance: 1.0, error: 0.0 },
    };
    let excess = estimate.upper(0.5 * level)?;
    let of = |i: usize| if pixels.estimate.is_some() { claimed * excess } else { variance[i] };
    let floor = judged.iter().map(|&i| pixels.floor(i).powi(2) / of(i)).sum::<f64>() / count;
    if floor > 0.25 * VARIANCE_CAP {
        return None;
    }
    let count_pairs = stack.passes / 2;
    let (ln_e, sum) = too_small(floor, count_pairs, is_free, |pair, y| {
        let (one, other) = (stack.pass(2 * pair), stack.pass(2 * pair + 1));
        let square = |i: &usize| 0.5 * (one[*i] - other[*i]).powi(2) / of(*i);
        let of_group = |group: &&[usize]| group.iter().map(square).sum::<f64>() * draws / count;
        y.extend(groups.iter().map(|group| of_group(group) - 1.0));
    });
    let ratio = (1.0 + sum / (count_pairs as f64 * draws)) * excess;
    let ln_share = if pixels.estimate.is_some() { std::f64::consts::LN_2 } else { 0.0 };
    Some((
        Squares { ln_e: ln_e - ln_share, about_truth: ratio, about_mean: ratio },
        excess,
        estimate.error,
    ))
}
