//! Moments and lookups of product estimators from their differential equations.

use super::rule::Rule;
use super::{Law, Scene};

/// Compared numbers: T, V, the central moments over T^k (k = 2, 3, 4), E[M].
pub struct Solution {
    pub mean: f64,
    pub variance: f64,
    pub relative: [f64; 3],
    pub lookups: f64,
}

/// Central moments over T^k, survival, lookups, T and V along the ray.
type State = [f64; 7];

/// Returns the right-hand sides. Central moments in units of `T^k` follow from `M_k = m_k/T^k` with
/// `dM_k/ds = λ_k M_k`, `λ_k = k σ_t − k σ_c − σ̂ (1 − E[W^k])`:
///
/// ```text
/// c₂ = M₂ − 1,  c₃ = M₃ − 3M₂ + 2,  c₄ = M₄ − 4M₃ + 6M₂ − 3
/// ```
///
/// Products have no collisions where medium and control are zero, nor anywhere if they are equal everywhere
/// (`nothing_left`).
fn slope(law: Law, nothing_left: bool, scene: &Scene, t: f64, inside: f64, y: &State) -> State {
    let (medium, mut sampling, mut control) = scene.at(t, inside);
    let (mut r, rule, killing) = match law {
        Law::Product { rule, controlled } => {
            control = if controlled { control } else { 0.0 };
            ((medium - control) / sampling, rule, 0.0)
        }
        _ => ((medium - control) / sampling, Rule::Null, control),
    };
    let is_product = matches!(law, Law::Product { .. });
    if is_product && (nothing_left || (medium == 0.0 && control == 0.0)) {
        (sampling, r) = (0.0, 0.0);
    }
    let lambda = |k: i32| {
        // A sampled control ends the walk for any k; an integrated one multiplies X.
        let integrated = if killing == 0.0 { f64::from(k) * control } else { killing };
        f64::from(k) * medium - integrated - sampling * (1.0 - rule.power(r, k))
    };
    let [c2, c3, c4, alive, _, mean, variance] = *y;
    let (m2, m3) = (1.0 + c2, 1.0 + 3.0 * c2 + c3);
    let m4 = 1.0 + 6.0 * c2 + 4.0 * c3 + c4;
    let (l2, l3, l4) = (lambda(2), lambda(3), lambda(4));
    let w = sampling * rule.introduced(r) + killing;
    [
        l2 * m2,
        l3 * m3 - 3.0 * l2 * m2,
        l4 * m4 - 4.0 * l3 * m3 + 6.0 * l2 * m2,
        -(sampling * (1.0 - rule.survival(r)) + killing) * alive,
        sampling * alive,
        -medium * mean,
        variance * (w - 2.0 * medium) + w * mean * mean,
    ]
}

pub fn solve(law: Law, scene: &Scene) -> Solution {
    let controlled = matches!(law, Law::Product { controlled: true, .. });
    let nothing_left = scene.ranges(controlled)[0] == [0.0, 0.0];
    let walk = |scale: &State, local: f64| {
        let mut y = [0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0];
        for [from, to] in scene.pieces() {
            let inside = 0.5 * (from + to);
            y = dormand_prince([from, to], y, (scale, local), |t, y| {
                slope(law, nothing_left, scene, t, inside, y)
            });
        }
        y
    };
    // A first integration finds the sizes at the end. A component that grows beyond 1 multiplies early errors, too.
    let sizes = walk(&[1e-3; 7], 1e-6).map(|y| y.abs().clamp(1e-12, 1.0));
    let [c2, c3, c4, _, lookups, mean, variance] = walk(&sizes, 1e-14);
    Solution { mean, variance, relative: [c2, c3, c4], lookups }
}

/// Integrates `y' = f(t, y)` by the pair of J. Dormand and P. Prince, *A family of embedded Runge–Kutta formulae*, J.
/// Comp. Appl. Math. 6 (1980). The error of a step stays below `local` of `y` or of `sizes`, whichever is larger.
fn dormand_prince<const N: usize>(
    [from, to]: [f64; 2],
    mut y: [f64; N],
    (sizes, local): (&[f64; N], f64),
    f: impl Fn(f64, &[f64; N]) -> [f64; N],
) -> [f64; N] {
    const C: [f64; 7] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
    const A: [[f64; 6]; 7] = [
        [0.0; 6],
        [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
        [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
        [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
        [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
        [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
    ];
    // The difference of the two orders.
    const E: [f64; 7] = [
        71.0 / 57600.0,
        0.0,
        -71.0 / 16695.0,
        71.0 / 1920.0,
        -17253.0 / 339_200.0,
        22.0 / 525.0,
        -1.0 / 40.0,
    ];
    // Kinks of a rule are passed by small steps; the error there is the step's square.
    let least = 1e-8 * (to - from);
    let mut t = from;
    let mut step = (to - from) / 64.0;
    while t < to {
        step = step.min(to - t);
        let mut k = [[0.0; N]; 7];
        let mut next = y;
        for stage in 0..7 {
            next = std::array::from_fn(|i| {
                y[i] + step * (0..stage).map(|j| A[stage][j] * k[j][i]).sum::<f64>()
            });
            k[stage] = f(t + C[stage] * step, &next);
        }
        let error = (0..N).fold(0.0f64, |worst, i| {
            let error = step * (0..7).map(|j| E[j] * k[j][i]).sum::<f64>();
            worst.max((error / sizes[i].max(next[i].abs())).abs())
        });
        if error <= local || step <= least {
            t = if step >= to - t { to } else { t + step };
            y = next;
        }
        step *= (0.9 * (local / error.max(1e-30)).powf(0.2)).clamp(0.2, 4.0);
        step = step.max(least);
    }
    y
}
