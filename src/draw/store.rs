//! Where a run finds blocks that are drawn already, has others drawn, keeps them, and hears that it shall stop.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::draw::block::Block;
use crate::draw::blocks::{Blocks, Fault, Key};
use crate::draw::drawn::Standing;
use crate::draw::progress::{Listener, Step};
use crate::draw::share::Piece;
use crate::draw::workers::{Drawing, Threads, Workers};

/// Files of blocks: the first is written, if it is a journal; the others are parts that others drew.
#[derive(Debug)]
pub struct Store {
    /// The files.
    pub files: Vec<Blocks>,
    /// Whether new blocks are written into the first file.
    pub keeps: bool,
    /// Set by whoever wants the drawing to end.
    pub stop: Arc<AtomicBool>,
    /// Who draws what the files do not have.
    pub workers: Box<dyn Workers>,
    fault: Mutex<Option<Fault>>,
}

impl Default for Store {
    fn default() -> Self {
        Self {
            files: Vec::new(),
            keeps: false,
            stop: Arc::default(),
            workers: Box::new(Threads),
            fault: Mutex::default(),
        }
    }
}

impl Store {
    /// A file that is written, who draws, and a word that ends the drawing.
    pub fn journal(file: Blocks, workers: Box<dyn Workers>, stop: Arc<AtomicBool>) -> Self {
        Self { files: vec![file], keeps: true, stop, workers, ..Self::default() }
    }

    /// Parts that are read.
    pub fn parts(files: Vec<Blocks>) -> Self {
        Self { files, ..Self::default() }
    }

    /// Whether the drawing shall end.
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || lock(&self.fault).is_some()
    }

    /// What went wrong with a file, and ended the drawing.
    pub fn fault(&self) -> Option<Fault> {
        lock(&self.fault).take()
    }

    /// Where an experiment stood when the run was interrupted.
    pub fn standing(&self, experiment: u32) -> Option<Standing> {
        self.files.iter().find_map(|file| file.standing(experiment).cloned())
    }

    /// The blocks of pieces, in their order: read where they are in a file, drawn and kept otherwise. `listen` is
    /// called with the draws of each piece.
    pub fn blocks(
        &self,
        pieces: &[Piece],
        drawing: &Drawing,
        listen: &Listener,
    ) -> Vec<Vec<Option<Block>>> {
        let kept = |piece: &Piece| -> Vec<Option<Block>> {
            let found = |&one: &u32| self.find((one, piece.block));
            let blocks: Vec<Option<Block>> = piece.experiments.iter().map(found).collect();
            listen(Step::Kept(draws(&blocks)));
            blocks
        };
        let mut blocks: Vec<Vec<Option<Block>>> = pieces.iter().map(kept).collect();
        let mut missing = Vec::new();
        for (number, (piece, blocks)) in pieces.iter().zip(&blocks).enumerate() {
            let both = piece.experiments.iter().zip(blocks);
            let experiments: Vec<u32> =
                both.filter(|(_, block)| block.is_none()).map(|(&one, _)| one).collect();
            if !experiments.is_empty() {
                missing.push((number, Piece { experiments, block: piece.block }));
            }
        }
        if (drawing.is_over)() {
            return blocks;
        }
        let (numbers, asked): (Vec<usize>, Vec<Piece>) = missing.into_iter().unzip();
        let drawn: Vec<Mutex<Vec<Option<Block>>>> =
            asked.iter().map(|_| Mutex::default()).collect();
        self.workers.draw(&asked, drawing, &|number, new| {
            self.keep(&asked[number], &new);
            listen(Step::Drawn(draws(&new)));
            *lock(&drawn[number]) = new;
        });
        for (number, drawn) in numbers.into_iter().zip(drawn) {
            let mut drawn = drawn.into_inner().unwrap_or_else(PoisonError::into_inner).into_iter();
            let gaps = blocks[number].iter_mut().filter(|block| block.is_none());
            gaps.for_each(|gap| *gap = drawn.next().flatten());
        }
        blocks
    }

    /// Writes the file of a run anew where that is worth it: where experiments stand takes the place of their blocks.
    pub fn shorten(&self, standings: &[(u32, &Standing)], ahead: &[(Key, &Block)]) {
        if let ([file, ..], true) = (&self.files[..], self.keeps) {
            self.note(file.rewrite(standings, ahead));
        }
    }

    /// Whether [`Self::shorten`] is worth it.
    pub fn is_long(&self) -> bool {
        self.keeps && self.files.first().is_some_and(Blocks::is_long)
    }

    /// Whether a file has anything of an experiment.
    pub fn knows(&self, experiment: u32) -> bool {
        self.files.iter().any(|file| file.knows(experiment))
    }

    /// Waits until what is kept is on the disk.
    pub fn synchronise(&self) {
        if let ([file, ..], true) = (&self.files[..], self.keeps) {
            self.note(file.synchronise());
        }
    }

    fn find(&self, key: Key) -> Option<Block> {
        self.files.iter().find_map(|file| self.note(file.find(key)).flatten())
    }

    fn keep(&self, piece: &Piece, blocks: &[Option<Block>]) {
        if let ([file, ..], true) = (&self.files[..], self.keeps) {
            for (&one, block) in piece.experiments.iter().zip(blocks) {
                if let Some(block) = block {
                    self.note(file.keep((one, piece.block), block));
                }
            }
        }
    }

    /// Remembers the first fault.
    fn note<T>(&self, result: Result<T, Fault>) -> Option<T> {
        result
            .map_err(|fault| {
                lock(&self.fault).get_or_insert(fault);
            })
            .ok()
    }
}

/// How many draws they are.
fn draws(blocks: &[Option<Block>]) -> u64 {
    blocks.iter().flatten().map(|block| block.draws).sum()
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
