//! Packets of walks in space equal single walks, to the bit.
//!
//! Values, lookups, and the final states of the streams are compared, on every level of vector hardware of this machine
//! with fused multiply-add. The walks are those of every problem in space, every field, every phase function, and of
//! one σ̂ as well as of cells.

use super::{compare, fusing_levels};
use crate::common::{case, shipped_in};
use trueflight::case::Case;

const BALL: &str = "bounds.sphere = { centre = [0.5, 0, 0], radius = 1.5 }";
const CUBE: &str = "bounds.box = { low = [-1, -1, -1], high = [1, 1.5, 2] }";

/// Returns fields in a body, below 2.
fn volumes() -> Vec<(&'static str, String)> {
    let within = |field: &str, body: &str| format!("volume.{field}, {body} }}");
    vec![
        ("constant", within("constant = { extinction = 1.3", BALL)),
        ("constant-box", within("constant = { extinction = 1.3", CUBE)),
        (
            "exponential",
            within("exponential = { extinction = 0.5, rate = 0.4, axis = [1, 0, 2]", BALL),
        ),
        ("gaussian", within("gaussian = { peak = 1.9, centre = [0.5, 0, 0], width = 0.8", BALL)),
        (
            "sines",
            within(
                "sines = { base = 1, amplitudes = [0.6, -0.3], vectors = [[2, 1, 0], [0, 1, 3]]",
                CUBE,
            ),
        ),
        (
            "steps",
            within("piecewise-constant = { breaks = [-1, 0, 1, 2], values = [0.8, 0, 1.5]", CUBE),
        ),
        (
            "lines",
            within(
                "piecewise-linear = { knots = [-1, 0, 1, 2], values = [0.8, 0.1, 1.5, 0.2]",
                BALL,
            ),
        ),
        ("noise", within("noise = { extinction = 1.8, octaves = 3, seed = 3", BALL)),
        (
            "grid",
            within("grid = { random = { size = [5, 4, 3], seed = 5 }, extinction = 1.5", CUBE),
        ),
        (
            "voxels",
            within(
                "grid = { random = { size = [5, 4, 3], seed = 5 }, interpolation = \"nearest\"",
                CUBE,
            ),
        ),
        (
            "radial",
            "volume.radial = { centre = [0.5, 0, 0], radius = 1.5, coefficients = [0.3, 2, -1.5] }"
                .into(),
        ),
    ]
}

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

fn cases() -> Vec<Case> {
    let mut cases = shipped_in(&["furnace", "lambertian", "infinite-medium", "ball"]);
    let phases = ["isotropic = {}", "rayleigh = {}", "henyey-greenstein = { g = 0.6 }"];
    let albedos = [
        "albedo = 0.8",
        "albedo = 1",
        "albedo = 0",
        "albedo.sines = { base = 0.6, amplitudes = [0.3], vectors = [[2, 1, 0]] }",
        "albedo.constant = { extinction = 0.9, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }",
    ];
    for (number, (name, volume)) in volumes().into_iter().enumerate() {
        for (problem, more) in [
            ("furnace", "ray = { origin = [0.4, 0.2, -3], direction = [0.1, 0, 1] }"),
            ("lambertian", ""),
        ] {
            for turn in 0..2 {
                let (phase, albedo) = (
                    phases[(number + turn) % phases.len()],
                    albedos[(number + turn) % albedos.len()],
                );
                let text = format!(
                    "title = \"{name}\"\n[problem.{problem}]\n{volume}\n{more}\n{albedo}\n\
                     phase.{phase}\nsampling.constant.value = 2\nestimators = [{ESTIMATORS}]"
                );
                cases.push(case(&format!("{name}, {problem}, {turn}"), &text));
            }
        }
    }
    cases
}

#[test]
fn packets_are_the_scalar_walks_at_every_level_that_fuses() {
    let compared = compare(&cases());
    assert!(fusing_levels().is_empty() || compared > 500, "only {compared} compared");
}
