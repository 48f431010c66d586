//! Medium that a program defines by closures: along a line, and in space.

use trueflight::OfCase;
use trueflight::case::Case;
use trueflight::case::Source;
use trueflight::catalogue::{Addition, Page, Settings};
use trueflight::geometry::{Aabb, Bounds, Point};
use trueflight::judge::Choice;
use trueflight::media::own::{Formula, SpaceFormula};
use trueflight::{Catalogue, check};

const CASE: &str = r#"
title = "Haze: all estimators that need no more than σ_t"
[problem.transmittance]
medium.haze = { scale = 2 }
span = [0, 5]
estimators = [{ woodcock = {} }, { ratio = {} }, { regular = {} }]
sampling.constant.value = 1.0
"#;

/// Checks an estimator in a medium that Trueflight does not have.
pub fn main() {
    let haze = Page { module: "haze", source: "Haze that thins out: σ_t = 1/(1 + (t/scale)²)." };
    let read = |settings: &Settings| {
        let scale = settings.number("scale", trueflight::catalogue::Domain::Positive)?;
        Some(Formula::new(move |t: f64| 1.0 / (1.0 + (t / scale).powi(2))))
    };
    let cube = Page { module: "cube", source: "A cube that is densest in one corner." };
    let unit = Bounds::Box(Aabb { low: Point([0.0; 3]), high: Point([1.0; 3]) });
    let corner = move |_: &Settings| Some(SpaceFormula::new(unit, 3.0, |[x, y, z]| x + y + z));
    let catalogue = Catalogue::builtin()
        .with(Addition::line(haze, &[], read))
        .and_then(|catalogue| catalogue.with(Addition::volume(cube, &[], corner)))
        .expect("names that are free");
    let source = Source { name: "haze".into(), path: "haze.toml".into(), text: CASE.into() };
    let case: Case = catalogue.read(&source).unwrap_or_else(|error| panic!("{}", error.in_full()));
    // Ratio tracking through the haze at σ̂ = 1, as in a renderer; theory knows its variance.
    let tracking = |rng: &mut trueflight::rng::Stream| {
        let (mut weight, mut t) = (1.0, 0.0);
        loop {
            t -= rng.positive_uniform().ln();
            if t > 5.0 {
                return weight;
            }
            weight *= 1.0 - 1.0 / (1.0 + (t / 2.0_f64).powi(2));
        }
    };
    let ratio = Choice { estimator: "ratio", ..Choice::default() };
    let found = check("ratio tracking in haze", tracking).of_case(&case, &ratio).verdict();
    let found = found.unwrap_or_else(|error| panic!("{error}"));
    println!("{found}");
    found.assert_pass();
}
