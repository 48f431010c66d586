//! Moments of the score of one scattering by each technique: shadow rays and hits.
//!
//! With x = Π (1 − r) over the null collisions of the last segment, a Poisson product,
//!
//! ```text
//! E[x^k] = M_k(y) = exp(−∫ σ̂(1 − (1 − r)^k)) from y to the emitter,   M_1 = T
//!
//! combination    n_k = E[(score of the shadow ray)^k]      h_k = E[(score of a hit)^k, nothing real on the way]
//! unidirectional 0                                         T
//! next-event     p^k t_k                                   0
//! directional    (p w_nee)^k t_k                           T w_uni^k
//! analytic       (p T w_nee)^k                             T w_uni^k
//! full           E[(ρ w_nee)^k],  ρ = p x                  E[x w_uni^k]
//!
//! t_k = T^k (exact), T (delta), M_k (ratio);   p = p(ω) towards the emitter
//! ```
//!
//! The weights of full MIS depend on x. Where `0 ≤ ρ ≤ 1` they are polynomials to rounding,
//!
//! ```text
//! 1/(1 + z) = q(z) + T_n(1 − 2z)/(T_n(3)(1 + z)),   |1/(1 + z) − q(z)| ≤ 2 · 5.83⁻ⁿ on [0, 1]
//! ```
//!
//! with the Chebyshev polynomial `T_n`, so that their means are sums of `M_k`.
//!
//! Source: derived; the polynomial is that of H. Cohen, F. Rodriguez Villegas, D. Zagier, *Convergence
//! Acceleration of Alternating Series*, Experimental Mathematics 9 (2000), algorithm 1.

use super::techniques::{Combination, Densities, Shadow, Techniques};
use crate::Heuristic;
use crate::raw::{HIGHEST, Powers};
use crate::rod::grid::{Grid, Step};
use numeric::sum::Sum;

/// Terms of q in its k-th power: to rounding for variances, 1e-11 for kurtoses, 1e-5 for tails.
fn terms(k: usize) -> usize {
    match k {
        0..=2 => 22,
        3..=4 => 16,
        _ => 8,
    }
}

/// A scattering of light that comes from one direction.
#[derive(Debug, Clone, Copy)]
pub struct Vertex {
    /// The probability to go towards the emitter.
    pub towards: f64,
    /// `n_k`, `n_0 = 1`.
    pub connected: Powers,
    /// `h_k`, `h_0` is the transmittance.
    pub hit: Powers,
}

/// Scatterings in the middles of all steps: of light that goes forward, and of light that goes backward.
pub struct Connections(Vec<[Vertex; 2]>);

impl Connections {
    /// Connections on a grid that was made for a σ̂, up to a power.
    pub fn new(grid: &Grid, techniques: Techniques, highest: usize) -> Self {
        let weights = Weights::new(techniques, highest);
        let nulls = weights.nulls(grid);
        let vertices = grid.steps().iter().zip(&nulls).map(|(step, nulls)| {
            let vertex = |towards: f64| weights.vertex(towards, nulls);
            [vertex(step.forward), vertex(1.0 - step.forward)]
        });
        Self(vertices.collect())
    }

    /// Scatterings in the middle of a step, of light that goes forward and backward.
    pub fn at(&self, step: usize) -> &[Vertex; 2] {
        &self.0[step]
    }
}

/// Techniques, and the powers for which moments are computed.
pub struct Weights {
    techniques: Techniques,
    highest: usize,
    /// The highest power of x that is needed, where ρ ≤ 1.
    pub products: usize,
    /// `q^k` for k = 0 … highest, where weights depend on x.
    inverses: Vec<Vec<f64>>,
}

impl Weights {
    /// Weights of techniques, up to a power.
    pub fn new(techniques: Techniques, highest: usize) -> Self {
        let (mut inverses, mut products) = (Vec::new(), highest);
        if techniques.has_nulls() {
            inverses = (0..=highest).map(inverse).collect();
            let most = inverses.iter().map(Vec::len).max().unwrap_or_default();
            // ρ^{2k} q^k(ρ²) x at most.
            products = 2 * (highest + most) + 1;
        }
        Self { techniques, highest, products, inverses }
    }

    /// `M_k`, k = 0, 1, …, from the middles of all steps to the emitter.
    pub fn nulls(&self, grid: &Grid) -> Vec<Vec<f64>> {
        let mut depths = vec![Sum::default(); self.products];
        let of_step = |step: &Step| {
            let (mut power, mut nulls) = (1.0, vec![1.0; self.products + 1]);
            for (depth, product) in depths.iter_mut().zip(&mut nulls[1..]) {
                power *= step.means[0];
                // Half of the step lies before its middle; with midpoints beyond it the error is even in h.
                let half = 0.5 * step.width * step.sampling * (1.0 - power);
                depth.add(half);
                *product = (-depth.value()).exp();
                depth.add(half);
            }
            nulls
        };
        let mut found: Vec<Vec<f64>> = grid.steps().iter().rev().map(of_step).collect();
        found.reverse();
        found
    }

