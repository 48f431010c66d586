//! Wrong ways to look for an emitter in several channels at once.
//!
//! ```text
//! X_λ = f_λ/Σ_h w_h (p_uni,h + p_nee,h),   f_λ = p_uni,λ = q_λ p_λ(ω) Π (1 − r_λ),  p_nee,λ = q_λ
//! ```
//!
//! Several are errors of Algorithms 1 and 2 of B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral
//! formulation of light transport*, ACM Transactions on Graphics 38 (2019), as printed, or ways to read them. A run of
//! `cases/rod/spectral-lit-as-printed.toml` tells how large the bias of the printed ones is.

use super::target::{SPECTRAL_LIT_FULL, SPECTRAL_LIT_HITS};
use super::{About, Draws, Mutant, Target, with};
use estimators::setup::heroes::Heroes;
use estimators::spectral_lit_rod::as_printed::{AsPrinted, Error};
use estimators::spectral_lit_rod::next_event_mis::NextEventMis;
use estimators::spectral_lit_rod::spectral_mis::SpectralMis;
use estimators::spectral_lit_rod::steps::{Found, Steps};
use estimators::spectral_lit_rod::walk::draw;
use estimators::walks::hero::{LastPiece, Weighing};
use numeric::Lane;
use theory::problems::SpectralLitRod;

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<SpectralLitRod>> {
    let heroes = || Heroes::Uniform;
    let printed = |name, bug, error| {
        let about = About { name, bug, target: SPECTRAL_LIT_FULL, check: "mean" };
        Mutant::new(about, with(AsPrinted { error }, draw), with(NextEventMis { heroes: heroes() }, draw))
    };
    let slip = |name, bug, target: Target, slip| {
        let about = About { name, bug, target, check: "mean" };
        let casts = target == SPECTRAL_LIT_FULL;
        let mutant = |wrong: Box<Draws<SpectralLitRod>>| if casts {
            Mutant::new(about, wrong, with(NextEventMis { heroes: heroes() }, draw))
        } else {
            Mutant::new(about, wrong, with(SpectralMis { heroes: heroes() }, draw))
        };
        match slip {
            Slip::NotReset => mutant(Box::new(with(Wrong::<true, false, false> { casts, slip }, draw))),
            Slip::AlbedoTwice => mutant(Box::new(with(Wrong::<false, true, false> { casts, slip }, draw))),
            Slip::HeroAnew => mutant(Box::new(with(Wrong::<false, false, true> { casts, slip }, draw))),
            _ => mutant(Box::new(with(Wrong::<false, false, false> { casts, slip }, draw))),
        }
    };
    vec![
        printed("spectral-lit-last-piece", "Algorithm 2, line 9: f and both densities lack the transmittance of the last piece", Error::LastPiece),
        printed("spectral-lit-averaged", "Algorithm 2, line 9: the densities are averaged over 2N techniques, and both samples are added", Error::Average),
        printed("spectral-lit-hits-alone", "Algorithm 1 beside shadow rays: hits are divided by p_uni, not by p_uni + p_nee", Error::HitsAlone),
        printed("spectral-lit-one-phase", "Algorithm 1, line 14, and Algorithm 2, lines 3 and 5: the phase function is that of the hero in all channels", Error::OnePhase),
        printed("spectral-lit-as-printed", "Algorithms 1 and 2 with all errors as printed, and an exit", Error::All),
        slip("spectral-lit-exit-missing", "Algorithm 1: f has the transmittance of the flight that leaves, and p has not", SPECTRAL_LIT_HITS, Slip::ExitMissing),
        slip("spectral-lit-albedo-twice", "Algorithm 1, line 12: what f has of the event is multiplied in once more", SPECTRAL_LIT_HITS, Slip::AlbedoTwice),
        slip("spectral-lit-phase-of-hero", "Algorithm 1, line 14: neither f nor p has the phase function of its channel", SPECTRAL_LIT_HITS, Slip::PhaseOfHero),
        slip("spectral-lit-other-majorant", "Algorithm 1, line 8: the chances are those of the hero's σ_t in another channel's σ̂", SPECTRAL_LIT_HITS, Slip::OtherMajorant),
        slip("spectral-lit-dropped", "the last channel is missing from the denominator", SPECTRAL_LIT_HITS, Slip::Dropped),
        slip("spectral-lit-not-reset", "p_nee is not reset at a real scattering", SPECTRAL_LIT_FULL, Slip::NotReset),
        slip("spectral-lit-nulls-in-one", "null collisions of shadow rays are left out of p_uni only", SPECTRAL_LIT_FULL, Slip::NullsInOne),
        slip("spectral-lit-hero-anew", "every shadow ray has a hero of its own", SPECTRAL_LIT_FULL, Slip::HeroAnew),
        slip("spectral-lit-unscattered-weighted", "what was never scattered is weighted as if shadow rays could find it", SPECTRAL_LIT_FULL, Slip::UnscatteredWeighted),
    ]
}

/// What goes wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Slip {
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

/// The steps of a walk with one slip.
struct Wrong<const GOES_ON: bool, const GAINS: bool, const CASTS_ANEW: bool> {
    casts: bool,
    slip: Slip,
}

impl<const GOES_ON: bool, const GAINS: bool, const CASTS_ANEW: bool> Steps
    for Wrong<GOES_ON, GAINS, CASTS_ANEW>
{
    const GOES_ON: bool = GOES_ON;
    const GAINS: bool = GAINS;
    const CASTS_ANEW: bool = CASTS_ANEW;

    fn heroes(&self) -> &Heroes {
        &Heroes::Uniform
    }

    fn casts(&self) -> bool {
        self.casts
    }

    fn weighing(&self, found: Found) -> Weighing {
        let has_next_event = self.casts && found != Found::Unscattered;
        let right = Weighing { has_next_event, ..Weighing::RIGHT };
        match (self.slip, found) {
            (Slip::ExitMissing, Found::Hit | Found::Unscattered) => {
                Weighing { last_piece: LastPiece::InContribution, ..right }
            }
            (Slip::Dropped, _) => Weighing { missing: 1, ..right },
            (Slip::NullsInOne, Found::Connected) => Weighing { has_nulls: false, ..right },
            (Slip::UnscatteredWeighted, _) => Weighing { has_next_event: true, ..right },
            _ => right,
        }
    }

    fn phase_of(&self, channel: usize, hero: usize) -> usize {
        if self.slip == Slip::PhaseOfHero { hero } else { channel }
    }

    fn decides<L: Lane>(&self, right: L, by_first: impl Fn() -> L) -> L {
        if self.slip == Slip::OtherMajorant { by_first() } else { right }
    }
}
