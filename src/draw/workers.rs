//! Workers: the threads of this process, or those of many processes, draw pieces.

use std::fmt::Debug;

use crate::draw::block::{self, Block};
use crate::draw::share::Piece;
use crate::draw::store::Header;
use crate::plan::{Plan, Planned};
use theory::parallel;

/// Receives the blocks of a piece, after its number: one for each experiment, `None` where the drawing was over.
pub type Take<'a> = dyn Fn(usize, Vec<Option<Block>>) + Sync + 'a;

/// Threads that draw; a block does not depend on the thread.
pub trait Workers: Debug + Send + Sync {
    /// Returns the number of threads.
    fn threads(&self) -> usize;

    /// Compares the draws of all workers with those that a header describes.
    ///
    /// # Errors
    ///
    /// Workers would draw something else: their names, and why.
    fn agree(&self, header: &Header) -> Result<(), String>;

    /// Draws pieces in any order, and hands over the blocks of each.
    fn draw(&self, pieces: &[Piece], drawing: &Drawing, take: &Take);
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

    fn draw(&self, pieces: &[Piece], drawing: &Drawing, take: &Take) {
        parallel::range(pieces.len(), |number| take(number, drawing.draw(&pieces[number])));
    }
}

/// Drawing of a plan, whose experiments are found by their numbers.
pub struct Drawing<'p> {
    plan: &'p Plan<'p>,
    experiments: Vec<&'p Planned>,
    /// Returns whether the drawing shall end.
    pub is_over: &'p (dyn Fn() -> bool + Sync),
}

impl<'p> Drawing<'p> {
    /// Numbers the experiments of a plan.
    pub fn new(plan: &'p Plan, is_over: &'p (dyn Fn() -> bool + Sync)) -> Self {
        let experiments = plan.experiments().map(|(_, planned)| planned).collect();
        Self { plan, experiments, is_over }
    }

    /// Draws a piece in this thread: one block for each experiment, `None` where the drawing is over.
    pub fn draw(&self, piece: &Piece) -> Vec<Option<Block>> {
        let numbers = piece.experiments.iter();
        let group: Vec<&Planned> = numbers.map(|&one| self.experiments[one as usize]).collect();
        block::merged(&group, piece.block, self.plan.options.blocks_per_look, self.is_over)
    }
}
