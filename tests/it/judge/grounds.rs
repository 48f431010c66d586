//! Verdicts need grounds: missing evidence is no reason to fail.

use gate::stats::verdict::BLOCK;
use lab::self_test::streams::{self, CLAIMS, DrawDistribution, LAWS};
use trueflight::case::Case;
use trueflight::case::CaseText;
use trueflight::estimators::DrawBuffer;
use trueflight::judge::{CheckedClaim, Claim, Options, ROUNDING};
use trueflight::plan::{self, Plan};
use trueflight::record::Verdict;

use super::{Place, raw, uniform};

#[test]
fn rare_events_do_not_fail_a_correct_mean() {
    // 38 events of probability 9.5e-5, none among the first draws: the mean is the truth.
    let mut draws = vec![0.0; 400_000];
    draws[20_000..].iter_mut().step_by(10_000).for_each(|x| *x = 1.0);
    let place = Place::new(&[("b.f64", &raw(&draws))]);
    let missing =
        ["38 of 400000 draws carry it", "the variance, the range or the largest kurtosis"];
    place.expect(3, "--truth 9.5e-5 b.f64", &missing);
    for known in ["--variance 9.499e-5", "--range 0,1", "--variance 9.499e-5 --range 0,1"] {
        place.expect(3, &format!("--truth 9.5e-5 {known} b.f64"), &["undecided"]);
    }
    // The range is a ground against a mean that is really off.
    place.expect(1, "--truth 2.5e-4 --range 0,1 b.f64", &["the mean is off by -6"]);
    place.expect(1, "--truth 3e-5 --range 0,1 b.f64", &["the mean is off by +2"]);
}

#[test]
fn correct_draws_of_hard_laws_do_not_fail() {
    let verdicts = streams::all(4, &|_| {});
    for row in &verdicts {
        assert_eq!(row.failed, 0, "{}, {}: {}", row.distribution, row.known, row.reason);
    }
    // Every distribution has its truth and its variance, all but one a kurtosis, all but one a range.
    assert_eq!(verdicts.len(), 4 * LAWS.len() - 2);
}

#[test]
fn the_moments_of_the_laws_are_those_of_their_draws() {
    // Light tails only: other distributions have no sample moments to compare with.
    for law in [
        DrawDistribution::Bernoulli(1e-2),
        DrawDistribution::Exponential,
        DrawDistribution::Narrow,
        DrawDistribution::Uniform,
    ] {
        let claim = law.claim(CLAIMS[2]).expect("a claim");
        let draws = law.draws(9);
        let n = draws.len() as f64;
        let moment = |k: i32| draws.iter().map(|x| (x - claim.truth).powi(k)).sum::<f64>() / n;
        let (variance, kurtosis) = (claim.variance.expect("V"), claim.kurtosis.expect("κ"));
        assert!(moment(1).abs() < 6.0 * (variance / n).sqrt(), "{law}");
        let error = 6.0 * ((kurtosis - 1.0) / n).sqrt();
        assert!((moment(2) / variance - 1.0).abs() < error, "{law}");
        assert!((moment(4) / (variance * variance) / kurtosis - 1.0).abs() < 0.2, "{law}");
    }
    // By hand: E[X] = e^{−2.25}, E[X²] = e⁰, E[X³] = e^{−3.375}, E[X⁴] = e^{1.8}.
    let claim = DrawDistribution::Signed.claim(CLAIMS[2]).expect("a claim");
    assert!((claim.truth - (-2.25f64).exp()).abs() < 1e-15);
    assert!((claim.variance.expect("V") - (1.0 - (-4.5f64).exp())).abs() < 1e-14);
    let (m, three) = ((-2.25f64).exp(), (-3.375f64).exp());
    let fourth = 1.8f64.exp() - 4.0 * m * three + 6.0 * m * m - 3.0 * m.powi(4);
    let expected = fourth / (1.0 - m * m).powi(2);
    assert!((claim.kurtosis.expect("κ") / expected - 1.0).abs() < 1e-13);
}

/// Returns 4e5 draws of ratio tracking along the central ray of Eq. 21.
fn eq21(sampling: f64, seed: u64) -> Vec<f64> {
    let text = format!(
        "title = \"Eq. 21\"\n[problem.transmittance]\nvolume.eq21 = {{}}\n\
         ray = {{ origin = [0, 0, 0], direction = [0, 0, 1], length = 20.0 }}\n\
         estimators = [{{ ratio = {{ sampling.constant.value = {sampling:?} }} }}]\n"
    );
    let place = Place::new(&[("eq21.toml", text.as_bytes())]);
    let source = CaseText::read(&place.path().join("eq21.toml")).expect("a case");
    let case = Case::read(&source).expect("a case");
    let options = plan::Options { seed, ..plan::Options::default() };
    let plan = Plan::new(std::slice::from_ref(&case), &options);
    let planned = &plan.cases[0].experiments[0];
    let ready = planned.outcome.as_ref().expect("it is drawn");
    let (mut values, mut buffer) = (Vec::new(), DrawBuffer::new(1));
    let mut block = 0;
    while values.len() < 400_000 {
        let mut streams = planned.streams(block);
        for _ in 0..BLOCK / DrawBuffer::LENGTH as u64 {
            ready.experiment.fill(&mut streams, DrawBuffer::LENGTH, &mut buffer);
            values.extend_from_slice(&buffer.values[0]);
        }
        block += 1;
    }
    values.truncate(400_000);
    values
}

