//! Log: a file of entries that are found by their keys, and that are whole or not there.
//!
//! ```text
//! file   a line of its own, then frames
//! frame  length of the content (u32), content (key and value), hash of the content (u64)
//! ```
//!
//! Frames behind the first one that is torn, cut, flipped or doubled are not used. Frames of other draws have other
//! keys. An entry is written at once, so that a killed process loses none; the disk is synchronised at most once a
//! second. Errors are those of the system, with the path and the operation, and files that are not logs. After an error
//! while a log is written or rewritten the file is as it was before.

#![allow(clippy::missing_errors_doc)] // the page tells all of them

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize, de::DeserializeOwned};

use media::files;
use numeric::rng::hash;

/// Key of an entry; experiments have the keys of [`Header`](super::Header).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Key {
    /// Description of the draws: the first entry of each log.
    Header,
    /// Block of an experiment, and its number.
    Block(u64, u64),
    /// Sums of an experiment.
    Progress(u64),
    /// End of a finished share, with its number of blocks.
    End,
}

/// First line of every log; the number grows with the format.
const FIRST: &[u8] = b"trueflight blocks 1\n";

/// Bytes of a length and of a hash, and of a frame beside its content.
const LENGTH: usize = size_of::<u32>();
const HASH: usize = size_of::<u64>();
const OVERHEAD: u64 = (LENGTH + HASH) as u64;

/// Longest time between two synchronisations with the disk while entries are written.
const MAX_UNSYNCED: Duration = Duration::from_secs(1);

/// Log, open.
#[derive(Debug)]
pub struct Log {
    /// Path of the file.
    pub path: PathBuf,
    /// First byte that cannot be used, if there is one.
    pub damaged_at: Option<u64>,
    inside: Mutex<Inside>,
    /// Lock of the folder.
    #[allow(dead_code)] // held as long as the log is open
    lock: Option<File>,
}

/// State that writing changes.
#[derive(Debug)]
struct Inside {
    file: File,
    /// Length of the file, and its length when it was last rewritten.
    end: u64,
    base: u64,
    places: BTreeMap<Key, u64>,
    synced: Instant,
}

/// Locks a folder, where the file system has locks: no other process writes a log there meanwhile.
pub fn lock(folder: &Path) -> io::Result<Option<File>> {
    // Some systems let no folder be opened, some file systems have no locks.
    let Ok(file) = File::open(folder) else { return Ok(None) };
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => {
            let busy = format!("another run is writing into {}", folder.display());
            Err(io::Error::new(io::ErrorKind::ResourceBusy, busy))
        }
        _ => Ok(Some(file)),
    }
}

/// Encodes an entry.
pub fn entry(key: Key, value: &impl Serialize) -> io::Result<Vec<u8>> {
    postcard::to_stdvec(&(key, value)).map_err(io::Error::other)
}

impl Log {
    /// Writes a log, in place of any that was there; each entry comes from [`entry`], the header first.
    pub fn write(
        path: &Path,
        entries: impl IntoIterator<Item = io::Result<Vec<u8>>>,
    ) -> io::Result<File> {
        let new = beside(path);
        let write = || {
            let mut file =
                OpenOptions::new().read(true).write(true).create(true).truncate(true).open(&new)?;
            let mut writer = BufWriter::new(&file);
            writer.write_all(FIRST)?;
            for content in entries {
                writer.write_all(&frame(&content?))?;
            }
            writer.flush()?;
            drop(writer);
            file.sync_data()?;
            file.rewind()?;
            fs::rename(&new, path)?;
            files::synchronise_folder(path);
            Ok(file)
        };
        write().map_err(|error| {
            let _ = fs::remove_file(&new);
            failed_to("write", path)(error)
        })
    }

    /// Opens a log to write into it, and cuts off damaged frames.
    pub fn resume(path: &Path, lock: Option<File>) -> io::Result<Self> {
        // A run that was killed while it rewrote the file left it; the lock excludes other processes.
        let _ = fs::remove_file(beside(path));
        let file = OpenOptions::new().read(true).write(true).open(path);
        let log = Self { lock, ..Self::scan(path, file.map_err(failed_to("open", path))?)? };
        let inside = log.inside();
        inside.file.set_len(inside.end).map_err(failed_to("write", path))?;
        drop(inside);
        Ok(log)
    }

    /// Opens a log to read it.
    pub fn open(path: &Path) -> io::Result<Self> {
        Self::scan(path, File::open(path).map_err(failed_to("open", path))?)
    }

    /// Reads all frames once, and remembers the places of entries.
    fn scan(path: &Path, file: File) -> io::Result<Self> {
        let mut places = BTreeMap::new();
        let mut scan = || {
            let length = file.metadata()?.len();
            let mut reader = BufReader::new(&file);
            let mut first = Vec::new();
            reader.by_ref().take(FIRST.len() as u64).read_to_end(&mut first)?;
            let mut end = FIRST.len() as u64;
            while first == FIRST
                && let Some(content) = read_frame(&mut reader, length - end)?
            {
                // The header comes first, nothing follows an end, and nothing is there twice.
                let key = postcard::take_from_bytes(&content).map(|(key, _)| key);
                let is_sound = key.is_ok_and(|key| {
                    (key == Key::Header) == places.is_empty()
                        && !places.contains_key(&Key::End)
                        && places.insert(key, end).is_none()
                });
                if !is_sound {
                    break;
                }
                end += OVERHEAD + content.len() as u64;
            }
            Ok((end, (end < length).then_some(end)))
        };
        let (end, damaged_at) = scan().map_err(failed_to("read", path))?;
        if places.is_empty() {
            let wrong = "is no file of blocks of this version, or its header is damaged";
            return Err(io::Error::other(format!("{} {wrong}", path.display())));
        }
        let inside = Inside { file, end, base: 0, places, synced: Instant::now() };
        Ok(Self { path: path.to_owned(), damaged_at, inside: Mutex::new(inside), lock: None })
    }

