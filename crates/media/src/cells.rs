//! The cells of a lattice that a ray crosses, and prefix sums over them.
//!
//! ```text
//! u(t) = start + slope·t crosses a plane uⱼ = n at t = (n − startⱼ)/slopeⱼ
//! ```
//!
//! An integral over an interval is the difference of two prefix sums and the two partial cells at its ends. It
//! costs a binary search and two cells, for any length of the ray.

use super::lattice::Track;
use numeric::{Known, Span, roots, sum::Sum};

/// The intervals of a ray between the planes of a lattice, with the integral up to each.
pub struct Cells {
    ends: Vec<f64>,
    sums: Vec<f64>,
}

impl Cells {
    /// The cells of the integer lattice on `inside`; an interval without length is one cell.
    #[allow(clippy::cast_possible_truncation)] // a lattice is addressed by 32-bit integers
    pub fn cross(track: Track, inside: Span) -> Self {
        let mut planes = Vec::new();
        for (a, b) in track.start.into_iter().zip(track.slope).filter(|&(_, b)| b != 0.0) {
            let (p, q) = (a + b * inside.from, a + b * inside.to);
            let crossed = p.min(q).ceil() as i64..=p.max(q).floor() as i64;
            planes.extend(crossed.map(|n| (n as f64 - a) / b));
        }
        let mut ends = inside.cut(planes);
        if ends.len() == 1 {
            ends.push(inside.to);
        }
        let sums = vec![0.0; ends.len()];
        Self { ends, sums }
    }

    /// The number of cells.
    pub fn count(&self) -> usize {
        self.ends.len() - 1
    }

    /// Interval of a cell.
    pub fn cell(&self, index: usize) -> Span {
        Span::new(self.ends[index], self.ends[index + 1])
    }

    /// The crossings inside an interval.
    pub fn crossings(&self, span: Span) -> Vec<f64> {
        self.ends.iter().copied().filter(|&t| span.contains_inside(t)).collect()
    }

    /// Sums the integrals over the cells: `integral` returns the integral for a cell's index and interval, and any
    /// part of that interval.
    #[must_use]
    pub fn summed(mut self, integral: impl Fn(usize, Span, Span) -> f64) -> Self {
        let mut sum = Sum::default();
        for index in 0..self.count() {
            sum.add(integral(index, self.cell(index), self.cell(index)));
            self.sums[index + 1] = sum.value();
        }
        self
    }

    fn find(&self, t: f64) -> usize {
        self.ends.partition_point(|&end| end <= t).saturating_sub(1).min(self.count() - 1)
    }

    /// The integral over an interval; the error is that of the sums, not of `integral` itself.
    pub fn integrate(&self, span: Span, integral: impl Fn(usize, Span, Span) -> f64) -> Known {
        let integral = |index, part| integral(index, self.cell(index), part);
        let (first, last) = (self.find(span.from), self.find(span.to));
        if first == last {
            return Known::exact(integral(first, span));
        }
        let head = integral(first, Span::new(span.from, self.ends[first + 1]));
        let tail = integral(last, Span::new(self.ends[last], span.to));
        let (from, to) = (self.sums[first + 1], self.sums[last]);
        let sizes = head.abs() + tail.abs() + 2.0 * (from.abs() + to.abs());
        Known::new(head + (to - from) + tail, sizes * f64::EPSILON)
    }

    /// Distance at which the integral of a non-negative field from the beginning of the interval reaches `depth`;
    /// `None` where the interval ends first.
    pub fn invert(
        &self,
        span: Span,
        depth: f64,
        integral: impl Fn(usize, Span, Span) -> f64,
    ) -> Option<f64> {
        let integral = |index, part| integral(index, self.cell(index), part);
        let (first, last) = (self.find(span.from), self.find(span.to));
        let solve = |index: usize, from: f64, depth: f64| {
            let to = if index == last { span.to } else { self.ends[index + 1] };
            if integral(index, Span::new(from, to)) <= depth {
                // The sum selects the cell: only rounding can end the search in a cell before the last.
                return (index != last).then_some(to);
            }
            Some(roots::root(from, to, &|s| integral(index, Span::new(from, s)) - depth))
        };
        let head = integral(first, Span::new(span.from, self.ends[first + 1]));
        if first == last || depth < head {
            return solve(first, span.from, depth);
        }
        let (begin, rest) = (self.sums[first + 1], depth - head);
        let index = self.sums.partition_point(|&sum| sum <= begin + rest) - 1;
        if index > last {
            return None;
        }
        solve(index, self.ends[index], rest - (self.sums[index] - begin))
    }
}
