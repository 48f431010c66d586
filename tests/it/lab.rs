//! Parts of the lab: what its tables, oracles and traces are made of.

use lab::h_function::h_function;
use lab::self_test::streams::StreamVerdicts;
use lab::stress::balls::FINER;
use lab::stress::moments::{Case, products};
use lab::stress::narrow::trail::{Precision, Traced, Trail};
use lab::stress::narrow::{Along, BothPrecisions, PrecisionCurve};
use lab::stress::parameters::between;
use lab::stress::rods::rod_of;
use lab::stress::shared_walk::of_mean;
use lab::stress::table::of_stated;
use lab::stress::{Effort, Measure, Run, TrialRow};
use proptest::collection::vec;
use proptest::strategy::Just;
use trueflight::media::Piecewise;
use trueflight::numeric::quadrature::GaussLegendre;
use trueflight::numeric::rng::{Address, Random};
use trueflight::numeric::{DoubleDouble, F32, Known, Lane, ScalarLane};
use trueflight::theory::space::sphere::ball::Ball;
use trueflight::theory::space::sphere::shells::{BallResolution, Centre};
use trueflight::theory::space::sphere::{Lights, Observable, answers};
use trueflight::theory::{ParticleRule, rod};

#[test]
fn without_scattering_it_is_one() {
    assert!((h_function(0.0, 0.7) - 1.0).abs() < 1e-15);
    assert_eq!(h_function(0.9, 0.0), 1.0);
}

#[test]
fn its_integral_is_known() {
    // ½ a ∫ H dμ = 1 − √(1 − a) (Chandrasekhar, chapter 5, theorem 1).
    let rule = GaussLegendre::new(40);
    for albedo in [0.3, 0.9, 1.0] {
        let integral = rule.integrate(0.0, 1.0, |x| 2.0 * x * h_function(albedo, x * x));
        let exact = 1.0 - f64::sqrt(1.0 - albedo);
        assert!((0.5 * albedo * integral - exact).abs() < 1e-10, "a = {albedo}: {integral}");
    }
}

#[test]
fn it_solves_its_equation() {
    let rule = GaussLegendre::new(40);
    for (albedo, cosine) in [(0.5, 0.3), (1.0, 1.0)] {
        let here = h_function(albedo, cosine);
        let integral =
            rule.integrate(0.0, 1.0, |x| 2.0 * x * h_function(albedo, x * x) / (cosine + x * x));
        let there = 1.0 + 0.5 * albedo * cosine * here * integral;
        assert!((here - there).abs() < 1e-10, "{here} {there}");
    }
}

fn row(measure: Measure, errors: &[f64]) -> TrialRow {
    let mut row = TrialRow::new("q", "r", measure, 0.0);
    errors.iter().zip(0..).for_each(|(&error, trial)| row.see(error, trial, String::new));
    row
}

#[test]
fn the_worst_error_is_kept_and_nan_is_the_worst() {
    let mut all = row(Measure::Absolute, &[1e-12, 1e-10, 1e-11]);
    assert_eq!((all.worst, all.trial, all.trials), (1e-10, 1, 3));
    all.merge(row(Measure::Absolute, &[f64::NAN, 1.0]));
    assert!(all.worst.is_nan() && all.trial == 0 && all.trials == 5);
}

#[test]
fn wrong_answers_are_counted_and_the_first_is_kept() {
    let mut all = row(Measure::Count, &[0.0, 0.0, 1.0]);
    all.merge(row(Measure::Count, &[1.0, 1.0]));
    assert_eq!((all.worst, all.trial), (3.0, 2));
}

fn run(seed: u64) -> Vec<TrialRow> {
    let run = Run { effort: Effort::Full, seed };
    let rows = [TrialRow::relative("q", "r", 0.5), TrialRow::wrong("w", "r")];
    run.fill(
        [10, 1000],
        rows,
        || vec(between(0.0, 1.0), 1..4),
        |numbers, seen| {
            let largest = numbers.iter().copied().fold(0.0, f64::max);
            seen.at("largest");
            seen.see(0, if largest > 0.8 { 1.0 } else { 0.1 });
            seen.wrong(1, false);
            (largest > 0.05).then_some(())
        },
    )
}

#[test]
fn a_broken_bound_has_a_short_place() {
    let rows = run(1);
    assert!(!rows[0].holds() && rows[0].worst == 1.0 && rows[0].trials == 1000, "{rows:?}");
    // One number of one or two digits is enough.
    let place = rows[0].place.split_once("; shortened: ").expect("shortened");
    assert!(place.0.starts_with("largest, [") && place.1.len() < 8, "{place:?}");
    assert!(rows[1].holds() && rows[1].place.is_empty() && rows[1].skipped > 0, "{rows:?}");
}

#[test]
fn parameters_depend_on_the_seed() {
    assert!(run(1) == run(1) && run(1) != run(2));
}

/// r = 39.2: the fourth moment is e^647, of which e^{J₄} = e^717 is a factor that overflows.
#[test]
fn a_factor_that_overflows_does_not_hide_a_moment() {
    let [extinction, sampling, length] = [5.95e-10, 1.51725e-11, 2e7];
    let case = Case { extinction, control: 0.0, sampling, length, albedo: 0.5 };
    let rows = TrialRow::moments("products", "r = 39.2");
    let run = Run { effort: Effort::Quick, seed: 1 };
    let rows = run.fill([1, 1], rows, || Just(case), products);
    assert!(rows.iter().all(|row| row.holds() && row.skipped == 0), "{rows:#?}");
}

