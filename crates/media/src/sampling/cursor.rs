//! Walks of one lane through σ̂.

use super::{FlightOverPieces, FlightWithGaps, PackedFlight, Piecewise};
use numeric::Lane;

/// Position of a walk through a [`Piecewise`] field that is not negative.
#[derive(Clone, Copy)]
pub enum Cursor<'a> {
    /// In a field of one value with gaps.
    WithGaps(FlightWithGaps<'a, f64>),
    /// In any other.
    OverPieces(FlightOverPieces<'a, f64>),
}

impl Cursor<'_> {
    /// The distance reached.
    #[inline]
    pub fn t(&self) -> f64 {
        match self {
            Self::WithGaps(flight) => flight.reached(),
            Self::OverPieces(flight) => flight.reached(),
        }
    }

    /// Flies on through an optical depth and returns the field at the new distance; `None` beyond the last knot.
    #[inline(always)]
    pub fn fly(&mut self, depth: f64) -> Option<f64> {
        match self {
            Self::WithGaps(flight) => flight.fly(depth).then(|| flight.sampling()),
            Self::OverPieces(flight) => flight.fly(depth).then(|| flight.sampling()),
        }
    }
}

impl Piecewise {
    /// A walk from the first knot, or from the beginning of a field that is [`Piecewise::with_gaps`].
    #[inline]
    pub fn begin(&self) -> Cursor<'_> {
        match &self.gaps {
            Some(gaps) => Cursor::WithGaps(FlightWithGaps::new(0.0, gaps)),
            None => Cursor::OverPieces(FlightOverPieces::new(0.0, self)),
        }
    }

    /// Ends of flights from the beginning through optical depths.
    #[inline(always)]
    pub fn flown<L: Lane>(&self, depth: L) -> L {
        if let Some(gaps) = &self.gaps {
            return gaps
                .spread(depth.times_plus(depth.each(1.0 / gaps.value), depth.each(gaps.from)));
        }
        depth.map(|depth| {
            let mut flight = FlightOverPieces::new(0.0, self);
            if flight.fly(depth) { flight.reached() } else { self.knots[self.left.len()] }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::ConstantWithGaps;
    use super::*;
    use crate::OpticalDepth;
    use numeric::Span;

    #[test]
    fn a_flight_begins_where_a_field_with_gaps_does() {
        let field = Piecewise::constant(2.0, Span::new(0.0, 5.0));
        let field = field.zero_on(&[Span::new(0.0, 1.0), Span::new(4.0, 5.0)]);
        let expected = ConstantWithGaps { value: 2.0, from: 1.0, to: 4.0, gaps: Vec::new() };
        assert_eq!(field.with_gaps(), Some(&expected));
        assert_eq!((field.value(0.5), field.value(1.0), field.value(4.5)), (0.0, 2.0, 0.0));
        let mut cursor = field.begin();
        assert_eq!((cursor.fly(1.0), cursor.t()), (Some(2.0), 1.5));
        assert_eq!(cursor.fly(5.1), None);
        let nothing = field.zero_on(&[Span::new(0.0, 5.0)]);
        assert_eq!(nothing.begin().fly(1e-9), None);
    }

    #[test]
    fn gaps_take_none_of_the_way() {
        let values = [0.0, 3.0, 3.0, 0.0, 0.0, 3.0, 0.0, 3.0, 0.0];
        let field = Piecewise::steps(&[0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 7.0, 8.0, 9.0], &values);
        let gaps = vec![[2.0, 2.0], [4.0, 1.0]];
        assert_eq!(
            field.with_gaps(),
            Some(&ConstantWithGaps { value: 3.0, from: 1.0, to: 5.0, gaps })
        );
        for step in 1..120 {
            let depth = 0.1 * f64::from(step) + 0.01;
            let mut cursor = field.begin();
            let flown = cursor.fly(depth).map(|_| cursor.t());
            let over = FlightOverPieces::new(0.0, &field).fly(depth);
            assert_eq!(flown.is_some(), over);
            if let Some(t) = flown {
                let back = field.optical_depth(Span::new(0.0, t)).value;
                assert!((back - depth).abs() < 1e-14, "{t}");
            }
        }
    }
}
