//! A cubic in each cell of a lattice that a ray crosses, found by counting planes.
//!
//! ```text
//! cell(t) = Σⱼ round(|slopeⱼ|·t ± startⱼ − ½) − the same at the beginning
//! σ(t) = ((c₃ s + c₂) s + c₁) s + c₀,   s = t − knot of the cell
//! ```
//!
//! The number of planes of the integer lattice that a ray has crossed is computed without a search. Near a plane
//! rounding may count it too early or too late. Then the cubic of the adjacent cell is evaluated beside its own
//! interval, by a rounding of t. Planes that are crossed at once bound cells without length, which keep their
//! places in the table.
//!
//! Products and sums are rounded separately on every machine. A field of non-negative samples is not negative,
//! whatever the rounding of its cubic: 0 is the minimum.

use super::lattice::Track;
use numeric::{CacheRow, Lane, Span, order};

/// Cubics along a ray.
pub struct Cubics {
    /// The ray in lattice coordinates, less ½, mirrored so that all of them increase.
    start: [f64; 3],
    slope: [f64; 3],
    /// The planes below the beginning.
    below: f64,
    /// The coefficients of each cell and its beginning.
    rows: Vec<CacheRow>,
}

impl Cubics {
    /// The cubics that `cubic` returns for the cell about a distance, in powers of the distance from the cell's
    /// beginning: both are its arguments.
    pub fn new(
        Track { start, slope }: Track,
        inside: Span,
        cubic: impl Fn(f64, f64) -> [f64; 4],
    ) -> Self {
        let mirrored = |j: usize| if slope[j] < 0.0 { -start[j] } else { start[j] };
        let start: [f64; 3] = std::array::from_fn(mirrored);
        let slope = slope.map(f64::abs);
        let mut crossings = vec![];
        for (a, b) in start.into_iter().zip(slope) {
            let (mut plane, last) =
                (cell(a - 0.5, b, inside.from) + 1.0, cell(a - 0.5, b, inside.to));
            while plane <= last {
                crossings.push(((plane - a) / b).clamp(inside.from, inside.to));
                plane += 1.0;
            }
        }
        order::ascend(&mut crossings);
        let knots: Vec<f64> = std::iter::once(inside.from).chain(crossings).collect();
        let ends = knots[1..].iter().copied().chain(std::iter::once(inside.to));
        let row = |(&from, to): (&f64, f64)| {
            let [a, b, c, d] = cubic(from + 0.5 * (to - from), from);
            CacheRow([a, b, c, d, from, 0.0, 0.0, 0.0])
        };
        let rows = knots.iter().zip(ends).map(row).collect();
        let mut cubics = Self { start: start.map(|a| a - 0.5), slope, below: 0.0, rows };
        cubics.below = cubics.cell(inside.from);
        cubics
    }

    /// The number of the cell at a distance within the interval.
    #[inline(always)]
    fn cell<L: Lane>(&self, t: L) -> L {
        let (a, b) = (self.start, self.slope);
        cell(a[0], b[0], t) + cell(a[1], b[1], t) + (cell(a[2], b[2], t) - self.below)
    }

    /// The field at a distance within the interval.
    #[inline(always)]
    pub fn value<L: Lane>(&self, t: L) -> L {
        let [c0, c1, c2, c3, knot] = self.cell(t).columns(&self.rows);
        let s = t - knot;
        (((c3 * s + c2) * s + c1) * s + c0).or_more(t.each(0.0))
    }
}

/// The cell along one axis.
#[inline(always)]
fn cell<L: Lane>(a: f64, b: f64, t: L) -> L {
    (t * b + a).nearest()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each cell's cubic is its own beginning.
    fn beginnings(start: [f64; 3], slope: [f64; 3], inside: Span) -> Cubics {
        Cubics::new(Track { start, slope }, inside, |_, from| [from, 0.0, 0.0, 0.0])
    }

    #[test]
    fn cells_begin_at_planes() {
        let cells = beginnings([0.5, 0.25, 3.0], [1.0, -0.5, 0.0], Span::new(0.0, 2.0));
        assert_eq!([0.0, 0.4, 0.6, 1.4, 1.6].map(|t| cells.value(t)), [0.0, 0.0, 0.5, 0.5, 1.5]);
    }

    #[test]
    fn planes_that_are_crossed_at_once_shift_no_later_cell() {
        let cells = beginnings([0.1, 0.1, 0.4 - 0.3], [1.0, 1.0, -1.0], Span::new(0.0, 50.0));
        for n in 1..49 {
            let t = f64::from(n) + 0.5;
            assert!((cells.value(t) - (f64::from(n) + 0.1)).abs() < 1e-13, "{t}");
            let t = f64::from(n);
            assert!((cells.value(t) - (f64::from(n) - 0.1)).abs() < 1e-13, "{t}");
        }
    }
}
