//! A variance that was itself estimated: what its entries are, and how far it may be off.
//!
//! ```text
//! V_i   the sample variance of Q other passes in pixel i; below 0: 0, no number: the pixel is not judged
//! V̂     the mean of V_i over a tile
//! Y     (x_2k − x_2k+1)²/2 of consecutive passes: non-negative, of mean V_i
//! q     n ΣY²/(ΣY)² over the n Y of a tile, of the passes judged and of the stack of the variance;  (κ + 3)/2
//! r     max(q, the mean q of all tiles of that size)/(⌊Q/2⌋ pixels)         see `stats::estimated_variance`
//! ```
//!
//! A negative entry is noise of an estimate. Counting it as 0 makes V̂ larger, so that evidence gets less. A 0 says that
//! nothing was seen in Q passes, not that nothing varies: nothing fails for that. Rare bright values that were seen in
//! one tile make q large in all.

use super::claim::{Claim, Level};
use super::error::ImageError;
use super::judgement;
use super::picture::{Picture, Size, Stack};
use super::tiles::Part;
use gate::stats::estimated_variance::Estimate;
use theory::parallel;

/// What is kept of an estimated variance.
pub(super) struct Estimated {
    /// Q.
    pub passes: usize,
    /// `true` for values with a variance that is NaN or infinite.
    pub is_unknown: Vec<bool>,
    pub negative: u64,
    pub unknown: u64,
    /// The place of the first entry that is negative or no number.
    pub first: Option<usize>,
    /// The passes that it was taken from, where these are known.
    pub stack: Option<Stack>,
}

impl Estimated {
    /// Returns the variances, none of them negative, and what was found of them; `None` for an exact variance, or none.
    pub(super) fn of(claim: &Claim, size: Size) -> Result<Option<(Vec<f64>, Self)>, ImageError> {
        let (level, passes) = match (&claim.variance_stack, &claim.variance, claim.variance_passes)
        {
            (Some(stack), _, _) => {
                if stack.size != size {
                    return Err(ImageError::Differ {
                        file: "the stack of the variance".to_owned(),
                        found: stack.size,
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
}

impl Estimated {
    /// What is said of it.
    pub(super) fn told(
        &self,
        claim: &Claim,
        size: Size,
        tile: usize,
        parts: &[Part],
        q: &[f64],
    ) -> judgement::Estimate {
        let smallest = parts.iter().zip(q).filter(|(part, _)| part.size == tile);
        let place = |index: usize| {
            let (pixel, channel) = (index / size.channels, index % size.channels);
            [pixel / size.columns, pixel % size.columns, channel]
        };
        judgement::Estimate {
            passes: self.passes,
            kurtosis: kurtosis(smallest.map(|(_, q)| *q).fold(0.0, f64::max)),
            is_given: claim.kurtosis.is_some(),
            negative: self.negative,
            unknown: self.unknown,
            first: self.first.map(place),
        }
    }
}

/// Sample variances of the passes of each value.
pub(super) fn variances(stack: &Stack) -> Result<Picture, ImageError> {
    let n = stack.passes as f64;
    let of = |i: usize| {
        let values = || (0..stack.passes).map(|pass| stack.pass(pass)[i]);
        let mean = values().sum::<f64>() / n;
        values().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0)
    };
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
                let y = 0.5 * (one[i] - other[i]).powi(2);
                self.count += 1.0;
                self.sum += y;
                self.squares += y * y;
            }
        }
    }

    /// q; `None` where nothing varies.
    pub(super) fn q(&self) -> Option<f64> {
        let q = self.count * self.squares / (self.sum * self.sum);
        Some(q).filter(|q| q.is_finite())
    }
}

/// q of each part: its own, or the mean of all parts of that size and channel, whichever is larger; infinite where no
/// such part varies.
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

/// κ that a q stands for.
pub(super) fn kurtosis(q: f64) -> f64 {
    (2.0 * q - 3.0).max(1.0)
}

/// The estimate of the variance of a tile of `pixels` pixels, V̂ above 0, from Q passes.
pub(super) fn of_tile(variance: f64, q: f64, passes: usize, pixels: f64) -> Estimate {
    Estimate { variance, error: q / ((passes / 2) as f64 * pixels) }
}
