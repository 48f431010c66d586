//! Values of a swept quantity: any value for which theory has an answer.

use super::{Place, raw, uniform};
use trueflight::OfCase;

/// Case with σ̂ from 0.5 to 4 in seven steps of a factor, and estimators with σ̂ of their own.
const SWEPT: &str = "title = \"a sweep\"
[problem.transmittance]
medium.constant.extinction = 0.5
span = [0, 2]
sweep.sampling = { from = 0.5, to = 4, points = 8, scale = \"log\" }
estimators = [{ ratio = {} }, { woodcock = {} }, { closed-form = {} }]
";
const MANY: &str = "points = 30";

/// Case with explorer points of a control: whole numbers from 2.
const POINTS: &str = "title = \"explorers\"
[problem.transmittance]
medium.constant.extinction = 0.5
span = [0, 2]
sampling.constant.value = 1
control.explorers.points = 4
sweep.points.values = [2, 4, 8]
estimators = [{ double = {} }, { ratio = {} }]
";

/// Returns draws of ratio tracking of σ_t = 0.5 on [0, 2] by σ̂: (1 − 0.5/σ̂)^N, N Poisson distributed of mean 2σ̂.
fn ratio(sampling: f64, n: usize) -> Vec<f64> {
    let mut rng = trueflight::rng::Address { seed: 8, experiment: 8, block: 0, lane: 0 }.stream();
    let draw = |_| {
        let (mut weight, mut t) = (1.0, -rng.positive_uniform().ln() / sampling);
        while t < 2.0 {
            weight *= 1.0 - 0.5 / sampling;
            t -= rng.positive_uniform().ln() / sampling;
        }
        weight
    };
    (0..n).map(draw).collect()
}

fn place() -> Place {
    Place::new(&[
        ("swept.toml", SWEPT.as_bytes()),
        ("many.toml", SWEPT.replace("points = 8", MANY).as_bytes()),
        ("points.toml", POINTS.as_bytes()),
        ("x.f64", &raw(&ratio(0.7, 200_000))),
        ("u.f64", &raw(&uniform(1000))),
    ])
}

#[test]
fn any_sampling_extinction_is_taken_as_it_is() {
    let place = place();
    let judge = "--case swept.toml --estimator ratio --tolerance 0.05 --variance-tolerance 0.1";
    place.expect(0, &format!("{judge} --swept 0.7 x.f64"), &["pass", "sampling = 0.7"]);
    let found = place.json(&format!("{judge} --swept 0.7 x.f64"), &[]);
    assert_eq!(found["theory"], "`ratio` of swept, sampling = 0.7");
    // T²(e^{2·0.25/σ̂} − 1), by hand.
    let variance = (-2f64).exp() * ((0.5f64 / 0.7).exp() - 1.0);
    let predicted = found["predicted_variance"].as_f64().expect("a variance");
    assert!((predicted / variance - 1.0).abs() < 1e-12, "{predicted}");
    // The nearest value of the sweep has another variance.
    let nearest = format!("{judge} --swept 0.7 --nearest x.f64");
    place.expect(1, &nearest, &["the variance", "nearest to 0.7"]);
    let found = place.json(&nearest, &[]);
    assert_eq!(
        found["theory"],
        "`ratio` of swept, sampling = 0.672950096, the value of the sweep nearest to 0.7"
    );
}

#[test]
fn what_cannot_be_is_refused_with_the_nearest_value() {
    let place = place();
    for (arguments, words) in [
        // Values are listed as in tables, some of many.
        ("--case swept.toml --estimator ratio", &["0.5, 0.673, 0.9057", "--swept"][..]),
        ("--case many.toml --estimator ratio", &["0.5, ", "…, 4 (30 values)"]),
        // σ̂ below σ_t is refused, but the nearest value of the sweep is not.
        (
            "--case swept.toml --estimator woodcock --swept 0.4",
            &["nearest value of the sweep is 0.5"],
        ),
        (
            "--case points.toml --estimator double --swept 5.4",
            &["is not a whole number from 2", "nearest value of the sweep is 4"],
        ),
        (
            "--case points.toml --estimator double --swept 1",
            &["is not a whole number from 2", "sweep is 2"],
        ),
        ("--case swept.toml --estimator ratio --swept 0", &["is not a finite number above 0"]),
        ("--case swept.toml --estimator ratio --swept -1", &["is not a finite number above 0"]),
        ("--case swept.toml --estimator closed-form --swept 1", &["is not swept"]),
        ("--case swept.toml --estimator closed-form --swept 1 --nearest", &["is not swept"]),
        // A number of points is not a σ̂ of an estimator without σ̂.
        ("--case points.toml --estimator ratio --swept 4", &["is not swept"]),
        ("--case swept.toml --estimator ratio --nearest", &["--swept"]),
        ("--truth 1 --nearest", &["--swept"]),
    ] {
        place.expect(2, &format!("{arguments} u.f64"), words);
    }
    // Any number of points, not only those of the sweep; the nearest for a number that is not whole.
    for more in ["--swept 5", "--swept 5.4 --nearest", "--swept 4"] {
        let arguments = format!("--case points.toml --estimator double {more} u.f64");
        let (code, text) = place.says(&arguments, &[]);
        assert_ne!(code, 2, "{arguments}: {text}");
        assert!(text.contains("points = "), "{text}");
    }
}

#[test]
fn checks_in_memory_say_the_same() {
    let place = place();
    let path = place.path().join("swept.toml").display().to_string();
    let draws = ratio(0.7, 200_000);
    let claim = |swept: Option<f64>| {
        let check = trueflight::claim("x").of(&path, "ratio", swept);
        check.tolerance(0.05).variance_tolerance(0.1).judge(&draws)
    };
    let outcome = claim(Some(0.7)).expect("a verdict");
    assert!(outcome.passed(), "{outcome}");
    assert!(outcome.to_string().contains("sampling = 0.7"), "{outcome}");
    let error = claim(None).expect_err("a value is missing").to_string();
    assert!(error.contains("0.5, 0.673, 0.9057") && error.contains("sampling="), "{error}");
    assert!(claim(Some(-1.0)).is_err());
}
