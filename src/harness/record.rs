//! What a run found: all that a report may know.
//!
//! A record has two parts. `results` is the same to the bit for any number of threads on any
//! machine; `timing` is not, and is kept apart. Unknown is `None`, never zero.

use serde::Serialize;

/// A finished run, prediction or plan.
#[derive(Debug, Clone, Serialize)]
pub struct Record {
    /// What was drawn, predicted and decided.
    pub results: Results,
    /// How long it took, and where.
    pub timing: Timing,
}

/// The part of a record that depends on nothing but the cases, the seed and the options.
#[derive(Debug, Clone, Serialize)]
pub struct Results {
    /// The version of the tool.
    pub version: String,
    /// The run's seed.
    pub seed: u64,
    /// The chance that a correct run shows any failure at all.
    pub alpha: f64,
    /// How many checks share `alpha`; fixed before the first draw.
    pub checks: usize,
    /// Whether a time limit cut the draws short; such results depend on the machine.
    pub cut_by_time: bool,
    /// The cases, in the order they were given.
    pub cases: Vec<CaseRecord>,
}

/// What was found for one case file.
#[derive(Debug, Clone, Serialize)]
pub struct CaseRecord {
    /// The case's name: its path below the cases folder, without `.toml`.
    pub name: String,
    /// Its title.
    pub title: String,
    /// The problem's name: `transmittance`, `free-flight`, `transmittance-curve`.
    pub problem: String,
    /// The field's name in the catalogue.
    pub medium: String,
    /// One row per experiment and channel; the rows of one experiment follow each other.
    pub rows: Vec<Row>,
    /// What was swept, with the theory's curves.
    pub sweep: Option<Sweep>,
    /// The ray seen from the side, for cases with a curve.
    pub anatomy: Option<Anatomy>,
}

/// One experiment (one estimator at one sweep point), one channel of its value.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Row {
    /// The estimator with its own settings, as in `single(non-terminating, a=0.7)`.
    pub estimator: String,
    /// The constant sampling extinction, 1/length; `None` where σ̂ varies or is not used.
    pub sampling: Option<f64>,
    /// The sampling extinction in words, as in `piecewise-linear`; empty where none is used.
    pub sampling_kind: String,
    /// The control in words, as in `constant 0.3`; empty for none.
    pub control: String,
    /// The value of the swept quantity; `None` for experiments outside the sweep.
    pub swept: Option<f64>,
    /// The channel's name, as in `T(5)`; empty where the value has one channel only.
    pub channel: String,
    /// How many draws were made.
    pub draws: Option<u64>,
    /// The mean of the draws.
    pub mean: Option<f64>,
    /// The standard error of the mean from the draws' own variance.
    pub standard_error: Option<f64>,
    /// The exact answer.
    pub truth: Option<f64>,
    /// The bound on the truth's own error.
    pub truth_error: Option<f64>,
    /// (mean − truth) in predicted standard errors.
    pub z_mean: Option<f64>,
    /// The unbiased sample variance of one draw.
    pub variance: Option<f64>,
    /// The variance of one draw in theory.
    pub predicted_variance: Option<f64>,
    /// (variance − predicted) in predicted standard deviations of the sample variance.
    pub z_variance: Option<f64>,
    /// The predicted standard deviation of the sample variance, for error bars.
    pub variance_deviation: Option<f64>,
    /// The mean number of lookups of σ_t.
    pub lookups_per_draw: Option<f64>,
    /// The same in theory.
    pub predicted_lookups: Option<f64>,
    /// (lookups − predicted) in predicted standard errors.
    pub z_lookups: Option<f64>,
    /// The predicted standard deviation of the mean number of lookups, for error bars.
    pub lookups_deviation: Option<f64>,
    /// The p-value of the test of the whole law, where the law is known.
    pub p_law: Option<f64>,
    /// The skewness of one draw in theory.
    pub predicted_skewness: Option<f64>,
    /// The kurtosis of one draw in theory (3 for the normal law).
    pub predicted_kurtosis: Option<f64>,
    /// The smallest relative bias of the mean that the run would have shown.
    pub detectable_bias: Option<f64>,
    /// The measured figure of merit, 1/(variance · lookups per draw).
    pub fom: Option<f64>,
    /// The same in theory.
    pub predicted_fom: Option<f64>,
    /// The share of the ray on which `w ≤ 2σ_t`, the stability condition, holds.
    pub stable_share: Option<f64>,
    /// The constant σ̂ with the largest predicted figure of merit; for the double particle, which
    /// has no optimum, the σ̂ that reaches 90 % of the limit.
    pub best_sampling: Option<f64>,
    /// The figure of merit there.
    pub best_fom: Option<f64>,
    /// `pass`, `fail`, `inconclusive`, `underpowered` or `refused`; `None` where nothing was drawn.
    pub verdict: Option<Verdict>,
    /// Why, in words; empty for a plain pass.
    pub reason: String,
    /// What each check found.
    pub findings: Vec<Finding>,
    /// `J_k = ∫ σ̂ E[(1 − W)^k]`, k = 1 … 4, of product estimators.
    pub losses: Option<[f64; 4]>,
    /// The central moments `μ_k/T^k` of one draw in theory, k = 2, 3, 4; `None` where they are
    /// unknown or overflow.
    pub relative_moments: [Option<f64>; 3],
    /// The variance of the number of lookups of one draw in theory.
    pub lookups_variance: Option<f64>,
    /// `P(0), P(1), …` lookups of one draw in theory; empty where unknown or longer than 100.
    pub lookups_pmf: Vec<f64>,
    /// `n(2)`: with fewer draws the events that make the variance are not seen.
    pub rare_event_size: Option<f64>,
    /// All values of the row are in units of `exp(−log_unit)`; `None` where they are as they are.
    pub log_unit: Option<f64>,
}

