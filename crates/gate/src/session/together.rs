//! Quantities of one kind that are judged together after all of their draws, such as the tiles of an image.
//!
//! ```text
//! draws   in blocks of 1, 1, 2, 4, 8, … units of the caller's, so that stakes on a range learn from the draws before
//! look    one, after the last block
//! fail    by Holm at the level α that the quantities share, p = 1/E
//! pass    both ln P± ≥ ln(1/β)
//! list    by e-BH: a share of 5 % of it is false at most, on average
//! ```

use super::quantity::Quantity;
use super::scalar::{Levels, Scalar};
use crate::stats::gate::Evidence;
use crate::stats::multiplicity::{e_benjamini_hochberg, holm};
use crate::stats::verdict::{MISS, Verdict};

/// Largest share of false entries of the list, on average.
pub const LISTED: f64 = 0.05;

/// Levels that no evidence reaches before the end.
pub const AT_THE_END: Levels = Levels { ln_fail: f64::INFINITY, ln_pass: f64::INFINITY };

impl Scalar {
    /// Takes all draws of a quantity and looks once. The draws are those of `units` units; `y` appends those of the units from
    /// one number up to another. A bound on the variance by a kurtosis takes its share of `levels`.
    pub fn of_all(
        quantity: Quantity,
        planned: Option<f64>,
        levels: Levels,
        units: usize,
        mut y: impl FnMut(usize, usize, &mut Vec<f64>),
    ) -> Self {
        let (mut scalar, mut values) = (Self::new(quantity, planned, levels), Vec::new());
        for (first, last) in doubling(units) {
            values.clear();
            y(first, last, &mut values);
            scalar.absorb(&values);
        }
        scalar.decide();
        scalar
    }
}

/// Blocks of units: 1, 1, 2, 4, 8, …
fn doubling(units: usize) -> impl Iterator<Item = (usize, usize)> {
    let begins = std::iter::successors(Some(0_usize), |&at| Some((2 * at).max(1)));
    begins.take_while(move |&at| at < units).map(move |at| (at, (2 * at).max(1).min(units)))
}

/// Decision on one of several quantities that are judged together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Joint {
    /// True if it fails.
    pub is_off: bool,
    /// True if it passes; a failure comes first.
    pub has_passed: bool,
    /// True if it is on the list of quantities that deviate.
    pub is_listed: bool,
}

impl Joint {
    /// The verdict.
    pub fn verdict(self) -> Verdict {
        match (self.is_off, self.has_passed) {
            (true, _) => Verdict::Fail,
            (false, true) => Verdict::Pass,
            (false, false) => Verdict::Inconclusive,
        }
    }
}

/// Decides quantities that share `alpha`.
pub fn decide_together(evidence: &[Evidence], alpha: f64) -> Vec<Joint> {
    let ln_e: Vec<f64> = evidence.iter().map(|evidence| evidence.ln_e).collect();
    let p: Vec<Option<f64>> = ln_e.iter().map(|ln_e| Some((-ln_e).exp().min(1.0))).collect();
    let is_off = holm(&p, p.len(), alpha);
    let decide = |(evidence, is_off): (&Evidence, bool)| {
        let has_passed = evidence.ln_pass.iter().all(|&ln_p| ln_p >= -MISS.ln());
        Joint { is_off, has_passed, is_listed: false }
    };
    let mut decisions: Vec<Joint> = evidence.iter().zip(is_off).map(decide).collect();
    for index in e_benjamini_hochberg(&ln_e, LISTED) {
        decisions[index].is_listed = true;
    }
    decisions
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_double_and_cover_all_units() {
        let blocks: Vec<_> = doubling(11).collect();
        assert_eq!(blocks, [(0, 1), (1, 2), (2, 4), (4, 8), (8, 11)]);
    }

    #[test]
    fn holm_fails_both_sides_pass_and_e_bh_lists() {
        let of = |ln_e: f64, ln_p| Evidence { ln_e, ln_pass: [5.0, ln_p] };
        // ln(3/0.01) = 5.70 for the largest, then ln(2/0.01) = 5.30; e-BH at 5 %: ln(3/0.1) = 3.40 for two.
        let finding = decide_together(&[of(5.8, 0.0), of(5.2, 4.7), of(0.0, 4.5)], 0.01);
        let verdicts: Vec<Verdict> = finding.iter().map(|finding| finding.verdict()).collect();
        assert_eq!(verdicts, [Verdict::Fail, Verdict::Pass, Verdict::Inconclusive]);
        assert_eq!(
            finding.iter().map(|finding| finding.is_listed).collect::<Vec<_>>(),
            [true, true, false]
        );
    }
}
