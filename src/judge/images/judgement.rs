//! What is said of a stack of pictures.

use super::picture::Size;
use crate::stats::verdict::Verdict;

/// The verdict on a stack, with its numbers.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Judgement {
    /// `pass`, `fail` or `inconclusive`.
    pub verdict: Verdict,
    /// Why, in words; empty for a plain pass.
    pub reason: String,
    /// What the verdict promises, and what it does not.
    pub guarantees: Vec<String>,
    /// α: the chance that correct passes fail.
    pub alpha: f64,
    /// β: the chance that a tile, or the whole, passes although it is off by its tolerance.
    pub beta: f64,
    /// The rate of false ones that is kept on the list of tiles.
    pub listed_rate: f64,
    /// How many passes there are.
    pub passes: usize,
    /// How large each is.
    pub size: Size,
    /// Rows and columns of the smallest tiles; fewer at the right and at the foot.
    pub tile: usize,
    /// The first value that refutes the claim by itself.
    pub refuted_by: Option<Refuted>,
    /// How many such values there are.
    pub refuting: u64,
    /// Whether the passes depend on each other.
    pub order: Dependence,
    /// Whether the pixels of a pass do.
    pub neighbours: Dependence,
    /// The passes that share values, from 0; empty where none do.
    pub repeated: Vec<u32>,
    /// What the values show of the claimed variance.
    pub variance: Option<Variance>,
    /// The whole picture, each channel.
    pub whole: Vec<Tile>,
    /// Every tile, the smallest first, row after row from the top, each with all its channels.
    #[serde(skip)]
    pub tiles: Vec<Tile>,
    /// How many tiles there are, and how many of them pass, fail and are listed.
    pub counts: Counts,
    /// The tiles with the most evidence against them.
    pub worst: Vec<Tile>,
}

/// How many tiles there are of a kind; a tile counts in each channel.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct Counts {
    /// K.
    pub tiles: usize,
    /// Those that pass.
    pub pass: usize,
    /// Those that fail, by Holm.
    pub fail: usize,
    /// Those on the list, by e-BH.
    pub listed: usize,
}

/// A value that refutes the claim by itself.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Refuted {
    /// The pass, from 0.
    pub pass: usize,
    /// The row, from 0 at the top.
    pub row: usize,
    /// The column, from 0.
    pub column: usize,
    /// The channel, from 0.
    pub channel: usize,
    /// What it is.
    pub value: f64,
}

/// Whether some numbers depend on each other.
#[derive(Debug, Clone, Default, serde::Serialize)]
pub struct Dependence {
    /// Why they do; empty where nothing was found.
    pub reason: String,
    /// ln of the evidence, or of 1/p.
    pub evidence: f64,
    /// What it must reach.
    pub limit: f64,
    /// The strongest correlation that was seen.
    pub correlation: Option<f64>,
    /// Its lag, in passes.
    pub lag: Option<usize>,
    /// Whether there is enough to tell.
    pub is_tested: bool,
}

impl Dependence {
    /// Whether a dependence was found.
    pub fn is_refuted(&self) -> bool {
        !self.reason.is_empty()
    }
}

/// What the values show of the claimed variance, over all pixels.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Variance {
    /// The mean of (x − truth)²/V.
    pub about_truth: f64,
    /// The mean of s²/V.
    pub about_mean: f64,
    /// ln E against a variance of V at most.
    pub ln_e: f64,
    /// The ln E at which it is refuted.
    pub limit: f64,
    /// Whether it is.
    pub is_refuted: bool,
}

/// A rectangle of pixels in one channel.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Tile {
    /// Rows and columns of tiles of its kind.
    pub size: usize,
    /// The first row, from 0 at the top.
    pub row: usize,
    /// The first column, from 0.
    pub column: usize,
    /// How many rows it has.
    pub height: usize,
    /// How many columns it has.
    pub width: usize,
    /// The channel, from 0.
    pub channel: usize,
    /// The mean of the truth.
    pub truth: f64,
    /// The mean of all passes.
    pub mean: f64,
    /// Its standard error: from the variance claimed, else from that of the passes.
    pub standard_error: f64,
    /// (mean − truth) in standard errors; `None` where that is no number.
    pub z: Option<f64>,
    /// ln E against the truth.
    pub ln_e: f64,
    /// ln of the evidence against a bias of +ε and of −ε; infinite where there is no doubt.
    pub ln_p: [f64; 2],
    /// ε, in units of the picture's mean truth in that channel; `None` where nothing could be asked.
    pub tolerance: Option<f64>,
    /// Whether it is on the list of tiles that are off.
    pub is_listed: bool,
    /// What is said of it.
    pub verdict: Verdict,
}
