//! Subpaths by delta tracking, from the light or from the sensor, and connections by ratio tracking.
//!
//! A flight and each tentative collision take a random number. A scattering takes one more, which decides between
//! absorption, forward and backward. The last vertex of a subpath is a real collision, where nothing is decided
//! yet. A flight goes on until the last lane has come to its next real collision. The other lanes and their streams
//! stand still until then.

use super::path::Path;
use crate::Setup;
use media::sampling::BothWays;
use numeric::rng::Random;
use numeric::{Lane, Mask};
use theory::problems::BidirectionalRod;
use theory::problems::bidirectional_rod::{HIGHEST_ORDER, MAX_CHANNELS, Sensor};

/// The side from which a subpath begins.
#[derive(Clone, Copy, PartialEq)]
pub enum Side {
    /// The light.
    Light = 0,
    /// The sensor.
    Camera = 1,
}

/// Real collisions of walks.
#[derive(Clone, Copy)]
pub struct Subpath<L: Lane, P> {
    /// Distances of the collisions along the ray.
    pub at: [L; HIGHEST_ORDER],
    /// Lanes with a flight that goes forward: to each collision, and out of the rod.
    pub is_forward: [L::Mask; HIGHEST_ORDER + 1],
    /// `∏ (1 − σ_t/σ̂)` over the null vertices of each flight.
    pub nulls: [L; HIGHEST_ORDER + 1],
    /// Positions of the walk at its beginning and at each collision.
    pub places: [P; HIGHEST_ORDER + 1],
    /// Lanes with at least this number of collisions.
    pub reached: [L::Mask; HIGHEST_ORDER + 1],
    /// Lanes that left the rod after this number of collisions.
    pub left: [L::Mask; HIGHEST_ORDER + 1],
}

/// Functions that are evaluated for all lanes at once.
pub trait LaneFunctions<L: Lane> {
    /// σ_t at distances.
    fn extinction(&self, t: L) -> L;

    /// `e^x`, with the bits that each lane has by itself.
    fn exp(&self, x: L) -> L;
}

/// Tracking through the rod of one experiment. It is passed by reference: copies would cost more than the draws.
pub struct RodTracker<'a, L: Lane, C: BothWays<L>, F> {
    /// The rod and σ̂.
    pub setup: &'a Setup<BidirectionalRod>,
    /// σ_t.
    pub field: F,
    /// Walks at the beginning of σ̂, and at its end.
    ends: [C; 2],
    /// The number of lookups so far.
    pub lookups: L,
    /// The last subpaths from either side.
    pub subpaths: [Subpath<L, C::Place>; 2],
    /// The path that is built from them.
    pub path: Path<L>,
    /// The values of channels so far.
    pub values: [L; MAX_CHANNELS],
}

impl<'a, L: Lane, C: BothWays<L>, F: LaneFunctions<L>> RodTracker<'a, L, C, F> {
    /// A tracker without lookups; `ends` are at the beginning and at the end of σ̂.
    #[inline(always)]
    pub fn new(setup: &'a Setup<BidirectionalRod>, zero: L, ends: [C; 2], field: F) -> Self {
        let (none, place) = (zero.below(zero), ends[0].place());
        let subpath = Subpath {
            at: [zero; HIGHEST_ORDER],
            is_forward: [none; HIGHEST_ORDER + 1],
            nulls: [zero; HIGHEST_ORDER + 1],
            places: [place; HIGHEST_ORDER + 1],
            reached: [none; HIGHEST_ORDER + 1],
            left: [none; HIGHEST_ORDER + 1],
        };
        let path = Path::new(zero.each(1.0), setup.problem.albedo);
        let (subpaths, values) = ([subpath; 2], [zero; MAX_CHANNELS]);
        Self { setup, field, ends, lookups: zero, subpaths, path, values }
    }

