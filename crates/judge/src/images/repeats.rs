//! Passes that repeat each other: one seed for two passes, or for parts of them.
//!
//! ```text
//! places   of each pixel: the passes in which a value stands that 2 or more of the n passes have, but not all
//! repeat   of t pixels with a value in k passes, c have it in the same k:   p ≤ C(t, c) C(n, k)^{1−c}
//! alike    passes a and b, and another one c for each pixel: x_b = x_a ≠ x_c is as probable as x_b = x_c ≠ x_a
//! ```
//!
//! If passes are independent and of one distribution, any k passes are as likely to share a pixel's value as any
//! others, for any distribution. The bound is for pixels of a pass that are independent of each other; all k from 2 to
//! n − 1 share the level. Zeros, the commonest atom, are left out. Pixels of few values, such as 0 and 1, have equal
//! values in many passes by coincidence. For them two passes are compared with a third one by signs, which are ±1 with
//! equal probability for every distribution, in e-values that are averaged over all pairs (`stats::independence`).
//!
//! Images that were made from the judged passes themselves, and stacks that share passes:
//!
//! ```text
//! truth      equals the mean of the passes, to rounding, wherever rounding is far below the standard error
//! variance   equals the sample variance of the passes (over n or n − 1) where they vary
//! passes     of two stacks: c of t values that stand in one pass of each stand in the same two passes:
//!            p ≤ C(t, c) (N M)^{1−c};   or two passes equal in every pixel, where others differ in many
//! ```
//!
//! The order within each stack does not matter: any two passes are as likely to share a rare value as any others.

use std::collections::BTreeMap;
use std::f64::consts::LN_2;
use std::hash::{DefaultHasher, Hash, Hasher};

use super::claim::Pixels;
use super::picture::Stack;
use super::variance;
use gate::stats::independence::Signs;

/// Approximate number of pixels that are compared.
const PIXELS: usize = 1 << 16;

/// ln of a probability below which a repetition is certain.
const SURE: f64 = -20.0;

/// Repetition of values in several passes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Repeat {
    /// Passes that share values.
    pub passes: Vec<u32>,
    /// ln of a bound on the probability of such a repetition.
    pub ln_p: f64,
}

/// Returns the least probable repetition; `None` if no value occurs twice.
pub(super) fn repeat(stack: &Stack) -> Option<Repeat> {
    // The two searches share the level.
    let (values, alike) = (by_values(stack), alike(stack));
    // If two passes of 0 and 1 are equal, all others share the other value in many pixels, without being equal.
    let is_most = |finding: &Repeat| 2 * finding.passes.len() > stack.passes;
    let is_sure = alike.as_ref().is_some_and(|finding| finding.ln_p < SURE);
    let values = values.filter(|finding| !(is_sure && is_most(finding)));
    let finding = [values, alike].into_iter().flatten();
    let finding = finding.map(|finding| Repeat { ln_p: (finding.ln_p + LN_2).min(0.0), ..finding });
    finding.min_by(|a, b| a.ln_p.total_cmp(&b.ln_p))
}

/// Returns the least probable repetition of values that few passes share.
fn by_values(stack: &Stack) -> Option<Repeat> {
    let (n, pixels) = (stack.passes, stack.size.pixels());
    let mut places: BTreeMap<Vec<u32>, u64> = BTreeMap::new();
    let mut values: Vec<(u64, u32)> = Vec::with_capacity(n);
    for pixel in (0..pixels).step_by(pixels.div_ceil(PIXELS)) {
        values.clear();
        values.extend((0_u32..).zip(0..n).map(|(p, pass)| (stack.grey(pass, pixel).to_bits(), p)));
        values.sort_unstable();
        for same in values.chunk_by(|a, b| a.0 == b.0) {
            if (2..n).contains(&same.len()) && f64::from_bits(same[0].0) != 0.0 {
                *places.entry(same.iter().map(|place| place.1).collect()).or_default() += 1;
            }
        }
    }
    let mut all: BTreeMap<usize, u64> = BTreeMap::new();
    for (passes, count) in &places {
        *all.entry(passes.len()).or_default() += count;
    }
    let finding = places.into_iter().map(|(passes, count)| {
        let (t, c) = (all[&passes.len()] as f64, count as f64);
        let ways = ln_choose(t, c) - (c - 1.0) * ln_choose(n as f64, passes.len() as f64);
        let ln_p = (ways + (n as f64 - 2.0).ln()).min(0.0);
        Repeat { passes, ln_p }
    });
    finding.min_by(|a, b| a.ln_p.total_cmp(&b.ln_p))
}

/// Number of parts of a pass: two passes are compared only if one part is equal in both.
const PARTS: usize = 8;
/// Maximum number of pairs of passes that are compared.
const MAX_PAIRS: usize = 1024;

