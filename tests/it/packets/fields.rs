//! Every estimator in every field along a ray, as cases.

use crate::common::{case, shipped};
use trueflight::case::Case;

/// Media that the shipped cases do not combine with every estimator, σ̂ and control.
pub const MEDIA: [(&str, &str); 14] = [
    ("constant", "medium.constant.extinction = 0.7\nspan = [1, 4]"),
    (
        "steps",
        "medium.piecewise-constant = { breaks = [0, 1, 2.5, 4], values = [0.2, 1.5, 0.4] }
        span = [0, 4]",
    ),
    (
        "lines",
        "medium.piecewise-linear = { knots = [0, 1, 2.5, 4], values = [0.2, 1.4, 0, 1] }
        span = [0, 4]",
    ),
    ("exponential", "medium.exponential = { extinction = 1.4, rate = 0.7 }\nspan = [0, 3]"),
    ("gaussian", "medium.gaussian = { peak = 1.4, centre = 2, width = 0.7 }\nspan = [0, 4]"),
    (
        "sines",
        "medium.sines = { base = 0.8, amplitudes = [0.4, -0.2], frequencies = [2, 5] }
        span = [0, 4]",
    ),
    (
        "radial",
        "volume.radial = { centre = [2, 2, 2], radius = 1.9, coefficients = [0.3, 2, -1.5, -0.6] }
        ray = { origin = [-1, 0.4, 0.9], direction = [4.2, 2.2, 1.9], length = 9 }",
    ),
    (
        "eq21",
        "volume.eq21 = {}
        ray = { origin = [1, 0, -3], direction = [0, 0.1, 1], length = 30 }",
    ),
    (
        "noise",
        "volume.noise = { extinction = 1.2, octaves = 3, seed = 5 }
        ray = { origin = [0.3, 0.7, -0.4], direction = [0.6, 0.5, 0.4], length = 5 }",
    ),
    (
        "grid",
        "volume.grid = { random = { size = [5, 5, 5], seed = 7 },
                         bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }
        ray = { origin = [-1, 0.4, 0.9], direction = [4.2, 2.2, 1.9], length = 9 }",
    ),
    (
        "many-steps",
        "medium.piecewise-constant = {
            breaks = [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.01, 1.02, 1.03, 1.04, 1.05,
                      2, 2.5, 3, 4],
            values = [1, 0, 1, 0.5, 1.2, 0, 1, 0.7, 0.4, 1.4, 1, 0.2, 0, 1, 1, 0.4, 1.3, 0.1, 0.9] }
        span = [0, 4]",
    ),
    (
        "gaps",
        "medium.piecewise-constant = { breaks = [0, 1, 1.5, 2, 3, 4, 5],
                                       values = [0, 0.7, 1.1, 0, 0.5, 0] }
        span = [0, 5]",
    ),
    (
        "cubic-noise",
        "volume.noise = { extinction = 1.2, octaves = 7, seed = 4294967294, fade = \"cubic\" }
        ray = { origin = [3, -0.7, 90.4], direction = [-0.6, 0, 0.4], length = 5 }",
    ),
    (
        "nearest-grid",
        "volume.grid = { random = { size = [9, 8, 7], seed = 7 }, interpolation = \"nearest\",
                         bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }
        ray = { origin = [5, 5, 5], direction = [-1, -1, -1], length = 9 }",
    ),
];

