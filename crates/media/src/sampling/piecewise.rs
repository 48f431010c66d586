//! Straight pieces: the shape of every sampling extinction and of most controls.

use super::search::Search;
use super::{ConstantWithGaps, FlightOverPieces, PackedFlight};
use crate::{Extinction, Facts, OpticalDepth};
use numeric::{CacheRow, Known, Lane, Span, sum::Sum};

/// A field made of straight pieces, which need not meet at the knots.
///
/// ```text
/// σ(t) = leftᵢ + slopeᵢ (t − knotᵢ),   knotᵢ ≤ t < knotᵢ₊₁
/// ```
///
/// Outside the knots the field keeps the first and the last value. Integral and inverse are closed forms.
#[derive(Debug, Clone, PartialEq)]
pub struct Piecewise {
    pub(super) knots: Vec<f64>,
    pub(super) left: Vec<f64>,
    pub(super) slope: Vec<f64>,
    pub(super) depth: Vec<f64>,
    pub(super) gaps: Option<ConstantWithGaps>,
    search: Search,
    /// Knot, left and slope of each piece, for lookups, and for flights its end and the value there.
    pub(super) rows: Vec<CacheRow>,
    stretches: Vec<CacheRow>,
}

impl Piecewise {
    /// A constant on the whole span.
    pub fn constant(value: f64, span: Span) -> Self {
        Self::steps(&[span.from, span.to], &[value])
    }

    /// `values[i]` between `breaks[i]` and `breaks[i + 1]`; breaks ascend.
    pub fn steps(breaks: &[f64], values: &[f64]) -> Self {
        Self::pieces(breaks, values.to_vec(), vec![0.0; values.len()])
    }

    /// Straight lines through the points `(knots[i], values[i])`; knots ascend.
    pub fn lines(knots: &[f64], values: &[f64]) -> Self {
        let pieces = knots.windows(2).zip(values.windows(2));
        let slope = pieces.map(|(k, v)| (v[1] - v[0]) / (k[1] - k[0])).collect();
        Self::pieces(knots, values[..values.len() - 1].to_vec(), slope)
    }

    /// Straight lines between the given `(first, last)` values of each piece; knots ascend.
    pub fn joined(knots: &[f64], ends: impl Iterator<Item = (f64, f64)>) -> Self {
        let lines = knots.windows(2).zip(ends);
        let (left, slope) =
            lines.map(|(k, (first, last))| (first, (last - first) / (k[1] - k[0]))).unzip();
        Self::pieces(knots, left, slope)
    }

    fn pieces(knots: &[f64], left: Vec<f64>, slope: Vec<f64>) -> Self {
        let mut sum = Sum::default();
        let mut depth = vec![0.0];
        for (i, ends) in knots.windows(2).enumerate() {
            let width = ends[1] - ends[0];
            sum.add(width * (left[i] + 0.5 * slope[i] * width));
            depth.push(sum.value());
        }
        let row = |(i, &knot): (usize, &f64)| {
            let end = knots[i + 1];
            let right = left[i] + slope[i] * (end - knot);
            CacheRow([knot, left[i], slope[i], end, right, 0.0, 0.0, 0.0])
        };
        let rows = knots[..left.len()].iter().enumerate().map(row).collect();
        let gaps = ConstantWithGaps::new(knots, &left, &slope);
        let stretch =
            |i: usize| CacheRow([knots[i], knots[i + 1], 1.0 / left[i], 0.0, 0.0, 0.0, 0.0, 0.0]);
        let stretches = (0..left.len()).filter(|&i| left[i] > 0.0).map(stretch).collect();
        let search = Search::new(knots);
        Self { knots: knots.to_vec(), left, slope, depth, gaps, search, rows, stretches }
    }

    /// The field restricted to, or continued over, a span.
    #[must_use]
    pub fn on(&self, span: Span) -> Self {
        if span.is_empty() {
            return Self::constant(self.value(span.from), span);
        }
        let piece = |ends: Span| match self.piece_at(ends.middle()) {
            (Some(value), _) => (value, 0.0),
            (None, piece) => (self.line(piece, ends.from), self.slope[piece]),
        };
        Self::between(&span.cut(self.knots.clone()), piece)
    }

