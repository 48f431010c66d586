//! Single scattering: the radiance against independent values, and predictions against draws.

use crate::common::{case, options, row, rows};
use serde::Deserialize;
use serde_json::Value;
use trueflight::plan::Plan;
use trueflight::record::Verdict;

#[derive(Deserialize)]
struct Reference {
    id: String,
    params: Params,
    value: f64,
}

#[derive(Deserialize)]
struct Params {
    o: [f64; 3],
    d_unnormalised: [f64; 3],
    #[serde(rename = "S")]
    length: f64,
    light: [f64; 3],
    a: f64,
    medium: String,
    phase: String,
}

fn values() -> Vec<Reference> {
    serde_json::from_str(include_str!("../data/single-scattering.json")).expect("values")
}

fn case_of(value: &Reference, estimators: &str) -> trueflight::case::Case {
    let p = &value.params;
    let volume = match p.medium.as_str() {
        "homogeneous sigma .8" => "volume.constant.extinction = 0.8",
        "Eq. 21" => "volume.eq21 = {}",
        other => panic!("{other}"),
    };
    let text = format!(
        "title = \"{id}\"
        [problem.single-scattering]
        {volume}
        ray = {{ origin = {o:?}, direction = {d:?}, length = {s} }}
        light.position = {l:?}
        albedo = {a}
        phase.{phase} = {{}}
        sampling.constant.value = 1.0
        estimators = [{estimators}]",
        id = value.id,
        o = p.o,
        d = p.d_unnormalised,
        s = p.length,
        l = p.light,
        a = p.a,
        phase = p.phase.to_lowercase(),
    );
    case(&value.id, &text)
}

