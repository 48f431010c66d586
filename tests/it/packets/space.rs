//! Packets of walks in space equal single walks, to the bit: every rule in every field, with every phase function, through
//! one σ̂ and through cells.

use super::compare;
use crate::common::case;

const BALL: &str = "bounds.sphere = { centre = [0.5, 0, 0], radius = 1.5 }";
const CUBE: &str = "bounds.box = { low = [-1, -1, -1], high = [1, 1.5, 2] }";

/// Fields below 2, without the end of their settings, and their bodies.
#[rustfmt::skip] // one field, one line
const VOLUMES: [(&str, &str); 11] = [
    ("constant = { extinction = 1.3,", BALL),
    ("constant = { extinction = 1.3,", CUBE),
    ("exponential = { extinction = 0.5, rate = 0.4, axis = [1, 0, 2],", BALL),
    ("gaussian = { peak = 1.9, centre = [0.5, 0, 0], width = 0.8,", BALL),
    ("sines = { base = 1, amplitudes = [0.6, -0.3], vectors = [[2, 1, 0], [0, 1, 3]],", CUBE),
    ("piecewise-constant = { breaks = [-1, 0, 1, 2], values = [0.8, 0, 1.5],", CUBE),
    ("piecewise-linear = { knots = [-1, 0, 1, 2], values = [0.8, 0.1, 1.5, 0.2],", BALL),
    ("noise = { extinction = 1.8, octaves = 3, seed = 3,", BALL),
    ("grid = { random = { size = [5, 4, 3], seed = 5 }, extinction = 1.5,", CUBE),
    ("grid = { random = { size = [5, 4, 3], seed = 5 }, interpolation = \"nearest\",", CUBE),
    ("radial = { centre = [0.5, 0, 0], radius = 1.5, coefficients = [0.3, 2, -1.5]", ""),
];

/// Every rule, with and without roulette, through one σ̂ and through cells, above σ_t and below.
const ESTIMATORS: &str = "{ particle.rule = \"terminating\" }, { particle.rule = \"non-terminating\" },
    { particle.rule = \"adaptive\" }, { particle.rule = \"analog\" }, { particle.rule = \"weighted\" },
    { particle = { rule = \"weighted\", roulette = 0.7 } },
    { particle = { rule = \"non-terminating\", roulette = 0.2 } },
    { particle = { rule = \"non-terminating\", sampling.constant.value = 1.7 } },
    { particle = { rule = \"analog\", sampling.local-majorants.grid = [4, 3, 5] } },
    { particle = { rule = \"weighted\", sampling.local-majorants.grid = [1, 1, 9] } },
    { particle = { rule = \"adaptive\", roulette = 0.5, sampling.local-majorants.grid = [7, 7, 7] } },
    { splitting = { rule = \"analog\", depth = 2 } }";

#[test]
fn packets_are_the_scalar_walks_in_every_field() {
    let mut cases = Vec::new();
    let phases = ["isotropic = {}", "rayleigh = {}", "henyey-greenstein = { g = 0.6 }"];
    let albedos = [
        "albedo = 0.8",
        "albedo = 1",
        "albedo = 0",
        "albedo.sines = { base = 0.6, amplitudes = [0.3], vectors = [[2, 1, 0]] }",
        "albedo.constant = { extinction = 0.9, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }",
    ];
    for (number, (field, body)) in VOLUMES.into_iter().enumerate() {
        for (problem, more) in [
            ("furnace", "ray = { origin = [0.4, 0.2, -3], direction = [0.1, 0, 1] }"),
            ("lambertian", ""),
        ] {
            for turn in 0..2 {
                let phase = phases[(number + turn) % phases.len()];
                let albedo = albedos[(number + turn) % albedos.len()];
                let text = format!(
                    "title = \"{number}\"\n[problem.{problem}]\nvolume.{field} {body} }}\n{more}\n{albedo}\n\
                     phase.{phase}\nsampling.constant.value = 2\nestimators = [{ESTIMATORS}]"
                );
                cases.push(case(&format!("{field}, {problem}, {turn}"), &text));
            }
        }
    }
    compare(&cases, 250);
}
