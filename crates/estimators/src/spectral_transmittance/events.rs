//! The steps of a walk through a chromatic medium that a known bug may replace.

use numeric::Lane;
use numeric::rng::Random;

/// Events of a walk, each of which a known bug may replace.
pub trait WalkEvents: Copy {
    /// True if [`WalkEvents::relative`] needs the last collision.
    const KEEPS_LAST: bool = false;

    /// Number of the hero with the share of null collisions that decides at a collision.
    #[inline(always)]
    fn decides<L: Lane>(&self, hero: L, inside: L::Mask, random: &mut impl Random<L>) -> L {
        let _ = (inside, random);
        hero
    }

    /// σ̂ in a channel's share of null collisions.
    #[inline(always)]
    fn majorant<L: Lane>(&self, own: L, heros: impl Fn() -> L) -> L {
        let _ = heros;
        own
    }

    /// The probability of a null collision in spectral tracking, and the divisor of weights, given the right ones.
    #[inline(always)]
    fn tracked<L: Lane>(&self, right: L, shares: &[L]) -> [L; 2] {
        let _ = shares;
        [right, right]
    }

    /// The score of a channel by a walk for its hero alone; the channel may be the hero or another one.
    #[inline(always)]
    fn alone<L: Lane>(&self, is_hero: L::Mask, value: L, probability: f64) -> L {
        L::select(is_hero, value * (1.0 / probability), value.each(0.0))
    }

    /// `q_λ/q_h`, given the right one, σ̂ of the channel and of the hero, and the distance from the last collision
    /// to the end.
    #[inline(always)]
    fn relative<L: Lane>(&self, right: L, majorants: [L; 2], last: impl Fn() -> L) -> L {
        let _ = (majorants, last);
        right
    }

    /// `p_λ/q_h`, from `f_λ/q_h` and `q_λ/q_h`.
    #[inline(always)]
    fn density<L: Lane>(&self, delta: bool, contribution: L, relative: L) -> L {
        if delta { contribution } else { relative }
    }

    /// The probability of a hero in the mean density.
    #[inline(always)]
    fn share(&self, probability: f64, is_last: bool) -> f64 {
        let _ = is_last;
        probability
    }

    /// The divisor of a contribution: the mean density, or, by mistake, its own.
    #[inline(always)]
    fn divisor<L: Lane>(&self, mean: L, own: L) -> L {
        let _ = own;
        mean
    }
}

/// The right steps.
#[derive(Debug, Clone, Copy)]
pub struct Right;

impl WalkEvents for Right {}
