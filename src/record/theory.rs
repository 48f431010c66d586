//! Predictions and statistics of an experiment, for a record.

use crate::draw::block::DrawnExperiment;
use crate::plan::{PlannedCase, PlannedExperiment};
use crate::record::{ChannelRecord, Course, ExperimentRecord, Score, Verdict};
use checks::normality::{Tails, needed};
use estimators::Refusal;
use gate::stats::Tally;
use theory::prediction::CERTAIN;
use theory::{Channel, CountDistribution, Prediction};

/// Maximum number of probabilities in the record; a longer list is left out.
const MAX_DISTRIBUTION: usize = 100;

/// Returns an experiment of a case with the predictions of each channel, or with the reason of its refusal.
pub fn predicted(case: &PlannedCase, planned: &PlannedExperiment) -> ExperimentRecord {
    let blank = ExperimentRecord {
        id: planned.id.clone(),
        label: planned.id.label(),
        listed: planned.estimator,
        needs: planned.needs.clone(),
        ..ExperimentRecord::default()
    };
    let ready = match &planned.outcome {
        Ok(ready) => ready,
        Err(refusal) => {
            let verdict = Some(Verdict::Refused);
            let channels = vec![ChannelRecord { verdict, ..ChannelRecord::default() }];
            let courses = courses(case, planned, refusal);
            let refusal = Some(refusal.clone());
            return ExperimentRecord { refusal, courses, channels, ..blank };
        }
    };
    let prediction = &ready.prediction;
    let distribution = prediction.lookups.as_ref();
    let shadow_lookups = prediction.shadow_lookups.filter(|_| distribution.is_some());
    let cost = prediction.cost(planned.draws_per_ray);
    let mut channels: Vec<ChannelRecord> =
        prediction.channels.iter().map(|channel| of_channel(channel, cost)).collect();
    for covariance in prediction.covariances.iter().filter(|c| c.pair[1] == c.pair[0] + 1) {
        channels[covariance.pair[0]].covariance = finite(Some(covariance.value));
    }
    let pmf = distribution
        .filter(|distribution| distribution.pmf.len() <= MAX_DISTRIBUTION)
        .map(|distribution| distribution.pmf.clone());
    ExperimentRecord {
        same_as: planned.same_as.clone(),
        skipped: Some(ready.experiment.skipped()).filter(|&share| share > 0.0),
        predicted_lookups: distribution.map(|distribution| distribution.mean),
        setup_lookups: Some(prediction.setup_lookups),
        stable_share: prediction.stable_share,
        lookups_variance: distribution.map(|distribution| distribution.variance),
        lookups_error: finite(
            distribution.map(|distribution| distribution.error.max(CountDistribution::ERROR)),
        ),
        lookups_grade: distribution.map(|distribution| distribution.grade),
        lookups_moments_error: finite(
            distribution
                .map(|distribution| distribution.moments_error.max(CountDistribution::ERROR)),
        ),
        walk_lookups: distribution
            .zip(shadow_lookups)
            .map(|(distribution, shadow)| distribution.mean - shadow),
        shadow_lookups,
        lookups_pmf: pmf.unwrap_or_default(),
        channels,
        ..blank
    }
}

/// Returns the predictions of a channel; `cost` is the number of lookups that a draw is charged with.
fn of_channel(channel: &Channel, cost: Option<f64>) -> ChannelRecord {
    let moments = channel.resolved_moments();
    let variance = moments.map(|moments| moments.variance());
    ChannelRecord {
        channel: channel.name.clone(),
        truth: Some(channel.truth.value),
        truth_error: Some(channel.truth.error),
        predicted_variance: finite(variance),
        predicted_skewness: finite(moments.and_then(|m| m.skewness())),
        predicted_kurtosis: finite(moments.and_then(|m| m.kurtosis())),
        predicted_fom: finite(variance.zip(cost).map(|(v, m)| 1.0 / (v * m))),
        losses: channel.losses,
        relative_moments: moments
            .map_or([None; 3], |moments| moments.relative.map(|m| finite(Some(m)))),
        moments_error: finite(channel.moments_error()),
        error_grade: channel.error_grade(),
        rare_event_size: finite(moments.map(|_| channel.tails.rare_event_size)),
        eighth_moment_ratio: finite(moments.map(|_| channel.tails.eighth_moment_ratio)),
        log_unit: Some(channel.log_unit).filter(|&unit| unit != 0.0),
        ..ChannelRecord::default()
    }
}

/// Returns the fields along the ray, which show where an inequality fails.
fn courses(case: &PlannedCase, planned: &PlannedExperiment, refusal: &Refusal) -> Vec<Course> {
    let place = match refusal {
        Refusal::Inequality { at, .. } => Some(*at),
        _ => None,
    };
    let at = case.case.at(planned.id.variation());
    at.map_or(Vec::new(), |at| at.courses(planned.estimator, planned.address, place))
}

