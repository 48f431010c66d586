//! Sessions: draws of one estimator that the gate judges, from any source.
//!
//! A [`Claim`] has the properties of a correct draw: its mean and, if known, its variance, kurtosis and range. A
//! [`Session`] takes draws block by block, from a [`Source`] by [`Session::judge`], from a closure by [`drive`], or
//! by [`Session::absorb`]. It returns a [`Judgement`] for each value of a draw.
//!
//! ```text
//! quantities  mean, variance and lookups, as far as the claim says (`quantity`); drift: the mean from any later block
//!             on, against the truth and against all other draws
//! ε           as asked; else √(27 V/n) for n draws, at most 5 % for the mean, 20 % for the variance and 2 % for the
//!             lookups, by a range alone not below 12 R/n, R its further part; else 1 % for the mean, and for the
//!             others what as many draws see
//! levels      fail at ln E ≥ ln(K/0.8α), K the number of quantities; drift at ln(1/0.2α); with the theory of a case
//!             ln(K/0.6α), and the p-values of the distribution (`theory`) share 0.2α; pass at both ln P ≥ ln(1/β),
//!             β = 0.01; dependence has an α of its own
//! ```
//!
//! Draws are judged in blocks of 2¹⁴, in constant memory. A quantity fails only on grounds that hold (`ground`): a
//! known variance, a range, a bound on the kurtosis. Without any of them it can pass, on an assumption that the
//! verdict names, but not fail. All of that is for independent draws. If `stats::independence`, `stats::replays`,
//! `stats::sequences` or `stats::runs` finds a dependence, the verdict names it, and the mean is not judged. No
//! quantity passes with an obvious difference (`finding`). Draws of variance 0 must all be the truth to rounding. A
//! draw that is not a finite number fails. So does one out of the claimed range, or so far from the truth that the
//! square of the distance overflows.
//!
//! ```
//! use trueflight_gate::session::{Claim, CheckedClaim, Options};
//! use trueflight_gate::stats::verdict::Verdict;
//!
//! // Draws of a fair coin, claimed to be 0.5 on average and to lie in [0, 1].
//! let mut state = 1u64;
//! let draws: Vec<f64> = (0..400_000)
//!     .map(|_| {
//!         state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
//!         f64::from(u8::from(state >> 63 == 1))
//!     })
//!     .collect();
//! let claim = Claim { range: Some([0.0, 1.0]), ..Claim::of_truth(0.5) }.validated()?;
//! let trial = CheckedClaim::new(claim, Options::default(), Some(draws.len() as u64))?;
//! assert_eq!(trial.judge_all(&draws).verdict, Verdict::Pass);
//! # Ok::<(), trueflight_gate::session::ClaimError>(())
//! ```

use std::convert::Infallible;

mod claim;
mod dependence;
mod finding;
mod flights;
mod ground;
mod judgement;
mod planned;
pub mod quantity;
mod reading;
mod reason;
mod scalar;
mod theory;
mod together;
mod verdict;

pub use claim::{BUFFER, CheckedClaim, Claim, ClaimError, Lookups, Options, ROUNDING};
pub use finding::plain_limit;
pub use flights::RayFlights;
pub use judgement::{
    DistributionFinding, DriftFinding, IndependenceFinding, InvalidDraw, Judgement, ScalarFinding,
    Stop,
};
pub use planned::{BlockSums, PlannedQuantity, Trail};
pub use quantity::{Quantity, VarianceBound};
pub use reason::{Missing, Reason, What};
pub use scalar::{Levels, SIDE_SHARE, Scalar, main_share};
pub use theory::{Distribution, TestRequest, Tested, Tests, Theory, TheoryClaims};
pub use together::{AT_THE_END, Joint, LISTED, decide_together};
pub use verdict::{Reasons, beside_variance, is_by_spread, is_off_by_itself};

use reading::Reading;
use theory::Background;

/// Draws that are being judged, with a reading for each value of a draw.
pub struct Session {
    readings: Vec<Reading>,
    /// Draws that do not fill a block yet.
    pending: Block,
}

