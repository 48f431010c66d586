//! Sums over the events of walks in space, as one formula for every lane type.

use super::shadow::{Aim, LitLanes, ShadowRays, VisibleLight};
use numeric::geometry::Point;
use numeric::rng::Random;
use numeric::{Kept, Lane};

/// Tentative collisions.
pub struct CollisionTally<L: Lane> {
    /// Lanes with a collision.
    pub inside: L::Mask,
    /// The place.
    pub place: [L; 3],
    /// The weight before the collision.
    pub weight: L,
    /// `r = σ_t/σ̂`.
    pub ratio: L,
    /// a.
    pub albedo: L,
}

/// Particles that leave.
pub struct Departure<L: Lane> {
    /// Lanes that leave.
    pub left: L::Mask,
    /// The place.
    pub place: [L; 3],
    /// The direction.
    pub direction: [L; 3],
    /// The weight.
    pub weight: L,
    /// Lanes that were never scattered.
    pub unscattered: L::Mask,
}

/// Particles that are scattered, before their new directions are drawn.
pub struct Scattering<L: Lane> {
    /// Lanes that are scattered with a weight that is not 0.
    pub which: L::Mask,
    /// The place.
    pub place: [L; 3],
    /// The weight after the scattering: the albedo is in it.
    pub weight: L,
}

/// The beginning of the walks of a problem, and their values.
pub trait Tally {
    /// Sums and state of a walk so far.
    type Found<L: Lane>: Kept<L::Mask>;

    /// True if particles cast shadow rays where they are scattered.
    const CASTS: bool = false;

    /// True if scatterings have further estimates, see [`Tally::connect`].
    const CONNECTS: bool = false;

    /// Sums and state of a walk that begins.
    fn nothing<L: Lane>(&self, zero: L) -> Self::Found<L>;

    /// The number of channels of a draw.
    fn channels(&self) -> usize {
        1
    }

    /// The value of walks in a channel.
    fn value<L: Lane>(&self, totals: &Self::Found<L>, channel: usize) -> L;

    /// The places where particles set out, and their directions. Their weight is 1. Only lanes in `which` may take
    /// random numbers.
    fn begin<L: Lane>(&self, one: L, which: L::Mask, random: &mut impl Random<L>) -> [[L; 3]; 2];

    /// Adds flights of given lengths and weights.
    #[inline(always)]
    fn flown<L: Lane>(&self, totals: &mut Self::Found<L>, length: L, weight: L) {
        let _ = (totals, length, weight);
    }

    /// Adds tentative collisions.
    #[inline(always)]
    fn collided<L: Lane>(&self, totals: &mut Self::Found<L>, at: &CollisionTally<L>) {
        let _ = (totals, at);
    }

    /// Adds particles that leave.
    #[inline(always)]
    fn escaped<L: Lane>(&self, totals: &mut Self::Found<L>, at: &Departure<L>) {
        let _ = (totals, at);
    }

    /// A black ball that absorbs every particle that reaches it: centre and radius.
    fn core(&self) -> Option<(Point, f64)> {
        None
    }

    /// The shadow rays, if they are cast.
    fn shadow_rays(&self) -> Option<ShadowRays<'_>> {
        None
    }

    /// True if a walk begins as if it were scattered: it casts a shadow ray, if particles do, and turns.
    fn begins_turned(&self) -> bool {
        false
    }

    /// Cosine of the turn at the beginning, from a uniform number.
    #[inline(always)]
    fn first_cosine<L: Lane>(&self, number: L) -> L {
        number * 2.0 - 1.0
    }

    /// The one direction of all shadow rays, which then take no random numbers.
    fn parallel(&self) -> Option<Point> {
        None
    }

    /// The aim of shadow rays from places, from uniform numbers.
    #[inline(always)]
    fn aim<L: Lane>(&self, place: [L; 3], number: L) -> Aim<L> {
        let _ = number;
        let zero = place[0].each(0.0);
        Aim { axis: place, cosine: zero, share: zero, distance: zero }
    }

    /// The light of shadow rays from places, given the light that was aimed at.
    #[inline(always)]
    fn light<L: Lane>(&self, place: [L; 3], aimed: VisibleLight<L>) -> VisibleLight<L> {
        let _ = place;
        aimed
    }

    /// Adds scatterings at places of the lanes in `which`, or beginnings as if they were scattered.
    #[inline(always)]
    fn scattered<L: Lane>(&self, totals: &mut Self::Found<L>, which: L::Mask, place: [L; 3]) {
        let _ = (totals, which, place);
    }

    /// Adds light that shadow rays have found, by its transmittance.
    #[inline(always)]
    fn lit<L: Lane>(&self, totals: &mut Self::Found<L>, light: LitLanes<L>, through: L) {
        let _ = (totals, light, through);
    }

    /// Casts shadow rays to a light, if there are no [`Tally::shadow_rays`]; returns the number of lookups. Their
    /// lines are in the bounds between `ends`.
    #[inline(always)]
    fn track<L: Lane>(
        &self,
        totals: &mut Self::Found<L>,
        at: &Scattering<L>,
        (light, ends): (&VisibleLight<L>, [L; 2]),
        random: &mut impl Random<L>,
    ) -> L {
        let _ = (totals, light, ends, random);
        at.weight.each(0.0)
    }

    /// Adds further estimates at scatterings, after their shadow rays; returns the number of lookups.
    #[inline(always)]
    fn connect<L: Lane>(
        &self,
        totals: &mut Self::Found<L>,
        at: &Scattering<L>,
        random: &mut impl Random<L>,
    ) -> L {
        let _ = (totals, random);
        at.weight.each(0.0)
    }
}
