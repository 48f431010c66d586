//! A path from the light to the sensor: its vertices, what lies between them, and its weights by the techniques that make it.

use numeric::Lane;
use theory::problems::bidirectional_rod::HIGHEST_ORDER;
use theory::rod::bidirectional::{Combination, quotient};

/// Paths from the light to the sensor, all by the same technique.
#[derive(Clone, Copy)]
pub struct Path<L: Lane> {
    /// Numbers of scatterings, r.
    pub order: usize,
    /// Numbers of vertices made from the light, s.
    pub light: usize,
    /// Light, scatterings and sensor, as distances along the ray.
    pub at: [L; HIGHEST_ORDER + 2],
    /// Lanes with a segment that goes forward, by segment.
    pub is_forward: [L::Mask; HIGHEST_ORDER + 1],
    /// `T̂ⱼ` of each segment.
    pub transmittance: [L; HIGHEST_ORDER + 1],
    /// ρ at each scattering, from the first on.
    pub phase: [L; HIGHEST_ORDER],
    /// a.
    pub albedo: f64,
}

impl<L: Lane> Path<L> {
    /// Memory for paths, with the albedo a.
    #[inline(always)]
    pub fn new(one: L, albedo: f64) -> Self {
        Self {
            order: 0,
            light: 0,
            at: [one; HIGHEST_ORDER + 2],
            is_forward: [one.at_most(one); HIGHEST_ORDER + 1],
            transmittance: [one; HIGHEST_ORDER + 1],
            phase: [one; HIGHEST_ORDER],
            albedo,
        }
    }

    /// `c_s = f/p_s` of a technique for these paths.
    #[inline(always)]
    pub fn quotient(&self, s: usize) -> L {
        quotient(
            s,
            self.order,
            #[inline(always)]
            |j| self.transmittance[j],
            #[inline(always)]
            |i| self.phase[i - 1] * self.albedo,
        )
    }

    /// Factor of [`Self::quotient`] that the directions make: a and T̂ are left out.
    #[inline(always)]
    fn directions(&self, s: usize) -> L {
        quotient(
            s,
            self.order,
            #[inline(always)]
            |_| self.at[0].each(1.0),
            #[inline(always)]
            |i| self.phase[i - 1],
        )
    }

    /// The weight of the technique that made the paths.
    #[inline(always)]
    pub fn weight(&self, combination: Combination) -> L {
        let (light, order) = (self.light, self.order);
        match combination {
            Combination::Full(heuristic) => heuristic.share(
                light,
                order,
                #[inline(always)]
                |s| self.quotient(s),
            ),
            Combination::Directional(heuristic) => heuristic.share(
                light,
                order,
                #[inline(always)]
                |s| self.directions(s),
            ),
            Combination::Technique(_) => self.at[0].each(1.0),
        }
    }
}
