//! What is said of another program's draws.

use super::reason::Reason;
use crate::causes::{Pattern, Side};
use crate::stats::verdict::{GateFinding, Verdict};

/// The verdict on a list of draws, with its numbers.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Judgement {
    /// `pass`, `fail` or `inconclusive`.
    pub verdict: Verdict,
    /// Why, in words; empty for a plain pass. A pass with words has a mean that is off within the tolerance.
    pub reason: String,
    /// Kind of the draw that refutes the claim by itself, where there is one.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub fault: Option<Fault>,
    /// What the verdict promises, and what it does not.
    pub guarantees: Vec<String>,
    /// α: the chance that correct draws fail.
    pub alpha: f64,
    /// β: the chance that a scalar passes although it is off by its tolerance.
    pub beta: f64,
    /// How many draws were read.
    pub draws: u64,
    /// How many there are, where that is known.
    pub length: Option<u64>,
    /// Why reading stopped before the end, where it did.
    pub stopped: Option<Stop>,
    /// How many consecutive draws are averaged before they are judged.
    pub batch: u64,
    /// How many of the last draws fill no average.
    pub unfilled: u64,
    /// What the mean should be.
    pub truth: f64,
    /// What the tolerance of the mean is relative to.
    pub unit: f64,
    /// The mean of the draws.
    pub mean: Option<f64>,
    /// Its standard error: from the variance claimed, else from that of the draws.
    pub standard_error: Option<f64>,
    /// (mean − truth) in standard errors.
    pub z: Option<f64>,
    /// The unbiased sample variance, of averages where draws are averaged.
    pub variance: Option<f64>,
    /// The variance claimed.
    pub predicted_variance: Option<f64>,
    /// s²/V.
    pub variance_ratio: Option<f64>,
    /// The standard deviation of s²/V: from the kurtosis claimed, else from that of the draws.
    pub variance_band: Option<f64>,
    /// The sample kurtosis.
    pub kurtosis: Option<f64>,
    /// The mean number of lookups.
    pub lookups: Option<f64>,
    /// The number claimed.
    pub predicted_lookups: Option<f64>,
    /// The first draw that refutes the claim by itself, counted from 0.
    pub refuted_by: Option<u64>,
    /// How many such draws there are.
    pub refuting: u64,
    /// Whether every draw is a number of single precision, and no small set of values.
    pub single_precision: bool,
    /// `log₂` of how many values the first draws seem to come from, where they come twice too often for
    /// all bits of a double.
    pub resolution: Option<f64>,
    /// What the gate found of the mean, the variance and the lookups.
    pub findings: Vec<ScalarFinding>,
    /// Whether the mean changes on the way.
    pub drift: Option<DriftFinding>,
    /// Whether the draws depend on each other.
    pub independence: IndependenceFinding,
    /// The experiment of the case, in words.
    pub theory: Option<String>,
    /// Tests of the distribution of the draws and of their lookups, where theory knows it.
    pub distribution: Vec<DistributionFinding>,
}

/// Result of a test of a whole distribution.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DistributionFinding {
    /// `distances`, `depth`, `resolution`, `atoms`, `counts`, `curve` or `covariance`.
    pub check: String,
    /// The distribution in words.
    pub what: String,
    /// What is said of it.
    pub verdict: Verdict,
    /// Why.
    #[cfg_attr(feature = "serde", serde(serialize_with = "super::reason::words"))]
    pub reason: Option<Reason>,
    /// The p-value of the last look, or of the one that refuted it.
    pub p: f64,
    /// Number of draws at that look.
    pub draws: u64,
}

/// Why reading stopped before the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Stop {
    /// All was decided, and the caller wanted no more.
    Decided,
    /// As many draws were read as the caller wanted, or as are read of a pipe.
    Limit,
}

/// What the gate found of one scalar.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ScalarFinding {
    /// `mean`, `variance` or `lookups`.
    pub check: String,
    /// What is said of it.
    pub verdict: Verdict,
    /// Why.
    #[cfg_attr(feature = "serde", serde(serialize_with = "super::reason::words"))]
    pub reason: Option<Reason>,
    /// Whether its variance was estimated from earlier draws without a promise of the caller's.
    pub is_estimated: bool,
    /// The largest kurtosis for which the finding holds, where one had to be assumed.
    pub assumed_kurtosis: Option<f64>,
    /// Whether correct draws of the planned number pass.
    pub is_promised: bool,
    /// Where the gate stands; `None` where nothing could be asked of the draws.
    pub gate: Option<GateFinding>,
}

/// Whether the mean is the same from beginning to end.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct DriftFinding {
    /// What is said of it.
    pub verdict: Verdict,
    /// Why.
    #[cfg_attr(feature = "serde", serde(serialize_with = "super::reason::words"))]
    pub reason: Option<Reason>,
    /// ln E against draws that have the claimed mean throughout, from any later block on.
    pub ln_e: f64,
    /// The ln E at which it fails.
    pub ln_e_limit: f64,
    /// The draw from which on the mean differs; `None` where no change is shown.
    pub from: Option<u64>,
    /// By how much from the truth, in units of it.
    pub off: f64,
}

/// Whether draws depend on each other.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct IndependenceFinding {
    /// Why they do; `None` where nothing was found.
    #[cfg_attr(feature = "serde", serde(serialize_with = "super::reason::words"))]
    pub reason: Option<Reason>,
    /// ln E against independent draws of one law.
    pub ln_e: f64,
    /// The ln E at which draws count as dependent.
    pub ln_e_limit: f64,
    /// How many consecutive draws are summed up where the dependence was found.
    pub scale: Option<u64>,
    /// The lag, in draws or sums.
    pub lag: Option<u64>,
    /// The correlation there.
    pub correlation: Option<f64>,
    /// After how many draws the same ones come again.
    pub replay: Option<u64>,
    /// Number of times that the same draws come in all.
    pub repeats: Option<u64>,
    /// ln of a bound on the probability that independent draws come again like that.
    pub replay_ln_p: Option<f64>,
    /// From how many averaged draws on no dependence shows.
    pub batch: Option<u64>,
}

impl IndependenceFinding {
    /// Whether a dependence was found.
    pub fn is_refuted(&self) -> bool {
        self.reason.is_some()
    }
}

impl Judgement {
    /// What was found of a scalar.
    pub fn finding(&self, check: &str) -> Option<&ScalarFinding> {
        self.findings.iter().find(|finding| finding.check == check)
    }

    /// Which checks fail, and on which side; draws that depend on each other have no other side.
    pub fn pattern(&self) -> Pattern {
        let mut pattern = Pattern::default();
        if self.independence.is_refuted() {
            pattern.dependence = true;
            return pattern;
        }
        for finding in self.findings.iter().filter(|found| found.verdict == Verdict::Fail) {
            pattern.note(&finding.check, finding.gate.map(|gate| gate.mean));
        }
        match self.fault {
            Some(Fault::Number | Fault::Range) => pattern.number = true,
            Some(Fault::Lookups) => pattern.lookups = Side::Both,
            Some(Fault::Spread | Fault::Distance) => pattern.mean = Side::Both,
            None => {}
        }
        pattern
    }
}

/// What is wrong with a draw that refutes the claim by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// It is not finite, or so far from the truth that the square of the distance overflows.
    Number,
    /// It is out of the promised range.
    Range,
    /// It is not the truth, and draws have no spread.
    Spread,
    /// It takes another number of lookups than all draws take.
    Lookups,
    /// It is a negative number in place of a distance.
    Distance,
}
