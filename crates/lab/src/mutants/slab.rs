//! Wrong walks through a slab.
//!
//! ```text
//! a flight of optical depth u goes u|μ| deep; a particle that is scattered by an angle θ at an azimuth φ
//! goes on with μ' = μ cos θ + √(1 − μ²) sin θ cos φ;  diffuse light has the law 2μ₀ dμ₀
//! ```

use super::scattering::{Steps, albedo_twice, backward, of};
use super::target::{
    SLAB_ADAPTIVE, SLAB_ANALOG, SLAB_DIFFUSE, SLAB_NON_TERMINATING, SLAB_WEIGHTED,
};
use super::{About, Mutant, with};
use estimators::slab::walk::draw;
use theory::ParticleRule::{Adaptive, Analog, NonTerminating, Terminating, Weighted};
use theory::problems::Slab;

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Slab>> {
    let slab = |name, bug, target, check, honest: Steps, wrong: Steps| {
        Mutant::new(About { name, bug, target, check }, with(wrong, draw), with(honest, draw))
    };
    let (analog, weighted, non_terminating) = (of(Analog), of(Weighted), of(NonTerminating));
    vec![
        slab("slab-cosine-sign", "the cosine of Henyey and Greenstein has the wrong sign: forward is backward", SLAB_ANALOG, "mean", analog, Steps { deflection: backward, ..analog }),
        slab("slab-albedo-twice", "the albedo is a chance and a weight", SLAB_NON_TERMINATING, "mean", non_terminating, Steps { odds: albedo_twice, ..non_terminating }),
        slab("slab-albedo-by-roulette-and-weight", "absorption by roulette and by weight at once", SLAB_WEIGHTED, "mean", weighted, Steps { odds: albedo_twice, ..analog }),
        slab("slab-slant-forgotten", "a slanted flight goes as deep as one straight down", SLAB_ANALOG, "lookups", analog, Steps { descent: |length, _| length, ..analog }),
        slab("slab-slant-inverted", "a flight goes u/|μ| deep", SLAB_WEIGHTED, "mean", weighted, Steps { descent: |length, cosine| length / cosine.abs(), ..weighted }),
        slab("slab-even-light", "diffuse light has the law dμ₀, without the cosine", SLAB_DIFFUSE, "mean", non_terminating, Steps { diffuse: |rng| 1.0 - rng.uniform(), ..non_terminating }),
        slab("slab-terminating-beyond", "the terminating rule where r > 2/(a + 1)", SLAB_ADAPTIVE, "mean", of(Adaptive), of(Terminating)),
    ]
}
