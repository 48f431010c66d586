//! `judge --images`: stacks of passes, tile by tile.

use std::fs;

use trueflight::judge::images::judgement::Tile;
use trueflight::judge::images::{
    Claim, ImageOptions, Judgement, Level, Picture, Size, Stack, judge,
};
use trueflight::rng::{Address, unit};
use trueflight::stats::verdict::Verdict;

use super::{Place, npy, raw};

const SIZE: Size = Size { rows: 48, columns: 40, channels: 1 };
const PIXELS: usize = 48 * 40;

/// Returns the truth of a pixel: brighter to the right and downwards, from 0.2 to 1.1.
fn truth(pixel: usize) -> f64 {
    0.2 + 0.01 * (pixel % 40) as f64 + 0.01 * (pixel / 40) as f64
}

/// Returns passes of exponential draws with the square of the truth as variance, changed by `change(pass, pixel)`.
fn passes(seed: u64, count: usize, change: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
    let mut rng = Address { seed, experiment: 11, block: 0, lane: 0 }.stream();
    (0..count)
        .map(|pass| {
            let draw = |pixel| -truth(pixel) * (1.0 - unit(&mut rng)).ln() * change(pass, pixel);
            (0..PIXELS).map(draw).collect()
        })
        .collect()
}

fn image(of: impl Fn(usize) -> f64) -> Level {
    Level::Each(Picture::new(SIZE, (0..PIXELS).map(of).collect()).expect("a picture"))
}

fn claim() -> Claim {
    let variance = Some(image(|pixel| truth(pixel) * truth(pixel)));
    Claim { variance, ..Claim::of_truth(image(truth)) }
}

fn judged(passes: &[Vec<f64>], claim: &Claim, wanted: &ImageOptions) -> Judgement {
    let stack = Stack::new(passes.len(), SIZE, passes.concat()).expect("a stack");
    judge(&stack, claim, wanted).expect("a judgement")
}

const LOOSE: ImageOptions = ImageOptions { tile: None, tolerance: None, alpha: 0.05 };

/// At α = 0.05 at most 200 · 0.05 = 10 of 200 correct stacks may fail on average; the e-values are far below.
#[test]
fn honest_stacks_never_fail_and_most_pass() {
    let (mut failed, mut passed, mut dependent) = (0, 0, 0);
    for seed in 0..200 {
        let found = judged(&passes(seed, 16, |_, _| 1.0), &claim(), &LOOSE);
        failed += usize::from(found.verdict == Verdict::Fail);
        passed += usize::from(found.verdict == Verdict::Pass);
        dependent += usize::from(found.order.is_refuted() || found.neighbours.is_refuted());
    }
    // Binomial(200, 0.05) exceeds 22 with probability 2e-4. The tiles pass with probability 0.95, and so does the
    // whole.
    assert!(failed <= 22 && dependent <= 22, "{failed} failed, {dependent} depend");
    assert!(passed >= 160, "{passed}");
}

#[test]
fn what_is_wrong_is_found_where_it_is() {
    let is_bad = |pixel: usize| (16..24).contains(&(pixel / 40)) && (8..16).contains(&(pixel % 40));
    let tile = ImageOptions { tile: Some(8), ..ImageOptions::default() };
    let found = judged(&passes(1, 64, |_, p| if is_bad(p) { 1.15 } else { 1.0 }), &claim(), &tile);
    assert_eq!(found.verdict, Verdict::Fail, "{}", found.reason);
    assert_eq!((found.worst[0].row, found.worst[0].column, found.worst[0].size), (16, 8, 8));
    let failing = |found: &Judgement, size| -> Vec<(usize, usize)> {
        let fails = |tile: &&Tile| tile.verdict == Verdict::Fail && tile.size == size;
        found.tiles.iter().filter(fails).map(|tile| (tile.row, tile.column)).collect()
    };
    assert_eq!(failing(&found, 8), [(16, 8)]);
    assert!(found.reason.contains("rows 16 to 23, columns 8 to 15"), "{}", found.reason);
    assert!(found.worst[0].is_listed && found.worst[0].z.is_some_and(|z| z > 6.0));

    // From no bias at the left to 16 % too dark at the right.
    let dark = |_, pixel: usize| 1.0 - 0.004 * (pixel % 40) as f64;
    let found = judged(&passes(2, 64, dark), &claim(), &tile);
    assert_eq!(found.verdict, Verdict::Fail, "{}", found.reason);
    let dark = failing(&found, 8);
    assert!(!dark.is_empty() && dark.iter().all(|&(_, column)| column >= 16), "{dark:?}");

    // A bias of −2 % everywhere is too small for small tiles, and is detected in large ones and in the whole.
    let found = judged(&passes(3, 256, |_, _| 0.98), &claim(), &tile);
    assert_eq!(found.verdict, Verdict::Fail, "{}", found.reason);
    assert!(found.reason.contains("the picture is off"), "{}", found.reason);
    assert!(failing(&found, 8).is_empty() && !failing(&found, 32).is_empty());
}