/// Returns the two passes with the least probable agreement of pixels, and all others that are the same image.
fn alike(stack: &Stack) -> Option<Repeat> {
    let (n, pixels) = (stack.passes, stack.size.pixels());
    if n < 3 {
        return None;
    }
    let looked: Vec<usize> = (0..pixels).step_by(pixels.div_ceil(PIXELS)).collect();
    let mut alike: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for part in looked.chunks(looked.len().div_ceil(PARTS)) {
        let mut last: BTreeMap<u64, usize> = BTreeMap::new();
        for pass in 0..n {
            let mut hasher = DefaultHasher::new();
            for &pixel in part {
                stack.grey(pass, pixel).to_bits().hash(&mut hasher);
            }
            if let Some(earlier) = last.insert(hasher.finish(), pass) {
                *alike.entry((earlier, pass)).or_default() += 1;
            }
        }
    }
    let mut pairs: Vec<_> = alike.into_iter().collect();
    pairs.sort_by_key(|&(_, parts)| std::cmp::Reverse(parts));
    pairs.truncate(MAX_PAIRS);
    let evidence = |a: usize, b: usize| {
        let mut signs = Signs::default();
        for (&pixel, turn) in looked.iter().zip(0..) {
            // The third pass changes from pixel to pixel.
            let c = (0..3).map(|k| (turn + k) % n).find(|c| ![a, b].contains(c)).unwrap_or(0);
            let [x, y, z] = [a, b, c].map(|pass| stack.grey(pass, pixel));
            if x != z && (x == y || y == z) {
                signs.add(1.0, if x == y { 1.0 } else { -1.0 });
            }
        }
        signs.ln_e()
    };
    let finding = pairs.into_iter().map(|((a, b), _)| (evidence(a, b), a, b));
    let (ln_e, a, b) = finding.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let is_same = |pass: usize| looked.iter().all(|&p| stack.grey(pass, p) == stack.grey(a, p));
    let named = (0_u32..).zip(0..n).filter(|&(_, pass)| pass == a || pass == b || is_same(pass));
    let passes = named.map(|(pass, _)| pass).collect();
    Some(Repeat { passes, ln_p: (ln_choose(n as f64, 2.0) - ln_e).min(0.0) })
}

/// Number of different values in an image above which a distribution cannot plausibly repeat it in all passes.
const VARIED: usize = 8;

/// Returns whether all passes are one image of many values: passes of few values may be equal by coincidence.
pub(super) fn is_one_image(stack: &Stack) -> bool {
    let first = stack.pass(0);
    let mut values: Vec<u64> = first.iter().map(|x| x.to_bits()).collect();
    values.sort_unstable();
    values.dedup();
    values.len() >= VARIED
        && (1..stack.passes).all(|pass| stack.pass(pass).iter().zip(first).all(|(x, y)| x == y))
}

/// Returns `ln C(n, k)`.
fn ln_choose(n: f64, k: f64) -> f64 {
    libm::lgamma(n + 1.0) - libm::lgamma(k + 1.0) - libm::lgamma(n - k + 1.0)
}

/// Smallest number of compared values.
const MIN_VALUES: usize = 32;
/// ln of the probability below which passes count as shared.
const LN_SHARED: f64 = -23.0;

/// Returns whether the truth is the mean of the passes.
pub(super) fn is_own_truth(stack: &Stack, pixels: &Pixels) -> bool {
    let n = stack.passes as f64;
    let mut compared = 0;
    for i in 0..stack.size.values() {
        let (mean, variance) = (stack.mean(i), stack.variance(i));
        let floor = pixels.floor(i).max(1e-6 * mean.abs());
        if (variance / n).sqrt() < 20.0 * floor {
            continue;
        }
        if (mean - pixels.truth[i]).abs() > floor {
            return false;
        }
        compared += 1;
    }
    compared >= MIN_VALUES
}

/// Returns whether the variance is that of the passes.
pub(super) fn is_own_variance(stack: &Stack, pixels: &Pixels) -> bool {
    let (Some(claimed), Ok(own)) = (&pixels.variance, variance::variances(stack)) else {
        return false;
    };
    let n = stack.passes as f64;
    let is_equal = |scale: f64| {
        let varying = own.values.iter().zip(claimed).filter(|(own, _)| **own > 0.0);
        let is_near = |own: f64, claimed: f64| (own * scale - claimed).abs() <= 2e-3 * claimed;
        varying.clone().count() >= MIN_VALUES && varying.clone().all(|(own, v)| is_near(*own, *v))
    };
    is_equal(1.0) || is_equal((n - 1.0) / n)
}

/// Returns a pass of each stack, from 0, that have values in common; `None` if there are no such passes.
pub(super) fn shared(one: &Stack, other: &Stack) -> Option<[usize; 2]> {
    equal(one, other).or_else(|| rare_values(one, other))
}