/// Optical depth τ of that ray, by quadrature in 30 digits.
const DEPTH: f64 = 3.415_684_260_061_982_3;

#[test]
fn two_per_cent_of_bias_fail_by_truth_and_range_alone() {
    let truth = (-DEPTH).exp();
    let verdict = |draws: &[f64], truth: f64| {
        let range = Some([0.0, 1.0]);
        let claim = Claim { range, rounding: ROUNDING, ..Claim::of_truth(truth) };
        let claim = claim.validated().expect("a claim");
        let trial = CheckedClaim::new(claim, Options::default(), Some(400_000)).expect("a trial");
        trial.judge_all(draws).verdict
    };
    for seed in [1, 2, 3] {
        let draws = eq21(2.0, seed);
        assert_eq!(verdict(&draws, truth * 1.02), Verdict::Fail, "seed {seed}");
        assert_eq!(verdict(&draws, truth / 1.02), Verdict::Fail, "seed {seed}");
        assert_ne!(verdict(&draws, truth), Verdict::Fail, "seed {seed}");
    }
}

#[test]
fn a_bound_on_the_kurtosis_is_a_ground() {
    let draws = uniform(200_000);
    let place = Place::new(&[("x.f64", &raw(&draws))]);
    place.expect(0, "--truth 1 --kurtosis 1.8 x.f64", &["a kurtosis of 1.8 at most"]);
    place.expect(1, "--truth 1.01 --kurtosis 1.8 x.f64", &["the mean is off by"]);
}

#[test]
fn draws_leave_their_range_only_by_rounding() {
    let mut draws = uniform(50_000);
    let place = Place::new(&[("x.f64", &raw(&draws))]);
    place.expect(0, "--truth 1 --range 0.75,1.25 x.f64", &[]);
    place.expect(0, "--truth 1 --range 0.75,inf --kurtosis 2 x.f64", &[]);
    place.expect(1, "--truth 1 --range 0.8,1.25 x.f64", &["range: draw", "outside of 0.8 to 1.25"]);
    draws[7] = 1.25 + 1e-14;
    std::fs::write(place.path().join("x.f64"), raw(&draws)).expect("written");
    place.expect(0, "--truth 1 --range 0.75,1.25 x.f64", &[]);
}

#[test]
fn a_kurtosis_of_one_is_tested() {
    let two_point: Vec<f64> =
        uniform(50_000).iter().map(|x| if *x < 1.0 { 0.5 } else { 1.5 }).collect();
    let place = Place::new(&[("two.f64", &raw(&two_point)), ("x.f64", &raw(&uniform(50_000)))]);
    let claim = "--truth 1 --variance 0.25 --kurtosis 1";
    place.expect(0, &format!("{claim} two.f64"), &["pass"]);
    place.expect(1, &format!("{claim} x.f64"), &["the variance is off"]);
    // A probability of ½ to rounding: κ − 1 = 1.6e-17, and squares differ from V by 4e-9 of it.
    let near = "--truth 0.500000001 --variance 0.25 --kurtosis 1";
    let bernoulli: Vec<f64> = two_point.iter().map(|x| x - 0.5).collect();
    std::fs::write(place.path().join("x.f64"), raw(&bernoulli)).expect("written");
    place.expect(0, &format!("{near} x.f64"), &["pass"]);
}

#[test]
fn ends_of_a_range_next_to_the_truth_are_no_trouble() {
    // A mean that no draws in the range can have needs no evidence.
    let bernoulli: Vec<f64> =
        uniform(50_000).iter().map(|x| f64::from(u8::from(*x < 1.245))).collect();
    let place = Place::new(&[("x.f64", &raw(&bernoulli))]);
    place.expect(0, "--truth 0.99 --range 0,1 --tolerance 0.02 x.f64", &["pass"]);
    place.expect(1, "--truth 0.97 --range 0,1 --tolerance 0.02 x.f64", &["the mean is off by +"]);
    // Rounding at one end is negligible at the other.
    let near: Vec<f64> = uniform(50_000).iter().map(|x| 1.0 + 6e-7 * (x - 1.0)).collect();
    std::fs::write(place.path().join("x.f64"), raw(&near)).expect("written");
    place.expect(1, "--truth 1 --range 0.999999999,1e6 x.f64", &["range: draw"]);
}

