//! A point from the light and delta tracking that share lookups: theory against values that were computed by other
//! means, and against draws.

use std::cell::RefCell;
use std::path::Path;

use serde::Deserialize;

use crate::common::{failing, medium, none, predicted, rows, source};
use trueflight::catalogue::Settings;
use trueflight::media::{Body, Control, Piecewise};
use trueflight::problems::{Problem, SingleScattering};
use trueflight::record::Row;
use trueflight::theory::Mesh;
use trueflight::theory::light::Heuristic;
use trueflight::theory::light::contour::Made;
use trueflight::theory::single::{
    Camera, CameraTracking, Collisions, Mis, NullPaths, RayScene, Tracking,
};

#[derive(Deserialize)]
struct Reference {
    case: String,
    what: String,
    value: Vec<f64>,
    error: f64,
}

fn references() -> Vec<Reference> {
    serde_json::from_str(include_str!("../data/equiangular.json")).expect("the reference values")
}

const CASES: [&str; 4] = ["EQ-A", "EQ-A3", "EQ-FAR", "EQ-2L"];

/// Returns the problem of a case, and σ̂ of both of its segments.
fn scene(case: &str) -> (&'static str, f64) {
    match case {
        "EQ-A" => (
            "volume.constant.extinction = 0.8
            ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 6 }
            light.position = [0.5, 0, 2.5]\nalbedo = 0.9",
            1.2,
        ),
        "EQ-A3" => (
            "volume.constant.extinction = 0.8
            ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 6 }
            light.position = [0.001, 0, 2.5]\nalbedo = 0.9",
            1.2,
        ),
        "EQ-FAR" => (
            "volume.constant.extinction = 1.5
            ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 4 }
            light.position = [3, 0, 2]\nalbedo = 0.9",
            2.0,
        ),
        "EQ-2L" => (
            "volume.piecewise-constant = { breaks = [0, 1.5, 5], values = [0.3, 1.6] }
            ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 5 }
            light.position = [0.4, 0, 2.2]\nalbedo = 0.8",
            2.0,
        ),
        other => panic!("{other}"),
    }
}

fn text(case: &str, estimators: &str) -> String {
    let (scene, sampling) = scene(case);
    let estimators = estimators.replace("RATIO", &format!("shadow.ratio.sampling = {sampling}"));
    format!(
        "title = \"{case}\"\n[problem.single-scattering]\n{scene}\nphase.isotropic = {{}}
        sampling.constant.value = {sampling}\nestimators = [{estimators}]"
    )
}

/// Returns the estimator of a reference value.
fn estimator(what: &str) -> Option<&'static str> {
    Some(match what {
        "dt+nee-ratio" => "{ delta-tracking = { absorption = \"analog\", RATIO } }",
        "dt-analytic" => "{ delta-tracking = { absorption = \"analog\" } }",
        "ea-ratio" => "{ source-driven = { camera = \"ratio\", RATIO } }",
        "ea-analytic" => "{ source-driven = {} }",
        "mis-two-sample" => {
            "{ source-delta-mis = { camera = \"ratio\", absorption = \"analog\", RATIO } }"
        }
        "mis-one-sample" => {
            "{ source-delta-mis = { camera = \"ratio\", absorption = \"analog\", samples = \"one\", RATIO } }"
        }
        "mis-analytic-two-sample" => "{ source-delta-mis = { absorption = \"analog\" } }",
        _ => return None,
    })
}

fn predict(case: &str, estimator: &str) -> Row<'static> {
    predicted(&text(case, estimator)).remove(0)
}

#[test]
fn means_and_variances_are_those_of_the_references() {
    let (mut seen, mut wrong) = (0, Vec::new());
    for reference in references() {
        let Reference { case, what, value, error } = &reference;
        let asked = if what == "mean" { Some("{ source-driven = {} }") } else { estimator(what) };
        let Some(asked) = asked else { continue };
        let row = predict(case, asked);
        let found = if what == "mean" { row.truth } else { row.predicted_variance };
        let found = found.unwrap_or(f64::NAN);
        let off = (found - value[0]).abs();
        println!("{case} {what}: {found:e}, {:.1e} of {:.1e}", off / found, error / found);
        if off > *error || off.is_nan() || !row.moments_error.is_some_and(|error| error < 1e-8) {
            wrong.push(format!(
                "{case}, {what}: {found:e} against {:e}, {:?}",
                value[0], row.moments_error
            ));
        }
        seen += 1;
    }
    none(&wrong);
    assert_eq!(seen, 4 * 8);
}

