//! Wrong combinations of hits, shadow rays and connections in a ball.
//!
//! ```text
//! X = Σ f/p w,   p = 1, 1/(q Π ν), 4 d²/(a ρ² Π ν) of a hit, a shadow ray, a connection,   w = p/Σ p
//! ```

use super::target::{
    SPHERE_BIDIRECTIONAL, SPHERE_BIDIRECTIONAL_SKY, SPHERE_DIRECTIONAL, SPHERE_FULL,
    SPHERE_FULL_SKY, SPHERE_POWER, Target,
};
use super::{About, Mutant, with};
use estimators::space::Particle;
use estimators::sphere::sharing::{Link, Sharing, Steps, Subpaths};
use estimators::sphere::{Honest, Page};
use estimators::{Draw, Setup};
use media::Lookups;
use numeric::rng::Stream;
use numeric::{Lane, Mask};
use theory::lit_rod::Densities;
use theory::problems::Sphere;
use theory::single::Tracking;
use theory::sphere::Techniques;
use theory::{Heuristic, ParticleRule};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Sphere>> {
    let of = |name, bug, target: Target, page: Page, wrong: Bug| {
        Mutant::new(About { name, bug, target, check: "mean" }, with((wrong, page), draw), with((Bug::None, page), draw))
    };
    let balance = Heuristic::Balance;
    let full = Sharing { techniques: Techniques::Mis(Densities::Full, balance), shadow: None, subpaths: None };
    let particle = Particle::of(ParticleRule::Analog);
    let directional = Sharing { techniques: Techniques::Mis(Densities::Directional, balance), shadow: Some(Tracking::Delta { sampling: 2.5 }), ..full };
    let directional = Page { particle, sharing: directional };
    let power = Page { particle, sharing: Sharing { techniques: Techniques::Mis(Densities::Full, Heuristic::Power), ..full } };
    let three = Page { particle, sharing: Sharing { techniques: Techniques::Bidirectional(balance), subpaths: Some(Subpaths::Independent), ..full } };
    let full = Page { particle, sharing: full };
    vec![
        of("sphere-mis-hits-alone", "hits are not divided by p_uni + p_nee", SPHERE_DIRECTIONAL, directional, Bug::HitsAlone),
        of("sphere-mis-phase-alone", "a hit is weighted as if p_nee were 1 per steradian", SPHERE_DIRECTIONAL, directional, Bug::PhaseAlone),
        of("sphere-mis-shadow-twice", "the transmittance of a shadow ray is a weight twice", SPHERE_FULL, full, Bug::ShadowTwice),
        of("sphere-mis-averaged", "samples of both techniques are weighted, added, and divided by their number", SPHERE_FULL, full, Bug::Averaged),
        of("sphere-mis-nulls-in-one", "null collisions are left out of the density of hits only", SPHERE_FULL_SKY, full, Bug::NullsInOne),
        of("sphere-mis-nulls-of-all", "ρ does not begin anew at a scattering: null collisions of all segments are in it", SPHERE_FULL_SKY, full, Bug::NullsOfAll),
        of("sphere-mis-unscattered", "light that was never scattered is weighted as if shadow rays could find it", SPHERE_FULL_SKY, full, Bug::Unscattered),
        of("sphere-mis-two-heuristics", "hits are weighted by the balance heuristic, shadow rays by the power heuristic", SPHERE_POWER, power, Bug::TwoHeuristics),
        of("sphere-connection-without-distance", "1/d² is left out of a connection", SPHERE_BIDIRECTIONAL, three, Bug::WithoutDistance),
        of("sphere-connection-albedo-missing", "a connection leaves out the albedo at the vertex of the light", SPHERE_BIDIRECTIONAL, three, Bug::AlbedoMissing),
        of("sphere-connection-tracked-twice", "the tracked transmittance of a connection multiplies its worth twice", SPHERE_BIDIRECTIONAL, three, Bug::TrackedTwice),
        of("sphere-connection-through-light", "connections go through the black sphere", SPHERE_BIDIRECTIONAL, three, Bug::ThroughLight),
        of("sphere-connection-even-emission", "light leaves its surface in all directions alike, without the law of Lambert", SPHERE_BIDIRECTIONAL_SKY, three, Bug::EvenEmission),
        of("sphere-connection-added", "weights of hits and shadow rays do not know of connections, which are added", SPHERE_BIDIRECTIONAL_SKY, three, Bug::Added),
        of("sphere-connection-geometry-in-one", "d² is left out of the density of connections for the paths that others made", SPHERE_BIDIRECTIONAL_SKY, three, Bug::GeometryInOne),
        of("sphere-connection-nulls-missing", "null collisions are left out of the densities of what walks, from the eye and from the light", SPHERE_BIDIRECTIONAL_SKY, three, Bug::NullsInOne),
    ]
}

