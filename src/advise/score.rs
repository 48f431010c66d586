//! Variance and cost of a draw, means over the rays of a medium, and the value of them that is searched.

use super::Target;
use crate::case::Case;
use theory::Channel;
use theory::prediction::CERTAIN;
use theory::prediction::search::BEYOND;

/// Relative difference of a mean from the truth that is a bias.
const BIAS: f64 = 1e-9;

/// Variance and cost of a candidate at one setting, means over the rays.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CandidateScore {
    /// Variance of a draw relative to the squared mean transmittance.
    pub variance: f64,
    /// Relative variance times cost: the cost at a relative error of 1.
    pub work: f64,
    /// Relative variance times cost of each ray.
    pub works: Vec<f64>,
    /// Cost of a draw with its share of the setup.
    pub cost: f64,
    /// Expected lookups of a draw.
    pub lookups: f64,
    /// Setup lookups of a ray.
    pub setup_lookups: f64,
    /// Largest kurtosis of a draw on a ray; `None` where theory has none or the variance is 0.
    pub kurtosis: Option<f64>,
    /// True if theory only bounds the variance of some ray.
    pub is_bound: bool,
}

impl CandidateScore {
    /// Returns the relative standard deviation of a draw, root mean square over the rays.
    pub fn deviation(&self) -> f64 {
        self.variance.sqrt()
    }

    /// Returns the cost to an error, of one draw at least, or the squared error within a budget; beyond the budget, a value
    /// that cannot be taken and that rises with the cost.
    pub fn goal(&self, target: Target) -> f64 {
        match target {
            Target::Error(error) => (self.work / (error * error)).max(self.cost),
            Target::Budget(budget) if self.cost <= budget => self.work / budget,
            Target::Budget(budget) => BEYOND * (self.cost / budget),
        }
    }
}

/// Returns the variance of a channel relative to its squared mean, or a bound on it; `None` where theory has neither,
/// and of a biased estimator.
pub fn relative_variance(channel: &Channel) -> Option<f64> {
    let truth = channel.truth.value;
    let off = (channel.mean.value - truth).abs();
    if off > BIAS * truth.abs() + channel.mean.error + channel.truth.error {
        return None;
    }
    match channel.moments {
        Some(moments) if moments.relative[0] <= CERTAIN => Some(0.0),
        Some(_) => Some(channel.resolved_moments()?.variance() / (truth * truth)),
        None => Some(channel.variance_bound? / (truth * truth)),
    }
}

/// Returns `(T/T̄)²` of each ray; 1 for problems other than transmittance, and for a single ray.
pub fn weights(base: &Case, cases: &[Case]) -> Vec<f64> {
    let depth = |case: &Case| {
        let medium = &case.scenario.media()[0];
        medium.optical_depth(medium.support()).value
    };
    let all: Vec<f64> = cases.iter().map(|case| (-depth(case)).exp()).collect();
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    if base.problem != "transmittance" || cases.len() == 1 || mean == 0.0 {
        return vec![1.0; cases.len()];
    }
    all.into_iter().map(|t| (t / mean).powi(2)).collect()
}
