//! Draw with few possible values: each value's share against its probability, by Pearson's χ².
//!
//! It applies where theory knows all values: 0 and 1 of tracking estimators, the powers `T_c (1 − r)^N` of a constant
//! ratio, the single value of deterministic estimators. A draw that equals none of them is unexpected: where the list
//! is complete, one such draw fails the check.

use super::batch::{Batch, each_value};
use super::check::{Question, Subject};
use super::distribution::DistributionTest;
use super::foreign::{ANY, ForeignDraws, ForeignTest};
use crate::CheckKind;
use gate::CheckId;
use gate::stats::chi_square;
use theory::{self, Prediction};

/// A draw counts as a value if it is this close to it, relative to the value's size.
const SAME: f64 = 1e-9;
/// A draw also counts as a value if it is this close to it in units of the largest value: 1 − r is rounded, and the 0
/// of r = 1 may be drawn as 1e-16.
const ROUNDING: f64 = 1e-15;

/// Values in ascending order with their probabilities.
struct AtomValues {
    value: Vec<f64>,
    probability: Vec<f64>,
    /// Largest relative distance at which a draw still counts as the value.
    same: f64,
}

impl AtomValues {
    fn of(mut atoms: Vec<(f64, f64)>, same: f64) -> Self {
        atoms.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (value, probability) = atoms.into_iter().unzip();
        Self { value, probability, same }
    }

    /// Returns whether two adjacent values are too close to be distinguished in rounded draws.
    fn is_blurred(&self) -> bool {
        let gaps = self.value.windows(2).map(|pair| pair[1] - pair[0]);
        let sizes = self.value.windows(2).map(|pair| pair[0].abs().max(pair[1].abs()));
        gaps.zip(sizes).any(|(gap, size)| gap < 4.0 * self.same * size)
    }

    /// Returns the expected number of draws outside the list of values.
    fn left_out(&self, draws: f64) -> f64 {
        (1.0 - self.probability.iter().sum::<f64>()).max(0.0) * draws
    }

    /// Returns the index of the nearest value, if it is close enough.
    fn find(&self, x: f64) -> Option<usize> {
        let after = self.value.partition_point(|&value| value < x);
        let ends = [self.value.first(), self.value.last()];
        let largest = ends.into_iter().flatten().fold(0.0, |maximum: f64, x| maximum.max(x.abs()));
        let near = |i: &usize| {
            let value = self.value[*i];
            (x - value).abs() <= self.same * value.abs() + ROUNDING * largest
        };
        let sides = [after, after.wrapping_sub(1)].into_iter().filter(|&i| i < self.value.len());
        let distance = |i: &usize| (x - self.value[*i]).abs();
        sides.filter(near).min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }
}

impl DistributionTest for AtomValues {
    fn size(&self) -> usize {
        self.value.len() + 1
    }

    fn add(&self, draws: &Batch, _: usize, sums: &mut [f64]) {
        let strange = self.value.len();
        let count = |x: f64, times| sums[self.find(x).unwrap_or(strange)] += times;
        each_value(draws.values[0].as_ref(), &draws.draws.values[0], count);
    }

    fn p_value(&self, sums: &[f64], draws: f64) -> Option<f64> {
        let known = self.value.len();
        // A product of many factors may fall below the last listed power; such draws are as rare as the probability
        // that the list leaves out.
        let expected = self.left_out(draws);
        let strange = if expected < 1e-6 { 0.0 } else { 10.0 + 10.0 * expected };
        if sums[known] > strange {
            return Some(0.0);
        }
        chi_square::p_value(&sums[..known], &self.probability)
    }

    fn details(&self, sums: &[f64], draws: f64) -> String {
        let strange = sums[self.value.len()];
        if strange <= 10.0 * self.left_out(draws).max(0.01) {
            return String::new();
        }
        let draws_are = if strange > 1.0 { "draws are" } else { "draw is" };
        format!("{strange} {draws_are} none of the {} values that can occur", self.value.len())
    }
}

/// Returns the values and their probabilities, if theory knows them.
fn atoms(prediction: &Prediction) -> Option<Vec<(f64, f64)>> {
    match &prediction.distribution {
        Some(theory::Distribution::Atoms(atoms)) => Some(atoms.clone()),
        _ => None,
    }
}

/// Returns the tests of foreign draws; none if rounding hides which value a draw is.
fn of_foreign(draws: &ForeignDraws) -> Vec<ForeignTest> {
    let Some(atoms) = draws.in_full().and_then(atoms) else { return Vec::new() };
    let same = draws.error_of_product().max(SAME);
    let (what, values) = ("the distribution of the values", AtomValues::of(atoms, same));
    if values.is_blurred() {
        let why = format!("values of a draw are closer to each other than {same:.1e}, relative");
        return vec![ForeignTest { what: what.into(), test: Err(why), between: ANY }];
    }
    ForeignTest::of(what, Some(values), ANY)
}

/// The check.
// Two values have an exact binomial distribution, which has discrete p-values.
pub const CHECK: CheckKind =
    CheckKind::new(CheckId::Atoms, questions).not_uniform().of_foreign(of_foreign);

/// Returns the questions of this check.
fn questions(subject: &Subject) -> Vec<Question> {
    let Some(atoms) = atoms(subject.prediction) else { return Vec::new() };
    let values = AtomValues::of(atoms, SAME);
    let bins = chi_square::testable_bins(&values.probability, subject.fixed as f64);
    Question::distribution(
        CheckId::Atoms,
        "the shares of the values",
        (bins >= 2).then_some(values),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rounded_zero_is_zero_and_a_strange_value_is_none() {
        let values = AtomValues::of(vec![(1.0, 0.4), (0.0, 0.6)], SAME);
        assert_eq!(
            [values.find(0.0), values.find(-1.1e-16), values.find(1.0)],
            [Some(0), Some(0), Some(1)]
        );
        assert_eq!([values.find(1e-9), values.find(0.5), values.find(1.1)], [None; 3]);
        // Powers of a small ratio are separated, however small they are.
        let powers = AtomValues::of((0..20).map(|n| (0.01f64.powi(n), 0.05)).collect(), SAME);
        assert_eq!(powers.find(0.01f64.powi(3) * (1.0 + 1e-12)), Some(16));
        assert_eq!(powers.find(0.5 * 0.01f64.powi(3)), None);
    }
}
