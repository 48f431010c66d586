//! Chromatic media against reference values that were computed by other means, and refusals.

use std::collections::BTreeMap;

use serde::Deserialize;
use trueflight::record::{Row, Verdict};
use trueflight::theory::rod::closed::critical;

use crate::common::{failing, none, predicted, rows};

#[derive(Deserialize)]
struct Reference {
    id: String,
    value: Vec<f64>,
    error: f64,
}

const LAYERS: &str = include_str!("../../cases/transmittance/spectral-layers.toml");
const SMOOTH: &str = include_str!("../cases/transmittance/spectral-smooth.toml");
const HERO_DELTA: &str = include_str!("../../cases/transmittance/spectral-hero-delta.toml");

/// Trackers by the names of the reference values.
const TRACKERS: [(&str, &str, &str); 10] = [
    ("indep-delta", "independent (delta)", ""),
    ("indep-ratio", "independent (ratio)", ""),
    ("hero-ratio", "hero (ratio)", ""),
    ("hero-delta", "hero (delta)", ""),
    ("mis-ratio", "spectral-mis (ratio)", ""),
    ("mis-delta", "spectral-mis (delta)", "1.6, 1.1, 1.9"),
    ("spectral-avg", "spectral-tracking (average)", ""),
    ("spectral-max", "spectral-tracking (maximum)", ""),
    ("history-avg", "spectral-tracking (history)", ""),
    ("common-ratio", "common-ratio", ""),
];

/// Returns the channels of an estimator, the luminance last.
fn of<'a>(rows: &'a [Row<'static>], estimator: &str, sampling: &str) -> Vec<&'a Row<'static>> {
    let is_asked = |row: &&Row| {
        row.experiment.label == estimator
            && (sampling.is_empty() || row.experiment.id.sampling.kind == sampling)
    };
    rows.iter().filter(is_asked).collect()
}

#[test]
fn moments_and_lookups_are_those_of_the_references() {
    let mut rows: BTreeMap<&str, Vec<Row>> = BTreeMap::new();
    rows.insert("PW3", predicted(LAYERS).into_iter().chain(predicted(HERO_DELTA)).collect());
    let with_hero = SMOOTH.replace(
        "  { spectral-mis = { collisions = \"ratio\" } },",
        "  { hero = { collisions = \"delta\" } },\n  { spectral-mis = { collisions = \"ratio\" } },",
    );
    rows.insert("SM4", predicted(&with_hero));
    let references: Vec<Reference> =
        serde_json::from_str(include_str!("../data/spectral-transmittance.json"))
            .expect("the reference values");
    let mut count = 0;
    for Reference { id, value, error } in references {
        let parts: Vec<&str> = id.split('/').collect();
        let rows = &rows[parts[1]];
        if parts[2] == "mean" {
            for (row, expected) in of(rows, "independent (delta)", "").iter().zip(&value) {
                let found = row.truth.expect("a truth");
                assert!((found - expected).abs() <= error, "{id}: {found} for {expected}");
                count += 1;
            }
            continue;
        }
        let (_, estimator, sampling) =
            TRACKERS.into_iter().find(|tracker| tracker.0 == parts[2]).expect("a tracker");
        let rows = of(rows, estimator, sampling);
        let found: Vec<f64> = if parts[3] == "var" {
            rows[..value.len()].iter().map(|row| row.predicted_variance.expect("known")).collect()
        } else {
            let last = rows.last().expect("the luminance");
            let (variance, lookups) = (last.predicted_variance, last.experiment.predicted_lookups);
            let (variance, lookups) = (variance.expect("known"), lookups.expect("known"));
            vec![variance, lookups, variance * lookups]
        };
        for (found, expected) in found.iter().zip(&value) {
            assert!((found - expected).abs() <= error, "{id}: {found} for {expected}");
            count += 1;
        }
    }
    assert!(count >= 120, "{count}");
}

/// With equal probabilities the mean of all channels is 1 for a survivor: the luminance of four channels has
/// the variance of one bit, `Ȳ(1 − Ȳ)`.
#[test]
fn multiple_importance_sampling_removes_colour_noise_only() {
    let drawn = rows(SMOOTH, 200_000);
    let luminance = |name: &str| {
        let rows = of(&drawn, name, "");
        let row = rows.last().expect("the luminance");
        assert_eq!(row.channel, "luminance");
        (row.truth.expect("known"), row.variance.expect("drawn"))
    };
    for name in ["independent (delta)", "spectral-mis (delta)"] {
        let (truth, variance) = luminance(name);
        let bit = truth * (1.0 - truth);
        assert!((variance / bit - 1.0).abs() < 0.01, "{name}: {variance} for {bit}");
    }
}

