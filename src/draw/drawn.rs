//! What experiments drew: blocks merged in the order of their addresses.

use serde::{Deserialize, Serialize};

use crate::checks::Kind;
use crate::draw::block::{Answer, Block, larger};
use crate::plan::Planned;
use gate::stats::Tally;
use gate::stats::gate::{Decision, Evidence, SUMS};
use numeric::sum::Sum;

/// What one experiment drew.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Drawn {
    /// How many draws all of its questions saw.
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

/// What all blocks say to one question.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Total {
    /// Where the gate stands.
    Gate(GateState),
    /// The sums of a law over the fixed draws.
    Law(Vec<Sum>),
    /// The largest value, and the block where it was found first.
    Largest(f64, u64),
    /// Nothing.
    Silent,
}

/// Where a question of the gate stands.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GateState {
    /// The sums of ψ.
    pub psi: [Sum; SUMS],
    /// The sum of y.
    pub y: Sum,
    /// The mean of y up to the look of the decision, or to the last.
    pub mean: f64,
    /// The evidence at the look of the decision, or at the last.
    pub evidence: Evidence,
    /// The decision.
    pub decision: Decision,
    /// The draws up to that look.
    pub draws: u64,
    /// The draws and ln E at every look up to that one.
    pub path: Vec<(u64, f64)>,
}

/// Where an experiment stands: everything that what is still to be drawn and decided depends on.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Standing {
    /// What it drew.
    pub drawn: Drawn,
    /// How many blocks are merged.
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
        let totals = planned.questions.iter().map(|question| match &question.kind {
            Kind::Scalar(_) => Total::Gate(GateState {
                psi: [Sum::default(); SUMS],
                y: Sum::default(),
                mean: 0.0,
                evidence: Evidence::NONE,
                decision: Decision::Open,
                draws: 0,
                path: Vec::new(),
            }),
            Kind::Law(law) => Total::Law(vec![Sum::default(); law.size()]),
            Kind::Always(_) => Total::Largest(0.0, 0),
            Kind::Inspection(_) | Kind::Untestable(_) => Total::Silent,
        });
        let channels = planned.outcome.as_ref().map_or(0, |ready| ready.prediction.channels.len());
        let tallies = vec![Tally::default(); channels];
        Self { totals: totals.collect(), tallies, ..Self::default() }
    }

    /// Adds the block that follows.
    pub fn merge(&mut self, block: &Block, number: u64) {
        self.draws += block.draws;
        for (tally, other) in self.tallies.iter_mut().zip(&block.tallies) {
            tally.merge(other);
        }
        self.lookups.merge(&block.lookups);
        for (total, answer) in self.totals.iter_mut().zip(&block.answers) {
            match (total, answer) {
                (Total::Gate(state), Answer::Gate(sums, y)) => {
                    state.psi.iter_mut().zip(sums).for_each(|(sum, &x)| sum.add(x));
                    state.y.add(*y);
                }
                (Total::Law(sums), Answer::Law(others)) => {
                    sums.iter_mut().zip(others).for_each(|(sum, &x)| sum.add(x));
                }
                (Total::Largest(most, at), Answer::Largest(other)) => {
                    let largest = larger(*most, *other);
                    if largest.to_bits() != most.to_bits() {
                        (*most, *at) = (largest, number);
                    }
                }
                _ => {}
            }
        }
        self.seconds += block.seconds;
    }
}
