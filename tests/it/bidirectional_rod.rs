//! Bidirectional path tracing in a rod: shares and second moments of every technique against numbers from another
//! arithmetic, see `tests/data/README.md`, and predictions against draws.

use crate::common::{none, row, rows};
use serde::Deserialize;
use trueflight::gate::CheckId;
use trueflight::numeric::Known;
use trueflight::record::Verdict;
use trueflight::theory::Prediction;
use trueflight::theory::light::Heuristic;
use trueflight::theory::rod::bidirectional::{
    Combination, Connection, DrawRules, RodScene, predict,
};

#[derive(Deserialize)]
struct Reference {
    id: String,
    sensor: String,
    order: usize,
    what: String,
    value: Vec<f64>,
    error: f64,
}

fn values() -> Vec<Reference> {
    serde_json::from_str(include_str!("../data/bidirectional-rod.json")).expect("values")
}

/// Returns the rod of the reference values: τ = 2, a = 0.9, `p_f` = 0.75.
fn scene(sensor: &str, order: usize) -> RodScene {
    let depth = Known::exact(2.0);
    let is_transmitted = sensor == "T";
    RodScene { depth, albedo: 0.9, forward: 0.75, is_transmitted, orders: order..=order }
}

fn predicted(scene: &RodScene, combination: Combination, connection: Connection) -> Prediction {
    predict(
        scene,
        &DrawRules { combination, connection, is_shared: false, has_shares: true },
        None,
        true,
    )
}

const FULL: Combination = Combination::Full(Heuristic::Balance);
const DIRECTIONAL: Combination = Combination::Directional(Heuristic::Balance);

/// Returns the shares, then the second moments, of every technique.
fn shares(prediction: &Prediction) -> Vec<f64> {
    let techniques = &prediction.channels[..prediction.channels.len() - 1];
    let share = techniques.iter().map(|channel| channel.truth.value);
    let second = techniques.iter().map(|channel| {
        let variance = channel.moments.expect("moments").variance();
        variance + channel.truth.value.powi(2)
    });
    share.chain(second).collect()
}

/// Returns the variance of the sum.
fn variance(prediction: &Prediction) -> f64 {
    let sum = prediction.channels.last().expect("a sum");
    assert_eq!(sum.name, "sum");
    sum.moments.expect("moments").variance()
}

#[test]
fn every_reference_value_is_met() {
    let mut wrong = Vec::new();
    for Reference { id, sensor, order, what, value, error } in values() {
        let scene = scene(&sensor, order);
        let of = |combination| predicted(&scene, combination, Connection::Exact);
        let found = match what.as_str() {
            "full" => shares(&of(FULL)),
            "C_s" => shares(&of(FULL))[..order + 3].to_vec(),
            "V_s" => shares(&of(FULL))[order + 3..].to_vec(),
            "directional" => shares(&of(DIRECTIONAL)),
            "variance" => vec![variance(&of(FULL)), variance(&of(DIRECTIONAL))],
            "total" => vec![of(FULL).channels.last().expect("a sum").truth.value],
            "M2_s" => {
                let alone = |s| of(Combination::Technique(s)).channels[0].clone();
                let second = |s| {
                    let channel = alone(s);
                    let moments = channel.moments.expect("moments");
                    moments.variance() + channel.truth.value.powi(2)
                };
                (0..order + 3).map(second).collect()
            }
            other => panic!("{other}"),
        };
        assert_eq!(found.len(), value.len(), "{id}");
        for (i, (found, value)) in found.iter().zip(&value).enumerate() {
            let off = (found - value).abs();
            if off > error {
                wrong.push(format!("{id}, {i}: {found:e} against {value:e}, off by {off:.1e}"));
            }
        }
    }
    none(&wrong);
}