/// E[X⁴] is `e^{107}` times T⁴: steps that resolve E[X²] do not resolve it.
#[test]
fn a_steep_moment_is_resolved() {
    let (depth, ratio) = (8.940_790_550_262_802, 1.577_262_931_059_708_6);
    let (mesh, medium) = rod_of(depth, &[0.975_508_180_662_457_5], 1.0);
    let flown = Piecewise::constant(depth / ratio, mesh.support());
    let found = rod::predict(&mesh, &medium, &flown, ParticleRule::NonTerminating, true);
    let moments = found.channels[1].moments.expect("a variance");
    for (found, exact) in [0, 2]
        .map(|i| moments.relative[i])
        .iter()
        .zip([562_318_773.801_692, 1.830_027_460_650_75e47])
    {
        assert!((found / exact - 1.0).abs() < moments.error.min(1e-10), "{found:e} {moments:?}");
    }
}

#[test]
fn all_ways_together_are_as_many_as_choices_of_points() {
    for count in 1..9 {
        assert_eq!(of_mean(count, |_| 1.0), [1.0; 4], "{count} points");
    }
}

/// Two answers that happened to agree stated an error a hundred times too small.
#[test]
fn a_difference_of_two_would_break_the_row() {
    let width = 5.009_185_299_915_946e-1;
    let extinction = move |r2: f64| 4.491_279_127_719_145 * (-0.5 * r2 / (width * width)).exp();
    let centre = Centre::Black(0.152_548_266_190_216_4);
    let ball = Ball { radius: 1.0, centre, extinction: &extinction };
    let lights = Lights { environment: 0.0, core: 1.0 };
    let asked = [Observable::Radiance { offset: 0.624_808_847_846_952, from: f64::NEG_INFINITY }];
    let of = |resolution| {
        let found = answers(&ball, 0.392_282_540_822_851_2, lights, resolution, &asked);
        found.expect("a medium")[0]
    };
    let (found, exact) = (of(BallResolution::COARSE), DoubleDouble::from(of(FINER).value));
    assert!(of_stated(found, exact) <= 1.0, "{found:?}");
    let two = Known::new(found.value, 0.01 * found.error);
    assert!(of_stated(two, exact) > 1.0, "{found:?}");
}

#[test]
fn a_bias_counts_only_where_it_is_certain() {
    let point =
        BothPrecisions { x: 1.0, walks: 9.0, bias: -1e-4, error: 1e-5, noise: 5e-5, z: None };
    assert!(point.exceeds());
    assert!(!BothPrecisions { error: 3e-5, ..point }.exceeds());
    let (family, estimator) = ("Rod", "rod, analog");
    let curve = PrecisionCurve { family, estimator, along: Along::Steps, points: vec![point] };
    assert_eq!(curve.fails_from(), Some(1.0));
}

/// Decides among three events by one number, then by another one; far from 0, single precision takes 0.3 for 0.3125.
fn walk<N: Precision>(mut trail: &Trail) -> [bool; 2] {
    let share = Traced::<N>::of(1e6 + 0.3) - 1e6;
    let (u, scale): (Traced<N>, _) = (Random::uniform(&mut trail), Traced::of(7.0));
    let (is_first, is_second) = (u.below(share), u.below(share + share));
    let v: Traced<N> = Random::uniform(&mut trail);
    let is_real = v.times_plus(-scale, scale).at_most(share * scale);
    [is_second && !is_first, is_real]
}

#[test]
fn repeated_decisions_have_the_mean_of_walks_that_make_their_own() {
    let walks = 200_000;
    let (mut own, mut repeated, mut kept) = ([0.0; 2], 0.0, 0.0);
    for block in 0..walks {
        let stream = Address { seed: 1, experiment: 2, block, lane: 0 }.stream();
        let score = |ends: [bool; 2]| f64::from(u8::from(ends == [true, true]));
        let trail = Trail::new(stream, false);
        own[0] += score(walk::<f64>(&trail));
        assert_eq!((trail.likelihood(), trail.words()), (1.0, 2.0));
        let trail = trail.again(stream);
        repeated += score(walk::<F32>(&trail)) * trail.likelihood();
        own[1] += score(walk::<F32>(&Trail::new(stream, false)));
        let trail = Trail::new(stream, true);
        assert_eq!(walk::<F32>(&trail), [false, false]);
        kept += trail.likelihood();
    }
    // Four standard errors: √(0.1/200 000).
    let is_near = |sum: f64, mean: f64| (sum / walks as f64 - mean).abs() < 3e-3;
    assert!(is_near(own[0], 0.3 * 0.3), "{own:?}");
    assert!(is_near(own[1], 0.3125 * 0.3125) && is_near(repeated, 0.3125 * 0.3125));
    assert!((repeated - own[0]) / walks as f64 > 6e-3, "{own:?} {repeated}");
    assert!((kept / walks as f64 - (1.0 - 0.625) * (1.0 - 0.3125)).abs() < 1e-6, "{kept}");
}

#[test]
fn a_promise_is_broken_by_more_fails_than_chance_allows() {
    let of = |failed| StreamVerdicts {
        distribution: String::new(),
        known: String::new(),
        streams: 1000,
        passed: 1000 - failed,
        failed,
        inconclusive: 0,
        reason: String::new(),
    };
    // One is expected; P(12 or more) of a Poisson number of mean 1 is 8e-10, P(5 or more) 4e-3.
    assert!(of(0).is_kept() && of(4).is_kept());
    assert!(!of(12).is_kept() && !of(1000).is_kept());
}
