//! Foreign draws with the right mean and variance: their distribution is tested, too.
//!
//! Draws are made here by inversion, in an arithmetic other than the library's.

use std::path::Path;

use trueflight::OfCase;
use trueflight::rng::{Address, Stream};
use trueflight::stats::verdict::Verdict;

use super::{Place, npy, raw};

const FIELD: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/field/13-free-flight-law");
/// Case with σ_t = 0.5 on [0, 1] and 2 on [1, 2]: T(2) = e^{−2.5}.
const FLIGHTS: &str = include_str!("../../data/field/13-free-flight-law/ff.toml");
/// Case with a ray of length 1.3, which is not a number of single precision; T = e^{−0.65}.
const ODD: &str = "title = \"a ray of an odd length\"
[problem.free-flight]
medium.constant.extinction = 0.5
span = [0.1, 1.4]
sampling.constant.value = 0.5
estimators = [{ woodcock = {} }]
";
/// Case with T = e^{−1} and σ̂ = 2 on [0, 2]: the number of collisions is Poisson distributed with mean 4.
const COUNTED: &str = "title = \"collisions\"
[problem.transmittance]
medium.constant.extinction = 0.5
span = [0, 2]
sampling.constant.value = 2
estimators = [{ woodcock = {} }, { double = {} }, { ratio = {} }]
";

fn stream(seed: u64) -> Stream {
    Address { seed, experiment: 13, block: 0, lane: 0 }.stream()
}

/// Returns a flight through the two layers, without an end.
fn flight(rng: &mut Stream) -> f64 {
    let depth = -rng.positive_uniform().ln();
    if depth < 0.5 { depth / 0.5 } else { 1.0 + (depth - 0.5) / 2.0 }
}

fn flights(seed: u64, n: usize, put: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut rng = stream(seed);
    (0..n).map(|_| put(flight(&mut rng))).collect()
}

/// Returns a function that replaces flights that leave by this number.
fn or(left: f64) -> impl Fn(f64) -> f64 {
    move |t| if t >= 2.0 { left } else { t }
}

const N: usize = 200_000;
/// Tolerances that the draws pass by far.
const WIDE: &str = "--tolerance 0.05 --variance-tolerance 0.1";

#[test]
fn flights_of_two_lengths_fail_whose_mean_and_variance_are_right() {
    let place = Place::new(&[]);
    let judge = format!("--case {FIELD}/ff.toml --estimator woodcock {FIELD}/two.f64");
    place.expect(
        1,
        &judge,
        &[
            "the distribution of the distances differs from theory",
            "0 % of the flights leave, 8.21 %",
        ],
    );
    let found = place.json(&judge, &[]);
    assert!(found["z"].as_f64().is_some_and(|z| z.abs() < 0.1), "{found}");
    for finding in found["findings"].as_array().expect("a list") {
        assert_eq!(finding["verdict"], "pass", "{finding}");
    }
    let checks: Vec<&str> = found["distribution"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|test| test["check"].as_str().expect("a name"))
        .collect();
    assert_eq!(checks, ["distances", "depth", "resolution"]);
    assert_eq!(found["theory"], "`woodcock` of ff");
}

#[test]
fn every_way_to_write_a_flight_that_leaves_gets_the_same_verdict() {
    let place = Place::new(&[("ff.toml", FLIGHTS.as_bytes())]);
    let judge = |draws: &[f64], more: &str| {
        std::fs::write(place.path().join("x.f64"), raw(draws)).expect("written");
        let arguments = format!("--case ff.toml --estimator woodcock {more} x.f64");
        place.expect(0, &arguments, &["pass"]);
        place.json(&arguments, &[])
    };
    for more in [WIDE, "--mean-only --tolerance 0.05", "--batch 10 --tolerance 0.05"] {
        let expected = judge(&flights(1, N, or(2.0)), more);
        for left in [f64::INFINITY, -1.0, 2.5, f64::MAX, f64::from(f32::MAX)] {
            let found = judge(&flights(1, N, or(left)), more);
            assert_eq!(found, expected, "{left} {more}");
        }
        assert_eq!(judge(&flights(1, N, |t| t), more), expected, "beyond the end {more}");
    }
}

