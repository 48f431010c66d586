//! Draws of users: streams that repeat, passes with large z, a mean that is off from the first draw.

use super::{Place, raw, uniform};

/// Returns uniform numbers in [0, 1), another sequence for each seed.
fn units(seed: u64, n: usize) -> Vec<f64> {
    // Not a multiple of the step: the sequences would overlap.
    let mut state = seed.wrapping_mul(0xd134_2543_de82_ef95);
    let mut next = || {
        // SplitMix64 (G. L. Steele Jr., D. Lea, C. H. Flood, Fast splittable pseudorandom number generators, 2014).
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0
    };
    (0..n).map(|_| next()).collect()
}

fn times(draws: &[f64], n: usize) -> Vec<f64> {
    draws.iter().copied().cycle().take(n).collect()
}

fn field(name: &str) -> Vec<u8> {
    std::fs::read(format!("{}/tests/data/field/{name}", env!("CARGO_MANIFEST_DIR"))).expect(name)
}

#[test]
fn streams_of_the_field_that_repeat_are_named_with_their_period() {
    let claim = "--truth 1 --variance 1 --kurtosis 9 --tolerance 0.1";
    for (draws, often) in [(500, 24), (600, 20), (800, 15)] {
        let file = field(&format!("14-seed-repeats/{draws}-draws-{often}-times.f64"));
        let place = Place::new(&[("x.f64", &file)]);
        let said = format!("the same draws come again {draws} draws later, {often} times in all");
        place.expect(3, &format!("{claim} x.f64"), &[&said, "a seed of its own"]);
        let found = place.json(&format!("{claim} x.f64"), &[]);
        assert_eq!(
            (&found["independence"]["replay"], &found["independence"]["repeats"]),
            (&draws.into(), &often.into())
        );
    }
}

#[test]
fn any_number_of_repetitions_is_found() {
    for (seed, (period, n)) in (1..).zip([
        (100_000, 199_000),
        (1000, 17_000),
        (1000, 400_000),
        (50, 200_000),
        (7, 70_000),
        (12, 24),
    ]) {
        let place = Place::new(&[("x.f64", &raw(&times(&units(seed, period), n)))]);
        let said = format!("the same draws come again {period} draws later");
        place.expect(3, "--truth 0.5 --range 0,1 x.f64", &[&said]);
    }
    // A repetition after other draws.
    let late = [units(9, 30_000), times(&units(10, 777), 13_000)].concat();
    let place = Place::new(&[("x.f64", &raw(&late))]);
    place.expect(3, "--truth 0.5 --range 0,1 x.f64", &["again 777 draws later, 17 times in all"]);
    // Averages that repeat, given as draws.
    let place = Place::new(&[("x.f64", &raw(&times(&units(11, 500), 12_000)))]);
    let said = "the same averages come again 500 draws later, 24 times in all";
    place.expect(3, "--truth 0.5 --range 0,1 --batch 10 x.f64", &[said]);
    let all = "all 24 averages hold the same draws";
    place.expect(3, "--truth 0.5 --range 0,1 --batch 500 x.f64", &[all]);
    for levels in [2.0, 1e9] {
        let coarse: Vec<f64> =
            units(12, 997).iter().map(|u| (u * levels).floor() / (levels - 1.0)).collect();
        let place = Place::new(&[("x.f64", &raw(&times(&coarse, 24_000)))]);
        let said = "the same draws come again 997 draws later";
        place.expect(3, "--truth 0.5 --range 0,1 --batch 64 x.f64", &[said]);
    }
    // Passes of a hundred pixels: half of them have one value in all passes, and a quarter are 0 or 1.
    let pass = |(i, u): (usize, &f64)| match i % 100 {
        0..50 => (i % 100) as f64 / 50.0,
        50..75 => u.round(),
        _ => *u,
    };
    let passes: Vec<f64> = units(13, 500_000).iter().enumerate().map(pass).collect();
    let place = Place::new(&[("x.f64", &raw(&passes))]);
    let (code, text) = place.says("--truth 0.495 --range 0,1 --batch 100 x.f64", &[]);
    assert!(code != 1 && text.contains("nothing found"), "{text}");
}

