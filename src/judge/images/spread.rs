//! Whether the claimed variance is too small: squares over all pixels.
//!
//! ```text
//! y = (x − T)²/V − 1 ≥ −1      in the mean over a pixel's channels; blocks of passes as for tiles
//! E    bets against a mean of y above 0: squares need no kurtosis to be refuted as too large
//! s²/V the mean over pixels of what their passes show about their own mean
//! ```
//!
//! Where the pixels of a pass depend on each other a draw is the average of y over a pass.

use super::claim::Pixels;
use super::estimate;
use super::picture::Stack;
use super::tiles::{AT_THE_END, judged as judge};
use crate::judge::Quantity;
use gate::session::quantity::{VARIANCE_CAP, variance_floor};

/// What was found of the variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Squares {
    /// ln E.
    pub ln_e: f64,
    /// 1 + the mean of y.
    pub about_truth: f64,
    /// s²/V.
    pub about_mean: f64,
}

/// The variance, of which a square is never below 0.
fn variance(floor: f64) -> Quantity {
    Quantity { range: Some([-1.0, f64::INFINITY]), ..Quantity::variance(None, floor) }
}

/// Compares squares with the variance; `None` where none is claimed, or all are certain.
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
    // Too much rounding hides the variance.
    let noise = |i: usize| variance_floor(variance[i], 0.0, pixels.floor(i));
    let floors = judged.iter().flat_map(|pixel| (0..channels).map(move |c| pixel * channels + c));
    let floor = floors.map(noise).sum::<f64>() / (judged.len() * channels) as f64;
    if floor > 0.25 * VARIANCE_CAP {
        return None;
    }
    let n = stack.passes as f64;
    let mut sum = 0.0;
    let of_block =
        |first: usize, last: usize, y: &mut Vec<f64>| {
            for pass in first..last {
                let values = stack.pass(pass);
                let before = y.len();
                y.extend(judged.iter().map(|&pixel| {
                    of_pixel(pixel, &|i| (values[i] - pixels.truth[i]).powi(2)) - 1.0
                }));
                let all: f64 = y[before..].iter().sum();
                sum += all;
                if !is_free {
                    y.truncate(before);
                    y.push(all / judged.len() as f64);
                }
            }
        };
    let scalar = judge(self::variance(floor), None, AT_THE_END, stack.passes, of_block);
    let shown = |i: usize| {
        let values = || (0..stack.passes).map(|pass| stack.pass(pass)[i]);
        let mean = values().sum::<f64>() / n;
        values().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0)
    };
    let about_mean = judged.iter().map(|&pixel| of_pixel(pixel, &shown)).sum::<f64>();
    Some(Squares {
        ln_e: scalar.evidence.ln_e,
        about_truth: 1.0 + sum / (n * judged.len() as f64),
        about_mean: about_mean / judged.len() as f64,
    })
}

/// Compares pairs of passes with a variance that was estimated, or where the truth has an error of its own.
///
/// ```text
/// y = (x_2k − x_2k+1)²/(2V) − 1 ≥ −1;   V of the pixel where it is exact, else a bound on the mean of all pixels:
///     V̂/(1 − √(2r ln(2/α_v)))    as of `stats::estimated_variance`, which takes half of the level α_v
/// ```
pub(super) fn pairs(
    stack: &Stack,
    pixels: &Pixels,
    q: f64,
    is_free: bool,
    level: f64,
) -> Option<(Squares, f64)> {
    let variance = pixels.variance.as_ref()?;
    let is_judged = |&i: &usize| {
        !pixels.is_certain(i) && pixels.estimate.as_ref().is_none_or(|found| !found.is_unknown[i])
    };
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
    let excess = match &pixels.estimate {
        Some(found) => estimate::of_tile(1.0, q, found.passes, draws).upper(0.5 * level)?,
        None => 1.0,
    };
    let of = |i: usize| if pixels.estimate.is_some() { claimed * excess } else { variance[i] };
    let floor = judged.iter().map(|&i| pixels.floor(i).powi(2) / of(i)).sum::<f64>() / count;
    if floor > 0.25 * VARIANCE_CAP {
        return None;
    }
    let mut sum = 0.0;
    let count_pairs = stack.passes / 2;
    let of_block = |first: usize, last: usize, y: &mut Vec<f64>| {
        for pair in first..last {
            let (one, other) = (stack.pass(2 * pair), stack.pass(2 * pair + 1));
            let square = |i: &usize| 0.5 * (one[*i] - other[*i]).powi(2) / of(*i);
            let before = y.len();
            y.extend(
                groups
                    .iter()
                    .map(|group| group.iter().map(square).sum::<f64>() * draws / count - 1.0),
            );
            let all: f64 = y[before..].iter().sum();
            sum += all;
            if !is_free {
                y.truncate(before);
                y.push(all / draws);
            }
        }
    };
    let scalar = judge(self::variance(floor), None, AT_THE_END, count_pairs, of_block);
    let ratio = (1.0 + sum / (count_pairs as f64 * draws)) * excess;
    let ln_share = if pixels.estimate.is_some() { std::f64::consts::LN_2 } else { 0.0 };
    let ln_e = scalar.evidence.ln_e - ln_share;
    Some((Squares { ln_e, about_truth: ratio, about_mean: ratio }, excess))
}
