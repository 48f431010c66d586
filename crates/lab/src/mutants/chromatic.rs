//! Wrong ways to walk through a furnace or a slab in which every channel has a medium of its own.
//!
//! ```text
//! X_λ = f_λ/Σ_h w_h f_h;  an event multiplies f_λ by 1 − r_λ, r_λ (1 − a_λ) or r_λ a_λ p_λ(cos θ),  r_λ = σ_t/σ̂;
//! a flight of the length s by e^{−σ̂_λ s}
//! ```
//!
//! Most of them keep `Σ w_λ X_λ = 1` in a furnace: they show only in single channels. Walks that are absorbed in a slab
//! score nothing, and show no bug.

use super::{Mutant, MutantRow, On, family, on, one_by_one};
use estimators::chromatic::{Chromatic, Right, WEIGHING, WalkEvents, WalkerWeights};
use estimators::setup::heroes::Heroes;
use estimators::setup::walker::Walker;
use estimators::walks::hero::{LastPiece, Weighing};
use gate::CheckId;
use numeric::Lane;
use theory::collisions::particle::Event;
use theory::colours::{Chance, Chances};
use theory::problems::{ChromaticSlab, SpectralFurnace};

/// Function that makes a walker.
type Make = fn() -> Walker;

/// Three channels of different σ_t, σ̂, albedo and phase function.
const FURNACE: On<Make> = on("furnace/spectral-known-bugs", 1, || Walker::Mis(Heroes::Uniform));
/// All channels together.
const FURNACE_TRACKING: On<Make> = on("furnace/spectral-like-colours", 4, || {
    Walker::SpectralTracking(Chances::Fixed(Chance::Maximum))
});
/// Three channels of different σ_t, σ̂, albedo and phase function, light from aslant.
const SLAB: On<Make> = on("slab/chromatic-three-colours", 1, || Walker::Mis(Heroes::Uniform));
/// All channels together.
const SLAB_TRACKING: On<Make> = on("slab/chromatic-like-colours", 3, || {
    Walker::SpectralTracking(Chances::Fixed(Chance::Average))
});

#[derive(Debug, Clone, Copy, PartialEq)]
enum Bug {
    None,
    NullsLeftOut,
    OtherMajorant,
    PhaseOfHero,
    AlbedoMissing,
    AbsorbedWhole,
    Dropped,
    ExitMissing,
    Upright,
}

#[rustfmt::skip] // one mutant, one entry
const IN_FURNACE: &[MutantRow<Make, Bug>] = &[
    ("spectral-furnace-nulls-left-out", "null collisions are left out of all densities", FURNACE, CheckId::Mean, Bug::NullsLeftOut),
    ("spectral-furnace-other-majorant", "the ratio of every channel is taken with the hero's σ̂", FURNACE, CheckId::Mean, Bug::OtherMajorant),
    ("spectral-furnace-phase-of-hero", "every channel has the phase function of the hero", FURNACE, CheckId::Mean, Bug::PhaseOfHero),
    ("spectral-furnace-albedo-missing", "a scattering multiplies f by r p(cos θ), without the albedo", FURNACE, CheckId::Mean, Bug::AlbedoMissing),
    ("spectral-furnace-absorbed-whole", "an absorption multiplies f by r, not by r (1 − a)", FURNACE, CheckId::Mean, Bug::AbsorbedWhole),
    ("spectral-furnace-dropped", "the last channel is missing from the denominator", FURNACE, CheckId::Mean, Bug::Dropped),
    ("spectral-furnace-exit-missing", "the transmittance of the last flight is missing from all densities", FURNACE, CheckId::Mean, Bug::ExitMissing),
    ("spectral-furnace-tracking-nulls-left-out", "spectral tracking divides by the chance of a null collision and multiplies by nothing", FURNACE_TRACKING, CheckId::Mean, Bug::NullsLeftOut),
    ("spectral-furnace-tracking-albedo-missing", "spectral tracking multiplies by r p(cos θ), without the albedo, where it scatters", FURNACE_TRACKING, CheckId::Mean, Bug::AlbedoMissing),
];