/// Every product estimator, with every form of σ̂ and of control.
pub const ESTIMATORS: &str = "
    { woodcock = {} }, { woodcock.sampling.local-majorants.segments = 5 },
    { ratio = {} }, { ratio.sampling.local-majorants.segments = 5 },
    { residual-ratio = {} }, { weighted-delta = {} },
    { single.rule = \"terminating\" }, { single.rule = \"clamped\" },
    { single = { rule = \"non-terminating\", albedo = 0.7 } },
    { single = { rule = \"adaptive\", albedo = 0.2 } },
    { single = { rule = \"clamped\", control.constant.value = 0.9, sampling.constant.value = 0.6 } },
    { single = { rule = \"adaptive\", albedo = 0.2, control.explorers.points = 5 } },
    { double.control.explorers.points = 5 }, { double.control.explorers.points = 40 }, { double.control.constant.value = 0.9 },
    { double.sampling.constant.value = 0.4 },";

/// Other estimators of transmittance that are drawn in packets.
const OTHERS: &str = "
    { next-flight = {} }, { unidirectional-mis = {} }, { next-flight.sampling.constant.value = 0.4 },
    { unidirectional-mis.sampling.constant.value = 300 },
    { decomposition = {} }, { decomposition.control.constant.value = 0 },
    { decomposition.sampling.local-majorants.segments = 5 },
    { decomposition.sampling.piecewise-linear = { knots = [0, 2, 30], values = [1.5, 2, 1.5] } },
    { local-majorant = {} }, { local-majorant.sampling.local-majorants.segments = 5 },
    { local-majorant.sampling.local-majorants.segments = 70 },";

/// Compared combinations: every estimator in every field, or every estimator in one field and one estimator of each
/// kind in every field, since kernels and fields are compiled separately.
#[derive(Clone, Copy, PartialEq)]
pub enum Matrix {
    Full,
    Cross,
}

/// Field with every estimator in [`Matrix::Cross`].
const CENTRE: &str = "eq21";

/// Returns slabs with a medium for each channel, in both lights.
fn slabs_of_media() -> [Case; 2] {
    let slab = include_str!("../../../cases/slab/chromatic-three-colours.toml");
    let diffuse = slab.replace("collimated = { cosine = 0.6 }", "diffuse = {}");
    assert_ne!(slab, diffuse);
    [case("colours", slab), case("colours-diffuse", &diffuse)]
}

pub fn cases(matrix: Matrix) -> Vec<Case> {
    let mut cases = if matrix == Matrix::Full { shipped() } else { Vec::new() };
    cases.push(case("layers", include_str!("../../../cases/transmittance/spectral-layers.toml")));
    cases.push(case("smooth", include_str!("../../cases/transmittance/spectral-smooth.toml")));
    cases.push(case("hero", include_str!("../../../cases/transmittance/spectral-hero-delta.toml")));
    for (name, text) in [
        ("three-colours", include_str!("../../../cases/rod/spectral-lit-three-colours.toml")),
        ("extinctions", include_str!("../../cases/rod/spectral-lit-extinctions.toml")),
        ("phases", include_str!("../../cases/rod/spectral-lit-phases.toml")),
        ("forward", include_str!("../../../cases/rod/spectral-lit-forward.toml")),
        ("as-printed", include_str!("../../../cases/rod/spectral-lit-as-printed.toml")),
        ("one-medium", include_str!("../../cases/rod/spectral-lit-one-medium.toml")),
        ("connected", include_str!("../../cases/rod/bidirectional-known-bugs.toml")),
        ("unscattered", include_str!("../../cases/rod/bidirectional-unscattered.toml")),
        ("reflected", include_str!("../../cases/rod/bidirectional-reflected.toml")),
    ] {
        cases.push(case(name, text));
    }
    cases.extend(slabs_of_media());
    for (name, medium) in MEDIA {
        if matrix == Matrix::Cross && name != CENTRE {
            let text = format!(
                "title = \"{name}\"\n[problem.transmittance]\n{medium}\nsampling.constant.value = 1.5
                estimators = [{{ ratio = {{}} }}, {{ ratio.sampling.local-majorants.segments = 5 }},
                    {{ single.rule = \"clamped\" }}, {{ double.control.explorers.points = 5 }}]"
            );
            cases.push(case(name, &text));
            continue;
        }
        let transmittance = format!(
            "title = \"{name}\"\n[problem.transmittance]\n{medium}\nsampling.constant.value = 1.5
            estimators = [{ESTIMATORS} {OTHERS}
                {{ ray-marching = {{ steps = 10, jitter = true, expect = \"biased\" }} }},
                {{ ray-marching = {{ steps = 3, expect = \"biased\" }} }},
                {{ woodcock = {{ sampling.constant.value = 0.3, expect = \"biased\" }} }},
                {{ ratio.sampling.piecewise-linear = {{ knots = [0, 2, 30], values = [0.5, 2, 1] }} }}]"
        );
        let flight = format!(
            "title = \"{name}, flight\"\n[problem.free-flight]\n{medium}
            sampling.constant.value = 1.5
            estimators = [{{ woodcock = {{}} }}, {{ woodcock.sampling.local-majorants.segments = 5 }}]"
        );
        let curve = format!(
            "title = \"{name}, curve\"\n[problem.transmittance]\n{medium}\ndistances = 5
            sampling.constant.value = 1.5
            estimators = [{{ double = {{}} }}, {{ double.control.explorers.points = 40 }},
                {{ double = {{ control.mean = {{}}, sampling.local-majorants.segments = 5 }} }},
                {{ double.sampling.piecewise-linear = {{ knots = [0, 2, 30], values = [0.5, 2, 1] }} }}]"
        );
        let rod = format!(
            "title = \"{name}, rod\"\n[problem.rod]\n{medium}\nforward = 0.7\nabsorbed = true
            albedo.piecewise-linear = {{ knots = [0, 4], values = [0.9, 0.6] }}\norders = 2\nflux = 3
            sampling.constant.value = 1.6
            estimators = [{{ terminating = {{}} }}, {{ non-terminating = {{}} }}, {{ adaptive = {{}} }},
                {{ adaptive.sampling.constant.value = 0.7 }}, {{ analog = {{}} }}, {{ weighted = {{}} }},
                {{ weighted.sampling.local-majorants.segments = 5 }}]"
        );
        cases.push(case(name, &transmittance));
        cases.push(case(&format!("{name}-curve"), &curve));
        if matches!(name, "constant" | "lines" | "sines" | "eq21" | "gaps") {
            cases.push(case(&format!("{name}-rod"), &rod));
            // The emitter is in the field.
            let medium = medium.replace("length = 30", "length = 12");
            let lit = format!(
                "title = \"{name}, lit\"\n[problem.rod]\nlight = 'emitter'\n{medium}\nforward = 0.7
                albedo.piecewise-linear = {{ knots = [0, 4], values = [0.9, 0.6] }}
                sampling.constant.value = 1.6
                estimators = [{{ unidirectional = {{}} }}, {{ next-event.shadow = \"exact\" }},
                    {{ next-event.shadow = \"delta\" }}, {{ next-event = {{}} }}, {{ directional-mis = {{}} }},
                    {{ full-mis.shadow = \"exact\" }}, {{ full-mis = {{}} }}, {{ full-mis.heuristic = \"power\" }},
                    {{ full-mis.sampling.local-majorants.segments = 5 }},
                    {{ directional-mis.sampling.piecewise-linear = {{ knots = [0, 2, 30], values = [1.5, 2.5, 1.5] }} }}]"
            );
            cases.push(case(&format!("{name}-lit"), &lit));
            cases.extend(lit_slabs(name, &medium));
            cases.extend(coloured(name, &medium));
            let roulette = format!(
                "title = \"{name}, roulette\"\n[problem.rod]\n{medium}\nforward = 0.7\nalbedo = 0.8\norders = 1
                sampling.constant.value = 1.6
                estimators = [{{ roulette = {{}} }}, {{ roulette.below = 0.6 }},
                    {{ roulette.sampling.local-majorants.segments = 5 }}]"
            );
            cases.push(case(&format!("{name}-roulette"), &roulette));
            for (light, phase) in [
                ("collimated.cosine = 0.8", "isotropic = {}"),
                ("diffuse = {}", "isotropic = {}"),
                ("diffuse = {}", "rayleigh = {}"),
                ("collimated.cosine = 1", "henyey-greenstein = { g = 0.6 }"),
            ] {
                let slab = format!(
                    "title = \"{name}, slab\"\n[problem.slab]\n{medium}\nalbedo = 0.8
                    incidence.{light}\nphase.{phase}\nsampling.constant.value = 1.6
                    estimators = [{{ terminating = {{}} }}, {{ non-terminating = {{}} }},
                        {{ adaptive = {{}} }}, {{ analog = {{}} }}, {{ weighted = {{}} }},
                        {{ weighted.sampling.local-majorants.segments = 5 }}]"
                );
                cases.push(case(&format!("{name}-slab"), &slab));
            }
        }
        cases.push(case(&format!("{name}-flight"), &flight));
    }
    cases
}

/// Returns a field as a slab with each kind of light behind it.
fn lit_slabs(name: &str, medium: &str) -> Vec<Case> {
    let lights = [
        ("cap.cosine = 0.6", ", { unidirectional = {} }, { full-mis.heuristic = \"power\" }"),
        ("disc = { distance = 1, radius = 2 }", ", { unidirectional = {} }"),
        ("distant.cosine = 0.7", ""),
    ];
    let of = |(light, hits)| {
        let slab = format!(
            "title = \"{name}, lit slab\"\n[problem.slab]\n{medium}\nalbedo = 0.9
            phase.henyey-greenstein = {{ g = 0.4 }}\nlight.{light}\nsampling.constant.value = 1.6
            estimators = [{{ next-event.shadow = \"exact\" }}, {{ next-event.shadow = \"delta\" }},
                {{ next-event = {{}} }}, {{ directional-mis = {{}} }}, {{ full-mis.shadow = \"exact\" }},
                {{ full-mis = {{}} }}, {{ full-mis.sampling.local-majorants.segments = 5 }}{hits}]"
        );
        case(&format!("{name}-lit-slab"), &slab)
    };
    lights.map(of).into()
}

/// Returns a field as a rod and as slabs of coloured scatterers.
fn coloured(name: &str, medium: &str) -> Vec<Case> {
    let bodies = [
        ("rod", "forward = 0.7"),
        ("slab", "phase.isotropic = {}\nincidence.collimated.cosine = 0.8"),
        ("slab", "phase.henyey-greenstein = { g = 0.4 }\nincidence.diffuse = {}"),
    ];
    let of = |(body, settings)| {
        let text = format!(
            "title = \"{name}, coloured {body}\"\n[problem.{body}]\n{medium}\n{settings}
            albedos = [0.9, 0, 0.6]\nsampling.constant.value = 1.6
            estimators = [{{ independent = {{}} }}, {{ independent.hero = [0.1, 0.2, 0.7] }},
                {{ spectral-mis = {{}} }}, {{ spectral-mis.sampling.local-majorants.segments = 5 }},
                {{ spectral-tracking = {{}} }}, {{ spectral-tracking.probabilities = \"maximum\" }}]"
        );
        case(&format!("{name}-coloured-{body}"), &text)
    };
    bodies.map(of).into()
}
