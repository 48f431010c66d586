//! Draws that other code makes and pushes.

use super::builder::{Check, MAX_DRAWS};
use super::outcome::{CheckError, CheckFault, Outcome, assert_pass};
use crate::session::{BUFFER, Block, Session, Sink, Stop, Until, drive, room};
use numeric::rng::{Address, Stream, name_hash};

impl Check<()> {
    /// Judges draws in memory; draws of several values are stored one after the other.
    ///
    /// # Errors
    ///
    /// The properties of the draws are invalid, there are no draws, or the last one is incomplete.
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

    /// Begins to judge draws that come in parts, by [`Pushed::absorb`].
    ///
    /// # Errors
    ///
    /// The properties of the draws are invalid.
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
        let length =
            numbers.map(|numbers| (numbers / values.max(1)) as u64).or(self.said.options.maximum);
        let has_lookups = self.said.has_lookups();
        self.begun(values, has_lookups, length)
    }

    /// Begins to judge draws of `values` values; `length` is the number of draws, if known.
    pub(super) fn begun(
        self,
        values: usize,
        has_lookups: bool,
        length: Option<u64>,
    ) -> Result<Pushed, CheckError> {
        let session = self.session(values, has_lookups, length)?;
        let (block, next, stopped) = (Block::new(values), 0, None);
        Ok(Pushed { check: self, length, has_lookups, session, block, next, stopped })
    }

    /// Numbers that address the blocks of draws.
    fn plan(&self) -> BlockPlan {
        let (seed, experiment) = (self.said.seed, name_hash(&self.name));
        BlockPlan { seed, experiment, maximum: self.said.options.maximum.unwrap_or(MAX_DRAWS) }
    }
}

/// A check that takes draws.
pub struct Pushed {
    check: Check<()>,
    /// Number of draws, where it is known.
    length: Option<u64>,
    /// True if each draw comes with its lookups.
    has_lookups: bool,
    session: Session,
    /// Memory for draws of several values.
    block: Block,
    /// Number of the next block that a source is asked for.
    next: u64,
    /// Reason why a source was asked for no more draws.
    stopped: Option<Stop>,
}

/// Request for a block of draws.
#[derive(Debug, Clone, Copy)]
pub struct BlockRequest {
    /// Number of draws.
    pub draws: usize,
    /// Number of the block, counted from 0.
    pub block: u64,
    pub(super) plan: BlockPlan,
}

impl BlockRequest {
    /// Returns the random stream of the block, which depends on seed, name and number of the block.
    pub fn stream(&self) -> Stream {
        let BlockPlan { seed, experiment, .. } = self.plan;
        Address { seed, experiment, block: self.block, lane: 0 }.stream()
    }

    /// Returns the number of the first draw, counted from 0, where all blocks before are whole.
    pub(super) fn first(&self) -> u64 {
        self.block * BUFFER as u64
    }
}

/// Addresses of the blocks of draws, and their number.
#[derive(Debug, Clone, Copy)]
pub(super) struct BlockPlan {
    pub(super) seed: u64,
    pub(super) experiment: u64,
    pub(super) maximum: u64,
}

impl BlockPlan {
    /// Returns the requests for all blocks.
    pub(super) fn requests(self) -> impl Iterator<Item = BlockRequest> {
        let size = BUFFER as u64;
        (0..self.maximum.div_ceil(size)).map(move |block| BlockRequest {
            draws: room(self.maximum - block * size),
            block,
            plan: self,
        })
    }
}

impl Pushed {
    /// Asks a source for blocks of draws until the verdict is decided, or until the number of [`Check::draws`] is
    /// reached.
    ///
    /// The source adds its draws, and returns whether there may be more. It may add more or fewer than it is asked for.
    /// A later call goes on with the next block.
    ///
    /// # Errors
    ///
    /// The error of the source.
    ///
    /// ```
    /// use trueflight_gate::check::{CheckError, BlockRequest};
    ///
    /// let mut pushed = trueflight_gate::claim("uniform").truth(0.5).range(0.0, 1.0).open()?;
    /// pushed.drive(|pushed, request: BlockRequest| {
    ///     let mut stream = request.stream();
    ///     let draws: Vec<f64> = (0..request.draws).map(|_| stream.uniform()).collect();
    ///     pushed.absorb(&draws)?;
    ///     Ok::<_, CheckError>(true)
    /// })?;
    /// pushed.assert_pass();
    /// # Ok::<(), CheckError>(())
    /// ```
    pub fn drive<E>(
        &mut self,
        mut source: impl FnMut(&mut Self, BlockRequest) -> Result<bool, E>,
    ) -> Result<(), E> {
        let plan = self.check.plan();
        let is_fixed = self.check.said.options.maximum.is_some();
        let until = Until { maximum: Some(plan.maximum), is_decided: !is_fixed };
        let stopped = drive(self, until, |pushed, draws| {
            let request = BlockRequest { draws, block: pushed.next, plan };
            pushed.next += 1;
            source(pushed, request)
        })?;
        // If all requested draws came, nothing is left out.
        self.stopped = stopped.filter(|_| !is_fixed);
        Ok(())
    }

