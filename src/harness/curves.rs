//! The theory's lines along a sweep, and the best constant σ̂ of each estimator.

use rayon::prelude::*;

use super::addresses;
use super::case::Case;
use super::record::{Curve, CurvePoint, Sweep};
use super::scenario::Variation;
use super::sweep::{SweepAxis, What};
use crate::theory::Prediction;
use crate::theory::optimum::{Optimum, best_constant};

/// Points of a line.
const POINTS: usize = 48;

/// The lines of a case with a sweep.
#[must_use]
pub fn sweep(case: &Case, seed: u64, z_limit: Option<f64>) -> Option<Sweep> {
    let axis = case.sweep.as_ref()?;
    let swept = (0..case.scenario.estimators()).filter(|&i| case.scenario.depends_on(i, axis.what));
    let swept: Vec<usize> = swept.collect();
    let best = if axis.what == What::Sampling { best_of_each(case, seed) } else { Vec::new() };
    let x = abscissae(axis);
    let curves = swept
        .par_iter()
        .map(|&estimator| {
            let points: Vec<CurvePoint> = x
                .par_iter()
                .filter_map(|&x| point(case, seed, estimator, Some((axis.what, x)), x))
                .collect();
            let names =
                case.scenario.names(estimator, axis.values.first().map(|&x| (axis.what, x)));
            let inside = |best: &Optimum| {
                let ends = x.first().zip(x.last());
                ends.is_some_and(|(&low, &high)| (low..=high).contains(&best.sampling))
            };
            let optimum = best.get(estimator).copied().flatten().filter(inside).and_then(|best| {
                let at = best.sampling;
                point(case, seed, estimator, Some((What::Sampling, at)), at)
            });
            Curve { estimator: names.estimator, control: names.control, points, optimum }
        })
        .collect();
    Some(Sweep {
        what: axis.what.key().to_owned(),
        axis: axis.what.axis().to_owned(),
        log: axis.log,
        z_limit,
        curves,
    })
}

/// The best constant σ̂ of each estimator; `None` for those that take none of the case's.
#[must_use]
pub fn best_of_each(case: &Case, seed: u64) -> Vec<Option<Optimum>> {
    let scenario = &case.scenario;
    (0..scenario.estimators())
        .into_par_iter()
        .map(|estimator| {
            if !scenario.depends_on(estimator, What::SamplingScale) {
                return None;
            }
            let pilots = addresses::pilots(seed, case, estimator);
            best_constant(scenario.natural_scale(estimator, None), |sampling| {
                scenario.predict(estimator, Some((What::Sampling, sampling)), pilots)
            })
        })
        .collect()
}

fn point(
    case: &Case,
    seed: u64,
    estimator: usize,
    variation: Variation,
    x: f64,
) -> Option<CurvePoint> {
    let prediction: Prediction =
        case.scenario.predict(estimator, variation, addresses::pilots(seed, case, estimator))?;
    let variance = prediction.channels.last()?.moments?.variance();
    let lookups = prediction.lookups.as_ref()?.mean;
    let fom = 1.0 / (variance * lookups);
    (variance.is_finite() && fom.is_finite()).then_some(CurvePoint { x, variance, lookups, fom })
}

/// The values at which lines are computed: the sweep's own, and more between them.
fn abscissae(axis: &SweepAxis) -> Vec<f64> {
    let (low, high) = axis
        .values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)));
    let mut x = axis.values.clone();
    if axis.what != What::Points {
        x.extend((0..POINTS).map(|i| {
            let u = i as f64 / (POINTS - 1) as f64;
            if axis.log { low * (high / low).powf(u) } else { low + (high - low) * u }
        }));
    }
    x.sort_by(f64::total_cmp);
    x.dedup();
    x
}
