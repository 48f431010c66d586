//! `judge --images` with noisy variances, truths or references.

mod command;
mod references;

use trueflight::judge::images::against::{Terms, compare};
use trueflight::judge::images::{
    Claim, ImageOptions, Judgement, Level, Picture, Size, Stack, judge,
};
use trueflight::rng::{Address, unit};
use trueflight::stats::normal::upper_quantile;
use trueflight::stats::verdict::Verdict;

const SIZE: Size = Size { rows: 24, columns: 24, channels: 1 };
const PIXELS: usize = 24 * 24;

/// Distributions of a value of mean 1.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Law {
    /// Normal distribution of standard deviation 0.5.
    Normal,
    /// 1/p with probability p, else 0.
    Rare(f64),
    /// Log-normal weight with probability 0.5, else 0.
    Fireflies(f64),
    /// Mean of 4 such weights.
    FourFireflies(f64),
}

impl Law {
    fn variance(self) -> f64 {
        match self {
            Self::Normal => 0.25,
            Self::Rare(p) => 1.0 / p - 1.0,
            Self::Fireflies(s) => 2.0 * (s * s).exp() - 1.0,
            Self::FourFireflies(s) => 0.25 * Self::Fireflies(s).variance(),
        }
    }
}

const LAWS: [Law; 5] =
    [Law::Normal, Law::Rare(0.05), Law::Rare(0.002), Law::Fireflies(1.0), Law::Fireflies(1.5)];

/// Returns the truth of a pixel: brighter to the right.
fn truth(pixel: usize) -> f64 {
    0.2 + 0.05 * (pixel % 24) as f64
}

/// Returns passes one after the other.
fn draws(seed: u64, passes: usize, law: Law, change: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut rng = Address { seed, experiment: 31, block: 0, lane: 0 }.stream();
    let mut draw = |law: Law| -> f64 {
        match law {
            Law::Normal => 1.0 + 0.5 * upper_quantile(unit(&mut rng).max(1e-15)),
            Law::Rare(p) => {
                if unit(&mut rng) < p {
                    1.0 / p
                } else {
                    0.0
                }
            }
            Law::Fireflies(s) | Law::FourFireflies(s) => {
                let normal = upper_quantile(unit(&mut rng).max(1e-15));
                if unit(&mut rng) < 0.5 { 2.0 * (s * normal - 0.5 * s * s).exp() } else { 0.0 }
            }
        }
    };
    let mut values = Vec::new();
    for _ in 0..passes {
        for pixel in 0..PIXELS {
            let x = match law {
                Law::FourFireflies(_) => (0..4).map(|_| draw(law)).sum::<f64>() / 4.0,
                _ => draw(law),
            };
            values.push(truth(pixel) * change(pixel) * x);
        }
    }
    values
}

fn stack(seed: u64, passes: usize, law: Law, change: impl Fn(usize) -> f64) -> Stack {
    Stack::new(passes, SIZE, draws(seed, passes, law, change)).expect("a stack")
}

fn honest(seed: u64, passes: usize, law: Law) -> Stack {
    stack(seed, passes, law, |_| 1.0)
}

fn image(of: impl Fn(usize) -> f64) -> Level {
    Level::Each(Picture::new(SIZE, (0..PIXELS).map(of).collect()).expect("a picture"))
}

/// Returns the variances by pairs, unlike the product: `Σ(x_p − x_q)²/(n(n − 1))` over the passes p < q of a pixel.
fn estimated(stack: &[f64]) -> Vec<f64> {
    let n = stack.len() / PIXELS;
    let value = |pass: usize, pixel: usize| stack[pass * PIXELS + pixel];
    let pairs = || (0..n).flat_map(|p| (0..p).map(move |q| (p, q)));
    let of = |i| pairs().map(|(p, q)| (value(p, i) - value(q, i)).powi(2)).sum::<f64>();
    (0..PIXELS).map(|i| of(i) / (n * (n - 1)) as f64).collect()
}

fn values(seed: u64, passes: usize, law: Law) -> Vec<f64> {
    draws(seed, passes, law, |_| 1.0)
}

fn by_image(seed: u64, passes: usize, law: Law) -> Claim {
    let variance = estimated(&values(seed, passes, law));
    let variance = Some(image(|pixel| variance[pixel]));
    Claim { variance, variance_passes: Some(passes), ..Claim::of_truth(image(truth)) }
}

fn judged(stack: &Stack, claim: &Claim, alpha: f64) -> Judgement {
    judge(stack, claim, &ImageOptions { alpha, ..ImageOptions::default() }).expect("a judgement")
}

/// 5 distributions, 3 numbers of passes, 20 stacks each, at α = 0.05: 300 · 0.05 = 15 on average if the level were
/// exhausted; Binomial(300, 0.05) exceeds 27 with probability 1e-3. Shares of α and e-values make it far smaller.
#[test]
fn correct_stacks_keep_the_level_by_an_estimated_variance() {
    let mut failed = Vec::new();
    for law in LAWS {
        for (n, q) in [(4, 4), (16, 8), (8, 64)] {
            for seed in 0..20 {
                let claim = by_image(10_000 + seed, q, law);
                let found = judged(&honest(seed, n, law), &claim, 0.05);
                if found.verdict == Verdict::Fail {
                    failed.push((law, n, q, found.reason));
                }
            }
        }
    }
    assert!(failed.len() <= 3, "{failed:#?}");
}