#[test]
fn lookups_are_those_of_the_references() {
    for reference in references().iter().filter(|reference| reference.what == "cost") {
        for (what, value) in ["dt+nee-ratio", "ea-ratio"].into_iter().zip(&reference.value) {
            let row = predict(&reference.case, estimator(what).expect("an estimator"));
            let found = row.experiment.predicted_lookups.expect("lookups");
            assert!((found - value).abs() < reference.error, "{}, {what}: {found}", reference.case);
        }
        // Both techniques in one draw, or one of them.
        let cost: f64 = reference.value.iter().sum();
        for (what, parts) in [("mis-two-sample", 1.0), ("mis-one-sample", 0.5)] {
            let row = predict(&reference.case, estimator(what).expect("an estimator"));
            let found = row.experiment.predicted_lookups.expect("lookups");
            let off = (found - parts * cost).abs();
            assert!(off < 2.0 * reference.error, "{}, {what}: {found}", reference.case);
        }
    }
}

fn problem(case: &str) -> SingleScattering {
    let faults = RefCell::default();
    let (scene, _) = scene(case);
    let root = source("scene", &format!("{scene}\nphase.isotropic = {{}}")).parse(&faults);
    let settings = Settings::new(&root, Path::new("tests/data"), &faults);
    let body = Body::read(&settings);
    let problem = SingleScattering::read(body.as_ref(), &settings);
    problem.unwrap_or_else(|| panic!("{case}: {:?}", faults.borrow()))
}

/// Returns the contributions of the point from the light and of delta tracking to a draw of both, with their errors.
fn shares(case: &str, heuristic: Heuristic) -> [[f64; 2]; 2] {
    let problem = problem(case);
    let mesh = Mesh::new(problem.medium().clone());
    let sampling = Piecewise::constant(scene(case).1, mesh.support());
    let camera = Camera::new(&mesh, &sampling, &Control::None, CameraTracking::Ratio);
    let scene = &RayScene::new(&problem, camera, Tracking::Exact);
    let medium = problem.medium();
    let collisions = Collisions { medium, sampling: &sampling, scatters: problem.albedo() };
    let nulls = Some(NullPaths::new(&mesh, &sampling, heuristic));
    let mis = Mis { scene, collisions, heuristic, nulls };
    mis.points().map(|points| [points.raw.0[0].value, points.raw.0[0].error])
}

#[test]
fn shares_are_those_of_the_references() {
    let all = references();
    for reference in all.iter().filter(|reference| reference.what == "mis-shares") {
        let [light, tracking] = shares(&reference.case, Heuristic::Balance);
        for ([found, error], value) in [tracking, light].into_iter().zip(&reference.value) {
            let off = (found - value).abs();
            assert!(off < reference.error, "{}: {found:e}, {off:e}", reference.case);
            assert!(error < 1e-10 * found, "{error:e}");
        }
    }
}

#[test]
fn shares_are_all_of_the_radiance() {
    for reference in references().iter().filter(|reference| reference.what == "mean") {
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            let [light, tracking] = shares(&reference.case, heuristic);
            let off = (light[0] + tracking[0]) / reference.value[0] - 1.0;
            assert!(off.abs() < 1e-11, "{}, {heuristic:?}: {off:e}", reference.case);
        }
    }
}

/// Returns `Σ Pois(i; a) Pois(j; b) f(u^i v^j)`: the mean of f(x) over the null collisions in two layers.
fn summed([a, b]: [f64; 2], [u, v]: [f64; 2], f: &dyn Fn(f64) -> f64) -> f64 {
    let chances = |mean: f64| {
        let next = move |&(n, p): &(i32, f64)| Some((n + 1, p * mean / f64::from(n + 1)));
        std::iter::successors(Some((0, (-mean).exp())), next).take(60)
    };
    let first = |(i, p)| chances(b).map(|(j, q)| p * q * f(u.powi(i) * v.powi(j))).sum::<f64>();
    chances(a).map(first).sum()
}