/// Truth of the batch means of the field.
const BATCHED: &str = "--truth 0.36787944117144233";

#[test]
fn no_pass_stands_beside_a_bias_of_77_standard_errors() {
    let file = field("27-range-pass/bias1000.f64");
    let place = Place::new(&[("x.f64", &file)]);
    let looks = [
        "z = +77.38",
        "looks off by +1 % (measured 0.3716, expected 0.3679), z = +77.4 over 1000 draws",
        "give more",
    ];
    place.expect(3, &format!("{BATCHED} --range 0,1 x.f64"), &looks);
    // Smallest bias that a range of length 1 can show with this number of draws: 12 R/n with R = (1 − T)/T, relative to
    // the truth; up to half of the draws serve to estimate the variance.
    let found = place.json(&format!("{BATCHED} --range 0,1 x.f64"), &[]);
    let tolerance = found["findings"][0]["gate"]["tolerance"].as_f64().expect("ε");
    let finest = 12.0 * (1.0_f64.exp() - 1.0) / 1000.0;
    assert!((finest..2.0 * finest).contains(&tolerance), "{tolerance}");
    for known in ["--variance 2.3e-6", "--kurtosis 4", "--variance 2.3e-6 --kurtosis 3.1"] {
        let said = "the mean is off by +1 % (measured 0.371";
        place.expect(1, &format!("{BATCHED} {known} x.f64"), &[said]);
        let below = "below the tolerance of 5.0e-2, which is what a pass must exclude";
        place.expect(1, &format!("{BATCHED} {known} --tolerance 0.05 x.f64"), &[said, below]);
    }
    // The first n of these draws never pass, with any range.
    for n in [10, 20, 50, 100, 200, 500] {
        std::fs::write(place.path().join("few.f64"), &file[..8 * n]).expect("written");
        for range in ["0,1", "0.3,0.45", "-10,10"] {
            let (code, text) = place.says(&format!("{BATCHED} --range {range} few.f64"), &[]);
            assert!(code == 1 || code == 3, "{n}, {range}: {text}");
        }
    }
}

#[test]
fn a_tolerance_that_is_asked_for_is_the_one_that_is_tested() {
    let file = field("27-range-pass/bias1000.f64");
    let place = Place::new(&[("x.f64", &file), ("few.f64", &file[..800])]);
    let within = "within the tolerance of 5.0e-2 that was asked for";
    let said = [
        "pass: the mean is off by +1 % (measured 0.3716, expected 0.3679), z = +77.4 over 1000 draws",
        within,
    ];
    place.expect(0, &format!("{BATCHED} --range 0,1 --tolerance 0.05 x.f64"), &said);
    place.expect(
        3,
        &format!("{BATCHED} --range 0,1 --tolerance 0.005 x.f64"),
        &["ε = 0.005", "looks off"],
    );
    // Tolerances wider than a quarter of the spread, and few draws.
    for (claim, tolerance, file) in [
        ("--truth 0.3716 --variance 2.3e-6", 0.05, "few.f64"),
        ("--truth 0.3716 --variance 2.3e-6 --kurtosis 3.1", 0.5, "few.f64"),
        ("--truth 0.3716 --kurtosis 3.1", 0.05, "x.f64"),
        ("--truth 0.3716 --range 0,1", 0.3, "few.f64"),
        ("--truth 0.3716 --range 0,1 --batch 10", 0.3, "x.f64"),
    ] {
        let found = place.json(&format!("{claim} --tolerance {tolerance} {file}"), &[]);
        let gate = &found["findings"][0]["gate"];
        assert_eq!(found["verdict"], "pass", "{claim}: {}", found["reason"]);
        assert_eq!(gate["tolerance"].as_f64(), Some(tolerance), "{claim}");
    }
    // A tolerance that cannot be tested is reported.
    place.expect(
        3,
        "--truth 0.3716 --tolerance 0.05 x.f64",
        &["the tolerance of 5.0e-2 is not tested"],
    );
    let unused = "the tolerance of 5.0e-2 is not used: the variance given allows rounding alone";
    let same = raw(&[0.25; 1000]);
    let place = Place::new(&[("same.f64", &same), ("off.f64", &raw(&[0.2501; 1000]))]);
    place.expect(0, "--truth 0.25 --variance 0 --tolerance 0.05 same.f64", &[unused]);
    place.expect(1, "--truth 0.25 --variance 0 --tolerance 0.05 off.f64", &[unused]);
    place.expect(0, "--truth 0.25 --range 0,1 --tolerance 0.05 off.f64", &["pass"]);
    // Without a tolerance, draws that are all equal and off do not pass.
    place.expect(3, "--truth 0.25 --range 0,1 off.f64", &["undecided"]);
}

