//! Any walk along a ray, with one wrong step.
//!
//! ```text
//! numbers    draws the optical depth of a flight, and the random number of the decision at its end
//! fly        flies through σ̂
//! distance   returns the distance at which σ_t is looked up
//! collide    changes the walk by σ_t at a distance; some walks end
//! value      returns the score of a finished walk
//! ```
//!
//! [`Wrong`] wraps a walk of the estimators: it forwards each step to the walk, and one [`Slip`] changes one of them.
//! `Slip::None` changes nothing: that walk is the control. Changes of a σ_t after its lookup, and of the final value,
//! break the invariant of a product estimator, and count as its defect.

use estimators::setup::ControlledLine;
use estimators::walks::{Met, Route, Walk};
use estimators::{Estimated, Setup};
use media::course::BothWays;
use media::{Control, Piecewise};
use numeric::rng::Random;
use numeric::{Kept, Lane, Span, kept};

/// Flights that are kept to be repeated.
const KEPT_FLIGHTS: usize = 16;
/// Walks of a smaller weight are ended, wrongly.
const FAINT: f64 = 0.1;

/// A wrong step. The tables of known bugs describe the variants that have no comment here.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Slip {
    None,
    /// Optical depths of flights are multiplied by this factor.
    Deeper(f64),
    AsConstant,
    Replayed,
    FlightSingle,
    /// Uniform numbers are cut to this number of bits.
    Bits(i32),
    Shared,
    SharedReversed,
    Stale,
    OneForAll,
    Overshoots,
    AtPrevious,
    AtMidpoint,
    Reversed,
    OnRaster,
    OfAnotherChannel,
    /// Functions of the distance of a collision take the distance of the collision before it.
    OfLastCollision,
    ControlToCollision,
    GlobalMajorant,
    FirstSkipped,
    EndWeighted,
    LateEnd,
    /// Maximum number of collisions, and whether walks that end by it count as through.
    Cap(f64, bool),
    Roulette,
    CutOff,
    Clamped,
    ControlToLast,
    ControlTwice,
    LastMissing,
    FromOrigin,
    EscapeAtLast,
    PositionSingle,
    Shifted,
    WithoutFirst,
    AddsWeight,
}

/// A number in single precision.
#[allow(clippy::cast_possible_truncation)] // the bug
pub fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

kept! {
    /// State that slips need beside that of the walk.
    pub struct Notes<L> {
        /// The beginning of the flight.
        from: L,
        collisions: L,
        /// `∏ (1 − r)`.
        weight: L,
        /// A random number that is used again.
        number: L,
        /// Flights to be repeated, and their number.
        flights: [L; KEPT_FLIGHTS],
        waiting: L,
        /// The distance that flights reached, even beyond the end of a segment.
        came_to: L,
        /// Value of the walk at its beginning.
        first: L,
        /// Changes of r after σ_t was looked up.
        broken: L,
        /// Lanes that are beyond the end, count as through, or are lost.
        is_over: L::Mask,
        is_through: L::Mask,
        is_lost: L::Mask,
    }
}

impl<L: Lane> Notes<L> {
    #[inline(always)]
    fn new(from: L, first: L) -> Self {
        let (zero, none) = (from.each(0.0), from.below(from));
        Self {
            from,
            collisions: zero,
            weight: from.each(1.0),
            number: zero,
            flights: [zero; KEPT_FLIGHTS],
            waiting: zero,
            came_to: from,
            first,
            broken: zero,
            is_over: none,
            is_through: none,
            is_lost: none,
        }
    }

    /// Keeps the depth of a flight in the first half of the ray, and replaces one in the second half by a kept one.
    #[inline(always)]
    fn replayed(&mut self, depth: L, middle: f64) -> L {
        let is_first = self.from.at_most(depth.each(middle));
        let repeats = !is_first & depth.each(0.5).below(self.waiting);
        let answer = L::select(repeats, self.flights[0], depth);
        for number in 1..KEPT_FLIGHTS {
            let next = self.flights[number];
            self.flights[number - 1].set_where(repeats, next);
        }
        self.waiting.add_where(repeats, depth.each(-1.0));
        let is_kept = is_first & self.waiting.below(depth.each(KEPT_FLIGHTS as f64));
        for (number, flight) in self.flights.iter_mut().enumerate() {
            flight.set_where(is_kept & self.waiting.equals(number as f64), depth);
        }
        self.waiting.count_where(is_kept);
        answer
    }
}

/// State of a walk, its state before the last collision, and notes.
#[derive(Clone, Copy)]
pub struct Memory<L: Lane, T> {
    walk: T,
    before: T,
    notes: Notes<L>,
}

impl<L: Lane, T: Kept<L::Mask>> Kept<L::Mask> for Memory<L, T> {
    #[inline(always)]
    fn set_where(&mut self, which: L::Mask, other: Self) {
        self.walk.set_where(which, other.walk);
        self.before.set_where(which, other.before);
        self.notes.set_where(which, other.notes);
    }
}

