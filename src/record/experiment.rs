//! Results of an experiment: its identity, its channels, and the findings of the checks.

use std::ops::{Deref, DerefMut};

use checks::check::CheckResult;
use estimators::{Knowledge, Refusal};
use gate::CheckId;
use numeric::Grade;
use serde::{Deserialize, Serialize};

use crate::plan::ExperimentId;
use crate::plan::levels::Foreseen;
use crate::record::{Best, Course, Verdict};

/// Results of one experiment: one estimator at one point of the sweep.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct ExperimentRecord {
    /// Identity of the experiment.
    pub id: ExperimentId,
    /// Label of the estimator in tables, as in `single (non-terminating, a=0.7)`.
    pub label: String,
    /// Name of the experiment within its case, as in `ratio, σ̂ 0.5, control mean`: short, and distinct from others.
    pub name: String,
    /// The number of the estimator in the case's list, from 0.
    pub listed: usize,
    /// Knowledge of the medium that σ̂, control and estimator need beside lookups.
    pub needs: Vec<Knowledge>,
    /// Reason why it is not drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refusal: Option<Refusal>,
    /// Earlier experiment of the case that is the same by definition: both share their draws.
    pub same_as: Option<ExperimentId>,
    /// Share of the ray's support, or in space of the box around the volume, that is skipped as empty: σ̂ is 0 there.
    /// `None` if nothing is skipped.
    pub skipped: Option<f64>,
    /// Number of draws of the means, variances and z-scores, fixed by the plan.
    pub draws: Option<u64>,
    /// Number of draws that the gate took to decide.
    pub drawn: Option<u64>,
    /// Number of the experiment's streams: with the seed and a block's number it is their address.
    pub stream: Option<u64>,
    /// The command that repeats the experiment.
    pub command: String,
    /// Lookups of σ_t for a ray before its first draw, as at explorer points and by pilot rays, which are not part of
    /// the lookups per draw. `None` if the experiment is refused.
    pub setup_lookups: Option<u64>,
    /// The mean number of lookups of σ_t.
    #[serde(with = "gate::extended")]
    pub lookups_per_draw: Option<f64>,
    /// The predicted mean number of lookups of σ_t.
    pub predicted_lookups: Option<f64>,
    /// (lookups − predicted) in predicted standard errors.
    pub z_lookups: Option<f64>,
    /// The predicted standard deviation of the mean number of lookups, for error bars.
    pub lookups_deviation: Option<f64>,
    /// The predicted variance of the number of lookups of one draw.
    pub lookups_variance: Option<f64>,
    /// Bound on the relative error of the predicted mean number of lookups.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lookups_error: Option<f64>,
    /// Ground of `lookups_error`; `None` without a prediction of lookups.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lookups_grade: Option<Grade>,
    /// Bound on the relative error of the predicted variance and fourth central moment of the number of lookups; `None`
    /// without a bound.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lookups_moments_error: Option<f64>,
    /// The predicted mean number of lookups of one draw's walk, where its shadow rays look up, too.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub walk_lookups: Option<f64>,
    /// The predicted mean number of lookups of one draw's shadow rays; `None` without shadow rays, or if it is unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shadow_lookups: Option<f64>,
    /// Predicted probabilities `P(0), P(1), …` of the number of lookups of one draw; empty if unknown or longer than 100.
    pub lookups_pmf: Vec<f64>,
    /// The share of the ray on which the variance stays bounded, `σ̂ E[(1 − W)²] ≤ 2σ_t`.
    pub stable_share: Option<f64>,
    /// The smallest p-value of the tests of distributions.
    pub p_law: Option<f64>,
    /// The fields along the ray, one for each channel of the medium, if the experiment is refused.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub courses: Vec<Course>,
    /// Findings of all checks, in the order of the catalogue.
    pub findings: Vec<Finding>,
    /// Time of the drawing: it differs from run to run.
    #[serde(skip)]
    pub spent: Spent,
    /// The channels of a draw; one without a name if the experiment is refused, or if a draw is one value.
    pub channels: Vec<ChannelRecord>,
}

/// Time of an experiment.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Spent {
    /// Processor seconds of the drawing; `None` if nothing was drawn.
    pub seconds: Option<f64>,
    /// True if an earlier run made the draws, and spent the time.
    pub is_reused: bool,
}