/// Lookups of a single technique in a rod where `σ̂/σ_t` is `ratio`.
#[derive(Debug, Deserialize)]
struct Lookups {
    depth: f64,
    albedo: f64,
    forward: f64,
    ratio: f64,
    sensor: String,
    order: usize,
    s: usize,
    connection: String,
    mean: f64,
    variance: f64,
    kurtosis: f64,
}

#[test]
fn lookups_of_single_techniques_are_those_of_the_references() {
    let references: Vec<Lookups> =
        serde_json::from_str(include_str!("../data/bidirectional-lookups.json"))
            .expect("the references");
    assert_eq!(references.len(), 72);
    for reference in references {
        let scene = RodScene {
            depth: Known::exact(reference.depth),
            albedo: reference.albedo,
            forward: reference.forward,
            is_transmitted: reference.sensor == "T",
            orders: reference.order..=reference.order,
        };
        let share = 1.0 / reference.ratio;
        let connection = match reference.connection.as_str() {
            "ratio" => Connection::Ratio(share),
            _ => Connection::Exact,
        };
        let combination = Combination::Technique(reference.s);
        let rules = DrawRules { combination, connection, is_shared: false, has_shares: true };
        let found = predict(&scene, &rules, Some(share), true).lookups.expect("one ratio");
        let pairs = [
            (found.mean, reference.mean),
            (found.variance, reference.variance),
            (found.kurtosis, reference.kurtosis),
        ];
        for (found, expected) in pairs {
            assert!((found - expected).abs() <= 1e-9 * expected.max(1.0), "{found}: {reference:?}");
        }
    }
}

#[test]
fn stated_errors_hold() {
    // Two resolutions of the same integrals, and numbers from elsewhere, agree within the stated errors.
    for Reference { id, sensor, order, what, value, error } in values() {
        if what != "full" {
            continue;
        }
        let prediction = predicted(&scene(&sensor, order), FULL, Connection::Exact);
        for (channel, share) in prediction.channels.iter().zip(&value[..order + 3]) {
            let off = (channel.truth.value - share).abs();
            assert!(off <= channel.truth.error + error, "{id}: {off:e}");
            assert!(channel.truth.error < 1e-13, "{id}: {:e}", channel.truth.error);
            let moments = channel.moments.expect("moments");
            assert!(moments.error < 1e-9, "{id}: {:e}", moments.error);
        }
    }
}

/// Returns every combination of techniques with every connection.
fn combinations() -> Vec<(Combination, Connection)> {
    let heuristics = [Heuristic::Balance, Heuristic::Power];
    let combined = heuristics
        .into_iter()
        .flat_map(|heuristic| [Combination::Full(heuristic), Combination::Directional(heuristic)]);
    let alone = (0..3).map(Combination::Technique);
    let connections = [Connection::Exact, Connection::Ratio(0.4), Connection::Ratio(1.0)];
    let all = combined
        .chain(alone)
        .flat_map(|combination| connections.map(|connection| (combination, connection)));
    all.collect()
}

#[test]
fn shares_add_up_to_the_light_of_their_order() {
    let mut wrong = Vec::new();
    for is_transmitted in [true, false] {
        for forward in [0.0, 0.3, 1.0] {
            let orders = 2..=2;
            let depth = Known::exact(1.7);
            let scene = RodScene { depth, albedo: 0.8, forward, is_transmitted, orders };
            let alone = predicted(&scene, Combination::Technique(0), Connection::Exact);
            let truth = alone.channels[0].truth.value;
            for (combination, connection) in combinations() {
                let found = predicted(&scene, combination, connection);
                let whole = found.channels.last().expect("a channel").truth;
                if (whole.value - truth).abs() > whole.error + 1e-13 * truth {
                    wrong.push(format!(
                        "{combination:?}, {connection:?}: {} and {truth}",
                        whole.value
                    ));
                }
            }
        }
    }
    none(&wrong);
}

