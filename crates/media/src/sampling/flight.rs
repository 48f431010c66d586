//! Flights through straight pieces: of one walk, or of a pack of walks side by side.
//!
//! ```text
//! y₀ s + k s²/2 = u   ⇒   s = 2u / (y₀ + √(y₀² + 2ku))
//! ```

use super::{ConstantWithGaps, Piecewise};
use numeric::{Kept, Lane, Mask};

/// Positions of walks.
pub trait PackedFlight<L: Lane>: Copy {
    /// Flies each walk through an optical depth; returns the lanes that are still before the last knot.
    fn fly(&mut self, depth: L) -> L::Mask;

    /// The distances reached.
    fn reached(&self) -> L;

    /// `σ̂` at these distances.
    fn sampling(&self) -> L;

    /// The mean free paths `1/σ̂` at these distances.
    fn mean_free_path(&self) -> L;

    /// Restarts the lanes in `which`.
    fn restart(&mut self, which: L::Mask);

    /// Continues through a σ̂ with other values, one for each lane, given the mean free paths. Only where σ̂ has
    /// one value.
    #[inline(always)]
    fn change(&mut self, mean_free_path: L) {
        let _ = mean_free_path;
    }
}

/// Flights that may also go back.
pub trait BothWays<L: Lane>: PackedFlight<L> {
    /// Positions of walks, to be kept.
    type Place: Copy;

    /// Present positions.
    fn place(&self) -> Self::Place;

    /// Sets all positions.
    fn return_to(&mut self, place: Self::Place);

    /// Flies each walk forward or backward through an optical depth; returns the lanes that are still between the
    /// ends.
    fn fly_either_way(&mut self, depth: L, is_forward: L::Mask) -> L::Mask;

    /// Sets the positions of the lanes in `which` to those of other flights through the same field.
    fn copy_where(&mut self, which: L::Mask, other: &Self);
}

/// Flights through one value, with gaps.
#[derive(Clone, Copy)]
pub struct FlightWithGaps<'a, L> {
    field: &'a ConstantWithGaps,
    begin: L,
    end: L,
    rate: L,
    path: L,
    way: L,
}

impl<'a, L: Lane> FlightWithGaps<'a, L> {
    /// Flights from the beginning of a field; `any` is an arbitrary lane.
    #[inline(always)]
    pub fn new(any: L, field: &'a ConstantWithGaps) -> Self {
        let (begin, end) = (any.each(field.from), any.each(field.to));
        let (rate, path) = (any.each(field.value), any.each(1.0 / field.value));
        Self { field, begin, end, rate, path, way: begin }
    }

    /// Flights from the end of the field.
    #[must_use]
    #[inline(always)]
    pub fn from_end(self) -> Self {
        Self { way: self.end, ..self }
    }
}

impl<L: Lane> PackedFlight<L> for FlightWithGaps<'_, L> {
    #[inline(always)]
    fn fly(&mut self, depth: L) -> L::Mask {
        self.way = depth.times_plus(self.path, self.way);
        self.way.below(self.end)
    }

    #[inline(always)]
    fn reached(&self) -> L {
        self.field.spread(self.way)
    }

    #[inline(always)]
    fn sampling(&self) -> L {
        self.rate
    }

    #[inline(always)]
    fn mean_free_path(&self) -> L {
        self.path
    }

    #[inline(always)]
    fn restart(&mut self, which: L::Mask) {
        self.way.set_where(which, self.begin);
    }

    #[inline(always)]
    fn change(&mut self, mean_free_path: L) {
        self.path = mean_free_path;
    }
}

impl<L: Lane> BothWays<L> for FlightWithGaps<'_, L> {
    type Place = L;

    #[inline(always)]
    fn place(&self) -> L {
        self.way
    }

    #[inline(always)]
    fn return_to(&mut self, way: L) {
        self.way = way;
    }

    #[inline(always)]
    fn fly_either_way(&mut self, depth: L, is_forward: L::Mask) -> L::Mask {
        self.way = L::select(is_forward, depth, -depth).times_plus(self.path, self.way);
        (is_forward & self.way.below(self.end)) | (!is_forward & self.begin.below(self.way))
    }

    #[inline(always)]
    fn copy_where(&mut self, which: L::Mask, other: &Self) {
        self.way.set_where(which, other.way);
    }
}

