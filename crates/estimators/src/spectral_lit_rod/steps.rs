//! The steps of a walk to the emitter that a known bug may replace.

use crate::setup::heroes::Heroes;
use crate::walks::hero::Weighing;
use numeric::Lane;

/// The way in which a path was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Found {
    /// By a walk that was never scattered.
    Unscattered,
    /// By a walk, after a scattering.
    Hit,
    /// By a shadow ray.
    Connected,
}

impl Found {
    /// All ways.
    pub const ALL: [Self; 3] = [Self::Unscattered, Self::Hit, Self::Connected];

    /// As a number.
    #[inline(always)]
    pub fn as_lane<L: Lane>(self, any: L) -> L {
        any.each(f64::from(self as u8))
    }
}

/// The steps of a walk that a known bug may replace.
pub trait Steps: Sync {
    /// Whether the densities of the next segment go on from those of the last one.
    const GOES_ON: bool = false;

    /// Whether f gains the albedo at a scattering, and the densities do not.
    const GAINS: bool = false;

    /// Whether every shadow ray has a hero of its own.
    const CASTS_ANEW: bool = false;

    /// The distribution of the hero.
    fn heroes(&self) -> &Heroes;

    /// Whether shadow rays are cast.
    fn casts(&self) -> bool;

    /// The weighting of a path.
    #[inline(always)]
    fn weighing(&self, found: Found) -> Weighing {
        let has_next_event = self.casts() && found != Found::Unscattered;
        Weighing { has_next_event, ..Weighing::RIGHT }
    }

    /// The channel whose phase function counts in a channel.
    #[inline(always)]
    fn phase_of(&self, channel: usize, hero: usize) -> usize {
        let _ = hero;
        channel
    }

    /// `σ_t/σ̂` by which the hero's collisions are decided, or, by mistake, with σ̂ of the first channel.
    #[inline(always)]
    fn decides<L: Lane>(&self, right: L, by_first: impl Fn() -> L) -> L {
        let _ = by_first;
        right
    }
}
