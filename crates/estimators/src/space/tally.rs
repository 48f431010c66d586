//! What walks in space are worth: sums over what happens on the way, one formula for one walk and for eight.

use fearless_simd::{Simd, f64x8, mask64x8};

use super::exit::Points;
use super::shadow::{Aim, Found, ShadowRays};
use super::walk::Sink;
use crate::kernels::packet::bank::Numbers;
use numeric::Lane;
use numeric::geometry::Point;
use theory::problems::Values;

/// A tentative collision, or eight.
pub struct Collision<L: Lane> {
    /// Which of them there are.
    pub inside: L::Mask,
    /// Where.
    pub place: [L; 3],
    /// The weights before them.
    pub weight: L,
    /// `r = σ_t/σ̂`.
    pub ratio: L,
    /// a.
    pub albedo: L,
}

/// A particle that may have left, or eight.
pub struct Departure<L: Lane> {
    /// Which of them have.
    pub left: L::Mask,
    /// Where.
    pub place: [L; 3],
    /// In which direction.
    pub direction: [L; 3],
    /// With which weight.
    pub weight: L,
    /// Which of all were never scattered.
    pub unscattered: L::Mask,
}

/// How walks of a problem begin, and what they are worth: so many sums, which begin at 0.
pub trait Tally<const SUMS: usize> {
    /// Whether particles cast shadow rays where they are scattered.
    const CASTS: bool = false;

    /// Where particles set out, and in which directions; those that a mask names may take numbers for it.
    /// Their weight is 1.
    fn begin<S: Simd>(
        &self,
        simd: S,
        numbers: &mut Numbers<S>,
        which: mask64x8<S>,
    ) -> [Points<S>; 2];

    /// Particles flew lengths, with weights.
    #[inline(always)]
    fn flown<L: Lane>(&self, sums: &mut [L; SUMS], length: L, weight: L) {
        let _ = (sums, length, weight);
    }

    /// They met tentative collisions.
    #[inline(always)]
    fn collided<L: Lane>(&self, sums: &mut [L; SUMS], at: &Collision<L>) {
        let _ = (sums, at);
    }

    /// They left.
    #[inline(always)]
    fn escaped<L: Lane>(&self, sums: &mut [L; SUMS], at: &Departure<L>) {
        let _ = (sums, at);
    }

    /// A black ball that stops all that meets it.
    fn core(&self) -> Option<(Point, f64)> {
        None
    }

    /// How shadow rays are cast.
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

    /// The one direction of all shadow rays, which take no numbers then.
    fn parallel(&self) -> Option<Point> {
        None
    }

    /// How shadow rays from places are aimed by uniform numbers.
    #[inline(always)]
    fn aim<S: Simd>(&self, place: Points<S>, number: f64x8<S>) -> Aim<f64x8<S>> {
        let _ = number;
        let zero = place[0].each(0.0);
        Aim { axis: place, cosine: zero, share: zero, distance: zero }
    }

    /// Those that a mask names are scattered at places, or begin there as if they were.
    #[inline(always)]
    fn scattered<L: Lane>(&self, sums: &mut [L; SUMS], which: L::Mask, place: [L; 3]) {
        let _ = (sums, which, place);
    }

    /// Shadow rays found light through tracked transmittances.
    #[inline(always)]
    fn lit<S: Simd>(&self, sums: &mut [f64x8<S>; SUMS], found: Found<S>, through: f64x8<S>) {
        let _ = (sums, found, through);
    }

    /// Which sum each channel of a draw is.
    fn channels(&self) -> &[usize];
}

/// Adds to a sum where a mask says so.
#[inline(always)]
pub fn add_where<L: Lane>(sum: &mut L, mask: L::Mask, term: L) {
    *sum = L::select(mask, *sum + term, *sum);
}

/// The sums of one walk.
pub struct Sums<'a, T, const SUMS: usize> {
    tally: &'a T,
    /// What they have come to.
    pub at: [f64; SUMS],
}

impl<'a, T: Tally<SUMS>, const SUMS: usize> Sums<'a, T, SUMS> {
    /// Of a walk that begins.
    pub fn new(tally: &'a T) -> Self {
        Self { tally, at: [0.0; SUMS] }
    }

    /// The channels of the draw.
    pub fn values<const N: usize>(&self) -> Values<N> {
        let channels = self.tally.channels();
        let mut values = Values { at: [0.0; N], count: channels.len() };
        values.at.iter_mut().zip(channels).for_each(|(value, &sum)| *value = self.at[sum]);
        values
    }
}

impl<T: Tally<SUMS>, const SUMS: usize> Sink for Sums<'_, T, SUMS> {
    fn flown(&mut self, length: f64, weight: f64) {
        self.tally.flown(&mut self.at, length, weight);
    }

    fn collided(&mut self, at: &Collision<f64>) {
        self.tally.collided(&mut self.at, at);
    }

    fn escaped(&mut self, at: Point, direction: Point, weight: f64, order: u32) {
        let (place, direction) = (at.0, direction.0);
        let at = Departure { left: true, place, direction, weight, unscattered: order == 0 };
        self.tally.escaped(&mut self.at, &at);
    }
}