#[test]
fn a_mean_that_is_off_from_the_first_draw_is_no_drift() {
    type Law = (&'static str, f64, f64, &'static str, fn(f64) -> f64);
    let laws: [Law; 4] = [
        ("coin", 0.3, 0.21, "--kurtosis 1.77", |u| f64::from(u8::from(u < 0.3))),
        ("exponential", 1.0, 1.0, "--kurtosis 9", |u| -(1.0 - u).ln()),
        ("uniform", 0.5, 1.0 / 12.0, "--kurtosis 1.8 --range 0,1", |u| u),
        // Pareto of index 4.5 less 1.
        ("Pareto", 1.0 / 3.5, 4.5 / (3.5 * 3.5 * 2.5), "--range 0,inf", |u| {
            (1.0 - u).powf(-1.0 / 4.5) - 1.0
        }),
    ];
    for (name, mean, variance, known, law) in laws {
        for seed in 50..53 {
            let draws: Vec<f64> = units(seed, 300_000).iter().map(|&u| law(u)).collect();
            let place = Place::new(&[("x.f64", &raw(&draws))]);
            for bias in [0.003, -0.01, 0.03, -0.1, 0.4] {
                let truth = mean / (1.0 + bias);
                let all = format!("--truth {truth} --variance {variance} {known}");
                for claim in [all, format!("--truth {truth} {known}")] {
                    let found = place.json(&format!("{claim} x.f64"), &[]);
                    let reason = found["reason"].as_str().expect("words");
                    assert!(!reason.contains("the mean changes"), "{name}, {claim}: {reason}");
                    assert_ne!(found["drift"]["verdict"], "fail", "{name}, {claim}");
                    assert!(found["drift"]["from"].is_null(), "{name}, {claim}");
                    let is_plain = found["z"].as_f64().expect("z").abs() > 8.0;
                    assert!(!is_plain || found["verdict"] != "pass", "{name}, {claim}: {reason}");
                }
            }
        }
    }
}

#[test]
fn a_variance_is_not_accused_where_squares_are_too_large_by_the_bias_alone() {
    let draws: Vec<f64> = uniform(100_000).iter().map(|x| x + 0.3).collect();
    let place = Place::new(&[("x.f64", &raw(&draws))]);
    for kurtosis in ["", "--kurtosis 1.8"] {
        let claim = format!("--truth 1 --variance {} {kurtosis} x.f64", 1.0 / 48.0);
        let found = place.json(&claim, &[]);
        let reason = found["reason"].as_str().expect("words");
        assert!(
            found["verdict"] == "fail" && reason.starts_with("the mean is off by +"),
            "{reason}"
        );
        assert!(!reason.contains("variance"), "{reason}");
        let words = found["findings"][1]["reason"].as_str().expect("words");
        assert!(words.starts_with("squares about the truth are too large"), "{words}");
    }
}

