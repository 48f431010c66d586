//! Sums over what happens to walks in space, as one formula for every lane type.

use super::shadow::{Aim, Light, Lit, ShadowRays};
use numeric::geometry::Point;
use numeric::rng::Random;
use numeric::{Kept, Lane};

/// Tentative collisions.
pub struct Collision<L: Lane> {
    /// Lanes with a collision.
    pub inside: L::Mask,
    /// The place.
    pub place: [L; 3],
    /// The weight before it.
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
    /// The weight after it, the albedo in it.
    pub weight: L,
}

/// The beginning of the walks of a problem, and their values.
pub trait Tally {
    /// Sums and notes of a walk so far.
    type Found<L: Lane>: Kept<L::Mask>;

    /// Whether particles cast shadow rays where they are scattered.
    const CASTS: bool = false;

    /// Whether something else is estimated from scatterings, see [`Tally::connect`].
    const CONNECTS: bool = false;

    /// Sums and notes of a walk that begins.
    fn nothing<L: Lane>(&self, zero: L) -> Self::Found<L>;

    /// The number of [`Tally::sums`].
    const SUMS: usize = 1;

    /// Sums, of which the channels of a draw are some.
    fn sums<L: Lane>(found: &Self::Found<L>) -> &[L];

    /// The sums that are the channels of a draw.
    fn channels(&self) -> &[usize] {
        &[0]
    }

    /// The places where particles set out, and their directions. Their weight is 1. Only lanes in `which` may take random
    /// numbers.
    fn begin<L: Lane>(&self, one: L, which: L::Mask, random: &mut impl Random<L>) -> [[L; 3]; 2];

    /// Particles fly lengths, with weights.
    #[inline(always)]
    fn flown<L: Lane>(&self, found: &mut Self::Found<L>, length: L, weight: L) {
        let _ = (found, length, weight);
    }

    /// Particles come to tentative collisions.
    #[inline(always)]
    fn collided<L: Lane>(&self, found: &mut Self::Found<L>, at: &Collision<L>) {
        let _ = (found, at);
    }

    /// Particles leave.
    #[inline(always)]
    fn escaped<L: Lane>(&self, found: &mut Self::Found<L>, at: &Departure<L>) {
        let _ = (found, at);
    }

    /// A black ball that stops all that meets it.
    fn core(&self) -> Option<(Point, f64)> {
        None
    }

    /// The shadow rays, if they are cast.
    fn shadow_rays(&self) -> Option<ShadowRays<'_>> {
        None
    }

    /// Whether a walk begins as if it were scattered: it casts a shadow ray, if particles do, and turns.
    fn begins_turned(&self) -> bool {
        false
    }

    /// The cosine with which it turns there, of a uniform number.
    #[inline(always)]
    fn first_cosine<L: Lane>(&self, number: L) -> L {
        number * 2.0 - 1.0
    }

    /// The one direction of all shadow rays, which then take no numbers.
    fn parallel(&self) -> Option<Point> {
        None
    }

    /// The aim of shadow rays from places, of uniform numbers.
    #[inline(always)]
    fn aim<L: Lane>(&self, place: [L; 3], number: L) -> Aim<L> {
        let _ = number;
        let zero = place[0].each(0.0);
        Aim { axis: place, cosine: zero, share: zero, distance: zero }
    }

    /// The light that shadow rays from places are cast to, from the light aimed at.
    #[inline(always)]
    fn light<L: Lane>(&self, place: [L; 3], aimed: Light<L>) -> Light<L> {
        let _ = place;
        aimed
    }

    /// The lanes in `which` are scattered at places, or begin there as if they were.
    #[inline(always)]
    fn scattered<L: Lane>(&self, found: &mut Self::Found<L>, which: L::Mask, place: [L; 3]) {
        let _ = (found, which, place);
    }

    /// Shadow rays find light through transmittances.
    #[inline(always)]
    fn lit<L: Lane>(&self, found: &mut Self::Found<L>, light: Lit<L>, through: L) {
        let _ = (found, light, through);
    }

    /// Casts shadow rays to a light, if there are no [`Tally::shadow_rays`]; answers lookups. Their lines are in the bounds
    /// between `ends`.
    #[inline(always)]
    fn track<L: Lane>(
        &self,
        found: &mut Self::Found<L>,
        at: &Scattering<L>,
        (light, ends): (&Light<L>, [L; 2]),
        random: &mut impl Random<L>,
    ) -> L {
        let _ = (found, light, ends, random);
        at.weight.each(0.0)
    }

    /// Estimates something else from scatterings, after their shadow rays; answers lookups.
    #[inline(always)]
    fn connect<L: Lane>(
        &self,
        found: &mut Self::Found<L>,
        at: &Scattering<L>,
        random: &mut impl Random<L>,
    ) -> L {
        let _ = (found, random);
        at.weight.each(0.0)
    }
}