/// What is said of an experiment, or of one check.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Agrees with theory, and a difference of the size that matters would have been seen.
    Pass,
    /// Differs from theory by more than chance allows.
    Fail,
    /// Not refuted, but too few draws to tell.
    Inconclusive,
    /// The same, known beforehand and allowed by the case.
    Underpowered,
    /// Not drawn: the estimator does not exist or is biased here.
    Refused,
}

impl Verdict {
    /// The word in tables and files.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Inconclusive => "inconclusive",
            Self::Underpowered => "underpowered",
            Self::Refused => "refused",
        }
    }
}

/// What one check found of one experiment.
#[derive(Debug, Clone, Serialize)]
pub struct Finding {
    /// The check's name in the catalogue.
    pub check: String,
    /// The channel it is about; empty for the experiment as a whole.
    pub channel: String,
    /// The statistic, in standard deviations, where the check has one.
    pub z: Option<f64>,
    /// The p-value, for tests of a whole law.
    pub p: Option<f64>,
    /// What the check says.
    pub verdict: Verdict,
    /// Why, with the numbers.
    pub reason: String,
}

/// The axis of a sweep and the theory's curves along it.
#[derive(Debug, Clone, Serialize)]
pub struct Sweep {
    /// What is swept: `sampling`, `sampling-scale`, `albedo`, `control` or `points`.
    pub what: String,
    /// The axis title with symbol and unit.
    pub axis: String,
    /// Whether the axis is logarithmic.
    pub log: bool,
    /// Beyond this, a z-score fails its check.
    pub z_limit: Option<f64>,
    /// One curve per estimator.
    pub curves: Vec<Curve>,
}

/// What theory says of one estimator along the sweep.
#[derive(Debug, Clone, Serialize)]
pub struct Curve {
    /// The estimator's label: the same as in its rows.
    pub estimator: String,
    /// Its control in words: the same as in its rows.
    pub control: String,
    /// Points in ascending order; refused stretches are left out.
    pub points: Vec<CurvePoint>,
    /// Where the figure of merit is largest, if it has a maximum inside the sweep.
    pub optimum: Option<CurvePoint>,
}

/// Theory at one value of the swept quantity.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct CurvePoint {
    /// The swept value.
    pub x: f64,
    /// The variance of one draw.
    pub variance: f64,
    /// The expected lookups.
    pub lookups: f64,
    /// 1/(variance · lookups).
    pub fom: f64,
}

/// A ray seen from the side, as in Figures 5 and 8 of Szirmay-Kalos et al. 2017.
#[derive(Debug, Clone, Serialize)]
pub struct Anatomy {
    /// The estimator that the curves belong to.
    pub estimator: String,
    /// Distances along the ray, ascending.
    pub t: Vec<f64>,
    /// σ_t there, 1/length.
    pub extinction: Vec<f64>,
    /// The control there, 1/length; empty for none.
    pub control: Vec<f64>,
    /// σ_t less the control there, 1/length.
    pub residual: Vec<f64>,
    /// σ̂ there, 1/length.
    pub sampling: Vec<f64>,
    /// The exact transmittance T(t) there.
    pub transmittance: Vec<f64>,
    /// The standard deviation of one draw of it there.
    pub deviation: Vec<f64>,
    /// Where the control was fitted: (t, value).
    pub explorers: Vec<[f64; 2]>,
    /// The tentative collisions of the first walk: (t, σ_t).
    pub collisions: Vec<[f64; 2]>,
    /// T̂ of the first few walks at the distances `t`.
    pub walks: Vec<Vec<f64>>,
    /// What was measured: one entry per channel.
    pub measured: Vec<MeasuredPoint>,
}

/// A measured point of the transmittance along a ray.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct MeasuredPoint {
    /// The distance.
    pub t: f64,
    /// The mean of the draws.
    pub mean: f64,
    /// The standard error of the mean.
    pub standard_error: f64,
    /// The standard deviation of one draw.
    pub deviation: f64,
}

/// The part of a record that differs from run to run.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Timing {
    /// How many threads drew.
    pub threads: usize,
    /// Wall-clock seconds of the whole run.
    pub seconds: f64,
    /// Per case and row, the processor seconds of the drawing; the rows of one experiment share
    /// one figure. `None` where nothing was drawn.
    pub rows: Vec<Vec<Option<f64>>>,
}