#[test]
fn a_mean_that_changes_is_named_drift() {
    let n = 400_000;
    for (seed, bias) in [(60, 0.02), (61, -0.02), (62, 0.05)] {
        for start in [n * 3 / 10, n / 2, n * 4 / 5] {
            let draws: Vec<f64> = units(seed, n)
                .iter()
                .enumerate()
                .map(|(i, u)| (0.75 + 0.5 * u) * if i < start { 1.0 } else { 1.0 + bias })
                .collect();
            let place = Place::new(&[("x.f64", &raw(&draws))]);
            for claim in [super::UNIFORM, "--truth 1 --range 0.5,1.5"] {
                let found = place.json(&format!("{claim} x.f64"), &[]);
                let reason = found["reason"].as_str().expect("words");
                let said = format!("it is off by {}", if bias > 0.0 { "+" } else { "-" });
                assert!(
                    reason.contains("the mean changes: from draw"),
                    "{bias}, {start}: {reason}"
                );
                assert!(reason.contains(&said), "{reason}");
                let from = found["drift"]["from"].as_u64().expect("a draw");
                assert!(from.abs_diff(start as u64) <= 16_384, "{from} for {start}");
            }
        }
    }
}

/// Returns the rows of `trueflight predict`, by the names of columns.
fn predicted(case: &str) -> Vec<std::collections::HashMap<String, String>> {
    let place = Place::new(&[("x.toml", case.as_bytes())]);
    let mut command = assert_cmd::Command::cargo_bin("trueflight").expect("the binary");
    let output = command.current_dir(place.path()).args(["predict", "x.toml", "--format", "csv"]);
    let output = output.output().expect("it runs");
    let text = String::from_utf8(output.stdout).expect("text");
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned));
    let names: Vec<String> = lines.next().expect("a header").collect();
    lines.map(|row| names.iter().cloned().zip(row).collect()).collect()
}

#[test]
fn a_draw_of_0_or_1_has_the_moments_of_a_coin_in_slabs_of_any_depth() {
    let field = String::from_utf8(field("35-slab-variance/t40.toml")).expect("text");
    for (depth, albedo) in [(100, 0.9), (50, 0.9), (30, 0.5), (250, 0.99), (40, 0.1), (10, 0.3)] {
        for light in
            ["collimated = { cosine = 1 }", "diffuse = {}", "collimated = { cosine = 0.2 }"]
        {
            let case = field
                .replace("extinction = 100", &format!("extinction = {depth}"))
                .replace("value = 100", &format!("value = {}", 1.5 * f64::from(depth)))
                .replace("albedo = 0.9", &format!("albedo = {albedo}"))
                .replace("collimated = { cosine = 1 }", light)
                .replace(
                    "[{ analog",
                    "[{ weighted = { sampling.constant.value = 300 } }, { analog",
                );
            let rows = predicted(&case);
            assert!(rows.len() == 4 && rows.iter().all(|row| !row["truth"].is_empty()), "{case}");
            for row in &rows {
                let number = |column: &str| row[column].parse::<f64>().ok();
                let Some(truth) = number("truth") else { continue };
                let context = format!("{depth}, {albedo}, {light}: {row:?}");
                let coin = truth * (1.0 - truth);
                let error = number("moments_error").expect("an error");
                let Some(variance) = number("predicted_variance") else {
                    // Numbers that theory does not resolve are not shown.
                    assert!(error >= 0.5 && row["predicted_kurtosis"].is_empty(), "{context}");
                    continue;
                };
                assert!(error < 0.5, "{context}");
                // No draw in [0, 1] has a larger variance.
                assert!(variance <= coin * (1.0 + error + 1e-9), "{context}");
                if row["estimator"] == "analog" {
                    assert!((variance / coin - 1.0).abs() < 1e-9 + error, "{context}");
                    let kurtosis = number("predicted_kurtosis").expect("a kurtosis");
                    let expected = (1.0 - 3.0 * coin) / coin;
                    assert!((kurtosis / expected - 1.0).abs() < 1e-6 + 3.0 * error, "{context}");
                }
            }
            let mut coins = rows.iter().filter(|row| row["estimator"] == "analog");
            let is_shown = |row: &_, column: &str| {
                let row: &std::collections::HashMap<String, String> = row;
                !row[column].is_empty()
            };
            assert!(coins.all(|row| is_shown(row, "truth") == is_shown(row, "predicted_variance")));
        }
    }
}
