//! Promises of verdicts on one stack and on two, and their assumptions.

use super::claim::Claim;
use super::judgement::{ComparisonMethod, Judgement, StackComparison};
use super::verdict::{self, has_variance};
use numeric::digits::short;

/// Returns the assumptions about a variance and a truth that are not exact.
fn estimated(judgement: &Judgement) -> Vec<String> {
    let mut said = Vec::new();
    if let Some(finding) = judgement.estimate {
        let (kurtosis, passes) = (short(finding.kurtosis, 3), finding.passes);
        said.push(if finding.is_given {
            format!(
                "the variance is an estimate of {passes} passes; its error is paid for: the levels hold if no tile has a \
                 kurtosis above {kurtosis}, as given"
            )
        } else {
            format!(
                "the variance is an estimate of {passes} passes; its error is paid for, at nominal levels: they assume that \
                 no tile has a larger kurtosis than these values show ({kurtosis} at most); a bound by --kurtosis K makes \
                 them hold"
            )
        });
        let (negative, unknown) = (finding.negative, finding.unknown);
        if let Some([row, column, channel]) = finding.first {
            let place =
                format!("row {row}, column {column}{}", verdict::channel(judgement, channel));
            said.push(format!(
                "{negative} variances are negative and count as 0, {unknown} are no numbers and their values are not \
                 judged; the first: {place}"
            ));
        }
    }
    if let Some(passes) = judgement.truth_passes {
        said.push(format!("the truth is the mean of {passes} passes, and has the error of that"));
    }
    said
}

/// Returns the promises of a verdict on one stack.
pub(super) fn guarantees(judgement: &Judgement, claim: &Claim) -> Vec<String> {
    let mut said = Vec::new();
    let has_variance = has_variance(claim);
    let has_kurtosis = !has_variance && claim.kurtosis.is_some();
    let has_grounds = has_variance || has_kurtosis || claim.range.is_some();
    let is_free = judgement.neighbours.is_tested && !judgement.neighbours.is_refuted();
    let pixels = if is_free { " of independent pixels" } else { "" };
    let whose = match (has_variance, claim.kurtosis.filter(|_| has_kurtosis)) {
        (true, _) => " of that variance".to_owned(),
        (_, Some(kurtosis)) => format!(" of a kurtosis of {kurtosis} at most in every tile"),
        _ => String::new(),
    };
    if has_grounds {
        said.push(format!(
            "independent passes{pixels}{whose} fail with probability {} at most, all tiles and channels together",
            judgement.alpha
        ));
        let condition = if has_variance { " if the variance is right" } else { "" };
        said.push(format!(
            "a picture, or a tile, that is off by its tolerance passes with probability {} at most{condition}",
            judgement.beta
        ));
    } else {
        said.push("nothing fails or passes without a variance or a range".to_owned());
    }
    said.extend(estimated(judgement));
    if !judgement.neighbours.is_tested {
        said.push("there are no neighbours".to_owned());
    } else if judgement.neighbours.is_refuted() {
        said.push(format!(
            "{}: averages of whole passes are judged, by the range alone",
            judgement.neighbours.reason
        ));
    } else {
        said.push(
            "the pixels of a pass count as independent of each other; neighbours show nothing else"
                .to_owned(),
        );
    }
    if !judgement.order.is_tested {
        said.push(format!(
            "{} passes are too few to see whether each depends on the one before",
            judgement.passes
        ));
    }
    if judgement.counts.listed > 0 {
        said.push(format!(
            "of the {} tiles on the list, a share of {} at most is right, on average",
            judgement.counts.listed, judgement.listed_rate
        ));
    }
    said
}

/// Returns the promises of a verdict on two stacks.
pub(super) fn guarantees_against(
    judgement: &Judgement,
    comparison: &StackComparison,
) -> Vec<String> {
    let alpha = judgement.alpha;
    let pixels = if comparison.method == ComparisonMethod::Signs {
        ", and pixels are independent,"
    } else {
        ""
    };
    let mut said = vec![format!(
        "if both stacks have one distribution in every pixel{pixels} they fail with probability {alpha} at most: exact, for any distribution and \
         number of passes"
    )];
    if !comparison.is_same_distribution {
        let kurtosis = comparison
            .kurtosis
            .map_or(String::new(), |k| format!(" ({} as measured)", short(k, 3)));
        said.push(format!(
            "if only their means are equal the level {alpha} is nominal: it assumes independent pixels and that no tile has a \
             larger kurtosis than these passes show{kurtosis}; rare values that neither stack drew may carry a mean"
        ));
    }
    said.push(format!(
        "a picture, or a tile, that is off by its tolerance passes with probability {} at most: nominal, by averages that are near \
         normal",
        judgement.beta
    ));
    if judgement.neighbours.is_refuted() {
        said.push(format!("{}: averages of whole passes are judged", judgement.neighbours.reason));
    }
    if !judgement.order.is_tested {
        said.push(
            "the passes are too few to see whether each depends on the one before".to_owned(),
        );
    }
    said
}
