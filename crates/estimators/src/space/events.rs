//! The steps of a walk of a particle in space that a known bug may replace.

use media::phase::Phase;
use numeric::Lane;
use numeric::rng::Random;
use theory::collisions::particle::EventProbabilities;

/// Events of a walk, each of which a known bug may replace.
pub trait WalkEvents: Copy {
    /// The probabilities at a collision of a given ratio `σ_t/σ̂` and albedo.
    fn probabilities<L: Lane>(&self, ratio: L, albedo: L) -> EventProbabilities<L>;

    /// Lanes of `goes_on` that survive roulette, with their weights.
    fn survive<L: Lane>(
        &self,
        goes_on: L::Mask,
        weight: &mut L,
        random: &mut impl Random<L>,
    ) -> L::Mask;

    /// σ̂ of a flight in a cell, from σ̂ of the cell and of that in which the flight begins.
    #[inline(always)]
    fn through<L: Lane>(&self, here: L, begun: L) -> L {
        let _ = begun;
        here
    }

    /// The uniform number that decides a collision, for the lanes in `which`; `depth` is the optical depth of the flight.
    #[inline(always)]
    fn number<L: Lane>(&self, which: L::Mask, depth: L, random: &mut impl Random<L>) -> L {
        let _ = depth;
        random.uniform_where(which)
    }

    /// The cosine of the scattering angle, from a uniform number.
    #[inline(always)]
    fn deflection<L: Lane>(&self, phase: &Phase, number: L) -> L {
        phase.cosine(number)
    }

    /// The axis about which a particle of a direction turns.
    #[inline(always)]
    fn axis<L: Lane>(&self, direction: [L; 3]) -> [L; 3] {
        direction
    }

    /// The cosine with which a walk begins, from a uniform number, given the right one.
    #[inline(always)]
    fn first_cosine<L: Lane>(&self, right: L, number: L) -> L {
        let _ = number;
        right
    }
}
