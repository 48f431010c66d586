//! Packets of single scattering equal single draws, to the bit: every technique with every camera, shadow ray and
//! control, in bodies of all kinds.

use super::compare;
use crate::common::case;

const VOLUMES: [&str; 8] = [
    "constant = { extinction = 0.8 }",
    "constant = { extinction = 0.9, bounds.sphere = { centre = [0, 0, 2], radius = 2 } }",
    "constant = { extinction = 0.9, bounds.box = { low = [-1, -1, 0], high = [2, 2, 3] } }",
    "radial = { centre = [0, 0, 2], radius = 2, coefficients = [0.3, 0.5, -0.4] }",
    "gaussian = { peak = 0.9, centre = [0.5, 0, 2], width = 0.8 }",
    "noise = { extinction = 0.9, octaves = 2, seed = 3 }",
    "grid = { random = { size = [5, 4, 3], seed = 5 }, extinction = 0.9, bounds.box = { low = [-1, -1, 0], high = [2, 2, 3] } }",
    "piecewise-constant = { breaks = [0, 1, 2, 3.5], values = [0.9, 0, 0.4], bounds.box = { low = [-4, -4, 0], high = [4, 4, 3.5] } }",
];

const LIGHTS: [&str; 2] = ["[0.6, 0.4, 1.5]", "[2.4, 0.5, 4]"];

const PHASES: [&str; 3] = ["isotropic = {}", "rayleigh = {}", "henyey-greenstein.g = 0.4"];

/// Shadow rays.
const SHADOWS: [&str; 4] = [
    "exact = {}",
    "ratio = { sampling = 0.8 }",
    "ratio = { sampling = 0.7, control = 0.4 }",
    "delta = { sampling = 1 }",
];

/// Techniques, each with a shadow ray to be filled in.
const TECHNIQUES: [&str; 28] = [
    "source-driven = {",
    "source-driven = { camera = \"ratio\",",
    "source-driven = { camera = \"delta\",",
    "source-driven = { camera = \"ratio\", control.constant.value = 0.4,",
    "source-driven = { camera = \"ratio\", control.explorers.points = 7,",
    "scattering-driven = { control.constant.value = 0.6,",
    "scattering-driven = { control.explorers.points = 7,",
    "scattering-driven = { control.mean = {}, camera = \"ratio\",",
    "source-scattering-mis = { control.mean = {},",
    "source-scattering-mis = { control.explorers.points = 5, camera = \"ratio\",",
    "delta-tracking = {",
    "source-delta-mis = {",
    "delta-tracking = { absorption = \"analog\",",
    "source-delta-mis = { camera = \"ratio\",",
    "source-delta-mis = { camera = \"ratio\", absorption = \"analog\", heuristic = \"power\",",
    "source-delta-mis = { camera = \"ratio\", absorption = \"analog\", samples = \"one\",",
    "source-delta-mis = { absorption = \"analog\", samples = \"one\", heuristic = \"power\",",
    "source-delta-mis = { absorption = \"analog\", heuristic = \"power\",",
    "attenuation-driven = {",
    "attenuation-driven = { control.constant.value = 0.4, sampling.constant.value = 0.3,",
    "attenuation-driven = { control.explorers.points = 5,",
    "attenuation-resampled = {",
    "attenuation-resampled = { control.constant.value = 0.9, sampling.constant.value = 2,",
    "shared-walk = {",
    "shared-walk = { points = 1,",
    "shared-walk = { points = 16, control.constant.value = 0.4,",
    "shared-walk = { points = 7, sampling.constant.value = 0.3,",
    "delta-tracking = { sampling.piecewise-constant = { breaks = [0, 2, 9], values = [1, 1.5] },",
];

#[test]
fn packets_are_the_scalar_draws_in_bodies_of_all_kinds() {
    let mut cases = Vec::new();
    let lit = VOLUMES.iter().flat_map(|volume| LIGHTS.map(|light| (volume, light)));
    for (number, (volume, light)) in lit.enumerate() {
        // Each technique in each body, with two of the shadow rays.
        let with_shadow = |(technique, text): (usize, &&str)| {
            format!("{{ {text} shadow.{} }} }}", SHADOWS[(number + technique) % SHADOWS.len()])
        };
        let estimators: Vec<String> = TECHNIQUES.iter().enumerate().map(with_shadow).collect();
        let text = format!(
            "title = \"packets\"
            [problem.single-scattering]
            volume.{volume}
            ray = {{ origin = [0.3, 0, -1], direction = [0, 0.1, 1], length = 6 }}
            light.position = {light}
            albedo = 0.8
            phase.{}
            sampling.constant.value = 1
            estimators = [{}]",
            PHASES[number % PHASES.len()],
            estimators.join(",\n")
        );
        cases.push(case(&format!("{volume}, {light}"), &text));
    }
    compare(&cases, 400);
}
