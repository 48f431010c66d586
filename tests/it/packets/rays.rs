//! Packets along rays, in rods and in slabs: every estimator in every field, and the shipped cases.

use super::compare;
use crate::common::{case, shipped};
use trueflight::case::Case;

/// Media that the shipped cases do not combine with every estimator, σ̂ and control.
#[rustfmt::skip] // one medium, one line
const MEDIA: [(&str, &str); 14] = [
    ("constant", "medium.constant.extinction = 0.7\nspan = [1, 4]"),
    ("steps", "medium.piecewise-constant = { breaks = [0, 1, 2.5, 4], values = [0.2, 1.5, 0.4] }\nspan = [0, 4]"),
    ("lines", "medium.piecewise-linear = { knots = [0, 1, 2.5, 4], values = [0.2, 1.4, 0, 1] }\nspan = [0, 4]"),
    ("exponential", "medium.exponential = { extinction = 1.4, rate = 0.7 }\nspan = [0, 3]"),
    ("gaussian", "medium.gaussian = { peak = 1.4, centre = 2, width = 0.7 }\nspan = [0, 4]"),
    ("sines", "medium.sines = { base = 0.8, amplitudes = [0.4, -0.2], frequencies = [2, 5] }\nspan = [0, 4]"),
    ("radial", "volume.radial = { centre = [2, 2, 2], radius = 1.9, coefficients = [0.3, 2, -1.5, -0.6] }\nray = { origin = [-1, 0.4, 0.9], direction = [4.2, 2.2, 1.9], length = 9 }"),
    ("eq21", "volume.eq21 = {}\nray = { origin = [1, 0, -3], direction = [0, 0.1, 1], length = 12 }"),
    ("noise", "volume.noise = { extinction = 1.2, octaves = 3, seed = 5 }\nray = { origin = [0.3, 0.7, -0.4], direction = [0.6, 0.5, 0.4], length = 5 }"),
    ("grid", "volume.grid = { random = { size = [5, 5, 5], seed = 7 }, bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }\nray = { origin = [-1, 0.4, 0.9], direction = [4.2, 2.2, 1.9], length = 9 }"),
    ("many-steps", "medium.piecewise-constant = { breaks = [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.01, 1.02, 1.03, 1.04, 1.05, 2, 2.5, 3, 4], values = [1, 0, 1, 0.5, 1.2, 0, 1, 0.7, 0.4, 1.4, 1, 0.2, 0, 1, 1, 0.4, 1.3, 0.1, 0.9] }\nspan = [0, 4]"),
    ("gaps", "medium.piecewise-constant = { breaks = [0, 1, 1.5, 2, 3, 4, 5], values = [0, 0.7, 1.1, 0, 0.5, 0] }\nspan = [0, 5]"),
    ("cubic-noise", "volume.noise = { extinction = 1.2, octaves = 7, seed = 4294967294, fade = 'cubic' }\nray = { origin = [3, -0.7, 90.4], direction = [-0.6, 0, 0.4], length = 5 }"),
    ("nearest-grid", "volume.grid = { random = { size = [9, 8, 7], seed = 7 }, interpolation = 'nearest', bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }\nray = { origin = [5, 5, 5], direction = [-1, -1, -1], length = 9 }"),
];

/// Problems of every field, their settings, and their estimators with every form of σ̂ and of control.
const PROBLEMS: [[&str; 3]; 3] = [
    [
        "transmittance",
        "",
        "{ woodcock = {} }, { woodcock.sampling.local-majorants.segments = 5 },
        { woodcock = { sampling.constant.value = 0.3, expect = 'biased' } },
        { ratio = {} }, { ratio.sampling.local-majorants.segments = 5 },
        { ratio.sampling.piecewise-linear = { knots = [0, 2, 30], values = [0.5, 2, 1] } },
        { residual-ratio = {} }, { weighted-delta = {} },
        { single.rule = 'terminating' }, { single.rule = 'clamped' },
        { single = { rule = 'non-terminating', albedo = 0.7 } },
        { single = { rule = 'adaptive', albedo = 0.2 } },
        { single = { rule = 'clamped', control.constant.value = 0.9, sampling.constant.value = 0.6 } },
        { single = { rule = 'adaptive', albedo = 0.2, control.explorers.points = 5 } },
        { double.control.explorers.points = 5 }, { double.control.explorers.points = 40 },
        { double.control.constant.value = 0.9 }, { double.sampling.constant.value = 0.4 },
        { next-flight = {} }, { unidirectional-mis = {} }, { next-flight.sampling.constant.value = 0.4 },
        { unidirectional-mis.sampling.constant.value = 300 },
        { decomposition = {} }, { decomposition.control.constant.value = 0 },
        { decomposition.sampling.local-majorants.segments = 5 },
        { decomposition.sampling.piecewise-linear = { knots = [0, 2, 30], values = [1.5, 2, 1.5] } },
        { local-majorant = {} }, { local-majorant.sampling.local-majorants.segments = 5 },
        { local-majorant.sampling.local-majorants.segments = 70 },
        { ray-marching = { steps = 10, jitter = true, expect = 'biased' } },
        { ray-marching = { steps = 3, expect = 'biased' } }",
    ],
    ["free-flight", "", "{ woodcock = {} }, { woodcock.sampling.local-majorants.segments = 5 }"],
    [
        "transmittance",
        "distances = 5",
        "{ double = {} }, { double.control.explorers.points = 40 },
        { double = { control.mean = {}, sampling.local-majorants.segments = 5 } },
        { double.sampling.piecewise-linear = { knots = [0, 2, 30], values = [0.5, 2, 1] } }",
    ],
];