/// Results of one channel of an experiment.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct ChannelRecord {
    /// The channel's name, as in `T(5)` or `reflectance`; empty if a draw is one value.
    #[serde(rename = "name")]
    pub channel: String,
    /// The mean of the draws.
    #[serde(with = "gate::extended")]
    pub mean: Option<f64>,
    /// The standard error of the mean from the draws' own variance.
    #[serde(with = "gate::extended")]
    pub standard_error: Option<f64>,
    /// The exact answer.
    pub truth: Option<f64>,
    /// The bound on the truth's own error.
    pub truth_error: Option<f64>,
    /// (mean − truth) in predicted standard errors.
    #[serde(with = "gate::extended")]
    pub z_mean: Option<f64>,
    /// The unbiased sample variance of one draw.
    #[serde(with = "gate::extended")]
    pub variance: Option<f64>,
    /// The predicted variance of one draw.
    #[serde(with = "gate::extended")]
    pub predicted_variance: Option<f64>,
    /// (variance − predicted) in predicted standard deviations of the sample variance.
    #[serde(with = "gate::extended")]
    pub z_variance: Option<f64>,
    /// The predicted standard deviation of the sample variance, for error bars.
    pub variance_deviation: Option<f64>,
    /// z-scores that are not to be read as normal: the draws are too few, or their tails too heavy.
    pub not_normal: Vec<Score>,
    /// The predicted skewness of one draw.
    pub predicted_skewness: Option<f64>,
    /// The predicted kurtosis of one draw (3 for the normal distribution).
    #[serde(with = "gate::extended")]
    pub predicted_kurtosis: Option<f64>,
    /// ε of the mean: the smallest bias, relative to the truth, that a pass excludes.
    #[serde(with = "gate::extended")]
    pub detectable_bias: Option<f64>,
    /// The measured figure of merit, 1/(variance · (lookups per draw + setup lookups/draws per ray)).
    #[serde(with = "gate::extended")]
    pub fom: Option<f64>,
    /// The predicted figure of merit.
    pub predicted_fom: Option<f64>,
    /// The constant σ̂ with the largest predicted figure of merit; `None` if it was not searched.
    pub best: Option<Best>,
    /// `pass`, `fail`, `inconclusive`, `underpowered` or `refused`; `None` if nothing was drawn.
    pub verdict: Option<Verdict>,
    /// Command that decides an inconclusive channel; in a plan, one that decides all of the case that it leaves
    /// inconclusive. Empty if no number of draws does, and for all other channels.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub decide: String,
    /// Best verdict of a plan that has too few draws for a pass; `None` in a run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub foreseen: Option<Foreseen>,
    /// `J_k = ∫ σ̂ E[(1 − W)^k]`, k = 1 … 4, of product estimators.
    #[serde(with = "gate::extended")]
    pub losses: Option<[f64; 4]>,
    /// The predicted central moments `μ_k/T^k` of one draw, k = 2, 3, 4; `None` if they are
    /// unknown or overflow.
    pub relative_moments: [Option<f64>; 3],
    /// Bound on the relative error of the predicted variance and, if that is known, of the fourth moment; `None`
    /// without a bound.
    pub moments_error: Option<f64>,
    /// Ground of `truth_error` and `moments_error`; `None` if the truth is unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_grade: Option<Grade>,
    /// Predicted covariance of one draw with the next channel; `None` for the last channel, or if it is unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub covariance: Option<f64>,
    /// `n(2)`: fewer draws do not contain the events that make the variance.
    pub rare_event_size: Option<f64>,
    /// `E[X⁸]/E[X⁴]²`, the weight of the tails of the sample variance.
    pub eighth_moment_ratio: Option<f64>,
    /// Unit of all values of the channel, `exp(−log_unit)`; `None` for plain units.
    pub log_unit: Option<f64>,
}

/// A z-score of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Score {
    /// Deviation of the mean.
    #[serde(rename = "z_mean")]
    Mean,
    /// Deviation of the variance.
    #[serde(rename = "z_variance")]
    Variance,
    /// Deviation of the lookups.
    #[serde(rename = "z_lookups")]
    Lookups,
}

