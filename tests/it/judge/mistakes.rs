//! Usual mistakes of first users, and the verdicts that name them.

use trueflight::judge::images::{
    Claim, ImageOptions, Judgement, Level, Picture, Size, Stack, judge,
};
use trueflight::report::judge::images::console::block;
use trueflight::rng::{Address, unit};
use trueflight::stats::normal::upper_quantile;
use trueflight::stats::verdict::Verdict;

use super::{Place, UNIFORM, npy, raw, uniform};

const SIZE: Size = Size { rows: 32, columns: 32, channels: 1 };
const PIXELS: usize = 32 * 32;

/// Returns the probability of a hit in a pixel: larger to the right.
fn hit(pixel: usize) -> f64 {
    0.05 + 0.004 * (pixel % 32) as f64
}

/// Returns values of passes one after the other; `draw` gets the pixel and a uniform number.
fn values(seed: u64, passes: usize, draw: impl Fn(usize, f64) -> f64) -> Vec<f64> {
    let mut rng = Address { seed, experiment: 41, block: 0, lane: 0 }.stream();
    (0..passes * PIXELS).map(|i| draw(i % PIXELS, unit(&mut rng))).collect()
}

fn stack(values: Vec<f64>) -> Stack {
    Stack::new(values.len() / PIXELS, SIZE, values).expect("a stack")
}

/// Returns passes of hits and misses that are too bright by a factor.
fn hits(seed: u64, passes: usize, factor: f64) -> Vec<f64> {
    values(seed, passes, |pixel, u| f64::from(u8::from(u < factor * hit(pixel))))
}

/// Returns log-normal passes of mean 1 times a factor.
fn fireflies(seed: u64, passes: usize, sigma: f64, factor: f64) -> Vec<f64> {
    values(seed, passes, |_, u| {
        factor * (sigma * upper_quantile(u.max(1e-15)) - 0.5 * sigma * sigma).exp()
    })
}

fn image(of: impl Fn(usize) -> f64) -> Level {
    Level::Each(Picture::new(SIZE, (0..PIXELS).map(of).collect()).expect("a picture"))
}

fn claim(variance: impl Fn(usize) -> f64) -> Claim {
    Claim { variance: Some(image(variance)), ..Claim::of_truth(image(hit)) }
}

fn exact() -> Claim {
    claim(|pixel| hit(pixel) * (1.0 - hit(pixel)))
}

fn judged(values: Vec<f64>, claim: &Claim) -> Judgement {
    judge(&stack(values), claim, &ImageOptions::default()).expect("a judgement")
}

/// The variance of hits and misses grows with their mean: 1.15 (1 − 1.15 p)/(1 − p) = 1.13.
#[test]
fn a_biased_picture_of_hits_names_the_mean_before_the_variance() {
    let found = judged(hits(1, 256, 1.15), &exact());
    assert_eq!(found.verdict, Verdict::Fail);
    let reason = &found.reason;
    assert!(reason.starts_with("the mean is plainly off by +1"), "{reason}");
    assert!(reason.contains("by the passes' own spread; the variance is too small"), "{reason}");
    assert!(found.likely()[0].contains("the mean is high, the variance is high"));
    assert!(found.is_unjudged() && found.shown.is_some());
    assert!(reason.contains("give a range, too"), "{reason}");
    let text = block(&found, "x", 400);
    assert!(!text.contains("0 fail") && text.matches("not judged").count() >= 2, "{text}");
    let open_range = Claim { range: Some([0.0, f64::INFINITY]), ..exact() };
    let found = judged(hits(1, 256, 1.15), &open_range);
    assert!(!found.reason.contains("a range, too"), "{}", found.reason);
    // By another stack, and for correct passes.
    let by_stack =
        Claim { variance_stack: Some(stack(hits(2, 256, 1.0))), ..Claim::of_truth(image(hit)) };
    let found = judged(hits(1, 256, 1.15), &by_stack);
    assert_eq!(found.verdict, Verdict::Fail);
    assert!(found.reason.contains("off by +1"), "{}", found.reason);
    for seed in 0..10 {
        let found = judged(hits(10 + seed, 64, 1.0), &exact());
        assert!(found.shown.is_none() && found.verdict != Verdict::Fail, "{}", found.reason);
    }
}

