//! What a record holds for plots: theory's lines along a sweep, a ray seen from the side, fields along the ray of
//! what is refused, and the way of ln E.

use serde::{Deserialize, Serialize};

use crate::plan::ExperimentId;
use theory::optimum::Kind;

/// The axis of a sweep and the theory's curves along it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Sweep {
    /// What is swept, by its key in case files, as `sampling` or `density`.
    pub what: String,
    /// The axis title with symbol and unit.
    pub axis: String,
    /// Whether the axis is logarithmic.
    pub log: bool,
    /// The z-score that is as rare as a false alarm of the gate.
    pub z_limit: Option<f64>,
    /// One curve per estimator and channel; none where nothing is drawn.
    pub curves: Vec<Curve>,
}

/// What theory says of one estimator along the sweep, one channel of its value.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Curve {
    /// The estimator's label at the first value of the sweep.
    pub estimator: String,
    /// The number of the estimator in the case's list: its experiments have the same.
    pub listed: usize,
    /// Its control in words at the first value of the sweep.
    pub control: String,
    /// The channel.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub channel: String,
    /// Points in ascending order; refused stretches are left out.
    pub points: Vec<CurvePoint>,
    /// Theory at the best constant σ̂, if that was searched and lies inside the sweep.
    pub optimum: Option<CurvePoint>,
    /// The best constant σ̂, inside the sweep or not; `None` where it was not searched.
    pub best: Option<Best>,
}

/// The constant σ̂ that a search for the largest figure of merit names.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Best {
    /// σ̂, 1/length.
    pub sampling: f64,
    /// The figure of merit there; `None` where it is infinite.
    pub fom: Option<f64>,
    /// Kind of this σ̂, in the words of a row's `best_kind`.
    pub kind: String,
    /// The limit of a figure of merit that rises with σ̂ to one.
    pub limit: Option<f64>,
}

impl Best {
    /// Whether the figure of merit is largest there.
    pub fn is_optimum(&self) -> bool {
        self.kind == Kind::Maximum.words()
    }
}

/// Theory at one value of the swept quantity.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct CurvePoint {
    /// The swept value.
    pub x: f64,
    /// The variance of one draw.
    pub variance: f64,
    /// The expected lookups.
    pub lookups: f64,
    /// 1/(variance · (lookups + setup lookups/draws per ray)).
    pub fom: f64,
    /// Lookups for a ray before its first draw.
    #[serde(default)]
    pub setup_lookups: u64,
}

/// A ray seen from the side, as in Figures 5 and 8 of Szirmay-Kalos et al. 2017.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Anatomy {
    /// The experiment that the curves belong to.
    pub experiment: ExperimentId,
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
    /// The standard deviation of one draw of it there; it may be infinite.
    #[serde(with = "gate::extended")]
    pub deviation: Vec<f64>,
    /// Where the control was fitted: (t, value).
    pub explorers: Vec<[f64; 2]>,
    /// The tentative collisions of the first walk: (t, σ_t).
    pub collisions: Vec<[f64; 2]>,
    /// T̂ of the first few walks at the distances `t`.
    pub walks: Vec<Vec<f64>>,
    /// Measured points: one for each channel with finite statistics.
    pub measured: Vec<MeasuredPoint>,
}

/// A measured point of the transmittance along a ray.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
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

/// σ_t, control and σ̂ along the ray of an experiment that is refused.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Course {
    /// Distances along the ray, ascending; not more than 100.
    #[serde(with = "gate::extended")]
    pub t: Vec<f64>,
    /// σ_t there, 1/length.
    #[serde(with = "gate::extended")]
    pub extinction: Vec<f64>,
    /// The control there, 1/length; empty for none, or where it cannot be made.
    #[serde(with = "gate::extended")]
    pub control: Vec<f64>,
    /// σ̂ there, 1/length; empty for none, or where it cannot be made.
    #[serde(with = "gate::extended")]
    pub sampling: Vec<f64>,
    /// Where the inequality does not hold; `None` where something else is refused.
    pub at: Option<f64>,
}

impl Course {
    /// Leaves out the places where a field has no finite value.
    #[must_use]
    pub fn finite(self) -> Self {
        let fields = [&self.t, &self.extinction, &self.control, &self.sampling];
        let is_finite =
            |i: &usize| fields.iter().all(|field| field.get(*i).is_none_or(|v| v.is_finite()));
        let kept: Vec<usize> = (0..self.t.len()).filter(is_finite).collect();
        let [t, extinction, control, sampling] =
            fields.map(|field| kept.iter().filter_map(|&i| field.get(i).copied()).collect());
        Self { t, extinction, control, sampling, at: self.at }
    }
}

/// More looks of the gate than this are thinned.
const LOOKS: usize = 64;

/// Draws and ln E at the looks, as a record has them: the first, the last, and those between them evenly. An infinite ln E
/// becomes the largest number.
pub fn thinned(path: &[(u64, f64)]) -> Vec<[f64; 2]> {
    let last = path.len().saturating_sub(1);
    let few = path.len().min(LOOKS);
    let kept = (0..few).map(|i| path[i * last / (few - 1).max(1)]);
    kept.map(|(draws, ln_e)| [draws as f64, rounded(ln_e)]).collect()
}

/// A number in steps of 0.001; an infinite one becomes the largest number.
fn rounded(ln_e: f64) -> f64 {
    ((ln_e * 1e3).round() / 1e3).clamp(f64::MIN, f64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_keeps_its_ends_and_its_order() {
        for looks in [0, 1, 2, 63, 64, 65, 200] {
            let path: Vec<(u64, f64)> = (0..looks).map(|i| (i * i, i as f64 / 8.0)).collect();
            let kept = thinned(&path);
            assert_eq!(kept.len(), path.len().min(LOOKS));
            assert!(kept.is_sorted_by(|a, b| a[0] < b[0]), "{kept:?}");
            let last = path.last().map(|&(draws, ln_e)| [draws as f64, ln_e]);
            assert_eq!(kept.last().copied(), last);
            assert_eq!(kept.is_empty(), path.is_empty());
        }
    }
}
