//! What a bench found: all that its reports may know.
//!
//! Unknown is `None`, never zero. All times are in [`Times`] and [`Conditions`]; everything else is
//! the same for any number of threads on any machine.

use serde::Serialize;

use super::clock::Clock;
use super::comparison::Comparison;
use super::spread::Spread;

/// A finished bench.
#[derive(Debug, Clone, Serialize)]
pub struct Bench {
    /// The version of the tool.
    pub version: String,
    /// The seed.
    pub seed: u64,
    /// Draws of an experiment in a round.
    pub draws: u64,
    /// Rounds.
    pub rounds: u32,
    /// Where and how it was timed.
    pub conditions: Conditions,
    /// The cases, in the order they were given.
    pub cases: Vec<BenchCase>,
    /// What changed since a stored bench, where it was compared with one.
    pub comparison: Option<Comparison>,
}

/// Where and how it was timed.
#[derive(Debug, Clone, Serialize)]
pub struct Conditions {
    /// How many threads drew at once.
    pub threads: usize,
    /// What time is.
    pub clock: Clock,
    /// The vector hardware that was used.
    pub level: String,
    /// Seconds of the whole bench.
    pub seconds: f64,
    /// The median of all experiments' speedups, the least and the most.
    pub speedup: Option<Spread>,
}

/// What was found for one case.
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
    /// What is swept, if anything.
    pub swept: Option<String>,
    /// One row per experiment and channel; the rows of one experiment follow each other.
    pub rows: Vec<BenchRow>,
}

impl BenchCase {
    /// The first row of each experiment.
    pub fn experiments(&self) -> impl Iterator<Item = &BenchRow> {
        self.rows.iter().filter(|row| row.is_first)
    }
}

/// One experiment, one channel of its value.
#[derive(Debug, Clone, Default, Serialize)]
pub struct BenchRow {
    /// Whether it is the first row of its experiment.
    pub is_first: bool,
    /// The estimator with its own settings.
    pub estimator: String,
    /// The constant sampling extinction, 1/length; `None` where σ̂ varies or is not used.
    pub sampling: Option<f64>,
    /// The sampling extinction in words; empty where none is used.
    pub sampling_kind: String,
    /// The control in words; empty for none.
    pub control: String,
    /// The value of the swept quantity.
    pub swept: Option<f64>,
    /// The channel's name; empty where the value has one channel only.
    pub channel: String,
    /// How many draws the mean and the variance are of: those of all rounds.
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
    /// The same in theory.
    pub predicted_lookups: Option<f64>,
    /// Lookups of σ_t for a ray before its first draw, as at explorer points and by pilot rays.
    pub setup_lookups: Option<u64>,
    /// Knowledge of the medium that σ̂, control and estimator need beside lookups, as in `τ`; empty for none.
    pub needs: String,
    /// 1/(variance · (lookups per draw + setup lookups/draws per ray)), both those of theory where it has them.
    pub fom: Option<f64>,
    /// How the error falls.
    pub curve: Vec<CurvePoint>,
    /// Whether a plot with room for one line per estimator shows this one: of a sweep the point with
    /// the largest figure of merit, of a curve the last channel.
    pub is_shown: bool,
    /// Whether it was refused.
    pub is_refused: bool,
    /// Why it is refused, or why numbers are missing; empty where all is there.
    pub reason: String,
    /// What depends on the machine; `None` where nothing was drawn.
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
    /// The same, relative to the truth.
    pub relative: f64,
    /// The least of the rounds, relative.
    pub least: f64,
    /// The most of the rounds, relative.
    pub most: f64,
    /// √(V/n)/T; `None` where the draws have no variance that is known.
    pub predicted: Option<f64>,
}

/// What depends on the machine.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Times {
    /// Nanoseconds of a draw; with several threads, of all threads together.
    pub ns_per_draw: Spread,
    /// Nanoseconds of a draw of the plain loop on one thread.
    pub plain_ns_per_draw: Spread,
    /// How many times as fast as the plain loop a single thread is.
    pub speedup: Spread,
    /// How many times as fast as one thread all are; `None` with one thread.
    pub scaling: Option<Spread>,
    /// Draws in a second.
    pub draws_per_second: f64,
    /// Nanoseconds of a lookup of σ_t; `None` where nothing was looked up.
    pub ns_per_lookup: Option<f64>,
    /// Seconds to a relative standard error of 1e-2, 1e-3 and 1e-4; `None` where none is known.
    pub seconds_to: Option<[f64; 3]>,
    /// 1/(variance · seconds of a draw).
    pub efficiency: Option<f64>,
    /// Seconds at the points of the curve.
    pub seconds: Vec<f64>,
    /// Seconds of the plain loop there.
    pub plain_seconds: Vec<f64>,
}

impl Times {
    /// TTUV, the time to unit variance: variance · seconds of a draw, the efficiency upside down.
    pub fn ttuv(&self) -> Option<f64> {
        self.efficiency.map(f64::recip)
    }
}
