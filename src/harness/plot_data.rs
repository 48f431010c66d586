//! What a record holds for plots: theory's lines along a sweep, and a ray seen from the side.

use serde::Serialize;

/// The axis of a sweep and the theory's curves along it.
#[derive(Debug, Clone, Serialize)]
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
#[derive(Debug, Clone, Serialize)]
pub struct Curve {
    /// The estimator's label: the same as in its rows.
    pub estimator: String,
    /// Its control in words: the same as in its rows.
    pub control: String,
    /// The channel: the same as in its rows.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub channel: String,
    /// Points in ascending order; refused stretches are left out.
    pub points: Vec<CurvePoint>,
    /// Where the figure of merit is largest, if it has a maximum inside the sweep and was searched for it.
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
