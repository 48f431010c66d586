//! Wrong rules at a collision.
//!
//! ```text
//! W = (1 − r)/q with probability q, else 0
//! weight           q = 1
//! terminating      q = |1 − r|,                        0 ≤ r ≤ 2
//! non-terminating  q = |1 − r|/D, D = a|r| + |1 − r|,  every r
//! ```
//!
//! A weight must make up for the probability of survival, with its sign. The mean is right only if `E[W] = 1 − r` at every
//! collision: a sign, a bound or a cut that looks harmless for `0 ≤ r ≤ 1` is a bias elsewhere.

use numeric::Lane;
use theory::collisions::Outcome;
use theory::collisions::rules::{Collision, Extinctions};

/// The albedo of the experiments.
pub const ALBEDO: f64 = 0.7;

/// Function from the correct outcome and r to a wrong survival and weight.
pub type Mistake = fn(Outcome, f64) -> Outcome;

/// A rule, perhaps with a mistake. What a survivor is due stays right.
#[derive(Debug, Clone, Copy)]
pub struct Wrong<R> {
    /// The correct rule.
    pub rule: R,
    /// The mistake.
    pub mistake: Option<Mistake>,
}

impl<R: Collision> Collision for Wrong<R> {
    const DECIDES: bool = R::DECIDES;

    fn jumps(&self) -> Vec<f64> {
        Vec::new()
    }

    #[inline(always)]
    fn at<L: Lane>(&self, ratio: L) -> Outcome<L> {
        let right = self.rule.at(ratio);
        let Some(mistake) = self.mistake else { return right };
        let wrong = |ratio: f64| mistake(self.rule.at(ratio), ratio);
        let survival = ratio.map(|ratio| wrong(ratio).survival);
        Outcome { survival, weight: ratio.map(|ratio| wrong(ratio).weight), ..right }
    }

    #[inline(always)]
    fn absorption<L: Lane>(&self, extinctions: &Extinctions<L>, number: L) -> L::Mask {
        if self.mistake.is_none() {
            return self.rule.absorption(extinctions, number);
        }
        self.at(extinctions.ratio()).survival.at_most(number)
    }

    #[inline(always)]
    fn unbiased_weight<L: Lane>(&self, ratio: L, survival: L) -> L {
        self.rule.unbiased_weight(ratio, survival)
    }
}

/// Returns an outcome with a wrong weight.
pub fn weighing(right: Outcome, weight: f64) -> Outcome {
    Outcome { weight, ..right }
}

/// Returns an outcome with a wrong probability of survival.
pub fn surviving(right: Outcome, survival: f64) -> Outcome {
    Outcome { survival, ..right }
}

/// `q = (1 − r)/D > 1` and weight D for `r < 0`: it survives for certain, with too small a weight.
pub fn literal(right: Outcome, ratio: f64) -> Outcome {
    let sum = ALBEDO * ratio + (1.0 - ratio);
    if ratio >= 0.0 { right } else { weighing(surviving(right, (1.0 - ratio) / sum), sum) }
}
