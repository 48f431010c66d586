//! Blocks in a file: what an interrupted run has drawn, and what one machine drew of a run that many share.
//!
//! ```text
//! frames  the header; where experiments stand; the blocks that they do not count yet; the end of a finished share
//! ```
//!
//! A block is written when it is finished, and merged soon after. Where merged blocks take more than four times
//! as much room as the sums that count them, the file of a run is written anew with those sums in place of the blocks: it
//! does not grow with the number of draws. It is synchronised with the disk by a block that comes more than a second
//! after the last time, and where the drawing ends: a machine that loses its power loses what it drew since.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Seek};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::{Deserialize, Serialize};

use crate::draw::block::Block;
use crate::draw::drawn::Standing;
use crate::draw::frames::Frames;
use crate::draw::share::Header;
use media::files;

/// An experiment, counted through the plan, and a block of it.
pub type Key = (u32, u64);

/// What a frame behind the header begins with.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
enum Head {
    /// A block follows.
    Block(Key),
    /// Where this experiment stands follows.
    Standing(u32),
    /// The end of a finished share of so many blocks.
    End(u64),
}

/// The least that merged blocks take before the file is written anew, and how many times the room of the sums.
const LEAST: u64 = 2 << 20;
const TIMES: u64 = 4;

/// What is wrong with a file of blocks.
#[derive(Debug, thiserror::Error)]
pub enum Fault {
    /// The system refuses.
    #[error("cannot {} {}", .1, .0.display())]
    System(PathBuf, &'static str, #[source] io::Error),
    /// It is something else, or its header is damaged.
    #[error("{} is no file of blocks of this version, or its header is damaged", .0.display())]
    Foreign(PathBuf),
    /// What was whole when it was opened is no longer.
    #[error("{} has changed at byte {} since it was opened", .0.display(), .1)]
    Changed(PathBuf, u64),
    /// Somebody else writes it.
    #[error("another run is writing into {}", .0.display())]
    Busy(PathBuf),
}

/// A file of blocks.
#[derive(Debug)]
pub struct Blocks {
    /// Where it is.
    pub path: PathBuf,
    /// What was drawn, and by whom.
    pub header: Header,
    /// The first byte that cannot be used, if there is one.
    pub damaged_at: Option<u64>,
    /// Whether nothing is missing: it ends as a finished share does.
    pub is_finished: bool,
    /// Where experiments stood when it was last written anew before it was opened.
    standings: BTreeMap<u32, Standing>,
    /// Held as long as it is written.
    #[allow(dead_code)] // it is its end that matters
    lock: Lock,
    inside: Mutex<Inside>,
}

/// The right to write the file of blocks of a folder. Nobody else has it meanwhile, where the file system knows locks.
#[derive(Debug, Default)]
pub struct Lock(#[allow(dead_code)] Option<File>); // closing the folder ends it

impl Lock {
    /// Takes it.
    ///
    /// # Errors
    ///
    /// Where somebody else has it.
    pub fn take(folder: &Path) -> Result<Self, Fault> {
        // Some systems let no folder be opened, some file systems have no locks.
        let Ok(file) = File::open(folder) else { return Ok(Self(None)) };
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => Err(Fault::Busy(folder.to_owned())),
            _ => Ok(Self(Some(file))),
        }
    }
}

/// What changes while it is written.
#[derive(Debug)]
struct Inside {
    frames: Frames,
    /// Where the frames of the blocks are that it had when it was opened.
    places: BTreeMap<Key, u64>,
    /// How many blocks it has.
    blocks: u64,
    /// How long it was when it was written anew.
    base: u64,
}

impl Blocks {
    /// Begins a file, in place of any that was there.
    ///
    /// # Errors
    ///
    /// Where the system refuses.
    pub fn create(path: &Path, header: &Header, lock: Lock) -> Result<Self, Fault> {
        let system = |error| Fault::System(path.to_owned(), "write", error);
        write_anew(path, [encoded(header)]).map_err(system)?;
        Self::go_on(path, lock)
    }