/// Returns two passes that are equal in every pixel.
fn equal(one: &Stack, other: &Stack) -> Option<[usize; 2]> {
    let pairs = (0..one.passes).flat_map(|p| (0..other.passes).map(move |q| [p, q]));
    let finding = pairs.clone().find(|&[p, q]| one.pass(p) == other.pass(q))?;
    // Probability that independent passes agree: the share of equal pairs in each pixel.
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
    // Any pair of passes may be equal by coincidence. A pixel that never varies is equal in all passes.
    let is_constant = ln_p > LN_SHARED - all.ln();
    (!is_constant).then_some(finding)
}

/// Returns two passes with many values that no other pass has.
fn rare_values(one: &Stack, other: &Stack) -> Option<[usize; 2]> {
    let pixels = one.size.pixels();
    let mut places: BTreeMap<[usize; 2], f64> = BTreeMap::new();
    for pixel in (0..pixels).step_by(pixels.div_ceil(PIXELS)) {
        let mut finding: BTreeMap<u64, [Vec<usize>; 2]> = BTreeMap::new();
        for (k, stack) in [one, other].into_iter().enumerate() {
            for pass in 0..stack.passes {
                finding.entry(stack.grey(pass, pixel).to_bits()).or_default()[k].push(pass);
            }
        }
        for (bits, passes) in finding {
            if let ([p], [q], true) = (&*passes[0], &*passes[1], f64::from_bits(bits) != 0.0) {
                *places.entry([*p, *q]).or_default() += 1.0;
            }
        }
    }
    let all: f64 = places.values().sum();
    let ln_pairs = ((one.passes * other.passes) as f64).ln();
    let ln_p = |c: f64| ln_choose(all, c) - (c - 1.0) * ln_pairs;
    let is_shared = |(_, c): &(&[usize; 2], &f64)| ln_p(**c) <= LN_SHARED;
    places.iter().filter(is_shared).max_by(|a, b| a.1.total_cmp(b.1)).map(|(pair, _)| *pair)
}

#[cfg(test)]
mod tests {
    use super::super::picture::Size;
    use super::*;
    use numeric::rng::{Address, unit};

    const SIZE: Size = Size { rows: 30, columns: 40, channels: 1 };

    fn passes(seed: u64, n: usize, of: impl Fn(f64) -> f64) -> Vec<Vec<f64>> {
        let mut rng = Address { seed, experiment: 8, block: 0, lane: 0 }.stream();
        (0..n).map(|_| (0..SIZE.pixels()).map(|_| of(unit(&mut rng))).collect()).collect()
    }

    fn found(passes: &[Vec<f64>]) -> Option<Repeat> {
        repeat(&Stack::new(passes.len(), SIZE, passes.concat()).expect("a stack"))
    }

    #[test]
    fn equal_passes_are_named() {
        let mut passes = passes(1, 6, |u| u);
        assert_eq!(found(&passes), None);
        passes[4] = passes[1].clone();
        let repeat = found(&passes).expect("one");
        assert_eq!(repeat.passes, [1, 4]);
        assert!(repeat.ln_p < -1000.0, "{repeat:?}");
        // All but one.
        for pass in 0..5 {
            passes[pass] = passes[1].clone();
        }
        assert_eq!(found(&passes).expect("one").passes, [0, 1, 2, 3, 4]);
    }

    #[test]
    fn a_tenth_of_a_pass_is_enough() {
        let mut passes = passes(2, 5, |u| u);
        let (before, after) = passes.split_at_mut(3);
        after[0][..120].copy_from_slice(&before[0][..120]);
        let repeat = found(&passes).expect("one");
        assert!(repeat.passes == [0, 3] && repeat.ln_p < -100.0, "{repeat:?}");
    }

    #[test]
    fn equal_passes_of_pixels_that_are_0_or_1_are_named() {
        for p in [0.5, 0.1, 0.97] {
            let mut passes = passes(3, 12, |u| f64::from(u8::from(u < p)));
            passes[7] = passes[2].clone();
            let repeat = found(&passes).expect("one");
            assert!(repeat.passes == [2, 7] && repeat.ln_p < -20.0, "{p}: {repeat:?}");
            // Three seeds in turn.
            for pass in 3..12 {
                passes[pass] = passes[pass % 3].clone();
            }
            let repeat = found(&passes).expect("one");
            assert!(repeat.passes.len() == 4 && repeat.ln_p < -20.0, "{p}: {repeat:?}");
        }
    }

    #[test]
    fn coarse_values_are_no_repetition() {
        for seed in 0..20 {
            for steps in [1.0, 2.0, 3.0, 30.0] {
                let coarse = found(&passes(seed, 7, |u| (u * steps).ceil().min(steps) + 1.0));
                assert!(coarse.is_none_or(|finding| finding.ln_p > -9.0), "{steps}");
            }
        }
    }
}
