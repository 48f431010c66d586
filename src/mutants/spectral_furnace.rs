//! Wrong ways to walk through a furnace in several channels at once.
//!
//! ```text
//! X_λ = f_λ/Σ_h w_h f_h;  an event multiplies f_λ by 1 − r_λ, r_λ (1 − a_λ) or r_λ a_λ p_λ(cos θ),  r_λ = σ_t/σ̂
//! ```
//!
//! Most of them keep `Σ w_λ X_λ = 1`: only the channels apart tell.

use super::target::SPECTRAL_FURNACE;
use super::{About, Mutant, with};
use crate::estimators::spectral_furnace::page::{WEIGHING, balanced};
use crate::estimators::spectral_furnace::spectral_mis::SpectralMis;
use crate::estimators::spectral_furnace::walk::Steps;
use crate::kernels::hero::{LastPiece, Weighing};
use crate::problems::SpectralFurnace;
use crate::setup::heroes::Heroes;
use crate::theory::particle::Event;

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<SpectralFurnace>> {
    let of = |name, bug, slip: Slip| {
        let about = About { name, bug, target: SPECTRAL_FURNACE, check: "mean" };
        let right = SpectralMis { heroes: Heroes::Uniform };
        Mutant::new(
            about,
            with(Wrong(slip), |wrong, setup, _, rng| balanced(wrong, (&Heroes::Uniform, wrong.weighing()), setup, rng)),
            with(right, |right, setup, _, rng| balanced(right, (&right.heroes, WEIGHING), setup, rng)),
        )
    };
    vec![
        of("spectral-furnace-nulls-left-out", "null collisions are left out of all densities", Slip::NullsLeftOut),
        of("spectral-furnace-other-majorant", "the ratio of every channel is taken with the hero's σ̂", Slip::OtherMajorant),
        of("spectral-furnace-phase-of-hero", "every channel has the phase function of the hero", Slip::PhaseOfHero),
        of("spectral-furnace-albedo-missing", "a scattering multiplies f by r p(cos θ), without the albedo", Slip::AlbedoMissing),
        of("spectral-furnace-absorbed-whole", "an absorption multiplies f by r, not by r (1 − a)", Slip::AbsorbedWhole),
        of("spectral-furnace-dropped", "the last channel is missing from the denominator", Slip::Dropped),
        of("spectral-furnace-exit-missing", "the transmittance of the last flight is missing from all densities", Slip::ExitMissing),
    ]
}

/// What goes wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Slip {
    NullsLeftOut,
    OtherMajorant,
    PhaseOfHero,
    AlbedoMissing,
    AbsorbedWhole,
    Dropped,
    ExitMissing,
    /// Of walks through a slab.
    Upright,
}

/// The steps of a walk with one slip.
pub(super) struct Wrong(pub(super) Slip);

impl Wrong {
    pub(super) fn weighing(&self) -> Weighing {
        match self.0 {
            Slip::Dropped => Weighing { missing: 1, ..WEIGHING },
            Slip::ExitMissing => Weighing { last_piece: LastPiece::Nowhere, ..WEIGHING },
            _ => WEIGHING,
        }
    }
}

impl Steps for Wrong {
    fn factor(&self, event: Event, ratio: f64, albedo: f64, density: f64) -> f64 {
        match (self.0, event) {
            (Slip::NullsLeftOut, Event::Transmitted) => 1.0,
            (Slip::AlbedoMissing, Event::Scattered) => ratio * density,
            (Slip::AbsorbedWhole, Event::Absorbed) => ratio,
            (_, Event::Transmitted) => 1.0 - ratio,
            (_, Event::Scattered) => ratio * albedo * density,
            (_, Event::Absorbed) => ratio * (1.0 - albedo),
        }
    }

    fn majorant_of(&self, channel: usize, hero: usize) -> usize {
        if self.0 == Slip::OtherMajorant { hero } else { channel }
    }

    fn phase_of(&self, channel: usize, hero: usize) -> usize {
        if self.0 == Slip::PhaseOfHero { hero } else { channel }
    }
}