/// Fields with rods and slabs.
const BODIES: [&str; 5] = ["constant", "lines", "sines", "eq21", "gaps"];

const VARYING: &str =
    "forward = 0.7\nalbedo.piecewise-linear = { knots = [0, 4], values = [0.9, 0.6] }";

const RULES: &str =
    "{ terminating = {} }, { non-terminating = {} }, { adaptive = {} }, { analog = {} },
    { weighted = {} }, { weighted.sampling.local-majorants.segments = 5 },
    { adaptive.sampling.constant.value = 0.7 }";

const ROULETTE: &str = "{ roulette = {} }, { roulette.below = 0.6 },
    { roulette.sampling.local-majorants.segments = 5 }";

const TECHNIQUES: &str = "{ next-event.shadow = 'exact' }, { next-event.shadow = 'delta' }, { next-event = {} },
    { directional-mis = {} }, { full-mis.shadow = 'exact' }, { full-mis = {} },
    { unidirectional = {} }, { full-mis.heuristic = 'power' },
    { full-mis.sampling.local-majorants.segments = 5 },
    { directional-mis.sampling.piecewise-linear = { knots = [0, 2, 30], values = [1.5, 2.5, 1.5] } }";

const COLOURED: &str = "{ independent = {} }, { independent.hero = [0.1, 0.2, 0.7] },
    { spectral-mis = {} }, { spectral-mis.sampling.local-majorants.segments = 5 },
    { spectral-tracking = {} }, { spectral-tracking.probabilities = 'maximum' }";

/// Returns rods and slabs: the problem, its settings beside the field, and its estimators.
fn bodies() -> Vec<(&'static str, String, &'static str)> {
    let slab = |settings: &str| format!("albedo = 0.8\n{settings}");
    let light =
        |light: &str| slab(&format!("phase.henyey-greenstein = {{ g = 0.4 }}\nlight.{light}"));
    let colours = |settings: &str| format!("albedos = [0.9, 0, 0.6]\n{settings}");
    vec![
        ("rod", format!("{VARYING}\nabsorbed = true\norders = 2\nflux = 3"), RULES),
        ("rod", "forward = 0.7\nalbedo = 0.8\norders = 1".into(), ROULETTE),
        ("rod", format!("{VARYING}\nlight = 'emitter'"), TECHNIQUES),
        ("rod", colours("forward = 0.7"), COLOURED),
        ("slab", slab("incidence.collimated.cosine = 0.8\nphase.isotropic = {}"), RULES),
        ("slab", slab("incidence.diffuse = {}\nphase.isotropic = {}"), RULES),
        ("slab", slab("incidence.diffuse = {}\nphase.rayleigh = {}"), RULES),
        ("slab", slab("incidence.collimated.cosine = 1\nphase.henyey-greenstein.g = 0.6"), RULES),
        ("slab", light("cap.cosine = 0.6"), TECHNIQUES),
        ("slab", light("disc = { distance = 1, radius = 2 }"), TECHNIQUES),
        ("slab", light("distant.cosine = 0.7"), TECHNIQUES),
        ("slab", colours("phase.isotropic = {}\nincidence.collimated.cosine = 0.8"), COLOURED),
        ("slab", colours("phase.henyey-greenstein.g = 0.4\nincidence.diffuse = {}"), COLOURED),
    ]
}

/// Returns a case of a problem in a field.
fn of(problem: &str, (name, field): (&str, &str), settings: &str, estimators: &str) -> Case {
    let text = format!(
        "title = \"{name}\"\n[problem.{problem}]\n{field}\n{settings}
        sampling.constant.value = 1.6\nestimators = [{estimators}]"
    );
    case(&format!("{name}, {problem}, {settings}"), &text)
}

#[test]
fn packets_are_the_scalar_draws_in_every_field() {
    let in_each = |[problem, settings, estimators]: [&str; 3]| {
        MEDIA.map(|medium| of(problem, medium, settings, estimators))
    };
    compare(&PROBLEMS.into_iter().flat_map(in_each).collect::<Vec<_>>(), 450);
}

#[test]
fn packets_are_the_scalar_draws_in_rods_and_slabs() {
    let media = MEDIA.into_iter().filter(|(name, _)| BODIES.contains(name));
    let of_field = |medium| {
        let bodies = bodies().into_iter();
        bodies
            .map(move |(problem, settings, estimators)| of(problem, medium, &settings, estimators))
    };
    compare(&media.flat_map(of_field).collect::<Vec<_>>(), 400);
}

#[test]
fn packets_are_the_scalar_draws_in_the_shipped_cases() {
    let mut cases = shipped();
    let slab = include_str!("../../../cases/slab/chromatic-three-colours.toml");
    let diffuse = slab.replace("collimated = { cosine = 0.6 }", "diffuse = {}");
    assert_ne!(slab, diffuse);
    cases.push(case("diffuse", &diffuse));
    compare(&cases, 250);
}