#[test]
fn a_wrong_way_to_write_them_is_named_and_no_bias_accused() {
    let place = Place::new(&[("ff.toml", FLIGHTS.as_bytes())]);
    for (left, words) in [
        (0.0, "% of the first draws are 0;"),
        (1.9, "% of the first draws are 1.9"),
        (f64::NAN, "is NaN"),
        (-2.0, "is -2, which is no distance"),
        (f64::NEG_INFINITY, "is -inf"),
    ] {
        std::fs::write(place.path().join("x.f64"), raw(&flights(1, N, or(left)))).expect("written");
        for more in ["", "--mean-only --range 0,3"] {
            let arguments = format!("--case ff.toml --estimator woodcock {more} x.f64");
            let cure = "write a flight that leaves as 2, the length of the ray";
            place.expect(1, &arguments, &[words, cure]);
            let found = place.json(&arguments, &[]);
            let reason = found["reason"].as_str().expect("a reason");
            assert!(!reason.contains("off by"), "{left}: {reason}");
        }
    }
}

#[test]
fn without_a_medium_all_flights_leave_however_that_is_written() {
    let case = ODD.replace("extinction = 0.5", "extinction = 0");
    let place = Place::new(&[("odd.toml", case.as_bytes())]);
    for left in [1.3, f64::INFINITY, -1.0, 7.0] {
        std::fs::write(place.path().join("x.f64"), raw(&[left; 1000])).expect("written");
        place.expect(0, "--case odd.toml --estimator woodcock x.f64", &["pass"]);
    }
    std::fs::write(place.path().join("x.f64"), raw(&[1.2; 1000])).expect("written");
    place.expect(1, "--case odd.toml --estimator woodcock x.f64", &["fail"]);
}

#[test]
fn flights_that_never_leave_or_leave_too_often_fail() {
    let place = Place::new(&[("ff.toml", FLIGHTS.as_bytes())]);
    let judge = "--case ff.toml --estimator woodcock x.f64";
    let mut dropped = flights(1, N, |t| t);
    dropped.retain(|&t| t < 2.0);
    std::fs::write(place.path().join("x.f64"), raw(&dropped)).expect("written");
    place.expect(1, judge, &["0 % of the flights leave, 8.21 % expected"]);
    // Every eighth collision is replaced by an escape: the distances of collisions have the right distribution.
    let mut rng = stream(9);
    let more = flights(1, N, |t| t);
    let more: Vec<f64> =
        more.into_iter().map(|t| if rng.uniform() < 0.125 { 2.0 } else { t }).collect();
    std::fs::write(place.path().join("x.f64"), raw(&more)).expect("written");
    place.expect(1, judge, &["19.", "% of the flights leave, 8.21 % expected"]);
    let found = place.json(judge, &[]);
    assert_eq!(found["distribution"][1]["verdict"], "pass", "the collisions by themselves");
}

#[test]
fn quantised_flights_fail_and_single_precision_does_not() {
    let place = Place::new(&[("ff.toml", FLIGHTS.as_bytes()), ("odd.toml", ODD.as_bytes())]);
    let judge = "--case ff.toml --estimator woodcock x.f64";
    for (steps, check) in [(8.0, "distances"), (50.0, "near both ends"), (4096.0, "resolution")] {
        let round = |t: f64| if t >= 2.0 { t } else { (t * steps).round() / steps };
        std::fs::write(place.path().join("x.f64"), raw(&flights(1, N, round))).expect("written");
        place.expect(1, judge, &[check, "differs from theory"]);
    }
    #[allow(clippy::cast_possible_truncation)] // single precision
    let single = |draws: &[f64]| -> Vec<u8> {
        draws.iter().flat_map(|&x| (x as f32).to_le_bytes()).collect()
    };
    let bytes = npy("<f4", &format!("({N},)"), &single(&flights(1, N, or(2.0))));
    std::fs::write(place.path().join("x.npy"), bytes).expect("written");
    place.expect(
        0,
        &format!("--case ff.toml --estimator woodcock {WIDE} x.npy"),
        &["single precision"],
    );
    // Distances are differences of positions from 0.1 on, with the end slightly short of 1.3.
    let mut rng = stream(3);
    let odd: Vec<f64> = (0..N).map(|_| (-rng.positive_uniform().ln() / 0.5).min(1.3)).collect();
    let bytes = npy("<f4", &format!("({N},)"), &single(&odd));
    std::fs::write(place.path().join("odd.npy"), bytes).expect("written");
    place.expect(
        0,
        &format!("--case odd.toml --estimator woodcock {WIDE} odd.npy"),
        &["single precision"],
    );
}

