//! The theory's lines along a sweep, the best constant σ̂ of each estimator, and rays seen from the side.

use crate::case::Case;
use crate::case::names::Names;
use crate::case::sweep::{SweepAxis, Variation, What};
use crate::draw::drawn::Drawn;
use crate::plan::{Planned, PlannedCase};
use crate::record::theory::finite;
use crate::record::{Anatomy, Best, Curve, CurvePoint, MeasuredPoint, Sweep};
use ::theory::Channel;
use ::theory::optimum::{Optimum, best_constants};
use ::theory::parallel;

/// Points of a line.
const POINTS: usize = 48;

/// The lines of a case; none without a sweep. Each takes fifty predictions.
pub fn curves(case: &Case, seed: u64) -> Vec<Curve> {
    let Some(axis) = &case.sweep else { return Vec::new() };
    let swept = (0..case.scenario.estimators()).filter(|&i| case.scenario.depends_on(i, axis.what));
    let swept: Vec<usize> = swept.collect();
    let x = abscissae(axis);
    let (low, high) = ends(&x);
    let curves: Vec<Vec<Curve>> = parallel::map(&swept, |&estimator| {
        let predicted: Vec<Vec<(String, Option<CurvePoint>)>> =
            parallel::map(&x, |&x| points(case, seed, estimator, Some((axis.what, x)), x));
        let names = case.names(estimator, axis.values.first().map(|&x| (axis.what, x)));
        let is_sought = axis.what == What::Sampling;
        let best = is_sought.then(|| best(case, seed, estimator, None));
        let found = |channel: usize| best.as_ref()?.get(channel).copied().flatten();
        let optimum = |channel: usize| {
            let at = found(channel)?.sampling;
            let mut points = (low..=high)
                .contains(&at)
                .then(|| points(case, seed, estimator, Some((What::Sampling, at)), at))?;
            (channel < points.len()).then(|| points.swap_remove(channel).1)?
        };
        let named = predicted.iter().max_by_key(|channels| channels.len());
        let named = named.map_or(&[][..], Vec::as_slice);
        let curve = |(index, (channel, _)): (usize, &(String, Option<CurvePoint>))| Curve {
            estimator: names.estimator.to_string(),
            control: names.control.clone(),
            channel: channel.clone(),
            points: predicted.iter().filter_map(|p| p.get(index)?.1).collect(),
            listed: estimator,
            optimum: optimum(index),
            best: found(index).map(named_best),
        };
        let curves: Vec<Curve> = named.iter().enumerate().map(curve).collect();
        if curves.is_empty() { vec![refused(names, estimator)] } else { curves }
    });
    curves.into_iter().flatten().collect()
}

/// What a case sweeps, without lines.
pub fn axis(case: &Case) -> Option<Sweep> {
    let axis = case.sweep.as_ref()?;
    let (what, title) = (axis.what.key().to_owned(), axis.what.axis().to_owned());
    Some(Sweep { what, axis: title, log: axis.log, z_limit: None, curves: Vec::new() })
}

/// The best constant σ̂ of each experiment of a case, channel by channel; empty for those that take none, or
/// are refused at every σ̂.
pub fn best_of_each(case: &PlannedCase, seed: u64) -> Vec<Vec<Option<Optimum>>> {
    // Experiments that differ in nothing but σ̂ have the same.
    let asked = |planned: &Planned| {
        let is_of_sampling =
            |(what, _): &(What, f64)| matches!(what, What::Sampling | What::SamplingScale);
        (planned.estimator, planned.variation.filter(|variation| !is_of_sampling(variation)))
    };
    let mut questions: Vec<_> = case.experiments.iter().map(asked).collect();
    questions.dedup();
    let found = parallel::map(&questions, |&(estimator, variation)| {
        best(case.case, seed, estimator, variation)
    });
    let answer = |planned: &Planned| {
        let place = questions.iter().position(|question| *question == asked(planned));
        place.map(|place| found[place].clone()).unwrap_or_default()
    };
    case.experiments.iter().map(answer).collect()
}

/// The best constant σ̂ of one experiment, channel by channel.
fn best(case: &Case, seed: u64, estimator: usize, variation: Variation) -> Vec<Option<Optimum>> {
    if !case.scenario.depends_on(estimator, What::SamplingScale) {
        return Vec::new();
    }
    let pilots = case.pilots(seed, estimator);
    let at = case.at(variation);
    let scale = at.as_ref().map_or(0.0, |at| at.natural_scale(estimator));
    best_constants(scale, case.draws_per_ray, |sampling| {
        at.as_ref().ok()?.predict(estimator, Some(sampling), pilots)
    })
}

/// The line of an estimator that is refused everywhere: it has no points.
fn refused(names: Names, listed: usize) -> Curve {
    let (estimator, control) = (names.estimator.to_string(), names.control);
    let (channel, points) = (String::new(), Vec::new());
    Curve { estimator, listed, control, channel, points, optimum: None, best: None }
}

/// The best σ̂ as a record has it.
pub fn named_best(optimum: Optimum) -> Best {
    let Optimum { sampling, figure_of_merit, kind } = optimum;
    let (fom, limit) = (finite(Some(figure_of_merit)), kind.limit());
    Best { sampling, fom, kind: kind.words().to_owned(), limit }
}

/// The channels with their points; nothing where the estimator is refused.
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
    let lookups = prediction.lookups.as_ref().map(|law| law.mean);
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

/// The values at which lines are computed: the sweep's own, and more between them.
fn abscissae(axis: &SweepAxis) -> Vec<f64> {
    let (low, high) = ends(&axis.values);
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

/// The least and the largest of some numbers.
fn ends(x: &[f64]) -> (f64, f64) {
    x.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)))
}

/// The anatomy of an experiment on a curve; `None` of any other.
pub fn anatomy(case: &PlannedCase, planned: &Planned, drawn: &Drawn) -> Option<Anatomy> {
    let ready = planned.outcome.as_ref().ok()?;
    let at = case.case.at(planned.variation).ok()?;
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
