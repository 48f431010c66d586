//! Judgements of draws: the numbers, and a few lines of words, each with a label at its left, for every console and
//! language.

use crate::CheckId;
use std::fmt::{self, Write};

use super::reason::Reason;
use crate::causes::{DeviationSide, Pattern};
use crate::stats::verdict::{GateFinding, Verdict};
use numeric::digits::{count, fixed, short, signed};

/// The verdict on a list of draws, with its numbers.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Judgement {
    /// `pass`, `fail` or `inconclusive`.
    pub verdict: Verdict,
    /// Reason in words; empty for a plain pass. A pass with words has a mean that deviates within the tolerance.
    pub reason: String,
    /// Kind of the draw that refutes the claim by itself, where there is one.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub fault: Option<InvalidDraw>,
    /// Guarantees of the verdict, and their limits.
    pub guarantees: Vec<String>,
    /// α: the probability that correct draws fail.
    pub alpha: f64,
    /// β: the probability that a scalar passes although it deviates by its tolerance.
    pub beta: f64,
    /// Number of draws that were read.
    pub draws: u64,
    /// Number of draws that exist, if it is known.
    pub length: Option<u64>,
    /// Reason why reading stopped before the end, if it did.
    pub stopped: Option<Stop>,
    /// Number of consecutive draws that are averaged before they are judged.
    pub batch: u64,
    /// Number of last draws that fill no average.
    pub unfilled: u64,
    /// Expected value of the mean.
    pub truth: f64,
    /// Unit of the mean's tolerance.
    pub unit: f64,
    /// The mean of the draws.
    pub mean: Option<f64>,
    /// Standard error of the mean: from the claimed variance, else from that of the draws.
    pub standard_error: Option<f64>,
    /// (mean − truth) in standard errors.
    pub z: Option<f64>,
    /// The unbiased sample variance, of averages if draws are averaged.
    pub variance: Option<f64>,
    /// The claimed variance.
    pub predicted_variance: Option<f64>,
    /// s²/V.
    pub variance_ratio: Option<f64>,
    /// The standard deviation of s²/V: from the claimed kurtosis, else from that of the draws.
    pub variance_band: Option<f64>,
    /// The sample kurtosis.
    pub kurtosis: Option<f64>,
    /// The mean number of lookups.
    pub lookups: Option<f64>,
    /// The claimed number of lookups.
    pub predicted_lookups: Option<f64>,
    /// The first draw that refutes the claim by itself, counted from 0.
    pub refuted_by: Option<u64>,
    /// Number of draws that refute the claim by themselves.
    pub refuting: u64,
    /// True if every draw is a number of single precision, and draws do not come from a small set of values.
    pub single_precision: bool,
    /// `log₂` of the number of values that the first draws seem to come from, if values come twice too often for
    /// all bits of a double.
    pub resolution: Option<f64>,
    /// Findings of the gate on the mean, the variance and the lookups.
    pub findings: Vec<ScalarFinding>,
    /// Finding on a change of the mean.
    pub drift: Option<DriftFinding>,
    /// Finding on the dependence of the draws.
    pub independence: IndependenceFinding,
    /// The experiment of the case, in words.
    pub theory: Option<String>,
    /// Tests of the distributions of the draws and of their lookups, if theory has them.
    pub distribution: Vec<DistributionFinding>,
}

/// Result of a test of a whole distribution.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DistributionFinding {
    /// `distances`, `depth`, `resolution`, `atoms`, `counts`, `curve` or `covariance`.
    pub check: CheckId,
    /// The distribution in words.
    pub what: String,
    /// The verdict on it.
    pub verdict: Verdict,
    /// The reason.
    #[cfg_attr(feature = "serde", serde(serialize_with = "super::reason::words"))]
    pub reason: Option<Reason>,
    /// The p-value of the last look, or of the look that refuted it.
    pub p: f64,
    /// Number of draws at that look.
    pub draws: u64,
}

/// Reason why reading stopped before the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Stop {
    /// All was decided, and no more draws were wanted.
    Decided,
    /// The maximum number of draws was reached: that of the caller, or that for a pipe.
    Limit,
}

/// Finding of the gate on one scalar.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ScalarFinding {
    /// `mean`, `variance` or `lookups`.
    pub check: CheckId,
    /// The verdict on it.
    pub verdict: Verdict,
    /// The reason.
    #[cfg_attr(feature = "serde", serde(serialize_with = "super::reason::words"))]
    pub reason: Option<Reason>,
    /// True if its variance was estimated from earlier draws, without a claim of the caller.
    pub is_estimated: bool,
    /// The largest kurtosis for which the finding holds, where one had to be assumed.
    pub assumed_kurtosis: Option<f64>,
    /// True if correct draws of the planned number pass.
    pub is_promised: bool,
    /// State of the gate; `None` where the scalar could not be tested.
    pub gate: Option<GateFinding>,
}

