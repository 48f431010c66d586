//! Data for plots in a record: predicted curves along a sweep, the best constant σ̂ of each estimator, and rays seen
//! from the side.

use serde::{Deserialize, Serialize};

use crate::case::Case;
use crate::case::id::ExperimentId;
use crate::case::sweep::{SweepAxis, SweptQuantity, Variation};
use crate::draw::block::DrawnExperiment;
use crate::plan::{PlannedCase, PlannedExperiment};
use crate::record::theory::finite;
use ::theory::Channel;
use ::theory::parallel;
use ::theory::prediction::optimum::{Optimum, best_constants};
use ::theory::prediction::search::PlaceKind;

/// Axis of a sweep and the predicted curves along it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Sweep {
    /// The swept quantity.
    pub what: SweptQuantity,
    /// The axis title with symbol and unit.
    pub axis: String,
    /// True if the axis is logarithmic.
    pub log: bool,
    /// z-score with the two-sided probability of a false alarm of the gate.
    pub z_limit: Option<f64>,
    /// One curve per estimator and channel; none if nothing is drawn.
    pub curves: Vec<PredictedCurve>,
}

/// Predictions of one channel of an estimator along the sweep.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct PredictedCurve {
    /// The estimator's label at the first value of the sweep.
    pub estimator: String,
    /// Index of the estimator in the case's list, which its experiments share.
    pub listed: usize,
    /// Its control in words at the first value of the sweep.
    pub control: String,
    /// The channel.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub channel: String,
    /// Points in ascending order, without refused ones.
    pub points: Vec<CurvePoint>,
    /// Prediction at the best constant σ̂, if that was searched and lies inside the sweep.
    pub optimum: Option<CurvePoint>,
    /// Best constant σ̂, inside the sweep or not; `None` if it was not searched.
    pub best: Option<Best>,
}

/// Constant σ̂ that a search for the largest figure of merit returns.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Best {
    /// σ̂, 1/length.
    pub sampling: f64,
    /// The figure of merit there; `None` where it is infinite.
    pub fom: Option<f64>,
    /// Kind of this σ̂.
    pub kind: PlaceKind,
    /// Limit of the figure of merit, if it rises with σ̂ to one.
    pub limit: Option<f64>,
}

impl Best {
    /// Returns whether the figure of merit is largest there.
    pub fn is_optimum(&self) -> bool {
        self.kind == PlaceKind::Optimum
    }
}

/// Prediction at one value of the swept quantity.
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
    /// σ_t − σ_c there, 1/length.
    pub residual: Vec<f64>,
    /// σ̂ there, 1/length.
    pub sampling: Vec<f64>,
    /// The exact transmittance T(t) there.
    pub transmittance: Vec<f64>,
    /// Standard deviation of one draw of it there; it may be infinite.
    #[serde(with = "gate::extended")]
    pub deviation: Vec<f64>,
    /// Places where the control was fitted: (t, value).
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

/// Number of points of a curve.
const POINTS: usize = 48;

/// Returns the curves of a case; none without a sweep. Each takes fifty predictions.
pub fn curves(case: &Case, seed: u64) -> Vec<PredictedCurve> {
    let Some(axis) = &case.sweep else { return Vec::new() };
    let swept = (0..case.scenario.estimators()).filter(|&i| case.scenario.depends_on(i, axis.what));
    let swept: Vec<usize> = swept.collect();
    let x = abscissae(axis);
    let (low, high) = ends(&x);
    let curves: Vec<Vec<PredictedCurve>> = parallel::map(&swept, |&estimator| {
        let predicted: Vec<Vec<(String, Option<CurvePoint>)>> =
            parallel::map(&x, |&x| points(case, seed, estimator, Some((axis.what, x)), x));
        let id = case.id(estimator, axis.values.first().map(|&x| (axis.what, x)));
        let is_sought = axis.what == SweptQuantity::Sampling;
        let best = is_sought.then(|| best(case, seed, estimator, None));
        let finding = |channel: usize| best.as_ref()?.get(channel).copied().flatten();
        let optimum = |channel: usize| {
            let at = finding(channel)?.sampling;
            let mut points = (low..=high)
                .contains(&at)
                .then(|| points(case, seed, estimator, Some((SweptQuantity::Sampling, at)), at))?;
            (channel < points.len()).then(|| points.swap_remove(channel).1)?
        };
        let named = predicted.iter().max_by_key(|channels| channels.len());
        let named = named.map_or(&[][..], Vec::as_slice);
        let curve =
            |(index, (channel, _)): (usize, &(String, Option<CurvePoint>))| PredictedCurve {
                channel: channel.clone(),
                points: predicted.iter().filter_map(|p| p.get(index)?.1).collect(),
                optimum: optimum(index),
                best: finding(index).map(named_best),
                ..without_points(&id, estimator)
            };
        let curves: Vec<PredictedCurve> = named.iter().enumerate().map(curve).collect();
        if curves.is_empty() { vec![without_points(&id, estimator)] } else { curves }
    });
    curves.into_iter().flatten().collect()
}

/// Returns the sweep of a case, without curves.
pub fn axis(case: &Case) -> Option<Sweep> {
    let axis = case.sweep.as_ref()?;
    let (what, title) = (axis.what, axis.what.axis().to_owned());
    Some(Sweep { what, axis: title, log: axis.log, z_limit: None, curves: Vec::new() })
}

