//! Estimators as closures: passes, failures, and their messages.

use trueflight::OfCase;
use trueflight::case::Case;
use trueflight::case::CaseText;
use trueflight::check::CheckError;
use trueflight::gate::CheckId;
use trueflight::judge::ExperimentChoice;
use trueflight::rng::Stream;
use trueflight::stats::verdict::Verdict;
use trueflight::{Gate, check, check_with, claim};

/// Returns σ_t of Eq. 21 on its central ray.
fn sigma_t(t: f64) -> f64 {
    (0.75 * t).cos().powi(10) * ((t / 2.0).sin() + 2.0) / 3.0
}

/// Ratio tracking on [0, 20] with the factor of a collision, and its lookups.
fn ratio_of(rng: &mut Stream, sampling: f64, keep: impl Fn(f64) -> f64) -> (f64, u64) {
    let (mut weight, mut t, mut lookups) = (1.0, 0.0, 0);
    loop {
        t -= rng.positive_uniform().ln() / sampling;
        if t > 20.0 {
            return (weight, lookups);
        }
        weight *= keep(sigma_t(t) / sampling);
        lookups += 1;
    }
}

fn ratio(rng: &mut Stream, sampling: f64) -> f64 {
    ratio_of(rng, sampling, |r| 1.0 - r).0
}

const CASE: &str = "transmittance/eq21-overview";

#[test]
fn the_three_lines_of_the_front_page_pass() {
    check("ratio tracking, Eq. 21", |rng| ratio(rng, 1.0)).of(CASE, "ratio", 1.0).assert_pass();
}

#[test]
fn lookups_are_judged_where_they_are_told() {
    let with = |keep: fn(f64) -> f64| {
        check("ratio", move |rng| ratio_of(rng, 1.3, keep)).of(CASE, "ratio", 1.3).verdict()
    };
    let honest = with(|r| 1.0 - r).expect("a verdict");
    assert_eq!(honest.verdict(), Verdict::Pass, "{honest}");
    assert!(honest.values[0].finding(CheckId::Lookups).is_some(), "{honest}");
    // Draws with doubled lookups.
    let twice = check("twice", |rng| {
        let (weight, lookups) = ratio_of(rng, 1.3, |r| 1.0 - r);
        (weight, 2 * lookups)
    });
    let twice = twice.of(CASE, "ratio", 1.3).verdict().expect("a verdict");
    assert_eq!(twice.verdict(), Verdict::Fail);
    assert!(twice.reason().contains("lookups"), "{twice}");
}

#[test]
fn bugs_of_mean_and_variance_fail() {
    // Each collision keeps slightly too much.
    let bright = check("bright", |rng| ratio_of(rng, 1.0, |r| 1.0 - 0.99 * r).0);
    let bright = bright.of(CASE, "ratio", 1.0).verdict().expect("a verdict");
    assert_eq!(bright.verdict(), Verdict::Fail, "{bright}");
    // The right mean at another σ̂: the variance differs.
    let other = check("other", |rng| ratio(rng, 1.5)).of(CASE, "ratio", 1.0).verdict();
    let other = other.expect("a verdict");
    assert_eq!(other.verdict(), Verdict::Fail, "{other}");
    assert!(other.reason().contains("variance"), "{other}");
    let mean = check("other", |rng| ratio(rng, 1.5)).of(CASE, "ratio", 1.0).mean_only();
    mean.range(0.0, 1.0).assert_pass();
}

#[test]
fn a_constant_does_not_pass_for_draws_that_vary() {
    // The right mean without any variance: without a kurtosis or a range nothing refutes it, and nothing confirms it.
    let constant = || check("constant", |_| 0.4).truth(0.4).variance(0.1).draws(200_000);
    let found = constant().verdict().expect("a verdict");
    assert_eq!(found.verdict(), Verdict::Inconclusive, "{found}");
    assert!(found.reason().contains("the variance looks off by -1"), "{found}");
    for known in [constant().range(0.0, 1.0), constant().kurtosis(3.0)] {
        let found = known.verdict().expect("a verdict");
        assert_eq!(found.verdict(), Verdict::Fail, "{found}");
    }
}

#[test]
fn channels_are_judged_one_by_one() {
    let three = |rng: &mut Stream| {
        let u = rng.uniform();
        [u, u * u, 2.0 - u]
    };
    let right = [0.5, 1.0 / 3.0, 1.5];
    check("three", three).truth(right).range(0.0, 2.0).assert_pass();
    let wrong = check("three", three).truth([0.5, 0.34, 1.5]).range(0.0, 2.0).verdict();
    let wrong = wrong.expect("a verdict");
    assert_eq!(
        wrong.values.iter().map(|v| v.verdict).collect::<Vec<_>>(),
        [Verdict::Pass, Verdict::Fail, Verdict::Pass]
    );
    assert!(wrong.reason().starts_with("value 1: "), "{wrong}");
}