#[rustfmt::skip] // one mutant, one entry
const IN_SLAB: &[MutantRow<Make, Bug>] = &[
    ("chromatic-slab-nulls-left-out", "null collisions are left out of all densities", SLAB, CheckId::Mean, Bug::NullsLeftOut),
    ("chromatic-slab-other-majorant", "the ratio of every channel is taken with the hero's σ̂", SLAB, CheckId::Mean, Bug::OtherMajorant),
    ("chromatic-slab-phase-of-hero", "every channel has the phase function of the hero", SLAB, CheckId::Mean, Bug::PhaseOfHero),
    ("chromatic-slab-albedo-missing", "a scattering multiplies f by r p(cos θ), without the albedo", SLAB, CheckId::Mean, Bug::AlbedoMissing),
    ("chromatic-slab-dropped", "the last channel is missing from the denominator", SLAB, CheckId::Mean, Bug::Dropped),
    ("chromatic-slab-exit-missing", "the transmittance of the last flight is missing from all densities", SLAB, CheckId::Mean, Bug::ExitMissing),
    ("chromatic-slab-upright", "the transmittance of a flight is that of its depth, not of its length", SLAB, CheckId::Mean, Bug::Upright),
    ("chromatic-slab-tracking-nulls-left-out", "spectral tracking divides by the chance of a null collision and multiplies by nothing", SLAB_TRACKING, CheckId::Mean, Bug::NullsLeftOut),
    ("chromatic-slab-tracking-albedo-missing", "spectral tracking multiplies by r p(cos θ), without the albedo, where it scatters", SLAB_TRACKING, CheckId::Mean, Bug::AlbedoMissing),
];

/// Mutants in a furnace.
pub fn in_furnace() -> Vec<Mutant<SpectralFurnace>> {
    mutants(IN_FURNACE)
}

/// Mutants in a slab.
pub fn in_slab() -> Vec<Mutant<ChromaticSlab>> {
    mutants(IN_SLAB)
}

fn mutants<P: Chromatic>(lines: &[MutantRow<Make, Bug>]) -> Vec<Mutant<P>> {
    family(lines, &Bug::None, |make, &bug| {
        let wrong = Wrong { bug, walker: make() };
        one_by_one(move |setup, medium, random| P::draw(&wrong, wrong.by(), setup, medium, random))
    })
}

/// The steps of a walk, of which a bug makes one wrong.
struct Wrong {
    bug: Bug,
    walker: Walker,
}

impl Wrong {
    fn by(&self) -> WalkerWeights<'_> {
        let weighing = match self.bug {
            Bug::Dropped => Weighing { missing: 1, ..WEIGHING },
            Bug::ExitMissing => Weighing { last_piece: LastPiece::Nowhere, ..WEIGHING },
            _ => WEIGHING,
        };
        WalkerWeights { walker: &self.walker, weighing, scores_all: true }
    }
}

impl WalkEvents for &Wrong {
    fn factor<L: Lane>(&self, event: Event, ratio: L, albedo: L, density: L) -> L {
        match (self.bug, event) {
            (Bug::NullsLeftOut, Event::Transmitted) => ratio.each(1.0),
            (Bug::AlbedoMissing, Event::Scattered) => ratio * density,
            (Bug::AbsorbedWhole, Event::Absorbed) => ratio,
            _ => Right.factor(event, ratio, albedo, density),
        }
    }

    fn has_heros_majorant(&self) -> bool {
        self.bug == Bug::OtherMajorant
    }

    fn has_heros_phase(&self) -> bool {
        self.bug == Bug::PhaseOfHero
    }

    fn flown<L: Lane>(&self, depth: L, cosine: L) -> L {
        if self.bug == Bug::Upright { depth.size() } else { depth / cosine }
    }
}
