//! Wrong ways to look for a light behind a slab.
//!
//! ```text
//! X = q t̂ w_nee(ρ) + [hit] w_uni(ρ),   q = p(μ)/p_nee,   p_nee = D²/(A μ³) for a disc,   ρ = q Π (1 − r)
//! ```

use super::lit_rod::{Steps, right};
use super::target::{LIT_SLAB_DIRECTIONAL, LIT_SLAB_DISTANT, LIT_SLAB_FULL, LIT_SLAB_NEXT_EVENT};
use super::{About, Mutant, Target, with};
use estimators::lit_slab::walk::{self, draw};
use media::phase::Phase;
use theory::lit_rod::{Combination, Densities, Heuristic, Shadow, Techniques};
use theory::problems::LitSlab;

/// What directions are worth, of which a mutant has one wrong.
#[derive(Clone, Copy)]
struct Directions {
    /// The phase function.
    scattered: fn(&Phase, f64) -> f64,
    /// `1/p_nee` of a chosen direction, from what is right and the cosine.
    spread: fn(f64, f64) -> f64,
    /// `1/p_nee` of a drawn direction, from what is right.
    spread_of_hit: fn(f64) -> f64,
    /// How deep a shadow ray flies in a unit of optical depth, from the cosine.
    slant: fn(f64) -> f64,
}

const HONEST: Directions = Directions {
    scattered: |phase, cosine| phase.value(cosine),
    spread: |right, _| right,
    spread_of_hit: |right| right,
    slant: |cosine| cosine,
};

impl walk::Directions for Directions {
    fn scattered(&self, phase: &Phase, cosine: f64) -> f64 {
        (self.scattered)(phase, cosine)
    }

    fn spread(&self, right: f64, cosine: f64) -> f64 {
        (self.spread)(right, cosine)
    }

    fn spread_of_hit(&self, right: f64) -> f64 {
        (self.spread_of_hit)(right)
    }

    fn slant(&self, cosine: f64) -> f64 {
        (self.slant)(cosine)
    }
}

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<LitSlab>> {
    let twin = |walk: (Steps, Directions)| {
        with(walk, |(steps, directions): &(Steps, Directions), setup, medium, rng| draw((steps, directions), setup, medium, rng))
    };
    let mutant = |name, bug, target: Target, honest: Steps, wrong: (Steps, Directions)| {
        Mutant::new(About { name, bug, target, check: "mean" }, twin(wrong), twin((honest, HONEST)))
    };
    let balanced = |shadow, densities| {
        let combination = Combination::Mis(densities, Heuristic::Balance);
        right(Techniques { shadow: Some(shadow), combination })
    };
    let full = balanced(Shadow::Ratio, Densities::Full);
    let directional = balanced(Shadow::Delta, Densities::Directional);
    let alone = right(Techniques { shadow: Some(Shadow::Ratio), combination: Combination::NextEvent });
    vec![
        mutant("lit-slab-cosine-missing", "the cosine at the disc is left out of p_nee: D²/(A μ²)", LIT_SLAB_NEXT_EVENT, alone, (alone, Directions { spread: |right, cosine| right / cosine, ..HONEST })),
        mutant("lit-slab-upright", "shadow rays fly as deep as if they went straight down", LIT_SLAB_NEXT_EVENT, alone, (alone, Directions { slant: |_| 1.0, ..HONEST })),
        mutant("lit-slab-reversed", "the phase function of a shadow ray is that of the reversed direction", LIT_SLAB_NEXT_EVENT, alone, (alone, Directions { scattered: |phase, cosine| phase.value(-cosine), ..HONEST })),
        mutant("lit-slab-shadow-twice", "the transmittance of a shadow ray is a weight twice", LIT_SLAB_NEXT_EVENT, alone, (Steps { connected: |right, [_, found, _]| right * found, ..alone }, HONEST)),
        mutant("lit-slab-areas-mixed", "a hit compares p(μ) per steradian with a density per area of the disc", LIT_SLAB_DIRECTIONAL, directional, (directional, Directions { spread_of_hit: |_| std::f64::consts::PI * 1.44, ..HONEST })),
        mutant("lit-slab-phase-alone", "a hit is weighted as if p_nee were 1, as in a rod", LIT_SLAB_DIRECTIONAL, directional, (directional, Directions { spread_of_hit: |_| 1.0, ..HONEST })),
        mutant("lit-slab-hit-alone", "hits are not divided by p_uni + p_nee", LIT_SLAB_FULL, full, (Steps { hit: |_| 1.0, ..full }, HONEST)),
        mutant("lit-slab-nulls-missing", "null collisions are left out of the density of hits only", LIT_SLAB_FULL, full, (Steps { after_null: |_, before| before, ..full }, HONEST)),
        mutant("lit-slab-last-segment", "the last segment's transmittance is in the densities, and not in f", LIT_SLAB_FULL, full, (Steps { last: f64::exp, ..full }, HONEST)),
        mutant("lit-slab-beam-weighted", "a shadow ray to a beam is weighted as if it could be hit", LIT_SLAB_DISTANT, alone, (full, HONEST)),
    ]
}