#[test]
fn threads_change_nothing() {
    let by = |threads| {
        let make = || |rng: &mut Stream| ratio(rng, 1.0);
        let check = check_with("ratio", make).of(CASE, "ratio", 1.0).threads(threads);
        check.draws(300_001).verdict().expect("a verdict").to_string()
    };
    let one = by(1);
    assert!(one.contains("300001 in ratio"), "{one}");
    assert_eq!(by(2), one);
    assert_eq!(by(16), one);
    let plain = check("ratio", |rng| ratio(rng, 1.0)).of(CASE, "ratio", 1.0).draws(300_001);
    assert_eq!(plain.verdict().expect("a verdict").to_string(), one);
}

#[test]
fn pushing_by_ones_or_by_millions_is_the_same() {
    let mut state = 7u64;
    let draws = std::iter::repeat_with(|| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    });
    let draws: Vec<f64> = draws.take(100_000).collect();
    let claimed = || claim("u").truth(0.5).variance(1.0 / 12.0).draws(100_000);
    let whole = claimed().judge(&draws).expect("a verdict").to_string();
    for size in [1, 999, 16_384, 40_000] {
        let mut pushed = claimed().open().expect("a claim");
        for some in draws.chunks(size) {
            pushed.absorb(some).expect("whole draws");
        }
        assert_eq!(pushed.draws(), 100_000);
        assert_eq!(pushed.verdict().expect("a verdict").to_string(), whole, "{size}");
    }
    // Two values per draw, with lookups.
    let mut pairs = claim("pairs").truth([0.5, 0.5]).range(0.0, 1.0).lookups(3.0, 0.0).open();
    let pairs = pairs.as_mut().expect("a claim");
    let counts = vec![3.0; draws.len() / 2];
    pairs.absorb_with_lookups(&draws, &counts).expect("whole draws");
    assert_eq!(pairs.draws(), 50_000);
}

#[test]
fn a_gate_shares_its_alpha() {
    let fair = || check("fair", Stream::uniform).truth(0.5).range(0.0, 1.0);
    let off = check("off", Stream::uniform).truth(0.52).range(0.0, 1.0);
    let verdicts = Gate::new().alpha(0.02).check(fair()).check(off).verdicts();
    let verdicts: Vec<_> = verdicts.into_iter().map(|verdict| verdict.expect("one")).collect();
    assert!(verdicts.iter().all(|outcome| outcome.alpha == 0.01));
    assert!(verdicts[0].passed() && verdicts[1].verdict() == Verdict::Fail);
    let off = check("off", Stream::uniform).truth(0.52).range(0.0, 1.0);
    let panic = std::panic::catch_unwind(|| Gate::new().check(fair()).check(off).assert_pass());
    let panic = panic.expect_err("a fail");
    let words = panic.downcast_ref::<String>().expect("words");
    assert!(words.starts_with("1 of 2 checks do not pass\n`off`: fail"), "{words}");
}

#[test]
fn many_values_are_told_in_few_words() {
    let wrong = check("many", |rng| [rng.uniform(); 100]).truth(0.4).range(0.0, 1.0).draws(50_000);
    let text = wrong.verdict().expect("a verdict").to_string();
    assert!(text.contains("; and 92 others") && text.ends_with("and 92 other values"), "{text}");
    assert!(std::panic::catch_unwind(|| Gate::new().assert_pass()).is_err());
}

#[test]
fn a_case_of_ones_own_is_as_good() {
    let text = r#"
        title = "two layers"
        [problem.transmittance]
        medium.piecewise-constant = { breaks = [0, 1, 3], values = [1, 0.25] }
        span = [0, 3]
        estimators = [{ ratio = { sampling.constant.value = 1.0 } }]
    "#;
    let source = CaseText { name: "mine".into(), path: "mine.toml".into(), text: text.into() };
    let case = Case::read(&source).expect("a case without mistakes");
    let estimator = |rng: &mut Stream| {
        let (mut weight, mut t) = (1.0, 0.0);
        loop {
            t -= rng.positive_uniform().ln();
            if t > 3.0 {
                return weight;
            }
            weight *= if t < 1.0 { 0.0 } else { 0.75 };
        }
    };
    let choice = ExperimentChoice { estimator: "ratio", ..ExperimentChoice::default() };
    check("layers", estimator).of_case(&case, &choice).assert_pass();
}

/// Returns the message of a check without a verdict.
fn said<T>(verdict: Result<T, CheckError>) -> String {
    verdict.map_or_else(|error| error.to_string(), |_| "a verdict".into())
}

/// Returns a case with draws that are too small for doubles.
fn deep() -> Case {
    let text = r#"
        title = "deep"
        [problem.transmittance]
        medium.constant = { extinction = 1 }
        span = [0, 400]
        estimators = [{ ratio = { sampling.constant.value = 1.5 } }]
    "#;
    let source = CaseText { name: "deep".into(), path: "deep.toml".into(), text: text.into() };
    Case::read(&source).expect("a case without mistakes")
}

