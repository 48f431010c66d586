//! Fields of one value with gaps: a constant σ̂ where a ray crosses empty space.

use numeric::Lane;

/// Maximum number of gaps: a walk tests each gap at each step. With more gaps pieces are looked up instead.
const MAX_GAPS: usize = 8;

/// A field that has one value wherever it is not zero. A walk through it measures only the distance on which it is
/// not zero.
#[derive(Debug, Clone, PartialEq)]
pub struct ConstantWithGaps {
    /// The value; zero only where the whole field is.
    pub value: f64,
    /// Beginning of the field.
    pub from: f64,
    /// End of the field without its gaps.
    pub to: f64,
    /// The gaps: the distance without gaps before each, measured like `to`, and its length.
    pub gaps: Vec<[f64; 2]>,
}

impl ConstantWithGaps {
    /// The pieces of a [`super::Piecewise`] as such a field; `None` where they have several values, or too many
    /// gaps.
    pub fn new(knots: &[f64], left: &[f64], slope: &[f64]) -> Option<Self> {
        let is_zero = |i: usize| left[i] == 0.0 && slope[i] == 0.0;
        let Some(first) = (0..left.len()).find(|&i| !is_zero(i)) else {
            let (from, to) = (knots[0], knots[left.len()]);
            return Some(Self { value: 0.0, from, to, gaps: Vec::new() });
        };
        let mut field =
            Self { value: left[first], from: knots[first], to: knots[first], gaps: Vec::new() };
        let mut skipped = 0.0;
        for i in first..left.len() {
            if is_zero(i) {
                continue;
            }
            if left[i] != field.value || slope[i] != 0.0 {
                return None;
            }
            let gap = (knots[i] - skipped) - field.to;
            // The gap before this piece.
            if i > first && is_zero(i - 1) {
                field.gaps.push([field.to, gap]);
                skipped += gap;
            }
            field.to = knots[i + 1] - skipped;
        }
        (field.gaps.len() <= MAX_GAPS).then_some(field)
    }

    /// The position that is reached after a distance without gaps.
    #[inline(always)]
    pub fn spread<L: Lane>(&self, way: L) -> L {
        let mut t = way;
        for &[after, length] in &self.gaps {
            let is_beyond = way.each(after).at_most(way);
            t = L::select(is_beyond, t + length, t);
        }
        t
    }
}