    /// Opens a file to write what is missing; what is damaged in it is cut off.
    ///
    /// # Errors
    ///
    /// Where the system refuses, or it is no such file.
    pub fn go_on(path: &Path, lock: Lock) -> Result<Self, Fault> {
        let system = |error| Fault::System(path.to_owned(), "open", error);
        // What a run left that was killed while it wrote it; whoever has the lock is alone.
        let _ = fs::remove_file(beside(path));
        let file = OpenOptions::new().read(true).write(true).open(path).map_err(system)?;
        let blocks = Self { lock, ..Self::scan(path, file)? };
        blocks.inside().frames.cut().map_err(system)?;
        Ok(blocks)
    }

    /// Opens a file to read it.
    ///
    /// # Errors
    ///
    /// Where the system refuses, or it is no such file.
    pub fn open(path: &Path) -> Result<Self, Fault> {
        let file = File::open(path);
        Self::scan(path, file.map_err(|e| Fault::System(path.to_owned(), "open", e))?)
    }

    /// Reads all frames once, and remembers where blocks are.
    fn scan(path: &Path, file: File) -> Result<Self, Fault> {
        let mut header = None;
        let (mut standings, mut places) = (BTreeMap::new(), BTreeMap::new());
        let mut is_finished = false;
        let scanned = Frames::scan(file, |at, content| {
            if header.is_none() {
                header = postcard::from_bytes::<Header>(content).ok();
                return header.is_some();
            }
            let Ok((head, rest)) = postcard::take_from_bytes(content) else { return false };
            // Nothing follows an end, and nothing is there twice.
            !is_finished
                && match head {
                    Head::Block(key) => places.insert(key, at).is_none(),
                    Head::Standing(one) => postcard::from_bytes(rest)
                        .is_ok_and(|standing| standings.insert(one, standing).is_none()),
                    Head::End(blocks) => {
                        is_finished = blocks == places.len() as u64;
                        is_finished
                    }
                }
        });
        let scanned = scanned.map_err(|error| Fault::System(path.to_owned(), "read", error))?;
        let (Some((frames, damaged_at)), Some(header)) = (scanned, header) else {
            return Err(Fault::Foreign(path.to_owned()));
        };
        let (blocks, base) = (places.len() as u64, 0);
        let inside = Mutex::new(Inside { frames, places, blocks, base });
        let path = path.to_owned();
        let lock = Lock::default();
        Ok(Self { path, header, damaged_at, is_finished, standings, lock, inside })
    }

