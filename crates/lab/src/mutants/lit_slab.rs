//! Wrong ways to look for a light behind a slab.
//!
//! ```text
//! X = q t̂ w_nee(ρ) + [hit] w_uni(ρ),   q = p(μ)/p_nee,   p_nee = D²/(A μ³) for a disc,   ρ = q Π (1 − r)
//! ```

use super::altered::{Altered, Change};
use super::lit_rod::{balanced, flight_to_end, next_event, transmittance};
use super::{Mutant, MutantRow, On, family, filled, on};
use estimators::Setup;
use estimators::lit_slab::walk::{Path, ToLight};
use estimators::walks::{self, Route, TentativeCollision, Walk};
use gate::CheckId;
use media::sampling::BothWays;
use numeric::Lane;
use numeric::rng::Random;
use theory::light::{Densities, Shadow, Techniques};
use theory::problems::LitSlab;

/// A wide disc close behind a slab of rising extinction, g = 0.6, `σ̂ = 1.5`; next event by ratio tracking.
const NEXT_EVENT: On<Techniques> = on("slab/lit-known-bugs", 3, next_event(Shadow::Ratio));
/// Directional weights, delta tracking.
const DIRECTIONAL: On<Techniques> =
    on("slab/lit-known-bugs", 4, balanced(Shadow::Delta, Densities::Directional));
/// All densities, ratio tracking.
const FULL: On<Techniques> = on("slab/lit-known-bugs", 6, balanced(Shadow::Ratio, Densities::Full));
/// A beam behind the same slab.
const DISTANT: On<Techniques> = on("slab/lit-distant", 3, next_event(Shadow::Ratio));

#[derive(Debug, Clone, Copy, PartialEq)]
enum Bug {
    None,
    ShadowTwice,
    HitAlone,
    NullsMissing,
    LastSegment,
    BeamWeighted,
    CosineMissing,
    Upright,
    Reversed,
    AreasMixed,
    PhaseAlone,
}

#[rustfmt::skip] // one mutant, one entry
const LINES: &[MutantRow<Techniques, Bug>] = &[
    ("lit-slab-cosine-missing", "the cosine at the disc is left out of p_nee: D²/(A μ²)", NEXT_EVENT, CheckId::Mean, Bug::CosineMissing),
    ("lit-slab-upright", "shadow rays fly as deep as if they went straight down", NEXT_EVENT, CheckId::Mean, Bug::Upright),
    ("lit-slab-reversed", "the phase function of a shadow ray is that of the reversed direction", NEXT_EVENT, CheckId::Mean, Bug::Reversed),
    ("lit-slab-shadow-twice", "the transmittance of a shadow ray is a weight twice", NEXT_EVENT, CheckId::Mean, Bug::ShadowTwice),
    ("lit-slab-areas-mixed", "a hit compares p(μ) per steradian with a density per area of the disc", DIRECTIONAL, CheckId::Mean, Bug::AreasMixed),
    ("lit-slab-phase-alone", "a hit is weighted as if p_nee were 1, as in a rod", DIRECTIONAL, CheckId::Mean, Bug::PhaseAlone),
    ("lit-slab-hit-alone", "hits are not divided by p_uni + p_nee", FULL, CheckId::Mean, Bug::HitAlone),
    ("lit-slab-nulls-missing", "null collisions are left out of the density of hits only", FULL, CheckId::Mean, Bug::NullsMissing),
    ("lit-slab-last-segment", "the last segment's transmittance is in the densities, and not in f", FULL, CheckId::Mean, Bug::LastSegment),
    ("lit-slab-beam-weighted", "a shadow ray to a beam is weighted as if it could be hit", DISTANT, CheckId::Mean, Bug::BeamWeighted),
];

/// The family.
pub fn mutants() -> Vec<Mutant<LitSlab>> {
    family(LINES, &Bug::None, |&right, &bug| {
        let techniques = match bug {
            Bug::BeamWeighted => balanced(Shadow::Ratio, Densities::Full),
            _ => right,
        };
        filled(move |setup, request| {
            let walk = ToLight::of(setup, techniques);
            walks::in_turn(&Altered { walk, change: Wrong { bug, setup } }, setup, request);
        })
    })
}

/// A walk with a bug.
#[derive(Clone, Copy)]
struct Wrong<'a> {
    bug: Bug,
    setup: &'a Setup<LitSlab>,
}

impl Change<ToLight<'_>> for Wrong<'_> {
    fn fly<L: Lane>(
        &self,
        walk: &ToLight,
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
        walk: &ToLight,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let (before, one, phase) = (*path, extinctions.t.each(1.0), &walk.slab.phase);
        let (casts, left) = (before.shadow.casts, !extinctions.inside);
        path.score = one.each(0.0);
        let goes_on = walk.collide(path, route, extinctions, random);
        let begins = path.shadow.casts & !casts;
        let shadow = &mut path.shadow;
        let meets = begins & path.meets;
        match self.bug {
            Bug::ShadowTwice => path.score.scale_where(casts & left, before.shadow.lit),
            Bug::HitAlone => path.score.set_where(before.seeks & left, one),
            Bug::NullsMissing => path.ratio.set_where(before.seeks, before.ratio),
            Bug::LastSegment => {
                let depth = flight_to_end(self.setup, extinctions.t) / path.cosine;
                shadow.lit.set_where(begins, depth.exp());
            }
            Bug::CosineMissing => shadow.density.scale_where(begins, one / path.cosine),
            Bug::Upright => path.cosine.set_where(begins, one),
            Bug::Reversed => {
                let turned = phase.value(-path.cosine) / phase.value(path.cosine);
                shadow.density.scale_where(begins, turned);
            }
            Bug::AreasMixed => {
                let density = phase.value(path.drawn) * (std::f64::consts::PI * 1.44);
                path.ratio.set_where(meets, density);
            }
            Bug::PhaseAlone => path.ratio.set_where(meets, phase.value(path.drawn)),
            Bug::None | Bug::BeamWeighted => {}
        }
        path.score = path.score + before.score;
        goes_on
    }
}
