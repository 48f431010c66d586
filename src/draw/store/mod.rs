//! Store of draws: one format and one key for resumed runs, shares, and experiments that earlier runs have finished.
//!
//! An experiment is found by a hash of everything that its draws and decisions depend on ([`Header`]), a block by that
//! key and its number. Blocks that no log has are drawn by [`Workers`], and written into the log of the run.

mod header;
mod log;

use std::collections::BTreeMap;
use std::io::{self, ErrorKind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

pub use self::header::Header;
pub use self::log::{Key, Log, entry, lock};
use crate::draw::block::{Block, Draws, Progress};
use crate::draw::run::{Listener, Step};
use crate::draw::share::{BlockName, Drawing, Threads, Workers};
use crate::plan::{Plan, PlannedExperiment};

/// Largest number of finished experiments that are kept for later runs: some 20 MB.
const MAX_FINISHED: usize = 2000;

/// Bytes of blocks before a log is rewritten: a minimum, and a multiple of the sums that replace them.
const MIN_REWRITE: u64 = 2 << 20;
const REWRITE_RATIO: u64 = 4;

/// Logs that are read and written, and workers that draw what is missing.
#[derive(Debug)]
pub struct Store {
    /// Description of the draws.
    pub header: Header,
    /// Log of this run, or logs of all shares.
    pub logs: Vec<Log>,
    /// True if new blocks are written into the first log.
    pub keeps: bool,
    /// Set to end the drawing.
    pub stop: Arc<AtomicBool>,
    /// Threads or ranks that draw.
    pub workers: Box<dyn Workers>,
    keys: Vec<u64>,
    /// Experiments that earlier runs have finished.
    finished: Option<Log>,
    is_fresh: bool,
    error: Mutex<Option<io::Error>>,
}

impl Default for Store {
    fn default() -> Self {
        Self::new(Header::default())
    }
}

impl Store {
    /// Draws everything by the threads of this process, and keeps nothing.
    pub fn new(header: Header) -> Self {
        Self {
            keys: header.keys(),
            header,
            logs: Vec::new(),
            keeps: false,
            stop: Arc::default(),
            workers: Box::new(Threads),
            finished: None,
            is_fresh: false,
            error: Mutex::default(),
        }
    }

    /// Writes new blocks into a log.
    pub fn journal(
        header: Header,
        log: Log,
        workers: Box<dyn Workers>,
        stop: Arc<AtomicBool>,
    ) -> Self {
        Self { logs: vec![log], keeps: true, stop, workers, ..Self::new(header) }
    }

    /// Reads the logs of all shares.
    pub fn shares(header: Header, logs: Vec<Log>) -> Self {
        Self { logs, ..Self::new(header) }
    }

    /// Opens the experiments that earlier runs have finished; a fresh run adds to them, and does not use them.
    /// Experiments of another program and a damaged file are ignored.
    ///
    /// # Errors
    ///
    /// The system refuses to read the file.
    pub fn reuse(&mut self, path: &Path, is_fresh: bool) -> io::Result<()> {
        self.is_fresh = is_fresh;
        self.finished = match Log::open(path) {
            Ok(log) => Some(log).filter(|log| {
                let header = log.get::<Header>(Key::Header).ok().flatten();
                let is_own = header.is_some_and(|header| header.program == self.header.program);
                is_own && log.damaged_at.is_none()
            }),
            Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::Other) => None,
            Err(error) => return Err(error),
        };
        Ok(())
    }

    /// Writes the experiments that earlier runs and this one have finished, unless a limit cut this one short. If they
    /// are too many, those of earlier runs are dropped.
    ///
    /// # Errors
    ///
    /// The system refuses.
    pub fn finish(&self, path: &Path, draws: &Draws) -> io::Result<()> {
        let mut finished = BTreeMap::new();
        if !draws.cut_by_time && !draws.cut_by_budget {
            for one in draws.experiments.iter().filter(|one| is_reusable(one.planned)) {
                let Some(key) = self.key(one.planned.number) else { continue };
                let drawn = one.drawn.clone();
                finished.insert(key, Progress { drawn, is_done: true, ..Progress::default() });
            }
        }
        let old = self.finished.as_ref().map_or(Vec::new(), Log::keys);
        if let Some(log) = &self.finished
            && old.len() + finished.len() <= MAX_FINISHED
        {
            for key in old {
                if let Key::Progress(experiment) = key
                    && !finished.contains_key(&experiment)
                {
                    finished.extend(log.get(key)?.map(|progress| (experiment, progress)));
                }
            }
        }
        let sums = finished.iter().map(|(&one, progress)| entry(Key::Progress(one), progress));
        let entries = std::iter::once(entry(Key::Header, &self.header)).chain(sums);
        Log::write(path, entries).map(drop)
    }

    /// Returns whether the drawing shall end.
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || locked(&self.error).is_some()
    }

    /// Returns the error of a log that ended the drawing.
    pub fn error(&self) -> Option<io::Error> {
        locked(&self.error).take()
    }

    /// Returns the sums of an experiment, interrupted or finished. An experiment that an interrupted run has begun is
    /// continued, even if another run has finished it.
    pub fn progress(&self, planned: &PlannedExperiment) -> Option<Progress> {
        let key = self.key(planned.number)?;
        let get = |log: &Log| self.noted(log.get(Key::Progress(key))).flatten();
        let own = self.logs.iter().find_map(get);
        if own.is_some() || self.logs.iter().any(|log| log.blocks(Some(key)) > 0) {
            return own;
        }
        let log = self.finished.as_ref().filter(|_| !self.is_fresh && is_reusable(planned))?;
        let mut progress: Progress = log.get(Key::Progress(key)).ok().flatten()?;
        progress.drawn.is_reused = true;
        Some(progress)
    }

    /// Returns how many experiments of a plan need not be drawn, and how many can be.
    pub fn reusable(&self, plan: &Plan) -> [usize; 2] {
        let ready =
            plan.experiments().map(|(_, planned)| planned).filter(|one| one.outcome.is_ok());
        let all = ready.map(|planned| self.progress(planned));
        all.fold([0, 0], |[reused, all], progress| {
            [reused + usize::from(progress.is_some_and(|one| one.drawn.is_reused)), all + 1]
        })
    }

    /// Returns blocks: read where a log has them, else drawn and kept. `listen` is called for all draws.
    pub fn blocks(
        &self,
        names: &[BlockName],
        drawing: &Drawing,
        listen: &Listener,
    ) -> BTreeMap<BlockName, Block> {
        let kept = names.iter().filter_map(|&name| Some((name, self.find(name)?)));
        let blocks: BTreeMap<BlockName, Block> = kept.collect();
        let missing = names.iter().copied().filter(|name| !blocks.contains_key(name));
        let missing: Vec<BlockName> = missing.collect();
        listen(Step::Kept(blocks.values().map(|block| block.draws).sum()));
        let blocks = Mutex::new(blocks);
        if !(drawing.is_over)() {
            self.workers.draw(&missing, drawing, &|name, drawn| {
                let Some(block) = drawn else { return };
                listen(Step::Drawn(block.draws));
                self.keep(name, &block);
                locked(&blocks).insert(name, block);
            });
        }
        blocks.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    /// Rewrites a long log of a run: sums take the place of the blocks that they count.
    pub fn shorten<'a>(&self, experiments: impl Iterator<Item = (u32, &'a Progress)>) {
        let Some(log) = self.journal_log().filter(|log| log.is_long(MIN_REWRITE, REWRITE_RATIO))
        else {
            return;
        };
        let kept: BTreeMap<u64, &Progress> =
            experiments.filter_map(|(number, one)| Some((self.key(number)?, one))).collect();
        let waits = |key| match key {
            Key::Block(one, block) => {
                kept.get(&one).is_none_or(|one| !one.is_done && block >= one.blocks)
            }
            _ => false,
        };
        let sums = kept.iter().map(|(&one, progress)| entry(Key::Progress(one), progress));
        self.noted(log.rewrite(sums, waits));
    }

    /// Waits until the disk has all that is kept.
    pub fn synchronise(&self) {
        self.journal_log().and_then(|log| self.noted(log.synchronise()));
    }

    fn journal_log(&self) -> Option<&Log> {
        self.logs.first().filter(|_| self.keeps)
    }

    fn key(&self, number: u32) -> Option<u64> {
        self.keys.get(number as usize).copied()
    }

    fn find(&self, (number, block): BlockName) -> Option<Block> {
        let key = Key::Block(self.key(number)?, block);
        self.logs.iter().find_map(|log| self.noted(log.get(key)).flatten())
    }

    fn keep(&self, (number, block): BlockName, drawn: &Block) {
        if let (Some(log), Some(key)) = (self.journal_log(), self.key(number)) {
            self.noted(log.put(Key::Block(key, block), drawn));
        }
    }

    /// Remembers the first error.
    fn noted<T>(&self, result: io::Result<T>) -> Option<T> {
        let note = |error| {
            locked(&self.error).get_or_insert(error);
        };
        result.map_err(note).ok()
    }
}

/// Returns whether a later run may use the draws of an experiment. It may not if theory has no moments: 256 draws alone
/// would distinguish one data file from another.
fn is_reusable(planned: &PlannedExperiment) -> bool {
    planned.outcome.as_ref().is_ok_and(|ready| {
        ready.prediction.channels.iter().all(|channel| channel.moments.is_some())
    })
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