impl Session {
    /// A session with a claim for each value of a draw; `length` is the number of draws, if known. The values share α
    /// equally. Lookups belong to the draw, and are judged with its first value.
    ///
    /// # Errors
    ///
    /// The settings of the verdict are invalid for a claim.
    pub fn new(
        claims: &[Claim],
        options: Options,
        length: Option<u64>,
        taken: Option<TheoryClaims>,
    ) -> Result<Self, ClaimError> {
        claim::check_alpha(options.alpha)?;
        let options = Options { alpha: options.alpha / claims.len() as f64, ..options };
        let maximum = options.maximum.unwrap_or(u64::MAX);
        // A decision may end the draws earlier.
        let certain = length.map(|length| length.min(maximum)).filter(|_| !options.stop_early);
        let mut background = taken
            .map_or_else(Background::default, |taken| taken.background(&options, claims, certain));
        let reading = |(index, claim): (usize, &Claim)| {
            let lookups = claim.lookups.filter(|_| index == 0);
            let trial = CheckedClaim::new(Claim { lookups, ..*claim }, options, length)?;
            // The first reading tests the draw as a whole.
            Ok(Reading::new(trial, std::mem::take(&mut background)))
        };
        let readings: Result<_, ClaimError> = claims.iter().enumerate().map(reading).collect();
        Ok(Self { readings: readings?, pending: Block::new(claims.len()) })
    }

    /// Number of values of a draw.
    pub fn values(&self) -> usize {
        self.readings.len()
    }

    /// Number of all draws, if it was given.
    fn length(&self) -> Option<u64> {
        self.readings.first().and_then(|reading| reading.trial.length)
    }

    /// Adds draws, a column of numbers for each value, with the number of lookups of each draw or with none. The size of a
    /// call makes no difference.
    pub fn absorb(&mut self, columns: &[&[f64]], lookups: &[f64]) {
        let all = columns.first().map_or(0, |column| column.len());
        let mut at = 0;
        while at < all {
            let count = (BUFFER - self.pending.draws()).min(all - at);
            let part = at..at + count;
            let now: Vec<&[f64]> = columns.iter().map(|column| &column[part.clone()]).collect();
            let lookups = lookups.get(part).unwrap_or_default();
            at += count;
            if count == BUFFER {
                // A whole block needs no copy.
                judge(&mut self.readings, &now, lookups);
                continue;
            }
            self.pending.push(&now, lookups);
            if self.pending.draws() == BUFFER {
                self.judge_pending();
            }
        }
    }

    /// The judgement of each value; `stopped` is the reason if draws are left.
    pub fn outcome(mut self, stopped: Option<Stop>) -> Vec<Judgement> {
        self.judge_pending();
        self.readings.into_iter().map(|reading| reading.close(stopped)).collect()
    }

    fn judge_pending(&mut self) {
        if self.pending.draws() > 0 {
            judge(&mut self.readings, &self.pending.columns(), &self.pending.lookups);
            self.pending.clear();
        }
    }
}

impl Sink for Session {
    fn draws(&self) -> u64 {
        self.readings.first().map_or(0, Reading::draws) + self.pending.draws() as u64
    }

    /// Returns whether more draws may change the verdict.
    fn is_open(&self) -> bool {
        self.readings.iter().any(Reading::is_open)
    }
}

impl From<CheckedClaim> for Session {
    fn from(trial: CheckedClaim) -> Self {
        let readings = vec![Reading::new(trial, Background::default())];
        Self { readings, pending: Block::new(1) }
    }
}

/// Passes a block to the readings of its values. Lookups go to the first.
fn judge(readings: &mut [Reading], columns: &[&[f64]], lookups: &[f64]) {
    if let (Some(first), [block, ..]) = (readings.first_mut(), columns) {
        if let Some(ends) = &mut first.ends {
            // For the tests a flight that leaves is beyond all classes; for everything else it has the ray's
            // length.
            let marked = ends.marked(block);
            if let Some(tests) = &mut first.background.tests {
                tests.absorb(&[&marked.beyond], lookups);
            }
            return first.absorb(&marked.at_end, lookups);
        }
        if let Some(tests) = &mut first.background.tests {
            tests.absorb(columns, lookups);
        }
    }
    for (index, (reading, column)) in readings.iter_mut().zip(columns).enumerate() {
        reading.absorb(column, if index == 0 { lookups } else { &[] });
    }
}

/// Draws: a column of numbers for each value, and the number of lookups of each draw, if it is known.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Block {
    /// The values.
    pub columns: Vec<Vec<f64>>,
    /// The lookups; empty where they are not known.
    pub lookups: Vec<f64>,
}

impl Block {
    /// No draws of `values` values.
    pub fn new(values: usize) -> Self {
        Self { columns: vec![Vec::new(); values], lookups: Vec::new() }
    }