/// Without a tolerance ε is what the passes resolve, and a twentieth of correct pictures is undecided.
#[test]
fn an_undecided_picture_is_told_passes_and_their_tolerance() {
    let found = (0..60).map(|seed| judged(hits(100 + seed, 16, 1.0), &exact()).reason);
    let undecided: Vec<String> =
        found.filter(|reason| reason.contains("the picture may")).collect();
    assert!(!undecided.is_empty());
    for reason in undecided {
        assert!(reason.contains(" passes in place of 16 with --tolerance 0.0"), "{reason}");
    }
}

#[test]
fn a_variance_that_is_plainly_too_large_does_not_pass() {
    let square = |pixel: usize| hit(pixel) * (1.0 - hit(pixel));
    let good = |claim: &Claim| judged(hits(3, 64, 1.0), claim);
    assert!(good(&exact()).variance.is_some_and(|variance| !variance.is_too_large));
    for (wrong, times) in [
        (claim(move |pixel| 16.0 * square(pixel)), "1"),
        // √V, 3 to 4 times as large.
        (claim(move |pixel| square(pixel).sqrt()), "3"),
    ] {
        let found = good(&wrong);
        assert_eq!(found.verdict, Verdict::Inconclusive);
        assert!(found.variance.is_some_and(|variance| variance.is_too_large));
        let said = format!("the passes vary {times}");
        assert!(found.reason.starts_with(&said), "{}", found.reason);
        assert!(found.reason.contains("that of one sample instead of a pass"), "{}", found.reason);
    }
    // A tenth more is within the tolerance of a variance.
    let found = good(&claim(move |pixel| 1.1 * square(pixel)));
    assert!(found.variance.is_some_and(|variance| !variance.is_too_large));
}

#[test]
fn a_bright_picture_of_heavy_tails_looks_off_and_a_range_decides_it() {
    let other = Some(stack(fireflies(4, 8, 1.5, 1.0)));
    let claim = Claim { variance_stack: other, ..Claim::of_truth(Level::All(1.0)) };
    let bad = || fireflies(5, 64, 1.5, 1.4);
    let found = judged(bad(), &claim);
    assert_eq!(found.verdict, Verdict::Inconclusive, "{}", found.reason);
    assert!(found.reason.starts_with("the mean looks off by +"), "{}", found.reason);
    assert!(found.reason.contains("--range 0,inf decides it"), "{}", found.reason);
    // These values vary, so that nothing is said about values that never do.
    assert!(!found.reason.contains("--variance 0"), "{}", found.reason);
    let ranged = Claim { range: Some([0.0, f64::INFINITY]), ..claim };
    assert_eq!(judged(bad(), &ranged).verdict, Verdict::Fail);
}

/// More passes make smaller tiles by default, but not so small that a few bright values carry the variance of one.
#[test]
fn more_passes_of_heavy_tails_do_not_take_a_pass_back() {
    let passes = |seed, count| fireflies(seed, count, 1.3, 1.0);
    let claim =
        Claim { variance_stack: Some(stack(passes(6, 512))), ..Claim::of_truth(Level::All(1.0)) };
    let found = judged(passes(7, 512), &claim);
    assert_eq!(found.verdict, Verdict::Pass, "tile {}: {}", found.tile, found.reason);
    // 4 × 4 pixels have 8,192 values.
    assert!(found.tile > 4, "{}", found.tile);
    let small = ImageOptions { tile: Some(2), ..ImageOptions::default() };
    let found = judge(&stack(passes(7, 512)), &claim, &small).expect("a judgement");
    assert_eq!(found.verdict, Verdict::Inconclusive);
    assert!(found.reason.contains("or give --tile "), "{}", found.reason);
    assert!(found.reason.contains("with which these passes pass"), "{}", found.reason);
    assert!(block(&found, "x", 400).contains(" pass (ε up to "));
}

#[test]
fn a_flipped_picture_asks_whether_it_is_flipped() {
    // Uniform noise of variance 0.05² about the truth.
    let noisy = values(8, 256, |pixel, u| hit(pixel) + 0.05 * 12_f64.sqrt() * (u - 0.5));
    let flipped: Vec<f64> = noisy.chunks(32).flat_map(|row| row.iter().rev().copied()).collect();
    let found = judged(flipped, &claim(|_| 0.05 * 0.05));
    assert_eq!(found.verdict, Verdict::Fail);
    assert!(found.is_misplaced(), "{}", found.reason);
    assert!(found.reason.ends_with(
        "is the picture flipped or transposed, or are the passes not on the first axis?"
    ));
    let text = block(&found, "x", 400);
    assert!(!text.contains("majorant"), "{text}");
    // The evidence of the variance is about squares from the truth.
    assert!(
        text.contains("(x − truth)²/V = ") && text.contains(": mostly because the means are off"),
        "{text}"
    );
}

