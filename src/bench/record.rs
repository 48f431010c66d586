//! Record of a bench: everything that its reports use.
//!
//! Unknown is `None`, never zero. All times are in [`Times`] and [`Conditions`]; everything else is
//! the same for any number of threads on any machine.

use serde::{Deserialize, Serialize};

use super::clock::Clock;
use super::stored::BenchComparison;
use crate::case::id::ExperimentId;
use crate::case::sweep::SweptQuantity;
use crate::record::Digits;

/// A finished bench.
#[derive(Debug, Clone)]
pub struct Bench {
    /// The version of the tool.
    pub version: String,
    /// The seed.
    pub seed: u64,
    /// Draws of an experiment in a round.
    pub draws: u64,
    /// Rounds.
    pub rounds: u32,
    /// Conditions of the timing.
    pub conditions: Conditions,
    /// The cases, in the order they were given.
    pub cases: Vec<BenchCase>,
    /// Changes since a stored bench, if the bench was compared with one.
    pub comparison: Option<BenchComparison>,
}

/// Conditions of the timing.
#[derive(Debug, Clone)]
pub struct Conditions {
    /// Number of threads that drew at once.
    pub threads: usize,
    /// Clock of the times.
    pub clock: Clock,
    /// The vector hardware that was used.
    pub level: String,
    /// Seconds of the whole bench.
    pub seconds: f64,
    /// The median of all experiments' speedups, the least and the most.
    pub speedup: Option<Spread>,
}

/// Results of one case.
#[derive(Debug, Clone, Serialize)]
pub struct BenchCase {
    /// The case's name.
    pub name: String,
    /// Its title.
    pub title: String,
    /// The problem's name.
    pub problem: String,
    /// The field's name in the catalogue.
    pub medium: String,
    /// A hash of the case's text.
    pub digest: String,
    /// Swept quantity, if there is one.
    pub swept: Option<SweptQuantity>,
    /// One row per experiment and channel; the rows of one experiment follow each other.
    pub rows: Vec<BenchRow>,
}

impl BenchCase {
    /// Returns the digits that distinguish σ̂ and swept values.
    pub fn digits(&self) -> Digits {
        Digits::new(self.rows.iter().flat_map(|row| [row.sampling(), row.id.swept_value()]))
    }

    /// Returns the first row of each experiment.
    pub fn experiments(&self) -> impl Iterator<Item = &BenchRow> {
        self.rows.iter().filter(|row| row.is_first)
    }
}

/// One experiment, one channel of its value.
#[derive(Debug, Clone, Default, Serialize)]
pub struct BenchRow {
    /// True if it is the first row of its experiment.
    pub is_first: bool,
    /// Identity of the experiment.
    pub id: ExperimentId,
    /// The number of the estimator in the case's list, from 0.
    pub listed: usize,
    /// The channel's name; empty where the value has one channel only.
    pub channel: String,
    /// Number of draws of the mean and the variance: those of all rounds.
    pub draws: Option<u64>,
    /// The mean of the draws.
    pub mean: Option<f64>,
    /// The exact answer.
    pub truth: Option<f64>,
    /// The unbiased sample variance of one draw.
    pub variance: Option<f64>,
    /// The variance of one draw in theory.
    pub predicted_variance: Option<f64>,
    /// The mean number of lookups of σ_t.
    pub lookups_per_draw: Option<f64>,
    /// The predicted mean number of lookups of σ_t.
    pub predicted_lookups: Option<f64>,
    /// Lookups of σ_t for a ray before its first draw, as at explorer points and by pilot rays.
    pub setup_lookups: Option<u64>,
    /// Knowledge of the medium that σ̂, control and estimator need beside lookups, as in `τ`; empty for none.
    pub needs: String,
    /// 1/(variance · (lookups per draw + setup lookups/draws per ray)), both those of theory where it has them.
    pub fom: Option<f64>,
    /// Error after growing numbers of draws.
    pub curve: Vec<CurvePoint>,
    /// True if a plot with room for one line per estimator shows this one: of a sweep the point with the largest figure
    /// of merit, of a curve the last channel.
    pub is_shown: bool,
    /// True if it was refused.
    pub is_refused: bool,
    /// Why it is refused, or why numbers are missing; empty where all is there.
    pub reason: String,
    /// Times, which depend on the machine; `None` where nothing was drawn.
    pub times: Option<Times>,
}

/// The error after a number of draws, relative to the truth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CurvePoint {
    /// Draws.
    pub draws: u64,
    /// Their lookups of σ_t, with their share of the setup lookups.
    pub lookups: f64,
    /// |mean − T|, absolute: the root of its mean square over the rounds.
    pub error: f64,
    /// The error relative to the truth.
    pub relative: f64,
    /// Minimum over the rounds, relative.
    pub least: f64,
    /// Maximum over the rounds, relative.
    pub most: f64,
    /// √(V/n)/T; `None` where the variance of the draws is unknown.
    pub predicted: Option<f64>,
}