    /// Returns the keys of all entries.
    pub fn keys(&self) -> Vec<Key> {
        self.inside().places.keys().copied().collect()
    }

    /// Returns whether there is an entry.
    pub fn has(&self, key: Key) -> bool {
        self.inside().places.contains_key(&key)
    }

    /// Returns the number of blocks, of one experiment or of all.
    pub fn blocks(&self, experiment: Option<u64>) -> usize {
        let [from, to] = experiment.map_or([0, u64::MAX], |one| [one; 2]);
        self.inside().places.range(Key::Block(from, 0)..=Key::Block(to, u64::MAX)).count()
    }

    /// Reads an entry; its hash is checked once more.
    pub fn get<T: DeserializeOwned>(&self, key: Key) -> io::Result<Option<T>> {
        let Some(content) = self.inside().read(&self.path, key)? else { return Ok(None) };
        let decoded = postcard::from_bytes::<(Key, T)>(&content).map_err(io::Error::other);
        Ok(Some(decoded.map_err(failed_to("read", &self.path))?.1))
    }

    /// Appends an entry.
    pub fn put(&self, key: Key, value: &impl Serialize) -> io::Result<()> {
        let mut inside = self.inside();
        let written = entry(key, value).and_then(|content| inside.write(key, &content));
        written.map_err(failed_to("write", &self.path))
    }

    /// Returns whether the file is longer than `min`, and than `ratio` times what it was when it was last rewritten.
    pub fn is_long(&self, min: u64, ratio: u64) -> bool {
        let inside = self.inside();
        inside.end > inside.base + min.max(ratio * inside.base)
    }

    /// Rewrites the file with these entries and with those of its own that are kept.
    pub fn rewrite(
        &self,
        entries: impl Iterator<Item = io::Result<Vec<u8>>>,
        is_kept: impl Fn(Key) -> bool,
    ) -> io::Result<()> {
        let mut inside = self.inside();
        let kept: Vec<Key> = inside.places.keys().copied().filter(|&key| is_kept(key)).collect();
        let header = inside.read(&self.path, Key::Header)?;
        let kept = kept.into_iter().filter_map(|key| inside.read(&self.path, key).transpose());
        let entries = header.map(Ok).into_iter().chain(entries).chain(kept);
        let file = Self::write(&self.path, entries)?;
        let new = Self::scan(&self.path, file)?.inside.into_inner();
        let new = new.unwrap_or_else(PoisonError::into_inner);
        *inside = Inside { base: new.end, ..new };
        Ok(())
    }

    /// Waits until the disk has all entries.
    pub fn synchronise(&self) -> io::Result<()> {
        self.inside().synchronise().map_err(failed_to("write", &self.path))
    }

    fn inside(&self) -> MutexGuard<'_, Inside> {
        self.inside.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Inside {
    /// Reads the content of an entry.
    fn read(&mut self, path: &Path, key: Key) -> io::Result<Option<Vec<u8>>> {
        let Some(&at) = self.places.get(&key) else { return Ok(None) };
        let mut read = || {
            self.file.seek(SeekFrom::Start(at))?;
            let left = self.file.metadata()?.len().saturating_sub(at);
            read_frame(&mut self.file, left)
        };
        let content = read().map_err(failed_to("read", path))?;
        let changed = || format!("{} has changed at byte {at} since it was opened", path.display());
        content.map(Some).ok_or_else(|| io::Error::other(changed()))
    }

    /// Writes an entry at the end.
    fn write(&mut self, key: Key, content: &[u8]) -> io::Result<()> {
        let bytes = frame(content);
        self.file.seek(SeekFrom::Start(self.end))?;
        self.file.write_all(&bytes)?;
        self.places.insert(key, self.end);
        self.end += bytes.len() as u64;
        if self.synced.elapsed() > MAX_UNSYNCED { self.synchronise() } else { Ok(()) }
    }

    fn synchronise(&mut self) -> io::Result<()> {
        self.file.sync_data()?;
        self.synced = Instant::now();
        Ok(())
    }
}

/// Adds the path and the operation to an error.
fn failed_to(doing: &str, path: &Path) -> impl Fn(io::Error) -> io::Error {
    let what = format!("cannot {doing} {}", path.display());
    move |error| io::Error::new(error.kind(), format!("{what}: {error}"))
}

/// Returns where a log is rewritten, before it is renamed.
fn beside(path: &Path) -> PathBuf {
    path.with_extension("new")
}

fn frame(content: &[u8]) -> Vec<u8> {
    #[allow(clippy::cast_possible_truncation)] // a block has some thousand sums
    let length = content.len() as u32;
    [&length.to_le_bytes()[..], content, &hash(content).to_le_bytes()].concat()
}

/// Reads the content of the next frame, with `left` bytes to the end; `None` if it is not whole.
fn read_frame(reader: &mut impl Read, left: u64) -> io::Result<Option<Vec<u8>>> {
    let (mut length, mut result) = ([0; LENGTH], [0; HASH]);
    if left < OVERHEAD {
        return Ok(None);
    }
    reader.read_exact(&mut length)?;
    let length = u32::from_le_bytes(length);
    if u64::from(length) > left - OVERHEAD {
        return Ok(None);
    }
    let mut content = vec![0; length as usize];
    reader.read_exact(&mut content)?;
    reader.read_exact(&mut result)?;
    Ok((result == hash(&content).to_le_bytes()).then_some(content))
}
