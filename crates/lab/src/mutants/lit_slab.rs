//! Wrong ways to look for a light behind a slab.
//!
//! ```text
//! X = q t̂ w_nee(ρ) + [hit] w_uni(ρ),   q = p(μ)/p_nee,   p_nee = D²/(A μ³) for a disc,   ρ = q Π (1 − r)
//! ```

use super::lit_rod::{self, Wrong};
use super::target::{LIT_SLAB_DIRECTIONAL, LIT_SLAB_DISTANT, LIT_SLAB_FULL, LIT_SLAB_NEXT_EVENT};
use super::{About, Mutant, Target, filled};
use estimators::lit_slab::walk::{Directions, Right, fill};
use media::phase::Phase;
use numeric::Lane;
use theory::lit_rod::{Combination, Densities, Heuristic, Shadow, Techniques};
use theory::problems::LitSlab;

/// The bugs in densities of directions.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Bug {
    None,
    CosineMissing,
    Upright,
    Reversed,
    AreasMixed,
    PhaseAlone,
}

impl Directions for Bug {
    #[inline(always)]
    fn scattered<L: Lane>(&self, phase: &Phase, cosine: L) -> L {
        phase.value(if *self == Self::Reversed { -cosine } else { cosine })
    }

    #[inline(always)]
    fn spread<L: Lane>(&self, right: L, cosine: L) -> L {
        if *self == Self::CosineMissing { right / cosine } else { right }
    }

    #[inline(always)]
    fn spread_of_hit<L: Lane>(&self, right: L) -> L {
        match self {
            Self::AreasMixed => right.each(std::f64::consts::PI * 1.44),
            Self::PhaseAlone => right.each(1.0),
            _ => right,
        }
    }

    #[inline(always)]
    fn slant<L: Lane>(&self, cosine: L) -> L {
        if *self == Self::Upright { cosine.each(1.0) } else { Right.slant(cosine) }
    }
}

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<LitSlab>> {
    use lit_rod::Bug as Step;
    let twin = |walk: (Wrong, Bug)| filled(walk, fill);
    let mutant = |name, bug, target: Target, honest: Techniques, wrong: (Wrong, Bug)| {
        Mutant::new(About { name, bug, target, check: "mean" }, twin(wrong), twin((Wrong(honest, Step::None), Bug::None)))
    };
    let direction = |name, bug, target, honest, wrong| mutant(name, bug, target, honest, (Wrong(honest, Step::None), wrong));
    let step = |name, bug, target, honest, wrong| mutant(name, bug, target, honest, (Wrong(honest, wrong), Bug::None));
    let balanced = |shadow, densities| {
        let combination = Combination::Mis(densities, Heuristic::Balance);
        Techniques { shadow: Some(shadow), combination }
    };
    let full = balanced(Shadow::Ratio, Densities::Full);
    let directional = balanced(Shadow::Delta, Densities::Directional);
    let alone = Techniques { shadow: Some(Shadow::Ratio), combination: Combination::NextEvent };
    vec![
        direction("lit-slab-cosine-missing", "the cosine at the disc is left out of p_nee: D²/(A μ²)", LIT_SLAB_NEXT_EVENT, alone, Bug::CosineMissing),
        direction("lit-slab-upright", "shadow rays fly as deep as if they went straight down", LIT_SLAB_NEXT_EVENT, alone, Bug::Upright),
        direction("lit-slab-reversed", "the phase function of a shadow ray is that of the reversed direction", LIT_SLAB_NEXT_EVENT, alone, Bug::Reversed),
        step("lit-slab-shadow-twice", "the transmittance of a shadow ray is a weight twice", LIT_SLAB_NEXT_EVENT, alone, Step::ShadowTwice),
        direction("lit-slab-areas-mixed", "a hit compares p(μ) per steradian with a density per area of the disc", LIT_SLAB_DIRECTIONAL, directional, Bug::AreasMixed),
        direction("lit-slab-phase-alone", "a hit is weighted as if p_nee were 1, as in a rod", LIT_SLAB_DIRECTIONAL, directional, Bug::PhaseAlone),
        step("lit-slab-hit-alone", "hits are not divided by p_uni + p_nee", LIT_SLAB_FULL, full, Step::HitAlone),
        step("lit-slab-nulls-missing", "null collisions are left out of the density of hits only", LIT_SLAB_FULL, full, Step::NullsMissing),
        step("lit-slab-last-segment", "the last segment's transmittance is in the densities, and not in f", LIT_SLAB_FULL, full, Step::LastSegment),
        mutant("lit-slab-beam-weighted", "a shadow ray to a beam is weighted as if it could be hit", LIT_SLAB_DISTANT, alone, (Wrong(full, Step::None), Bug::None)),
    ]
}
