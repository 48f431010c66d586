//! Optical depths of catalogued fields against 30-digit quadrature: see `tests/data/README.md`.

use crate::common::{differs, none};

/// Field and ray of `data/optical-depths.json` as in a case.
struct Line {
    id: &'static str,
    text: &'static str,
    /// The reference is `(τ − shift) · scale`: bare noise has both signs, a field does not.
    shift: f64,
    scale: f64,
}

const fn depth(id: &'static str, text: &'static str) -> Line {
    Line { id, text, shift: 0.0, scale: 1.0 }
}

/// Returns `σ_t = ½ + fbm/2B` on a ray of length 12.5; `b` is B.
const fn noise(id: &'static str, text: &'static str, b: f64) -> Line {
    Line { id, text, shift: 6.25, scale: 2.0 * b }
}

const LINES: &[Line] = &[
    depth(
        "tau_eq21/A",
        "volume.eq21 = {}
         ray = { origin = [0, 0, -5], direction = [0, 0, 1], length = 40 }",
    ),
    depth(
        "tau_eq21/B",
        "volume.eq21 = {}
         ray = { origin = [3, -2, -20], direction = [-2, 3, 29], length = 60 }",
    ),
    depth(
        "tau_eq21/C",
        "volume.eq21 = {}
         ray = { origin = [-20, 14, 12], direction = [1, -1, 0], length = 60 }",
    ),
    depth(
        "tau_pwconst",
        "medium.piecewise-constant = { breaks = [0, 1, 2.5, 4], values = [0.2, 1.5, 0.4] }
         span = [0.3, 3.7]",
    ),
    depth(
        "tau_pwlin",
        "medium.piecewise-linear = { knots = [0, 1, 2.5, 4], values = [0.2, 1.5, 0.4, 0.9] }
         span = [0.3, 3.7]",
    ),
    depth(
        "tau_exp",
        "volume.exponential = { extinction = 2, rate = 0.35 }
         ray = { origin = [1, -2, 0.5], direction = [1, 2, 2], length = 7 }",
    ),
    depth(
        "tau_gauss",
        "volume.gaussian = { peak = 3, centre = [0.7, 0.1, 2], width = 0.6 }
         ray = { origin = [1, -2, 0.5], direction = [1, 2, 2], length = 7 }",
    ),
    noise(
        "noise_int/quintic",
        "volume.noise = { extinction = 1, octaves = 1 }
         ray = { origin = [0.3, 0.7, -0.45], direction = [0.6, 0.5, 0.37], length = 12.5 }",
        1.036_353_811_211_802_7,
    ),
    noise(
        "noise_int/cubic",
        "volume.noise = { extinction = 1, octaves = 1, fade = \"cubic\" }
         ray = { origin = [0.3, 0.7, -0.45], direction = [0.6, 0.5, 0.37], length = 12.5 }",
        1.044_905_189_609_877,
    ),
    noise(
        "fbm_int/4",
        "volume.noise = { extinction = 1, octaves = 4 }
         ray = { origin = [0.3, 0.7, -0.45], direction = [0.6, 0.5, 0.37], length = 12.5 }",
        1.036_353_811_211_802_7 * 1.875,
    ),
    depth(
        "trilinear/1",
        "volume.grid = { random = { size = [5, 5, 5], seed = 7 }, samples = \"vertices\",
                         bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }
         ray = { origin = [-1, 0.4, 0.9], direction = [4.2, 2.2, 1.9], length = 20 }",
    ),
    depth(
        "trilinear/3",
        "volume.grid = { random = { size = [5, 5, 5], seed = 7 }, samples = \"vertices\",
                         bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }
         ray = { origin = [0.25, 1.5, -3], direction = [0, 0, 1], length = 20 }",
    ),
];

fn reference(id: &str) -> f64 {
    let file = include_str!("../data/optical-depths.json");
    let entries: Vec<serde_json::Value> = serde_json::from_str(file).expect("JSON");
    let entry = entries.iter().find(|entry| entry["id"] == id);
    entry.and_then(|entry| entry["value"].as_f64()).unwrap_or_else(|| panic!("no {id}"))
}

#[test]
fn optical_depths_agree_with_quadrature_in_30_digits() {
    let differences = LINES.iter().filter_map(|line| {
        let medium = crate::common::medium(line.text);
        let depth = medium.optical_depth(medium.span());
        let exact = reference(line.id) / line.scale + line.shift;
        let rounding = f64::EPSILON * exact;
        assert!(
            (depth.value - exact).abs() <= depth.error + rounding,
            "{}: {} is not within its own error bound {:e} of {exact}",
            line.id,
            depth.value,
            depth.error
        );
        // Eight units in the last place, of the depth or of the argument of a ray that grazes a field.
        differs(line.id, depth.value, exact, 8.0 * f64::EPSILON / exact.min(1.0))
    });
    none(&differences.collect::<Vec<_>>());
}

#[test]
fn every_reference_is_used() {
    let file = include_str!("../data/optical-depths.json");
    assert_eq!(file.matches("\"id\"").count(), LINES.len());
}