#[test]
fn averages_take_the_mean_alone_and_rounding_counts_whenever_it_is_said() {
    let averages = check("averages", |rng| ratio(rng, 1.0)).of(CASE, "ratio", 1.0).batch(16);
    averages.range(0.0, 1.0).assert_pass();
    #[expect(clippy::cast_possible_truncation)] // single precision is what this is about
    let single = |rng: &mut Stream| f64::from(ratio(rng, 1.0) as f32);
    let regular = |_: &mut Stream| 0.013_4 * (1.0 + 1e-7);
    let claimed = || check("constant", regular).truth(0.013_4).variance(0.0);
    assert_eq!(claimed().verdict().expect("a verdict").verdict(), Verdict::Fail);
    assert_eq!(
        claimed().rounding(1e-6).draws(20_000).verdict().expect("one").verdict(),
        Verdict::Pass
    );
    check("single", single).of(CASE, "ratio", 1.0).rounding(1e-6).assert_pass();
    // Every draw of `closed-form` is the truth, within the rounding that the claim states.
    let truth = check("truth", |_| 0.032_853_9 * (1.0 + 1e-5)).of(CASE, "closed-form", None);
    let truth = truth.mean_only().variance(0.0).draws(20_000);
    assert_eq!(truth.clone().verdict().expect("one").verdict(), Verdict::Fail);
    assert_eq!(truth.rounding(1e-4).verdict().expect("one").verdict(), Verdict::Pass);
}

/// Wrong claims alone are in `judge::bad_input_is_2_with_one_clear_error`.
#[test]
fn what_makes_no_sense_is_told_with_its_cure() {
    let u = || check("u", Stream::uniform);
    let pair = || check("pair", |rng| [rng.uniform(), rng.uniform()]);
    let texts = [
        (said(u().verdict()), "give it by .truth(…)"),
        (said(u().truth(0.5).alpha(0.0).verdict()), "a probability above 0 and below 1"),
        (said(u().truth(0.5).alpha(f64::NAN).verdict()), "alpha = NaN"),
        (said(u().truth(0.5).draws(0).verdict()), "number of draws = 0"),
        (said(u().truth(0.5).batch(0).verdict()), "batch = 0"),
        (said(u().truth([0.5, 0.5]).verdict()), "2 numbers for the truth, but a draw has 1 value;"),
        (
            said(pair().truth([0.5; 3]).verdict()),
            "3 numbers for the truth, but a draw has 2 values",
        ),
        (said(u().truth(0.5).lookups(3.0, 1.0).verdict()), "return (value, lookups)"),
        (said(u().of(CASE, "ratio", None).verdict()), "say at which value your draws were made"),
        (said(pair().truth(0.5).alpha(1.5).verdict()), "alpha = 1.5"),
        (
            said(
                u().of_case(
                    &deep(),
                    &ExperimentChoice { estimator: "ratio", ..ExperimentChoice::default() },
                )
                .verdict(),
            ),
            "multiply the draws by e^τ",
        ),
        (said(u().of(CASE, "ratio", 1.0).truth(0.5).verdict()), "the truth is given twice"),
        (
            said(pair().of(CASE, "ratio", 1.0).verdict()),
            "a draw has 2 values, but the case has 1 channel",
        ),
        (said(check("none", |_| [0.0; 0]).truth(0.5).verdict()), "return one at least"),
        (said(u().of("transmitance/eq21-overview", "ratio", 1.0).verdict()), "did you mean"),
        (said(claim("none").truth(0.5).judge(&[])), "there are no draws"),
        (said(claim("odd").truth([0.5; 2]).judge(&[0.5; 3])), "no whole number of draws"),
    ];
    for (found, wanted) in texts {
        assert!(found.contains(wanted), "{found}\n  does not say\n{wanted}");
    }
}

#[test]
fn panics_and_numbers_that_are_none_are_placed() {
    let mut calls = 0u64;
    let panics = check("third", move |_| {
        calls += 1;
        assert!(calls <= 20_000, "no more");
        0.5
    });
    let found = said(panics.truth(0.5).range(0.0, 1.0).draws(30_000).seed(9).verdict());
    assert_eq!(found, "check `third`: the estimator panicked in draw 20000 (seed 9): no more");
    let make = || |_: &mut Stream| -> f64 { panic!("at once") };
    let found = said(check_with("all", make).truth(0.5).threads(3).verdict());
    assert!(found.contains("in draw 0 (seed 1): at once"), "{found}");
    let nan = |rng: &mut Stream| if rng.uniform() < 1e-3 { f64::NAN } else { 0.5 };
    let nan = check("nan", nan).truth(0.5).range(0.0, 1.0).verdict().expect("a verdict");
    assert_eq!(nan.verdict(), Verdict::Fail);
    assert!(nan.reason().starts_with("numeric: draw "), "{nan}");
}