/// Returns a number that files can hold; `None` for others.
pub fn finite(x: Option<f64>) -> Option<f64> {
    x.filter(|x| x.is_finite())
}

/// Adds statistics of the fixed draws: lookups, and for each channel mean and variance with their z-scores.
pub fn measure(
    record: &mut ExperimentRecord,
    DrawnExperiment { planned, drawn, .. }: &DrawnExperiment,
) {
    let Ok(ready) = &planned.outcome else { return };
    let prediction = &ready.prediction;
    let channels = prediction.channels.iter().zip(&drawn.tallies);
    record.draws = drawn.tallies.first().map(|tally| tally.draws);
    if record.draws.is_some() {
        measure_lookups(record, prediction, &drawn.lookups);
    }
    let setup = prediction.shared_setup(planned.draws_per_ray);
    let cost = record.lookups_per_draw.map(|lookups| lookups + setup);
    let of_lookups =
        prediction.lookups.as_ref().map(|distribution| needed(distribution.kurtosis, 1.0));
    let looked = drawn.lookups.draws as f64;
    let z_lookups = (record.z_lookups, of_lookups.is_some_and(|needed| looked >= needed));
    for (values, (channel, tally)) in record.channels.iter_mut().zip(channels) {
        measure_channel(values, channel, tally);
        let fom = values.variance.zip(cost).map(|(v, m)| 1.0 / (v * m));
        values.fom = finite(fom.filter(|_| values.z_mean.is_some()));
        values.not_normal = not_normal(values, tally.draws as f64, z_lookups);
    }
}

/// Adds the mean lookups of the fixed draws, and their z-score.
fn measure_lookups(record: &mut ExperimentRecord, prediction: &Prediction, lookups: &Tally) {
    let n = lookups.draws as f64;
    let distribution = prediction.lookups.as_ref();
    let observed = lookups.moments().map(|m| m.mean);
    record.lookups_per_draw =
        observed.map(|mean| mean + distribution.map_or(0.0, |distribution| distribution.mean));
    if let Some(distribution) = distribution.filter(|distribution| distribution.variance > 0.0) {
        let deviation = (distribution.variance / n).sqrt();
        record.lookups_deviation = Some(deviation);
        record.z_lookups =
            observed.filter(|_| distribution.is_sharp()).map(|mean| mean / deviation);
    }
}

/// Adds mean and variance of the fixed draws, and their z-scores.
fn measure_channel(values: &mut ChannelRecord, channel: &Channel, tally: &Tally) {
    let n = tally.draws as f64;
    let unit = channel.truth.value;
    let moments = tally.moments();
    values.mean = finite(moments.map(|m| channel.mean.value + m.mean * unit));
    values.variance = finite(moments.and_then(|m| m.variance).map(|v| v * unit * unit));
    values.standard_error = values.variance.map(|v| (v / n).sqrt());
    let predicted = channel.resolved_moments().filter(|m| m.relative[0] > CERTAIN);
    let Some(predicted) = predicted else { return };
    values.variance_deviation = finite(
        predicted.spread_of_sample_variance(n).map(|s| s.max(0.0).sqrt() * predicted.variance()),
    );
    let spread = (predicted.variance() / n).sqrt();
    values.z_mean = finite(values.mean.map(|mean| (mean - channel.truth.value) / spread));
    let testable = |kurtosis: &f64| *kurtosis > 1.0 + 1e-6 && kurtosis.is_finite();
    let kurtosis = predicted.kurtosis().filter(testable);
    let square = tally.mean_square().map(|square| square * unit * unit / predicted.variance());
    values.z_variance = finite(
        square
            .zip(kurtosis)
            .map(|(square, kurtosis)| (square - 1.0) / ((kurtosis - 1.0) / n).sqrt()),
    );
}

/// Returns the z-scores of a channel over `n` draws that are not to be read as normal. For lookups the caller says
/// whether they are normal.
fn not_normal(
    values: &ChannelRecord,
    n: f64,
    (z_lookups, is_normal): (Option<f64>, bool),
) -> Vec<Score> {
    let tails = Tails {
        kurtosis: values.predicted_kurtosis,
        eighth_moment_ratio: values.eighth_moment_ratio,
        rare_event_size: values.rare_event_size,
    };
    let all = [
        (Score::Mean, values.z_mean, tails.has_normal_mean(n)),
        (Score::Variance, values.z_variance, tails.has_normal_variance(n)),
        (Score::Lookups, z_lookups, is_normal),
    ];
    all.into_iter().filter(|(_, z, is)| z.is_some() && !is).map(|(score, ..)| score).collect()
}