#[test]
fn scales_whose_squares_underflow_are_judged() {
    // A truth with a square of 0, and draws with a far larger spread.
    let wide: Vec<f64> = uniform(100_000).iter().map(|x| 1e-163 + 1e-150 * (x - 1.0)).collect();
    let place = Place::new(&[("x.f64", &raw(&wide))]);
    let claim = format!("--truth 1e-163 --variance {:e} --kurtosis 1.8", 1e-300 / 48.0);
    let found = place.json(&format!("{claim} x.f64"), &[]);
    assert_eq!(found["findings"][1]["verdict"], "pass", "{}", found["reason"]);
    let tiny: Vec<f64> = uniform(100_000).iter().map(|x| x * 1e-163).collect();
    std::fs::write(place.path().join("x.f64"), raw(&tiny)).expect("written");
    place.expect(0, "--truth 1e-163 --range 0.75e-163,1.25e-163 x.f64", &["pass"]);
    // The inverse of such a truth overflows.
    std::fs::write(place.path().join("x.f64"), raw(&[1.5e-310; 100])).expect("written");
    place.expect(1, "--truth 1e-310 --variance 0 x.f64", &["not 1e-310"]);
}

#[test]
fn a_refuted_variance_is_named_and_a_mean_that_rests_on_it_is_not_accused() {
    let draws = uniform(200_000);
    let biased: Vec<f64> = draws.iter().map(|x| x + 0.01).collect();
    let place = Place::new(&[("x.f64", &raw(&draws)), ("off.f64", &raw(&biased))]);
    // A variance that is thirty times too small is evidence against any mean.
    let claim = format!("--truth 1 --variance {}", 1.0 / 1440.0);
    for kurtosis in ["", "--kurtosis 1.8"] {
        let found = place.json(&format!("{claim} {kurtosis} x.f64"), &[]);
        assert_eq!(found["verdict"], "fail");
        let reason = found["reason"].as_str().expect("words");
        assert!(reason.starts_with("the variance is off by +"), "{reason}");
        // Thirty times the variance is 29 more; its standard error over a block is 0.21.
        let off = found["findings"][0]["gate"]["mean"].as_f64().expect("a number");
        assert!((off - 29.0).abs() < 1.0, "{off}");
        assert!(!reason.contains("the mean is off"), "{reason}");
        assert_eq!(found["findings"][0]["check"], "variance");
        let found = place.json(&format!("{claim} {kurtosis} off.f64"), &[]);
        let reason = found["reason"].as_str().expect("words");
        // If the mean is off as well, both are reported, the variance first.
        let place = |words: &str| reason.find(words).unwrap_or_else(|| panic!("{reason}"));
        assert!(place("the variance is off") < place("the mean is off"), "{reason}");
    }
}

#[test]
fn a_kurtosis_that_draws_refute_is_not_assumed() {
    // Light tails first, heavy ones later: the kurtosis of the first draws bounded the variance, and does not hold.
    let mut draws = uniform(400_000);
    draws[100_000..].iter_mut().step_by(100).for_each(|x| *x = 1.0 + 30.0 * (*x - 1.0));
    let place = Place::new(&[("x.f64", &raw(&draws))]);
    let words = ["more than the 82 that was assumed", "give the variance, the range"];
    place.expect(3, "--truth 1 x.f64", &words);
}

#[test]
fn a_variance_that_is_not_tested_says_so() {
    let faint: Vec<f64> = uniform(50_000).iter().map(|x| 1.0 + 1e-11 * (x - 1.0)).collect();
    let place = Place::new(&[("x.f64", &raw(&faint))]);
    let claim = "--truth 1 --variance 2.0833333333333333e-24 --kurtosis 1.8";
    place.expect(0, &format!("{claim} x.f64"), &["the variance is not tested: rounding hides it"]);
    let unused = "no variance is tested: rounding hides it; leave it out";
    place.expect(2, &format!("{claim} --variance-tolerance 0.1 x.f64"), &[unused]);
}

#[test]
fn coarse_draws_and_draws_that_fill_no_average_are_told() {
    #[allow(clippy::cast_possible_truncation)] // what the truncation loses is the question
    let single: Vec<f64> = uniform(50_000).iter().map(|&x| f64::from(x as f32)).collect();
    let place = Place::new(&[("x.f64", &raw(&single))]);
    let words = [
        "single precision: draws have 24 bits",
        "resolution: the first draws repeat as if they took 2^2",
    ];
    place.expect(0, "--truth 1 --range 0.75,1.25 x.f64", &words);
    let batch = "--truth 1 --range 0.75,1.25 --batch 99 x.f64";
    place.expect(0, batch, &["averages of 99", "the last 5 draws fill no average"]);
}