    /// Adds a block of draws by one column for each value.
    pub(super) fn absorb_block(&mut self, block: &Block) {
        self.session.absorb(&block.columns(), &block.lookups);
    }

    /// Adds draws; draws of several values are stored one after the other. Their distribution over calls does not
    /// matter.
    ///
    /// # Errors
    ///
    /// The last draw is incomplete, or the check wants lookups.
    pub fn absorb(&mut self, draws: &[f64]) -> Result<(), CheckError> {
        if self.has_lookups {
            return Err(CheckFault::NoLookups.of(&self.check.name));
        }
        self.push(draws, &[])
    }

    /// Adds draws with the number of lookups of each. They are judged by the case, or without one by [`Check::lookups`]. All
    /// draws come with lookups, or no draw does.
    ///
    /// # Errors
    ///
    /// The last draw is incomplete, there are more or fewer lookups than draws, or draws without lookups came
    /// before.
    pub fn absorb_with_lookups(
        &mut self,
        draws: &[f64],
        lookups: &[f64],
    ) -> Result<(), CheckError> {
        if !self.has_lookups {
            if self.draws() > 0 || !self.check.said.knows_lookups() {
                return Err(CheckFault::NoLookupsWanted.of(&self.check.name));
            }
            // Theory has a claim on lookups: the first draw decides whether they are judged.
            self.session = self.check.session(self.values(), true, self.length)?;
            self.has_lookups = true;
        }
        let (actual, expected) = (lookups.len(), draws.len() / self.values());
        if actual != expected {
            return Err(CheckFault::Lookups { actual, expected }.of(&self.check.name));
        }
        self.push(draws, lookups)
    }

    /// Returns whether more draws may change the verdict: before the announced number of draws, and until all is
    /// decided.
    pub fn is_open(&self) -> bool {
        self.session.is_open()
    }

    /// Number of values of a draw.
    pub fn values(&self) -> usize {
        self.session.values()
    }

    /// Number of draws so far.
    pub fn draws(&self) -> u64 {
        self.session.draws()
    }

    /// Judges all draws.
    ///
    /// # Errors
    ///
    /// There were no draws.
    pub fn verdict(self) -> Result<Outcome, CheckError> {
        if self.draws() == 0 {
            return Err(CheckFault::NoDraws.of(&self.check.name));
        }
        let Self { check, session, stopped, .. } = self;
        let channels = check.said.names(session.values());
        let values = session.outcome(stopped);
        Ok(Outcome { name: check.name, alpha: check.said.options.alpha, channels, values })
    }

    /// Panics unless the draws pass.
    ///
    /// # Panics
    ///
    /// The verdict is fail or inconclusive, or an error.
    #[track_caller]
    pub fn assert_pass(self) {
        assert_pass(&self.verdict());
    }

    /// Adds draws that are stored one after the other.
    fn push(&mut self, draws: &[f64], lookups: &[f64]) -> Result<(), CheckError> {
        let expected = self.values();
        if !draws.len().is_multiple_of(expected) {
            let fault = CheckFault::Ragged { actual: draws.len(), expected };
            return Err(fault.of(&self.check.name));
        }
        if expected == 1 {
            self.session.absorb(&[draws], lookups);
            return Ok(());
        }
        let mut lookups = lookups.chunks(BUFFER);
        for rows in draws.chunks(BUFFER * expected) {
            self.block.clear();
            self.block.push_rows(rows);
            self.session.absorb(&self.block.columns(), lookups.next().unwrap_or_default());
        }
        Ok(())
    }
}

impl Sink for Pushed {
    fn draws(&self) -> u64 {
        self.session.draws()
    }

    fn is_open(&self) -> bool {
        self.session.is_open()
    }
}
