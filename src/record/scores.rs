//! Distribution of the z-scores of a run, beside the standard normal that correct estimators give.

use statrs::distribution::{Binomial, DiscreteCDF};

use crate::record::{Results, Row, Score};
use gate::stats::normal::upper_tail;

/// Number of bins of unit width/2 between −[`EDGE`] and [`EDGE`].
const BINS: usize = 16;
/// Largest |z| with a bin of its own; scores beyond are counted at the edges.
pub const EDGE: f64 = 4.0;
/// Width of a bin.
pub const WIDTH: f64 = 2.0 * EDGE / BINS as f64;
/// Probability that a bin of a correct run lies outside of its band.
const OUTSIDE: f64 = 0.01;

/// Scores of one quantity, counted in bins.
#[derive(Debug, Clone)]
pub struct Scores {
    /// Quantity.
    pub score: Score,
    /// Number of scores.
    pub all: u64,
    /// Bins, from below −[`EDGE`] to above [`EDGE`].
    pub bins: Vec<Bin>,
}

/// Scores between two values, and their number among as many scores of a standard normal.
#[derive(Debug, Clone, Copy)]
pub struct Bin {
    /// Lower and upper end; the outermost bins have an infinite one.
    pub ends: [f64; 2],
    /// Number of scores.
    pub count: u64,
    /// Expected number.
    pub expected: f64,
    /// Numbers between which a correct run lies with a probability of 99 %.
    pub band: [u64; 2],
}

impl Bin {
    /// Returns whether the number is one that a correct run has.
    pub fn is_usual(&self) -> bool {
        (self.band[0]..=self.band[1]).contains(&self.count)
    }
}

/// Returns the scores of means, variances and lookups. Scores that are not to be read as normal, of declared biases, and of
/// draws that count for another experiment, are left out, and so is a quantity without scores.
pub fn scores(results: &Results) -> Vec<Scores> {
    Score::ALL
        .into_iter()
        .map(|score| Scores::of(results, score))
        .filter(|one| one.all > 0)
        .collect()
}

impl Scores {
    fn of(results: &Results, score: Score) -> Self {
        let values: Vec<f64> = results.rows().filter_map(|row| value(&row, score)).collect();
        let all = values.len() as u64;
        let inner = (0..=BINS).map(|i| WIDTH * i as f64 - EDGE);
        let ends: Vec<f64> =
            [f64::NEG_INFINITY].into_iter().chain(inner).chain([f64::INFINITY]).collect();
        let bins = ends.windows(2).map(|pair| {
            let p = upper_tail(pair[0]) - upper_tail(pair[1]);
            let count = values.iter().filter(|&&z| pair[0] <= z && z < pair[1]).count() as u64;
            Bin { ends: [pair[0], pair[1]], count, expected: p * all as f64, band: band(all, p) }
        });
        Self { score, all, bins: bins.collect() }
    }
}

/// Returns the numbers between which a binomial count lies with a probability of 99 %.
fn band(trials: u64, p: f64) -> [u64; 2] {
    let Ok(count) = Binomial::new(p.clamp(0.0, 1.0), trials) else { return [0, trials] };
    [0.5 * OUTSIDE, 1.0 - 0.5 * OUTSIDE].map(|level| count.inverse_cdf(level))
}

/// Returns a finite score of a row that is to be read as normal.
fn value(row: &Row, score: Score) -> Option<f64> {
    let is_own = row.experiment.same_as.is_none()
        && !row.findings().any(|one| one.expects_bias)
        && (score != Score::Lookups || row.is_first());
    row.compared(score).z.filter(|z| z.is_finite() && is_own && row.is_normal(score))
}
