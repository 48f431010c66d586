//! The rod against numbers from another arithmetic: see `tests/data/README.md`.

mod common;

use common::{differs, none, predicted, row};
use serde_json::Value;
use trueflight::harness::record::Row;

/// A value of `rod-values.json`.
fn reference(id: &str) -> Vec<Value> {
    let all: Vec<Value> = serde_json::from_str(include_str!("data/rod-values.json")).expect("JSON");
    all.into_iter().filter(|entry| entry["id"] == id).collect()
}

fn numbers(entry: &Value) -> Vec<f64> {
    let list = entry["value"].as_array().expect("a list");
    list.iter().map(|x| x.as_f64().unwrap_or(f64::INFINITY)).collect()
}

/// The truths of a rod, channel by channel.
fn truths(text: &str) -> Vec<(String, f64)> {
    let rows = predicted(&format!(
        "title = \"a rod\"\n[problem.rod]\n{text}\nestimators = [{{ non-terminating = {{}} }}]"
    ));
    rows.iter()
        .map(|row| (row.channel.clone(), row.truth.unwrap_or_else(|| panic!("{}", row.reason))))
        .collect()
}

#[test]
fn closed_forms_are_met() {
    let mut wrong = Vec::new();
    for entry in reference("rod_RT") {
        let [a, pf, tau] =
            ["a", "pf", "tau"].map(|key| entry["params"][key].as_f64().expect("a number"));
        let expected = numbers(&entry);
        // Only the optical depth matters: one value, and layers with a gap.
        let media = [
            format!("medium.constant.extinction = {tau}\nspan = [0, 1]"),
            format!(
                "medium.piecewise-constant = {{ breaks = [1, 2, 3, 5], values = [{}, 0, {}] }}\nspan = [1, 5]",
                0.5 * tau,
                0.25 * tau
            ),
        ];
        for medium in media {
            let found = truths(&format!(
                "{medium}\nalbedo = {a}\nforward = {pf}\nsampling.constant.value = 4"
            ));
            for ((name, value), expected) in found.iter().zip(&expected) {
                wrong.extend(differs(
                    &format!("{name} of {}", entry["params"]),
                    *value,
                    *expected,
                    1e-14,
                ));
            }
        }
    }
    none(&wrong);
}

#[test]
fn varying_albedo_is_met() {
    let lines = "medium.piecewise-linear = { knots = [0, 3], values = [0.5, 3.5] }\nspan = [0, 3]\nalbedo.piecewise-linear = { knots = [0, 3], values = [0.95, 0.35] }\nforward = 0.7\nsampling.constant.value = 4";
    let steps = "medium.piecewise-constant = { breaks = [0, 1, 3, 3.5], values = [0.5, 1.2, 2] }\nspan = [0, 3.5]\nalbedo.piecewise-constant = { breaks = [0, 1, 3, 3.5], values = [0.9, 0.4, 1] }\nforward = 0.6\nsampling.constant.value = 3";
    let mirrored = "medium.piecewise-constant = { breaks = [0, 0.5, 2.5, 3.5], values = [2, 1.2, 0.5] }\nspan = [0, 3.5]\nalbedo.piecewise-constant = { breaks = [0, 0.5, 2.5, 3.5], values = [1, 0.4, 0.9] }\nforward = 0.6\nsampling.constant.value = 3";
    let lin = numbers(&reference("rod_lin")[0]);
    let pw = numbers(&reference("rod_pw")[0]);
    let mut wrong = Vec::new();
    let cases = [(lines, [lin[0], lin[1]]), (steps, [pw[0], pw[1]]), (mirrored, [pw[2], pw[1]])];
    for (text, expected) in cases {
        for ((name, value), expected) in truths(text).iter().zip(expected) {
            wrong.extend(differs(name, *value, expected, 5e-12));
        }
    }
    // The third number of rod_lin is the reflectance from the other end.
    let back = "medium.piecewise-linear = { knots = [0, 3], values = [3.5, 0.5] }\nspan = [0, 3]\nalbedo.piecewise-linear = { knots = [0, 3], values = [0.35, 0.95] }\nforward = 0.7\nsampling.constant.value = 4";
    wrong.extend(differs("from the right", truths(back)[0].1, lin[2], 5e-12));
    none(&wrong);
}

#[test]
fn orders_of_scattering_are_met() {
    let found = truths(
        "medium.constant.extinction = 2\nspan = [0, 1]\nalbedo = 1\nforward = 0.75\norders = 6\nsampling.constant.value = 3",
    );
    let (r, t) = (numbers(&reference("rod_orders_R")[0]), numbers(&reference("rod_orders_T")[0]));
    let mut wrong = Vec::new();
    for order in 0..=6 {
        for (word, expected) in [("reflectance", &r), ("transmittance", &t)] {
            let name = format!("{word}, order {order}");
            match found.iter().find(|(channel, _)| *channel == name) {
                // The reference is an FFT on |a| = 1, exact to 1e-16 absolute.
                Some((_, value)) => wrong.extend(differs(&name, *value, expected[order], 1e-13)),
                None => assert!(order == 0 && word == "reflectance"),
            }
        }
    }
    none(&wrong);
}

fn raw(row: &Row, k: usize) -> f64 {
    let (m, [m2, m3, m4]) = (row.truth.expect("a truth"), row.relative_moments);
    let (m2, m3, m4) =
        (m2.unwrap_or(f64::INFINITY), m3.unwrap_or(f64::INFINITY), m4.unwrap_or(f64::INFINITY));
    if k == 2 { m * m * (1.0 + m2) } else { m.powi(4) * (m4 + 4.0 * m3 + 6.0 * m2 + 1.0) }
}

#[test]
fn moments_of_every_rule_are_met() {
    let mut wrong = Vec::new();
    for (rule, word) in [("term", "terminating"), ("non", "non-terminating"), ("adapt", "adaptive")]
    {
        for sampling in ["0.5", "0.6", "0.8", "1.0", "1.5"] {
            let Some(entry) = reference(&format!("spm_rod_eq21/{rule}/{sampling}")).pop() else {
                continue;
            };
            let expected = numbers(&entry);
            let rows = predicted(&format!(
                "title = \"a rod\"\n[problem.rod]\nvolume.eq21 = {{}}\nray = {{ origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }}\nalbedo = 0.7\nsampling.constant.value = {sampling}\nestimators = [{{ {word} = {{}} }}]"
            ));
            assert!(rows.len() == 2, "{}", rows[0].reason);
            let found = [
                raw(&rows[0], 2),
                raw(&rows[1], 2),
                raw(&rows[0], 4),
                raw(&rows[1], 4),
                row(&rows, word).predicted_lookups.expect("lookups"),
            ];
            for (name, (found, expected)) in
                ["m2R", "m2T", "m4R", "m4T", "E[n]"].iter().zip(found.iter().zip(expected))
            {
                wrong.extend(differs(
                    &format!("{name} of {word} at {sampling}"),
                    *found,
                    expected,
                    5e-11,
                ));
            }
        }
    }
    none(&wrong);
}