/// Finding on a change of the mean.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DriftFinding {
    /// The verdict on it.
    pub verdict: Verdict,
    /// The reason.
    #[cfg_attr(feature = "serde", serde(serialize_with = "super::reason::words"))]
    pub reason: Option<Reason>,
    /// ln E against draws that have the claimed mean throughout, from any later block on.
    pub ln_e: f64,
    /// The ln E at which it fails.
    pub ln_e_limit: f64,
    /// The draw from which on the mean differs; `None` where no change is shown.
    pub from: Option<u64>,
    /// Deviation from the truth, in units of it.
    pub off: f64,
}

/// Finding on the dependence of draws.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct IndependenceFinding {
    /// The reason; `None` where no dependence was found.
    #[cfg_attr(feature = "serde", serde(serialize_with = "super::reason::words"))]
    pub reason: Option<Reason>,
    /// ln E against independent draws of one distribution.
    pub ln_e: f64,
    /// The ln E at which draws count as dependent.
    pub ln_e_limit: f64,
    /// Number of consecutive draws in each sum where the dependence was found.
    pub scale: Option<u64>,
    /// The lag, in draws or sums.
    pub lag: Option<u64>,
    /// The correlation there.
    pub correlation: Option<f64>,
    /// Number of draws after which the same ones repeat.
    pub replay: Option<u64>,
    /// Number of times that the same draws occur in all.
    pub repeats: Option<u64>,
    /// ln of a bound on the probability that independent draws repeat like that.
    pub replay_ln_p: Option<f64>,
    /// Minimum number of averaged draws from which on no dependence shows.
    pub batch: Option<u64>,
}

impl IndependenceFinding {
    /// Returns whether a dependence was found.
    pub fn is_refuted(&self) -> bool {
        self.reason.is_some()
    }
}

impl Judgement {
    /// Finding on a scalar.
    pub fn finding(&self, check: CheckId) -> Option<&ScalarFinding> {
        self.findings.iter().find(|finding| finding.check == check)
    }

    /// Checks that fail, and their sides; dependent draws have no other side.
    pub fn pattern(&self) -> Pattern {
        let mut pattern = Pattern::default();
        if self.independence.is_refuted() {
            pattern.dependence = true;
            return pattern;
        }
        for finding in self.findings.iter().filter(|result| result.verdict == Verdict::Fail) {
            pattern.note(finding.check, finding.gate.map(|gate| gate.mean));
        }
        for result in self.distribution.iter().filter(|result| result.verdict == Verdict::Fail) {
            pattern.note(result.check, None);
        }
        match self.fault {
            Some(InvalidDraw::Number | InvalidDraw::Range) => pattern.number = true,
            Some(InvalidDraw::Lookups) => pattern.lookups = DeviationSide::Both,
            Some(InvalidDraw::Spread | InvalidDraw::Distance) => pattern.mean = DeviationSide::Both,
            None => {}
        }
        pattern.binary = self.batch == 1 && self.has_binary_moments();
        pattern
    }

    /// Returns whether mean and variance are those of draws of 0 and 1 only: `E[X²] = E[X]` up to rounding.
    fn has_binary_moments(&self) -> bool {
        let (Some(mean), Some(variance)) = (self.mean, self.variance) else { return false };
        let share = 1.0 - 1.0 / self.draws.max(1) as f64;
        (variance * share - mean * (1.0 - mean)).abs() <= 1e-9 * mean.abs()
    }
}

/// Kind of a draw that refutes the claim by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InvalidDraw {
    /// The draw is not finite, or so far from the truth that the square of the distance overflows.
    Number,
    /// The draw is out of the claimed range.
    Range,
    /// The draw differs from the truth, and draws have no variance.
    Spread,
    /// The draw takes another number of lookups than all draws must.
    Lookups,
    /// The draw is a negative number in place of a distance.
    Distance,
}

impl Judgement {
    /// The lines on draws of that name: label and text of each.
    pub fn lines(&self, name: &str) -> Vec<(&'static str, String)> {
        let mut lines = vec![("draws", draws(self, name))];
        lines.extend(self.theory.iter().map(|about| ("theory", about.clone())));
        lines.push(("mean", mean(self)));
        lines.extend(variance(self).map(|text| ("variance", text)));
        lines.extend(lookups(self).map(|text| ("lookups", text)));
        lines.extend(self.findings.iter().map(|finding| ("gate", gate(finding))));
        if let Some(drift) = &self.drift {
            let (word, result, limit) = (drift.verdict.word(), drift.ln_e, drift.ln_e_limit);
            let shown = match drift.verdict {
                Verdict::Pass if result >= limit => ", but all draws are off, from the first on",
                _ => "",
            };
            let text = format!(
                "ln E = {} of {limit:.1} for a change of the mean{shown}: {word}",
                ln(result)
            );
            lines.push(("drift", text));
        }
        lines.extend(self.distribution.iter().map(|result| ("p-value", p_value(result))));
        lines.push(("order", order(&self.independence)));
        lines.extend(self.guarantees.iter().map(|promise| ("promise", promise.clone())));
        lines.push(("verdict", self.to_string()));
        lines.extend(self.pattern().lines().into_iter().map(|line| ("likely", line)));
        lines
    }
}

