//! Judgement of a stack of pictures.

use super::picture::{Size, Stack};
use crate::LISTED;
use gate::CheckId;
use gate::causes::Pattern;
use gate::stats::gate::Evidence;
use gate::stats::verdict::{MISS, Verdict};
use serde::{Serialize, Serializer};

/// Verdict on a stack, with its numbers.
#[derive(Debug, Clone, Serialize)]
pub struct Judgement {
    /// `pass`, `fail` or `inconclusive`.
    pub verdict: Verdict,
    /// Reason, in words. It is empty for a pass, unless the pass excludes only a large bias.
    pub reason: String,
    /// Promises of the verdict, and their assumptions.
    pub guarantees: Vec<String>,
    /// α, the probability that correct passes fail.
    pub alpha: f64,
    /// β, the probability that a tile, or the whole, passes although its bias equals its tolerance.
    pub beta: f64,
    /// Bound on the expected share of false entries on the list of tiles.
    pub listed_rate: f64,
    /// Number of passes.
    pub passes: usize,
    /// Size of each pass.
    pub size: Size,
    /// Rows and columns of the smallest tiles; smaller ones at the right and at the foot.
    pub tile: usize,
    /// First value that refutes the claim by itself.
    pub refuted_by: Option<Refuted>,
    /// Number of such values.
    pub refuting: u64,
    /// Dependence of the passes on each other.
    pub order: Dependence,
    /// Dependence of the pixels of a pass on each other.
    #[serde(serialize_with = "without_lag")]
    pub neighbours: Dependence,
    /// Passes that share values, from 0; empty if none share any.
    pub repeated: Vec<u32>,
    /// Test of the claimed variance.
    pub variance: Option<Variance>,
    /// Estimated variance; `None` for an exact one, or for none.
    pub estimate: Option<VarianceEstimate>,
    /// Number of passes that the truth image is the mean of; `None` for an exact truth.
    pub truth_passes: Option<usize>,
    /// Comparison with a second stack; `None` if the truth is given.
    pub comparison: Option<StackComparison>,
    /// Picture in the channel with the most obvious bias that the claimed variance does not show, with the standard error
    /// and z of the passes' own spread; `None` without such a bias.
    #[serde(skip)]
    pub shown: Option<Tile>,
    /// Whole picture, one entry per channel.
    #[serde(skip)]
    pub whole: Vec<Tile>,
    /// Every tile, the smallest first, row after row from the top, each with all its channels.
    #[serde(skip)]
    pub tiles: Vec<Tile>,
    /// Numbers of tiles by their verdicts.
    #[serde(skip)]
    pub counts: Counts,
    /// Tiles with the most evidence against them.
    #[serde(skip)]
    pub worst: Vec<Tile>,
}

/// Numbers of tiles by their verdicts; a tile counts in each channel.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// K, the number of all tiles.
    pub tiles: usize,
    /// Number of tiles that pass.
    pub pass: usize,
    /// Number of tiles that fail, by Holm.
    pub fail: usize,
    /// Number of tiles on the list, by e-BH.
    pub listed: usize,
}

/// Value that refutes the claim by itself.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Refuted {
    /// Pass, from 0.
    pub pass: usize,
    /// Row, from 0 at the top.
    pub row: usize,
    /// Column, from 0.
    pub column: usize,
    /// Channel, from 0.
    pub channel: usize,
    /// Value.
    pub value: f64,
}

impl Refuted {
    /// Returns the value at a place of a pass.
    pub(super) fn at(size: Size, pass: usize, index: usize, value: f64) -> Self {
        let [row, column, channel] = size.place(index);
        Self { pass, row, column, channel, value }
    }
}

/// Test for dependence of some numbers on each other.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Dependence {
    /// Description of a dependence; empty if none was found.
    pub reason: String,
    /// ln of the evidence, or of 1/p.
    pub evidence: f64,
    /// Limit of the evidence.
    pub limit: f64,
    /// Strongest correlation that was found.
    pub correlation: Option<f64>,
    /// Lag of that correlation, in passes.
    pub lag: Option<usize>,
    /// True if the numbers suffice for a test.
    pub is_tested: bool,
}

impl Dependence {
    /// Returns whether a dependence was found.
    pub fn is_refuted(&self) -> bool {
        !self.reason.is_empty()
    }
}

/// Serializes the dependence of neighbours without its lag.
fn without_lag<S: Serializer>(of: &Dependence, to: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct OfNeighbours<'a> {
        reason: &'a str,
        evidence: f64,
        limit: f64,
        correlation: Option<f64>,
        is_tested: bool,
    }
    let &Dependence { ref reason, evidence, limit, correlation, lag: _, is_tested } = of;
    OfNeighbours { reason, evidence, limit, correlation, is_tested }.serialize(to)
}