/// A draw of a page, by right steps or wrong ones.
fn draw(
    (steps, page): &(Bug, Page),
    setup: &Setup<Sphere>,
    _: &Lookups,
    rng: &mut Stream,
) -> Draw<[f64; 1]> {
    page.draw_for(*steps, setup, rng)
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Bug {
    None,
    HitsAlone,
    PhaseAlone,
    ShadowTwice,
    Averaged,
    NullsInOne,
    NullsOfAll,
    Unscattered,
    TwoHeuristics,
    WithoutDistance,
    AlbedoMissing,
    TrackedTwice,
    ThroughLight,
    EvenEmission,
    Added,
    GeometryInOne,
}

impl Steps for Bug {
    #[inline(always)]
    fn chance<L: Lane>(&self, right: L) -> L {
        if *self == Self::NullsInOne { right.each(1.0) } else { right }
    }

    #[inline(always)]
    fn segment<L: Lane>(&self, before: L) -> L {
        if *self == Self::NullsOfAll { before } else { before.each(1.0) }
    }

    #[inline(always)]
    fn weight<L: Lane, const N: usize>(
        &self,
        heuristic: Heuristic,
        own: usize,
        mut densities: [L; N],
    ) -> L {
        let one = densities[own].each(1.0);
        let right = heuristic.weight(own, densities);
        match self {
            Self::HitsAlone if own == 0 => one,
            Self::PhaseAlone if own == 0 => {
                densities[1] = one.each(4.0 * std::f64::consts::PI);
                heuristic.weight(0, densities)
            }
            Self::Averaged => right * 0.5,
            Self::TwoHeuristics if own == 0 => Heuristic::Balance.weight(0, densities),
            Self::Added if own < 2 => {
                densities.iter_mut().skip(2).for_each(|connection| *connection = one.each(0.0));
                heuristic.weight(own, densities)
            }
            _ => right,
        }
    }

    #[inline(always)]
    fn unscattered(&self) -> f64 {
        if *self == Self::Unscattered { 0.5 } else { 1.0 }
    }

    #[inline(always)]
    fn lit<L: Lane>(&self, right: L, transmittance: L) -> L {
        if *self == Self::ShadowTwice { right * transmittance } else { right }
    }

    #[inline(always)]
    fn linked<L: Lane>(&self, right: L, square: L) -> L {
        if *self == Self::GeometryInOne { right / square } else { right }
    }

    #[inline(always)]
    fn connected<L: Lane>(&self, right: L, link: &Link<L>) -> L {
        match self {
            Self::WithoutDistance => right * link.distance * link.distance,
            Self::AlbedoMissing => right / link.albedo,
            Self::TrackedTwice => right * link.transmittance,
            _ => right,
        }
    }

    #[inline(always)]
    fn is_hidden<M: Mask>(&self, right: M) -> M {
        if *self == Self::ThroughLight { right & !right } else { right }
    }

    #[inline(always)]
    fn cosine<L: Lane>(&self, number: L) -> L {
        if *self == Self::EvenEmission { number.one_minus() } else { Honest.cosine(number) }
    }
}