/// Formats the verdict, and the reason.
impl fmt::Display for Judgement {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (word, reason) = (self.verdict.word(), &self.reason);
        if reason.is_empty() { f.write_str(word) } else { write!(f, "{word}: {reason}") }
    }
}

fn draws(judgement: &Judgement, name: &str) -> String {
    let read = count(judgement.draws);
    let of = match judgement.length {
        Some(length) if length != judgement.draws => format!(" of {}", count(length)),
        _ => String::new(),
    };
    let rest = match judgement.stopped {
        Some(Stop::Decided) => "; all was decided, and the rest was not read",
        Some(Stop::Limit) => "; the rest was not read",
        None => "",
    };
    let batch = match judgement.batch {
        1 => String::new(),
        batch => format!(", judged as averages of {}", count(batch)),
    };
    format!("{read}{of} in {name}{rest}{batch}")
}

fn lookups(judgement: &Judgement) -> Option<String> {
    let (result, claimed) = (judgement.lookups?, judgement.predicted_lookups?);
    Some(format!("{} a draw, {} expected", short(result, 8), short(claimed, 8)))
}

/// Describes the dependence of the draws.
fn order(result: &IndependenceFinding) -> String {
    let evidence = match result.replay_ln_p {
        Some(ln_p) => format!("probability e^{ln_p:.1} or less"),
        None => format!("ln E = {:.1} of {:.1}", result.ln_e, result.ln_e_limit),
    };
    match &result.reason {
        Some(reason) => format!("{evidence}: {reason}"),
        None => format!("{evidence} against independent draws: nothing found"),
    }
}

fn mean(judgement: &Judgement) -> String {
    let Some(mean) = judgement.mean else { return "–".into() };
    let truth = short(judgement.truth, 10);
    let error = judgement.standard_error.map(|error| format!(" ± {}", short(error, 3)));
    let kind = if judgement.predicted_variance.is_some() { "predicted" } else { "estimated" };
    let error = error.map_or(String::new(), |error| format!("{error} ({kind})"));
    let z = judgement.z.map_or(String::new(), |z| format!(", z = {}", signed(z)));
    format!("{}{error}, truth {truth}{z}", fixed(mean, 8))
}

fn variance(judgement: &Judgement) -> Option<String> {
    let mut text = format!("s² = {}", short(judgement.variance?, 6));
    if let Some(ratio) = judgement.variance_ratio {
        let _ = write!(text, ", s²/V = {}", fixed(ratio, 5));
        if let Some(band) = judgement.variance_band {
            let _ = write!(text, " (1 ± {})", short(band, 2));
        }
    }
    if let Some(kurtosis) = judgement.kurtosis {
        let _ = write!(text, ", sample kurtosis {}", short(kurtosis, 4));
    }
    Some(text)
}

/// The test of a distribution.
fn p_value(result: &DistributionFinding) -> String {
    let DistributionFinding { check, what, verdict, p, draws, .. } = result;
    let (p, draws) = (short(*p, 3), count(*draws));
    format!("{check}: p = {p} for {what} after {draws} draws: {}", verdict.word())
}

/// A logarithm of evidence; bets on draws out of their range have none.
fn ln(evidence: f64) -> String {
    if evidence.is_nan() { "–".to_owned() } else { format!("{evidence:.1}") }
}

fn gate(finding: &ScalarFinding) -> String {
    let check = finding.check;
    let word = finding.verdict.word();
    let Some(gate) = &finding.gate else { return format!("{check} not tested: {word}") };
    let [above, below] = gate.ln_p;
    let estimated = match (finding.is_estimated, check) {
        (true, CheckId::Variance) => " · kurtosis estimated",
        (true, _) => " · variance estimated",
        _ => "",
    };
    format!(
        "{check}: ε = {}, ln E = {above_e} of {limit:.1}, ln P± = {above} and {below} of \
         {pass:.1} after {} draws: {word}{estimated}",
        short(gate.tolerance, 3),
        count(gate.draws),
        above_e = ln(gate.ln_e),
        above = ln(above),
        below = ln(below),
        limit = gate.ln_e_limit,
        pass = gate.ln_p_limit,
    )
}