#[test]
fn a_dark_percent_shows_in_the_whole() {
    let found = judged(&passes(4, 600, |_, _| 0.99), &claim(), &ImageOptions::default());
    assert_eq!(found.verdict, Verdict::Fail, "{}", found.reason);
    // z = −0.01 √(600 · 1920) = −10.7 in units of the relative spread, weighted by the truth: about −10.
    assert!(found.whole[0].z.is_some_and(|z| (-14.0..-6.0).contains(&z)), "{:?}", found.whole[0]);
}

#[test]
fn single_pixels_can_fail() {
    let pixels = ImageOptions { tile: Some(1), ..ImageOptions::default() };
    let found = judged(&passes(5, 64, |_, p| if p == 777 { 2.5 } else { 1.0 }), &claim(), &pixels);
    assert_eq!(found.verdict, Verdict::Fail, "{}", found.reason);
    let worst = &found.worst[0];
    assert_eq!((worst.row, worst.column, worst.size), (777 / 40, 777 % 40, 1));
    // Without a bias no single pixel can pass with 64 passes, and the reason says so.
    let found = judged(&passes(5, 64, |_, _| 1.0), &claim(), &pixels);
    assert_eq!(found.verdict, Verdict::Inconclusive);
    let is_open = |tile: &&Tile| tile.verdict == Verdict::Inconclusive && tile.size == 1;
    assert_eq!(found.tiles.iter().filter(is_open).count(), PIXELS);
    assert!(found.reason.contains("may be off, the first, row 0, column 0"), "{}", found.reason);
}

#[test]
fn equal_passes_and_chains_are_inconclusive() {
    let honest = passes(6, 24, |_, _| 1.0);
    let mut twice = honest.clone();
    twice[17] = twice[4].clone();
    let found = judged(&twice, &claim(), &ImageOptions::default());
    assert_eq!(found.verdict, Verdict::Inconclusive);
    assert!(found.reason.contains("passes 4, 17 share values"), "{}", found.reason);
    assert_eq!(found.repeated, [4, 17]);

    let found = judged(&vec![honest[0].clone(); 6], &claim(), &ImageOptions::default());
    assert_eq!(found.verdict, Verdict::Inconclusive);
    assert!(found.reason.contains("one image"), "{}", found.reason);

    // A render that continues from the last pass: each is half of the one before.
    let mut chain = honest;
    for pass in 1..chain.len() {
        let (before, after) = chain.split_at_mut(pass);
        after[0].iter_mut().zip(&before[pass - 1]).for_each(|(x, last)| *x = 0.5 * (*x + last));
    }
    let found = judged(&chain, &claim(), &ImageOptions::default());
    assert_eq!(found.verdict, Verdict::Inconclusive);
    assert!(found.reason.contains("passes that are 1 apart"), "{}", found.reason);
    assert!(found.tiles.iter().all(|tile| tile.verdict == Verdict::Inconclusive));
}

/// Returns passes in which each pixel takes half of the value at its right, as by the footprint of a filter.
fn blended(seed: u64, count: usize) -> Vec<Vec<f64>> {
    let blend = |pass: Vec<f64>| {
        let next = |p: usize| if p % 40 == 39 { p } else { p + 1 };
        // Deviations about the pixel's own truth, so that only the spread changes.
        let off = |p: usize| pass[p] / truth(p) - 1.0;
        (0..PIXELS).map(|p| truth(p) * (1.0 + 0.5 * (off(p) + off(next(p))))).collect()
    };
    passes(seed, count, |_, _| 1.0).into_iter().map(blend).collect()
}

