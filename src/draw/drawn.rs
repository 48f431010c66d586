//! What experiments drew: blocks merged in the order of their addresses.

use serde::{Deserialize, Serialize};

use crate::checks::check::Total;
use crate::draw::block::Block;
use crate::plan::Planned;
use gate::stats::Tally;

/// Draws of one experiment.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Drawn {
    /// Number of draws that all of its checks absorbed.
    pub draws: u64,
    /// One tally per channel over the fixed draws, in units of the truth about the predicted mean.
    pub tallies: Vec<Tally>,
    /// The lookups of the fixed draws, about their predicted mean.
    pub lookups: Tally,
    /// One total per question.
    pub totals: Vec<Total>,
    /// Processor seconds.
    pub seconds: f64,
    /// Whether an earlier run drew it.
    #[serde(skip)]
    pub is_reused: bool,
}

/// Where an experiment stands: everything that what is still to be drawn and decided depends on.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Standing {
    /// Draws so far.
    pub drawn: Drawn,
    /// Number of merged blocks.
    pub blocks: u64,
    /// After how many blocks the next look comes.
    pub look: u64,
    /// Whether nothing is left to draw.
    pub is_done: bool,
}

impl Standing {
    /// Before the first block.
    pub fn new(planned: &Planned) -> Self {
        Self { drawn: Drawn::new(planned), look: 1, ..Self::default() }
    }
}

/// Everything that a plan drew.
#[derive(Debug, Clone)]
pub struct Draws {
    /// Per case, per experiment; nothing for refused ones.
    pub cases: Vec<Vec<Drawn>>,
    /// Whether the time limit came first, or the wish to stop.
    pub cut_by_time: bool,
    /// Whether the budget of draws came first.
    pub cut_by_budget: bool,
}

impl Drawn {
    /// Nothing yet.
    pub fn new(planned: &Planned) -> Self {
        let totals = planned.questions.iter().map(|question| question.answer.total());
        let channels = planned.outcome.as_ref().map_or(0, |ready| ready.prediction.channels.len());
        let tallies = vec![Tally::default(); channels];
        Self { totals: totals.collect(), tallies, ..Self::default() }
    }

    /// Adds the block that follows.
    pub fn merge(&mut self, planned: &Planned, block: &Block, number: u64) {
        self.draws += block.draws;
        for (tally, other) in self.tallies.iter_mut().zip(&block.tallies) {
            tally.merge(other);
        }
        self.lookups.merge(&block.lookups);
        let questions = planned.questions.iter().zip(&mut self.totals);
        for ((question, total), numbers) in questions.zip(&block.answers) {
            question.answer.merge(total, numbers, number);
        }
        self.seconds += block.seconds;
    }
}