#[test]
fn channels_of_one_place_are_one_line() {
    let size = Size { channels: 3, ..SIZE };
    let bad: Vec<f64> =
        hits(9, 128, 1.5).iter().flat_map(|x| [1.0, 0.9, 0.8].map(|colour| colour * x)).collect();
    let level = |of: &dyn Fn(usize) -> [f64; 3]| {
        let values = (0..PIXELS).flat_map(of).collect();
        Some(Level::Each(Picture::new(size, values).expect("a picture")))
    };
    let truth = level(&|p| [1.0, 0.9, 0.8].map(|colour| colour * hit(p))).expect("one");
    let variance = level(&|p| [1.0_f64, 0.81, 0.64].map(|square| 2.0 * square * hit(p)));
    let claim = Claim { variance, ..Claim::of_truth(truth) };
    let stack = Stack::new(128, size, bad).expect("a stack");
    let found = judge(&stack, &claim, &ImageOptions::default()).expect("a judgement");
    assert_eq!(found.verdict, Verdict::Fail);
    assert_eq!(found.reason.matches("the picture is off").count(), 1, "{}", found.reason);
    assert!(found.reason.contains("off in 3 of 3 channels; the furthest: the mean in channel"));
    let places: Vec<_> =
        found.worst.iter().map(|tile| (tile.size, tile.row, tile.column)).collect();
    let different: std::collections::BTreeSet<_> = places.iter().collect();
    assert!(places.len() > 1 && different.len() == places.len(), "{places:?}");
    let text = block(&found, "x", 400);
    assert!(text.contains("; channels ") && text.contains(", too"), "{text}");
}

#[test]
fn images_that_are_missing_or_without_a_claim_say_so() {
    let bytes = npy("<f8", "(4, 32, 32)", &raw(&hits(10, 4, 1.0)));
    let pass = npy("<f8", "(32, 32)", &raw(&hits(11, 1, 1.0)));
    let place = Place::new(&[("x.npy", &bytes)]);
    for folder in ["passes", "others"] {
        std::fs::create_dir(place.path().join(folder)).expect("a folder");
        std::fs::write(place.path().join(folder).join("0.npy"), &pass).expect("a file");
        std::fs::write(place.path().join(folder).join("1.npy"), &bytes[..128]).expect("a file");
    }
    let missing = "nowhere: there is no such file or folder";
    place.expect(2, "--images --truth 1 --variance-stack nowhere x.npy", &[missing]);
    place.expect(2, "--images --truth 1 nowhere", &[missing]);
    place.expect(2, "--images --truth 1 passes others", &["passes: a folder beside other files"]);
    place.expect(2, "--images x.npy", &["--truth T", "--truth-image FILE", "--against FILE"]);
    place.expect(2, "--images --truth 1 --tolerance 5 x.npy", &["5 is 500 %; did you mean 0.05"]);
    let (code, text) = place.says("--images --truth 0.1 --range 0,1 --tolerance 50% x.npy", &[]);
    assert_ne!(code, 2, "{text}");
    let (_, help) = place.says("--help", &[]);
    let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(help.contains("or one folder of them"), "{help}");
}

#[test]
fn a_variance_of_the_mean_is_told_from_that_of_a_pass() {
    let variance = |pixel: usize| hit(pixel) * (1.0 - hit(pixel));
    let passes = hits(13, 64, 1.0);
    for (divisor, is_told) in [(64.0, true), (16.0, false)] {
        let found = judged(passes.clone(), &claim(|pixel| variance(pixel) / divisor));
        let said = "that is the number of passes: give the variance of one pass";
        assert_eq!(found.verdict, Verdict::Fail);
        assert_eq!(found.reason.contains(said), is_told, "{}", found.reason);
    }
}

