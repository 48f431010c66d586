//! Wrong ways to look for a light behind a slab.
//!
//! ```text
//! X = q t̂ w_nee(ρ) + [hit] w_uni(ρ),   q = p(μ)/p_nee,   p_nee = D²/(A μ³) for a disc,   ρ = q Π (1 − r)
//! ```

use super::lit_rod::{self, balanced, next_event};
use super::{Line, Mutant, On, family, filled, on};
use estimators::lit_slab::walk::{Directions, Right, ToLight};
use estimators::walks;
use gate::CheckId;
use media::phase::Phase;
use numeric::Lane;
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

/// The bugs: in a step of a rod's walk, in the techniques, and in densities of directions.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Bug {
    None,
    Step(lit_rod::Bug),
    BeamWeighted,
    CosineMissing,
    Upright,
    Reversed,
    AreasMixed,
    PhaseAlone,
}

#[rustfmt::skip] // one mutant, one entry
const LINES: &[Line<Techniques, Bug>] = &[
    ("lit-slab-cosine-missing", "the cosine at the disc is left out of p_nee: D²/(A μ²)", NEXT_EVENT, CheckId::Mean, Bug::CosineMissing),
    ("lit-slab-upright", "shadow rays fly as deep as if they went straight down", NEXT_EVENT, CheckId::Mean, Bug::Upright),
    ("lit-slab-reversed", "the phase function of a shadow ray is that of the reversed direction", NEXT_EVENT, CheckId::Mean, Bug::Reversed),
    ("lit-slab-shadow-twice", "the transmittance of a shadow ray is a weight twice", NEXT_EVENT, CheckId::Mean, Bug::Step(lit_rod::Bug::ShadowTwice)),
    ("lit-slab-areas-mixed", "a hit compares p(μ) per steradian with a density per area of the disc", DIRECTIONAL, CheckId::Mean, Bug::AreasMixed),
    ("lit-slab-phase-alone", "a hit is weighted as if p_nee were 1, as in a rod", DIRECTIONAL, CheckId::Mean, Bug::PhaseAlone),
    ("lit-slab-hit-alone", "hits are not divided by p_uni + p_nee", FULL, CheckId::Mean, Bug::Step(lit_rod::Bug::HitAlone)),
    ("lit-slab-nulls-missing", "null collisions are left out of the density of hits only", FULL, CheckId::Mean, Bug::Step(lit_rod::Bug::NullsMissing)),
    ("lit-slab-last-segment", "the last segment's transmittance is in the densities, and not in f", FULL, CheckId::Mean, Bug::Step(lit_rod::Bug::LastSegment)),
    ("lit-slab-beam-weighted", "a shadow ray to a beam is weighted as if it could be hit", DISTANT, CheckId::Mean, Bug::BeamWeighted),
];

/// The family.
pub fn mutants() -> Vec<Mutant<LitSlab>> {
    family(LINES, &Bug::None, |&right, &bug| {
        let techniques = match bug {
            Bug::BeamWeighted => balanced(Shadow::Ratio, Densities::Full),
            _ => right,
        };
        let step = if let Bug::Step(step) = bug { step } else { lit_rod::Bug::None };
        filled(move |setup, request| {
            let steps = lit_rod::Wrong(techniques, step);
            walks::in_turn(&ToLight::of(setup, steps, bug), setup, request);
        })
    })
}

impl Directions for Bug {
    fn scattered<L: Lane>(&self, phase: &Phase, cosine: L) -> L {
        phase.value(if *self == Self::Reversed { -cosine } else { cosine })
    }

    fn spread<L: Lane>(&self, right: L, cosine: L) -> L {
        if *self == Self::CosineMissing { right / cosine } else { right }
    }

    fn spread_of_hit<L: Lane>(&self, right: L) -> L {
        match self {
            Self::AreasMixed => right.each(std::f64::consts::PI * 1.44),
            Self::PhaseAlone => right.each(1.0),
            _ => right,
        }
    }

    fn slant<L: Lane>(&self, cosine: L) -> L {
        if *self == Self::Upright { cosine.each(1.0) } else { Right.slant(cosine) }
    }
}