#[test]
fn wrong_renderers_are_found_by_an_estimated_variance() {
    let is_bad = |pixel: usize| (8..16).contains(&(pixel / 24)) && (8..16).contains(&(pixel % 24));
    let tile = |pixel| if is_bad(pixel) { 1.2 } else { 1.0 };
    for law in [Law::Normal, Law::Fireflies(0.6)] {
        let claim = by_image(1, 64, law);
        let found = judge(
            &stack(2, 512, law, tile),
            &claim,
            &ImageOptions { tile: Some(8), ..ImageOptions::default() },
        )
        .expect("a judgement");
        assert_eq!(found.verdict, Verdict::Fail, "{law:?}: {}", found.reason);
        let small = found.tiles.iter().filter(|tile| tile.size == 8);
        let failing = small.filter(|tile| tile.verdict == Verdict::Fail);
        let places: Vec<_> = failing.map(|tile| (tile.row, tile.column)).collect();
        assert_eq!(places, [(8, 8)], "{law:?}");
        // 2 % everywhere: 0.02 √(256 · 576)/0.5 = 15 standard errors of the normal distribution, 1024 passes: 11 of the
        // other.
        let dark = stack(3, if law == Law::Normal { 256 } else { 1024 }, law, |_| 0.98);
        let found = judged(&dark, &claim, 1e-3);
        assert_eq!(found.verdict, Verdict::Fail, "{law:?}: {}", found.reason);
        // Twice the variance.
        let wide = stack(4, 64, law, |_| 1.0);
        let narrow = image(|pixel| 0.5 * law.variance() * truth(pixel) * truth(pixel));
        let claim = Claim { variance: Some(narrow), ..claim };
        let found = judged(&wide, &claim, 1e-3);
        assert!(found.reason.contains("the variance is too small"), "{law:?}: {}", found.reason);
    }
}

#[test]
fn a_truth_of_passes_has_their_error() {
    let exact = |law: Law| image(move |pixel| law.variance() * truth(pixel) * truth(pixel));
    let (mut failed, mut without) = (0, 0);
    for (seed, law) in (0..40).zip([Law::Normal, Law::Fireflies(1.0)].into_iter().cycle()) {
        let reference = values(30_000 + seed, 4, law);
        let mean = |i: usize| (0..4).map(|pass| reference[pass * PIXELS + i]).sum::<f64>() / 4.0;
        let claim = Claim {
            variance: Some(exact(law)),
            truth_passes: Some(4),
            ..Claim::of_truth(image(mean))
        };
        let stack = honest(seed, 64, law);
        failed += usize::from(judged(&stack, &claim, 1e-3).verdict == Verdict::Fail);
        let blind = Claim { truth_passes: None, ..claim };
        without += usize::from(judged(&stack, &blind, 1e-3).verdict == Verdict::Fail);
    }
    // Taken as exact, the truth has an error of 4 standard errors of 64 passes and fails nearly always.
    assert!(failed == 0 && without >= 30, "{failed} {without}");
    let reference = values(5, 64, Law::Normal);
    let mean = |i: usize| (0..64).map(|pass| reference[pass * PIXELS + i]).sum::<f64>() / 64.0;
    let claim = Claim {
        variance: Some(exact(Law::Normal)),
        truth_passes: Some(64),
        ..Claim::of_truth(image(mean))
    };
    let found = judged(&stack(6, 64, Law::Normal, |_| 1.05), &claim, 1e-3);
    assert_eq!(found.verdict, Verdict::Fail, "{}", found.reason);
    let none = Claim { variance: None, ..claim };
    let found = judged(&honest(7, 64, Law::Normal), &none, 1e-3);
    assert_eq!(found.verdict, Verdict::Inconclusive);
}

#[test]
fn negative_and_missing_variances_are_counted_and_zeros_fail_nothing() {
    let law = Law::Rare(0.05);
    let mut variance = estimated(&values(8, 8, law));
    // (1 − p)⁸ = 0.66 of the pixels were never hit.
    assert!(variance.iter().filter(|v| **v == 0.0).count() > PIXELS / 2);
    (variance[30], variance[31], variance[50]) = (-0.1, -0.2, f64::NAN);
    let level = Some(image(|pixel| variance[pixel]));
    let claim = Claim { variance: level, ..Claim::of_truth(image(truth)) };
    let error =
        judge(&honest(9, 16, law), &claim, &ImageOptions::default()).expect_err("it is exact");
    assert!(error.to_string().contains("--variance-passes N"), "{error}");
    let claim = Claim { variance_passes: Some(8), ..claim };
    for seed in 0..10 {
        let found = judged(&honest(40 + seed, 16, law), &claim, 1e-3);
        assert_ne!(found.verdict, Verdict::Fail, "{}", found.reason);
        let estimate = found.estimate.expect("it is estimated");
        assert_eq!((estimate.negative, estimate.unknown), (2, 1));
        assert_eq!(estimate.first, Some([1, 6, 0]));
        assert!(found.guarantees.iter().any(|said| said.contains("row 1, column 6")));
    }
}

