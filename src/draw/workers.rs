//! Who draws: the threads of this process, or those of many processes.

use std::fmt::Debug;

use crate::draw::block::{self, Block};
use crate::draw::share::Piece;
use crate::draw::store::Header;
use crate::plan::{Plan, Planned};
use theory::parallel;

/// Takes what was drawn of the piece of a number: a block for each of its experiments, none where the drawing was over.
pub type Take<'a> = dyn Fn(usize, Vec<Option<Block>>) + Sync + 'a;

/// Those who draw. A block is the same whoever draws it.
pub trait Workers: Debug + Send + Sync {
    /// How many threads draw.
    fn threads(&self) -> usize;

    /// Whether all would draw what this header says.
    ///
    /// # Errors
    ///
    /// Who would not, and why.
    fn agree(&self, header: &Header) -> Result<(), String>;

    /// Draws pieces, and hands over what each gives when it is done, in any order.
    fn draw(&self, pieces: &[Piece], drawing: &Drawing, take: &Take);
}

/// The threads of this process.
#[derive(Debug, Clone, Copy, Default)]
pub struct Threads;

impl Workers for Threads {
    fn threads(&self) -> usize {
        rayon::current_num_threads()
    }

    fn agree(&self, _: &Header) -> Result<(), String> {
        Ok(())
    }

    fn draw(&self, pieces: &[Piece], drawing: &Drawing, take: &Take) {
        parallel::range(pieces.len(), |number| take(number, drawing.draw(&pieces[number])));
    }
}

/// The experiments of a plan, drawn by their numbers until that is over.
pub struct Drawing<'p> {
    plan: &'p Plan<'p>,
    experiments: Vec<&'p Planned>,
    /// Whether the drawing shall end.
    pub is_over: &'p (dyn Fn() -> bool + Sync),
}

impl<'p> Drawing<'p> {
    /// Numbers the experiments.
    pub fn new(plan: &'p Plan, is_over: &'p (dyn Fn() -> bool + Sync)) -> Self {
        let experiments = plan.experiments().map(|(_, planned)| planned).collect();
        Self { plan, experiments, is_over }
    }

    /// Draws a piece in this thread: a block for each of its experiments, none where the drawing is over.
    pub fn draw(&self, piece: &Piece) -> Vec<Option<Block>> {
        let numbers = piece.experiments.iter();
        let group: Vec<&Planned> = numbers.map(|&one| self.experiments[one as usize]).collect();
        block::merged(&group, piece.block, self.plan.options.blocks_per_look, self.is_over)
    }
}
