//! Search for the piece that holds a distance, without a branch that depends on the distance.
//!
//! ```text
//! few pieces:   the number of knots that are not beyond t
//! many pieces:  start[round((t − first)·scale)], then halving among the knots of that bin
//! ```
//!
//! Bins are uniform, four to a piece, so that evenly spaced pieces need a single comparison. Rounding
//! is monotone: a knot in a lower bin than t lies below it, a knot in a higher bin beyond it, and
//! only those of t's own bin are compared. The piece is exact.

use numeric::Lane;

/// Maximum number of pieces that are counted.
const FEW: usize = 16;

/// A search among ascending knots.
#[derive(Debug, Clone, PartialEq)]
pub struct Search {
    /// All knots; the first and the last are not searched.
    knots: Vec<f64>,
    scale: f64,
    /// The piece that holds the beginning of each bin.
    starts: Vec<f64>,
    /// The first step of the halving; 0 where the knots are counted.
    reach: u32,
}

impl Search {
    /// A search among the pieces between two or more knots, which ascend.
    pub fn new(knots: &[f64]) -> Self {
        let (knots, pieces) = (knots.to_vec(), knots.len() - 1);
        if pieces <= FEW {
            return Self { knots, scale: 0.0, starts: Vec::new(), reach: 0 };
        }
        let bins = 4 * pieces;
        let scale = bins as f64 / (knots[pieces] - knots[0]);
        let scale = if scale.is_finite() { scale } else { 0.0 };
        let mut search = Self { knots, scale, starts: Vec::new(), reach: 1 };
        let of_knots: Vec<f64> = search.knots[1..pieces].iter().map(|&t| search.bin(t)).collect();
        let below = |bin: f64| of_knots.partition_point(|&of_knot| of_knot < bin);
        search.starts = (0..=bins).map(|bin| below(bin as f64) as f64).collect();
        let longest = of_knots.chunk_by(|a, b| a == b).map(<[f64]>::len).max().unwrap_or(1);
        while 2 * search.reach as usize <= longest {
            search.reach *= 2;
        }
        search
    }

    #[inline(always)]
    fn bin<L: Lane>(&self, t: L) -> L {
        ((t - self.knots[0]) * self.scale).nearest()
    }

    /// The number of the piece that holds `t`, which is not outside the knots. At the last knot it may be the
    /// number of pieces.
    #[inline(always)]
    pub fn piece<L: Lane>(&self, t: L) -> L {
        let (zero, one) = (t.each(0.0), t.each(1.0));
        if self.reach == 0 {
            let mut piece = zero;
            for &knot in &self.knots[1..self.knots.len() - 1] {
                piece = piece + L::select(t.each(knot).at_most(t), one, zero);
            }
            return piece;
        }
        let mut piece = self.bin(t).entry(&self.starts);
        let mut step = self.reach;
        while step > 0 {
            let next = piece + f64::from(step);
            piece = L::select(next.entry(&self.knots).at_most(t), next, piece);
            step /= 2;
        }
        piece
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn agrees(knots: &[f64]) {
        let (search, last) = (Search::new(knots), knots.len() - 2);
        let (first, end) = (knots[0], knots[last + 1]);
        let between = (0..=5_000).map(|n| first + (end - first) * (f64::from(n) / 5_000.0));
        let beside = knots.iter().flat_map(|&knot| [knot.next_down(), knot, knot.next_up()]);
        for t in between.chain(beside).map(|t| t.clamp(first, end)) {
            let exact = knots.partition_point(|&knot| knot <= t) - 1;
            assert_eq!(search.piece(t).min(last as f64), exact.min(last) as f64, "{t}");
        }
    }

    #[test]
    fn pieces_are_those_of_a_binary_search() {
        for pieces in [1, 2, 16, 17, 100, 1000] {
            let even: Vec<f64> = (0..=pieces).map(|n| 0.3 + 0.1 * f64::from(n)).collect();
            agrees(&even);
            agrees(&even.iter().map(|x| x.powi(9)).collect::<Vec<f64>>());
            agrees(&even.iter().map(|x| (-30.0 * x).exp()).rev().collect::<Vec<f64>>());
        }
    }

    #[test]
    fn evenly_spaced_pieces_need_one_comparison() {
        let even: Vec<f64> = (0..=1000).map(|n| 0.1 * f64::from(n)).collect();
        assert_eq!(Search::new(&even).reach, 1);
    }
}