#[test]
fn images_without_spread_are_compared_as_they_are() {
    let flat = |x: f64| Stack::new(8, SIZE, vec![x; 8 * PIXELS]).expect("a stack");
    let none = Some(Level::All(0.0));
    let claim =
        Claim { variance: none, variance_passes: Some(8), ..Claim::of_truth(Level::All(0.5)) };
    assert_eq!(judged(&flat(0.5), &claim, 1e-3).verdict, Verdict::Pass);
    // A stack that is too bright is off; one that is too dark may have missed rare bright values.
    assert_eq!(judged(&flat(0.6), &claim, 1e-3).verdict, Verdict::Fail);
    assert_eq!(judged(&flat(0.4), &claim, 1e-3).verdict, Verdict::Inconclusive);
    let against =
        |x: f64| compare(&flat(x), &flat(0.5), Terms::default(), &ImageOptions::default());
    assert_eq!(against(0.5).expect("a judgement").verdict, Verdict::Pass);
    assert_ne!(against(0.6).expect("a judgement").verdict, Verdict::Pass);
}

#[test]
fn images_of_the_passes_judged_are_no_grounds() {
    let law = Law::Normal;
    let own = values(10, 16, law);
    let stack = honest(10, 16, law);
    let claim = by_image(10, 16, law);
    let found = judged(&stack, &claim, 1e-3);
    assert_eq!(found.verdict, Verdict::Inconclusive);
    assert!(found.reason.contains("that of these very passes"), "{}", found.reason);
    let mean = |i: usize| (0..16).map(|pass| own[pass * PIXELS + i]).sum::<f64>() / 16.0;
    let claim = Claim { truth: image(mean), ..by_image(11, 16, law) };
    let found = judged(&stack, &claim, 1e-3);
    assert_eq!(found.verdict, Verdict::Inconclusive);
    assert!(found.reason.contains("the mean of these very passes"), "{}", found.reason);
    let found = compare(&stack, &stack, Terms::default(), &ImageOptions::default()).expect("one");
    assert_eq!(found.verdict, Verdict::Inconclusive);
    assert!(found.reason.contains("share values"), "{}", found.reason);
    let claim = Claim { variance_stack: Some(stack.clone()), ..Claim::of_truth(image(truth)) };
    let found = judged(&stack, &claim, 1e-3);
    assert!(found.reason.contains("share values"), "{}", found.reason);
    // Passes with only two values, 0 and 20, are enough evidence.
    let coins = |seed| honest(seed, 8, Law::Rare(0.05));
    let found =
        compare(&coins(1), &coins(1), Terms::default(), &ImageOptions::default()).expect("one");
    assert!(found.reason.contains("share values"), "{}", found.reason);
}

#[test]
fn a_bound_on_the_kurtosis_is_a_ground() {
    let law = Law::Normal;
    // About their truths, with pixels of unequal brightness: 3 E[T⁴]/E[T²]² = 3 · 1.6 at most in a picture of 0.2 to
    // 1.35.
    let claim = Claim { kurtosis: Some(6.0), ..Claim::of_truth(image(truth)) };
    for seed in 0..20 {
        let found = judged(&honest(seed, 16, law), &claim, 1e-3);
        assert_ne!(found.verdict, Verdict::Fail, "{}", found.reason);
    }
    let found = judged(&stack(1, 64, law, |_| 1.1), &claim, 1e-3);
    assert_eq!(found.verdict, Verdict::Fail, "{}", found.reason);
    assert!(found.guarantees[0].contains("a kurtosis of 6"), "{:?}", found.guarantees);
}

/// With 256 passes of 64 pixels a tile can show 0.5 · 1.5 · 8/√16384 = 4.7 % of the picture's mean.
#[test]
fn a_pass_by_a_wide_tolerance_says_so() {
    let law = Law::Normal;
    let variance = Some(image(move |pixel| law.variance() * truth(pixel) * truth(pixel)));
    let claim = Claim { variance, ..Claim::of_truth(image(truth)) };
    let wanted = ImageOptions { tolerance: Some(0.06), tile: Some(8), ..ImageOptions::default() };
    let found = judge(&honest(1, 256, law), &claim, &wanted).expect("a judgement");
    assert_eq!(found.verdict, Verdict::Pass, "{}", found.reason);
    assert!(found.reason.starts_with("but only a bias above 6 %"), "{}", found.reason);
    let wanted = ImageOptions { tolerance: Some(0.05), tile: Some(24), ..ImageOptions::default() };
    let found = judge(&honest(1, 256, law), &claim, &wanted).expect("a judgement");
    assert_eq!((found.verdict, &*found.reason), (Verdict::Pass, ""));
}