    /// The first value and the slope that `piece` returns for the interval between every two knots.
    fn between(knots: &[f64], piece: impl Fn(Span) -> (f64, f64)) -> Self {
        let (left, slope) = Span::between(knots).map(piece).unzip();
        Self::pieces(knots, left, slope)
    }

    /// The field, set to zero on some intervals, which ascend and do not touch.
    #[must_use]
    pub fn zero_on(&self, stretches: &[Span]) -> Self {
        let (first, last) = (self.knots[0], self.knots[self.left.len()]);
        let ends = stretches.iter().flat_map(|s| [s.from, s.to]);
        let knots = Span::new(first, last).cut(self.knots.iter().copied().chain(ends).collect());
        let piece = |ends: Span| {
            let middle = ends.middle();
            if stretches.iter().any(|s| s.contains_inside(middle)) {
                return (0.0, 0.0);
            }
            let (_, piece) = self.piece_at(middle);
            (self.line(piece, ends.from), self.slope[piece])
        };
        Self::between(&knots, piece)
    }

    /// The field times a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let left = self.left.iter().map(|x| x * factor).collect();
        let slope = self.slope.iter().map(|x| x * factor).collect();
        Self::pieces(&self.knots, left, slope)
    }

    /// The knots, ascending.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// The optical depth of all pieces, signed.
    pub fn whole_depth(&self) -> f64 {
        self.depth[self.depth.len() - 1]
    }

    /// The value, if there is only one.
    pub fn single_value(&self) -> Option<f64> {
        (self.left.len() == 1 && self.slope[0] == 0.0).then(|| self.left[0])
    }

    /// The field as one value with gaps, if it has only one value other than zero.
    #[inline]
    pub fn with_gaps(&self) -> Option<&ConstantWithGaps> {
        self.gaps.as_ref()
    }

    /// Number of pieces.
    pub fn count(&self) -> usize {
        self.left.len()
    }

    /// Returns whether no piece has a slope.
    pub fn is_steps(&self) -> bool {
        self.slope.iter().all(|&slope| slope == 0.0)
    }

    /// Beginning, end and mean free path `1/σ̂` of every piece that begins above zero.
    #[inline(always)]
    pub fn stretches(&self) -> &[CacheRow] {
        &self.stretches
    }

    /// Both one-sided values at every knot, for a search of extremes.
    pub fn corner_values(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.left.len()).flat_map(|i| [self.left[i], self.line(i, self.knots[i + 1])])
    }

    /// The field at `t`.
    #[inline(always)]
    pub fn value<L: Lane>(&self, t: L) -> L {
        if let [value] = self.left[..]
            && self.slope[0] == 0.0
        {
            return t.each(value);
        }
        // Beyond the knots the field keeps the first and the last value.
        let (first, end) = (t.each(self.knots[0]), t.each(self.knots[self.left.len()]));
        let t = t.or_more(first).or_less(end);
        let [knot, left, slope, ..] = self.search.piece(t).columns(&self.rows);
        left + slope * (t - knot)
    }

    /// The piece that holds `t`, and the value where `t` lies outside the knots.
    pub(super) fn piece_at(&self, t: f64) -> (Option<f64>, usize) {
        let last = self.left.len() - 1;
        if t < self.knots[0] {
            return (Some(self.left[0]), 0);
        }
        if t >= self.knots[last + 1] {
            return (Some(self.line(last, self.knots[last + 1])), last);
        }
        let after = self.knots.partition_point(|&knot| knot <= t);
        (None, (after - 1).min(last))
    }

    #[inline]
    pub(super) fn line(&self, piece: usize, t: f64) -> f64 {
        self.left[piece] + self.slope[piece] * (t - self.knots[piece])
    }

    /// `∫` from the first knot to `t`.
    fn depth_to(&self, t: f64) -> f64 {
        match self.piece_at(t) {
            (Some(value), 0) if t < self.knots[0] => value * (t - self.knots[0]),
            (Some(value), last) => self.depth[last + 1] + value * (t - self.knots[last + 1]),
            (None, piece) => {
                let width = t - self.knots[piece];
                self.depth[piece] + width * (self.left[piece] + 0.5 * self.slope[piece] * width)
            }
        }
    }

    /// `∫` from one distance to others, as [`OpticalDepth`] finds it.
    #[inline(always)]
    pub fn depths<L: Lane>(&self, from: f64, to: L) -> L {
        if let ([first, end], [left], [slope]) = (&self.knots[..], &self.left[..], &self.slope[..])
        {
            let width = to - *first;
            let within = width * (width * (0.5 * *slope) + *left) + self.depth[0];
            let before = width * *left;
            let beyond = (to - *end) * self.line(0, *end) + self.depth[1];
            let inside = L::select(to.below(to.each(*end)), within, beyond);
            return L::select(to.below(to.each(*first)), before, inside) - self.depth_to(from);
        }
        let from = self.depth_to(from);
        to.map(|to| self.depth_to(to) - from)
    }
}

