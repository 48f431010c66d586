//! Collisions of a walk that ends at some of them: integrals along the ray.
//!
//! Let a walk collide at the rate σ̂. It survives collisions at the rate `σ̂q` and ends at the rate `κ ≥ σ̂(1 − q)`:
//!
//! ```text
//! K(s) = ∫₀ˢ κ,   A(s) = ∫₀ˢ σ̂q
//! E[M(M − 1)…(M − k + 1)] = k ∫ σ̂ e^{−K} A^{k−1} ds,   M the number of collisions
//! ```
//!
//! The collisions that it survives are a Poisson process, independent of the one that ends it.
//!
//! Source: derived from the superposition of Poisson processes.

use numeric::quadrature::{GaussLegendre, dot};
use numeric::sum::Sum;

/// `k σ̂ e^{−K} A^{k−1}`, k = 1 … 4: integrands of the factorial moments of the number of collisions.
#[inline]
pub fn factorial_rates(sampling: f64, lost: f64, survived: f64) -> [f64; 4] {
    let alive = sampling * (-lost).exp();
    // Powers as products: a call for each is a tenth of the time of a lit slab.
    let square = survived * survived;
    [alive, 2.0 * alive * survived, 3.0 * alive * square, 4.0 * alive * (survived * square)]
}

/// Integrals over the panels that a walk has passed.
#[derive(Default)]
pub struct Survival {
    lost: Sum,
    survived: Sum,
    factorial: [Sum; 4],
}

impl Survival {
    /// Adds a panel of a length, given σ̂, κ and σ̂q at its nodes.
    pub fn add(
        &mut self,
        rule: &GaussLegendre,
        length: f64,
        [sampling, lost, survived]: [&[f64]; 3],
    ) {
        let up_to = |before: &Sum, row: &[f64], f: &[f64]| before.value() + length * dot(row, f);
        let at_node = |(i, row): (usize, &Vec<f64>)| {
            let [lost, survived] =
                [up_to(&self.lost, row, lost), up_to(&self.survived, row, survived)];
            factorial_rates(sampling[i], lost, survived)
        };
        let rates: Vec<[f64; 4]> = rule.running.iter().enumerate().map(at_node).collect();
        for (k, sum) in self.factorial.iter_mut().enumerate() {
            let terms = rates.iter().zip(&rule.weights).map(|(rates, weight)| weight * rates[k]);
            sum.add(length * terms.sum::<f64>());
        }
        self.lost.add(length * dot(&rule.weights, lost));
        self.survived.add(length * dot(&rule.weights, survived));
    }

    /// `E[M(M − 1)…(M − k + 1)]`, k = 1 … 4.
    pub fn factorial(&self) -> [f64; 4] {
        self.factorial.map(|sum| sum.value())
    }
}
