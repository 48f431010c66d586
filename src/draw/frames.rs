//! A file of frames, each of which says whether it and all before it are whole.
//!
//! ```text
//! file   a line of its own, then frames
//! frame  length of the content (u32), content, hash of the frame before it and the content (u64)
//! ```
//!
//! The hashes are a chain: what is torn, cut, flipped, doubled or from another file is found at its first
//! byte, and nothing from there on is used.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::time::{Duration, Instant};

use numeric::rng::hash;

/// The first line of every such file; its number grows with the form.
const FIRST: &[u8] = b"trueflight blocks 2\n";

/// How long frames may wait to be synchronised.
const PATIENCE: Duration = Duration::from_secs(1);

/// The bytes of a length and of a hash; of a frame beside its content.
const LENGTH: usize = size_of::<u32>();
const HASH: usize = size_of::<u64>();
const OVERHEAD: u64 = (LENGTH + HASH) as u64;

/// A file at whose end frames are written.
#[derive(Debug)]
pub struct Frames {
    file: File,
    /// The hash of the last frame.
    last: u64,
    /// Where the last frame ends.
    end: u64,
    synced: Instant,
}

impl Frames {
    /// Begins an empty file with these frames, and synchronises it.
    ///
    /// # Errors
    ///
    /// Where the system refuses.
    pub fn begin(
        file: File,
        contents: impl IntoIterator<Item = io::Result<Vec<u8>>>,
    ) -> io::Result<Self> {
        let mut writer = BufWriter::new(&file);
        writer.write_all(FIRST)?;
        let (mut last, mut end) = (hash(FIRST), FIRST.len() as u64);
        for content in contents {
            let (bytes, hash) = frame(last, &content?);
            writer.write_all(&bytes)?;
            (last, end) = (hash, end + bytes.len() as u64);
        }
        writer.flush()?;
        drop(writer);
        file.sync_data()?;
        Ok(Self { file, last, end, synced: Instant::now() })
    }

    /// Reads the frames of a file as long as `visit`, which gets the place and the content of each, takes them; and where the first
    /// byte is that is not taken, if there is one. `None` if it is no such file.
    ///
    /// # Errors
    ///
    /// Where the system refuses.
    pub fn scan(
        file: File,
        mut visit: impl FnMut(u64, &[u8]) -> bool,
    ) -> io::Result<Option<(Self, Option<u64>)>> {
        let length = file.metadata()?.len();
        let mut reader = BufReader::new(&file);
        let mut first = Vec::new();
        reader.by_ref().take(FIRST.len() as u64).read_to_end(&mut first)?;
        if first != FIRST {
            return Ok(None);
        }
        let (mut end, mut last) = (FIRST.len() as u64, hash(FIRST));
        while let Some((content, hash)) = read_frame(&mut reader, length - end, last)? {
            if !visit(end, &content) {
                break;
            }
            (end, last) = (end + OVERHEAD + content.len() as u64, hash);
        }
        let damaged_at = (end < length).then_some(end);
        Ok(Some((Self { file, last, end, synced: Instant::now() }, damaged_at)))
    }

    /// Cuts off what follows the last frame.
    ///
    /// # Errors
    ///
    /// Where the system refuses.
    pub fn cut(&self) -> io::Result<()> {
        self.file.set_len(self.end)
    }

    /// How long it is.
    pub fn len(&self) -> u64 {
        self.end
    }

    /// The content of the frame at a place that [`Self::scan`] has seen; `None` if it has changed since.
    ///
    /// # Errors
    ///
    /// Where the system refuses.
    pub fn read(&mut self, at: u64) -> io::Result<Option<Vec<u8>>> {
        // The hash of the frame before it ends where it begins.
        self.file.seek(SeekFrom::Start(at - HASH as u64))?;
        let mut before = [0; HASH];
        self.file.read_exact(&mut before)?;
        let left = self.file.metadata()?.len().saturating_sub(at);
        let found = read_frame(&mut self.file, left, u64::from_le_bytes(before))?;
        Ok(found.map(|(content, _)| content))
    }

    /// Writes a frame at the end. It is handed to the system at once, so that a killed process loses none, and
    /// synchronised where that is asked, or was done more than a second ago.
    ///
    /// # Errors
    ///
    /// Where the system refuses.
    pub fn write(&mut self, content: &[u8], is_synced: bool) -> io::Result<()> {
        let (bytes, hash) = frame(self.last, content);
        self.file.seek(SeekFrom::Start(self.end))?;
        self.file.write_all(&bytes)?;
        (self.last, self.end) = (hash, self.end + bytes.len() as u64);
        if is_synced || self.synced.elapsed() > PATIENCE {
            self.synchronise()?;
        }
        Ok(())
    }

    /// Waits until all is on the disk.
    ///
    /// # Errors
    ///
    /// Where the system refuses.
    pub fn synchronise(&mut self) -> io::Result<()> {
        self.file.sync_data()?;
        self.synced = Instant::now();
        Ok(())
    }
}

/// A frame after one of hash `last`, and its own hash.
fn frame(last: u64, content: &[u8]) -> (Vec<u8>, u64) {
    let hash = chained(last, content);
    #[allow(clippy::cast_possible_truncation)] // a block has some thousand sums
    let length = content.len() as u32;
    ([&length.to_le_bytes()[..], content, &hash.to_le_bytes()].concat(), hash)
}

/// The content and the hash of the next frame, of which `left` bytes are there; `None` if it is not whole.
fn read_frame(reader: &mut impl Read, left: u64, last: u64) -> io::Result<Option<(Vec<u8>, u64)>> {
    let mut length = [0; LENGTH];
    if left < OVERHEAD {
        return Ok(None);
    }
    reader.read_exact(&mut length)?;
    let length = u32::from_le_bytes(length);
    if u64::from(length) > left - OVERHEAD {
        return Ok(None);
    }
    let (mut content, mut found) = (vec![0; length as usize], [0; HASH]);
    reader.read_exact(&mut content)?;
    reader.read_exact(&mut found)?;
    let hash = chained(last, &content);
    Ok((found == hash.to_le_bytes()).then_some((content, hash)))
}

fn chained(last: u64, content: &[u8]) -> u64 {
    last.rotate_left(1) ^ hash(content)
}
