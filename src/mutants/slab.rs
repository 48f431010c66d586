//! Wrong walks through a slab.
//!
//! ```text
//! a flight of optical depth u goes u|μ| deep; a particle that is scattered by an angle θ at an azimuth φ
//! goes on with μ' = μ cos θ + √(1 − μ²) sin θ cos φ;  diffuse light has the law 2μ₀ dμ₀
//! ```

use super::target::{
    SLAB_ADAPTIVE, SLAB_ANALOG, SLAB_DIFFUSE, SLAB_NON_TERMINATING, SLAB_WEIGHTED, Target,
};
use super::{About, Mutant, with};
use crate::estimators::slab::walk::{self, Steps};
use crate::phase::Phase;
use crate::problems::Slab;
use crate::rng::Stream;
use crate::theory::{Odds, ParticleRule};

use ParticleRule::{Adaptive, Analog, NonTerminating, Terminating, Weighted};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Slab>> {
    vec![
        slab("slab-cosine-sign", "the cosine of Henyey and Greenstein has the wrong sign: forward is backward", SLAB_ANALOG, "mean", Analog, Backward),
        slab("slab-albedo-twice", "the albedo is a chance and a weight", SLAB_NON_TERMINATING, "mean", NonTerminating, Changed(NonTerminating, albedo_twice)),
        slab("slab-albedo-by-roulette-and-weight", "absorption by roulette and by weight at once", SLAB_WEIGHTED, "mean", Weighted, Changed(Analog, albedo_twice)),
        slab("slab-slant-forgotten", "a slanted flight goes as deep as one straight down", SLAB_ANALOG, "lookups", Analog, Straight(Analog)),
        slab("slab-slant-inverted", "a flight goes u/|μ| deep", SLAB_WEIGHTED, "mean", Weighted, Steep(Weighted)),
        slab("slab-even-light", "diffuse light has the law dμ₀, without the cosine", SLAB_DIFFUSE, "mean", NonTerminating, Even),
        slab("slab-terminating-beyond", "the terminating rule where r > 2/(a + 1)", SLAB_ADAPTIVE, "mean", Adaptive, Terminating),
    ]
}

fn slab(
    name: &'static str,
    bug: &'static str,
    target: Target,
    check: &'static str,
    honest: ParticleRule,
    steps: impl Steps + Copy + Send + Sync + 'static,
) -> Mutant<Slab> {
    Mutant::new(
        About { name, bug, target, check },
        with(steps, walk::draw),
        with(honest, walk::draw),
    )
}

/// The odds of a rule, changed; the second argument is the albedo.
#[derive(Clone, Copy)]
struct Changed(ParticleRule, fn(Odds, f64) -> Odds);

impl Steps for Changed {
    #[inline(always)]
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        (self.1)(self.0.odds(ratio, albedo), albedo)
    }
}

/// `a² r`.
fn albedo_twice(right: Odds, albedo: f64) -> Odds {
    Odds { scatter_weight: albedo * right.scatter_weight, ..right }
}

/// `−cos θ`.
#[derive(Clone, Copy)]
struct Backward;

impl Steps for Backward {
    #[inline(always)]
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        Analog.odds(ratio, albedo)
    }

    #[inline(always)]
    fn deflection(&self, phase: &Phase, rng: &mut Stream) -> f64 {
        -phase.cosine(rng.uniform())
    }
}

/// u for `u|μ|`.
#[derive(Clone, Copy)]
struct Straight(ParticleRule);

impl Steps for Straight {
    #[inline(always)]
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        self.0.odds(ratio, albedo)
    }

    #[inline(always)]
    fn descent(&self, length: f64, _: f64) -> f64 {
        length
    }
}

/// `u/|μ|` for `u|μ|`.
#[derive(Clone, Copy)]
struct Steep(ParticleRule);

impl Steps for Steep {
    #[inline(always)]
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        self.0.odds(ratio, albedo)
    }

    #[inline(always)]
    fn descent(&self, length: f64, cosine: f64) -> f64 {
        length / cosine.abs()
    }
}

/// `μ₀ = u` for `√u`.
#[derive(Clone, Copy)]
struct Even;

impl Steps for Even {
    #[inline(always)]
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        NonTerminating.odds(ratio, albedo)
    }

    #[inline(always)]
    fn diffuse(&self, rng: &mut Stream) -> f64 {
        1.0 - rng.uniform()
    }
}
