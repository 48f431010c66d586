//! Moments of a walk towards an emitter, and of its lookups, from two-stream equations.
//!
//! Let `U_k(x, ±)` be the k-th moment of the score of all future scatterings of a particle that flies forward or
//! backward. F is the score of a particle that has just been scattered, with its next hit, and N the score of the
//! shadow ray. Both are independent:
//!
//! ```text
//! E[F^k]         = p (h_k + U_k⁺) + (1 − p) U_k⁻,          p the probability to go on forward
//! E[(N + F)^k]   = Σ (k over j) n_j E[F^{k−j}]
//! U_k⁺' =  σ U_k⁺ − σ a E[(N + F)^k forward],   U_k⁺(L) = 0
//! U_k⁻' = −σ U_k⁻ + σ a E[(N + F)^k backward],  U_k⁻(0) = 0
//! E[X^k] = e^{−τ} + U_k⁺(0)
//! ```
//!
//! The unscattered hit scores 1. `n_k` and `h_k` are those of [`super::connections`]. No moment is infinite:
//! weights are bounded, and scattering never multiplies particles.
//!
//! Lookups: each tentative collision is one. Where it scatters, the K lookups of the shadow ray are added.
//!
//! ```text
//! exact: K = 0;   ratio: K is Poisson, E[K(K − 1)…] = Λ^k, Λ = ∫σ̂ from y to the emitter
//! delta: h_k' = σ h_k − k σ̂ ((1 − r) h_{k−1} + r δ_{k1}),  h_0 = 1: its collisions, the real one too
//! ```

use super::connections::connections;
use crate::light::vertex::Vertex;
use crate::light::{Shadow, Techniques};
use crate::prediction::raw::binomial;
use crate::rod::line::{Importance, Line};
use crate::rod::moments::lookups_with;
use crate::rod::walk::RodPoint;

/// `U_k⁺(0)`, k = 1 … highest.
pub fn scattered(line: &Line, techniques: Techniques, highest: usize) -> Option<Vec<f64>> {
    let flow = line.flow(1)?;
    let connections = connections(line, techniques, highest);
    let mut futures: Vec<Importance> = Vec::new();
    let mut result = Vec::new();
    for k in 1..=highest {
        let source = |i: usize, node: &RodPoint| {
            let of = |vertex: &Vertex| {
                let mut sum = vertex.towards * vertex.hit[k];
                for j in 1..=k {
                    let way = binomial(k, j);
                    sum += way * vertex.connected[j] * future(vertex, &futures, k - j, i);
                }
                node.scattering() * sum
            };
            connections[i].each_ref().map(of)
        };
        let future = flow.solve(&source, [0.0; 2]);
        result.push(future.entering);
        futures.push(future);
    }
    Some(result)
}

/// `E[F^m]` after a scattering at a node.
fn future(vertex: &Vertex, futures: &[Importance], m: usize, node: usize) -> f64 {
    if m == 0 {
        return 1.0;
    }
    let [plus, minus] = futures[m - 1].at(node);
    vertex.towards * (vertex.hit[m] + plus) + (1.0 - vertex.towards) * minus
}

/// Factorial moments of the number of lookups of a shadow ray, k = 0 … 4, at each node.
fn shadow_lookups(line: &Line, shadow: Option<Shadow>) -> Option<Vec<[f64; 5]>> {
    let mut result = vec![[1.0, 0.0, 0.0, 0.0, 0.0]; line.nodes().len()];
    match shadow {
        None | Some(Shadow::Exact) => {}
        Some(Shadow::Ratio) => {
            let rates: Vec<Vec<f64>> =
                line.nodes().iter().map(|node| vec![node.sampling]).collect();
            for (depth, moments) in line.to_end(&rates).iter().zip(&mut result) {
                *moments = [0, 1, 2, 3, 4].map(|k| f64::powi(depth[0], k));
            }
        }
        Some(Shadow::Delta) => {
            let mut before: Option<Importance> = None;
            for k in 1..=4_u8 {
                let source = |i: usize, node: &RodPoint| {
                    let rate = f64::from(k) * node.sampling;
                    // The first collision counts, real or null.
                    let after = |last: &Importance| node.means[0] * last.at(i)[0];
                    [rate * before.as_ref().map_or(1.0, after), 0.0]
                };
                let counted = line.straight(1)?.solve(&source, [0.0; 2]);
                for (i, moments) in result.iter_mut().enumerate() {
                    moments[usize::from(k)] = counted.at(i)[0];
                }
                before = Some(counted);
            }
        }
    }
    Some(result)
}

/// `E[M(M − 1)…(M − k + 1)]`, k = 1 … 4, of all lookups, and the mean number of those of shadow rays.
pub fn lookups(line: &Line, techniques: Techniques) -> Option<[f64; 5]> {
    let of_shadow = shadow_lookups(line, techniques.shadow)?;
    let [one, two, three, four] = lookups_with(line, &|node| of_shadow[node])?;
    let source = |i: usize, node: &RodPoint| [node.scattering() * of_shadow[i][1]; 2];
    Some([one, two, three, four, line.flow(0)?.solve(&source, [0.0; 2]).entering])
}
