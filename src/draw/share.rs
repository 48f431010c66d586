//! Blocks of a run, and workers that draw them: the threads of this process, the ranks of many processes, or one machine of
//! many, each with its share.
//!
//! ```text
//! blocks are numbered through the experiments of the plan: number n belongs to part n mod N + 1 of N
//! ```
//!
//! The gate decides when all parts are present, so a part draws its share of all blocks up to the horizon.

use std::fmt::{self, Debug};
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::draw::block::{self, Block};
use crate::draw::store::Header;
use crate::plan::{Plan, PlannedExperiment};
use theory::parallel;

/// Part of a run; `1/1` is the whole run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Share {
    /// Number of the part, from 1.
    pub part: u32,
    /// Number of parts.
    pub of: u32,
}

impl Share {
    /// Whole run.
    pub const WHOLE: Self = Self { part: 1, of: 1 };
}

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}/{}", self.part, self.of)
    }
}

impl FromStr for Share {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').map(|(part, of)| (part.parse(), of.parse()));
        match numbers {
            Some((Ok(part), Ok(of))) if (1..=of).contains(&part) && of <= 1_000_000 => {
                Ok(Self { part, of })
            }
            _ => Err("it takes a part and their number, such as 3/16".into()),
        }
    }
}

/// Name of a block: an experiment by its number in the plan, and the number of the block.
pub type BlockName = (u32, u64);

/// Returns the blocks of a share, in the order of the plan.
pub fn blocks(plan: &Plan, share: Share) -> impl Iterator<Item = BlockName> {
    let drawn = plan.experiments().map(|(_, planned)| planned).filter(|one| one.is_drawn());
    let (step, mut before) = (plan.step(), 0);
    drawn.flat_map(move |planned| {
        let blocks = planned.horizon.div_ceil(step);
        let (part, of) = (u64::from(share.part - 1), u64::from(share.of));
        let first = (part + of - before % of) % of;
        before += blocks;
        (first..blocks).step_by(share.of as usize).map(move |block| (planned.number, block))
    })
}

/// Receives blocks that were drawn; none where the drawing is over.
pub type Take<'a> = dyn Fn(BlockName, Option<Block>) + Sync + 'a;

/// Threads that draw; a block does not depend on the thread.
pub trait Workers: Debug + Send + Sync {
    /// Returns the number of threads.
    fn threads(&self) -> usize;

    /// Compares the draws of all workers with the draws that a header describes.
    ///
    /// # Errors
    ///
    /// Workers would make other draws: their names, and why.
    fn agree(&self, header: &Header) -> Result<(), String>;

    /// Draws blocks in any order, and hands each over.
    fn draw(&self, names: &[BlockName], drawing: &Drawing, take: &Take);
}

/// Threads of this process.
#[derive(Debug, Clone, Copy, Default)]
pub struct Threads;

impl Workers for Threads {
    fn threads(&self) -> usize {
        rayon::current_num_threads()
    }

    fn agree(&self, _: &Header) -> Result<(), String> {
        Ok(())
    }

    fn draw(&self, names: &[BlockName], drawing: &Drawing, take: &Take) {
        parallel::range(names.len(), |number| take(names[number], drawing.draw(names[number])));
    }
}

/// Drawing of a plan; experiments are found by their numbers.
pub struct Drawing<'p> {
    blocks_per_look: u64,
    experiments: Vec<&'p PlannedExperiment>,
    /// Returns whether the drawing shall end.
    pub is_over: &'p (dyn Fn() -> bool + Sync),
}

impl<'p> Drawing<'p> {
    /// Draws experiments of a plan.
    pub fn new(plan: &'p Plan, is_over: &'p (dyn Fn() -> bool + Sync)) -> Self {
        let experiments = plan.experiments().map(|(_, planned)| planned).collect();
        Self { blocks_per_look: plan.options.blocks_per_look, experiments, is_over }
    }

    /// Draws a block in this thread; `None` where the drawing is over.
    pub fn draw(&self, (experiment, block): BlockName) -> Option<Block> {
        let planned = self.experiments[experiment as usize];
        block::merged(planned, block, self.blocks_per_look, self.is_over)
    }
}
