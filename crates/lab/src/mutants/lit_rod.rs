//! Wrong ways to look for an emitter at the end of a rod.
//!
//! ```text
//! X = [reached unscattered] + Σ p t̂ w_nee(ρ) + [hit after y] w_uni(ρ),   ρ = p_uni/p_nee = p Π (1 − r)
//! ```
//!
//! Several are errors of Algorithms 1 and 2 of B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral
//! formulation of light transport*, ACM Transactions on Graphics 38 (2019), as printed, or ways to read them.

use super::{Line, Mutant, On, family, filled, on};
use estimators::lit_rod::shadow::WalkEvents;
use estimators::lit_rod::walk::ToEmitter;
use estimators::walks;
use gate::CheckId;
use numeric::Lane;
use theory::light::{Combination, Densities, Heuristic, Shadow, Techniques};
use theory::problems::LitRod;

/// Extinction that rises to the emitter, `p_f = 0.4`, `σ̂ = 1.25`; next event by delta tracking.
const NEXT_EVENT_DELTA: On<Techniques> = on("rod/lit-rising", 2, next_event(Shadow::Delta));
/// Next event by ratio tracking.
const NEXT_EVENT: On<Techniques> = on("rod/lit-rising", 3, next_event(Shadow::Ratio));
/// Directional weights, delta tracking.
const DIRECTIONAL: On<Techniques> =
    on("rod/lit-rising", 4, balanced(Shadow::Delta, Densities::Directional));
/// All densities, ratio tracking.
const FULL: On<Techniques> = on("rod/lit-rising", 6, balanced(Shadow::Ratio, Densities::Full));

/// The bugs, each in one step of a walk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bug {
    None,
    LastSegment,
    Averaged,
    HitAlone,
    NullsInOne,
    NullsMissing,
    NotReset,
    UnscatteredWeighted,
    ShadowTwice,
    AlbedoTwice,
    CarriedAlong,
    ThroughScattering,
    Isotropic,
    Reversed,
    Squared,
}

#[rustfmt::skip] // one mutant, one entry
const LINES: &[Line<Techniques, Bug>] = &[
    ("lit-rod-last-segment", "Algorithm 2, line 9: the last segment's transmittance is in the densities, and not in f", FULL, CheckId::Mean, Bug::LastSegment),
    ("lit-rod-averaged", "the samples of both techniques are added, and divided by their number", FULL, CheckId::Mean, Bug::Averaged),
    ("lit-rod-hit-alone", "Algorithm 1 in the combination: hits are not divided by p_uni + p_nee", FULL, CheckId::Mean, Bug::HitAlone),
    ("lit-rod-nulls-in-one", "null collisions are left out of the density of shadow rays only", FULL, CheckId::Mean, Bug::NullsInOne),
    ("lit-rod-nulls-missing", "null collisions are left out of the density of hits only", FULL, CheckId::Mean, Bug::NullsMissing),
    ("lit-rod-not-reset", "p_nee is not reset at a real scattering: ρ is a product over the path", FULL, CheckId::Mean, Bug::NotReset),
    ("lit-rod-unscattered-weighted", "the unscattered hit is weighted as if a shadow ray could find it", FULL, CheckId::Mean, Bug::UnscatteredWeighted),
    ("lit-rod-shadow-twice", "the transmittance of a shadow ray is a weight twice", NEXT_EVENT, CheckId::Mean, Bug::ShadowTwice),
    ("lit-rod-found-twice", "what shadow rays find is hit, too", NEXT_EVENT, CheckId::Mean, Bug::HitAlone),
    ("lit-rod-albedo-twice", "the albedo is the chance of a scattering and a weight of its shadow ray", NEXT_EVENT, CheckId::Mean, Bug::AlbedoTwice),
    ("lit-rod-carried-along", "the walk goes on where its shadow ray ended", NEXT_EVENT, CheckId::Mean, Bug::CarriedAlong),
    ("lit-rod-through-scattering", "scattering lets a shadow ray through: only absorption stops it", NEXT_EVENT_DELTA, CheckId::Mean, Bug::ThroughScattering),
    ("lit-rod-isotropic", "shadow rays take both directions to be alike", NEXT_EVENT_DELTA, CheckId::Mean, Bug::Isotropic),
    ("lit-rod-reversed", "the phase function of a shadow ray is that of the reversed direction", DIRECTIONAL, CheckId::Mean, Bug::Reversed),
    ("lit-rod-squared-weights", "the power heuristic squares weights that sum to 1", DIRECTIONAL, CheckId::Mean, Bug::Squared),
];

/// The family.
pub fn mutants() -> Vec<Mutant<LitRod>> {
    family(LINES, &Bug::None, |&techniques, &bug| {
        filled(move |setup, request| {
            walks::in_turn(&ToEmitter::of(setup, Wrong(techniques, bug)), setup, request);
        })
    })
}

/// Shadow rays alone.
pub const fn next_event(shadow: Shadow) -> Techniques {
    Techniques { shadow: Some(shadow), combination: Combination::NextEvent }
}

/// Shadow rays and hits by the balance heuristic.
pub const fn balanced(shadow: Shadow, densities: Densities) -> Techniques {
    let combination = Combination::Mis(densities, Heuristic::Balance);
    Techniques { shadow: Some(shadow), combination }
}

/// The steps of techniques with a bug.
#[derive(Clone, Copy)]
pub struct Wrong(pub Techniques, pub Bug);

impl WalkEvents for Wrong {
    const KEEPS_LAST: bool = true;

    fn techniques(&self) -> Techniques {
        self.0
    }

    fn unscattered<L: Lane>(&self, one: L) -> L {
        if self.1 == Bug::UnscatteredWeighted { self.0.of_hit(one) } else { one }
    }

    fn hit<L: Lane>(&self, ratio: L) -> L {
        let right = self.0.of_hit(ratio);
        match self.1 {
            Bug::Averaged => right * 0.5,
            Bug::HitAlone => ratio.each(1.0),
            Bug::Squared => right * right,
            _ => right,
        }
    }

    fn connected<L: Lane>(&self, density: L, transmittance: L) -> L {
        let right = self.0.of_shadow_ray(density, transmittance);
        match self.1 {
            Bug::Averaged => right * 0.5,
            Bug::NullsInOne => density * transmittance / (density + 1.0),
            Bug::ShadowTwice => right * transmittance,
            Bug::Squared => right / (density + 1.0),
            _ => right,
        }
    }

    fn after_null<L: Lane>(&self, ratio: L, null: L) -> L {
        if self.1 == Bug::NullsMissing { ratio } else { self.0.after_null(ratio, null) }
    }

    fn after_scattering<L: Lane>(&self, before: L, right: L) -> L {
        if self.1 == Bug::NotReset { right * before } else { right }
    }

    fn phase<L: Lane>(&self, forward: L, is_forward: L::Mask, albedo: L) -> L {
        let right = self.0.phase(forward, is_forward, albedo);
        match self.1 {
            Bug::AlbedoTwice => right * albedo,
            Bug::Isotropic => forward.each(0.5),
            Bug::Reversed => right.one_minus(),
            _ => right,
        }
    }

    fn stops<L: Lane>(&self, ratio: L, albedo: L) -> L {
        if self.1 == Bug::ThroughScattering { ratio * albedo.one_minus() } else { ratio }
    }

    fn arrived<L: Lane>(&self, transmittance: L, last: impl Fn() -> L) -> L {
        if self.1 == Bug::LastSegment { transmittance * last().exp() } else { transmittance }
    }

    fn returns(&self) -> bool {
        self.1 != Bug::CarriedAlong
    }
}
