//! σ̂ and swept values as they stand beside their experiments: short, and no two of a case alike.

use crate::record::CaseRecord;
use numeric::digits::short;

/// Digits that are enough for most.
const FEWEST: usize = 4;
/// Digits that tell any two numbers apart.
const MOST: usize = 17;

/// How many digits the values of one case take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Labels {
    digits: usize,
}

impl Labels {
    /// Of a case.
    pub fn of(case: &CaseRecord) -> Self {
        Self::new(case.rows.iter().flat_map(|row| [row.sampling, row.swept]))
    }

    /// Of the σ̂ and the swept values of all rows.
    pub fn new(values: impl Iterator<Item = Option<f64>>) -> Self {
        Self { digits: distinct_digits(values.flatten().collect()) }
    }

    /// One of the values.
    pub fn text(&self, value: f64) -> String {
        short(value, self.digits)
    }
}

/// The fewest digits in which different values are printed differently.
fn distinct_digits(mut values: Vec<f64>) -> usize {
    values.sort_by(f64::total_cmp);
    values.dedup();
    let is_enough = |digits: &usize| {
        let texts: Vec<String> = values.iter().map(|&value| short(value, *digits)).collect();
        texts.windows(2).all(|pair| pair[0] != pair[1])
    };
    (FEWEST..MOST).find(is_enough).unwrap_or(MOST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_values_print_alike() {
        let labels = |values: &[f64]| {
            let labels = Labels::new(values.iter().copied().map(Some));
            values.iter().map(|&value| labels.text(value)).collect::<Vec<_>>()
        };
        assert_eq!(labels(&[0.486_39, 0.486_4, 0.6]), ["0.48639", "0.4864", "0.6"]);
        assert_eq!(labels(&[0.123_456, 2.0, 2.0]), ["0.1235", "2", "2"]);
        let near = [1.0, 1.0 + f64::EPSILON];
        assert_eq!(labels(&near), ["1", "1.0000000000000002"]);
        assert!(labels(&[]).is_empty());
    }
}
