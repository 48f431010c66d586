//! The two techniques that find an emitter, and the weights of their samples.
//!
//! A path ends with a real scattering at y, where light is scattered into the direction of the emitter with
//! probability p(ω), and a last segment. The null collisions of the segment have the factor `Π (1 − r)`,
//! `r = σ_t/σ̂`. Unidirectional tracking samples the direction and must have no real collision on the segment.
//! Next-event estimation sets the direction and tracks a shadow ray. The pdfs of the same path differ by
//!
//! ```text
//! ρ = p_uni/p_nee = p(ω) Π (1 − r)      over the null-scattering path (full)
//! ρ = p(ω) T(y, L)                      with analytic transmittances in both
//! ρ = p(ω)                              by the directions alone (directional)
//! ```
//!
//! A hit scores its weight, a shadow ray of transmittance t scores `p(ω) t` times its weight:
//!
//! | combination | weight of a hit | weight of a shadow ray |
//! |---|---|---|
//! | unidirectional | 1 | – |
//! | next-event | 0 | 1 |
//! | balance heuristic | ρ/(1 + ρ) | 1/(1 + ρ) |
//! | power heuristic | ρ²/(1 + ρ²) | 1/(1 + ρ²) |
//!
//! With both samples added the weights sum to 1 and every combination is unbiased. Next-event estimation cannot
//! find an emitter that the camera sees unscattered: such a hit always scores 1.
//!
//! Source: E. Veach, L. Guibas, *Optimally Combining Sampling Techniques for Monte Carlo Rendering*, SIGGRAPH
//! 1995; B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*,
//! ACM Transactions on Graphics 38 (2019), section 5.3 and Algorithm 2.

use crate::light::Heuristic;
use numeric::Lane;

/// Estimate of the transmittance of a shadow ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shadow {
    /// `exp(−τ)`, without lookups.
    Exact,
    /// Delta tracking: 1 where there is no real collision, else 0.
    Delta,
    /// Ratio tracking: `Π (1 − r)`.
    Ratio,
}

/// Part of a path's pdf on which a weight depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Densities {
    /// The directions alone; null vertices are left out.
    Directional,
    /// The whole null-scattering path.
    Full,
}

/// Combination of the samples of both techniques.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Combination {
    /// Hits alone.
    Unidirectional,
    /// Shadow rays, and the unscattered hits.
    NextEvent,
    /// Both, by multiple importance sampling.
    Mis(Densities, Heuristic),
}

/// Techniques that find an emitter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Techniques {
    /// Tracking of shadow rays, if there are any.
    pub shadow: Option<Shadow>,
    /// Weights of samples.
    pub combination: Combination,
}

impl Techniques {
    /// ρ just after a real scattering: p(ω), times the transmittance where both densities include it.
    #[inline(always)]
    pub fn ratio<L: Lane>(self, phase: L, transmittance: L) -> L {
        let is_analytic = self.shadow == Some(Shadow::Exact) && self.is_full();
        if is_analytic { phase * transmittance } else { phase }
    }

    /// True if null collisions are part of ρ.
    #[inline(always)]
    pub fn has_nulls(self) -> bool {
        self.shadow == Some(Shadow::Ratio) && self.is_full()
    }

    /// True if hits after a scattering score.
    #[inline(always)]
    pub fn has_hits(self) -> bool {
        self.combination != Combination::NextEvent
    }

    /// True if weights depend on the densities of the whole path.
    #[inline(always)]
    pub fn is_full(self) -> bool {
        matches!(self.combination, Combination::Mis(Densities::Full, _))
    }

    /// The weight of a hit after a scattering.
    #[inline(always)]
    pub fn of_hit<L: Lane>(self, ratio: L) -> L {
        match self.combination {
            Combination::Unidirectional => ratio.each(1.0),
            Combination::NextEvent => ratio.each(0.0),
            Combination::Mis(_, heuristic) => {
                let raised = heuristic.raised(ratio);
                raised / (raised + 1.0)
            }
        }
    }

    /// Score of a shadow ray, given its transmittance.
    #[inline(always)]
    pub fn of_shadow_ray<L: Lane>(self, phase: L, transmittance: L) -> L {
        let result = phase * transmittance;
        let ratio = if self.is_full() { result } else { phase };
        match self.combination {
            Combination::Unidirectional => result.each(0.0),
            Combination::NextEvent => result,
            Combination::Mis(_, heuristic) => result / (heuristic.raised(ratio) + 1.0),
        }
    }
}
