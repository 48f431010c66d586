//! Wrong ways to walk through a slab in which every channel has a medium of its own.
//!
//! ```text
//! X_λ = f_λ/Σ_h w_h f_h;  an event multiplies f_λ by 1 − r_λ, r_λ (1 − a_λ) or r_λ a_λ p_λ(cos θ),  r_λ = σ_t/σ̂;
//! a flight of the length s by e^{−σ̂_λ s}
//! ```
//!
//! Absorbed walks score nothing: the slips of the furnace that only those show are none here.

use super::spectral_furnace::{Slip, Wrong};
use super::target::{CHROMATIC_SLAB, CHROMATIC_SLAB_TRACKING};
use super::{About, Mutant, Target, with};
use estimators::chromatic::{Chromatic, draw};
use estimators::setup::heroes::Heroes;
use estimators::setup::walker::Walker;
use theory::problems::ChromaticSlab;
use theory::spectral::{Chance, Chances};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<ChromaticSlab>> {
    let of = |name, bug, target: Target, slip: Slip| {
        let about = About { name, bug, target, check: "mean" };
        let walker = if target == CHROMATIC_SLAB {
            Walker::Mis(Heroes::Uniform)
        } else {
            Walker::SpectralTracking(Chances::Fixed(Chance::Average))
        };
        let right = walker.clone();
        Mutant::new(
            about,
            with(Wrong { slip, walker }, |wrong, setup, medium, rng| ChromaticSlab::draw(wrong, wrong.by(), setup, medium, rng)),
            with(right, |right, setup, medium, rng| draw(right, true, setup, medium, rng)),
        )
    };
    vec![
        of("chromatic-slab-nulls-left-out", "null collisions are left out of all densities", CHROMATIC_SLAB, Slip::NullsLeftOut),
        of("chromatic-slab-other-majorant", "the ratio of every channel is taken with the hero's σ̂", CHROMATIC_SLAB, Slip::OtherMajorant),
        of("chromatic-slab-phase-of-hero", "every channel has the phase function of the hero", CHROMATIC_SLAB, Slip::PhaseOfHero),
        of("chromatic-slab-albedo-missing", "a scattering multiplies f by r p(cos θ), without the albedo", CHROMATIC_SLAB, Slip::AlbedoMissing),
        of("chromatic-slab-dropped", "the last channel is missing from the denominator", CHROMATIC_SLAB, Slip::Dropped),
        of("chromatic-slab-exit-missing", "the transmittance of the last flight is missing from all densities", CHROMATIC_SLAB, Slip::ExitMissing),
        of("chromatic-slab-upright", "the transmittance of a flight is that of its depth, not of its length", CHROMATIC_SLAB, Slip::Upright),
        of("chromatic-slab-tracking-nulls-left-out", "spectral tracking divides by the chance of a null collision and multiplies by nothing", CHROMATIC_SLAB_TRACKING, Slip::NullsLeftOut),
        of("chromatic-slab-tracking-albedo-missing", "spectral tracking multiplies by r p(cos θ), without the albedo, where it scatters", CHROMATIC_SLAB_TRACKING, Slip::AlbedoMissing),
    ]
}