/// Test of the claimed variance, over all pixels.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Variance {
    /// Mean of (x − truth)²/V.
    pub about_truth: f64,
    /// Mean of s²/V.
    pub about_mean: f64,
    /// Largest mean of s²/V with which a picture may pass.
    pub margin: f64,
    /// ln E against a variance of at most V.
    pub ln_e: f64,
    /// ln E at which the variance is refuted.
    pub limit: f64,
    /// True if it is refuted.
    pub is_refuted: bool,
    /// True if the passes plainly vary less.
    #[serde(skip)]
    pub is_too_large: bool,
}

/// Variance that was estimated from passes.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct VarianceEstimate {
    /// Number of passes that it was estimated from.
    pub passes: usize,
    /// Kurtosis of the values of the smallest tiles that the evidence relies on: measured, or given.
    pub kurtosis: f64,
    /// True if the caller gave the kurtosis.
    pub is_given: bool,
    /// Number of negative variances, which count as 0.
    pub negative: u64,
    /// Number of variances that are NaN or infinite: these values are not judged.
    pub unknown: u64,
    /// First of either kind: row, column and channel, from 0.
    #[serde(flatten, serialize_with = "by_names")]
    pub first: Option<[usize; 3]>,
}

/// Serializes a place as three fields.
#[allow(clippy::ref_option)] // serde asks for it
fn by_names<S: Serializer>(first: &Option<[usize; 3]>, to: S) -> Result<S::Ok, S::Error> {
    let names = [("first_row", 0), ("first_column", 1), ("first_channel", 2)];
    to.collect_map(names.map(|(name, axis)| (name, first.map(|place| place[axis]))))
}

/// Test of equal distributions of two stacks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ComparisonMethod {
    /// Permutations of passes.
    Permutation,
    /// Signs of differences.
    Signs,
    /// No test.
    None,
}

impl ComparisonMethod {
    /// Returns the word in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Permutation => "permutation",
            Self::Signs => "signs",
            Self::None => "none",
        }
    }
}

/// Two stacks against each other.
#[derive(Debug, Clone, Serialize)]
pub struct StackComparison {
    /// Number of passes of the reference.
    pub passes: usize,
    /// Test of equal distributions.
    pub method: ComparisonMethod,
    /// Number of random permutations; 0 for signs.
    pub permutations: u64,
    /// Smallest p-value of all tiles and the whole together, for equal distributions.
    pub p: f64,
    /// True if the caller claims equal distributions in each pixel.
    pub is_same_distribution: bool,
    /// Variance of the test over that of the reference, over all pixels; `None` if neither varies.
    pub spread: Option<f64>,
    /// p-value of that ratio for equal distributions.
    pub spread_p: f64,
    /// Largest kurtosis of the smallest tiles' values, as measured.
    pub kurtosis: Option<f64>,
}

/// Rectangle of pixels in one channel.
#[derive(Debug, Clone)]
pub struct Tile {
    /// Rows and columns of tiles of its kind.
    pub size: usize,
    /// First row, from 0 at the top.
    pub row: usize,
    /// First column, from 0.
    pub column: usize,
    /// Number of rows.
    pub height: usize,
    /// Number of columns.
    pub width: usize,
    /// Channel, from 0.
    pub channel: usize,
    /// Mean of the truth.
    pub truth: f64,
    /// Mean of all passes.
    pub mean: f64,
    /// Standard error of the mean: from the claimed variance, else from that of the passes.
    pub standard_error: f64,
    /// (mean − truth) in standard errors; `None` if that is not finite.
    pub z: Option<f64>,
    /// Probability of a difference at least as large for correct passes: by a permutation of two stacks, else from z.
    pub p: Option<f64>,
    /// ln E against the truth.
    pub ln_e: f64,
    /// ln of the evidence against a bias of +ε and of −ε; infinite if such a bias is impossible.
    pub ln_p: [f64; 2],
    /// ε, in units of the picture's mean truth in that channel; `None` if no evidence was possible.
    pub tolerance: Option<f64>,
    /// Number of passes after which it would be decided, as planned for ε; `None` if no number of them suffices.
    pub needed: Option<f64>,
    /// True if it is on the list of suspect tiles.
    pub is_listed: bool,
    /// Verdict on the tile.
    pub verdict: Verdict,
}

/// Cause of a picture that is right on the whole and wrong nearly everywhere.
const MISPLACED: &str = "the whole agrees and the tiles do not: is the picture flipped or transposed, or are the passes not on the first axis?";

/// Maximum number of worst tiles that are listed.
const WORST: usize = 5;

