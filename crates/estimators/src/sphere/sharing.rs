//! Techniques that share the vertices of a walk through a ball, and the steps of their scores.

use crate::space::shadow::VisibleLight;
use media::Majorants;
use numeric::{Lane, Mask};
use theory::ParticleRule;
use theory::light::{Densities, Heuristic};
use theory::problems::Sphere;
use theory::single::Tracking;
use theory::space::sphere::Techniques;

/// Vertices of the light that a walk is connected with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subpaths {
    /// A vertex of its own for each scattering of the walk.
    Independent,
    /// One vertex for all scatterings.
    Shared,
}

/// Techniques that share the vertices of a walk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharedTechniques {
    /// The techniques and their weights.
    pub techniques: Techniques,
    /// The tracking of shadow rays; without one, ratio tracking through the σ̂ of the walk.
    pub shadow: Option<Tracking>,
    /// The connections, if there are any.
    pub subpaths: Option<Subpaths>,
}

impl SharedTechniques {
    /// The densities of weights and their heuristic; `None` for next-event estimation, the only technique for
    /// scattered light.
    pub fn weights(&self) -> Option<(Densities, Heuristic)> {
        match self.techniques {
            Techniques::NextEvent => None,
            Techniques::Mis(densities, heuristic) => Some((densities, heuristic)),
            Techniques::Bidirectional(heuristic) => Some((Densities::Full, heuristic)),
        }
    }

    /// True if densities include the probabilities of null collisions, or transmittances.
    pub fn is_full(&self) -> bool {
        self.weights().is_some_and(|(densities, _)| densities == Densities::Full)
    }

    /// Tracking of shadow rays with random numbers of their own. The default is ratio tracking through the walk's
    /// σ̂, if σ̂ has one value and the rule passes a collision with probability `1 − σ_t/σ̂`. The tracked
    /// transmittance is then the probability that all collisions of the shadow ray are null.
    pub fn tracking(&self, rule: ParticleRule, majorants: &Majorants) -> Option<Tracking> {
        let is_its_own = !matches!(rule, ParticleRule::NonTerminating | ParticleRule::Adaptive);
        let of_walk = majorants.single_value().filter(|_| is_its_own);
        self.shadow.or(of_walk.map(|sampling| Tracking::Ratio { sampling, control: 0.0 }))
    }
}

/// Events of a walk, each of which a known bug may replace. Scores, weights and connections are computed within one step, so
/// that a walk around this one could not change them.
pub trait WalkEvents: Copy {
    /// The light of shadow rays from places, given the right one.
    #[inline(always)]
    fn light<L: Lane>(
        &self,
        sphere: &Sphere,
        place: [L; 3],
        right: VisibleLight<L>,
    ) -> VisibleLight<L> {
        let _ = (sphere, place);
        right
    }

    /// Lanes in which light that a walk hits counts beside next-event estimation, given the right ones.
    #[inline(always)]
    fn counts<M: Mask>(&self, right: M) -> M {
        right
    }

    /// The probability of a null collision in the densities of the walk.
    #[inline(always)]
    fn probability<L: Lane>(&self, right: L) -> L {
        right
    }

    /// The initial probability of the null collisions of a segment, given that of the segment before.
    #[inline(always)]
    fn segment<L: Lane>(&self, before: L) -> L {
        before.each(1.0)
    }

    /// The weight of a hit, a shadow ray or a connection: 0, 1 or 2. Densities of connections may be left out.
    #[inline(always)]
    fn weight<L: Lane, const N: usize>(
        &self,
        heuristic: Heuristic,
        own: usize,
        densities: [L; N],
    ) -> L {
        heuristic.weight(own, densities)
    }

    /// The weight of unscattered light.
    #[inline(always)]
    fn unscattered(&self) -> f64 {
        1.0
    }

    /// The unweighted score of a shadow ray with a transmittance.
    #[inline(always)]
    fn lit<L: Lane>(&self, right: L, transmittance: L) -> L {
        let _ = transmittance;
        right
    }

    /// The density of a connection of two scatterings of the walk, given their squared distance.
    #[inline(always)]
    fn linked<L: Lane>(&self, right: L, square: L) -> L {
        let _ = square;
        right
    }

    /// The unweighted score of a connection.
    #[inline(always)]
    fn connected<L: Lane>(&self, right: L, link: &Link<L>) -> L {
        let _ = link;
        right
    }

    /// Lanes in which the black sphere is between the ends of a connection.
    #[inline(always)]
    fn is_hidden<M: Mask>(&self, right: M) -> M {
        right
    }

    /// The cosine with the normal of light that leaves its surface, from a uniform number: Lambert's law.
    #[inline(always)]
    fn cosine<L: Lane>(&self, number: L) -> L {
        number.one_minus().root()
    }
}

/// The right steps.
#[derive(Debug, Clone, Copy)]
pub struct Correct;

impl WalkEvents for Correct {}

/// Connections.
#[derive(Debug, Clone, Copy)]
pub struct Link<L> {
    /// d.
    pub distance: L,
    /// a at the vertex of the light.
    pub albedo: L,
    /// T̂.
    pub transmittance: L,
}
