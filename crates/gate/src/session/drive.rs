//! The loop that takes draws from a source to a session.

use std::convert::Infallible;

use super::trial::BUFFER;
use super::{Judgement, Session, Stop, Trial};

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

    /// Adds draws that lie one after the other, each with all its values.
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

    /// Adds the next draws to an empty block, at most `most` of them. Fewer come only at the end, none after it.
    ///
    /// # Errors
    ///
    /// The draws cannot be made or read.
    fn fill(&mut self, block: &mut Block, most: usize) -> Result<(), Self::Error>;
}

/// Draws in memory, of one value each.
impl Source for &[f64] {
    type Error = Infallible;

    fn fill(&mut self, block: &mut Block, most: usize) -> Result<(), Infallible> {
        let (now, later) = self.split_at(most.min(self.len()));
        block.push(&[now], &[]);
        *self = later;
        Ok(())
    }
}

/// A taker of draws.
pub trait Sink {
    /// Number of draws so far.
    fn draws(&self) -> u64;

    /// Whether more draws may change the verdict.
    fn is_open(&self) -> bool;
}

/// End of the draws that are taken from a source.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Until {
    /// Largest number of draws.
    pub most: Option<u64>,
    /// Whether to stop as soon as all is decided.
    pub is_decided: bool,
}

/// Number of draws of the next block, `left` draws before the end.
pub(crate) fn room(left: u64) -> usize {
    usize::try_from(left).map_or(BUFFER, |left| left.min(BUFFER))
}

/// Adds blocks to a taker of draws until it needs no more. `next` adds at most the given number of draws, and returns whether
/// there may be more. Returns why `next` was not called again.
///
/// # Errors
///
/// Those of `next`.
pub fn drive<K: Sink, E>(
    sink: &mut K,
    until: Until,
    mut next: impl FnMut(&mut K, usize) -> Result<bool, E>,
) -> Result<Option<Stop>, E> {
    loop {
        if until.is_decided && !sink.is_open() {
            return Ok(Some(Stop::Decided));
        }
        let left = until.most.map_or(u64::MAX, |most| most.saturating_sub(sink.draws()));
        if left == 0 {
            return Ok(Some(Stop::Limit));
        }
        if !next(sink, room(left))? {
            return Ok(None);
        }
    }
}

impl Session {
    /// Takes draws from a source until it ends, or as far as is wanted, and judges them.
    ///
    /// # Errors
    ///
    /// Those of the source.
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
            // One draw more tells whether anything is left out.
            block.clear();
            source.fill(&mut block, 1)?;
            stopped = stopped.filter(|_| block.draws() > 0);
        }
        let is_all = self.length() == Some(self.draws());
        Ok(self.outcome(stopped.filter(|_| !is_all)))
    }
}

impl Trial {
    /// Takes draws from a source as far as is wanted, and judges them.
    ///
    /// # Errors
    ///
    /// Those of the source.
    pub fn judge<S: Source>(&self, source: &mut S) -> Result<Judgement, S::Error> {
        let mut judged = Session::from(*self).judge(source, self.wanted.until())?;
        Ok(judged.swap_remove(0))
    }

    /// Judges draws that are in memory; there are no lookups with them.
    pub fn judge_all(&self, mut draws: &[f64]) -> Judgement {
        let Ok(judgement) = self.judge(&mut draws);
        judgement
    }
}
