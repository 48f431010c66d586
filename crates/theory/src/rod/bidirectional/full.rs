//! Moments of techniques with weights that depend on the whole path.
//!
//! ```text
//! E[X_s^k] = ∫ f c_s^{(1−β)k−1} (Σⱼ cⱼ^{−β})^{−k},   c₀ = c_{r+2} = 1,   y^{−k} = ∫₀^∞ z^{k−1} e^{−zy} dz/Γ(k)
//! ```
//!
//! At a fixed z the sum in the exponent becomes a product: f is a chain of flights, each with its own factor
//! `exp(−z cⱼ^{−β})`, which depends on the flight and on the turns at both of its ends. The integral over z is the
//! trapezoidal rule in ln z, with an error that falls as `e^{−π²/h}`.

use super::grid::NodeGrid;
use super::paths::Chain;
use super::{Connection, RodScene};
use crate::light::Heuristic;
use crate::prediction::raw::{HIGHEST, Powers};

/// Limits of the integral over ln z.
const RANGE: [f64; 2] = [-52.0, 3.5];
/// Terms of a segment that are smaller than this, relative to their sum, are left out.
const FAINT: f64 = 1e-18;

/// Adds `E[X_s^k]`, k = 1 … 8, of the techniques s = 0 … r + 2 of each order.
pub fn add(
    scene: &RodScene,
    (connection, heuristic): (Connection, Heuristic),
    grid: &NodeGrid,
    step: f64,
    sums: &mut [Vec<Powers>],
) {
    let mut ln_z = RANGE[0];
    while ln_z <= RANGE[1] {
        let segments = Segments { connection, heuristic, z: ln_z.exp() };
        let chain = match heuristic {
            Heuristic::Balance => Chain::new(scene, grid, &|depth, ends| {
                let [alone, connected, ..] = segments.kernels(depth, ends);
                [alone, connected]
            }),
            Heuristic::Power => {
                Chain::new(scene, grid, &|depth, ends| segments.kernels(depth, ends))
            }
        };
        let weights = weights(segments.z, step);
        chain.add(sums, |_, _| weights);
        ln_z += step;
    }
}

/// `h z^k e^{−2z}/Γ(k)`, k = 1 … 8.
fn weights(z: f64, step: f64) -> Powers {
    let mut weights = [0.0; HIGHEST + 1];
    let mut weight = step * (-2.0 * z).exp();
    for (k, entry) in (1_u32..).zip(&mut weights[1..]) {
        weight *= z;
        *entry = weight;
        weight /= f64::from(k);
    }
    weights
}

/// The segments of a path at one z.
#[derive(Clone, Copy)]
struct Segments {
    connection: Connection,
    heuristic: Heuristic,
    z: f64,
}

impl Segments {
    /// `e^{−d} E[exp(−z c^{−β})]` of a segment with ends that contribute `c/T̂`; then with the factors
    /// `c^{(1−β)k−1}`: `1/c` for β = 1, and `1/c²`, `1/c³`, … for β = 2.
    fn kernels(self, depth: f64, ends: f64) -> Powers {
        let mut sums = [0.0; HIGHEST + 1];
        // By β = 1 one kernel is that of all moments.
        let highest = if self.heuristic == Heuristic::Power { HIGHEST } else { 1 };
        let mut last = 0.0;
        for [probability, inverse] in self.connection.transmittances(depth) {
            let density = inverse / ends;
            let mut term = probability * (-self.z * self.heuristic.raised(density)).exp();
            // Terms rise to one peak and fall.
            if ends == 0.0 || term == 0.0 {
                break;
            }
            sums[0] += term;
            if self.heuristic == Heuristic::Power {
                term *= density;
            }
            for sum in &mut sums[1..=highest] {
                term *= density;
                *sum += term;
            }
            if term <= last && term <= FAINT * sums[highest] {
                break;
            }
            last = term;
        }
        sums
    }
}
