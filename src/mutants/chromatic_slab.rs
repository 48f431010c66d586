//! Wrong ways to walk through a slab in which every channel has a medium of its own.
//!
//! ```text
//! X_λ = f_λ/Σ_h w_h f_h;  an event multiplies f_λ by 1 − r_λ, r_λ (1 − a_λ) or r_λ a_λ p_λ(cos θ),  r_λ = σ_t/σ̂;
//! a flight of the length s by e^{−σ̂_λ s}
//! ```
//!
//! Absorbed walks score nothing: the slips of the furnace that only those show are none here.

use super::spectral_furnace::{Slip, Wrong};
use super::target::CHROMATIC_SLAB;
use super::{About, Mutant, with};
use crate::estimators::chromatic_slab::page::balanced;
use crate::estimators::chromatic_slab::spectral_mis::SpectralMis;
use crate::estimators::chromatic_slab::walk::Steps;
use crate::estimators::spectral_furnace::page::WEIGHING;
use crate::problems::ChromaticSlab;
use crate::setup::heroes::Heroes;

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<ChromaticSlab>> {
    let of = |name, bug, slip: Slip| {
        let about = About { name, bug, target: CHROMATIC_SLAB, check: "mean" };
        let right = SpectralMis { heroes: Heroes::Uniform };
        Mutant::new(
            about,
            with(Wrong(slip), |wrong, setup, medium, rng| balanced(wrong, (&Heroes::Uniform, wrong.weighing()), setup, medium, rng)),
            with(right, |right, setup, medium, rng| balanced(right, (&right.heroes, WEIGHING), setup, medium, rng)),
        )
    };
    vec![
        of("chromatic-slab-nulls-left-out", "null collisions are left out of all densities", Slip::NullsLeftOut),
        of("chromatic-slab-other-majorant", "the ratio of every channel is taken with the hero's σ̂", Slip::OtherMajorant),
        of("chromatic-slab-phase-of-hero", "every channel has the phase function of the hero", Slip::PhaseOfHero),
        of("chromatic-slab-albedo-missing", "a scattering multiplies f by r p(cos θ), without the albedo", Slip::AlbedoMissing),
        of("chromatic-slab-dropped", "the last channel is missing from the denominator", Slip::Dropped),
        of("chromatic-slab-exit-missing", "the transmittance of the last flight is missing from all densities", Slip::ExitMissing),
        of("chromatic-slab-upright", "the transmittance of a flight is that of its depth, not of its length", Slip::Upright),
    ]
}

impl Steps for Wrong {
    fn flown(&self, depth: f64, cosine: f64) -> f64 {
        if self.0 == Slip::Upright { depth.abs() } else { depth / cosine }
    }
}