/// Times of an experiment, which depend on the machine.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Times {
    /// Nanoseconds of a draw; with several threads, of all threads together.
    pub ns_per_draw: Spread,
    /// Nanoseconds of a draw of the plain loop on one thread.
    pub plain_ns_per_draw: Spread,
    /// Speed of a single thread relative to the plain loop.
    pub speedup: Spread,
    /// Speed of all threads relative to one; `None` with one thread.
    pub scaling: Option<Spread>,
    /// Draws in a second.
    pub draws_per_second: f64,
    /// Nanoseconds of a lookup of σ_t; `None` where nothing was looked up.
    pub ns_per_lookup: Option<f64>,
    /// Seconds to a relative standard error of 1e-2, 1e-3 and 1e-4; `None` where the variance is unknown.
    pub seconds_to: Option<[f64; 3]>,
    /// 1/(variance · seconds of a draw).
    pub efficiency: Option<f64>,
}

impl BenchRow {
    /// Returns the constant sampling extinction, 1/length; `None` where σ̂ varies or is not used.
    pub fn sampling(&self) -> Option<f64> {
        self.id.sampling.constant.map(|value| value.0)
    }
}

impl Times {
    /// Returns the seconds of a number of draws.
    pub fn seconds(&self, draws: u64) -> f64 {
        draws as f64 * self.ns_per_draw.median * 1e-9
    }

    /// Returns the seconds of a number of draws of the plain loop.
    pub fn plain_seconds(&self, draws: u64) -> f64 {
        draws as f64 * self.plain_ns_per_draw.median * 1e-9
    }

    /// Returns the time to unit variance (TTUV), variance · seconds of a draw: the reciprocal of the efficiency.
    pub fn ttuv(&self) -> Option<f64> {
        self.efficiency.map(f64::recip)
    }
}

/// Median of the rounds with the minimum and the maximum.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Median; of an even number of rounds, the mean of the middle two.
    pub median: f64,
    /// Minimum.
    pub least: f64,
    /// Maximum.
    pub most: f64,
}

impl Spread {
    /// Returns the spread of some figures; `None` of none.
    pub fn of(figures: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut sorted: Vec<f64> = figures.into_iter().collect();
        sorted.sort_by(f64::total_cmp);
        let (least, most) = (*sorted.first()?, *sorted.last()?);
        let (upper, lower) = (sorted[sorted.len() / 2], sorted[(sorted.len() - 1) / 2]);
        Some(Self { median: lower.midpoint(upper), least, most })
    }

    /// Multiplies all three by a factor above 0.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        let [median, least, most] = [self.median, self.least, self.most].map(|x| x * factor);
        Self { median, least, most }
    }
}

/// The relative standard errors to which times are given.
pub const ERRORS: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// Returns the time until the standard error is `error` of the truth: `V/(ε²T²)` draws.
pub fn time_to(error: f64, variance: f64, truth: f64, seconds_per_draw: f64) -> f64 {
    let deviation = variance.sqrt() / (error * truth);
    deviation * deviation * seconds_per_draw
}

/// `1/(variance · price)`, where both are above 0.
pub fn efficiency(variance: f64, price: f64) -> Option<f64> {
    Some(1.0 / (variance * price)).filter(|efficiency| efficiency.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_in_the_middle() {
        let of = |figures: &[f64]| Spread::of(figures.iter().copied());
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[3.0, 1.0, 2.0]), Some(Spread { median: 2.0, least: 1.0, most: 3.0 }));
        assert_eq!(of(&[4.0, 1.0, 2.0, 3.0]).map(|spread| spread.median), Some(2.5));
    }

    #[test]
    fn a_hand_worked_case() {
        // V = 4, T = 2: a relative error of 1e-2 takes 4/(1e-4 · 4) = 1e4 draws.
        assert!((time_to(1e-2, 4.0, 2.0, 1e-6) - 1e-2).abs() < 1e-16);
        assert_eq!(efficiency(4.0, 0.5), Some(0.5));
        assert_eq!(efficiency(0.0, 1.0), None);
    }

    #[test]
    fn a_tenth_of_the_error_takes_a_hundred_times_the_time() {
        let [first, second, third] = ERRORS.map(|error| time_to(error, 0.3, 0.02, 1e-7));
        assert!((second / first - 100.0).abs() < 1e-9 && (third / second - 100.0).abs() < 1e-9);
    }
}