#[test]
fn optimal_weights_are_better_than_any_technique() {
    // Veach's bound: the second moment of the balance heuristic is the smallest of all weights.
    for (sensor, order) in [("T", 0), ("T", 2), ("R", 1), ("R", 3)] {
        let scene = scene(sensor, order);
        let second = |combination| {
            let prediction = predicted(&scene, combination, Connection::Exact);
            shares(&prediction)[order + 3..].iter().sum::<f64>()
        };
        let best = second(FULL);
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            assert!(second(Combination::Directional(heuristic)) > best);
        }
        assert!(second(Combination::Full(Heuristic::Power)) > best);
    }
}

#[test]
fn a_tight_majorant_needs_no_null_vertices() {
    // σ̂ = σ_t: a tracked connection is 1 or 0, and weights do not depend on distances.
    let scene = scene("T", 2);
    let found = predicted(&scene, FULL, Connection::Ratio(1.0));
    let directional = predicted(&scene, DIRECTIONAL, Connection::Ratio(1.0));
    assert_eq!(found.channels.len(), directional.channels.len());
    // With a large σ̂, many null vertices make a tracked connection nearly exact.
    let exact = predicted(&scene, FULL, Connection::Exact);
    let many = predicted(&scene, FULL, Connection::Ratio(1e-2));
    for (exact, many) in exact.channels.iter().zip(&many.channels) {
        assert!((many.truth.value / exact.truth.value - 1.0).abs() < 5e-3, "{}", exact.name);
    }
}

/// Returns a rod with estimators.
fn rod(sensor: &str, orders: usize, lowest: usize, estimators: &str) -> String {
    format!(
        "title = \"a rod\"
        [problem.rod]
        medium.piecewise-constant = {{ breaks = [0, 1, 2, 2.6], values = [0.6, 0, 1.5] }}
        span = [0, 2.6]
        albedo = 0.85
        forward = 0.35
        sensor = \"{sensor}\"
        orders = {orders}
        lowest = {lowest}
        sampling.piecewise-constant = {{ breaks = [0, 1, 2, 2.6], values = [0.9, 0, 2.25] }}
        estimators = [{estimators}]"
    )
}