#[derive(Deserialize)]
struct RodReference {
    id: String,
    params: RodParams,
    value: Vec<f64>,
    error: f64,
}

#[derive(Deserialize)]
struct RodParams {
    medium: String,
    albedos: Vec<f64>,
}

/// Returns a rod of that optical length, which is the same for any field.
fn rod(length: &str, albedos: &[f64], forward: &str) -> Vec<Row<'static>> {
    predicted(&format!(
        "title = \"rod\"\n[problem.rod]\nmedium.constant = {{ extinction = 0.5 }}\nspan = [0, {}]\n\
         albedos = {albedos:?}\nforward = {forward}\nsampling.constant = {{ value = 0.8 }}\nestimators = [\n\
         {{ spectral-tracking = {{ probabilities = \"average\" }} }},\n\
         {{ spectral-tracking = {{ probabilities = \"maximum\" }} }},\n{{ spectral-mis = {{}} }} ]\n",
        2.0 * length.parse::<f64>().expect("a length")
    ))
}

#[test]
fn rods_of_coloured_scatterers_have_the_variances_of_the_references() {
    let references: Vec<RodReference> =
        serde_json::from_str(include_str!("../data/spectral-rod.json"))
            .expect("the reference values");
    let mut count = 0;
    let mut agrees = |id: &str, found: f64, expected: f64, error: f64| {
        // A predicted variance is exact to its stated error, and to rounding of its moments.
        let near = error.max(1e-13 * (1.0 + expected.abs()));
        assert!((found - expected).abs() <= near, "{id}: {found} for {expected}");
        count += 1;
    };
    for RodReference { id, params, value, error } in references {
        let parts: Vec<&str> = id.split('/').collect();
        let forward = params.medium.rsplit("p_f=").next().expect("p_f").parse().expect("a number");
        let albedos = &params.albedos;
        if id.ends_with("L_critical") {
            let maximum = parts[2] == "spectral-max";
            let most = albedos.iter().fold(0.0f64, |most, &a| most.max(a));
            let least = albedos.iter().fold(1.0f64, |least, &a| least.min(a));
            let mean = albedos.iter().sum::<f64>() / albedos.len() as f64;
            let chance = if maximum { most / (most + 1.0 - least) } else { mean };
            for (albedo, expected) in albedos.iter().zip(value) {
                let found = critical(albedo * albedo / chance, forward);
                if expected > 0.0 {
                    agrees(&id, found, expected, error);
                } else {
                    assert_eq!(found, f64::INFINITY, "{id}");
                }
            }
            continue;
        }
        let rows = rod(&parts[2][1..], albedos, &forward.to_string());
        let of = |estimator: &str, channel: &str| {
            let is_asked = |row: &&Row| row.experiment.label == estimator && row.channel == channel;
            rows.iter().find(is_asked)
        };
        for (channel, expected) in value.iter().enumerate() {
            let number = channel % albedos.len() + 1;
            let side = if channel < albedos.len() { "transmittance" } else { "reflectance" };
            let name = format!("{side}, channel {number}");
            let estimator = match parts[3] {
                "spectral-avg" => "spectral-tracking (average)",
                "spectral-max" => "spectral-tracking (maximum)",
                _ => "spectral-mis",
            };
            let Some(row) = of(estimator, &name) else {
                // A reflectance of 0 is not a channel.
                assert!(expected.abs() < 1e-15, "{id}: {name}");
                continue;
            };
            let found = if parts[3] == "mean" { row.truth } else { row.predicted_variance };
            agrees(&id, found.expect("known"), *expected, error);
        }
    }
    assert!(count >= 30, "{count}");
}

/// In a rod that scatters forward only, the second moment of a dark hero is e^{999}/2: not a double, and not certain.
#[test]
fn what_no_number_holds_is_not_taken_for_nothing() {
    for (albedos, forward) in [("[1, 0.001]", 1.0), ("[1, 0.0026]", 1.0), ("[1, 0.001]", 0.999)] {
        let rows = rows(
            &format!(
                "title = \"rod\"\n[problem.rod]\nmedium.constant.extinction = 1\nspan = [0, 1]\nforward = {forward}\n\
                 albedos = {albedos}\nsampling.constant.value = 1.5\nestimators = [{{ hero = {{}} }}]\n"
            ),
            20_000,
        );
        for row in rows {
            assert_ne!(row.verdict, Some(Verdict::Fail), "{}", row.reason());
            let known = row.predicted_variance.unwrap_or(f64::INFINITY);
            assert!(
                !row.channel.ends_with("channel 1") || known > 1e100,
                "{}: {known}",
                row.channel
            );
        }
    }
}

