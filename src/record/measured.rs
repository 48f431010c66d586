//! What the fixed draws of an experiment say, in the rows of a record.

use crate::checks::normality::{Tails, needed};
use crate::draw::drawn::Drawn;
use crate::record::Row;
use crate::record::theory_rows::finite;
use gate::stats::Tally;
use theory::prediction::CERTAIN;
use theory::{Channel, Prediction};

/// Mean and variance of the fixed draws, and their z-scores.
pub fn measure(row: &mut Row, channel: &Channel, tally: &Tally) {
    let n = tally.draws as f64;
    let unit = channel.truth.value;
    let moments = tally.moments();
    row.draws = Some(tally.draws);
    row.mean = finite(moments.map(|m| channel.mean.value + m.mean * unit));
    row.variance = finite(moments.and_then(|m| m.variance).map(|v| v * unit * unit));
    row.standard_error = row.variance.map(|v| (v / n).sqrt());
    let predicted = channel.resolved_moments().filter(|m| m.relative[0] > CERTAIN);
    let Some(predicted) = predicted else { return };
    row.variance_deviation = finite(
        predicted.spread_of_sample_variance(n).map(|s| s.max(0.0).sqrt() * predicted.variance()),
    );
    let spread = (predicted.variance() / n).sqrt();
    row.z_mean = finite(row.mean.map(|mean| (mean - channel.truth.value) / spread));
    let testable = |kurtosis: &f64| *kurtosis > 1.0 + 1e-6 && kurtosis.is_finite();
    let kurtosis = predicted.kurtosis().filter(testable);
    let square = tally.mean_square().map(|square| square * unit * unit / predicted.variance());
    row.z_variance = finite(
        square
            .zip(kurtosis)
            .map(|(square, kurtosis)| (square - 1.0) / ((kurtosis - 1.0) / n).sqrt()),
    );
}

/// Mean lookups of the fixed draws, their z-score, and the figure of merit.
pub fn measure_lookups(row: &mut Row, prediction: &Prediction, drawn: &Drawn, draws_per_ray: u64) {
    let n = drawn.lookups.draws as f64;
    let law = prediction.lookups.as_ref();
    let observed = drawn.lookups.moments().map(|m| m.mean);
    row.lookups_per_draw = observed.map(|mean| mean + law.map_or(0.0, |law| law.mean));
    if let Some(law) = law.filter(|law| law.variance > 0.0) {
        let deviation = (law.variance / n).sqrt();
        row.lookups_deviation = Some(deviation);
        row.z_lookups = observed.map(|mean| mean / deviation);
    }
    let setup = prediction.shared_setup(draws_per_ray);
    let fom = row.variance.zip(row.lookups_per_draw).map(|(v, m)| 1.0 / (v * (m + setup)));
    row.fom = finite(fom.filter(|_| row.z_mean.is_some()));
}

/// The columns of z in a row that are not to be read as normal; the lookups are of so many draws.
pub fn not_normal(row: &Row, prediction: &Prediction, looked: u64) -> Vec<&'static str> {
    let n = row.draws.unwrap_or(0) as f64;
    let tails = Tails {
        kurtosis: row.predicted_kurtosis,
        eighth_moment_ratio: row.eighth_moment_ratio,
        rare_event_size: row.rare_event_size,
    };
    let of_lookups = prediction.lookups.as_ref().map(|law| needed(law.kurtosis, 1.0));
    let is_normal = of_lookups.is_some_and(|needed| looked as f64 >= needed);
    let all = [
        ("z_mean", row.z_mean, tails.has_normal_mean(n)),
        ("z_variance", row.z_variance, tails.has_normal_variance(n)),
        ("z_lookups", row.z_lookups, is_normal),
    ];
    all.into_iter().filter(|(_, z, is)| z.is_some() && !is).map(|(name, ..)| name).collect()
}
