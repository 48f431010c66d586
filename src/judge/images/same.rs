//! Images that were made of the very passes that are judged, and stacks that share passes.
//!
//! ```text
//! truth      equals the mean of the passes, to rounding, wherever rounding is far below the standard error
//! variance   equals the sample variance of the passes (over n or n − 1) where they vary
//! passes     of two stacks: c of t values that stand in one pass of each stand in the same two passes:
//!            p ≤ C(t, c) (N M)^{1−c};   or two passes equal in every pixel, where others differ in many
//! ```
//!
//! The order within each stack says nothing, so that any two passes are as likely to share a rare value as any others.

use std::collections::BTreeMap;

use super::claim::Pixels;
use super::estimate;
use super::picture::Stack;

/// Least number of compared values.
const FEWEST: usize = 32;
/// About how many pixels are looked at.
const PIXELS: usize = 1 << 16;
/// ln of the probability below which passes count as shared.
const LN_SHARED: f64 = -23.0;

/// Whether the truth is the mean of the passes.
pub(super) fn is_own_truth(stack: &Stack, pixels: &Pixels) -> bool {
    let n = stack.passes as f64;
    let all = |i: usize| (0..stack.passes).map(move |pass| stack.pass(pass)[i]);
    let mut compared = 0;
    for i in 0..stack.size.values() {
        let mean = all(i).sum::<f64>() / n;
        let variance = all(i).map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let floor = pixels.floor(i).max(1e-6 * mean.abs());
        if (variance / n).sqrt() < 20.0 * floor {
            continue;
        }
        if (mean - pixels.truth[i]).abs() > floor {
            return false;
        }
        compared += 1;
    }
    compared >= FEWEST
}

/// Whether the variance is that of the passes.
pub(super) fn is_own_variance(stack: &Stack, pixels: &Pixels) -> bool {
    let (Some(claimed), Ok(own)) = (&pixels.variance, estimate::variances(stack)) else {
        return false;
    };
    let n = stack.passes as f64;
    let is_equal = |scale: f64| {
        let varying = own.values.iter().zip(claimed).filter(|(own, _)| **own > 0.0);
        let is_near = |own: f64, claimed: f64| (own * scale - claimed).abs() <= 2e-3 * claimed;
        varying.clone().count() >= FEWEST && varying.clone().all(|(own, v)| is_near(*own, *v))
    };
    is_equal(1.0) || is_equal((n - 1.0) / n)
}

/// A pass of each stack, from 0, that have values in common; `None` where nothing of that kind is found.
pub(super) fn shared(one: &Stack, other: &Stack) -> Option<[usize; 2]> {
    equal(one, other).or_else(|| rare_values(one, other))
}

/// Two passes that are equal in every pixel.
fn equal(one: &Stack, other: &Stack) -> Option<[usize; 2]> {
    let pairs = (0..one.passes).flat_map(|p| (0..other.passes).map(move |q| [p, q]));
    let found = pairs.clone().find(|&[p, q]| one.pass(p) == other.pass(q))?;
    // How often independent passes agree: the share of all pairs in each pixel.
    let all = (one.passes * other.passes) as f64;
    let pixels = one.size.values();
    let ln_p: f64 = (0..pixels)
        .step_by(pixels.div_ceil(PIXELS))
        .map(|i| {
            let mut counts = BTreeMap::<u64, [f64; 2]>::new();
            for (k, stack) in [one, other].into_iter().enumerate() {
                for pass in 0..stack.passes {
                    counts.entry(stack.pass(pass)[i].to_bits()).or_default()[k] += 1.0;
                }
            }
            (counts.values().map(|[a, b]| a * b).sum::<f64>() / all).max(1.0 / all).ln()
        })
        .sum();
    // Any of all pairs may be equal by chance. What never varies is equal in all passes.
    let is_constant = ln_p > LN_SHARED - all.ln();
    (!is_constant).then_some(found)
}

/// Two passes with many values that no other pass has.
fn rare_values(one: &Stack, other: &Stack) -> Option<[usize; 2]> {
    let pixels = one.size.pixels();
    let mut places: BTreeMap<[usize; 2], f64> = BTreeMap::new();
    for pixel in (0..pixels).step_by(pixels.div_ceil(PIXELS)) {
        let mut found: BTreeMap<u64, [Vec<usize>; 2]> = BTreeMap::new();
        for (k, stack) in [one, other].into_iter().enumerate() {
            for pass in 0..stack.passes {
                found.entry(stack.grey(pass, pixel).to_bits()).or_default()[k].push(pass);
            }
        }
        for (bits, passes) in found {
            if let ([p], [q], true) = (&*passes[0], &*passes[1], f64::from_bits(bits) != 0.0) {
                *places.entry([*p, *q]).or_default() += 1.0;
            }
        }
    }
    let all: f64 = places.values().sum();
    let ln_pairs = ((one.passes * other.passes) as f64).ln();
    let ln_choose =
        |c: f64| libm::lgamma(all + 1.0) - libm::lgamma(c + 1.0) - libm::lgamma(all - c + 1.0);
    let ln_p = |c: f64| ln_choose(c) - (c - 1.0) * ln_pairs;
    let is_shared = |(_, c): &(&[usize; 2], &f64)| ln_p(**c) <= LN_SHARED;
    places.iter().filter(is_shared).max_by(|a, b| a.1.total_cmp(b.1)).map(|(pair, _)| *pair)
}
