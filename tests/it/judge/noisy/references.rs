//! Two stacks against each other, and the rate at which correct stacks fail.

use std::fmt::Write;

use trueflight::judge::images::against::{Terms, compare};
use trueflight::judge::images::{Claim, ImageOptions};
use trueflight::stats::verdict::Verdict;

use super::{LAWS, Law, PIXELS, by_image, honest, image, judged, stack, truth, values};

#[test]
fn correct_stacks_keep_the_level_against_a_reference() {
    let mut failed = Vec::new();
    let others = [
        (Law::FourFireflies(1.0), Law::Fireflies(1.0)),
        (Law::Normal, Law::Fireflies(1.5)),
        (Law::Normal, Law::Rare(0.002)),
        (Law::Rare(0.05), Law::Normal),
    ];
    for (one, other) in LAWS.map(|law| (law, law)).into_iter().chain(others) {
        for (n, m) in [(2, 4), (9, 9), (8, 24)] {
            for seed in 0..8 {
                let (stack, reference) = (honest(seed, n, one), honest(20_000 + seed, m, other));
                let wanted = ImageOptions { alpha: 0.05, ..ImageOptions::default() };
                for is_same_distribution in [false, true] {
                    let terms = Terms { is_same_distribution, ..Terms::default() };
                    let found = compare(&stack, &reference, terms, &wanted).expect("a judgement");
                    if found.verdict == Verdict::Fail && (one == other || !is_same_distribution) {
                        failed.push((one, other, n, m, is_same_distribution, found.reason));
                    }
                }
            }
        }
    }
    // 216 comparisons for means, 120 for distributions: Binomial(336, 0.05) exceeds 30 with probability 1e-3.
    assert!(failed.len() <= 12, "{failed:#?}");
}

#[test]
fn wrong_renderers_are_found_against_a_reference() {
    let is_bad = |pixel: usize| (8..16).contains(&(pixel / 24)) && (8..16).contains(&(pixel % 24));
    let wanted = ImageOptions { tile: Some(8), ..ImageOptions::default() };
    for (law, passes, factor) in
        [(Law::Normal, 4, 1.6), (Law::Normal, 32, 1.2), (Law::Fireflies(0.6), 256, 1.3)]
    {
        let bad = stack(1, passes, law, |p| if is_bad(p) { factor } else { 1.0 });
        let reference = honest(2, passes, law);
        let found = compare(&bad, &reference, Terms::default(), &wanted).expect("a judgement");
        assert_eq!(found.verdict, Verdict::Fail, "{law:?} {passes}: {}", found.reason);
        let expected = if passes < 8 { "signs" } else { "permutation" };
        assert_eq!(found.comparison.expect("one").method.word(), expected);
        assert!(found.reason.contains("rows 8 to 15, columns 8 to 15"), "{}", found.reason);
    }
    // A mean of a fourth of the samples has four times the variance: no fault, except with --same-distribution.
    let (many, one) = (honest(3, 24, Law::FourFireflies(1.0)), honest(4, 24, Law::Fireflies(1.0)));
    let found = compare(&one, &many, Terms::default(), &wanted).expect("a judgement");
    assert_ne!(found.verdict, Verdict::Fail, "{}", found.reason);
    // 4, with a relative error of √(κ/n), κ about 450, n = 24 · 576.
    let ratio = found.comparison.and_then(|found| found.spread).expect("a ratio");
    assert!((2.6..5.5).contains(&ratio), "{ratio}");
    let terms = Terms { is_same_distribution: true, ..Terms::default() };
    let found = compare(&one, &many, terms, &wanted).expect("a judgement");
    assert_eq!(found.verdict, Verdict::Fail);
    assert!(found.reason.contains("the variance is off"), "{}", found.reason);
}

/// Rates at which correct stacks fail, by distribution, number of passes and ground: the table of the manual.
#[test]
#[ignore = "long: 50 stacks of each of 80 kinds, 2 minutes of two cores"]
fn levels_of_correct_stacks() {
    const STACKS: u64 = 50;
    let mut total = [[0_u64; 2]; 4];
    let mut table = String::new();
    // Rarer values leave references of 4 passes black, without a unit.
    let laws = LAWS.map(|law| if law == Law::Rare(0.002) { Law::Rare(0.01) } else { law });
    for law in laws {
        for (n, q) in [(4, 4), (16, 16), (64, 64), (8, 64)] {
            let mut failed = [0; 4];
            for seed in 0..STACKS {
                let (stack, other) = (honest(seed, n, law), honest(100_000 + seed, q, law));
                let count = |verdict| u64::from(verdict == Verdict::Fail);
                failed[0] += count(judged(&stack, &by_image(200_000 + seed, q, law), 1e-3).verdict);
                let claim =
                    Claim { variance_stack: Some(other.clone()), ..Claim::of_truth(image(truth)) };
                failed[1] += count(judged(&stack, &claim, 1e-3).verdict);
                let reference = values(300_000 + seed, q, law);
                let mean = |i: usize| {
                    (0..q).map(|pass| reference[pass * PIXELS + i]).sum::<f64>() / q as f64
                };
                let claim = Claim {
                    truth: image(mean),
                    truth_passes: Some(q),
                    ..by_image(300_000 + seed, q, law)
                };
                failed[2] += count(judged(&stack, &claim, 1e-3).verdict);
                let found = compare(&stack, &other, Terms::default(), &ImageOptions::default());
                failed[3] += count(found.expect("a judgement").verdict);
            }
            let _ = writeln!(table, "{law:?}, {n} passes, {q} others: {failed:?} of {STACKS}");
            for (total, failed) in total.iter_mut().zip(failed) {
                *total = [total[0] + failed, total[1] + STACKS];
            }
        }
    }
    println!("{table}image, stack, truth of passes, against: {total:?}");
    // 1,000 of each at α = 1e-3: 1 on average if the level were exhausted, above 5 with probability 6e-4.
    assert!(total.iter().all(|[failed, _]| *failed <= 5), "{table}");
}
