//! Techniques that share what a walk through a ball finds, and the steps of their scores.

use crate::space::shadow::Light;
use media::Majorants;
use numeric::{Lane, Mask};
use theory::lit_rod::Densities;
use theory::problems::Sphere;
use theory::single::Tracking;
use theory::sphere::Techniques;
use theory::{Heuristic, ParticleRule};

/// Vertices of the light that a walk is connected with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subpaths {
    /// Each of its scatterings with one of its own.
    Independent,
    /// All of them with the same one.
    Shared,
}

/// Techniques that share what a walk finds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sharing {
    /// The techniques and their weights.
    pub techniques: Techniques,
    /// The tracking of shadow rays; without one, ratio tracking through the σ̂ of the walk.
    pub shadow: Option<Tracking>,
    /// The connections, if there are any.
    pub subpaths: Option<Subpaths>,
}

impl Sharing {
    /// The densities of weights and their heuristic; none for next-event estimation, where nothing else finds what was
    /// scattered.
    pub fn weights(&self) -> Option<(Densities, Heuristic)> {
        match self.techniques {
            Techniques::NextEvent => None,
            Techniques::Mis(densities, heuristic) => Some((densities, heuristic)),
            Techniques::Bidirectional(heuristic) => Some((Densities::Full, heuristic)),
        }
    }

    /// Whether densities hold the probabilities of null collisions, or transmittances.
    pub fn is_full(&self) -> bool {
        self.weights().is_some_and(|(densities, _)| densities == Densities::Full)
    }

    /// The tracking of shadow rays with numbers of their own: also through one σ̂ of the walk, where the probability of all
    /// collisions of a shadow ray to be null is its tracked transmittance.
    pub fn tracking(&self, rule: ParticleRule, majorants: &Majorants) -> Option<Tracking> {
        let is_its_own = !matches!(rule, ParticleRule::NonTerminating | ParticleRule::Adaptive);
        let of_walk = majorants.single_value().filter(|_| is_its_own);
        self.shadow.or(of_walk.map(|sampling| Tracking::Ratio { sampling, control: 0.0 }))
    }
}

/// The steps that a known bug may replace.
pub trait Steps: Copy {
    /// The light of shadow rays from places, from what is right.
    #[inline(always)]
    fn light<L: Lane>(&self, sphere: &Sphere, place: [L; 3], right: Light<L>) -> Light<L> {
        let _ = (sphere, place);
        right
    }

    /// Lanes in which light that a walk meets counts beside next-event estimation, from those that are right.
    #[inline(always)]
    fn counts<M: Mask>(&self, right: M) -> M {
        right
    }

    /// The probability of a null collision, as densities of the walk have it.
    #[inline(always)]
    fn chance<L: Lane>(&self, right: L) -> L {
        right
    }

    /// The probability of null collisions with which a segment begins, from that of the one before.
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

    /// The weight of what was never scattered.
    #[inline(always)]
    fn unscattered(&self) -> f64 {
        1.0
    }

    /// The score of a shadow ray of some transmittance, but for its weight.
    #[inline(always)]
    fn lit<L: Lane>(&self, right: L, transmittance: L) -> L {
        let _ = transmittance;
        right
    }

    /// The density of a connection of two scatterings of the walk, of a squared distance.
    #[inline(always)]
    fn linked<L: Lane>(&self, right: L, square: L) -> L {
        let _ = square;
        right
    }

    /// The score of a connection, but for its weight.
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

    /// The cosine with the normal of light that leaves its surface, of a uniform number: the law of Lambert.
    #[inline(always)]
    fn cosine<L: Lane>(&self, number: L) -> L {
        number.one_minus().root()
    }
}

/// The right steps.
#[derive(Debug, Clone, Copy)]
pub struct Honest;

impl Steps for Honest {}

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
