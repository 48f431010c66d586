//! Under the null hypothesis z-scores are standard normal: their mean square lies in its own χ² band.
//!
//! Every case file is drawn with a fixed number of draws. A predicted variance that is too small makes all z-scores of
//! its kind large, long before a single one fails. One that is too large makes them small, which no single check would
//! detect.

use crate::common::{ALPHA, none, shipped_record};
use statrs::distribution::{ChiSquared, ContinuousCDF};
use trueflight::record::{Finding, Record, Row, Verdict};
use trueflight::stats::normal;

/// Probability outside the band, half of it on either side.
const OUTSIDE: f64 = 1e-3;

/// Returns the last row of each experiment that was drawn and is not declared biased: the channels of one walk are not
/// independent.
fn experiments(record: &Record) -> Vec<(&str, Row<'_>)> {
    let mut found = Vec::new();
    for case in &record.results.cases {
        for experiment in &case.experiments {
            let rows = case.rows().filter(|row| row.experiment.id == experiment.id);
            let Some(row) = rows.last() else { continue };
            // A declared bias is neither unbiased nor predicted.
            let biased = |finding: &Finding| finding.expects_bias;
            let drawn = row.verdict != Some(Verdict::Refused);
            if drawn && !row.findings().any(biased) {
                found.push((case.name.as_str(), row));
            }
        }
    }
    found
}

/// Returns whether the draws are enough for the kurtosis of a draw, so that z-scores are near their limit distribution.
fn adequate(row: &Row) -> bool {
    let draws = row.experiment.draws.unwrap_or(0) as f64;
    row.predicted_kurtosis.is_some_and(|kurtosis| draws >= 100.0 * kurtosis)
        && row.verdict != Some(Verdict::Underpowered)
}

/// Returns the fault of a family of z-scores, if it has one.
fn judge(kind: &str, scores: &[(String, f64)]) -> Vec<String> {
    assert!(scores.len() >= 50, "only {} z-scores of the {kind}", scores.len());
    let mut wrong = Vec::new();
    let limit = normal::two_sided(ALPHA / scores.len() as f64);
    for (name, z) in scores {
        if z.abs() > limit {
            wrong.push(format!("{kind} of {name}: z = {z:.2} beyond {limit:.2}"));
        }
    }
    let n = scores.len() as f64;
    let law = ChiSquared::new(n).expect("a law");
    let [low, high] = [0.5 * OUTSIDE, 1.0 - 0.5 * OUTSIDE].map(|p| law.inverse_cdf(p) / n);
    let square = scores.iter().map(|(_, z)| z * z).sum::<f64>() / n;
    let largest = scores.iter().fold(0.0f64, |most, (_, z)| most.max(z.abs()));
    println!("{n} {kind}: mean z² {square:.3} in [{low:.3}, {high:.3}], largest |z| {largest:.2}");
    if !(low..=high).contains(&square) {
        wrong.push(format!("{kind}: mean z² of {n} is {square:.3}, outside [{low:.3}, {high:.3}]"));
    }
    wrong
}

#[test]
fn z_scores_of_all_cases_have_mean_square_one() {
    let experiments = experiments(shipped_record());
    let scores = |z: fn(&Row) -> Option<f64>, wanted: fn(&Row) -> bool| {
        let rows = experiments.iter().filter(|(_, row)| wanted(row));
        let scores = rows.filter_map(|(case, row)| {
            let name = format!(
                "{case}, {} {} {:?}",
                row.experiment.label,
                row.experiment.id.control,
                row.experiment.swept()
            );
            z(row).map(|z| (name, z))
        });
        scores.collect::<Vec<_>>()
    };
    let mut wrong = judge("means", &scores(|row| row.z_mean, adequate));
    wrong.extend(judge("variances", &scores(|row| row.z_variance, adequate)));
    wrong.extend(judge("lookups", &scores(|row| row.experiment.z_lookups, |_| true)));
    none(&wrong);
}

#[test]
fn wrong_variances_and_a_single_outlier_are_seen() {
    let scores = |scale: f64| -> Vec<(String, f64)> {
        let quantile = |i: u32| normal::upper_quantile((f64::from(i) + 0.5) / 400.0);
        (0..400).map(|i| (String::new(), scale * quantile(i))).collect()
    };
    assert!(judge("scores", &scores(1.0)).is_empty());
    assert_eq!(judge("scores", &scores(1.15)).len(), 1, "variances 1.3 times as large");
    assert_eq!(judge("scores", &scores(0.85)).len(), 1, "variances 1.4 times too small");
    let mut outlier = scores(1.0);
    outlier[0].1 = 7.0;
    assert_eq!(judge("scores", &outlier).len(), 1, "one z-score of 7");
}