#[test]
fn pixels_that_depend_on_each_other_are_judged_by_the_range_alone() {
    let stack = blended(7, 32);
    let found = judged(&stack, &claim(), &ImageOptions::default());
    assert_eq!(found.verdict, Verdict::Inconclusive, "{}", found.reason);
    assert!(found.neighbours.is_refuted() && found.reason.contains("filter"), "{}", found.reason);
    // Averages in a range need no independence of pixels: 0 to 40 is far from all of them.
    let wide = Claim { range: Some([0.0, 40.0]), ..claim() };
    assert_ne!(judged(&stack, &wide, &ImageOptions::default()).verdict, Verdict::Fail);
    // Stakes of at most ¾ of the possible loss gain 0.21 per pass: 20 of 96 passes, where ln(1/0.2α) is 8.5.
    let off = Claim { range: Some([0.0, 40.0]), ..Claim::of_truth(Level::All(10.0)) };
    let found = judged(&blended(7, 96), &off, &ImageOptions::default());
    assert_eq!(found.verdict, Verdict::Fail, "{}", found.reason);
}

#[test]
fn a_variance_that_is_too_small_is_named_and_the_means_are_not_accused() {
    let small = Claim { variance: Some(image(|p| 0.5 * truth(p) * truth(p))), ..claim() };
    let found = judged(&passes(8, 32, |_, _| 1.0), &small, &ImageOptions::default());
    assert_eq!(found.verdict, Verdict::Fail);
    assert!(
        found.reason.starts_with("the variance is too small: the passes vary"),
        "{}",
        found.reason
    );
    // Twice the variance, with the kurtosis 9 of exponential draws: ± 2√(8/61440) = 0.023.
    let spread = found.variance.expect("it is claimed").about_mean;
    assert!((spread - 2.0).abs() < 0.1, "{spread}");
    assert_eq!(found.counts.fail, 0);
}

#[test]
fn without_grounds_nothing_is_decided_and_a_range_is_one() {
    let alone = Claim::of_truth(image(truth));
    let off = passes(9, 32, |_, _| 1.3);
    let found = judged(&off, &alone, &ImageOptions::default());
    assert_eq!(found.verdict, Verdict::Inconclusive);
    assert!(found.reason.contains("--variance"), "{}", found.reason);
    // Draws of 0 or twice the truth.
    let coins = |seed, p: f64| -> Vec<Vec<f64>> {
        let mut rng = Address { seed, experiment: 12, block: 0, lane: 0 }.stream();
        let mut coin = |pixel| if unit(&mut rng) < p { 2.0 * truth(pixel) } else { 0.0 };
        (0..32).map(|_| (0..PIXELS).map(&mut coin).collect()).collect()
    };
    // Values that are never negative may only show that a mean is too large.
    let endless = Claim { range: Some([0.0, f64::INFINITY]), ..alone.clone() };
    assert_eq!(judged(&off, &endless, &ImageOptions::default()).verdict, Verdict::Fail);
    let found = judged(&passes(9, 32, |_, _| 0.7), &endless, &ImageOptions::default());
    assert_eq!(found.verdict, Verdict::Inconclusive);
    assert!(found.reason.contains("infinite end"), "{}", found.reason);
    let ranged = Claim { range: Some([0.0, 2.5]), ..alone };
    let found = judged(&coins(1, 0.5), &ranged, &ImageOptions::default());
    assert_eq!(found.verdict, Verdict::Pass, "{}", found.reason);
    let found = judged(&coins(2, 0.45), &ranged, &ImageOptions::default());
    assert_eq!(found.verdict, Verdict::Fail, "{}", found.reason);
}

#[test]
fn black_pixels_must_be_black() {
    let is_black = |pixel: usize| pixel / 40 < 8;
    let of = |pixel: usize| if is_black(pixel) { 0.0 } else { truth(pixel) };
    let claim = Claim { variance: Some(image(|p| of(p) * of(p))), ..Claim::of_truth(image(of)) };
    let mut passes = passes(10, 32, |_, p| if is_black(p) { 0.0 } else { 1.0 });
    let found = judged(&passes, &claim, &ImageOptions { tile: Some(8), ..ImageOptions::default() });
    assert_eq!(found.verdict, Verdict::Pass, "{}", found.reason);
    passes[20][85] = 1e-9;
    let found = judged(&passes, &claim, &ImageOptions::default());
    assert_eq!(found.verdict, Verdict::Fail);
    assert!(
        found.reason.starts_with("pass 20, row 2, column 5 is 1e-9, not 0e0"),
        "{}",
        found.reason
    );
}

#[test]
fn what_is_not_a_finite_number_fails_with_its_place() {
    for value in [f64::NAN, f64::INFINITY] {
        let mut passes = passes(11, 16, |_, _| 1.0);
        passes[3][5 * 40 + 7] = value;
        passes[9][0] = value;
        let found = judged(&passes, &claim(), &ImageOptions::default());
        assert_eq!(found.verdict, Verdict::Fail);
        assert!(
            found.reason.starts_with("numeric: pass 3, row 5, column 7 is "),
            "{}",
            found.reason
        );
        assert!(found.reason.ends_with("2 values are like that"), "{}", found.reason);
    }
}