#[test]
fn a_tile_that_passes_needs_no_passes() {
    let bytes = npy("<f8", "(64, 32, 32)", &raw(&hits(12, 64, 1.0)));
    let place = Place::new(&[("x.npy", &bytes)]);
    place.expect(
        0,
        "--images --truth 0.112 --range 0,1 --tile 32 --tolerance 0.9 --out out x.npy",
        &[],
    );
    let table = std::fs::read_to_string(place.path().join("out/tiles.csv")).expect("a table");
    let head: Vec<&str> = table.lines().next().expect("a head").split(',').collect();
    let at = |name: &str| head.iter().position(|column| *column == name).expect("a column");
    for line in table.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        assert_eq!((fields[at("verdict")], fields[at("needed_passes")]), ("pass", ""), "{line}");
    }
}

#[test]
fn a_tolerance_in_percent_needs_its_sign() {
    let place = Place::new(&[("x.f64", &raw(&uniform(200_000)))]);
    place.expect(0, &format!("{UNIFORM} --tolerance 5% x.f64"), &["pass"]);
    let said = "--tolerance 5 is 500 %; did you mean 0.05, or 5%?";
    place.expect(2, &format!("{UNIFORM} --tolerance 5 x.f64"), &[said]);
    place.expect(
        2,
        &format!("{UNIFORM} --variance-tolerance 20 x.f64"),
        &["did you mean 0.2, or 20%?"],
    );
    // About a truth of 0 it is no share.
    let (code, text) = place.says("--truth 0 --range -9,9 --tolerance 5 x.f64", &[]);
    assert_ne!(code, 2, "{text}");
}

#[test]
fn another_width_or_order_of_bytes_is_told() {
    let draws = uniform(200_000);
    #[allow(clippy::cast_possible_truncation)] // rounds
    let single: Vec<u8> = draws.iter().flat_map(|x| (*x as f32).to_le_bytes()).collect();
    let big: Vec<u8> = draws.iter().flat_map(|x| x.to_be_bytes()).collect();
    let place = Place::new(&[("x.f64", &raw(&draws)), ("s.f64", &single), ("big.f64", &big)]);
    place.expect(2, "--truth 1 --input f32 x.f64", &["float64, not float32; give --input f64"]);
    place.expect(2, "--truth 1 s.f64", &["float32, not float64; give --input f32"]);
    place.expect(2, "--truth 1 big.f64", &["as of big-endian numbers; write them"]);
    place.expect(0, "--truth 1 x.f64", &[]);
}

#[test]
fn columns_that_are_no_values_are_told() {
    let lines = (0..20_000).map(|i| format!("{i},{}", 0.5 + 0.1 * f64::from(i % 7)));
    let table = lines.collect::<Vec<String>>().join("\n") + "\n";
    let semicolons = format!("sample,x\n{table}").replace(',', ";");
    let place = Place::new(&[
        ("x.csv", format!("sample,x\n{table}").as_bytes()),
        ("semicolons.csv", semicolons.as_bytes()),
        ("bare.csv", table.replace(',', "\t").as_bytes()),
    ]);
    let index = "values rise by 1 from draw to draw: an index?";
    place.expect(3, "--truth 1 --column sample x.csv", &[index]);
    let (code, text) = place.says("--truth 0.5 --range 0,1 --column sample x.csv", &[]);
    assert!(code == 1 && text.contains(index) && !text.contains("NaN"), "{text}");
    place.expect(2, "--truth 1 --column x semicolons.csv", &["has semicolons between its columns"]);
    place.expect(2, "--truth 1 semicolons.csv", &["has semicolons between its columns"]);
    place.expect(2, "--truth 1 bare.csv", &["has tabs between its columns"]);
}

#[test]
fn a_case_lists_its_estimators_and_says_what_the_nearest_value_means() {
    let place =
        Place::new(&[("case.toml", super::CASE.as_bytes()), ("x.f64", &raw(&uniform(1000)))]);
    place.expect(2, "--case case.toml x.f64", &["by --estimator: ratio, ", "woodcock"]);
    place.expect(2, "x.f64", &["--truth T", "--case CASE"]);
    let swept = "--case case.toml --estimator woodcock --swept 0.4 x.f64";
    place.expect(
        2,
        swept,
        &["nearest value of the sweep is 0.8", "only if your draws were made there"],
    );
    // Where σ_t is 0.9, the nearest value 0.8 is refused as well.
    let thick = super::CASE.replace("extinction = 0.5", "extinction = 0.9");
    std::fs::write(place.path().join("thick.toml"), thick).expect("written");
    let swept = "--case thick.toml --estimator woodcock --swept 0.6 x.f64";
    place.expect(2, swept, &["nearest value of the sweep is 1:"]);
}
