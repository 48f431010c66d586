//! Wrong ways to look for an emitter at the end of a rod.
//!
//! ```text
//! X = [reached unscattered] + Σ p t̂ w_nee(ρ) + [hit after y] w_uni(ρ),   ρ = p_uni/p_nee = p Π (1 − r)
//! ```
//!
//! Several are errors of Algorithms 1 and 2 of B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral
//! formulation of light transport*, ACM Transactions on Graphics 38 (2019), as printed, or ways to read them.

use super::altered::{Altered, Change};
use super::{Mutant, MutantRow, On, family, filled, on};
use estimators::lit_rod::walk::{Path, Scatterers, ToEmitter};
use estimators::setup::Line as Along;
use estimators::walks::{self, Route, TentativeCollision, Walk};
use estimators::{Estimated, Setup};
use gate::CheckId;
use media::OpticalDepth;
use media::sampling::BothWays;
use numeric::rng::Random;
use numeric::{Lane, Span};
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

#[derive(Debug, Clone, Copy, PartialEq)]
enum Bug {
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
const LINES: &[MutantRow<Techniques, Bug>] = &[
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
            let walk = ToEmitter::of(setup, techniques);
            walks::in_turn(&Altered { walk, change: Wrong { bug, setup } }, setup, request);
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

/// Returns e^−τ of an optical depth τ.
#[inline(always)]
pub fn transmittance<L: Lane>(depth: L) -> L {
    (-depth).exp()
}

/// `∫σ̂` from distances to the end of a medium.
pub fn flight_to_end<P: Estimated<Fields = Along>, L: Lane>(setup: &Setup<P>, t: L) -> L {
    let (sampling, end) = (&setup.fields.sampling, setup.fields.mesh.support().to);
    t.map(|t| sampling.optical_depth(Span::new(t, end)).value)
}

/// A walk with a bug.
#[derive(Clone, Copy)]
struct Wrong<'a> {
    bug: Bug,
    setup: &'a Setup<LitRod>,
}

impl Change<ToEmitter<'_>> for Wrong<'_> {
    fn fly<L: Lane>(
        &self,
        walk: &ToEmitter,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        let inside = walk.fly(path, route, depth);
        if self.bug == Bug::LastSegment {
            // What is left is the last segment's.
            path.shadow.lit.scale_where(path.shadow.casts & inside, transmittance(depth));
        }
        inside
    }

    fn collide<L: Lane>(
        &self,
        walk: &ToEmitter,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let (bug, before, here, mut extinctions) = (self.bug, *path, route.here, *extinctions);
        let (one, casts, albedo) =
            (extinctions.t.each(1.0), before.shadow.casts, walk.rod.albedo(extinctions.t));
        let hits = !casts & !extinctions.inside & before.is_forward;
        match bug {
            Bug::HitAlone => path.unscattered |= hits,
            Bug::UnscatteredWeighted => {
                path.ratio.set_where(hits & path.unscattered, one);
                path.unscattered &= !hits;
            }
            Bug::ThroughScattering => {
                extinctions.extinction =
                    extinctions.extinction * L::select(casts, albedo.one_minus(), one);
            }
            _ => {}
        }
        path.score = one.each(0.0);
        let goes_on = walk.collide(path, route, &extinctions, random);
        let begins = path.shadow.casts & !casts;
        let shadow = &mut path.shadow;
        let (density, lit) = (before.shadow.density, before.shadow.lit);
        let arrives = casts & !extinctions.inside;
        match bug {
            Bug::Averaged => path.score.scale_where(arrives | !before.unscattered, one * 0.5),
            Bug::Squared => {
                path.score.scale_where(hits, path.score);
                path.score.set_where(arrives, path.score / (density + 1.0));
            }
            Bug::NullsInOne => path.score.set_where(arrives, density * lit / (density + 1.0)),
            Bug::ShadowTwice => path.score.scale_where(arrives, lit),
            Bug::NullsMissing => path.ratio.set_where(!casts & !begins, before.ratio),
            Bug::NotReset => path.ratio.scale_where(begins, before.ratio),
            Bug::AlbedoTwice => shadow.density.scale_where(begins, albedo),
            Bug::Isotropic => shadow.density.set_where(begins, one * 0.5),
            Bug::Reversed => {
                shadow.density.set_where(begins, shadow.density.one_minus());
                path.ratio.set_where(begins, path.ratio.one_minus());
            }
            Bug::LastSegment => {
                shadow.lit.set_where(begins, flight_to_end(self.setup, extinctions.t).exp());
            }
            Bug::CarriedAlong => route.here.copy_where(casts & !shadow.casts, &here),
            Bug::None | Bug::HitAlone | Bug::UnscatteredWeighted | Bug::ThroughScattering => {}
        }
        path.score = path.score + before.score;
        goes_on
    }
}