const ALL: &str = "
    { source-driven = {} },
    { source-driven = { camera = \"ratio\", shadow.ratio = { sampling = 1.3 } } },
    { source-driven = { camera = \"delta\", shadow.delta = { sampling = 1 } } },
    { scattering-driven = { control.mean = {} } },
    { delta-tracking = {} },
    { source-scattering-mis = { control.mean = {}, camera = \"ratio\" } },
    { source-delta-mis = {} },
    { source-delta-mis = { camera = \"ratio\", shadow.ratio = { sampling = 1.3 } } },
    { source-delta-mis = { camera = \"ratio\", absorption = \"analog\", samples = \"one\", heuristic = \"power\" } },
    { delta-tracking = { absorption = \"analog\" } },
    { attenuation-driven = { control.constant.value = 0.2 } },
    { attenuation-resampled = {} },
    { shared-walk = { points = 3, control.constant.value = 0.2 } }";

#[test]
fn radiances_meet_their_values_to_twelve_digits() {
    for value in values() {
        let case = case_of(&value, ALL);
        let plan = Plan::new(std::slice::from_ref(&case), &options(1, 10));
        for (_, planned) in plan.experiments() {
            let ready = planned.outcome.as_ref().unwrap_or_else(|refusal| panic!("{refusal}"));
            let channel = &ready.prediction.channels[0];
            let truth = channel.truth;
            let apart = (truth.value / value.value - 1.0).abs();
            let name = planned.id.label();
            assert!(apart < 1e-12, "{}, {name}: {apart:e}", value.id);
            assert!(truth.error < 2e-12 * truth.value, "{}, {name}: {:e}", value.id, truth.error);
            assert!(
                (truth.value - value.value).abs() <= truth.error + 1e-15 * truth.value,
                "{}, {name}: the bound {:e} is no bound, {apart:e}",
                value.id,
                truth.error / truth.value,
            );
        }
    }
}

/// The first raw moment, by quadrature of densities, gains and conditional means, equals the radiance by quadrature of
/// the integrand, for all techniques.
#[test]
fn predicted_means_are_the_radiance() {
    for value in values() {
        let case = case_of(&value, ALL);
        let plan = Plan::new(std::slice::from_ref(&case), &options(1, 10));
        for (_, planned) in plan.experiments() {
            let ready = planned.outcome.as_ref().unwrap_or_else(|refusal| panic!("{refusal}"));
            let channel = &ready.prediction.channels[0];
            let moments = channel.moments.expect("moments");
            let apart = (moments.scale / channel.truth.value - 1.0).abs();
            let name = planned.id.label();
            assert!(apart < 1e-10, "{}, {name}: {apart:e}", value.id);
        }
    }
}

/// A thin homogeneous medium without losses: L = σ a Φ/(16π² D) Δθ.
#[test]
fn a_thin_medium_scatters_by_the_angle_that_the_light_sees() {
    let text = "title = \"thin\"
        [problem.single-scattering]
        volume.constant.extinction = 1e-9
        ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 2 }
        light = { position = [0.5, 0, 1], power = 3 }
        albedo = 0.4
        phase.isotropic = {}
        estimators = [{ source-driven = {} }]";
    let found = *row(&rows(text, 1000), "source-driven");
    let angle = 2.0 * 2f64.atan();
    let thin = 1e-9 * 0.4 * 3.0 / (16.0 * std::f64::consts::PI.powi(2) * 0.5) * angle;
    let truth = found.truth.expect("a truth");
    assert!((truth / thin - 1.0).abs() < 1e-8, "{truth:e} for {thin:e}");
}

/// Light that a lamp at the centre of a ball sends to a pixel by its first scattering: the values of the integral
/// equation's first order, see `tests/data/README.md`.
#[test]
fn a_lamp_in_a_ball_shines_as_the_integral_equation_says() {
    let balls: Vec<Value> =
        serde_json::from_str(include_str!("../data/spheres.json")).expect("values");
    let mut seen = 0;
    for ball in balls.iter().filter(|ball| ball["light"] == "point") {
        let (volume, albedo) = match ball["ball"].as_str() {
            Some("S1") => (
                "constant = { extinction = 1, bounds.sphere = { centre = [0, 0, 0], radius = 1.5 } }",
                0.8,
            ),
            Some("S2") => {
                ("radial = { centre = [0, 0, 0], radius = 1.5, coefficients = [2, -2] }", 0.9)
            }
            other => panic!("{other:?}"),
        };
        let text = format!(
            "title = \"lamp\"
            [problem.single-scattering]
            volume.{volume}
            ray = {{ origin = [{beside}, 0, -3], direction = [0, 0, 1], length = 6 }}
            light.position = [0, 0, 0]
            albedo = {albedo}
            phase.isotropic = {{}}
            estimators = [{{ source-driven = {{}} }}]",
            beside = ball["at"][0],
        );
        let expected = ball["value"][0].as_f64().expect("a number");
        let truth = row(&rows(&text, 1000), "source-driven").truth.expect("a truth");
        assert!((truth / expected - 1.0).abs() < 1e-11, "{ball}: {truth:e}");
        seen += 1;
    }
    assert_eq!(seen, 6);
}

/// Forward light comes from behind the scattering point, seen from the ray's origin: with the light beyond the ray's
/// end, a forward phase function gathers more than a backward one.
#[test]
fn a_forward_phase_function_gathers_light_that_comes_towards_the_origin() {
    let radiance = |g: f64, z: f64| {
        let text = format!(
            "title = \"side\"
            [problem.single-scattering]
            volume.constant.extinction = 0.5
            ray = {{ origin = [0, 0, 0], direction = [0, 0, 1], length = 2 }}
            light.position = [0.2, 0, {z}]
            albedo = 0.9
            phase.henyey-greenstein.g = {g}
            estimators = [{{ source-driven = {{}} }}]"
        );
        row(&rows(&text, 1000), "source-driven").truth.expect("a truth")
    };
    assert!(radiance(0.6, 4.0) > 5.0 * radiance(-0.6, 4.0));
    assert!(radiance(-0.6, -2.0) > 5.0 * radiance(0.6, -2.0));
}

#[test]
fn a_sampling_extinction_is_not_used_where_the_camera_is_exact() {
    let of = |estimator: &str| {
        crate::common::predicted(&format!(
            "title = \"cameras\"
            [problem.single-scattering]
            volume.constant.extinction = 0.8
            ray = {{ origin = [0, 0, 0], direction = [0, 0, 1], length = 6 }}
            light.position = [0.5, 0, 2.5]
            albedo = 0.9
            phase.isotropic = {{}}
            sweep.sampling.values = [1, 2]
            estimators = [{estimator}]"
        ))
    };
    for name in ["source-driven", "scattering-driven", "source-scattering-mis"] {
        let bare = of(&format!("{{ {name} = {{}} }}"));
        let own =
            of(&format!("{{ {name} = {{ camera = \"exact\", sampling.constant.value = 1.5 }} }}"));
        assert_eq!((bare.len(), own.len()), (1, 1), "{name}: drawn once");
        assert_eq!(
            (own[0].experiment.sampling(), own[0].experiment.id.sampling.kind.as_str()),
            (None, ""),
            "{name}"
        );
        assert_eq!(own[0].predicted_variance, bare[0].predicted_variance, "{name}");
        // With another camera it has its own σ̂, which the sweep does not change.
        let ratio =
            of(&format!("{{ {name} = {{ camera = \"ratio\", sampling.constant.value = 1.5 }} }}"));
        assert_eq!((ratio.len(), ratio[0].experiment.sampling()), (1, Some(1.5)), "{name}");
    }
}

/// A weight of 0 still costs its shadow ray, as predicted: ratio tracking where σ̂ = σ_t.
#[test]
fn lookups_of_tight_ratio_tracking_are_predicted() {
    let text = "title = \"tight\"
        [problem.single-scattering]
        volume.constant.extinction = 0.8
        ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 6 }
        light.position = [0.5, 0, 2.5]
        albedo = 0.9
        phase.isotropic = {}
        sampling.constant.value = 0.8
        estimators = [
            { source-driven = { camera = \"ratio\", shadow.ratio.sampling = 1.2 } },
            { source-driven = { camera = \"delta\", shadow.ratio.sampling = 1.2 } },
            { source-scattering-mis = { camera = \"ratio\", control.constant.value = 0.3,
                sampling.constant.value = 0.5, shadow.delta.sampling = 1 } },
            { source-delta-mis = { camera = \"ratio\", shadow.ratio.sampling = 1.2 } },
        ]";
    for row in rows(text, 200_000) {
        assert_eq!(row.verdict, Some(Verdict::Pass), "{}: {}", row.experiment.label, row.reason());
    }
}
