//! Balls against reference values that were computed by other means: escape probabilities, radiances
//! under an environment, a black light sphere and a point source, and draws of all of them.

use serde::Deserialize;

use trueflight::theory::sphere::ball::Ball;
use trueflight::theory::sphere::shells::{Centre, Resolution};
use trueflight::theory::sphere::{Asked, Lights, answers, point};

#[derive(Deserialize)]
struct Reference {
    ball: String,
    a: f64,
    light: String,
    at: Vec<f64>,
    value: Vec<f64>,
}

const RADIUS: f64 = 1.5;
/// Half a unit of the last of thirteen decimals, and the rounding of the program that made them.
const PRINTED: f64 = 6e-13;

fn references(light: &str) -> Vec<Reference> {
    let all: Vec<Reference> =
        serde_json::from_str(include_str!("data/spheres.json")).expect("the reference values");
    let found: Vec<Reference> = all.into_iter().filter(|r| r.light == light).collect();
    assert!(found.len() >= 2);
    found
}

/// σ_t as a function of r².
fn extinction(reference: &Reference) -> fn(f64) -> f64 {
    match reference.ball.as_str() {
        "S1" => |_| 1.0,
        _ => |r2| 2.0 * (1.0 - r2 / (RADIUS * RADIUS)),
    }
}

fn compare(light: &str, centre: Centre, lights: Lights, asked: fn(f64) -> Asked) {
    for reference in references(light) {
        let extinction = extinction(&reference);
        let ball = Ball { radius: RADIUS, centre, extinction: &extinction };
        let asked: Vec<Asked> = reference.at.iter().map(|&at| asked(at)).collect();
        let precise = |resolution, allowed: f64| {
            let found = answers(&ball, reference.a, lights, resolution, &asked).expect("a medium");
            for (known, exact) in found.iter().zip(&reference.value) {
                let off = (known.value - exact).abs();
                assert!(off <= known.error + PRINTED, "{light} {}: {off:e}", reference.ball);
                assert!(known.error <= allowed, "{light} {}: {known:?}", reference.ball);
            }
            found
        };
        let fine = precise(Resolution::FINE, 1e-10);
        for (known, exact) in fine.iter().zip(&reference.value) {
            let off = (known.value - exact).abs();
            assert!(off < 3e-12, "{light} {}: off by {off:e}", reference.ball);
        }
        precise(Resolution::COARSE, 1e-7);
    }
}

const SKY: Lights = Lights { environment: 1.0, core: 0.0 };

fn from_afar(offset: f64) -> Asked {
    Asked::Radiance { offset, from: f64::NEG_INFINITY }
}

#[test]
fn escape_probabilities_are_those_of_the_references() {
    compare("escape", Centre::Medium, SKY, Asked::Mean);
}

#[test]
fn radiances_in_an_environment_are_those_of_the_references() {
    compare("environment", Centre::Medium, SKY, from_afar);
}

#[test]
fn radiances_of_a_black_light_sphere_are_those_of_the_references() {
    let lamp = Lights { environment: 0.0, core: 1.0 };
    compare("black", Centre::Black(0.3), lamp, from_afar);
}

#[test]
fn a_point_source_is_that_of_the_references_order_by_order() {
    for ball in ["S1", "S2"] {
        let mut references = references("point");
        references.retain(|reference| reference.ball == ball);
        assert_eq!(references.len(), 3);
        let offsets: Vec<f64> = references.iter().map(|reference| reference.at[0]).collect();
        let extinction = extinction(&references[0]);
        let space = Ball { radius: RADIUS, centre: Centre::Medium, extinction: &extinction };
        let found = point::orders(&space, references[0].a, &offsets, 3, Resolution::FINE);
        for (found, reference) in found.expect("a medium").iter().zip(&references) {
            assert_eq!(found.len(), 4);
            for (known, exact) in found.iter().zip(&reference.value) {
                let off = (known.value - exact).abs();
                assert!(off < 3e-12 && off <= known.error + PRINTED, "{ball}: off by {off:e}");
                assert!(known.error <= 1e-10);
            }
        }
    }
}