impl Extinction for Piecewise {
    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        self.value(t)
    }

    fn facts(&self) -> Facts<'_> {
        Facts { panel_nodes: Some(3), has_inverse: true, ..Facts::default() }
    }
}

impl OpticalDepth for Piecewise {
    fn optical_depth(&self, span: Span) -> Known {
        let (from, to) = (self.depth_to(span.from), self.depth_to(span.to));
        Known::new(to - from, 2.0 * f64::EPSILON * (from.abs() + to.abs()))
    }

    fn breaks(&self, _: Span) -> Vec<f64> {
        self.knots.clone()
    }

    fn free_flight(&self, span: Span, depth: f64) -> Option<f64> {
        if span.from < self.knots[0] || span.to > self.knots[self.left.len()] {
            return self.on(span).free_flight(span, depth);
        }
        let mut flight = FlightOverPieces::new(0.0, self).from(span.from);
        let is_inside = flight.fly(depth) && flight.reached() < span.to;
        is_inside.then(|| flight.reached())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines() -> Piecewise {
        Piecewise::lines(&[0.0, 1.0, 2.5, 4.0], &[0.2, 1.5, 0.4, 0.9])
    }

    #[test]
    fn steps_jump_at_their_breaks() {
        let steps = Piecewise::steps(&[0.0, 1.0, 2.0], &[1.0, 3.0]);
        assert_eq!((steps.value(0.999), steps.value(1.0)), (1.0, 3.0));
        assert_eq!((steps.value(-1.0), steps.value(9.0)), (1.0, 3.0));
    }

    #[test]
    fn stretches_are_the_pieces_that_hold_something() {
        let steps = Piecewise::steps(&[0.0, 1.0, 2.0, 3.0, 4.0], &[0.0, 2.0, 0.0, 0.5]);
        let row = |begin, end, path| CacheRow([begin, end, path, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(steps.stretches(), [row(1.0, 2.0, 0.5), row(3.0, 4.0, 2.0)]);
    }

    #[test]
    fn a_gap_leaves_the_rest_as_it_is() {
        let (whole, gap) = (lines(), Span::new(0.7, 2.7));
        let field = whole.zero_on(&[gap]);
        assert!(field.with_gaps().is_none());
        for step in 0..40 {
            let t = 0.1 * f64::from(step) + 0.05;
            let expected = if gap.contains_inside(t) { 0.0 } else { whole.value(t) };
            assert!((field.value(t) - expected).abs() < 1e-15, "at {t}");
        }
    }

    #[test]
    fn a_restricted_field_keeps_its_values() {
        let part = lines().on(Span::new(0.5, 3.0));
        for t in [0.5, 0.9, 1.0, 2.0, 2.9] {
            assert!((part.value(t) - lines().value(t)).abs() < 1e-15);
        }
    }
}
