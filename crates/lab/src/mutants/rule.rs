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
use theory::Outcome;
use theory::rules::{Collision, Met, Null, Single, Weight};

/// The albedo of the experiments.
pub const ALBEDO: f64 = 0.7;

/// A correct rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rule {
    Weight,
    Null,
    Single(Single),
}

impl Rule {
    #[inline(always)]
    fn at<L: Lane>(&self, ratio: L) -> Outcome<L> {
        match self {
            Self::Weight => Weight.at(ratio),
            Self::Null => Null.at(ratio),
            Self::Single(single) => single.at(ratio),
        }
    }
}

/// Function from the correct outcome and r to a wrong survival and weight.
pub type Mistake = fn(Outcome, f64) -> Outcome;

/// A rule, perhaps with a mistake; it `DECIDES` by a random number if the rule does.
#[derive(Debug, Clone, Copy)]
pub struct Wrong<const DECIDES: bool>(pub Rule, pub Option<Mistake>);

impl<const DECIDES: bool> Collision for Wrong<DECIDES> {
    const DECIDES: bool = DECIDES;

    fn jumps(&self) -> Vec<f64> {
        Vec::new()
    }

    #[inline(always)]
    fn at<L: Lane>(&self, ratio: L) -> Outcome<L> {
        let right = self.0.at(ratio);
        let Some(mistake) = self.1 else { return right };
        let wrong = |ratio: f64| mistake(self.0.at(ratio), ratio);
        let survival = ratio.map(|ratio| wrong(ratio).survival);
        Outcome { survival, weight: ratio.map(|ratio| wrong(ratio).weight), ..right }
    }

    #[inline(always)]
    fn kills<L: Lane>(&self, met: &Met<L>, number: L) -> L::Mask {
        match self {
            Self(Rule::Null, None) => Null.kills(met, number),
            _ => self.at(met.ratio()).survival.at_most(number),
        }
    }

    /// Returns the correct factor: a mistake is in the outcome only.
    #[inline(always)]
    fn due<L: Lane>(&self, ratio: L, survival: L) -> L {
        match self.0 {
            Rule::Weight => ratio.one_minus(),
            _ => ratio.one_minus() / survival,
        }
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