    /// Walks of the lanes in `which` to a number of `collisions`, and one flight beyond if `beyond` is 1.
    #[inline(always)]
    pub fn walk(
        &mut self,
        side: Side,
        [collisions, beyond]: [usize; 2],
        which: L::Mask,
        random: &mut impl Random<L>,
    ) {
        let (problem, none) = (&*self.setup.problem, which & !which);
        let begins_forward = side == Side::Light || problem.sensor == Sensor::Reflected;
        let mut course = self.ends[usize::from(!begins_forward)];
        let (mut flying, mut is_forward) = (which, if begins_forward { !none } else { none });
        let one = self.lookups.each(1.0);
        let (albedo, forward) =
            (one.each(problem.albedo), one.each(problem.albedo * problem.forward));
        let side = side as usize;
        (self.subpaths[side].places[0], self.subpaths[side].reached[0]) = (course.place(), which);
        for flight in 0..collisions + beyond {
            if flight > 0 {
                let number = random.uniform_where(flying);
                flying &= number.below(albedo);
                is_forward ^= flying & forward.at_most(number);
            }
            let (real, nulls) = self.fly(&mut course, flying, is_forward, random);
            let subpath = &mut self.subpaths[side];
            subpath.is_forward[flight] = is_forward;
            subpath.nulls[flight] = nulls;
            subpath.left[flight] = flying & !real;
            if flight < collisions {
                subpath.at[flight] = course.reached();
                subpath.places[flight + 1] = course.place();
                subpath.reached[flight + 1] = real;
            }
            flying = real;
        }
    }

    /// Flies lanes to their next real collisions, or out of the rod. Returns the lanes that collided, and the
    /// products over null vertices.
    #[inline(always)]
    fn fly(
        &mut self,
        course: &mut C,
        mut flying: L::Mask,
        is_forward: L::Mask,
        random: &mut impl Random<L>,
    ) -> (L::Mask, L) {
        let (mut nulls, mut real) = (self.lookups.each(1.0), flying & !flying);
        while flying.any() {
            flying &= step(course, flying, is_forward, random);
            let ratio = self.look_up(course, flying);
            let collides = flying & random.uniform_where(flying).below(ratio);
            flying &= !collides;
            nulls.scale_where(flying, ratio.one_minus());
            real |= collides;
        }
        (real, nulls)
    }

    /// `∏ (1 − σ_t/σ̂)` of lanes on the way from a place to distances: ratio tracking.
    #[inline(always)]
    pub fn connect(
        &mut self,
        from: C::Place,
        to: L,
        (mut flying, is_forward): (L::Mask, L::Mask),
        random: &mut impl Random<L>,
    ) -> L {
        let (mut nulls, mut course) = (to.each(1.0), self.ends[0]);
        course.return_to(from);
        while flying.any() {
            flying &= step(&mut course, flying, is_forward, random);
            let t = course.reached();
            flying &= (is_forward & t.below(to)) | (!is_forward & to.below(t));
            let ratio = self.look_up(&course, flying);
            nulls.scale_where(flying, ratio.one_minus());
        }
        nulls
    }

    /// `σ_t/σ̂` at the positions of the lanes in `flying`.
    #[inline(always)]
    fn look_up(&mut self, course: &C, flying: L::Mask) -> L {
        self.lookups.count_where(flying);
        // Beyond both ends there is no field to look at.
        let t = L::select(flying, course.reached(), self.ends[0].reached());
        self.field.extinction(t) / course.sampling()
    }
}

/// Flies to the next tentative collisions; answers which lanes are inside. The others stay where they are.
#[inline(always)]
fn step<L: Lane>(
    course: &mut impl BothWays<L>,
    flying: L::Mask,
    is_forward: L::Mask,
    random: &mut impl Random<L>,
) -> L::Mask {
    let depth = -random.ln_uniform_where(flying);
    course.fly_either_way(L::select(flying, depth, depth.each(0.0)), is_forward)
}