    /// Moments of a scattering, given p(ω) ≤ 1 and `M_k`.
    pub fn vertex(&self, towards: f64, nulls: &[f64]) -> Vertex {
        self.vertex_by(towards, nulls, |heuristic, k| self.full(heuristic, k, towards, nulls))
    }

    /// Moments of a scattering for any p(ω), where means of weights that depend on x are given: `[n_k, h_k]`.
    pub fn vertex_by(
        &self,
        towards: f64,
        nulls: &[f64],
        full: impl Fn(Heuristic, usize) -> [f64; 2],
    ) -> Vertex {
        let transmittance = nulls[1];
        let (mut connected, mut hit) = ([0.0; HIGHEST + 1], [0.0; HIGHEST + 1]);
        (connected[0], hit[0]) = (1.0, transmittance);
        let Techniques { shadow, combination } = self.techniques;
        for k in 1..=self.highest {
            let order = i32::try_from(k).unwrap_or(i32::MAX);
            [connected[k], hit[k]] = match (combination, shadow) {
                (Combination::Mis(Densities::Full, heuristic), Some(Shadow::Ratio)) => {
                    full(heuristic, k)
                }
                (Combination::Mis(Densities::Full, _), Some(Shadow::Exact)) => {
                    let ratio = self.techniques.ratio(towards, transmittance);
                    let score = self.techniques.of_shadow_ray(towards, transmittance);
                    let weight = self.techniques.of_hit(ratio);
                    [score.powi(order), transmittance * weight.powi(order)]
                }
                _ => {
                    let tracked = match shadow {
                        None => 0.0,
                        Some(Shadow::Exact) => transmittance.powi(order),
                        Some(Shadow::Delta) => transmittance,
                        Some(Shadow::Ratio) => nulls[k],
                    };
                    let score = self.techniques.of_shadow_ray(towards, 1.0);
                    let weight = self.techniques.of_hit(towards);
                    [score.powi(order) * tracked, transmittance * weight.powi(order)]
                }
            };
        }
        Vertex { towards, connected, hit }
    }

    /// `E[(ρ w_nee)^k]` and `E[x w_uni^k]`, with `ρ w_nee = ρ q(ρ)` or `ρ q(ρ²)`.
    fn full(&self, heuristic: Heuristic, k: usize, towards: f64, nulls: &[f64]) -> [f64; 2] {
        let (stride, of_hit) = match heuristic {
            Heuristic::Balance => (1, k),
            Heuristic::Power => (2, 2 * k),
        };
        let mean = |first: usize, more: usize| {
            let power = |n: usize| towards.powi(i32::try_from(n).unwrap_or(i32::MAX));
            let (mut factor, by) = (power(first), power(stride));
            let mut sum = Sum::default();
            for (i, coefficient) in self.inverses[k].iter().enumerate() {
                sum.add(coefficient * factor * nulls[first + stride * i + more]);
                factor *= by;
            }
            sum.value()
        };
        [mean(k, 0), mean(of_hit, 1)]
    }
}

/// The coefficients of `q^k`.
fn inverse(k: usize) -> Vec<f64> {
    let terms = terms(k);
    let n = terms as f64;
    let large = (3.0 + 8f64.sqrt()).powf(n);
    let chebyshev = 0.5 * (large + 1.0 / large);
    let (mut b, mut c) = (-1.0, -chebyshev);
    let base: Vec<f64> = (0..terms)
        .map(|i| {
            let i = i as f64;
            c = b - c;
            b *= (i + n) * (i - n) / ((i + 0.5) * (i + 1.0));
            // The algorithm is for Σ (−1)^i a_i: the signs are in c.
            c / chebyshev
        })
        .collect();
    let mut power = vec![1.0];
    for _ in 0..k {
        let mut product = vec![0.0; power.len() + base.len() - 1];
        for (i, x) in power.iter().enumerate() {
            for (j, y) in base.iter().enumerate() {
                product[i + j] += x * y;
            }
        }
        power = product;
    }
    power
}

/// The rate of scattering in a step.
pub fn scattering(step: &Step) -> f64 {
    step.sampling * step.means[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_polynomials_to_rounding() {
        for k in [1, 2, 3, 4, 8_u8] {
            let coefficients = inverse(usize::from(k));
            let n = i32::try_from(terms(usize::from(k))).expect("small");
            let rounding = f64::EPSILON * coefficients.iter().map(|c| c.abs()).sum::<f64>();
            let allowed = f64::from(k) * 2.0 * (3.0 + 8f64.sqrt()).powi(-n) + rounding;
            assert!(
                allowed < [0.0, 1e-14, 1e-13, 1e-11, 2e-11, 0.0, 0.0, 0.0, 2e-5][usize::from(k)]
            );
            for i in 0..=100 {
                let z = f64::from(i) / 100.0;
                let found = coefficients.iter().rev().fold(0.0, |sum, c| sum * z + c);
                let exact = (1.0 + z).powi(-i32::from(k));
                let off = (found - exact).abs();
                assert!(off < allowed, "{k}, {z}: {off:e}, {allowed:e}");
            }
        }
    }
}
