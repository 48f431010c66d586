//! Next-flight and unidirectional MIS from their Volterra equations.

use super::ode::Solution;
use super::{Law, Scene};

/// Returns `E[F^k](0)`, k = 1 … 4, of next-flight or unidirectional MIS, on a grid of n steps per piece.
///
/// `F = G + A` with A the remaining weight: `A_k(x) = ∫ σ̄ e^{−σ̄(y−x)} ρ(y)^k m_k(y) dy`. The kernel is exponential,
/// so that the trapezoid sum at x follows from that at x + h.
fn trapezoid(law: Law, scene: &Scene, sampling: f64, n: usize) -> [f64; 4] {
    const CHOOSE: [[f64; 5]; 5] = [
        [1.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 1.0, 0.0, 0.0, 0.0],
        [1.0, 2.0, 1.0, 0.0, 0.0],
        [1.0, 3.0, 3.0, 1.0, 0.0],
        [1.0, 4.0, 6.0, 4.0, 1.0],
    ];
    // E[F^k] from the moments of the remaining weight; G is v, or u with 2u at the end of the walk.
    let moment = |k: usize, v: f64, a: &[f64; 5]| {
        let direct = if law == Law::NextFlight { v } else { v / (1.0 + v) };
        let mixed = |j: usize| CHOOSE[k][j] * power(direct, k - j) * a[j];
        let on = (1..=k).map(mixed).sum::<f64>();
        let whole = power(direct, k);
        if law == Law::NextFlight {
            whole + on
        } else {
            // With probability v the flight passes the end: (2u)^k, and no weight remains.
            v * power(2.0, k) * whole + (1.0 - v) * whole + on
        }
    };
    let mut a = [0.0; 5];
    for [from, to] in scene.pieces().into_iter().rev() {
        let (step, inside) = ((to - from) / n as f64, 0.5 * (from + to));
        let decay = (-sampling * step).exp();
        let rho = |i: usize| 1.0 - (scene.medium.value)(from + step * i as f64, inside) / sampling;
        let v = |i: usize| (-sampling * (scene.length - from - step * i as f64)).exp();
        for i in (0..n).rev() {
            let (v_far, v_near) = (v(i + 1), v(i));
            let (rho_far, rho_near) = (rho(i + 1), rho(i));
            let far = a;
            for k in 1..=4 {
                let half = 0.5 * step * sampling;
                let beyond = power(rho_far, k) * moment(k, v_far, &far);
                // m_k(x) holds A_k(x) itself, linearly: solve for it.
                a[k] = 0.0;
                let known = moment(k, v_near, &a);
                let weight = half * power(rho_near, k);
                let sum = decay * far[k] + half * decay * beyond + weight * known;
                a[k] = sum / (1.0 - weight);
            }
        }
    }
    let start = (-sampling * scene.length).exp();
    std::array::from_fn(|k| moment(k + 1, start, &a))
}

/// Extrapolates the trapezoid rule by Richardson's method: the error is even in the step.
pub fn volterra(law: Law, scene: &Scene, sampling: f64) -> Solution {
    let mut table: Vec<[f64; 4]> =
        (0..6).map(|level| trapezoid(law, scene, sampling, 40 << level)).collect();
    let mut factor = 4.0;
    while table.len() > 1 {
        let finer = table.windows(2).map(|pair| {
            std::array::from_fn(|k| (factor * pair[1][k] - pair[0][k]) / (factor - 1.0))
        });
        table = finer.collect();
        factor *= 4.0;
    }
    let raw = table[0];
    let mean = raw[0];
    let [m2, m3, m4] = [1, 2, 3].map(|i| raw[i] / power(mean, i + 1));
    let relative = [m2 - 1.0, m3 - 3.0 * m2 + 2.0, m4 - 4.0 * m3 + 6.0 * m2 - 3.0];
    let lookups = sampling * scene.length;
    Solution { mean, variance: relative[0] * mean * mean, relative, lookups }
}

fn power(x: f64, k: usize) -> f64 {
    std::iter::repeat_n(x, k).product()
}
