//! Media that a program defines: of one coordinate by four functions, and in space by a closure.

use trueflight::OfCase;
use trueflight::case::Case;
use trueflight::case::CaseText;
use trueflight::catalogue::{Domain, OwnPage, Page, Settings};
use trueflight::geometry::{Aabb, Bounds, Point};
use trueflight::judge::ExperimentChoice;
use trueflight::media::Stratified;
use trueflight::media::own::SpaceFormula;
use trueflight::numeric::{Known, Lane, Span};
use trueflight::{Catalogue, check};

const CASE: &str = r#"
title = "Haze: all estimators that need no more than σ_t"
[problem.transmittance]
medium.haze = { scale = 2 }
span = [0, 5]
estimators = [{ woodcock = {} }, { ratio = {} }, { regular = {} }]
sampling.constant.value = 1.0
"#;

/// Haze that thins out: `σ_t(x) = 1/(1 + (x/scale)²)`.
#[derive(Clone)]
pub struct Haze {
    scale: f64,
}

impl Stratified for Haze {
    fn read(settings: &Settings) -> Option<Self> {
        settings.number("scale", Domain::Positive).map(|scale| Self { scale })
    }

    fn value<L: Lane>(&self, x: L) -> L {
        let u = x * (1.0 / self.scale);
        x.each(1.0) / (u * u + 1.0)
    }

    fn integral(&self, x: Span) -> Known {
        let [from, to] = [x.from, x.to].map(|x| (x / self.scale).atan());
        Known::new(self.scale * (to - from), self.scale * 1e-15)
    }

    fn highest(&self, x: Span) -> f64 {
        self.value(0.0_f64.max(x.from).min(x.to)) * (1.0 + 1e-12)
    }
}

/// Checks an estimator in a medium that Trueflight does not have.
pub fn main() {
    let haze = Page { module: "haze", source: "Haze that thins out: σ_t = 1/(1 + (t/scale)²)." };
    let cube = Page { module: "cube", source: "A cube that is densest in one corner." };
    let unit = Bounds::Box(Aabb { low: Point([0.0; 3]), high: Point([1.0; 3]) });
    let corner = move |_: &Settings| Some(SpaceFormula::new(unit, 3.0, |[x, y, z]| x + y + z));
    let catalogue = Catalogue::builtin()
        .with(OwnPage::layered::<Haze>(haze))
        .and_then(|catalogue| catalogue.with(OwnPage::volume(cube, &[], corner)))
        .expect("names that are free");
    let source = CaseText { name: "haze".into(), path: "haze.toml".into(), text: CASE.into() };
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
    let ratio = ExperimentChoice { estimator: "ratio", ..ExperimentChoice::default() };
    let found = check("ratio tracking in haze", tracking).of_case(&case, &ratio).verdict();
    let found = found.unwrap_or_else(|error| panic!("{error}"));
    println!("{found}");
    found.assert_pass();
}
