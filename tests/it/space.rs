//! Walks in space: exact answers against reference values that were computed by other means, skipped cells, and the
//! draws of every shipped case.

use crate::common::{case, options, shipped_record};
use serde::Deserialize;
use trueflight::estimators::DrawBuffer;
use trueflight::media::eq21::Eq21;
use trueflight::plan::Plan;
use trueflight::record::Verdict;
use trueflight::rng::{Address, Streams};
use trueflight::theory::space::content::content;
use trueflight::theory::space::infinite::{collisions_within, fluence};

#[derive(Deserialize)]
struct Reference {
    id: String,
    params: Params,
    value: Numbers,
}

#[derive(Deserialize)]
struct Params {
    c: Option<f64>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Numbers {
    One(f64),
    Many(Vec<f64>),
}

impl Reference {
    fn one(&self) -> f64 {
        match self.value {
            Numbers::One(value) => value,
            Numbers::Many(_) => panic!("{} is one number", self.id),
        }
    }

    fn many(&self) -> &[f64] {
        match &self.value {
            Numbers::Many(values) => values,
            Numbers::One(_) => panic!("{} is a list", self.id),
        }
    }
}

fn references(prefix: &str) -> Vec<Reference> {
    let all: Vec<Reference> =
        serde_json::from_str(include_str!("../data/space.json")).expect("the reference values");
    let found: Vec<Reference> =
        all.into_iter().filter(|reference| reference.id.starts_with(prefix)).collect();
    assert!(!found.is_empty(), "no {prefix}");
    found
}

#[test]
fn the_sphere_of_equation_21_has_the_content_of_the_reference() {
    let known = content(&Eq21).expect("bounded");
    let held = references("eq21/int_sigma_dV")[0].one();
    assert!((known.value / held - 1.0).abs() < 1e-13, "{known:?}");
    let surface = 400.0 * std::f64::consts::PI;
    let collisions = references("eq21/a=1 mean collisions")[0].one();
    assert!((4.0 * known.value / surface / collisions - 1.0).abs() < 1e-13);
    let path = references("eq21/mean path")[0].one();
    assert!((4.0 * 4000.0 * std::f64::consts::PI / 3.0 / surface - path).abs() < 1e-13);
}

#[test]
fn fluence_and_collisions_around_a_point_source_are_those_of_the_references() {
    for reference in references("inf/phi") {
        let albedo = reference.params.c.expect("an albedo");
        for (&value, distance) in reference.many().iter().zip([0.5, 1.0, 2.0, 5.0]) {
            let found = fluence(albedo, distance);
            let off = (found.value / value - 1.0).abs();
            assert!(off < 1e-13, "c = {albedo}, r = {distance}: off by {off:e}");
        }
    }
    let reference = &references("inf/collisions")[0];
    for (&value, distance) in reference.many().iter().zip([0.5, 1.0, 2.0, 4.0]) {
        let off = (collisions_within(0.9, distance).value / value - 1.0).abs();
        assert!(off < 1e-13, "R = {distance}: off by {off:e}");
    }
}

/// Returns draws of the first experiment of a case, and the final streams.
fn draws_of(text: &str, count: usize) -> (DrawBuffer, Streams, f64) {
    let cases = [case("space", text)];
    let plan = Plan::new(&cases, &options(1, 100));
    let ready = plan.cases[0].experiments[0].outcome.as_ref().expect("not refused");
    let mut streams = Address { seed: 1, experiment: 7, block: 0, lane: 0 }.streams();
    let mut buffer = DrawBuffer::new(ready.prediction.channels.len());
    ready.experiment.fill(&mut streams, count, &mut buffer);
    (buffer, streams, ready.experiment.skipped())
}

const RAY: &str = "ray = { origin = [0.5, 0.7, -1], direction = [0.1, 0.05, 1], length = 40 }";
const LAYERS: &str = "volume.piecewise-constant = { breaks = [0, 1, 3, 4], values = [0.8, 0, 1.5],
    bounds.box = { low = [0, 0, 0], high = [2, 2, 4] } }";

fn furnace(volume: &str, albedo: f64, phase: &str, estimator: &str) -> String {
    format!(
        "title = \"t\"\n[problem.furnace]\n{volume}\n{RAY}\nalbedo = {albedo}\nphase.{phase}\n\
         estimators = [{{ {estimator} }}]\n"
    )
}

#[test]
fn a_medium_that_only_absorbs_pays_for_transmittance_and_nothing_else() {
    let walk = "particle = { rule = \"non-terminating\", sampling.constant = { value = 1.2 } }";
    let volume = "volume.eq21 = {}";
    let (isotropic, after, _) = draws_of(&furnace(volume, 0.0, "isotropic = {}", walk), 4096);
    let forward = furnace(volume, 0.0, "henyey-greenstein = { g = 0.9 }", walk);
    let (other, same, _) = draws_of(&forward, 4096);
    assert_eq!((isotropic.values, &isotropic.lookups, after), (other.values, &other.lookups, same));
    // With one random number per flight, as in ratio tracking, the collisions are the same, draw by draw.
    let ratio = format!(
        "title = \"t\"\n[problem.transmittance]\n{volume}\n{RAY}\n\
         estimators = [{{ ratio = {{ sampling.constant = {{ value = 1.2 }} }} }}]\n"
    );
    let (tracked, ..) = draws_of(&ratio, 4096);
    assert_eq!(isotropic.lookups, tracked.lookups);
}