/// A walk with a slip.
#[derive(Clone, Copy)]
pub struct Wrong<'a, W> {
    walk: W,
    slip: Slip,
    /// The whole ray, and the part of it with a medium.
    ray: Span,
    support: Span,
    sampling: &'a Piecewise,
    control: &'a Control,
}

impl<'a, W: Walk> Wrong<'a, W> {
    /// Wraps a walk on its setup.
    pub fn new<P: Estimated<Fields = ControlledLine>>(
        walk: W,
        slip: Slip,
        setup: &'a Setup<P>,
    ) -> Self {
        let (ray, support) = (setup.problem.medium().span(), setup.fields.mesh.support());
        Self {
            walk,
            slip,
            ray,
            support,
            sampling: &setup.fields.sampling,
            control: &setup.fields.control,
        }
    }

    /// `∫σ_c` between distances.
    #[inline(always)]
    fn control_depth<L: Lane>(&self, from: L, to: L) -> L {
        let begin = self.support.from;
        self.control.depths(begin, to) - self.control.depths(begin, from)
    }

    /// Optical depth of the place that a flight of `depth` would reach if σ̂ stayed as at its beginning.
    #[inline(always)]
    fn as_constant<L: Lane>(&self, from: L, depth: L) -> L {
        let knots = self.sampling.knots();
        let to = depth / self.sampling.value(from) + from;
        let through = self.sampling.depths(knots[0], to) - self.sampling.depths(knots[0], from);
        L::select(to.below(to.each(knots[knots.len() - 1])), through, to.each(f64::INFINITY))
    }

    /// End of the segment of σ̂ that contains a distance.
    fn end_of_segment(&self, t: f64) -> f64 {
        let mut ends = self.sampling.stretches().iter().map(|row| row.0[1]);
        ends.find(|&end| t < end).unwrap_or(t)
    }
}

