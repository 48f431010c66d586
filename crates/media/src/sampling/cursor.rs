//! Walks through straight pieces by closed forms.

use super::Piecewise;
use numeric::Lane;

/// Position of a walk through a [`Piecewise`] field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cursor {
    /// The distance reached.
    pub t: f64,
    /// Distance without gaps, in a field that is [`Piecewise::with_gaps`].
    way: f64,
    piece: usize,
}

impl Piecewise {
    /// A walk from the first knot, or from the beginning of a field that is [`Piecewise::with_gaps`].
    #[inline]
    pub fn begin(&self) -> Cursor {
        let t = self.gaps.as_ref().map_or(self.knots[0], |gaps| gaps.from);
        Cursor { t, way: t, piece: 0 }
    }

    /// A walk over the pieces from any distance between the first and the last knot.
    pub(super) fn begin_at(&self, t: f64) -> Cursor {
        Cursor { t, way: t, piece: self.piece_at(t).1 }
    }

    /// Flies on through an optical depth and returns the field at the new distance; `None` beyond the last knot.
    /// Non-negative fields only.
    ///
    /// ```text
    /// y₀ s + k s²/2 = u   ⇒   s = 2u / (y₀ + √(y₀² + 2ku))
    /// ```
    #[inline(always)]
    pub fn fly(&self, cursor: &mut Cursor, depth: f64) -> Option<f64> {
        if let Some(gaps) = &self.gaps {
            cursor.way = Lane::times_plus(depth, 1.0 / gaps.value, cursor.way);
            cursor.t = gaps.spread(cursor.way);
            return (cursor.way < gaps.to).then_some(gaps.value);
        }
        self.fly_over(cursor, depth)
    }

    /// Ends of flights from the beginning through optical depths.
    #[inline(always)]
    pub fn flown<L: Lane>(&self, depth: L) -> L {
        if let Some(gaps) = &self.gaps {
            return gaps
                .spread(depth.times_plus(depth.each(1.0 / gaps.value), depth.each(gaps.from)));
        }
        depth.map(|depth| {
            let mut cursor = self.begin();
            self.fly_over(&mut cursor, depth);
            cursor.t
        })
    }

    /// Flies as [`Self::fly`] does, over several pieces.
    #[inline]
    pub(super) fn fly_over(&self, cursor: &mut Cursor, mut depth: f64) -> Option<f64> {
        while cursor.piece < self.left.len() {
            let (end, slope) = (self.knots[cursor.piece + 1], self.slope[cursor.piece]);
            let here = self.line(cursor.piece, cursor.t);
            let left = (end - cursor.t) * 0.5 * (here + self.line(cursor.piece, end));
            if depth < left {
                let root = Lane::or_more(here * here + 2.0 * slope * depth, 0.0).sqrt();
                cursor.t += 2.0 * depth / (here + root);
                return Some(self.line(cursor.piece, cursor.t));
            }
            depth -= left;
            cursor.t = end;
            cursor.piece += 1;
        }
        None
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
        assert_eq!((field.fly(&mut cursor, 1.0), cursor.t), (Some(2.0), 1.5));
        assert_eq!(field.fly(&mut cursor, 5.1), None);
        let nothing = field.zero_on(&[Span::new(0.0, 5.0)]);
        assert_eq!(nothing.fly(&mut nothing.begin(), 1e-9), None);
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
            let flown = field.fly(&mut cursor, depth).map(|_| cursor.t);
            let over = field.fly_over(&mut field.begin(), depth).is_some();
            assert_eq!(flown.is_some(), over);
            if let Some(t) = flown {
                let back = field.optical_depth(Span::new(0.0, t)).value;
                assert!((back - depth).abs() < 1e-14, "{t}");
            }
        }
    }
}
