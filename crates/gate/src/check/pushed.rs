//! Draws that somebody else makes and pushes.

use super::builder::Check;
use super::error::CheckError;
use super::made::assert_pass;
use super::outcome::Outcome;
use crate::judge::reading::Reading;
use crate::judge::trial::BUFFER;

impl Check<()> {
    /// Judges draws that are in memory; those of several values lie one draw after the other.
    ///
    /// # Errors
    ///
    /// What was said of the draws makes no sense, there are none, or the last one is not whole.
    ///
    /// ```
    /// let halves = [0.25, 0.75].repeat(50_000); // no chance in them: each draw tells the next
    /// let outcome = trueflight_gate::claim("alternating").truth(0.5).range(0.0, 1.0).judge(&halves)?;
    /// assert!(outcome.reason().contains("not independent"));
    /// # Ok::<(), trueflight_gate::check::CheckError>(())
    /// ```
    pub fn judge(self, draws: &[f64]) -> Result<Outcome, CheckError> {
        let mut pushed = self.opened(Some(draws.len()))?;
        pushed.absorb(draws)?;
        pushed.verdict()
    }

    /// Begins to judge draws that come some at a time, by [`Pushed::absorb`].
    ///
    /// # Errors
    ///
    /// What was said of the draws makes no sense.
    ///
    /// ```
    /// let mut pushed = trueflight_gate::claim("coin").truth(0.5).range(0.0, 1.0).open()?;
    /// let mut word = 1u64;
    /// while pushed.is_open() {
    ///     word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
    ///     pushed.absorb(&[f64::from(u8::from(word >> 63 == 1))])?;
    /// }
    /// pushed.verdict()?.assert_pass();
    /// # Ok::<(), trueflight_gate::check::CheckError>(())
    /// ```
    pub fn open(self) -> Result<Pushed, CheckError> {
        self.opened(None)
    }

    fn opened(self, numbers: Option<usize>) -> Result<Pushed, CheckError> {
        let values = self.said.values();
        let length = numbers.map(|numbers| (numbers / values.max(1)) as u64).or(self.said.draws);
        let has_lookups = self.said.has_lookups();
        let readings = self.readings(values, has_lookups, length)?;
        let columns = vec![Vec::with_capacity(BUFFER); values];
        Ok(Pushed { check: self, length, has_lookups, readings, columns, lookups: Vec::new() })
    }
}

/// A check that waits for draws.
pub struct Pushed {
    check: Check<()>,
    /// Number of draws, where it is known.
    length: Option<u64>,
    /// Whether each draw comes with its lookups.
    has_lookups: bool,
    readings: Vec<Reading>,
    /// What does not fill a block yet.
    columns: Vec<Vec<f64>>,
    lookups: Vec<f64>,
}

impl Pushed {
    /// Adds draws; those of several values lie one draw after the other. How many come in one call makes no
    /// difference.
    ///
    /// # Errors
    ///
    /// The last draw is not whole, or the check wants lookups.
    pub fn absorb(&mut self, draws: &[f64]) -> Result<(), CheckError> {
        if self.has_lookups {
            return Err(CheckError::NoLookups { name: self.check.name.clone() });
        }
        self.push(draws, &[])
    }

    /// Adds draws with the number of lookups of each. They are judged by the case, or without one by [`Check::lookups`]. All
    /// draws come with lookups, or no draw does.
    ///
    /// # Errors
    ///
    /// The last draw is not whole, there are more or fewer lookups than draws, or draws without lookups came before.
    pub fn absorb_with_lookups(
        &mut self,
        draws: &[f64],
        lookups: &[f64],
    ) -> Result<(), CheckError> {
        let name = self.check.name.clone();
        if !self.has_lookups {
            if self.draws() > 0 || !self.check.said.knows_lookups() {
                return Err(CheckError::NoLookupsWanted { name });
            }
            // Theory knows them: the first draw tells whether they come.
            self.readings = self.check.readings(self.columns.len(), true, self.length)?;
            self.has_lookups = true;
        }
        let (found, wanted) = (lookups.len(), draws.len() / self.columns.len());
        if found != wanted {
            return Err(CheckError::Lookups { name, found, wanted });
        }
        self.push(draws, lookups)
    }

    /// Whether more draws may change what is said; after that many as were announced, or once all is decided, they
    /// may not.
    pub fn is_open(&self) -> bool {
        self.readings.iter().any(Reading::is_open)
    }

    /// How many values a draw has.
    pub fn values(&self) -> usize {
        self.columns.len()
    }

    /// How many draws there were.
    pub fn draws(&self) -> u64 {
        self.readings[0].draws() + self.columns[0].len() as u64
    }

    /// What is said of all draws.
    ///
    /// # Errors
    ///
    /// There were none.
    pub fn verdict(mut self) -> Result<Outcome, CheckError> {
        if self.draws() == 0 {
            return Err(CheckError::NoDraws { name: self.check.name });
        }
        self.judge_block();
        Ok(self.check.outcome(self.readings, None))
    }

    /// Panics unless the draws pass.
    ///
    /// # Panics
    ///
    /// The verdict is fail or inconclusive, or there is none.
    #[track_caller]
    pub fn assert_pass(self) {
        assert_pass(&self.verdict());
    }

    fn push(&mut self, draws: &[f64], lookups: &[f64]) -> Result<(), CheckError> {
        let wanted = self.columns.len();
        if !draws.len().is_multiple_of(wanted) {
            let (name, found) = (self.check.name.clone(), draws.len());
            return Err(CheckError::Ragged { name, found, wanted });
        }
        let (mut draws, mut lookups) = (draws, lookups);
        while !draws.is_empty() {
            let room = BUFFER - self.columns[0].len();
            let count = room.min(draws.len() / wanted);
            let (now, later) = draws.split_at(count * wanted);
            let (counts, further) = lookups.split_at(count.min(lookups.len()));
            match &mut self.columns[..] {
                // A whole block needs no copy.
                [column] if count == BUFFER => {
                    debug_assert!(column.is_empty());
                    Reading::absorb_values(&mut self.readings, &[now], counts);
                }
                [column] => column.extend_from_slice(now),
                columns => {
                    for draw in now.chunks_exact(wanted) {
                        columns.iter_mut().zip(draw).for_each(|(column, x)| column.push(*x));
                    }
                }
            }
            if !(wanted == 1 && count == BUFFER) {
                self.lookups.extend_from_slice(counts);
            }
            if self.columns[0].len() == BUFFER {
                self.judge_block();
            }
            (draws, lookups) = (later, further);
        }
        Ok(())
    }

    fn judge_block(&mut self) {
        let columns: Vec<&[f64]> = self.columns.iter().map(Vec::as_slice).collect();
        if columns.iter().any(|column| !column.is_empty()) {
            Reading::absorb_values(&mut self.readings, &columns, &self.lookups);
        }
        self.columns.iter_mut().for_each(Vec::clear);
        self.lookups.clear();
    }
}