impl<W: Walk> Walk for Wrong<'_, W> {
    type State<L: Lane> = Memory<L, W::State<L>>;

    const DECIDES: bool = W::DECIDES;
    const PAUSES: bool = W::PAUSES;
    const HAS_DEFECT: bool = W::HAS_DEFECT;
    const IS_NOWHERE: bool = W::IS_NOWHERE;

    #[inline(always)]
    fn begin<L: Lane>(
        &self,
        one: L,
        which: L::Mask,
        random: &mut impl Random<L>,
    ) -> Self::State<L> {
        let walk = self.walk.begin(one, which, random);
        let first = self.walk.value(&walk, one.at_most(one), 0);
        Memory { walk, before: walk, notes: Notes::new(one.each(self.support.from), first) }
    }

    #[inline(always)]
    fn numbers<L: Lane>(&self, memory: &mut Self::State<L>, random: &mut impl Random<L>) -> [L; 2] {
        let [depth, number] = self.walk.numbers(&mut memory.walk, random);
        let notes = &mut memory.notes;
        let uniform = || (-depth).exp().one_minus();
        let is_first = notes.collisions.equals(0.0);
        match self.slip {
            Slip::Deeper(factor) => [depth * factor, number],
            Slip::AsConstant => [self.as_constant(notes.from, depth), number],
            Slip::Replayed => [notes.replayed(depth, self.support.middle()), number],
            Slip::FlightSingle => [depth.map(single), number],
            Slip::Bits(bits) => {
                let scale = f64::exp2(f64::from(bits));
                let rounded = |u: L| u.map(|u| (u * scale).floor() / scale);
                [-rounded(uniform()).one_minus().ln(), rounded(number)]
            }
            Slip::Shared => [depth, uniform()],
            Slip::SharedReversed => [depth, uniform().one_minus()],
            Slip::Stale => {
                let stale = L::select(is_first, number, notes.number);
                notes.number = uniform();
                [depth, stale]
            }
            Slip::OneForAll => {
                notes.number.set_where(is_first, number);
                [depth, notes.number]
            }
            _ => [depth, number],
        }
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        memory: &mut Self::State<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        let Memory { walk, notes, .. } = memory;
        match self.slip {
            Slip::Overshoots => {
                let begin = self.walk.distance(walk, route);
                let mean_free_path = self.walk.mean_free_path(walk, route);
                let beyond = !notes.came_to.below(begin.map(|t| self.end_of_segment(t)));
                let ahead = (notes.came_to - begin).or_more(depth.each(0.0)) / mean_free_path;
                let depth = L::select(beyond, depth.each(f64::INFINITY), depth + ahead);
                notes.came_to.set_where(!beyond, depth.times_plus(mean_free_path, begin));
                self.walk.fly(walk, route, depth)
            }
            Slip::EndWeighted | Slip::LateEnd => {
                let was_over = notes.is_over;
                let inside = self.walk.fly(walk, route, depth);
                notes.is_over |= !inside;
                !was_over
            }
            _ => self.walk.fly(walk, route, depth),
        }
    }

    #[inline(always)]
    fn distance<L: Lane>(&self, memory: &Self::State<L>, route: &Route<impl BothWays<L>>) -> L {
        let Memory { walk, notes, .. } = memory;
        let t = self.walk.distance(walk, route);
        let Span { from, to } = self.support;
        match self.slip {
            Slip::AtPrevious => notes.from,
            Slip::AtMidpoint => (notes.from + t) * 0.5,
            Slip::Reversed => -t + (from + to),
            Slip::OnRaster => {
                let cell = (to - from) / 16.0;
                t.map(|t| from + ((t - from) / cell).floor() * cell)
            }
            Slip::EndWeighted | Slip::LateEnd => L::select(notes.is_over, t.each(to), t),
            _ => t,
        }
    }

    #[inline(always)]
    fn mean_free_path<L: Lane>(
        &self,
        memory: &Self::State<L>,
        route: &Route<impl BothWays<L>>,
    ) -> L {
        self.walk.mean_free_path(&memory.walk, route)
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        memory: &mut Self::State<L>,
        route: &mut Route<impl BothWays<L>>,
        met: &Met<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let Memory { walk, before, notes } = memory;
        let Met { inside, mean_free_path, .. } = *met;
        let zero = mean_free_path.each(0.0);
        let t = self.walk.distance(walk, route);
        let found = match self.slip {
            Slip::OfAnotherChannel => met.extinction * 0.8,
            Slip::LateEnd => L::select(notes.is_over, zero, met.extinction),
            Slip::ControlToCollision => {
                let decay = (-self.control_depth(notes.from, t)).exp();
                let control = self.control.extinction(t);
                let kept = ((met.extinction - control) * mean_free_path).one_minus() * decay;
                kept.one_minus() / mean_free_path + control
            }
            _ => met.extinction,
        };
        let extinction = match self.slip {
            Slip::GlobalMajorant => {
                let largest = self.sampling.corner_values().fold(0.0, f64::max);
                found / (mean_free_path * largest)
            }
            Slip::FirstSkipped => L::select(notes.collisions.equals(0.0), zero, found),
            _ => found,
        };
        notes.broken.add_where(inside, (extinction - found).size() * mean_free_path);
        before.set_where(inside, *walk);
        let place = match self.slip {
            Slip::OfLastCollision => notes.from,
            Slip::EndWeighted => met.t,
            _ => t,
        };
        let right = Met { t: place, extinction, ..*met };
        let goes_on = self.walk.collide(walk, route, &right, random);
        notes.collisions.count_where(inside);
        notes.from.set_where(inside, t);
        let weight = notes.weight * (extinction * mean_free_path).one_minus();
        notes.weight.set_where(inside, weight);
        let is_faint = goes_on & weight.size().below(zero.each(FAINT));
        let stops = match self.slip {
            Slip::Cap(most, passes) => {
                let stops = goes_on & !notes.collisions.below(zero.each(most));
                if passes {
                    notes.is_through |= stops;
                }
                stops
            }
            Slip::Roulette => is_faint & random.uniform_where(is_faint).below(zero.each(0.5)),
            Slip::CutOff => is_faint,
            _ => return goes_on,
        };
        notes.is_lost |= stops & !notes.is_through;
        goes_on & !stops
    }

    fn channels(&self) -> usize {
        self.walk.channels()
    }

    #[inline(always)]
    fn value<L: Lane>(&self, memory: &Self::State<L>, left: L::Mask, channel: usize) -> L {
        let Memory { walk, before, notes } = memory;
        let right = self.walk.value(walk, left | notes.is_through, channel);
        let Span { from, to } = self.support;
        let each = |value: f64| right.each(value);
        match self.slip {
            Slip::Clamped => right.or_more(each(0.0)),
            Slip::ControlToLast => right * self.control_depth(notes.from, each(to)).exp(),
            Slip::ControlTwice => right * (-self.control_depth(each(from), each(to))).exp(),
            Slip::LastMissing => self.walk.value(before, left, channel),
            Slip::Roulette | Slip::CutOff => L::select(notes.is_lost, each(0.0), right),
            Slip::FromOrigin => L::select(left, right, right + self.ray.from),
            Slip::EscapeAtLast => L::select(left, notes.from - self.ray.from, right),
            Slip::PositionSingle => {
                let place = (right + self.ray.from).map(single) - single(self.ray.from);
                L::select(left, right, place)
            }
            Slip::Shifted if channel == 0 => each(1.0),
            Slip::Shifted => self.walk.value(walk, left, channel - 1),
            Slip::WithoutFirst => right - notes.first,
            Slip::AddsWeight => right + notes.weight,
            _ => right,
        }
    }

    #[inline(always)]
    fn defect<L: Lane>(&self, memory: &Self::State<L>, zero: L) -> L {
        let right = self.walk.defect(&memory.walk, zero) + memory.notes.broken;
        match self.slip {
            Slip::Clamped | Slip::ControlToLast | Slip::ControlTwice | Slip::LastMissing => {
                let all = zero.at_most(zero);
                let value = self.walk.value(&memory.walk, all, 0);
                right + (self.value(memory, all, 0) - value).size()
            }
            _ => right,
        }
    }
}
