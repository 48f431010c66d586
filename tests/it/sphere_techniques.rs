//! Hits, shadow rays and connections in a ball: their sum is the exact answer, for any weights.

use std::cell::RefCell;
use std::path::Path;
use std::sync::LazyLock;

use crate::common::{case, none, options, predicted, rows, rows_of, source};
use trueflight::catalogue::Settings;
use trueflight::draw::run;
use trueflight::estimators::DrawBuffer;
use trueflight::estimators::space::ParticleSettings;
use trueflight::estimators::sphere::sharing::{SharedTechniques, Subpaths, WalkEvents};
use trueflight::estimators::sphere::{Correct, Method};
use trueflight::media::{Body, Majorants};
use trueflight::numeric::Lane;
use trueflight::plan::{Plan, PlannedExperiment};
use trueflight::problems::{Problem, Sphere};
use trueflight::record::{Row, Verdict, build};
use trueflight::rng::Address;
use trueflight::theory::light::Heuristic;
use trueflight::theory::space::sphere::Techniques;
use trueflight::theory::{Channel, ParticleRule};

/// Every page with its settings; σ̂ of shadow rays is a majorant of both balls.
const ALL: &str = "
    { directional-mis = { rule = \"analog\", shadow.delta = { sampling = 2 } } },
    { directional-mis = { rule = \"weighted\", roulette = 0.3, shadow.ratio = { sampling = 2.2 } } },
    { directional-mis = { rule = \"analog\", heuristic = \"power\" } },
    { full-mis.rule = \"analog\" }, { full-mis.rule = \"adaptive\" },
    { full-mis = { rule = \"weighted\", heuristic = \"power\" } },
    { full-mis = { rule = \"non-terminating\", shadow = \"exact\" } },
    { full-mis = { rule = \"terminating\", sampling.local-majorants.grid = [3, 4, 5] } },
    { bidirectional = {} }, { bidirectional.heuristic = \"power\" },
    { bidirectional.subpaths = \"shared\" },
    { bidirectional = { heuristic = \"power\", subpaths = \"shared\" } },
    { bidirectional.sampling.local-majorants.grid = [4, 4, 4] }";

const HOMOGENEOUS: &str =
    "volume.constant = { extinction = 1, bounds.sphere = { centre = [1, -1, 2], radius = 1.5 } }";
const THINNING: &str =
    "volume.radial = { centre = [1, -1, 2], radius = 1.5, coefficients = [2, -2] }";
const SKY: &str = "albedo = 0.9\nlight.environment = {}";
const LAMP: &str = "albedo = 0.8\nlight.black-sphere = { radius = 0.4 }";
const SEEN: &str = "ray = { origin = [1.25, -1, -2], direction = [0, 0, 1], length = 9 }";
const BESIDE: &str = "ray = { origin = [1.6, -1, -2], direction = [0, 0, 1], length = 9 }";
const INSIDE: &str = "ray = { origin = [1.6, -1, 2], direction = [0, 0, 1], length = 9 }\n\
                      sought = \"mean-intensity\"";

/// Balls, lights and rays.
const SCENES: [[&str; 3]; 6] = [
    [HOMOGENEOUS, SKY, SEEN],
    [THINNING, SKY, BESIDE],
    [THINNING, SKY, INSIDE],
    [THINNING, LAMP, SEEN],
    [HOMOGENEOUS, LAMP, BESIDE],
    [THINNING, LAMP, INSIDE],
];

/// Returns a case with σ̂ = 2.5 for its walks.
fn text([volume, light, ray]: [&str; 3], estimators: &str) -> String {
    format!(
        "title = \"techniques\"\n[problem.ball]\n{volume}\n{light}\n{ray}\nphase.isotropic = {{}}\n\
         sampling.constant.value = 2.5\nestimators = [{estimators}]"
    )
}

/// Returns the distance of the mean from the exact answer, in standard errors of the draws.
fn z(row: &Row) -> f64 {
    let error = row.standard_error.expect("drawn");
    (row.mean.expect("drawn") - row.truth.expect("known")) / error
}

/// Draws all pages in some scenes; returns the faults, and z² of the means.
fn drawn(scenes: &[[&str; 3]], draws: u64) -> (Vec<String>, Vec<f64>) {
    judge(scenes.iter().flat_map(|&scene| {
        let rows = rows(&text(scene, ALL), draws);
        rows.into_iter().map(move |row| (scene, row))
    }))
}

/// Returns the faults of some rows, and z² of the means.
fn judge<'a>(rows: impl Iterator<Item = ([&'a str; 3], Row<'a>)>) -> (Vec<String>, Vec<f64>) {
    let (mut wrong, mut squares) = (Vec::new(), Vec::new());
    for (scene, row) in rows {
        let z = z(&row);
        let is_wrong = matches!(row.verdict, Some(Verdict::Fail | Verdict::Refused) | None);
        if is_wrong || z.abs() > 4.5 {
            wrong.push(format!("{scene:?} {}: z = {z:.2}, {}", row.experiment.label, row.reason()));
        }
        squares.push(z * z);
    }
    (wrong, squares)
}

/// Row of a scene with its prediction.
type Known = ([&'static str; 3], Row<'static>, Channel);

/// Draws of all pages in all scenes, 100,000 each, made once.
static DRAWN: LazyLock<Vec<Known>> = LazyLock::new(|| {
    let of = |scene: [&'static str; 3]| {
        let case = [case("bounds", &text(scene, ALL))];
        let plan = Plan::new(&case, &options(1, 100_000));
        let record = build::judged(&plan, &run::draw(&plan, &|_| {}), 0.0);
        let rows = rows_of(record);
        let channel = |planned: &PlannedExperiment| {
            let ready = planned.outcome.as_ref().unwrap_or_else(|r| panic!("{r}"));
            ready.prediction.channels[0].clone()
        };
        let channels = plan.experiments().map(|(_, planned)| channel(planned));
        let both = rows.into_iter().zip(channels);
        both.map(move |(row, channel)| (scene, row, channel)).collect::<Vec<_>>()
    };
    SCENES.into_iter().flat_map(of).collect()
});

#[test]
fn all_combinations_meet_the_exact_answer() {
    let (wrong, squares) = judge(DRAWN.iter().map(|(scene, row, _)| (*scene, *row)));
    none(&wrong);
    assert_eq!(squares.len(), 78);
}

#[test]
#[ignore = "long: 78 experiments of 4e6 draws, 4 minutes of two cores"]
fn all_combinations_meet_the_exact_answer_closely() {
    let (wrong, squares) = drawn(&SCENES, 4_000_000);
    none(&wrong);
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    println!("mean z² of {} means: {mean:.3}", squares.len());
    // 78 independent values: a standard deviation of 0.16.
    assert!((mean - 1.0).abs() < 0.8, "{mean}");
}

/// Predicted bounds hold; for walks of weight 0 or 1 with densities of directions the bound is the variance.
#[test]
fn bounds_on_variances_hold() {
    let mut bounded = 0;
    for (scene, row, channel) in DRAWN.iter() {
        let Some(most) = channel.variance_bound else {
            assert!(channel.pilot_variance_allowed && row.experiment.label.contains("shared"));
            continue;
        };
        bounded += 1;
        let ratio = row.variance.expect("drawn") / most;
        let name = format!("{scene:?} {}: {ratio:.3}", row.experiment.label);
        assert!(ratio < 1.03, "{name}");
        if row.experiment.label.contains("delta") {
            assert!(ratio > 0.97, "{name}");
        }
        assert!(ratio > 0.1, "{name}");
    }
    assert_eq!(bounded, 6 * 11);
}

/// Returns the sphere of a scene, and σ̂ for it.
fn sphere(scene: [&str; 3]) -> (Sphere, Majorants) {
    let faults = RefCell::default();
    let body = format!("{}\nphase.isotropic = {{}}", scene.join("\n"));
    let root = source("sphere", &body).parse(&faults);
    let settings = Settings::new(&root, Path::new("tests/data"), &faults);
    let sphere = Sphere::read(Body::read(&settings).as_ref(), &settings);
    let sphere = sphere.unwrap_or_else(|| panic!("{:?}", faults.borrow()));
    let majorants = Majorants::constant(2.5, &*sphere.scene.volume);
    (sphere, majorants)
}

/// Technique that alone counts, with its weight beside the others.
#[derive(Clone, Copy)]
struct Only(usize);

impl WalkEvents for Only {
    fn weight<L: Lane, const N: usize>(
        &self,
        heuristic: Heuristic,
        own: usize,
        densities: [L; N],
    ) -> L {
        let right = heuristic.weight(own, densities);
        if own == self.0 { right } else { right.each(0.0) }
    }

    fn unscattered(&self) -> f64 {
        f64::from(u8::from(self.0 == 0))
    }
}

/// Shares of hits, shadow rays and connections add up, draw by draw, and to the exact answer on average.
#[test]
fn shares_of_techniques_add_up() {
    for heuristic in [Heuristic::Balance, Heuristic::Power] {
        for subpaths in [Subpaths::Independent, Subpaths::Shared] {
            let techniques = Techniques::Bidirectional(heuristic);
            let sharing = SharedTechniques { techniques, shadow: None, subpaths: Some(subpaths) };
            let page = Method { particle: ParticleSettings::of(ParticleRule::Analog), sharing };
            for scene in [SCENES[1], SCENES[3]] {
                let (sphere, majorants) = sphere(scene);
                let row = &predicted(&text(scene, "{ bidirectional = {} }"))[0];
                let truth = row.truth.expect("known");
                let mut rng = Address { seed: 1, experiment: 2, block: 3, lane: 0 }.stream();
                let (draws, mut sums, mut square) = (15_000, [0.0; 3], 0.0);
                for _ in 0..draws {
                    let begin = rng;
                    let at = (&sphere, &majorants);
                    let whole = page.draw(Correct, at, &mut rng).value[0];
                    let shares: [f64; 3] = std::array::from_fn(|own| {
                        page.draw(Only(own), at, &mut begin.clone()).value[0]
                    });
                    assert!((shares.iter().sum::<f64>() - whole).abs() < 1e-12);
                    sums.iter_mut().zip(shares).for_each(|(sum, share)| *sum += share);
                    square += whole * whole;
                }
                let shares = sums.map(|sum| sum / f64::from(draws));
                let found: f64 = shares.iter().sum();
                let error = ((square / f64::from(draws) - found * found) / f64::from(draws)).sqrt();
                let name = format!("{heuristic:?} {subpaths:?} {scene:?} {shares:?}");
                assert!((found - truth).abs() < 4.5 * error, "{name}: {found} {truth}");
                assert!(shares.iter().all(|&share| share > 0.01 * truth), "{name}");
            }
        }
    }
}

/// Without null collisions densities of directions are complete.
#[test]
fn directional_and_full_are_the_same_where_nothing_is_null() {
    for light in [SKY, LAMP] {
        for heuristic in ["balance", "power"] {
            let text = format!(
                "title = \"s\"\n[problem.ball]\n{HOMOGENEOUS}\n{light}\n{BESIDE}\n\
                 phase.isotropic = {{}}\nsampling.constant.value = 1\nestimators = [\
                 {{ directional-mis = {{ rule = \"analog\", heuristic = \"{heuristic}\", \
                 shadow.ratio = {{ sampling = 1 }} }} }}, \
                 {{ full-mis = {{ rule = \"analog\", heuristic = \"{heuristic}\" }} }}]"
            );
            let case = [case("same", &text)];
            let plan = Plan::new(&case, &options(1, 1000));
            let planned: Vec<_> = plan.experiments().map(|(_, planned)| planned).collect();
            let values = [0, 1].map(|i| {
                let ready = planned[i].outcome.as_ref().unwrap_or_else(|r| panic!("{r}"));
                let mut buffer = DrawBuffer::new(1);
                ready.experiment.fill(&mut planned[0].streams(0), 5000, &mut buffer);
                buffer.values.remove(0)
            });
            let most = values[0].iter().zip(&values[1]).map(|(x, y)| (x - y).abs());
            assert!(most.fold(0.0, f64::max) < 1e-9, "{light} {heuristic}");
            assert!(values[0].iter().any(|&x| x > 0.0 && x < 1.0));
        }
    }
}

/// No direction hits a distant light: its shadow rays have weight 1, and vertices of its light are connected.
#[test]
fn a_distant_light_is_found_by_all_but_hits() {
    let centre = "ray = { origin = [1, -1, 2], direction = [1, 0, 0], length = 1 }\n\
                  sought = \"mean-intensity\"";
    let light = "albedo = 0.9\nlight.distant = { direction = [1, -2, 2] }";
    let (wrong, _) = drawn(&[[THINNING, light, centre]], 60_000);
    none(&wrong);
}