    /// How many blocks it has, beside those that were merged.
    pub fn len(&self) -> u64 {
        self.inside().blocks
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether it had a block when it was opened.
    pub fn has(&self, key: Key) -> bool {
        self.inside().places.contains_key(&key)
    }

    /// Where an experiment stood when the file was last written anew before it was opened.
    pub fn standing(&self, experiment: u32) -> Option<&Standing> {
        self.standings.get(&experiment)
    }

    /// Whether it had anything of an experiment when it was opened.
    pub fn knows(&self, experiment: u32) -> bool {
        let blocks = (experiment, 0)..=(experiment, u64::MAX);
        self.standings.contains_key(&experiment)
            || self.inside().places.range(blocks).next().is_some()
    }

    /// A block that it had when it was opened, its hash checked once more.
    ///
    /// # Errors
    ///
    /// Where the system refuses, or the file has changed since.
    pub fn find(&self, key: Key) -> Result<Option<Block>, Fault> {
        let mut inside = self.inside();
        let Some(&at) = inside.places.get(&key) else { return Ok(None) };
        let content = inside.frames.read(at);
        let content = content.map_err(|error| Fault::System(self.path.clone(), "read", error))?;
        let block =
            content.and_then(|content| postcard::from_bytes::<(Head, Block)>(&content).ok());
        match block {
            Some((head, block)) if head == Head::Block(key) => Ok(Some(block)),
            _ => Err(Fault::Changed(self.path.clone(), at)),
        }
    }

    /// Writes a block at the end.
    ///
    /// # Errors
    ///
    /// Where the system refuses.
    pub fn keep(&self, key: Key, block: &Block) -> Result<(), Fault> {
        let mut inside = self.inside();
        inside.blocks += 1;
        let written = encoded(&(Head::Block(key), block));
        written
            .and_then(|content| inside.frames.write(&content, false))
            .map_err(|e| self.unwritten(e))
    }

    /// Writes the end of a finished share.
    ///
    /// # Errors
    ///
    /// Where the system refuses.
    pub fn finish(&self) -> Result<(), Fault> {
        let mut inside = self.inside();
        let written = encoded(&Head::End(inside.blocks));
        written
            .and_then(|content| inside.frames.write(&content, true))
            .map_err(|e| self.unwritten(e))
    }

    /// Whether merged blocks may take so much room that it is worth to write it anew.
    pub fn is_long(&self) -> bool {
        let inside = self.inside();
        inside.frames.len() > inside.base + LEAST.max(TIMES * inside.base)
    }

    /// Writes it anew: where experiments stand, and the blocks that they do not count yet. Those are handed over where they are in
    /// memory; those that were read from it are kept.
    ///
    /// # Errors
    ///
    /// Where the system refuses; the file is then as it was.
    pub fn rewrite(
        &self,
        standings: &[(u32, &Standing)],
        ahead: &[(Key, &Block)],
    ) -> Result<(), Fault> {
        let counted: BTreeMap<u32, &Standing> = standings.iter().copied().collect();
        let waits = |&(one, block): &Key| {
            counted.get(&one).is_none_or(|standing| !standing.is_done && block >= standing.blocks)
        };
        let keys: Vec<Key> = self.inside().places.keys().copied().filter(waits).collect();
        let in_memory: BTreeSet<Key> = ahead.iter().map(|one| one.0).collect();
        let mut waiting = Vec::new();
        for key in keys.into_iter().filter(|key| !in_memory.contains(key)) {
            waiting.extend(self.find(key)?.map(|block| (key, block)));
        }
        let waiting = waiting.iter().map(|(key, block)| (*key, block));
        let blocks: Vec<(Key, &Block)> = ahead.iter().copied().chain(waiting).collect();
        let contents = std::iter::once(encoded(&self.header))
            .chain(
                standings.iter().map(|(one, standing)| encoded(&(Head::Standing(*one), standing))),
            )
            .chain(blocks.iter().map(|(key, block)| encoded(&(Head::Block(*key), block))));
        let system = |error| self.unwritten(error);
        let file = write_anew(&self.path, contents).map_err(system)?;
        let anew = Self::scan(&self.path, file)?;
        let Inside { frames, places, blocks, .. } =
            anew.inside.into_inner().unwrap_or_else(PoisonError::into_inner);
        let base = frames.len();
        *self.inside() = Inside { frames, places, blocks, base };
        Ok(())
    }

    /// Waits until all of it is on the disk.
    ///
    /// # Errors
    ///
    /// Where the system refuses.
    pub fn synchronise(&self) -> Result<(), Fault> {
        self.inside().frames.synchronise().map_err(|error| self.unwritten(error))
    }

    fn unwritten(&self, error: io::Error) -> Fault {
        Fault::System(self.path.clone(), "write", error)
    }

    fn inside(&self) -> MutexGuard<'_, Inside> {
        self.inside.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Where a file is written anew.
fn beside(path: &Path) -> PathBuf {
    path.with_extension("new")
}

/// Writes a file anew, or leaves it as it was; the answer is the file, at its start.
fn write_anew(
    path: &Path,
    contents: impl IntoIterator<Item = io::Result<Vec<u8>>>,
) -> io::Result<File> {
    let new = beside(path);
    let write = || {
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(true).open(&new)?;
        Frames::begin(file.try_clone()?, contents)?;
        file.rewind()?;
        fs::rename(&new, path)?;
        files::synchronise_folder(path);
        Ok(file)
    };
    let written = write();
    if written.is_err() {
        let _ = fs::remove_file(&new);
    }
    written
}

fn encoded(content: &impl Serialize) -> io::Result<Vec<u8>> {
    postcard::to_stdvec(content).map_err(io::Error::other)
}
