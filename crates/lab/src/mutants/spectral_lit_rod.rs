//! Wrong ways to look for an emitter in several channels at once.
//!
//! ```text
//! X_λ = f_λ/Σ_h w_h (p_uni,h + p_nee,h),   f_λ = p_uni,λ = q_λ p_λ(ω) Π (1 − r_λ),  p_nee,λ = q_λ
//! ```
//!
//! Several are errors of Algorithms 1 and 2 of B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral
//! formulation of light transport*, ACM Transactions on Graphics 38 (2019), as printed, or ways to read them. A run of
//! `cases/rod/spectral-lit-as-printed.toml` shows the bias of the printed ones.

use super::{DrawFunction, Mutant, MutantRow, On, family, on, one_by_one};
use estimators::setup::heroes::Heroes;
use estimators::spectral_lit_rod::as_printed::{AsPrinted, Error};
use estimators::spectral_lit_rod::events::{PathTechnique, WalkEvents};
use estimators::spectral_lit_rod::walk::draw;
use estimators::walks::hero::{LastPiece, Weighing};
use gate::CheckId;
use numeric::Lane;
use theory::problems::SpectralLitRod;

/// True if shadow rays are cast.
type Casts = bool;

/// Three channels of different σ_t, σ̂, albedo and `p_f`, a σ̂ that touches its σ_t, hits alone.
const HITS: On<Casts> = on("rod/spectral-lit-three-colours", 1, false);
/// Three channels as of `HITS`, by hits and shadow rays.
const FULL: On<Casts> = on("rod/spectral-lit-three-colours", 2, true);

#[derive(Debug, Clone, Copy, PartialEq)]
enum Bug {
    None,
    Printed(Error),
    ExitMissing,
    AlbedoTwice,
    PhaseOfHero,
    OtherMajorant,
    Dropped,
    NotReset,
    NullsInOne,
    HeroAnew,
    UnscatteredWeighted,
}

#[rustfmt::skip] // one mutant, one entry
const LINES: &[MutantRow<Casts, Bug>] = &[
    ("spectral-lit-last-piece", "Algorithm 2, line 9: f and both densities lack the transmittance of the last piece", FULL, CheckId::Mean, Bug::Printed(Error::LastPiece)),
    ("spectral-lit-averaged", "Algorithm 2, line 9: the densities are averaged over 2N techniques, and both samples are added", FULL, CheckId::Mean, Bug::Printed(Error::Average)),
    ("spectral-lit-hits-alone", "Algorithm 1 beside shadow rays: hits are divided by p_uni, not by p_uni + p_nee", FULL, CheckId::Mean, Bug::Printed(Error::HitsAlone)),
    ("spectral-lit-one-phase", "Algorithm 1, line 14, and Algorithm 2, lines 3 and 5: the phase function is that of the hero in all channels", FULL, CheckId::Mean, Bug::Printed(Error::OnePhase)),
    ("spectral-lit-as-printed", "Algorithms 1 and 2 with all errors as printed, and an exit", FULL, CheckId::Mean, Bug::Printed(Error::All)),
    ("spectral-lit-exit-missing", "Algorithm 1: f has the transmittance of the flight that leaves, and p has not", HITS, CheckId::Mean, Bug::ExitMissing),
    ("spectral-lit-albedo-twice", "Algorithm 1, line 12: what f has of the event is multiplied in once more", HITS, CheckId::Mean, Bug::AlbedoTwice),
    ("spectral-lit-phase-of-hero", "Algorithm 1, line 14: neither f nor p has the phase function of its channel", HITS, CheckId::Mean, Bug::PhaseOfHero),
    ("spectral-lit-other-majorant", "Algorithm 1, line 8: the chances are those of the hero's σ_t in another channel's σ̂", HITS, CheckId::Mean, Bug::OtherMajorant),
    ("spectral-lit-dropped", "the last channel is missing from the denominator", HITS, CheckId::Mean, Bug::Dropped),
    ("spectral-lit-not-reset", "p_nee is not reset at a real scattering", FULL, CheckId::Mean, Bug::NotReset),
    ("spectral-lit-nulls-in-one", "null collisions of shadow rays are left out of p_uni only", FULL, CheckId::Mean, Bug::NullsInOne),
    ("spectral-lit-hero-anew", "every shadow ray has a hero of its own", FULL, CheckId::Mean, Bug::HeroAnew),
    ("spectral-lit-unscattered-weighted", "what was never scattered is weighted as if shadow rays could find it", FULL, CheckId::Mean, Bug::UnscatteredWeighted),
];

/// The family.
pub fn mutants() -> Vec<Mutant<SpectralLitRod>> {
    family(LINES, &Bug::None, |&casts, &bug| match bug {
        Bug::Printed(error) => by(AsPrinted { error }),
        Bug::NotReset => by(Wrong::<true, false, false> { casts, bug }),
        Bug::AlbedoTwice => by(Wrong::<false, true, false> { casts, bug }),
        Bug::HeroAnew => by(Wrong::<false, false, true> { casts, bug }),
        _ => by(Wrong::<false, false, false> { casts, bug }),
    })
}

fn by(steps: impl WalkEvents + Send + 'static) -> Box<DrawFunction<SpectralLitRod>> {
    Box::new(one_by_one(move |setup, medium, random| draw(&steps, setup, medium, random)))
}

/// The steps of a walk with a bug.
struct Wrong<const GOES_ON: bool, const GAINS: bool, const CASTS_ANEW: bool> {
    casts: bool,
    bug: Bug,
}

impl<const GOES_ON: bool, const GAINS: bool, const CASTS_ANEW: bool> WalkEvents
    for Wrong<GOES_ON, GAINS, CASTS_ANEW>
{
    const GOES_ON: bool = GOES_ON;
    const GAINS: bool = GAINS;
    const CASTS_ANEW: bool = CASTS_ANEW;

    fn heroes(&self) -> &Heroes {
        &Heroes::Uniform
    }

    fn has_shadow_rays(&self) -> bool {
        self.casts
    }

    fn weighing(&self, light: PathTechnique) -> Weighing {
        let has_next_event = self.casts && light != PathTechnique::Unscattered;
        let right = Weighing { has_next_event, ..Weighing::RIGHT };
        match (self.bug, light) {
            (Bug::ExitMissing, PathTechnique::Hit | PathTechnique::Unscattered) => {
                Weighing { last_piece: LastPiece::InContribution, ..right }
            }
            (Bug::Dropped, _) => Weighing { missing: 1, ..right },
            (Bug::NullsInOne, PathTechnique::Connected) => Weighing { has_nulls: false, ..right },
            (Bug::UnscatteredWeighted, _) => Weighing { has_next_event: true, ..right },
            _ => right,
        }
    }

    fn phase_of(&self, channel: usize, hero: usize) -> usize {
        if self.bug == Bug::PhaseOfHero { hero } else { channel }
    }

    fn decides<L: Lane>(&self, right: L, by_first: impl Fn() -> L) -> L {
        if self.bug == Bug::OtherMajorant { by_first() } else { right }
    }
}
