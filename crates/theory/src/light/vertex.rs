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
//! The weights of full MIS depend on x, see [`crate::light::contour`].
//!
//! Source: derived.

use super::contour::{Contour, TechniqueScores};
use super::{Combination, Shadow, Techniques};
use crate::prediction::raw::{HIGHEST, Powers};

/// A scattering of light that comes from one direction.
#[derive(Debug, Clone, Copy)]
pub struct Vertex {
    /// The probability to go towards the emitter.
    pub towards: f64,
    /// `n_k`, `n_0 = 1`.
    pub connected: Powers,
    /// `h_k`, `h_0` is the transmittance.
    pub hit: Powers,
    /// Bounds on the errors of `n_k` and `h_k` from weights that depend on x.
    pub errors: [Powers; 2],
}

/// Techniques, and the powers for which moments are computed.
pub struct Weights {
    techniques: Techniques,
    highest: usize,
    /// The moments of x that are needed.
    pub contour: Contour,
}

impl Weights {
    /// Weights of techniques, up to a power, for p(ω) ≤ 1 or for any p(ω).
    pub fn new(techniques: Techniques, highest: usize, is_any: bool) -> Self {
        let heuristic = match techniques.combination {
            Combination::Mis(_, heuristic) if techniques.has_nulls() => Some(heuristic),
            _ => None,
        };
        Self { techniques, highest, contour: Contour::new(heuristic, highest, is_any) }
    }

    /// Moments of a scattering, given p(ω) and the moments of x with their relative error.
    pub fn vertex(&self, towards: f64, moments: &[f64], off: f64) -> Vertex {
        let transmittance = moments[0];
        let shadow = self.techniques.shadow;
        let (mut connected, mut hit) = ([0.0; HIGHEST + 1], [0.0; HIGHEST + 1]);
        let mut errors = [[0.0; HIGHEST + 1]; 2];
        if self.techniques.has_nulls() {
            let TechniqueScores { means, errors: of_means } =
                self.contour.scores(self.contour.line(towards), towards, moments, off);
            ([connected, hit], errors) = (means, of_means);
        } else {
            let is_analytic = self.techniques.is_full() && shadow == Some(Shadow::Exact);
            let passed = if is_analytic { transmittance } else { 1.0 };
            let score = self.techniques.of_shadow_ray(towards, passed);
            let weight = self.techniques.of_hit(self.techniques.ratio(towards, transmittance));
            for k in 1..=self.highest {
                let order = i32::try_from(k).unwrap_or(i32::MAX);
                let tracked = match shadow {
                    None => 0.0,
                    Some(Shadow::Exact) if is_analytic => 1.0,
                    Some(Shadow::Exact) => transmittance.powi(order),
                    Some(Shadow::Delta) => transmittance,
                    Some(Shadow::Ratio) => moments[k - 1],
                };
                connected[k] = score.powi(order) * tracked;
                hit[k] = transmittance * weight.powi(order);
            }
        }
        (connected[0], hit[0]) = (1.0, transmittance);
        Vertex { towards, connected, hit, errors }
    }
}