#[test]
fn what_is_not_tested_is_said_with_the_reason() {
    let few = flights(1, 600, or(2.0));
    // A ratio that changes along the ray: draws take more values than can be listed.
    let layers = FLIGHTS.replace("free-flight", "transmittance").replace("inversion", "ratio");
    let place = Place::new(&[
        ("ff.toml", FLIGHTS.as_bytes()),
        ("layers.toml", layers.as_bytes()),
        ("few.f64", &raw(&few)),
        ("many.f64", &raw(&flights(1, N, or(2.0)))),
        ("half.npy", &npy("<f4", &format!("({N},)"), &vec![0; 4 * N])),
    ]);
    let judge = "--case ff.toml --estimator woodcock";
    place.expect(
        3,
        &format!("{judge} few.f64"),
        &["the distribution of the distances is not tested: 600 draws are too few"],
    );
    let of_mean = "the distribution is not tested: of theory the mean alone is taken";
    place.expect(0, &format!("{judge} --mean-only --tolerance 0.05 many.f64"), &[of_mean]);
    let of_averages = "the distribution is not tested: averages of draws have another one";
    place.expect(0, &format!("{judge} --batch 10 --tolerance 0.05 many.f64"), &[of_averages]);
    let rounded = format!("{judge} --rounding 1e-2 --tolerance 0.05 many.f64");
    place.expect(0, &rounded, &["are not tested: rounding of the draws moves as many"]);
    let unknown = "theory knows mean and variance of it alone";
    place.expect(1, "--case layers.toml --estimator ratio half.npy", &[unknown]);
}

#[test]
fn a_value_that_cannot_occur_fails_however_few_there_are() {
    let mut rng = stream(5);
    let coin: Vec<f64> =
        (0..N).map(|_| f64::from(u8::from(rng.uniform() < (-1f64).exp()))).collect();
    let place = Place::new(&[("counted.toml", COUNTED.as_bytes()), ("x.f64", &raw(&coin))]);
    let judge = &format!("--case counted.toml --estimator woodcock {WIDE} x.f64");
    place.expect(0, judge, &["atoms: p = "]);
    let mut strange = coin.clone();
    let ones = (0..N).filter(|&i| coin[i] > 0.5).step_by(30_000);
    let changed = ones.map(|i| strange[i] = 0.999).count() as f64;
    std::fs::write(place.path().join("x.f64"), raw(&strange)).expect("written");
    let words = format!("{changed} draws are none of the 2 values that can occur");
    place.expect(1, judge, &["the distribution of the values differs from theory", &words]);
    let found = place.json(judge, &[]);
    assert_eq!(found["findings"][0]["verdict"], "pass", "the mean does not see it");
    // Also among draws that are too few for shares.
    std::fs::write(place.path().join("x.f64"), raw(&strange[..400])).expect("written");
    assert!(strange[..400].contains(&0.999));
    place.expect(1, judge, &["1 draw is none of the 2 values that can occur"]);
}

/// Returns a Poisson number by the product of uniforms.
fn poisson(rng: &mut Stream, mean: f64) -> i32 {
    let (mut left, mut count) = (rng.positive_uniform(), 0);
    while left > (-mean).exp() {
        left *= rng.positive_uniform();
        count += 1;
    }
    count
}