impl Score {
    /// All scores.
    pub const ALL: [Self; 3] = [Self::Mean, Self::Variance, Self::Lookups];

    /// Returns the check of the quantity.
    pub fn check(self) -> CheckId {
        match self {
            Self::Mean => CheckId::Mean,
            Self::Variance => CheckId::Variance,
            Self::Lookups => CheckId::Lookups,
        }
    }

    /// Returns the name of the quantity.
    pub fn quantity(self) -> &'static str {
        self.check().name()
    }

    /// Returns the name of its column in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Mean => "z_mean",
            Self::Variance => "z_variance",
            Self::Lookups => "z_lookups",
        }
    }
}

/// Finding of one check about one experiment.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Finding {
    /// The check.
    pub check: CheckId,
    /// The quantity, as in `the mean`.
    pub what: String,
    /// True if the case declares a bias that the check must show.
    pub expects_bias: bool,
    /// The channel; empty for the experiment as a whole, or if its channel has no name.
    pub channel: String,
    /// The statistic, in standard deviations, if the check has one.
    pub z: Option<f64>,
    /// The result of the check; a finding dereferences to it.
    #[serde(flatten)]
    pub result: CheckResult,
}

impl Deref for Finding {
    type Target = CheckResult;

    fn deref(&self) -> &CheckResult {
        &self.result
    }
}

impl DerefMut for Finding {
    fn deref_mut(&mut self) -> &mut CheckResult {
        &mut self.result
    }
}

impl Finding {
    /// Returns ln E of the gate; evidence beyond all numbers is infinite.
    pub fn evidence(&self) -> Option<f64> {
        let ln_e = self.gate?.ln_e;
        Some(if ln_e.is_finite() { ln_e } else { f64::INFINITY })
    }

    /// Returns whether it concerns a channel, or the experiment as a whole.
    pub fn is_about(&self, channel: &str) -> bool {
        self.channel.is_empty() || self.channel == channel
    }
}

impl ExperimentRecord {
    /// Returns the constant sampling extinction, 1/length; `None` if σ̂ varies or is not used.
    pub fn sampling(&self) -> Option<f64> {
        self.id.sampling.constant.map(|value| value.0)
    }

    /// Returns the value of the swept quantity; `None` for experiments outside the sweep.
    pub fn swept(&self) -> Option<f64> {
        self.id.swept_value()
    }

    /// Returns the findings about a channel, and about the experiment as a whole.
    pub fn findings_about(&self, channel: &str) -> impl Iterator<Item = &Finding> {
        let mut about: Vec<&Finding> = self.findings.iter().collect();
        about.retain(|finding| finding.is_about(channel));
        about.into_iter()
    }

    /// Returns the label of the experiment that is the same by definition; empty for none.
    pub fn same_as(&self) -> String {
        self.same_as.as_ref().map_or(String::new(), ExperimentId::label)
    }
}

impl ChannelRecord {
    /// Returns `log₁₀ LTUV`. LTUV = V · lookups of a draw with its share of the setup lookups is the lookups to unit
    /// variance of Miller et al. 2019, section 6, the reciprocal of the figure of merit.
    pub fn log10_ltuv(&self) -> Option<f64> {
        self.fom.map(|fom| -fom.log10())
    }

    /// Returns whether a plan foresees this verdict.
    pub fn foresees(&self, verdict: Verdict) -> bool {
        self.foreseen.as_ref().is_some_and(|foreseen| foreseen.verdict == verdict)
    }

    /// Returns the constant σ̂ with the largest predicted figure of merit, 1/length; `None` if it was not searched.
    pub fn best_sampling(&self) -> Option<f64> {
        self.best.as_ref().map(|best| best.sampling)
    }

    /// Returns the figure of merit at the best σ̂; `None` if it is infinite.
    pub fn best_fom(&self) -> Option<f64> {
        self.best.as_ref().and_then(|best| best.fom)
    }

    /// Returns the limit of the figure of merit, if it rises with σ̂ to one.
    pub fn best_limit(&self) -> Option<f64> {
        self.best.as_ref().and_then(|best| best.limit)
    }

    /// Returns the predicted `log₁₀ LTUV`.
    pub fn predicted_log10_ltuv(&self) -> Option<f64> {
        self.predicted_fom.map(|fom| -fom.log10())
    }
}