#[derive(Deserialize)]
struct SlabReference {
    id: String,
    params: SlabParams,
    value: Vec<f64>,
    error: f64,
}

#[derive(Deserialize)]
struct SlabParams {
    mu0: f64,
    albedos: Vec<f64>,
}

/// Returns a slab of that optical depth, the same for any field; `more` has its phase function and its estimators.
fn slab(depth: f64, cosine: f64, albedos: &[f64], more: &str) -> String {
    format!(
        "title = \"slab\"\n[problem.slab]\nmedium.constant = {{ extinction = 0.5 }}\nspan = [0, {}]\n\
         albedos = {albedos:?}\nincidence.collimated = {{ cosine = {cosine} }}\nsampling.constant = {{ value = 0.8 }}\n{more}",
        2.0 * depth
    )
}

const TRACKED: &str = "phase.isotropic = {}\nestimators = [
    { spectral-tracking = { probabilities = \"average\" } },
    { spectral-tracking = { probabilities = \"maximum\" } }, { spectral-mis = {} } ]\n";

#[test]
fn slabs_of_coloured_scatterers_have_the_variances_of_the_references() {
    let references: Vec<SlabReference> =
        serde_json::from_str(include_str!("../data/spectral-slab.json"))
            .expect("the reference values");
    assert_eq!(references.len(), 8);
    let (mut count, mut wrong) = (0, Vec::new());
    for SlabReference { id, params, value, error } in references {
        let parts: Vec<&str> = id.split('/').collect();
        let depth = parts[1]["slab".len()..].parse().expect("a depth");
        let rows = predicted(&slab(depth, params.mu0, &params.albedos, TRACKED));
        let estimator = match parts[3] {
            "spectral-avg" => "spectral-tracking (average)",
            "spectral-max" => "spectral-tracking (maximum)",
            _ => "spectral-mis",
        };
        if value.contains(&-1.0) {
            let row = rows.iter().find(|row| row.experiment.label == estimator).expect("a row");
            let needed = "E[X²] of channel 1 is infinite from the albedo 1.4074";
            assert!(row.reason().contains(needed), "{}", row.reason());
            count += 1;
            continue;
        }
        for (channel, expected) in value.iter().enumerate() {
            let name = format!("transmittance, channel {}", channel + 1);
            let is_asked = |row: &&Row| row.experiment.label == estimator && row.channel == name;
            let row = rows.iter().find(is_asked).expect("a row");
            let found = if parts[3] == "mean" { row.truth } else { row.predicted_variance };
            let off = (found.expect("known") - expected).abs();
            println!("{id}, {name}: off {off:.1e}, printed error {error:.1e}");
            count += 1;
            if off > error {
                wrong.push(format!("{id}, {name}: {found:?} for {expected}"));
            }
        }
    }
    none(&wrong);
    assert_eq!(count, 22);
}

#[test]
fn slabs_of_coloured_scatterers_are_drawn_as_predicted() {
    let more = "phase.isotropic = {}\nestimators = [ { independent = {} }, { spectral-mis = {} },
        { spectral-tracking = { probabilities = \"average\" } },
        { spectral-tracking = { probabilities = \"maximum\" } } ]\n";
    none(&failing(&rows(&slab(0.6, 0.5, &[0.6, 0.5, 0.4], more), 400_000)));
    // With other phase functions the variance of multiple importance sampling is that of pilots.
    let sharp = more.replace("isotropic = {}", "henyey-greenstein = { g = 0.6 }");
    for row in rows(&slab(0.6, 0.5, &[0.6, 0.5, 0.4], &sharp), 800_000) {
        assert_eq!(row.verdict, Some(Verdict::Pass), "{}: {}", row.experiment.label, row.reason());
    }
}

/// No weight of history-aware tracking exceeds the number of channels, in any medium.
#[test]
fn history_aware_tracking_of_smooth_forward_rods_is_judged_by_a_bound() {
    let rows = rows(
        "title = \"smooth\"
        [problem.rod]
        light = 'emitter'
        medium = [{ exponential = { extinction = 1, rate = 1 } }, { constant.extinction = 0.7 }]
        span = [0, 2]
        albedos = [0.9, 0.3]
        forward = 1
        sampling.constant.value = 1.2
        estimators = [{ spectral-tracking.probabilities = \"history\" }]",
        400_000,
    );
    assert_eq!(rows.len(), 2);
    for row in rows {
        assert_eq!(row.verdict, Some(Verdict::Pass), "{}", row.reason());
        assert!(row.predicted_variance.is_none());
    }
}
