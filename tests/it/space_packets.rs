//! Walks in space made side by side are the walks made one by one, to the bit.
//!
//! Values, lookups, and where the streams are left, on every level of vector hardware that this machine has
//! and that fuses multiplication and addition, for every problem in space, every field, every phase
//! function, and for one σ̂ as well as for cells.

use crate::common::{case, none, options};
use fearless_simd::Level;
use trueflight::estimators::{DrawBuffer, Kernel};
use trueflight::harness::plan::Planned;
use trueflight::harness::{Case, Plan};
use trueflight::numeric::pack::fuses;

/// Draws of several requests in a row, which no number of lanes divides.
const REQUESTS: [usize; 5] = [1, 5, 16, 100, 701];

const BALL: &str = "bounds.sphere = { centre = [0.5, 0, 0], radius = 1.5 }";
const CUBE: &str = "bounds.box = { low = [-1, -1, -1], high = [1, 1.5, 2] }";

/// Fields in a body, below 2.
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
    let folders = ["cases/furnace", "cases/lambertian", "cases/infinite-medium", "cases/sphere"];
    let mut cases = Case::read_all(&folders).unwrap_or_else(|errors| {
        panic!("{}", errors.iter().map(|error| error.render(false)).collect::<String>())
    });
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

/// All that an experiment draws, as bits, and its streams afterwards.
fn drawn(planned: &Planned, kernel: Kernel) -> Vec<u64> {
    let ready = planned.outcome.as_ref().expect("it is not refused");
    let mut buffer = DrawBuffer::new(ready.prediction.channels.len());
    let mut streams = planned.streams(3);
    let mut bits = Vec::new();
    for count in REQUESTS {
        ready.experiment.fill_by(kernel, &mut streams, count, &mut buffer);
        assert_eq!(buffer.lookups.len(), count);
        for channel in &buffer.values {
            bits.extend(channel.iter().map(|value| value.to_bits()));
        }
        bits.extend(buffer.lookups.iter().map(|&lookups| u64::from(lookups)));
        bits.extend(buffer.defects.iter().map(|defect| defect.to_bits()));
    }
    bits.push(streams.turn as u64);
    bits.extend(streams.words().take(16));
    bits
}

/// Every level that fuses, from the best down.
pub fn fusing_levels() -> Vec<Level> {
    let mut levels = vec![Level::new()];
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    levels.extend(Level::new().as_avx2().map(Level::Avx2));
    levels.retain(|&level| fuses(level));
    levels
}

/// Compares all experiments of cases on all levels; answers how many comparisons that were.
pub fn compare(cases: &[Case]) -> usize {
    let plan = Plan::new(cases, &options(1, 1_000));
    let (mut wrong, mut compared) = (Vec::new(), 0);
    for (case, planned) in plan.experiments().filter(|(_, planned)| planned.outcome.is_ok()) {
        let single = drawn(planned, Kernel::Single);
        for level in fusing_levels() {
            compared += 1;
            let packets = drawn(planned, Kernel::Packets(level));
            let differing = single.iter().zip(&packets).position(|(a, b)| a != b);
            if differing.is_some() || single.len() != packets.len() {
                let name = &planned.names.estimator;
                let sampling = &planned.names.sampling_kind;
                wrong.push(format!(
                    "{}, {name}, {sampling}, {level:?}: {differing:?}",
                    case.case.name
                ));
            }
        }
    }
    println!("{compared} compared");
    none(&wrong);
    compared
}

#[test]
fn packets_are_the_scalar_walks_at_every_level_that_fuses() {
    let compared = compare(&cases());
    assert!(fusing_levels().is_empty() || compared > 500, "only {compared} compared");
}
