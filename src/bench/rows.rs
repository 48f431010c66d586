//! Turns times and draws into rows.

use std::collections::BTreeMap;

use super::TimedExperiment;
use super::clock::Lap;
use super::curve::{BenchDraws, ChannelSample};
use super::record::{BenchRow, CurvePoint, ERRORS, Spread, Times, efficiency, time_to};
use crate::plan::PlannedExperiment;
use estimators::Knowledge;
use theory::Channel;
use theory::prediction::CERTAIN;

/// Reason if a round took no time that the clock could measure.
const TOO_SHORT: &str = "a round is shorter than the clock can tell; give more --draws";

/// Returns a figure over the rounds of one experiment; `None` where the clock was too coarse for one of them.
fn spread(laps: &[Lap], figure: impl Fn(&Lap) -> f64) -> Option<Spread> {
    let figures: Vec<f64> = laps.iter().map(figure).collect();
    let is_told = figures.iter().all(|x| x.is_finite() && *x > 0.0);
    Spread::of(figures).filter(|_| is_told)
}

fn named(planned: &PlannedExperiment) -> BenchRow {
    let (id, needs) = (planned.id.clone(), Knowledge::list(&planned.needs));
    BenchRow { id, listed: planned.estimator, needs, ..BenchRow::default() }
}

/// Returns the rows of an experiment, one per channel, or one row that says why it cannot be drawn.
pub fn of(TimedExperiment { planned, laps, sample, .. }: &TimedExperiment) -> Vec<BenchRow> {
    let ready = match &planned.outcome {
        Ok(ready) => ready,
        Err(refusal) => {
            let row = BenchRow { is_refused: true, is_first: true, ..named(planned) };
            return vec![BenchRow { reason: refusal.to_string(), ..row }];
        }
    };
    let observed = sample.lookups.moments().map(|moments| moments.mean);
    let predicted_lookups = ready.prediction.lookups.as_ref().map(|distribution| distribution.mean);
    let lookups = predicted_lookups.or(observed);
    let cost = lookups.map(|n| n + ready.prediction.shared_setup(planned.draws_per_ray));
    let both = ready.prediction.channels.iter().zip(&sample.channels).enumerate();
    let rows = both.map(|(index, (channel, drawn))| {
        let truth = channel.truth.value;
        let moments = drawn.tally.moments();
        let variance = moments.and_then(|m| m.variance).map(|v| v * truth * truth);
        let variance = variance.filter(|v| v.is_finite());
        let (known, reason) = known_variance(channel, variance, planned.expect_biased);
        let curve = match channel.moments {
            // The rest of the error is rounding and does not fall; a bias is larger than that.
            Some(m) if m.relative[0] <= CERTAIN && !planned.expect_biased => Vec::new(),
            _ => curve(sample, drawn, (truth, known), cost),
        };
        let times = times(laps, (truth, known), lookups);
        let reason = if times.is_some() { reason } else { TOO_SHORT.to_owned() };
        BenchRow {
            is_first: index == 0,
            channel: channel.name.clone(),
            draws: Some(drawn.tally.draws),
            mean: moments.map(|m| truth + m.mean * truth).filter(|mean| mean.is_finite()),
            truth: Some(truth),
            variance,
            predicted_variance: channel.moments.map(|m| m.variance()).filter(|v| v.is_finite()),
            lookups_per_draw: observed,
            predicted_lookups,
            setup_lookups: Some(ready.prediction.setup_lookups),
            fom: known.zip(cost).and_then(|(v, n)| efficiency(v, n)),
            reason,
            times,
            curve,
            ..named(planned)
        }
    });
    rows.collect()
}

/// Returns the variance that determines the error, or the reason why it has none.
fn known_variance(
    channel: &Channel,
    sample: Option<f64>,
    expect_biased: bool,
) -> (Option<f64>, String) {
    let none = |reason: &str| (None, reason.to_owned());
    if expect_biased {
        return none("declared biased: its error does not fall to 0, so no time leads to it");
    }
    let (unit, predicted) = (channel.truth.value, channel.moments.map(|m| m.variance()));
    match predicted.or(sample) {
        Some(v) if v <= CERTAIN * unit * unit => match predicted {
            Some(_) => {
                none("no variance: each draw is the answer, and there is no error to wait for")
            }
            None => none("all draws are the same and theory has no variance: no time to an error"),
        },
        Some(v) if v.is_finite() => (Some(v), String::new()),
        Some(_) => none("the variance in theory is beyond measure: no time to an error"),
        None => none("neither theory nor the draws have a variance: no time to an error"),
    }
}

