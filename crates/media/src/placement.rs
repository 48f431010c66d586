//! Where a collision lies that may be anywhere: a distance with the density σ̂/Λ.
//!
//! ```text
//! ∫σ̂ from the first knot to t = uΛ,  u uniform
//! ```

use super::Piecewise;
use super::even::Even;
use super::search::Search;
use numeric::{Lane, Row};

/// The inverse of a field's optical depth, for lanes.
#[derive(Debug, Clone)]
pub struct Placement<'a> {
    depth: f64,
    shape: Shape<'a>,
}

#[derive(Debug, Clone)]
enum Shape<'a> {
    /// One value, but for gaps; the length of the way, so rounded that no place is beyond its end.
    Even { even: &'a Even, length: f64 },
    /// The piece that holds an optical depth; its knot, first value and slope, and the depth before.
    Pieces { search: Search, rows: Vec<Row>, field: &'a Piecewise },
}

impl<'a> Placement<'a> {
    /// In a field that is not negative.
    pub fn new(field: &'a Piecewise) -> Self {
        let depth = field.depth[field.depth.len() - 1];
        let shape = if let Some(even) = field.even() {
            Shape::Even { even, length: within(even.from, even.to) }
        } else {
            let row = |i: usize| {
                let columns = [field.knots[i], field.left[i], field.slope[i], field.depth[i]];
                let mut row = Row::default();
                row.0[..columns.len()].copy_from_slice(&columns);
                row
            };
            let rows = (0..field.left.len()).map(row).collect();
            Shape::Pieces { search: Search::new(&field.depth), rows, field }
        };
        Self { depth, shape }
    }

    /// Λ.
    pub fn depth(&self) -> f64 {
        self.depth
    }

    /// σ̂, where it has one value.
    #[inline(always)]
    pub fn single_value(&self) -> Option<f64> {
        match self.shape {
            Shape::Even { even, .. } => Some(even.value),
            Shape::Pieces { .. } => None,
        }
    }

    /// Where σ̂ has one value without gaps: `[from, length, σ̂]`, and a number u lies at `from + u·length`,
    /// as in [`Placement::at`].
    pub fn plain(&self) -> Option<[f64; 3]> {
        match self.shape {
            Shape::Even { even, length } if even.gaps.is_empty() => {
                Some([even.from, length, even.value])
            }
            _ => None,
        }
    }

    /// The distance for a number in `[0, 1)`, and σ̂ there.
    ///
    /// Within a piece, `y₀ s + k s²/2 = d` as in [`Piecewise::fly`], and `σ̂ = √(y₀² + 2kd)`.
    #[inline(always)]
    pub fn at<L: Lane>(&self, uniform: L) -> (L, L) {
        match &self.shape {
            &Shape::Even { even, length } => {
                let way = uniform.times_plus(uniform.each(length), uniform.each(even.from));
                (even.spread(way), way.each(even.value))
            }
            Shape::Pieces { search, rows, field } => {
                let depth = uniform * self.depth;
                let [knot, left, slope, before, _] = search.piece(depth).columns(rows);
                let depth = depth - before;
                let least = depth.each(f64::MIN_POSITIVE);
                let here = (left * left + slope * 2.0 * depth).or_more(least).root();
                let end = depth.each(field.knots[field.left.len()]);
                let t = knot + depth * 2.0 / (left + here);
                (t.or_less(end), here)
            }
        }
    }
}

/// The largest length up to `to − from` by which no number below 1 leads beyond `to`, in one rounding
/// or in two.
fn within(from: f64, to: f64) -> f64 {
    let last = 1.0 - 0.5 * f64::EPSILON;
    let leaves = |length: f64| last.mul_add(length, from) > to || last * length + from > to;
    let mut length = to - from;
    while leaves(length) {
        length = length.next_down();
    }
    length
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FreeFlight, OpticalDepth};
    use numeric::Span;

    #[test]
    fn no_place_is_beyond_the_end() {
        let mut ends =
            vec![(0.0, 20.0), (-1.0, 4.0), (0.1, 0.3), (1e6, 1e6 + 1e-9), (-3.0, 1e-300)];
        ends.extend(
            (1..2000).map(|i| (0.1 * f64::from(i), 0.1 * f64::from(i) + f64::from(i).sqrt())),
        );
        for (from, to) in ends {
            let length = within(from, to);
            let last = (1.0 - 0.5 * f64::EPSILON).times_plus(length, from);
            assert!(last <= to, "{from} … {to}: {last}");
            // Rounded ends are all that it can lose.
            let ulp = f64::EPSILON * from.abs().max(to.abs());
            assert!((to - from) - length <= 4.0 * ulp, "{from} … {to}");
        }
    }

    /// The place of a number is where a flight through its share of the optical depth ends.
    #[test]
    fn a_place_inverts_the_optical_depth() {
        let many: Vec<f64> = (0..=40).map(|i| 0.1 * f64::from(i)).collect();
        let values: Vec<f64> = (0..40).map(|i| f64::from(i % 7)).collect();
        let fields = [
            Piecewise::constant(0.7, Span::new(-1.0, 4.0)),
            Piecewise::lines(&[0.0, 1.0, 2.5, 4.0], &[0.0, 1.5, 0.4, 0.9]),
            Piecewise::steps(&[0.0, 1.0, 2.0, 3.0], &[1.0, 0.0, 1.0]),
            Piecewise::steps(&many, &values),
            Piecewise::steps(&[-1.0, 0.0, 0.0625, 3.0], &[0.0, 1.7, 0.0]),
            Piecewise::steps(&[0.0, 1.0, 2.0, 3.0, 5.0, 6.0], &[1.0, 0.0, 2.0, 0.0, 1.0]),
        ];
        for field in fields {
            let support = Span::new(field.knots()[0], field.knots()[field.knots().len() - 1]);
            let placement = Placement::new(&field);
            let whole = field.optical_depth(support).value;
            assert!((placement.depth() - whole).abs() <= 1e-14 * whole);
            for step in 0..1000 {
                let uniform = (f64::from(step) + 0.37) / 1000.0;
                let (t, sampling) = placement.at(uniform);
                let flown = field.free_flight(support, uniform * whole).expect("before the end");
                assert!((t - flown).abs() < 1e-13, "{t} and {flown}");
                assert!((sampling - field.value(t)).abs() < 1e-12, "at {t}");
            }
        }
    }
}
