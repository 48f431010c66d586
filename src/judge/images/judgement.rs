//! What is said of a stack of pictures.

use super::picture::{Size, Stack};
use crate::judge::LISTED;
use gate::causes::Pattern;
use gate::stats::gate::Evidence;
use gate::stats::verdict::{MISS, Verdict};

/// The verdict on a stack, with its numbers.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Judgement {
    /// `pass`, `fail` or `inconclusive`.
    pub verdict: Verdict,
    /// Why, in words; of a pass, what it excludes where that is little; else empty for a pass.
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
    /// What is known of a variance that was estimated; `None` for an exact one, or none.
    pub estimate: Option<Estimate>,
    /// Number of passes that the truth image is the mean of; `None` for an exact truth.
    pub truth_passes: Option<usize>,
    /// Comparison with a second stack; `None` where the truth is given.
    pub comparison: Option<Comparison>,
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

impl Refuted {
    /// The value at a place of a pass.
    pub(super) fn at(size: Size, pass: usize, index: usize, value: f64) -> Self {
        let [row, column, channel] = size.place(index);
        Self { pass, row, column, channel, value }
    }
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
    /// True if there is enough to tell.
    pub is_tested: bool,
}

impl Dependence {
    /// Returns whether a dependence was found.
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
    /// The mean of s²/V beyond which nothing passes.
    pub margin: f64,
    /// ln E against a variance of V at most.
    pub ln_e: f64,
    /// The ln E at which it is refuted.
    pub limit: f64,
    /// True if it is.
    pub is_refuted: bool,
}

/// A variance that was estimated from passes.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Estimate {
    /// Number of passes that it was estimated from.
    pub passes: usize,
    /// Kurtosis of the values of the smallest tiles that is relied on: measured, or given.
    pub kurtosis: f64,
    /// True if the caller gave the kurtosis.
    pub is_given: bool,
    /// Number of negative variances, which count as 0.
    pub negative: u64,
    /// Number of variances that are NaN or infinite: these values are not judged.
    pub unknown: u64,
    /// The first of either kind: row, column and channel, from 0.
    pub first: Option<[usize; 3]>,
}

/// Two stacks against each other.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Comparison {
    /// Number of passes of the reference.
    pub passes: usize,
    /// Test of equal distributions: `permutation` of passes, `signs` of differences, or `none`.
    pub method: &'static str,
    /// Number of random permutations; 0 for signs.
    pub permutations: u64,
    /// Least p-value of all tiles and the whole together, for equal distributions.
    pub p: f64,
    /// True if the caller claims equal distributions in each pixel.
    pub is_same_law: bool,
    /// Variance of the test over that of the reference, over all pixels; `None` where neither varies.
    pub spread: Option<f64>,
    /// p-value of that for equal distributions.
    pub spread_p: f64,
    /// Largest kurtosis of the smallest tiles' values, as measured.
    pub kurtosis: Option<f64>,
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
    /// Probability of a difference at least as large where all is well: by a permutation of two stacks, else from z.
    pub p: Option<f64>,
    /// ln E against the truth.
    pub ln_e: f64,
    /// ln of the evidence against a bias of +ε and of −ε; infinite where there is no doubt.
    pub ln_p: [f64; 2],
    /// ε, in units of the picture's mean truth in that channel; `None` where nothing could be asked.
    pub tolerance: Option<f64>,
    /// True if it is on the list of tiles that are off.
    pub is_listed: bool,
    /// What is said of it.
    pub verdict: Verdict,
}

/// Maximum number of worst tiles that are listed.
const WORST: usize = 5;

/// Numbers of tiles by their verdicts.
fn counts(tiles: &[Tile]) -> Counts {
    let of = |verdict| tiles.iter().filter(|tile| tile.verdict == verdict).count();
    Counts {
        tiles: tiles.len(),
        pass: of(Verdict::Pass),
        fail: of(Verdict::Fail),
        listed: tiles.iter().filter(|tile| tile.is_listed).count(),
    }
}

/// The tiles with the most evidence against them, of those that fail or are listed.
fn worst(tiles: &[Tile]) -> Vec<Tile> {
    let is_off = |tile: &&Tile| tile.is_listed || tile.verdict == Verdict::Fail;
    let mut off: Vec<&Tile> = tiles.iter().filter(is_off).collect();
    off.sort_by(|a, b| b.ln_e.total_cmp(&a.ln_e));
    off.into_iter().take(WORST).cloned().collect()
}

impl Tile {
    /// The evidence on the mean.
    pub(super) fn evidence(&self) -> Evidence {
        Evidence { ln_e: self.ln_e, ln_pass: self.ln_p }
    }
}

impl Judgement {
    /// A judgement of passes of which nothing is known yet.
    pub(super) fn new(stack: &Stack, alpha: f64, tile: usize) -> Self {
        Self {
            verdict: Verdict::Inconclusive,
            reason: String::new(),
            guarantees: Vec::new(),
            alpha,
            beta: MISS,
            listed_rate: LISTED,
            passes: stack.passes,
            size: stack.size,
            tile,
            refuted_by: None,
            refuting: 0,
            order: Dependence::default(),
            neighbours: Dependence::default(),
            repeated: Vec::new(),
            variance: None,
            estimate: None,
            truth_passes: None,
            comparison: None,
            whole: Vec::new(),
            tiles: Vec::new(),
            counts: Counts::default(),
            worst: Vec::new(),
        }
    }

    /// Takes the tiles and the whole picture.
    pub(super) fn take(&mut self, tiles: Vec<Tile>, whole: Vec<Tile>) {
        (self.worst, self.counts) = (worst(&tiles), counts(&tiles));
        (self.tiles, self.whole) = (tiles, whole);
    }

    /// Which checks fail, and on which side; passes that depend on each other have no other side.
    pub fn pattern(&self) -> Pattern {
        let mut pattern = Pattern::default();
        if self.order.is_refuted() {
            pattern.dependence = true;
            return pattern;
        }
        pattern.number = self.refuted_by.is_some();
        if self.variance.is_some_and(|variance| variance.is_refuted) {
            pattern.note("variance", Some(1.0));
        }
        let failing =
            self.whole.iter().chain(&self.tiles).filter(|tile| tile.verdict == Verdict::Fail);
        for tile in failing {
            pattern.note("mean", Some(tile.mean - tile.truth));
        }
        pattern
    }
}