#[test]
fn the_command_says_it_and_writes_it() {
    let shape = "(24, 48, 40)";
    let truths: Vec<f64> = (0..PIXELS).map(truth).collect();
    let squares: Vec<f64> = truths.iter().map(|x| x * x).collect();
    let stack =
        |change: fn(usize, usize) -> f64| npy("<f8", shape, &raw(&passes(12, 24, change).concat()));
    let dark = |_, pixel: usize| if pixel / 40 < 16 { 0.8 } else { 1.0 };
    let place = Place::new(&[
        ("good.npy", &stack(|_, _| 1.0)),
        ("dark.npy", &stack(dark)),
        ("truth.npy", &npy("<f8", "(48, 40)", &raw(&truths))),
        ("variance.npy", &npy("<f8", "(48, 40)", &raw(&squares))),
    ]);
    let known = "--images --truth-image truth.npy --variance-image variance.npy";
    place.expect(0, &format!("{known} good.npy"), &["24 passes of 48 × 40", "verdict   pass"]);
    place.expect(3, "--images --truth-image truth.npy good.npy", &["--variance-image"]);
    let out = "--tile 8 --out out --junit report.xml";
    place.expect(1, &format!("{known} {out} dark.npy"), &["worst", "z = -", "tiles are off"]);
    let table = fs::read_to_string(place.path().join("out/tiles.csv")).expect("a table");
    // Tiles of 8, 16 and 32 pixels.
    assert_eq!(table.lines().count(), 1 + 30 + 9 + 4);
    let failing: Vec<&str> = table.lines().filter(|line| line.contains(",fail,true,")).collect();
    let is_dark =
        |line: &&str| ["8,0,", "8,8,", "16,0,", "32,0,"].iter().any(|at| line.starts_with(at));
    assert!(failing.len() >= 5 && failing.iter().all(is_dark), "{failing:?}");
    let json = fs::read(place.path().join("out/judgement.json")).expect("a record");
    let json: serde_json::Value = serde_json::from_slice(&json).expect("JSON");
    assert_eq!(json["verdict"], "fail");
    assert_eq!(json["counts"]["fail"], failing.len());
    assert_eq!(json, place.json(&format!("{known} --tile 8 dark.npy"), &[]));
    let png = fs::read(place.path().join("out/z-map.png")).expect("a picture");
    assert!(png.starts_with(b"\x89PNG") && png.len() < 60_000, "{}", png.len());
    let junit = fs::read_to_string(place.path().join("report.xml")).expect("a report");
    assert!(junit.contains("failures=\"1\"") && junit.contains("failing tiles"), "{junit}");
}

/// With an ε of 5 % a tile of 8 × 8 pixels takes s²/0.05² values: 8 passes are too few, and the verdict says how many are not.
#[test]
fn an_inconclusive_verdict_names_the_passes_that_decide() {
    let wanted = ImageOptions { tile: Some(8), tolerance: Some(0.05), alpha: 1e-3 };
    let found = judged(&passes(6, 8, |_, _| 1.0), &claim(), &wanted);
    assert_eq!(found.verdict, Verdict::Inconclusive, "{}", found.reason);
    let needed: Vec<f64> = found.tiles.iter().filter_map(|tile| tile.needed).collect();
    assert_eq!(needed.len(), found.tiles.len());
    let most = needed.iter().copied().fold(0.0, f64::max);
    // s² is 27 for one tile and 63 for 4096; V about the squared mean.
    assert!((27.0..400.0).contains(&(most * 64.0 * 0.05 * 0.05)), "{most}");
    let said = format!("render {most} passes in place of 8");
    assert!(found.reason.contains(&said), "no {said} in {}", found.reason);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // some hundred
    let found = judged(&passes(6, most as usize, |_, _| 1.0), &claim(), &wanted);
    assert_eq!(found.verdict, Verdict::Pass, "{}", found.reason);
    // The error of a truth that is the mean of few passes remains, however many others are rendered.
    let noisy = Claim { truth_passes: Some(4), ..claim() };
    let found = judged(&passes(6, 8, |_, _| 1.0), &noisy, &wanted);
    assert!(found.reason.contains("render more passes"), "{}", found.reason);
}
