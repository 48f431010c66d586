//! Wrong walks in space: weights that do not add up, directions, endings, flights and starts.
//!
//! ```text
//! furnace            Σ w r (1 − a) + w where it leaves = 1 on average, and in every draw where a rule never
//!                    ends a walk
//! infinite medium    E[x²] at absorption = 2/(σ_t² (1 − a)(1 − a g)) knows how a particle turns, the
//!                    collisions how it ends
//! lambertian         light from all sides: every law of a start but Lambert's changes lengths and counts
//! ```

use super::target::{
    FURNACE_ANALOG, FURNACE_BELOW, FURNACE_NON_TERMINATING, FURNACE_ROULETTE, INFINITE_ANALOG,
    INFINITE_WEIGHTED, LAMBERTIAN, LAMBERTIAN_CELLS, Target,
};
use super::{About, Mutant, with};
use estimators::space::{Particle, Steps, Walked, draw};
use media::phase::Phase;
use numeric::Lane;
use numeric::geometry::Point;
use numeric::rng::Random;
use theory::Odds;
use theory::ParticleRule::{self, Analog, NonTerminating, Terminating, Weighted};
use theory::problems::{Furnace, InfiniteMedium, Lambertian};

#[derive(Clone, Copy, PartialEq)]
enum Bug {
    None,
    AlbedoTwice,
    Uncompensated,
    NumberTwice,
    Backward,
    AboutZ,
    EvenLight,
    StaleMajorant,
}

/// The steps of a particle, of which a bug makes one wrong.
#[derive(Clone, Copy)]
struct Wrong(Particle, Bug);

impl Steps for Wrong {
    #[inline(always)]
    fn odds<L: Lane>(&self, ratio: L, albedo: L) -> Odds<L> {
        let right = self.0.odds(ratio, albedo);
        match self.1 {
            Bug::AlbedoTwice => Odds { scatter_weight: albedo * right.scatter_weight, ..right },
            _ => right,
        }
    }

    #[inline(always)]
    fn survive<L: Lane>(
        &self,
        goes_on: L::Mask,
        weight: &mut L,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let before = *weight;
        let survives = self.0.survive(goes_on, weight, random);
        if self.1 == Bug::Uncompensated {
            *weight = before;
        }
        survives
    }

    #[inline(always)]
    fn through<L: Lane>(&self, here: L, begun: L) -> L {
        if self.1 == Bug::StaleMajorant { begun } else { here }
    }

    #[inline(always)]
    fn number<L: Lane>(&self, which: L::Mask, depth: L, random: &mut impl Random<L>) -> L {
        if self.1 == Bug::NumberTwice {
            return Lane::exp(-depth);
        }
        self.0.number(which, depth, random)
    }

    #[inline(always)]
    fn deflection<L: Lane>(&self, phase: &Phase, number: L) -> L {
        let right = self.0.deflection(phase, number);
        if self.1 == Bug::Backward { -right } else { right }
    }

    #[inline(always)]
    fn axis<L: Lane>(&self, direction: [L; 3]) -> [L; 3] {
        let up = Point([0.0, 0.0, 1.0]).each(direction[0]);
        if self.1 == Bug::AboutZ { up } else { direction }
    }

    #[inline(always)]
    fn first_cosine<L: Lane>(&self, right: L, number: L) -> L {
        if self.1 == Bug::EvenLight { number.one_minus() } else { right }
    }
}

/// A bug that the mean shows, on a target: wrong steps of a walk beside the right ones.
fn mutant<P: Walked>(
    name: &'static str,
    bug: &'static str,
    target: Target,
    honest: Particle,
    wrong: Wrong,
) -> Mutant<P> {
    let walk = |steps: Wrong| {
        with(steps, |steps, setup, _, rng| draw::<P, false>(*steps, &steps.0, setup, rng))
    };
    let about = About { name, bug, target, check: "mean" };
    Mutant::new(about, walk(wrong), walk(Wrong(honest, Bug::None)))
}

/// A particle with roulette below a weight.
fn roulette(rule: ParticleRule, below: f64) -> Particle {
    Particle { roulette: Some(below), ..Particle::of(rule) }
}

/// In a furnace.
#[rustfmt::skip] // one mutant, one entry
pub fn in_furnace() -> Vec<Mutant<Furnace>> {
    let (non_terminating, analog) = (Particle::of(NonTerminating), Particle::of(Analog));
    let played = roulette(NonTerminating, 0.8);
    vec![
        mutant("furnace-albedo-twice", "the albedo is a chance and a weight", FURNACE_NON_TERMINATING, non_terminating, Wrong(non_terminating, Bug::AlbedoTwice)),
        mutant("furnace-roulette-uncompensated", "who survives roulette keeps the old weight", FURNACE_ROULETTE, played, Wrong(played, Bug::Uncompensated)),
        mutant("furnace-terminating-beyond", "the terminating rule where r > 2/(a + 1)", FURNACE_BELOW, non_terminating, Wrong(Particle::of(Terminating), Bug::None)),
        mutant("furnace-number-twice", "one random number for the flight and for what follows it", FURNACE_ANALOG, analog, Wrong(analog, Bug::NumberTwice)),
    ]
}

/// In the infinite medium.
#[rustfmt::skip] // one mutant, one entry
pub fn in_infinite_medium() -> Vec<Mutant<InfiniteMedium>> {
    let (analog, weighted) = (Particle::of(Analog), roulette(Weighted, 0.5));
    vec![
        mutant("infinite-cosine-sign", "the cosine of Henyey and Greenstein has the wrong sign: forward is backward", INFINITE_ANALOG, analog, Wrong(analog, Bug::Backward)),
        mutant("infinite-turned-about-z", "a particle turns about the z axis, not about its direction", INFINITE_ANALOG, analog, Wrong(analog, Bug::AboutZ)),
        mutant("infinite-albedo-twice", "absorption by weight and by roulette at once", INFINITE_WEIGHTED, weighted, Wrong(weighted, Bug::AlbedoTwice)),
        mutant("infinite-roulette-uncompensated", "who survives roulette keeps the old weight", INFINITE_WEIGHTED, weighted, Wrong(weighted, Bug::Uncompensated)),
    ]
}

/// Under light from all sides.
#[rustfmt::skip] // one mutant, one entry
pub fn under_light() -> Vec<Mutant<Lambertian>> {
    let (white, cells) = (Particle::of(NonTerminating), Particle::of(Analog));
    vec![
        mutant("lambertian-even-light", "the cosine with the normal is even, without the law of Lambert", LAMBERTIAN, white, Wrong(white, Bug::EvenLight)),
        mutant("lambertian-stale-majorant", "a flight goes on with the majorant of the cell it began in", LAMBERTIAN_CELLS, cells, Wrong(cells, Bug::StaleMajorant)),
    ]
}