/// Returns the numbers of tiles by their verdicts.
fn counts(tiles: &[Tile]) -> Counts {
    let of = |verdict| tiles.iter().filter(|tile| tile.verdict == verdict).count();
    Counts {
        tiles: tiles.len(),
        pass: of(Verdict::Pass),
        fail: of(Verdict::Fail),
        listed: tiles.iter().filter(|tile| tile.is_listed).count(),
    }
}

/// Returns the tiles with the most evidence against them, of those that fail or are listed; of one place the channel
/// with the most.
fn worst(tiles: &[Tile]) -> Vec<Tile> {
    let is_off = |tile: &&Tile| tile.is_listed || tile.verdict == Verdict::Fail;
    let mut off: Vec<&Tile> = tiles.iter().filter(is_off).collect();
    off.sort_by(|a, b| b.ln_e.total_cmp(&a.ln_e));
    let mut worst: Vec<Tile> = Vec::new();
    for tile in off {
        if worst.len() < WORST && !worst.iter().any(|other| other.is_at(tile)) {
            worst.push(tile.clone());
        }
    }
    worst
}

impl Tile {
    /// Returns whether another tile lies in this one.
    pub fn contains(&self, other: &Self) -> bool {
        let holds = |[first, length]: [usize; 2], [inner, extent]: [usize; 2]| {
            first <= inner && inner + extent <= first + length
        };
        holds([self.row, self.height], [other.row, other.height])
            && holds([self.column, self.width], [other.column, other.width])
    }

    /// Returns whether another tile has the same pixels, perhaps in another channel.
    pub fn is_at(&self, other: &Self) -> bool {
        self.contains(other) && other.contains(self) && self.size == other.size
    }

    /// Returns the evidence on the mean.
    pub(super) fn evidence(&self) -> Evidence {
        Evidence { ln_e: self.ln_e, ln_pass: self.ln_p }
    }
}

impl Judgement {
    /// Returns a judgement before any test.
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
            shown: None,
            whole: Vec::new(),
            tiles: Vec::new(),
            counts: Counts::default(),
            worst: Vec::new(),
        }
    }

    /// Takes over the tiles and the whole picture.
    pub(super) fn take(&mut self, tiles: Vec<Tile>, whole: Vec<Tile>) {
        (self.worst, self.counts) = (worst(&tiles), counts(&tiles));
        (self.tiles, self.whole) = (tiles, whole);
    }

    /// Returns which checks fail, and on which side. Passes that depend on each other have no other side.
    pub fn pattern(&self) -> Pattern {
        let mut pattern = Pattern::default();
        if self.order.is_refuted() {
            pattern.dependence = true;
            return pattern;
        }
        pattern.number = self.refuted_by.is_some();
        if self.variance.is_some_and(|variance| variance.is_refuted) {
            pattern.note(CheckId::Variance, Some(1.0));
        }
        let failing =
            self.whole.iter().chain(&self.tiles).filter(|tile| tile.verdict == Verdict::Fail);
        for tile in failing {
            pattern.note(CheckId::Mean, Some(tile.mean - tile.truth));
        }
        // A mean that deviates moves the variance of pixels that are hit or missed.
        if let Some(shown) = self.shown.as_ref().filter(|_| self.verdict == Verdict::Fail) {
            pattern.note(CheckId::Mean, Some(shown.mean - shown.truth));
        }
        pattern
    }

    /// Returns whether tiles were judged by no ground: their only one is a variance that is refuted, or the passes depend
    /// on each other.
    pub fn is_unjudged(&self) -> bool {
        let is_refuted = self.variance.is_some_and(|variance| variance.is_refuted);
        (is_refuted || self.order.is_refuted()) && self.counts.fail + self.counts.pass == 0
    }

    /// Returns whether pixels are probably in the wrong places: the whole agrees, and most of the smallest tiles are too
    /// bright or too dark, many of either kind.
    pub fn is_misplaced(&self) -> bool {
        let smallest = self.tiles.iter().filter(|tile| tile.size == self.tile);
        let failing = smallest.clone().filter(|tile| tile.verdict == Verdict::Fail);
        let bright = failing.clone().filter(|tile| tile.mean > tile.truth).count();
        let (failing, all) = (failing.count(), smallest.count());
        let is_two_sided = 10 * bright.min(failing - bright) >= all;
        let is_whole_off = self.whole.iter().any(|whole| whole.verdict == Verdict::Fail);
        !is_whole_off && 2 * failing >= all && is_two_sided
    }

    /// Returns the lines that follow a failure: its likely causes.
    pub fn likely(&self) -> Vec<String> {
        if self.is_misplaced() { vec![MISPLACED.to_owned()] } else { self.pattern().lines() }
    }
}
