//! `judgement.json`: the judgement of a stack of images, for machines.

use serde::Serialize;

use crate::json;
use crate::judge::images::Judgement;
use crate::judge::images::judgement::{Counts, Tile};
use crate::report::ReportError;
use crate::report::fields::{Cell, NamedPairs, Table, objects};

/// The judgement, with tiles by the columns of `tiles.csv`.
#[derive(Serialize)]
struct Document<'a> {
    #[serde(flatten)]
    judgement: &'a Judgement,
    whole: Vec<NamedPairs<Cell>>,
    counts: Counts,
    worst: Vec<NamedPairs<Cell>>,
}

/// Returns the judgement as a JSON object. An unknown number is `null`, and so is an object without content.
pub fn json(judgement: &Judgement) -> Result<String, ReportError> {
    let columns = <&Tile>::of_files();
    let document = Document {
        judgement,
        whole: objects(&columns, &judgement.whole),
        counts: judgement.counts,
        worst: objects(&columns, &judgement.worst),
    };
    Ok(json::pretty(&document)? + "\n")
}

/// Fields of the object and their meanings, for the manual; `order.lag` is `lag` in the object `order`.
#[rustfmt::skip] // a line for each field
pub const MEANINGS: &[(&str, &str)] = &[
    ("verdict", "Result: pass, fail or inconclusive"),
    ("reason", "Reason of the verdict; empty for a plain pass"),
    ("guarantees", "Promises of the verdict, and their assumptions"),
    ("alpha", "Probability that correct passes fail"),
    ("beta", "Probability that a tile, or the whole, passes although it is off by its tolerance"),
    ("listed_rate", "Bound on the expected share of false entries on the list of suspects"),
    ("passes", "Number of passes"),
    ("size.rows", "Height of a pass in pixels"),
    ("size.columns", "Width of a pass in pixels"),
    ("size.channels", "Number of values of a pixel"),
    ("tile", "Rows and columns of the smallest tiles"),
    ("refuted_by.pass", "Pass of the first value that refutes the claim by itself; this and all places count from 0"),
    ("refuted_by.row", "Its row"),
    ("refuted_by.column", "Its column"),
    ("refuted_by.channel", "Its channel"),
    ("refuted_by.value", "The value"),
    ("refuting", "Number of such values"),
    ("order.reason", "Dependence of the passes on each other; empty if none was found"),
    ("order.evidence", "ln 1/p against independent passes"),
    ("order.limit", "Limit of that evidence"),
    ("order.correlation", "Strongest correlation of passes"),
    ("order.lag", "Number of passes between them"),
    ("order.is_tested", "Whether the passes suffice for the test"),
    ("neighbours.reason", "Dependence of the pixels of a pass on each other; empty if none was found"),
    ("neighbours.evidence", "ln E against independent pixels"),
    ("neighbours.limit", "Limit of that evidence"),
    ("neighbours.correlation", "Correlation of adjacent pixels"),
    ("neighbours.is_tested", "Whether there are pixels to test"),
    ("repeated", "Passes that share values"),
    ("variance.about_truth", "Mean of (x − truth)²/V over all pixels"),
    ("variance.about_mean", "Mean of s²/V"),
    ("variance.margin", "Largest mean of s²/V with which a picture passes"),
    ("variance.ln_e", "Evidence against a variance of at most V"),
    ("variance.limit", "Limit of that evidence"),
    ("variance.is_refuted", "Whether the variance is refuted"),
    ("estimate.passes", "Number of passes that the variance was estimated from"),
    ("estimate.kurtosis", "Kurtosis of the smallest tiles that the evidence relies on"),
    ("estimate.is_given", "Whether the kurtosis was given"),
    ("estimate.negative", "Number of negative variances, which count as 0"),
    ("estimate.unknown", "Number of variances that are no numbers: their values are not judged"),
    ("estimate.first_row", "Row of the first of either"),
    ("estimate.first_column", "Its column"),
    ("estimate.first_channel", "Its channel"),
    ("truth_passes", "Number of passes that the truth is the mean of; null for an exact truth"),
    ("comparison.passes", "Number of passes of the reference"),
    ("comparison.method", "Test of equal distributions: permutation, signs or none"),
    ("comparison.permutations", "Number of random permutations"),
    ("comparison.p", "Smallest p-value of all tiles and the whole together, for equal distributions"),
    ("comparison.is_same_distribution", "Whether equal distributions are claimed"),
    ("comparison.spread", "Variance over that of the reference"),
    ("comparison.spread_p", "p-value of that ratio for equal distributions"),
    ("comparison.kurtosis", "Largest kurtosis of the smallest tiles, as measured"),
    ("whole", "Whole picture, an entry per channel, with the columns of `tiles.csv`"),
    ("counts.tiles", "Number of all tiles, in each channel"),
    ("counts.pass", "Number that pass"),
    ("counts.fail", "Number that fail, by Holm"),
    ("counts.listed", "Number on the list of suspects, by e-BH"),
    ("worst", "Tiles with the most evidence against them, with the columns of `tiles.csv`"),
];

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;
    use crate::judge::images::judgement::{
        ComparisonMethod, Refuted, StackComparison, Variance, VarianceEstimate,
    };
    use crate::judge::images::{Claim, ImageOptions, Level, Size, Stack, judge};

    /// Names of the fields of an object, in their order.
    fn names(within: &str, value: &Value) -> Vec<String> {
        let fields = value.as_object().into_iter().flatten();
        fields
            .flat_map(|(name, value)| match value {
                Value::Object(_) => names(&format!("{within}{name}."), value),
                _ => vec![format!("{within}{name}")],
            })
            .collect()
    }

    #[test]
    fn every_field_has_a_meaning() {
        let size = Size { rows: 1, columns: 2, channels: 1 };
        let stack = Stack::new(2, size, vec![0.0, 1.0, 1.0, 0.0]).expect("a stack");
        let claim = Claim::of_truth(Level::All(0.5));
        let judged = judge(&stack, &claim, &ImageOptions::default()).expect("a judgement");
        let judgement = Judgement {
            refuted_by: Some(Refuted { pass: 0, row: 0, column: 0, channel: 0, value: f64::NAN }),
            variance: Some(Variance {
                about_truth: 1.0,
                about_mean: 1.0,
                margin: 1.0,
                ln_e: 0.0,
                limit: 1.0,
                is_refuted: false,
                is_too_large: false,
            }),
            estimate: Some(VarianceEstimate {
                passes: 2,
                kurtosis: 3.0,
                is_given: false,
                negative: 0,
                unknown: 0,
                first: None,
            }),
            comparison: Some(StackComparison {
                passes: 2,
                method: ComparisonMethod::None,
                permutations: 0,
                p: 1.0,
                is_same_distribution: false,
                spread: None,
                spread_p: 1.0,
                kurtosis: None,
            }),
            ..judged
        };
        let written = json(&judgement).expect("JSON");
        let value = serde_json::from_str(&written).expect("JSON");
        let mut meanings: Vec<_> = MEANINGS.iter().map(|(name, _)| (*name).to_owned()).collect();
        let mut names = names("", &value);
        meanings.sort();
        names.sort();
        assert_eq!(names, meanings);
    }
}