#[test]
fn empty_cells_cost_no_lookup() {
    let walk = |sampling: &str| {
        let particle = format!("particle = {{ rule = \"non-terminating\", sampling.{sampling} }}");
        draws_of(&furnace(LAYERS, 0.6, "isotropic = {}", &particle), 20_000)
    };
    let (whole, _, nothing) = walk("constant = { value = 1.5 }");
    let (cells, _, skipped) = walk("local-majorants = { grid = [1, 1, 8] }");
    assert_eq!((nothing, skipped), (0.0, 0.5));
    let sum = |draws: &DrawBuffer| draws.lookups.iter().map(|&n| f64::from(n)).sum::<f64>();
    assert!(sum(&cells) < 0.6 * sum(&whole), "{} of {}", sum(&cells), sum(&whole));
    // A path through empty cells only has no lookup at all.
    let volume = LAYERS.replace("[0.8, 0, 1.5]", "[0, 0, 0]");
    let walk = "particle = { rule = \"analog\", sampling.local-majorants = { grid = [2, 2, 2] } }";
    let (empty, ..) = draws_of(&furnace(&volume, 0.6, "isotropic = {}", walk), 100);
    assert_eq!((empty.lookups, &empty.values[0]), (vec![0; 100], &vec![1.0; 100]));
}

#[test]
fn means_of_all_shipped_cases_are_off_by_their_standard_errors() {
    let is_space = |name: &str| {
        ["furnace/", "lambertian/", "infinite-medium/"].iter().any(|start| name.starts_with(start))
    };
    let cases = shipped_record().results.cases.iter();
    let mut squares = Vec::new();
    for case in cases.filter(|case| is_space(&case.name)) {
        for row in case.rows() {
            // In units of their own standard errors: theory does not know most of these variances.
            let (Some(mean), Some(error), Some(truth)) = (row.mean, row.standard_error, row.truth)
            else {
                continue;
            };
            if error > 1e-9 * truth {
                squares.push(((mean - truth) / error).powi(2));
            }
        }
    }
    let n = squares.len() as f64;
    let mean = squares.iter().sum::<f64>() / n;
    println!("{n} channels, mean z² {mean:.3}");
    // χ² of n degrees by Wilson and Hilferty, 99.9 %. Channels of one experiment are correlated, so that the band is
    // that of half as many.
    let end = |z: f64| {
        let k = 0.5 * n;
        (1.0 - 2.0 / (9.0 * k) + z * (2.0 / (9.0 * k)).sqrt()).powi(3)
    };
    assert!(n > 100.0 && mean > end(-3.29) && mean < end(3.29), "mean z² of {n} is {mean}");
}

#[test]
fn rays_that_are_not_walked_need_not_be_given() {
    let forms = [
        (
            "infinite-medium",
            "volume.constant.extinction = 1.5\nalbedo = 0.9\nphase.isotropic = {}\nradii = [1, 2]",
            "ray = { origin = [3, 0, 0], direction = [0, 1, 0], length = 1 }",
            "",
        ),
        (
            "lambertian",
            "volume.eq21 = {}\nalbedo = 1\nphase.isotropic = {}",
            "ray = { origin = [0, 0, -5], direction = [0.1, 0.05, 1], length = 40 }",
            "",
        ),
        (
            "furnace",
            "volume.eq21 = {}\nalbedo = 0.7\nphase.isotropic = {}",
            "ray = { origin = [0, 0, -5], direction = [0.1, 0.05, 1], length = 40 }",
            "ray = { origin = [0, 0, -5], direction = [0.1, 0.05, 1] }",
        ),
        (
            "ball",
            "volume.radial = { centre = [0, 0, 0], radius = 1.5, coefficients = [2, -2] }\n\
             albedo = 0.9\nphase.isotropic = {}\nlight.environment = {}",
            "ray = { origin = [0.1, 0.2, -4], direction = [0, 0, 1], length = 6 }",
            "ray = { origin = [0.1, 0.2, -4], direction = [0, 0, 1] }",
        ),
    ];
    for (problem, scene, whole, part) in forms {
        let drawn = |ray: &str| {
            crate::common::rows(
                &format!(
                    "title = \"rays\"\n[problem.{problem}]\n{scene}\n{ray}\n\
                     sampling.constant.value = 2\nestimators = [{{ particle.rule = \"analog\" }}]"
                ),
                20_000,
            )
        };
        let (whole, part) = (drawn(whole), drawn(part));
        assert!(!whole.is_empty() && whole.len() == part.len(), "{problem}");
        for (a, b) in whole.iter().zip(&part) {
            assert_ne!(b.verdict, Some(Verdict::Refused), "{problem}: {}", b.reason());
            // The same to the bit: draws do not depend on the ray.
            let of = |row: &trueflight::record::Row| {
                (row.truth, row.mean, row.variance, row.experiment.lookups_per_draw)
            };
            assert_eq!(of(a), of(b), "{problem} {}", a.channel);
        }
    }
    // The length is required if it matters, and the ray if radiance is sought along it.
    let text = "title = \"rays\"\n[problem.transmittance]\nvolume.eq21 = {}\n\
                ray = { origin = [0, 0, 0], direction = [0, 0, 1] }\n\
                estimators = [{ closed-form = {} }]";
    let wrong = crate::common::mistakes(text).expect("a mistake").render(false);
    assert!(wrong.contains("`length` is missing"), "{wrong}");
    let text = "title = \"rays\"\n[problem.furnace]\nvolume.eq21 = {}\nalbedo = 1\n\
                phase.isotropic = {}\nsampling.constant.value = 1\n\
                estimators = [{ particle.rule = \"analog\" }]";
    let wrong = crate::common::mistakes(text).expect("a mistake").render(false);
    assert!(wrong.contains("`ray` is missing"), "{wrong}");
}
