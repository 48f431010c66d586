//! The steps of a walk to the emitter that a known bug may replace.

use crate::setup::heroes::Heroes;
use crate::walks::hero::Weighing;
use numeric::Lane;

/// Technique by which a path was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PathTechnique {
    /// A walk that was never scattered.
    Unscattered,
    /// A walk, after a scattering.
    Hit,
    /// A shadow ray.
    Connected,
}

impl PathTechnique {
    /// All techniques.
    pub const ALL: [Self; 3] = [Self::Unscattered, Self::Hit, Self::Connected];

    /// Number of the technique: 0, 1 or 2.
    #[inline(always)]
    pub fn as_lane<L: Lane>(self, any: L) -> L {
        any.each(f64::from(self as u8))
    }
}

/// Events of a walk, each of which a known bug may replace.
pub trait WalkEvents: Sync {
    /// True if the densities of the next segment go on from those of the last one.
    const GOES_ON: bool = false;

    /// True if f gains the albedo at a scattering, and the densities do not.
    const GAINS: bool = false;

    /// True if every shadow ray has a hero of its own.
    const CASTS_ANEW: bool = false;

    /// The distribution of the hero.
    fn heroes(&self) -> &Heroes;

    /// True if shadow rays are cast.
    fn has_shadow_rays(&self) -> bool;

    /// Weighting of paths of a technique.
    #[inline(always)]
    fn weighing(&self, light: PathTechnique) -> Weighing {
        let has_next_event = self.has_shadow_rays() && light != PathTechnique::Unscattered;
        Weighing { has_next_event, ..Weighing::RIGHT }
    }

    /// Index of the channel with the phase function that a channel uses.
    #[inline(always)]
    fn phase_of(&self, channel: usize, hero: usize) -> usize {
        let _ = hero;
        channel
    }

    /// Ratio `σ_t/σ̂` that decides the hero's collisions: `right`, or, in a known bug, with σ̂ of the first
    /// channel.
    #[inline(always)]
    fn decides<L: Lane>(&self, right: L, by_first: impl Fn() -> L) -> L {
        let _ = by_first;
        right
    }
}