#[test]
fn weights_of_null_paths_are_poisson_sums() {
    // ∫σ̂ = 1.8 where 7/10 are kept and 2.2 where 1/5 is; at σ̂ = σ_t nothing is kept.
    for kept in [0.2, 0.0] {
        let (low, high) = (0.6, 2.0 * (1.0 - kept));
        let text = format!(
            "medium.piecewise-constant = {{ breaks = [0, 0.9, 2], values = [{low}, {high}] }}\nspan = [0, 2]"
        );
        let mesh = Mesh::new(medium(&text));
        let sampling = Piecewise::constant(2.0, mesh.support());
        for (heuristic, beta) in [(Heuristic::Balance, 1), (Heuristic::Power, 2)] {
            let paths = NullPaths::new(&mesh, &sampling, heuristic);
            for ratio in [1e-6, 0.01, 0.7, 1.0, 4.0, 1e3] {
                for (made, by, m) in [(Made::ByCollision, 1, beta), (Made::ByPoint, 0, 1)] {
                    let [powers, errors] = paths.weights(made, 2.0, ratio);
                    for k in 1..5 {
                        let exact = summed([1.8, 2.2], [0.7, kept], &|x| {
                            let r = ratio * x;
                            x.powi(by) * (r.powi(m) / (1.0 + r.powi(beta))).powi(k)
                        });
                        let k = usize::try_from(k).expect("small");
                        let off = (powers[k - 1] - exact).abs();
                        let place = format!(
                            "{kept} {heuristic:?} {made:?} {ratio}, {k}: {exact:e}, {off:e}"
                        );
                        assert!(
                            off <= errors[k - 1] + 1e-13 * exact,
                            "{place}, {:e}",
                            errors[k - 1]
                        );
                        assert!(ratio > 1e2 || k > 2 || errors[k - 1] < 1e-8 * exact, "{place}");
                    }
                }
            }
        }
    }
}

#[test]
fn weights_of_null_paths_share_all_of_what_varies() {
    // E[x r^β/(1 + r^β)] + E[r/(1 + r^β)]/R = E[x] = T.
    let mesh = Mesh::new(medium(
        "medium.gaussian = { peak = 1.5, centre = 1, width = 0.6 }\nspan = [0, 3]",
    ));
    let sampling = Piecewise::steps(&[0.0, 1.4, 3.0], &[1.5, 1.8]);
    for heuristic in [Heuristic::Balance, Heuristic::Power] {
        let paths = NullPaths::new(&mesh, &sampling, heuristic);
        for (s, ratio) in [(0.3, 0.2), (1.0, 3.0), (2.2, 0.9), (3.0, 8.0)] {
            let before = trueflight::numeric::Span::new(0.0, s);
            let transmittance = (-mesh.medium().optical_depth(before).value).exp();
            let [a, b] =
                [Made::ByCollision, Made::ByPoint].map(|made| paths.weights(made, s, ratio));
            let [[a, of_a], [b, of_b]] = [a, b].map(|moments| moments.map(|row| row[0]));
            let off = a + b / ratio - transmittance;
            let allowed = of_a + of_b / ratio;
            assert!(off.abs() <= allowed && allowed < 1e-11, "{s}: {off:e}, {allowed:e}");
        }
    }
}

/// All techniques that share lookups, in a medium of two layers and in one that varies.
const SHARING: &str = "{ delta-tracking = { absorption = \"analog\", RATIO } },
    { source-delta-mis = { camera = \"ratio\", RATIO } },
    { source-delta-mis = { camera = \"ratio\", absorption = \"analog\", heuristic = \"power\", RATIO } },
    { source-delta-mis = { camera = \"ratio\", absorption = \"analog\", samples = \"one\" } },
    { source-delta-mis = { camera = \"ratio\", samples = \"one\", heuristic = \"power\" } },
    { source-delta-mis = { absorption = \"analog\", samples = \"one\", RATIO } },
    { source-delta-mis = { heuristic = \"power\" } }";

fn draws_agree(draws: u64) {
    let mut wrong = Vec::new();
    for case in CASES.into_iter().filter(|case| *case != "EQ-A3") {
        let rows = rows(&text(case, SHARING), draws);
        assert_eq!(rows.len(), 7);
        wrong.extend(failing(&rows));
    }
    let varying = "title = \"t\"\n[problem.single-scattering]\nvolume.eq21 = {}
        ray = { origin = [0, 0, -5], direction = [0, 0, 1], length = 30 }
        light.position = [1.2, -0.8, 9.3]\nalbedo = 0.7\nphase.henyey-greenstein.g = 0.4
        sampling.piecewise-constant = { breaks = [-5, 9, 30], values = [1, 1.3] }";
    let sharing = SHARING.replace("RATIO", "shadow.delta.sampling = 1");
    wrong.extend(failing(&rows(&format!("{varying}\nestimators = [{sharing}]"), draws)));
    none(&wrong);
}

#[test]
fn draws_agree_with_the_predictions() {
    draws_agree(700_000);
}

#[test]
#[ignore = "long: 4e6 draws of 28 experiments"]
fn many_draws_agree_with_the_predictions() {
    draws_agree(4_000_000);
}