/// Flights through any pieces: each walk stores its own piece, and looks up the next one when it crosses.
#[derive(Clone, Copy)]
pub struct FlightOverPieces<'a, L> {
    field: &'a Piecewise,
    /// The number of the piece, and its row of [`Piecewise::rows`].
    piece: L,
    at_hand: [L; 5],
    t: L,
}

impl<'a, L: Lane> FlightOverPieces<'a, L> {
    /// Flights from the first knot; `any` is an arbitrary lane.
    #[inline(always)]
    pub fn new(any: L, field: &'a Piecewise) -> Self {
        let (piece, t) = (any.each(0.0), any.each(field.knots[0]));
        Self { field, piece, at_hand: piece.columns(&field.rows), t }
    }

    /// Flights from the last knot.
    #[must_use]
    #[inline(always)]
    pub fn from_end(self) -> Self {
        self.from(self.field.knots[self.field.left.len()])
    }

    /// Flights from a distance between the first and the last knot.
    #[must_use]
    pub(super) fn from(self, t: f64) -> Self {
        let piece = self.t.each(self.field.piece_at(t).1 as f64);
        Self { piece, at_hand: piece.columns(&self.field.rows), t: self.t.each(t), ..self }
    }

    /// σ̂ at the distances reached.
    #[inline(always)]
    fn here(&self) -> L {
        let [knot, left, slope, ..] = self.at_hand;
        left + slope * (self.t - knot)
    }

    /// Stores the pieces of the lanes in `which`.
    #[inline(always)]
    fn look_up(&mut self, which: L::Mask) {
        self.at_hand.set_where(which, self.piece.columns(&self.field.rows));
    }

    /// Flies each walk through an optical depth: forward, or, if `BOTH`, either way.
    #[inline(always)]
    fn go<const BOTH: bool>(&mut self, mut depth: L, is_forward: L::Mask) -> L::Mask {
        let (zero, one) = (depth.each(0.0), depth.each(1.0));
        let ahead = |on: L, back: L| if BOTH { L::select(is_forward, on, back) } else { on };
        let signed = |x: L| ahead(x, -x);
        let last = zero.each((self.field.left.len() - 1) as f64);
        let (mut flying, mut arrived) = (zero.at_most(zero), zero.below(zero));
        loop {
            let [knot, left, slope, end, right] = self.at_hand;
            let (here, edge, there) = (self.here(), ahead(end, knot), ahead(right, left));
            let rest = signed(edge - self.t) * 0.5 * (here + there);
            let arrives = flying & depth.below(rest);
            if arrives.maybe() {
                let root = (here * here + signed(slope * 2.0 * depth)).or_more(zero).root();
                self.t.set_where(arrives, self.t + signed(depth * 2.0 / (here + root)));
                arrived |= arrives;
            }
            // The other lanes cross the edge of their piece, or leave.
            let mut crosses = self.piece.below(last);
            if BOTH {
                crosses = (is_forward & crosses) | (!is_forward & zero.below(self.piece));
            }
            flying &= !arrives & crosses;
            if !flying.any() {
                return arrived;
            }
            depth.set_where(flying, depth - rest);
            self.t.set_where(flying, edge);
            self.piece.set_where(flying, self.piece + signed(one));
            self.look_up(flying);
        }
    }
}

