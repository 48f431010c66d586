//! The bytes of a table on their way to the csv crate: lines are counted, and none may be endless.

use super::Bytes;

/// How many bytes are asked for at a time.
pub(super) const CHUNK: usize = 1 << 17;
/// The longest line: a table of draws has some numbers to a line.
pub(super) const LONGEST: u64 = 1 << 16;
/// The most bytes between two records, quoted lines, comments and empty lines included.
const MOST: u64 = 1 << 24;

/// Remembers the last bytes it passed on, so that a line can be counted when something is wrong with
/// it: the csv crate's own count is that of the line before, after empty lines or Windows' line ends.
pub(super) struct Lines {
    bytes: Bytes,
    /// How many lines ended before the chunk.
    before: u64,
    /// How many bytes came before the chunk.
    start: u64,
    /// How many bytes came since a line ended, and since a record began, which may have quoted line ends.
    since: u64,
    taken: u64,
    chunk: Vec<u8>,
}

impl Lines {
    pub(super) fn new(bytes: Bytes) -> Self {
        Self { bytes, before: 0, start: 0, since: 0, taken: 0, chunk: Vec::new() }
    }

    /// What is read from now on belongs to another record.
    pub(super) fn begin_record(&mut self) {
        self.taken = 0;
    }

    /// The line, from 1 on, that holds the last of the first `end` bytes.
    pub(super) fn line(&self, end: u64) -> u64 {
        let last = usize::try_from(end.saturating_sub(self.start + 1)).unwrap_or(usize::MAX);
        1 + self.before + ends(&self.chunk[..last.min(self.chunk.len())])
    }
}

impl std::io::Read for Lines {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.since > LONGEST || self.taken > MOST {
            return Err(std::io::ErrorKind::FileTooLarge.into());
        }
        let count = self.bytes.read(buffer)?;
        let last = buffer[..count].iter().rposition(|&byte| byte == b'\n');
        self.since = last.map_or(self.since + count as u64, |at| (count - 1 - at) as u64);
        self.taken += count as u64;
        // At the end of the source the last chunk stays.
        if count > 0 {
            self.before += ends(&self.chunk);
            self.start += self.chunk.len() as u64;
            self.chunk.clear();
            self.chunk.extend_from_slice(&buffer[..count]);
        }
        Ok(count)
    }
}

/// How many lines end within the bytes.
fn ends(bytes: &[u8]) -> u64 {
    // Sums of bytes are fast, and a chunk of 255 cannot overflow one.
    let few = |chunk: &[u8]| chunk.iter().map(|&byte| u8::from(byte == b'\n')).sum::<u8>();
    bytes.chunks(255).map(|chunk| u64::from(few(chunk))).sum()
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::super::{Draws, Format, all};

    #[test]
    fn a_line_without_end_is_refused_before_it_fills_the_memory() {
        struct Endless(u64);
        impl std::io::Read for Endless {
            fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
                buffer.fill(b'1');
                self.0 += buffer.len() as u64;
                assert!(self.0 < 1 << 22, "reads on");
                Ok(buffer.len())
            }
        }
        for first in ["", "0.5\n", "\"1\n1\n"] {
            let reader = std::io::Read::chain(Cursor::new(first.as_bytes().to_vec()), Endless(0));
            let draws =
                Draws::from_reader(reader, "x.csv", Format::Csv { column: None, lookups: None });
            let error = draws.and_then(all).expect_err("an endless line").to_string();
            assert!(error.contains("longer than 65536 bytes"), "{error}");
        }
    }
}
