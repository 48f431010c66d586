//! Wrong ways to look for an emitter at the end of a rod.
//!
//! ```text
//! X = [reached unscattered] + Σ p t̂ w_nee(ρ) + [hit after y] w_uni(ρ),   ρ = p_uni/p_nee = p Π (1 − r)
//! ```
//!
//! Several are errors of Algorithms 1 and 2 of B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral
//! formulation of light transport*, ACM Transactions on Graphics 38 (2019), as printed, or ways to read them.

use super::target::{LIT_DIRECTIONAL, LIT_FULL, LIT_NEXT_EVENT, LIT_NEXT_EVENT_DELTA};
use super::{About, Mutant, Target, filled};
use estimators::lit_rod::shadow::Steps;
use estimators::lit_rod::walk::fill;
use numeric::Lane;
use theory::lit_rod::{Combination, Densities, Heuristic, Shadow, Techniques};
use theory::problems::LitRod;

/// The bugs, each in one step of a walk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Bug {
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

/// The steps of techniques with a bug.
#[derive(Clone, Copy)]
pub(super) struct Wrong(pub(super) Techniques, pub(super) Bug);

impl Steps for Wrong {
    const KEEPS_LAST: bool = true;

    #[inline(always)]
    fn techniques(&self) -> Techniques {
        self.0
    }

    #[inline(always)]
    fn unscattered<L: Lane>(&self, one: L) -> L {
        if self.1 == Bug::UnscatteredWeighted { self.0.of_hit(one) } else { one }
    }

    #[inline(always)]
    fn hit<L: Lane>(&self, ratio: L) -> L {
        let right = self.0.of_hit(ratio);
        match self.1 {
            Bug::Averaged => right * 0.5,
            Bug::HitAlone => ratio.each(1.0),
            Bug::Squared => right * right,
            _ => right,
        }
    }

    #[inline(always)]
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

    #[inline(always)]
    fn after_null<L: Lane>(&self, ratio: L, null: L) -> L {
        if self.1 == Bug::NullsMissing { ratio } else { self.0.after_null(ratio, null) }
    }

    #[inline(always)]
    fn after_scattering<L: Lane>(&self, before: L, right: L) -> L {
        if self.1 == Bug::NotReset { right * before } else { right }
    }

    #[inline(always)]
    fn phase<L: Lane>(&self, forward: L, is_forward: L::Mask, albedo: L) -> L {
        let right = self.0.phase(forward, is_forward, albedo);
        match self.1 {
            Bug::AlbedoTwice => right * albedo,
            Bug::Isotropic => forward.each(0.5),
            Bug::Reversed => right.one_minus(),
            _ => right,
        }
    }

    #[inline(always)]
    fn stops<L: Lane>(&self, ratio: L, albedo: L) -> L {
        if self.1 == Bug::ThroughScattering { ratio * albedo.one_minus() } else { ratio }
    }

    #[inline(always)]
    fn arrived<L: Lane>(&self, transmittance: L, last: impl Fn() -> L) -> L {
        if self.1 == Bug::LastSegment { transmittance * last().exp() } else { transmittance }
    }

    #[inline(always)]
    fn returns(&self) -> bool {
        self.1 != Bug::CarriedAlong
    }
}

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<LitRod>> {
    let mutant = |name, bug, target: Target, techniques, wrong| {
        let about = About { name, bug, target, check: "mean" };
        Mutant::new(about, filled(Wrong(techniques, wrong), fill), filled(Wrong(techniques, Bug::None), fill))
    };
    let balanced = |shadow, densities| {
        let combination = Combination::Mis(densities, Heuristic::Balance);
        Techniques { shadow: Some(shadow), combination }
    };
    let alone = |shadow| Techniques { shadow: Some(shadow), combination: Combination::NextEvent };
    let full = balanced(Shadow::Ratio, Densities::Full);
    let directional = balanced(Shadow::Delta, Densities::Directional);
    let (ratio, delta) = (alone(Shadow::Ratio), alone(Shadow::Delta));
    vec![
        mutant("lit-rod-last-segment", "Algorithm 2, line 9: the last segment's transmittance is in the densities, and not in f", LIT_FULL, full, Bug::LastSegment),
        mutant("lit-rod-averaged", "the samples of both techniques are added, and divided by their number", LIT_FULL, full, Bug::Averaged),
        mutant("lit-rod-hit-alone", "Algorithm 1 in the combination: hits are not divided by p_uni + p_nee", LIT_FULL, full, Bug::HitAlone),
        mutant("lit-rod-nulls-in-one", "null collisions are left out of the density of shadow rays only", LIT_FULL, full, Bug::NullsInOne),
        mutant("lit-rod-nulls-missing", "null collisions are left out of the density of hits only", LIT_FULL, full, Bug::NullsMissing),
        mutant("lit-rod-not-reset", "p_nee is not reset at a real scattering: ρ is a product over the path", LIT_FULL, full, Bug::NotReset),
        mutant("lit-rod-unscattered-weighted", "the unscattered hit is weighted as if a shadow ray could find it", LIT_FULL, full, Bug::UnscatteredWeighted),
        mutant("lit-rod-shadow-twice", "the transmittance of a shadow ray is a weight twice", LIT_NEXT_EVENT, ratio, Bug::ShadowTwice),
        mutant("lit-rod-found-twice", "what shadow rays find is hit, too", LIT_NEXT_EVENT, ratio, Bug::HitAlone),
        mutant("lit-rod-albedo-twice", "the albedo is the chance of a scattering and a weight of its shadow ray", LIT_NEXT_EVENT, ratio, Bug::AlbedoTwice),
        mutant("lit-rod-carried-along", "the walk goes on where its shadow ray ended", LIT_NEXT_EVENT, ratio, Bug::CarriedAlong),
        mutant("lit-rod-through-scattering", "scattering lets a shadow ray through: only absorption stops it", LIT_NEXT_EVENT_DELTA, delta, Bug::ThroughScattering),
        mutant("lit-rod-isotropic", "shadow rays take both directions to be alike", LIT_NEXT_EVENT_DELTA, delta, Bug::Isotropic),
        mutant("lit-rod-reversed", "the phase function of a shadow ray is that of the reversed direction", LIT_DIRECTIONAL, directional, Bug::Reversed),
        mutant("lit-rod-squared-weights", "the power heuristic squares weights that sum to 1", LIT_DIRECTIONAL, directional, Bug::Squared),
    ]
}
