//! What a gate says, and the numbers that every gate shares.

/// Draws per block, always: looks happen at the ends of blocks.
pub const BLOCK: u64 = 1 << 14;

/// β, the chance that a check passes although the bias is as large as its tolerance.
pub const MISS: f64 = 0.01;

/// So many standard deviations no draw is away from its mean: by Chebyshev's inequality, with chance
/// 1e-16 per draw.
pub const FURTHEST: f64 = 1e8;

/// What is said of an experiment, or of one check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Verdict {
    /// Agrees with theory, and a difference of the size that matters would have been seen.
    Pass,
    /// Differs from theory by more than chance allows.
    Fail,
    /// Not decided by the draws that were made.
    Inconclusive,
    /// It could fail, but was never promised to pass: known before the first draw.
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

/// Where the gate stands with one scalar.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GateFinding {
    /// ε: the bias that a pass excludes.
    #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
    pub tolerance: f64,
    /// V: the variance of the scalar in theory; it may be infinite.
    #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
    pub variance: f64,
    /// The observed mean of the scalar, 0 when all is well.
    #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
    pub mean: f64,
    /// How many draws were planned, 27 V/ε²; infinite where none would do.
    #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
    pub planned: f64,
    /// How many draws it took to decide, or were made without a decision.
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
    /// The draws that it would need, where more than were planned; infinite where none would do.
    /// `None` where the plan suffices.
    #[cfg_attr(feature = "serde", serde(default, with = "crate::extended"))]
    pub needed: Option<f64>,
    /// Whether it was decided.
    pub is_decided: bool,
}
