//! Verdicts of a gate, and the constants of every gate.

/// Number of draws in a block: looks happen at the ends of blocks.
pub const BLOCK: u64 = 1 << 14;

/// β, the probability that a check passes although the bias is as large as its tolerance.
pub const MISS: f64 = 0.01;

/// Maximum distance of a draw from its mean in standard deviations: by Chebyshev's inequality it is exceeded with
/// probability 1e-16 per draw.
pub const FURTHEST: f64 = 1e8;

/// Verdict on an experiment, or on one check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Verdict {
    /// Agrees with theory, and a difference of the size of the tolerance would have been detected.
    Pass,
    /// Differs from theory by more than random fluctuations explain.
    Fail,
    /// Not decided by the draws that were made.
    Inconclusive,
    /// Too few samples to confirm it, known before the first draw; it can still fail.
    Underpowered,
    /// Not drawn: the estimator does not exist or is biased here.
    Refused,
}

impl Verdict {
    /// The verdict on several things together: fail before inconclusive before underpowered before pass.
    pub fn worst(verdicts: impl IntoIterator<Item = Self>) -> Self {
        let order = [Self::Fail, Self::Inconclusive, Self::Underpowered];
        let rank = |verdict: &Self| order.iter().position(|other| other == verdict);
        let worst = verdicts.into_iter().filter_map(|verdict| rank(&verdict)).min();
        worst.map_or(Self::Pass, |rank| order[rank])
    }

    /// The word in tables and files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Inconclusive => "inconclusive",
            Self::Underpowered => "underpowered",
            Self::Refused => "refused",
        }
    }
}

/// State of the gate for one scalar.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GateFinding {
    /// ε: the bias that a pass excludes.
    #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
    pub tolerance: f64,
    /// V: the variance of the scalar in theory; it may be infinite.
    #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
    pub variance: f64,
    /// The observed mean of the scalar, 0 in theory.
    #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
    pub mean: f64,
    /// Number of planned draws, 27 V/ε²; infinite where no number suffices.
    #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
    pub planned: f64,
    /// Number of draws until the decision, or of all draws without a decision.
    pub draws: u64,
    /// ln E, the evidence against a correct scalar.
    #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
    pub ln_e: f64,
    /// The ln E at which it fails.
    pub ln_e_limit: f64,
    /// ln of the evidence against a bias of +ε and of −ε.
    #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
    pub ln_p: [f64; 2],
    /// The ln P at which it passes.
    pub ln_p_limit: f64,
    /// Number of draws that the test needs, where more than were planned; infinite where no number suffices. `None`
    /// where the plan suffices.
    #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
    pub needed: Option<f64>,
    /// True if it was decided.
    pub is_decided: bool,
}
