//! Wrong walks through a slab.
//!
//! ```text
//! a flight of optical depth u goes u|μ| deep; a particle that is scattered by an angle θ at an azimuth φ
//! goes on with μ' = μ cos θ + √(1 − μ²) sin θ cos φ;  diffuse light has the law 2μ₀ dμ₀
//! ```

use super::target::{
    SLAB_ADAPTIVE, SLAB_ANALOG, SLAB_DIFFUSE, SLAB_NON_TERMINATING, SLAB_WEIGHTED,
};
use super::{About, Mutant, filled};
use estimators::slab::walk::{Steps, fill};
use media::phase::Phase;
use numeric::Lane;
use theory::Odds;
use theory::ParticleRule::{self, Adaptive, Analog, NonTerminating, Terminating, Weighted};
use theory::problems::Slab;

#[derive(Clone, Copy, PartialEq)]
enum Bug {
    None,
    AlbedoTwice,
    Backward,
    Unslanted,
    SlantInverted,
    EvenLight,
}

/// Steps, of which a bug makes one wrong.
#[derive(Clone, Copy)]
struct Wrong(ParticleRule, Bug);

impl Steps for Wrong {
    #[inline(always)]
    fn odds<L: Lane>(&self, ratio: L, albedo: L) -> Odds<L> {
        let right = Steps::odds(&self.0, ratio, albedo);
        match self.1 {
            Bug::AlbedoTwice => Odds { scatter_weight: albedo * right.scatter_weight, ..right },
            _ => right,
        }
    }

    #[inline(always)]
    fn descent<L: Lane>(&self, length: L, cosine: L) -> L {
        match self.1 {
            Bug::Unslanted => length,
            Bug::SlantInverted => length / cosine.size(),
            _ => self.0.descent(length, cosine),
        }
    }

    #[inline(always)]
    fn deflection<L: Lane>(&self, phase: &Phase, number: L) -> L {
        let right = self.0.deflection(phase, number);
        if self.1 == Bug::Backward { -right } else { right }
    }

    #[inline(always)]
    fn diffuse<L: Lane>(&self, number: L) -> L {
        if self.1 == Bug::EvenLight { number.one_minus() } else { self.0.diffuse(number) }
    }
}

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Slab>> {
    let slab = |name, bug, target, check, honest, wrong| {
        Mutant::new(About { name, bug, target, check }, filled(wrong, fill), filled(Wrong(honest, Bug::None), fill))
    };
    vec![
        slab("slab-cosine-sign", "the cosine of Henyey and Greenstein has the wrong sign: forward is backward", SLAB_ANALOG, "mean", Analog, Wrong(Analog, Bug::Backward)),
        slab("slab-albedo-twice", "the albedo is a chance and a weight", SLAB_NON_TERMINATING, "mean", NonTerminating, Wrong(NonTerminating, Bug::AlbedoTwice)),
        slab("slab-albedo-by-roulette-and-weight", "absorption by roulette and by weight at once", SLAB_WEIGHTED, "mean", Weighted, Wrong(Analog, Bug::AlbedoTwice)),
        slab("slab-slant-forgotten", "a slanted flight goes as deep as one straight down", SLAB_ANALOG, "lookups", Analog, Wrong(Analog, Bug::Unslanted)),
        slab("slab-slant-inverted", "a flight goes u/|μ| deep", SLAB_WEIGHTED, "mean", Weighted, Wrong(Weighted, Bug::SlantInverted)),
        slab("slab-even-light", "diffuse light has the law dμ₀, without the cosine", SLAB_DIFFUSE, "mean", NonTerminating, Wrong(NonTerminating, Bug::EvenLight)),
        slab("slab-terminating-beyond", "the terminating rule where r > 2/(a + 1)", SLAB_ADAPTIVE, "mean", Adaptive, Wrong(Terminating, Bug::None)),
    ]
}