#[test]
fn lookups_of_another_distribution_fail_whose_mean_and_variance_are_right() {
    // Ratio tracking: (3/4)^N with N collisions.
    let mut rng = stream(6);
    let counts: Vec<i32> = (0..N).map(|_| poisson(&mut rng, 4.0)).collect();
    let table = |lookups: &dyn Fn(usize) -> i32| {
        let line = |(i, &n): (usize, &i32)| format!("{:?},{}\n", 0.75f64.powi(n), lookups(i));
        let rows: String = counts.iter().enumerate().map(line).collect();
        format!("X,n\n{rows}")
    };
    let place = Place::new(&[("counted.toml", COUNTED.as_bytes())]);
    let judge = "--case counted.toml --estimator ratio --column X --lookups n x.csv";
    let judge = &format!("{judge} {WIDE}");
    std::fs::write(place.path().join("x.csv"), table(&|i| counts[i])).expect("written");
    let (code, text) = place.says(judge, &[]);
    assert!(code != 1 && text.contains("counts: p = "), "{text}");
    // 2 or 6 with equal probability: mean 4, variance 4.
    let coins: Vec<i32> = (0..N).map(|_| if rng.uniform() < 0.5 { 2 } else { 6 }).collect();
    std::fs::write(place.path().join("x.csv"), table(&|i| coins[i])).expect("written");
    place.expect(1, judge, &["the distribution of the lookups differs from theory"]);
    let found = place.json(judge, &[]);
    assert_eq!(found["findings"][2]["check"], "lookups");
    assert_eq!(found["findings"][2]["verdict"], "pass", "{}", found["findings"][2]);
}

#[test]
fn products_in_single_precision_are_the_values_that_they_are_rounded_from() {
    // `double` of a constant ratio takes the powers of 3/4.
    let mut rng = stream(7);
    let draws: Vec<f64> = (0..N).map(|_| 0.75f64.powi(poisson(&mut rng, 4.0))).collect();
    // Rounding errors of some last digits, by another order of the factors.
    #[allow(clippy::cast_possible_truncation)] // single precision
    let off = |x: f64| f64::from((x * (1.0 + 3e-7)) as f32);
    let rounded: Vec<f64> = draws.iter().map(|&x| off(x)).collect();
    // The same error in a draw of double precision makes it another value.
    let mut wrong = draws.clone();
    wrong[3] *= 1.0 + 3e-7;
    wrong[4] = 0.1;
    let place = Place::new(&[("counted.toml", COUNTED.as_bytes())]);
    for (draws, code) in [(&draws, 0), (&rounded, 0), (&wrong, 1)] {
        std::fs::write(place.path().join("x.f64"), raw(draws)).expect("written");
        let judge = format!("--case counted.toml --estimator double {WIDE} x.f64");
        place.expect(code, &judge, &["atoms: p = "]);
    }
}

