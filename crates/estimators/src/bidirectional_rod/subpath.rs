//! Subpaths by delta tracking, from the light or from the sensor.
//!
//! A flight and each tentative collision take a random number, a scattering one more, which says whether the
//! particle is absorbed, goes straight on or turns. The last vertex of a subpath is a real collision, where
//! nothing is decided yet.

use crate::Setup;
use media::{Cursor, Extinction, Lookups};
use numeric::rng::Stream;
use theory::problems::BidirectionalRod;
use theory::problems::bidirectional_rod::{HIGHEST_ORDER, Sensor};

/// Real collisions of one walk.
#[derive(Clone, Copy)]
pub struct Subpath {
    /// How many there are.
    pub count: usize,
    /// Where, as distances along the ray.
    pub at: [f64; HIGHEST_ORDER],
    /// The direction of each flight: to each collision, and out of the rod.
    pub is_forward: [bool; HIGHEST_ORDER + 1],
    /// `∏ (1 − σ_t/σ̂)` over the null vertices of each flight.
    pub nulls: [f64; HIGHEST_ORDER + 1],
    /// The walk at its beginning and at each collision.
    pub cursors: [Cursor; HIGHEST_ORDER + 1],
    /// The end of the rod, forward or not, at which it left after all of them.
    pub left: Option<bool>,
}

/// Tracking through the rod of one experiment.
#[derive(Clone, Copy)]
pub struct Tracker<'a> {
    /// The rod and σ̂.
    pub setup: &'a Setup<BidirectionalRod>,
    /// σ_t.
    pub medium: &'a Lookups<'a>,
}

impl Tracker<'_> {
    /// A walk to so many collisions and, where that is asked for, one flight beyond.
    #[inline(always)]
    pub fn subpath(
        &self,
        from_light: bool,
        [collisions, beyond]: [usize; 2],
        rng: &mut Stream,
        lookups: &mut u32,
    ) -> Subpath {
        let sampling = &self.setup.sampling;
        let mut is_forward = from_light || self.setup.problem.sensor == Sensor::Reflected;
        let mut cursor = if is_forward { sampling.begin() } else { sampling.end() };
        let mut subpath = Subpath {
            count: 0,
            at: [0.0; HIGHEST_ORDER],
            is_forward: [true; HIGHEST_ORDER + 1],
            nulls: [1.0; HIGHEST_ORDER + 1],
            cursors: [cursor; HIGHEST_ORDER + 1],
            left: None,
        };
        for flight in 0..collisions + beyond {
            if flight > 0 {
                let Some(turns) = self.scatter(rng) else { return subpath };
                is_forward ^= turns;
            }
            let (nulls, is_real) = self.fly(&mut cursor, is_forward, rng, lookups);
            subpath.is_forward[flight] = is_forward;
            subpath.nulls[flight] = nulls;
            if !is_real {
                subpath.left = Some(is_forward);
                return subpath;
            }
            if flight < collisions {
                subpath.at[flight] = cursor.t;
                subpath.count += 1;
                subpath.cursors[subpath.count] = cursor;
            }
        }
        subpath
    }

    /// Whether a scattered particle turns; `None` if it is absorbed.
    #[inline(always)]
    fn scatter(&self, rng: &mut Stream) -> Option<bool> {
        let (number, problem) = (rng.uniform(), &self.setup.problem);
        (number < problem.albedo).then(|| number >= problem.albedo * problem.forward)
    }

    /// Flies to the next real collision, or out of the rod.
    #[inline(always)]
    fn fly(
        &self,
        cursor: &mut Cursor,
        is_forward: bool,
        rng: &mut Stream,
        lookups: &mut u32,
    ) -> (f64, bool) {
        let mut nulls = 1.0;
        while let Some(sampling) = self.step(cursor, is_forward, rng) {
            *lookups += 1;
            let ratio = self.medium.extinction(cursor.t) / sampling;
            if rng.uniform() < ratio {
                return (nulls, true);
            }
            nulls *= 1.0 - ratio;
        }
        (nulls, false)
    }

    /// `∏ (1 − σ_t/σ̂)` on the way to a place: ratio tracking.
    #[inline(always)]
    pub fn connect(
        &self,
        mut cursor: Cursor,
        to: f64,
        is_forward: bool,
        rng: &mut Stream,
        lookups: &mut u32,
    ) -> f64 {
        let mut nulls = 1.0;
        while let Some(sampling) = self.step(&mut cursor, is_forward, rng) {
            let is_beyond = if is_forward { cursor.t >= to } else { cursor.t <= to };
            if is_beyond {
                break;
            }
            *lookups += 1;
            nulls *= 1.0 - self.medium.extinction(cursor.t) / sampling;
        }
        nulls
    }

    /// σ̂ at the next tentative collision.
    #[inline(always)]
    fn step(&self, cursor: &mut Cursor, is_forward: bool, rng: &mut Stream) -> Option<f64> {
        let (sampling, depth) = (&self.setup.sampling, -rng.ln_uniform());
        if is_forward { sampling.fly(cursor, depth) } else { sampling.fly_back(cursor, depth) }
    }
}
