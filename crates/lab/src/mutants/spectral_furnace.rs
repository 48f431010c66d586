//! Wrong ways to walk through a furnace in several channels at once.
//!
//! ```text
//! X_λ = f_λ/Σ_h w_h f_h;  an event multiplies f_λ by 1 − r_λ, r_λ (1 − a_λ) or r_λ a_λ p_λ(cos θ),  r_λ = σ_t/σ̂
//! ```
//!
//! Most of them keep `Σ w_λ X_λ = 1`: only the channels apart tell.

use super::target::{SPECTRAL_FURNACE, SPECTRAL_FURNACE_TRACKING};
use super::{About, Mutant, Target, with};
use estimators::chromatic::{By, Chromatic, Right, Steps, WEIGHING, draw};
use estimators::setup::heroes::Heroes;
use estimators::setup::walker::Walker;
use estimators::walks::hero::{LastPiece, Weighing};
use numeric::Lane;
use theory::particle::Event;
use theory::problems::SpectralFurnace;
use theory::spectral::{Chance, Chances};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<SpectralFurnace>> {
    let of = |name, bug, target: Target, slip: Slip| {
        let about = About { name, bug, target, check: "mean" };
        let walker = if target == SPECTRAL_FURNACE {
            Walker::Mis(Heroes::Uniform)
        } else {
            Walker::SpectralTracking(Chances::Fixed(Chance::Maximum))
        };
        let right = walker.clone();
        Mutant::new(
            about,
            with(Wrong { slip, walker }, |wrong, setup, medium, rng| SpectralFurnace::draw(wrong, wrong.by(), setup, medium, rng)),
            with(right, |right, setup, medium, rng| draw(right, true, setup, medium, rng)),
        )
    };
    vec![
        of("spectral-furnace-nulls-left-out", "null collisions are left out of all densities", SPECTRAL_FURNACE, Slip::NullsLeftOut),
        of("spectral-furnace-other-majorant", "the ratio of every channel is taken with the hero's σ̂", SPECTRAL_FURNACE, Slip::OtherMajorant),
        of("spectral-furnace-phase-of-hero", "every channel has the phase function of the hero", SPECTRAL_FURNACE, Slip::PhaseOfHero),
        of("spectral-furnace-albedo-missing", "a scattering multiplies f by r p(cos θ), without the albedo", SPECTRAL_FURNACE, Slip::AlbedoMissing),
        of("spectral-furnace-absorbed-whole", "an absorption multiplies f by r, not by r (1 − a)", SPECTRAL_FURNACE, Slip::AbsorbedWhole),
        of("spectral-furnace-dropped", "the last channel is missing from the denominator", SPECTRAL_FURNACE, Slip::Dropped),
        of("spectral-furnace-exit-missing", "the transmittance of the last flight is missing from all densities", SPECTRAL_FURNACE, Slip::ExitMissing),
        of("spectral-furnace-tracking-nulls-left-out", "spectral tracking divides by the chance of a null collision and multiplies by nothing", SPECTRAL_FURNACE_TRACKING, Slip::NullsLeftOut),
        of("spectral-furnace-tracking-albedo-missing", "spectral tracking multiplies by r p(cos θ), without the albedo, where it scatters", SPECTRAL_FURNACE_TRACKING, Slip::AlbedoMissing),
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
pub(super) struct Wrong {
    pub(super) slip: Slip,
    pub(super) walker: Walker,
}

impl Wrong {
    pub(super) fn by(&self) -> By<'_> {
        let weighing = match self.slip {
            Slip::Dropped => Weighing { missing: 1, ..WEIGHING },
            Slip::ExitMissing => Weighing { last_piece: LastPiece::Nowhere, ..WEIGHING },
            _ => WEIGHING,
        };
        By { walker: &self.walker, weighing, scores_all: true }
    }
}

impl Steps for &Wrong {
    fn factor<L: Lane>(&self, event: Event, ratio: L, albedo: L, density: L) -> L {
        match (self.slip, event) {
            (Slip::NullsLeftOut, Event::Transmitted) => ratio.each(1.0),
            (Slip::AlbedoMissing, Event::Scattered) => ratio * density,
            (Slip::AbsorbedWhole, Event::Absorbed) => ratio,
            _ => Right.factor(event, ratio, albedo, density),
        }
    }

    fn has_heros_majorant(&self) -> bool {
        self.slip == Slip::OtherMajorant
    }

    fn has_heros_phase(&self) -> bool {
        self.slip == Slip::PhaseOfHero
    }

    fn flown<L: Lane>(&self, depth: L, cosine: L) -> L {
        if self.slip == Slip::Upright { depth.size() } else { depth / cosine }
    }
}