#[test]
fn checks_in_memory_test_the_distribution_too() {
    let case = format!("{FIELD}/ff.toml");
    let right = |rng: &mut Stream| flight(rng);
    trueflight::check("flights", right).of(&case, "woodcock", None).assert_pass();
    // E[min(s, 2)] = ∫T and E[min(s, 2)²] = 2∫tT, layer by layer; two lengths that have both.
    let [near, far] = [(-0.5f64).exp(), (-2f64).exp()];
    let mean = 2.0 * (1.0 - near) + near * (1.0 - far) / 2.0;
    let square = 2.0 * (4.0 - 6.0 * near + near * ((1.0 - far) / 2.0 + (1.0 - 3.0 * far) / 4.0));
    let spread = (square - mean * mean).sqrt();
    let two = |rng: &mut Stream| if rng.uniform() < 0.5 { mean - spread } else { mean + spread };
    let outcome = trueflight::check("two lengths", two).of(&case, "woodcock", None).verdict();
    let outcome = outcome.expect("a verdict");
    assert_eq!(outcome.verdict(), Verdict::Fail);
    assert!(outcome.reason().contains("the distribution of the distances"), "{outcome}");
    // Pushed draws, with a known length or not.
    let mut rng = stream(8);
    let draws: Vec<f64> = (0..50_000).map(|_| two(&mut rng)).collect();
    let claim = || trueflight::claim("pushed").of(&case, "woodcock", None);
    for check in [claim(), claim().draws(50_000)] {
        let mut pushed = check.open().expect("a check");
        draws.chunks(777).for_each(|some| pushed.absorb(some).expect("pushed"));
        let outcome = pushed.verdict().expect("a verdict");
        assert!(outcome.reason().contains("the distribution of the distances"), "{outcome}");
    }
    // A known length that is not reached.
    let mut pushed = claim().draws(60_000).open().expect("a check");
    pushed.absorb(&flights(2, 50_000, |t| t)).expect("pushed");
    let text = pushed.verdict().expect("a verdict").to_string();
    assert!(text.contains("not tested: 50000 of 60000 announced draws came"), "{text}");
}

#[test]
fn lookups_that_are_pushed_with_a_case_are_judged_by_it() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("counted.toml");
    std::fs::write(&path, COUNTED).expect("written");
    let claim = || trueflight::claim("pushed").of(&path.display().to_string(), "ratio", None);
    let mut rng = stream(6);
    let counts: Vec<i32> = (0..50_000).map(|_| poisson(&mut rng, 4.0)).collect();
    let draws: Vec<f64> = counts.iter().map(|&n| 0.75f64.powi(n)).collect();
    let judged = |lookups: &[f64]| {
        let mut pushed = claim().open().expect("a check");
        pushed.absorb_with_lookups(&draws, lookups).expect("pushed");
        pushed.verdict().expect("a verdict")
    };
    let right: Vec<f64> = counts.iter().map(|&n| f64::from(n)).collect();
    let text = judged(&right).to_string();
    assert!(text.contains("counts: p = ") && !text.contains("fail:"), "{text}");
    let coins: Vec<f64> =
        (0..50_000).map(|_| if rng.uniform() < 0.5 { 2.0 } else { 6.0 }).collect();
    let outcome = judged(&coins);
    assert!(outcome.reason().contains("the distribution of the lookups"), "{outcome}");
    // First draws without lookups, then some with.
    let mut pushed = claim().open().expect("a check");
    pushed.absorb(&draws).expect("pushed");
    assert!(pushed.absorb_with_lookups(&draws, &right).is_err());
}

#[test]
fn correct_flights_fail_no_more_often_than_promised() {
    // Half of the streams may fail at α = 0.5, of which the distribution has a fifth.
    let case = Path::new(FIELD).join("ff.toml").display().to_string();
    let checks = || trueflight::claim("flights").of(&case, "woodcock", None).alpha(0.5);
    let streams = 400;
    let refuted = |announced: bool| {
        let is_refuted = |seed: &u64| {
            let draws = flights(1000 + seed, 3000, |t| t);
            let outcome = if announced {
                checks().judge(&draws).expect("a verdict")
            } else {
                let mut pushed = checks().open().expect("a check");
                pushed.absorb(&draws).expect("pushed");
                pushed.verdict().expect("a verdict")
            };
            outcome.values[0].distribution.iter().any(|test| test.p <= test_level(announced))
        };
        (0..streams).filter(is_refuted).count()
    };
    // The smallest of three p-values is below α/5/3 with a probability of at most α/5 = 0.1: 40 of 400, give or take 6.
    let once = refuted(true);
    assert!((8..=64).contains(&once), "{once}");
    // At the first look of several the level is half of that: 20, give or take 4.4.
    let first = refuted(false);
    assert!((2..=40).contains(&first), "{first}");
}

/// Returns the level of the smallest of three p-values, by Holm.
fn test_level(announced: bool) -> f64 {
    let share = if announced { 1.0 } else { 0.5 };
    share * 0.5 * 0.2 / 3.0
}
