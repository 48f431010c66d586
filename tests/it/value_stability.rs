//! The first draws of every estimator from seed 1, to the bit.
//!
//! A change detector and nothing more: it says that draws have changed, not that they were right.
//! After a change that is meant, `TRUEFLIGHT_FIRST_DRAWS=write cargo test --test it value_stability`
//! writes the file anew; the difference belongs in the same commit as its reason.

use std::fmt::Write;
use std::path::Path;

use crate::common::{case, options};
use trueflight::case::Case;
use trueflight::catalogue::PageList;
use trueflight::estimators::{DrawBuffer, Estimated};
use trueflight::plan::Plan;
use trueflight::problems::{
    BidirectionalRod, FreeFlight, Furnace, InfiniteMedium, Lambertian, LitRod, LitSlab, Rod, Slab,
    SpectralLitRod, SpectralRod, SpectralSlab, SpectralTransmittance, Sphere, Transmittance,
    TransmittanceCurve,
};

/// Draws of each experiment.
const DRAWS: usize = 4;

fn cases() -> Vec<Case> {
    vec![
        case(
            "transmittance",
            "title = \"every estimator of the transmittance\"
            [problem.transmittance]
            medium.piecewise-constant = { breaks = [0, 1, 2.5, 4], values = [0.2, 1.5, 0.4] }
            span = [0, 4]
            sampling.constant.value = 1.6
            estimators = [
                { closed-form = {} },
                { regular = {} },
                { woodcock = {} },
                { woodcock.sampling.local-majorants.segments = 8 },
                { local-majorant.sampling.local-majorants.segments = 8 },
                { decomposition = {} },
                { ratio = {} },
                { ratio.sampling.piecewise-linear = { knots = [0, 2, 4], values = [0.5, 2, 1] } },
                { ratio.sampling.pilot.rays = 16 },
                { residual-ratio = {} },
                { single.rule = \"terminating\" },
                { single.rule = \"clamped\" },
                { single = { rule = \"non-terminating\", albedo = 0.7 } },
                { single = { rule = \"adaptive\", albedo = 0.2 } },
                { double.control.explorers.points = 5 },
                { double.control.constant.value = 0.9 },
                { weighted-delta = {} },
                { next-flight = {} },
                { unidirectional-mis = {} },
                { ray-marching = { steps = 10, jitter = true } },
            ]",
        ),
        case(
            "volume",
            "title = \"a volume whose lookups take cosines\"
            [problem.transmittance]
            volume.eq21 = {}
            ray = { origin = [1, 0, -3], direction = [0, 0.1, 1], length = 30 }
            sampling.constant.value = 1.1
            estimators = [{ woodcock = {} }, { double.control.mean = {} }]",
        ),
        case(
            "noise",
            "title = \"a volume whose lookups hash\"
            [problem.transmittance]
            volume.noise = { extinction = 1.2, octaves = 3, seed = 5 }
            ray = { origin = [0.3, 0.7, -0.4], direction = [0.6, 0.5, 0.4], length = 5 }
            sampling.constant.value = 1.3
            estimators = [{ woodcock = {} }, { ratio = {} }]",
        ),
        case(
            "grid",
            "title = \"a volume whose lookups interpolate\"
            [problem.transmittance]
            volume.grid = { random = { size = [5, 5, 5], seed = 7 },
                            bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }
            ray = { origin = [-1, 0.4, 0.9], direction = [4.2, 2.2, 1.9], length = 9 }
            sampling.constant.value = 1.1
            estimators = [{ woodcock = {} }, { ratio = {} }]",
        ),
        case(
            "flight",
            "title = \"free flights\"
            [problem.free-flight]
            medium.exponential = { extinction = 2, rate = 0.7 }
            span = [0, 3]
            sampling.constant.value = 2
            estimators = [{ woodcock = {} }, { inversion = {} }]",
        ),
        case(
            "curve",
            "title = \"a curve\"
            [problem.transmittance-curve]
            medium.gaussian = { peak = 1.5, centre = 2, width = 0.7 }
            span = [0, 4]
            distances = 3
            sampling.constant.value = 1.2
            estimators = [{ double = {} }]",
        ),
    ]
}

fn rods() -> Vec<Case> {
    vec![
        case(
            "rod",
            "title = \"a rod\"
            [problem.rod]
            medium.piecewise-linear = { knots = [0, 2, 4], values = [0.3, 1.2, 0.5] }
            span = [0, 4]
            albedo.piecewise-linear = { knots = [0, 4], values = [0.9, 0.6] }
            forward = 0.7
            absorbed = true
            orders = 1
            flux = 2
            sampling.constant.value = 1.3
            estimators = [
                { terminating = {} }, { non-terminating = {} }, { analog = {} }, { weighted = {} },
                { adaptive.sampling.piecewise-linear = { knots = [0, 2, 4], values = [0.8, 1, 0.6] } },
            ]",
        ),
        case(
            "roulette",
            "title = \"a rod with roulette\"
            [problem.rod]
            medium.constant.extinction = 2
            span = [0, 2]
            albedo = 0.6
            sampling.constant.value = 2.2
            estimators = [{ roulette.below = 0.5 }]",
        ),
        case(
            "lit-rod",
            "title = \"a rod with an emitter\"
            [problem.lit-rod]
            medium.piecewise-linear = { knots = [0, 2, 4], values = [0.3, 1.2, 0.5] }
            span = [0, 4]
            albedo.piecewise-linear = { knots = [0, 4], values = [0.9, 0.6] }
            forward = 0.7
            sampling.constant.value = 1.3
            estimators = [
                { unidirectional = {} }, { next-event = {} }, { directional-mis = {} }, { full-mis = {} },
            ]",
        ),
        case(
            "lit-slab",
            "title = \"a slab with a light\"
            [problem.lit-slab]
            medium.piecewise-linear = { knots = [0, 2, 4], values = [0.3, 1.2, 0.5] }
            span = [0, 4]
            albedo = 0.9
            phase.henyey-greenstein = { g = 0.5 }
            light.disc = { distance = 1, radius = 2 }
            sampling.constant.value = 1.3
            estimators = [
                { unidirectional = {} }, { next-event = {} }, { directional-mis = {} }, { full-mis = {} },
            ]",
        ),
        case(
            "slab",
            "title = \"a slab\"
            [problem.slab]
            medium.piecewise-linear = { knots = [0, 1, 2], values = [0.3, 1.2, 0.5] }
            span = [0, 2]
            albedo = 0.9
            phase.henyey-greenstein = { g = 0.5 }
            incidence.diffuse = {}
            sampling.constant.value = 1.3
            estimators = [
                { terminating = {} }, { non-terminating = {} }, { analog = {} }, { weighted = {} },
                { adaptive.sampling.piecewise-linear = { knots = [0, 1, 2], values = [0.8, 1.1, 0.6] } },
            ]",
        ),
    ]
}

fn spaces() -> Vec<Case> {
    let ray = "ray = { origin = [0.5, 1, -1], direction = [0.1, 0.05, 1], length = 22 }";
    let rules = "{ particle = { rule = \"terminating\" } }, { particle = { rule = \"weighted\" } },
        { particle = { rule = \"adaptive\", sampling.local-majorants.grid = [5, 4, 6] } },
        { particle = { rule = \"non-terminating\", roulette = 0.8 } }";
    let text = |name: &str, more: &str, estimators: &str| {
        let text = format!(
            "title = \"{name}\"\n[problem.{name}]\n{ray}\n{more}\nsampling.constant.value = 1.1\n\
             estimators = [{estimators}]"
        );
        case(name, &text)
    };
    let splitting = "{ splitting = { rule = \"analog\", depth = 2 } }";
    let forward = "phase.henyey-greenstein = { g = 0.5 }";
    vec![
        text(
            "furnace",
            &format!("volume.eq21 = {{}}\nalbedo = 0.7\n{forward}"),
            &format!("{rules}, {{ particle = {{ rule = \"analog\" }} }}, {splitting}"),
        ),
        text(
            "lambertian",
            &format!(
                "volume.noise = {{ octaves = 2, seed = 5, extinction = 1,
                bounds.box = {{ low = [0, 0, 0], high = [2, 3, 4] }} }}\nalbedo = 1\n{forward}"
            ),
            &format!("{rules}, {splitting}"),
        ),
        text(
            "infinite-medium",
            "volume.constant.extinction = 1\nalbedo = 0.7\nphase.isotropic = {}\nradii = [1, 2]",
            "{ particle = { rule = \"analog\" } },
            { particle = { rule = \"weighted\", roulette = 0.5 } }",
        ),
    ]
}

fn balls() -> Vec<Case> {
    let text = |light: &str, estimators: &str| {
        let text = format!(
            "title = \"a ball, {light}\"\n[problem.sphere]\n\
             volume.radial = {{ centre = [0, 0, 1], radius = 1.5, coefficients = [2, -1, -0.5] }}\n\
             ray = {{ origin = [0, 0.4, -2], direction = [0, 0, 1], length = 9 }}\nalbedo = 0.8\n\
             phase.isotropic = {{}}\nlight.{light}\nsampling.constant.value = 2\n\
             estimators = [{estimators}]"
        );
        case(&format!("ball-{}", &light[..5]), &text)
    };
    vec![
        text(
            "environment = {}",
            "{ particle.rule = \"analog\" }, { particle.rule = \"non-terminating\" },
            { next-event = { rule = \"weighted\", shadow.ratio = { sampling = 2, control = 1 } } },
            { full-mis = { rule = \"non-terminating\", heuristic = \"power\" } },
            { bidirectional.subpaths = \"shared\" }",
        ),
        text(
            "black-sphere.radius = 0.5",
            "{ particle.rule = \"weighted\" },
            { next-event = { rule = \"analog\", shadow.delta = { sampling = 2 } } },
            { directional-mis = { rule = \"analog\", shadow.delta = { sampling = 2 } } },
            { full-mis = { rule = \"analog\", sampling.local-majorants.grid = [3, 3, 3] } },
            { bidirectional = {} }",
        ),
    ]
}

fn spectral() -> Vec<Case> {
    vec![
        case("layers", include_str!("../../cases/spectral-transmittance/layers.toml")),
        case("colours", include_str!("../cases/spectral-rod/near-albedos.toml")),
        case("coloured-slab", include_str!("../cases/spectral-slab/known-bugs.toml")),
        case("chromatic-slab", include_str!("../../cases/chromatic-slab/three-colours.toml")),
        case("one-scattering", include_str!("../cases/spectral-single-scattering/known-bugs.toml")),
        case("like-slab", include_str!("../../cases/chromatic-slab/like-colours.toml")),
        case("like-furnace", include_str!("../../cases/spectral-furnace/like-colours.toml")),
        case(
            "without-mis",
            include_str!("../../cases/spectral-single-scattering/without-mis.toml"),
        ),
        case("coloured-furnace", include_str!("../cases/spectral-furnace/known-bugs.toml")),
    ]
}

fn paths() -> Vec<Case> {
    vec![case(
        "bidirectional-rod",
        "title = \"bidirectional path tracing\"
        [problem.bidirectional-rod]
        medium.piecewise-linear = { knots = [0, 2, 4], values = [0.3, 1.2, 0.5] }
        span = [0, 4]
        albedo = 0.9
        forward = 0.6
        sensor = \"reflected\"
        orders = 2
        sampling.piecewise-linear = { knots = [0, 2, 4], values = [0.6, 2.4, 1] }
        estimators = [
            { technique.light-vertices = 1 },
            { directional-mis = {} },
            { full-mis = {} },
            { full-mis = { heuristic = \"power\", connection = \"ratio\" } },
        ]",
    )]
}

fn lit() -> Vec<Case> {
    vec![
        case("lit-colours", include_str!("../../cases/spectral-lit-rod/three-colours.toml")),
        case("forward", include_str!("../../cases/spectral-lit-rod/forward.toml")),
        case("as-printed", include_str!("../../cases/spectral-lit-rod/as-printed.toml")),
    ]
}

/// One line per draw: names, values in bits and in decimals, lookups.
fn drawn() -> String {
    let cases: Vec<Case> = [cases(), rods(), spaces(), balls(), spectral(), paths(), lit()]
        .into_iter()
        .flatten()
        .collect();
    let plan = Plan::new(&cases, &options(1, DRAWS as u64));
    let mut text = String::from("case,estimator,sampling,control,draw,bits,values,lookups\n");
    for (planned_case, planned) in plan.experiments() {
        let ready = planned.outcome.as_ref().expect("it is not refused");
        let mut buffer = DrawBuffer::new(ready.prediction.channels.len());
        ready.experiment.fill(&mut planned.streams(0), DRAWS, &mut buffer);
        let id = &planned.id;
        for draw in 0..DRAWS {
            let values: Vec<f64> = buffer.values.iter().map(|channel| channel[draw]).collect();
            let bits: Vec<String> =
                values.iter().map(|value| format!("{:016x}", value.to_bits())).collect();
            let decimals: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
            let (estimator, sampling, control) = (id.label(), &id.sampling.kind, &id.control);
            writeln!(
                text,
                "{},\"{estimator}\",\"{sampling}\",\"{control}\",{draw},{},{},{}",
                planned_case.case.name,
                bits.join(" "),
                decimals.join(" "),
                buffer.lookups[draw]
            )
            .expect("a text takes lines");
        }
    }
    text
}

#[test]
fn the_first_draws_have_not_changed() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/first-draws.csv");
    let now = drawn();
    if std::env::var_os("TRUEFLIGHT_FIRST_DRAWS").is_some_and(|wish| wish == "write") {
        std::fs::write(&path, &now).expect("the file is written");
    }
    let before = std::fs::read_to_string(&path).expect("the file of first draws");
    let changed: Vec<String> = before
        .lines()
        .zip(now.lines())
        .filter(|(before, now)| before != now)
        .map(|(before, now)| format!("- {before}\n+ {now}"))
        .collect();
    crate::common::none(&changed);
    assert_eq!(before.lines().count(), now.lines().count(), "estimators came or went");
}

#[test]
fn every_estimator_of_the_catalogue_is_there() {
    let text = drawn();
    for (PageList { pages, .. }, cases) in [
        (Transmittance::CATALOGUE, ["transmittance", "volume"]),
        (FreeFlight::CATALOGUE, ["flight", "flight"]),
        (TransmittanceCurve::CATALOGUE, ["curve", "curve"]),
        (Rod::CATALOGUE, ["rod", "roulette"]),
        (LitRod::CATALOGUE, ["lit-rod", "lit-rod"]),
        (LitSlab::CATALOGUE, ["lit-slab", "lit-slab"]),
        (Slab::CATALOGUE, ["slab", "slab"]),
        (SpectralTransmittance::CATALOGUE, ["layers", "layers"]),
        (SpectralRod::CATALOGUE, ["colours", "colours"]),
        (SpectralSlab::CATALOGUE, ["coloured-slab", "coloured-slab"]),
        (SpectralLitRod::CATALOGUE, ["forward", "as-printed"]),
        (Furnace::CATALOGUE, ["furnace", "furnace"]),
        (Lambertian::CATALOGUE, ["lambertian", "lambertian"]),
        (InfiniteMedium::CATALOGUE, ["infinite-medium", "infinite-medium"]),
        (Sphere::CATALOGUE, ["ball-envir", "ball-black"]),
        (BidirectionalRod::CATALOGUE, ["bidirectional-rod", "bidirectional-rod"]),
    ] {
        for page in pages {
            let found =
                cases.iter().any(|case| text.contains(&format!("{case},\"{}", page.name())));
            assert!(found, "{} is missing here", page.name());
        }
    }
}