const ALL: &str = "
    { full-mis = {} }, { full-mis.connection = \"ratio\" },
    { full-mis.heuristic = \"power\" }, { full-mis = { heuristic = \"power\", connection = \"ratio\" } },
    { directional-mis = {} }, { directional-mis.connection = \"ratio\" },
    { directional-mis = { heuristic = \"power\" } },
    { technique.light-vertices = 0 }, { technique.light-vertices = 1 },
    { technique = { light-vertices = 2, connection = \"ratio\" } },
    { technique.light-vertices = 3 }";

#[test]
fn draws_meet_means_variances_covariances_and_lookups() {
    for (sensor, orders, lowest) in [("transmitted", 2, 1), ("reflected", 3, 1)] {
        let found = rows(&rod(sensor, orders, lowest, ALL), 100_000);
        let mut wrong = Vec::new();
        for row in &found {
            let is_sound = !matches!(row.verdict, Some(Verdict::Fail | Verdict::Refused) | None);
            if !is_sound {
                wrong.push(format!("{} {}: {}", row.experiment.label, row.channel, row.reason()));
            }
            let asked = |check: CheckId| row.findings().any(|finding| finding.check == check);
            assert!(
                asked(CheckId::Mean) && asked(CheckId::Variance),
                "{} {}",
                row.experiment.label,
                row.channel
            );
        }
        let asked = |check: CheckId| {
            found.iter().flat_map(trueflight::record::Row::findings).any(|f| f.check == check)
        };
        assert!(asked(CheckId::Lookups) && asked(CheckId::Covariance));
        none(&wrong);
    }
}

#[test]
fn shared_subpaths_have_the_same_shares_and_an_unknown_variance_of_their_sum() {
    let estimators = "{ full-mis = {} }, { full-mis.subpaths = \"shared\" },
        { directional-mis = { subpaths = \"shared\", connection = \"ratio\" } }";
    for sensor in ["transmitted", "reflected"] {
        let found = rows(&rod(sensor, 3, 1, estimators), 100_000);
        let of = |name: &str| {
            found.iter().filter(|row| row.experiment.label == name).collect::<Vec<_>>()
        };
        let alone = of("full-mis (exact connection)");
        let shared = of("full-mis (exact connection, shared subpaths)");
        assert_eq!(alone.len(), shared.len());
        for (alone, shared) in alone.iter().zip(&shared) {
            let is_sum = shared.channel == "sum";
            assert_eq!(alone.truth, shared.truth);
            assert_eq!(shared.predicted_variance.is_none(), is_sum);
            let asked = |check: CheckId| shared.findings().any(|f| f.check == check);
            assert!(
                asked(CheckId::Mean)
                    && !asked(CheckId::Covariance)
                    && asked(CheckId::Variance) != is_sum
            );
        }
        // Two walks in all, not two for each technique.
        assert!(shared[0].experiment.lookups_per_draw < alone[0].experiment.lookups_per_draw);
        let wrong = found
            .iter()
            .filter(|row| matches!(row.verdict, Some(Verdict::Fail | Verdict::Refused) | None));
        none(
            &wrong
                .map(|row| format!("{} {}: {}", row.experiment.label, row.channel, row.reason()))
                .collect::<Vec<_>>(),
        );
    }
}

#[test]
fn without_shares_the_sum_is_what_it_was() {
    let estimators = "{ full-mis = {} }, { technique.light-vertices = 1 }, \
        { directional-mis.subpaths = \"shared\" }";
    let text = rod("transmitted", 2, 1, estimators);
    let all = rows(&text, 50_000);
    let sums = rows(&text.replace("lowest = 1", "lowest = 1\nshares = false"), 50_000);
    let all: Vec<_> = all.iter().filter(|row| row.channel == "sum").collect();
    assert_eq!((all.len(), sums.len()), (3, 3));
    for (all, sum) in all.iter().zip(&sums) {
        assert_eq!((all.truth, all.predicted_variance), (sum.truth, sum.predicted_variance));
        assert!(sum.channel.is_empty() && sum.verdict == Some(Verdict::Pass), "{}", sum.reason());
    }
}

#[test]
fn orders_without_light_are_refused() {
    let of = |sensor, orders, albedo: &str, forward: &str| {
        let text = rod(sensor, orders, orders - 1, "{ full-mis.subpaths = \"shared\" }");
        let text = text.replace("albedo = 0.85", albedo).replace("forward = 0.35", forward);
        rows(&text.replace("lowest =", "shares = false\nlowest ="), 2000)
    };
    for (sensor, orders, albedo, forward, dark) in [
        ("transmitted", 2, "albedo = 0", "forward = 0.5", 1),
        ("transmitted", 2, "albedo = 0.5", "forward = 0", 1),
        ("reflected", 3, "albedo = 0.5", "forward = 0", 2),
        ("reflected", 3, "albedo = 0.5", "forward = 1", 2),
    ] {
        let reason = &of(sensor, orders, albedo, forward)[0].reason();
        let words = format!("leave none to r = {dark}");
        assert!(reason.contains(&words), "{sensor}, {albedo}, {forward}: {reason}");
    }
    assert_ne!(
        of("transmitted", 2, "albedo = 0.5", "forward = 1")[0].verdict,
        Some(Verdict::Refused)
    );
}

#[test]
fn unscattered_light_of_one_technique_does_not_vary() {
    let text = rod("transmitted", 0, 0, "{ technique.light-vertices = 1 }, { full-mis = {} }");
    let found = rows(&text, 20_000);
    let alone = row(&found, "technique");
    assert_eq!(alone.verdict, Some(Verdict::Pass));
    assert_eq!(alone.predicted_variance, Some(0.0));
}