impl<L: Lane> PackedFlight<L> for FlightOverPieces<'_, L> {
    #[inline(always)]
    fn fly(&mut self, depth: L) -> L::Mask {
        self.go::<false>(depth, depth.at_most(depth))
    }

    #[inline(always)]
    fn reached(&self) -> L {
        self.t
    }

    #[inline(always)]
    fn sampling(&self) -> L {
        self.here()
    }

    #[inline(always)]
    fn mean_free_path(&self) -> L {
        self.t.each(1.0) / self.here()
    }

    #[inline(always)]
    fn restart(&mut self, which: L::Mask) {
        if which.any() {
            let zero = self.piece.each(0.0);
            self.piece.set_where(which, zero);
            self.at_hand.set_where(which, zero.columns(&self.field.rows));
            self.t.set_where(which, zero.each(self.field.knots[0]));
        }
    }
}

impl<L: Lane> BothWays<L> for FlightOverPieces<'_, L> {
    type Place = Self;

    #[inline(always)]
    fn place(&self) -> Self {
        *self
    }

    #[inline(always)]
    fn return_to(&mut self, place: Self) {
        *self = place;
    }

    #[inline(always)]
    fn fly_either_way(&mut self, depth: L, is_forward: L::Mask) -> L::Mask {
        self.go::<true>(depth, is_forward)
    }

    #[inline(always)]
    fn copy_where(&mut self, which: L::Mask, other: &Self) {
        if which.any() {
            self.piece.set_where(which, other.piece);
            self.at_hand.set_where(which, other.at_hand);
            self.t.set_where(which, other.t);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::Span;

    fn flights(field: &Piecewise) -> [FlightOverPieces<'_, f64>; 2] {
        let begin = FlightOverPieces::new(0.0, field);
        [begin, begin.from_end()]
    }

    #[test]
    fn a_flight_back_undoes_a_flight() {
        let fields = [
            Piecewise::lines(&[0.0, 1.0, 2.5, 4.0], &[0.2, 1.5, 0.4, 0.9]),
            Piecewise::steps(&[0.0, 1.0, 2.0, 3.0], &[1.0, 0.0, 1.0]),
            Piecewise::constant(0.7, Span::new(-1.0, 4.0)),
            Piecewise::steps(&[0.0, 1.0, 2.0, 3.0], &[1.0, 0.0, 1.3]),
        ];
        for field in &fields {
            for step in 1..17 {
                let (there, back) = (0.1 * f64::from(step), 0.07 * f64::from(step));
                let [mut flight, mut direct] = [flights(field)[0]; 2];
                assert!(flight.fly(there) && flight.fly_either_way(back, false));
                assert!(direct.fly(there - back));
                assert!((flight.reached() - direct.reached()).abs() < 1e-14, "{field:?} at {step}");
                assert!((flight.sampling() - direct.sampling()).abs() < 1e-14);
                if let Some(gaps) = field.with_gaps() {
                    let mut along = FlightWithGaps::new(0.0, gaps);
                    assert!(along.fly(there) && along.fly_either_way(back, false));
                    assert!((along.reached() - flight.reached()).abs() < 1e-14);
                }
                assert!(!flight.fly_either_way(there, false), "beyond the first knot");
            }
        }
    }

    #[test]
    fn flights_from_both_ends_meet() {
        let field = Piecewise::lines(&[0.0, 1.0, 2.5, 4.0], &[0.2, 1.5, 0.4, 0.9]);
        let whole = 0.85 + 0.75 * 1.9 + 0.75 * 1.3;
        for share in [0.1, 0.4, 0.9] {
            let [mut begin, mut end] = flights(&field);
            let place = begin.place();
            assert!(begin.fly(share * whole) && end.fly_either_way((1.0 - share) * whole, false));
            assert!((begin.reached() - end.reached()).abs() < 1e-14);
            begin.return_to(place);
            assert_eq!(begin.reached(), 0.0);
        }
        let constant = Piecewise::constant(2.0, Span::new(1.0, 4.0));
        let gaps = constant.with_gaps().expect("one value");
        let mut end = FlightWithGaps::new(0.0, gaps).from_end();
        assert!(end.fly_either_way(1.0, false));
        assert_eq!(end.reached(), 3.5);
        end.change(0.25);
        assert!(end.fly(1.0));
        assert_eq!((end.reached(), end.mean_free_path()), (3.75, 0.25));
    }
}
