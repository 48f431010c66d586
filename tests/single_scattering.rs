//! Single scattering: the radiance against independent values, and predictions against draws.

mod common;

use common::{case, options};
use serde::Deserialize;
use trueflight::harness::Plan;

#[derive(Deserialize)]
struct Value {
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

fn values() -> Vec<Value> {
    serde_json::from_str(include_str!("data/single-scattering.json")).expect("values")
}

fn case_of(value: &Value, estimators: &str) -> trueflight::harness::Case {
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
            let name = &planned.names.estimator;
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

/// The first raw moment, by quadrature of densities, gains and conditional means, is the radiance by
/// quadrature of the integrand: for all ways to draw.
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
            let name = &planned.names.estimator;
            assert!(apart < 1e-10, "{}, {name}: {apart:e}", value.id);
            eprintln!("{} {name}: var {:e} kurt {:?} err {:e} lookups {:?}", value.id, moments.relative[0], moments.kurtosis(), moments.error, ready.prediction.lookups.as_ref().map(|l| (l.mean, l.variance)));
        }
    }
}
