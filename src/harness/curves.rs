//! The theory's lines along a sweep, and the best constant σ̂ of each estimator.

use rayon::prelude::*;

use super::case::Case;
use super::plan::pilot_address;
use super::record::{Curve, CurvePoint, Sweep};
use super::scenario::{Names, Variation};
use super::sweep::{SweepAxis, What};
use crate::theory::Channel;
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
        .flat_map_iter(|&estimator| {
            let predicted: Vec<Vec<(String, Option<CurvePoint>)>> = x
                .par_iter()
                .map(|&x| points(case, seed, estimator, Some((axis.what, x)), x))
                .collect();
            let names =
                case.scenario.names(estimator, axis.values.first().map(|&x| (axis.what, x)));
            let inside = |best: &Optimum| {
                let ends = x.first().zip(x.last());
                ends.is_some_and(|(&low, &high)| (low..=high).contains(&best.sampling))
            };
            let optimum = best.get(estimator).copied().flatten().filter(inside).and_then(|best| {
                let at = best.sampling;
                points(case, seed, estimator, Some((What::Sampling, at)), at).pop()?.1
            });
            let named = predicted.iter().max_by_key(|channels| channels.len());
            let named = named.map_or(&[][..], Vec::as_slice);
            let curve = |(index, (channel, _)): (usize, &(String, Option<CurvePoint>))| Curve {
                estimator: names.estimator.clone(),
                control: names.control.clone(),
                channel: channel.clone(),
                points: predicted.iter().filter_map(|p| p.get(index)?.1).collect(),
                // The figure of merit is that of the last channel.
                optimum: optimum.filter(|_| index + 1 == named.len()),
            };
            let curves: Vec<Curve> = named.iter().enumerate().map(curve).collect();
            if curves.is_empty() { vec![refused(names)] } else { curves }
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
            let pilots = pilot_address(seed, case, estimator);
            best_constant(scenario.natural_scale(estimator, None), |sampling| {
                scenario.predict(estimator, Some((What::Sampling, sampling)), pilots)
            })
        })
        .collect()
}

/// The line of an estimator that is refused everywhere: it has no points.
fn refused(names: Names) -> Curve {
    let Names { estimator, control, .. } = names;
    Curve { estimator, control, channel: String::new(), points: Vec::new(), optimum: None }
}

/// The channels with their points; nothing where the estimator is refused.
fn points(
    case: &Case,
    seed: u64,
    estimator: usize,
    variation: Variation,
    x: f64,
) -> Vec<(String, Option<CurvePoint>)> {
    let pilots = pilot_address(seed, case, estimator);
    let Some(prediction) = case.scenario.predict(estimator, variation, pilots) else {
        return Vec::new();
    };
    let lookups = prediction.lookups.as_ref().map(|law| law.mean);
    let point = |channel: &Channel| {
        let (variance, lookups) = (channel.moments?.variance(), lookups?);
        let fom = 1.0 / (variance * lookups);
        let is_finite = variance.is_finite() && fom.is_finite();
        is_finite.then_some(CurvePoint { x, variance, lookups, fom })
    };
    let channels = prediction.channels.iter();
    channels.map(|channel| (channel.name.clone(), point(channel))).collect()
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