fn curve(
    sample: &BenchDraws,
    drawn: &ChannelSample,
    (truth, variance): (f64, Option<f64>),
    lookups: Option<f64>,
) -> Vec<CurvePoint> {
    let looks = sample.looks.iter().enumerate();
    let point = |(look, &draws): (usize, &u64)| {
        let error = drawn.error(look)?;
        let n = draws as f64;
        Some(CurvePoint {
            draws,
            lookups: n * lookups?,
            error: error.typical * truth,
            relative: error.typical,
            least: error.least,
            most: error.most,
            predicted: variance.map(|v| (v / n).sqrt() / truth),
        })
    };
    looks.filter_map(point).collect()
}

fn times(
    laps: &[Lap],
    (truth, variance): (f64, Option<f64>),
    lookups: Option<f64>,
) -> Option<Times> {
    let draw = spread(laps, |lap| lap.together.unwrap_or(lap.single))?;
    let plain = spread(laps, |lap| lap.plain)?;
    let together = laps.first().is_some_and(|lap| lap.together.is_some());
    let scaling = spread(laps, |lap| lap.single / lap.together.unwrap_or(lap.single));
    Some(Times {
        ns_per_draw: draw.times(1e9),
        plain_ns_per_draw: plain.times(1e9),
        speedup: spread(laps, |lap| lap.plain / lap.single)?,
        scaling: scaling.filter(|_| together),
        draws_per_second: 1.0 / draw.median,
        ns_per_lookup: lookups.filter(|&n| n > 0.0).map(|n| draw.median * 1e9 / n),
        seconds_to: variance.map(|v| ERRORS.map(|error| time_to(error, v, truth, draw.median))),
        efficiency: variance.and_then(|v| efficiency(v, draw.median)),
    })
}

/// Chooses the rows of a plot: for each estimator of a case the last channel of the sweep point with the largest figure
/// of merit.
pub fn choose(rows: &mut [BenchRow]) {
    let merit = |row: &BenchRow| row.fom.unwrap_or(0.0);
    let mut best: BTreeMap<usize, usize> = BTreeMap::new();
    for (at, row) in rows.iter().enumerate() {
        let is_last = rows.get(at + 1).is_none_or(|next| next.is_first);
        let is_better = |&other: &usize| merit(row) > merit(&rows[other]);
        if is_last && !row.curve.is_empty() && best.get(&row.listed).is_none_or(is_better) {
            best.insert(row.listed, at);
        }
    }
    for at in best.into_values() {
        rows[at].is_shown = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(draws: u64) -> CurvePoint {
        CurvePoint {
            draws,
            lookups: draws as f64,
            error: 0.1,
            relative: 0.1,
            least: 0.1,
            most: 0.1,
            predicted: None,
        }
    }

    fn row(listed: usize, channel: &str, fom: f64) -> BenchRow {
        BenchRow {
            is_first: channel.is_empty() || channel == "T(1)",
            listed,
            channel: channel.to_owned(),
            fom: Some(fom),
            curve: vec![point(64)],
            ..BenchRow::default()
        }
    }

    #[test]
    fn a_plot_shows_the_best_of_a_sweep_and_the_last_of_a_curve() {
        let mut rows = vec![
            row(0, "", 2.0),
            row(0, "", 3.0),
            row(0, "", 1.0),
            row(1, "", 0.0),
            row(2, "T(1)", 9.0),
            row(2, "T(2)", 5.0),
            row(2, "T(3)", 1.0),
            row(3, "T(1)", 9.0),
        ];
        choose(&mut rows);
        let shown: Vec<usize> = (0..rows.len()).filter(|&i| rows[i].is_shown).collect();
        assert_eq!(shown, [1, 3, 6, 7]);
    }

    #[test]
    fn figures_agree_with_each_other() {
        let lap = |single| Lap { single, together: None, plain: 6e-8 };
        let laps = [lap(2e-8), lap(1e-8), lap(3e-8)];
        let (truth, variance, lookups) = (0.5, 0.02, 4.0);
        let times = times(&laps, (truth, Some(variance)), Some(lookups));
        let times = times.expect("rounds");
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
        near(times.ns_per_draw.median, 20.0);
        near(times.draws_per_second, 5e7);
        near(times.ns_per_lookup.expect("lookups"), 5.0);
        near(times.speedup.median, 3.0);
        near(times.speedup.least, 2.0);
        near(times.speedup.most, 6.0);
        near(times.efficiency.expect("a variance"), 1.0 / (variance * 2e-8));
        for (seconds, error) in times.seconds_to.expect("a variance").iter().zip(ERRORS) {
            // After that time the standard error equals the requested error.
            let draws = seconds * times.draws_per_second;
            near((variance / draws).sqrt() / truth, error);
        }
        near(times.seconds(100), 2e-6);
        assert_eq!(times.scaling, None);
    }

    #[test]
    fn a_clock_that_stands_still_tells_nothing() {
        let lap = |single| Lap { single, together: None, plain: 6e-8 };
        let laps = [lap(2e-8), lap(0.0)];
        assert_eq!(times(&laps, (0.5, Some(0.1)), Some(1.0)), None);
    }
}