    /// Number of draws.
    pub fn draws(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// Removes all draws.
    pub fn clear(&mut self) {
        self.columns.iter_mut().for_each(Vec::clear);
        self.lookups.clear();
    }

    /// The columns as slices.
    pub fn columns(&self) -> Vec<&[f64]> {
        self.columns.iter().map(Vec::as_slice).collect()
    }

    /// Adds draws.
    pub fn push(&mut self, columns: &[&[f64]], lookups: &[f64]) {
        self.columns.iter_mut().zip(columns).for_each(|(to, from)| to.extend_from_slice(from));
        self.lookups.extend_from_slice(lookups);
    }

    /// Adds draws that are stored one after the other, each with all its values.
    pub fn push_rows(&mut self, draws: &[f64]) {
        if let [column] = &mut self.columns[..] {
            column.extend_from_slice(draws);
            return;
        }
        for draw in draws.chunks_exact(self.columns.len().max(1)) {
            self.columns.iter_mut().zip(draw).for_each(|(column, &x)| column.push(x));
        }
    }
}

/// A source of draws: a file, a list, another program.
pub trait Source {
    /// Reason why the draws end too early.
    type Error;

    /// Adds the next draws to an empty block, at most `maximum` of them. Fewer come only at the end, none after it.
    ///
    /// # Errors
    ///
    /// The draws cannot be made or read.
    fn fill(&mut self, block: &mut Block, maximum: usize) -> Result<(), Self::Error>;
}

/// Draws in memory, of one value each.
impl Source for &[f64] {
    type Error = Infallible;

    fn fill(&mut self, block: &mut Block, maximum: usize) -> Result<(), Infallible> {
        let (now, later) = self.split_at(maximum.min(self.len()));
        block.push(&[now], &[]);
        *self = later;
        Ok(())
    }
}

/// A taker of draws.
pub trait Sink {
    /// Number of draws so far.
    fn draws(&self) -> u64;

    /// Returns whether more draws may change the verdict.
    fn is_open(&self) -> bool;
}

/// End of the draws that are taken from a source.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Until {
    /// Largest number of draws.
    pub maximum: Option<u64>,
    /// True to stop as soon as all is decided.
    pub is_decided: bool,
}

/// Number of draws of the next block, `left` draws before the end.
pub(crate) fn room(left: u64) -> usize {
    usize::try_from(left).map_or(BUFFER, |left| left.min(BUFFER))
}

/// Adds blocks to a taker of draws until it needs no more. `next` adds at most the given number of draws, and
/// returns whether there may be more. Returns the reason why `next` was not called again.
///
/// # Errors
///
/// The errors of `next`.
pub fn drive<K: Sink, E>(
    sink: &mut K,
    until: Until,
    mut next: impl FnMut(&mut K, usize) -> Result<bool, E>,
) -> Result<Option<Stop>, E> {
    loop {
        if until.is_decided && !sink.is_open() {
            return Ok(Some(Stop::Decided));
        }
        let left = until.maximum.map_or(u64::MAX, |maximum| maximum.saturating_sub(sink.draws()));
        if left == 0 {
            return Ok(Some(Stop::Limit));
        }
        if !next(sink, room(left))? {
            return Ok(None);
        }
    }
}

impl Session {
    /// Takes draws from a source until it ends, or up to the limit, and judges them.
    ///
    /// # Errors
    ///
    /// The errors of the source.
    pub fn judge<S: Source>(
        mut self,
        source: &mut S,
        until: Until,
    ) -> Result<Vec<Judgement>, S::Error> {
        let mut block = Block::new(self.values());
        let mut stopped = drive(&mut self, until, |session, draws| {
            block.clear();
            source.fill(&mut block, draws)?;
            session.absorb(&block.columns(), &block.lookups);
            Ok(block.draws() == draws)
        })?;
        if stopped == Some(Stop::Limit) {
            // One more draw shows whether anything is left out.
            block.clear();
            source.fill(&mut block, 1)?;
            stopped = stopped.filter(|_| block.draws() > 0);
        }
        let is_all = self.length() == Some(self.draws());
        Ok(self.outcome(stopped.filter(|_| !is_all)))
    }
}

impl CheckedClaim {
    /// Takes draws from a source up to the limit, and judges them.
    ///
    /// # Errors
    ///
    /// The errors of the source.
    pub fn judge<S: Source>(&self, source: &mut S) -> Result<Judgement, S::Error> {
        let mut judged = Session::from(*self).judge(source, self.options.until())?;
        Ok(judged.swap_remove(0))
    }

    /// Judges draws in memory, without lookups.
    pub fn judge_all(&self, mut draws: &[f64]) -> Judgement {
        let Ok(judgement) = self.judge(&mut draws);
        judgement
    }
}