/// Returns the best constant σ̂ of each experiment of a case, channel by channel; empty for those that take none, or
/// are refused at every σ̂.
pub fn best_of_each<'p>(
    case: &'p PlannedCase,
    seed: u64,
) -> Vec<(&'p PlannedExperiment, Vec<Option<Optimum>>)> {
    // Experiments that differ in σ̂ only have the same best σ̂.
    let requested = |planned: &PlannedExperiment| {
        let is_of_sampling = |(what, _): &(SweptQuantity, f64)| {
            matches!(what, SweptQuantity::Sampling | SweptQuantity::SamplingScale)
        };
        (planned.estimator, planned.id.variation().filter(|variation| !is_of_sampling(variation)))
    };
    let mut questions: Vec<_> = case.experiments.iter().map(requested).collect();
    questions.dedup();
    let finding = parallel::map(&questions, |&(estimator, variation)| {
        ((estimator, variation), best(case.case, seed, estimator, variation))
    });
    let answer = |planned: &'p PlannedExperiment| {
        let answer = finding.iter().find(|(question, _)| *question == requested(planned));
        (planned, answer.map_or(Vec::new(), |(_, best)| best.clone()))
    };
    case.experiments.iter().map(answer).collect()
}

/// Returns the best constant σ̂ of one experiment, channel by channel.
fn best(case: &Case, seed: u64, estimator: usize, variation: Variation) -> Vec<Option<Optimum>> {
    if !case.scenario.depends_on(estimator, SweptQuantity::SamplingScale) {
        return Vec::new();
    }
    let pilots = case.pilots(seed, estimator);
    let at = case.at(variation);
    let scale = at.as_ref().map_or(0.0, |at| at.natural_scale(estimator));
    best_constants(scale, case.draws_per_ray, |sampling| {
        at.as_ref().ok()?.predict(estimator, Some(sampling), pilots)
    })
}

/// Returns the curve of an estimator without points, as if it is refused everywhere.
fn without_points(id: &ExperimentId, listed: usize) -> PredictedCurve {
    let (estimator, control) = (id.estimator.to_string(), id.control.clone());
    let (channel, points) = (String::new(), Vec::new());
    PredictedCurve { estimator, listed, control, channel, points, optimum: None, best: None }
}

/// Converts the best σ̂ for a record.
pub fn named_best(optimum: Optimum) -> Best {
    let Optimum { sampling, figure_of_merit, limit, kind } = optimum;
    let fom = finite(Some(figure_of_merit));
    Best { sampling, fom, kind, limit }
}

/// Returns the channels with their points; none if the estimator is refused.
fn points(
    case: &Case,
    seed: u64,
    estimator: usize,
    variation: Variation,
    x: f64,
) -> Vec<(String, Option<CurvePoint>)> {
    let pilots = case.pilots(seed, estimator);
    let at = case.at(variation).ok();
    let Some(prediction) = at.and_then(|at| at.predict(estimator, None, pilots)) else {
        return Vec::new();
    };
    let lookups = prediction.lookups.as_ref().map(|distribution| distribution.mean);
    let (cost, setup_lookups) = (prediction.cost(case.draws_per_ray), prediction.setup_lookups);
    let point = |channel: &Channel| {
        let (variance, lookups) = (channel.moments?.variance(), lookups?);
        let fom = 1.0 / (variance * cost?);
        let is_finite = variance.is_finite() && fom.is_finite();
        is_finite.then_some(CurvePoint { x, variance, lookups, fom, setup_lookups })
    };
    let channels = prediction.channels.iter();
    channels.map(|channel| (channel.name.clone(), point(channel))).collect()
}

/// Returns the values at which curves are computed: the sweep's own, and more between them.
fn abscissae(axis: &SweepAxis) -> Vec<f64> {
    let (low, high) = ends(&axis.values);
    let mut x = axis.values.clone();
    if axis.what != SweptQuantity::Points {
        x.extend((0..POINTS).map(|i| {
            let u = i as f64 / (POINTS - 1) as f64;
            if axis.log { low * (high / low).powf(u) } else { low + (high - low) * u }
        }));
    }
    x.sort_by(f64::total_cmp);
    x.dedup();
    x
}

/// Returns the minimum and the maximum of some numbers.
fn ends(x: &[f64]) -> (f64, f64) {
    x.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)))
}

/// Returns the anatomy of an experiment on a curve; `None` for any other.
pub fn anatomy(DrawnExperiment { case, planned, drawn }: &DrawnExperiment) -> Option<Anatomy> {
    let ready = planned.outcome.as_ref().ok()?;
    let at = case.case.at(planned.id.variation()).ok()?;
    let (ray_view, explorers) = at.ray_view(planned.estimator, planned.address)?;
    let distances = at.scenario().distances();
    let channels = ready.prediction.channels.iter().zip(&drawn.tallies).zip(&distances);
    let measured = channels.filter_map(|((channel, tally), &t)| {
        let moments = tally.moments()?;
        let unit = channel.truth.value;
        let deviation = moments.variance?.sqrt() * unit;
        let point = MeasuredPoint {
            t,
            mean: channel.mean.value + moments.mean * unit,
            standard_error: deviation / (tally.draws as f64).sqrt(),
            deviation,
        };
        (point.mean.is_finite() && deviation.is_finite()).then_some(point)
    });
    let residual = ray_view.extinction.iter().zip(&ray_view.control).map(|(s, c)| s - c).collect();
    let controlled = !planned.id.control.is_empty();
    Some(Anatomy {
        experiment: planned.id.clone(),
        measured: measured.collect(),
        residual,
        control: if controlled { ray_view.control } else { Vec::new() },
        explorers,
        t: ray_view.t,
        extinction: ray_view.extinction,
        sampling: ray_view.sampling,
        transmittance: ray_view.transmittance,
        deviation: ray_view.deviation,
        collisions: ray_view.collisions,
        walks: ray_view.walks,
    })
}
