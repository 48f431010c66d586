//! Numbers of a fixed width, one after the other.

use super::rows::Rows;
use super::{Bytes, ForeignError, Layout};
use media::files::npy::Word;

/// How many bytes are asked for at a time: they stay in the second-level cache until converted.
const CHUNK: usize = 1 << 17;

/// A stream of words.
pub(super) struct Words {
    bytes: Bytes,
    file: String,
    word: Word,
    /// How many a header announces; the stream ends there.
    announced: Option<u64>,
    /// How many there are, where it is known.
    length: Option<u64>,
    /// Number of numbers of a draw, for messages.
    pub(super) width: u64,
    given: u64,
    chunk: Vec<u8>,
    /// What is read and not yet given, `chunk[start..end]`.
    start: usize,
    end: usize,
}

/// Opens little-endian float64 without a header; `length` counts the bytes of the file.
pub(super) fn open(
    bytes: Bytes,
    file: &str,
    length: Option<u64>,
    layout: &Layout,
) -> Result<Rows, ForeignError> {
    if layout.column.is_some() {
        return Err(ForeignError::NoColumns { file: file.to_owned() });
    }
    if layout.takes_all() && layout.derived > 0 {
        let channels = layout.channels.join(", ");
        return Err(ForeignError::NoShape { file: file.to_owned(), channels });
    }
    // Draws of several values lie one after the other.
    let width = if layout.takes_all() { layout.channels.len() } else { 1 };
    if let Some(length) = length
        && length % 8 != 0
    {
        let rest = usize::try_from(length % 8).unwrap_or_default();
        return Err(ForeignError::PartialDraw { file: file.to_owned(), whole: length / 8, rest });
    }
    let mut words = Words::new(bytes, file, Word::LittleDouble, None);
    // The first bytes show whether there are any, in a pipe too.
    if words.fill()? == 0 {
        return Err(ForeignError::Empty { file: file.to_owned() });
    }
    words.length = length.map(|bytes| bytes / 8);
    if let Some(numbers) = words.length.filter(|numbers| numbers % width as u64 != 0) {
        return Err(ForeignError::PartialRow { file: file.to_owned(), numbers, values: width });
    }
    Ok(Rows::new(words, width, (0..width).collect(), false))
}

impl Words {
    pub(super) fn new(bytes: Bytes, file: &str, word: Word, announced: Option<u64>) -> Self {
        Self {
            bytes,
            file: file.to_owned(),
            word,
            announced,
            length: announced,
            width: 1,
            given: 0,
            chunk: vec![0; CHUNK],
            start: 0,
            end: 0,
        }
    }

    pub(super) fn known_length(&self) -> Option<u64> {
        self.length
    }

    /// Appends the next numbers, until the buffer holds `at_most`.
    pub(super) fn read(
        &mut self,
        numbers: &mut Vec<f64>,
        at_most: usize,
    ) -> Result<(), ForeignError> {
        let width = self.word.width();
        let before = numbers.len();
        while numbers.len() < at_most {
            let left = self.announced.map_or(u64::MAX, |all| all - self.given);
            let wanted = (at_most - numbers.len()).min(usize::try_from(left).unwrap_or(usize::MAX));
            if wanted == 0 || (self.end - self.start < width && self.fill()? < width) {
                break;
            }
            let count = wanted.min((self.end - self.start) / width);
            let stop = self.start + count * width;
            self.word.convert(&self.chunk[self.start..stop], numbers);
            self.start = stop;
            self.given += count as u64;
        }
        if numbers.len() < at_most && numbers.len() == before { self.check_end() } else { Ok(()) }
    }

    /// Moves what is left to the front and reads on until a word is there or the source ends;
    /// answers how many bytes are there.
    fn fill(&mut self) -> Result<usize, ForeignError> {
        self.chunk.copy_within(self.start..self.end, 0);
        (self.start, self.end) = (0, self.end - self.start);
        while self.end < self.word.width() {
            match self.bytes.read(&mut self.chunk[self.end..]) {
                Ok(0) => break,
                Ok(count) => self.end += count,
                Err(cause) if cause.kind() == std::io::ErrorKind::Interrupted => {}
                Err(cause) => return Err(ForeignError::unreadable(&self.file, cause)),
            }
        }
        Ok(self.end)
    }

    /// That the numbers end within a draw.
    pub(super) fn partial_row(&self, numbers: u64, values: usize) -> ForeignError {
        match self.announced {
            Some(announced) => {
                let (found, expected) = (numbers / values as u64, announced / values as u64);
                ForeignError::Truncated { file: self.file.clone(), found, expected }
            }
            None => ForeignError::PartialRow { file: self.file.clone(), numbers, values },
        }
    }

    /// What is wrong with the end, if anything.
    fn check_end(&mut self) -> Result<(), ForeignError> {
        let rest = if self.end > self.start { self.end - self.start } else { self.fill()? };
        let file = || self.file.clone();
        match self.announced {
            Some(announced) if self.given < announced => {
                let (found, expected) = (self.given / self.width, announced / self.width);
                Err(ForeignError::Truncated { file: file(), found, expected })
            }
            Some(announced) if rest > 0 => {
                let expected = announced / self.width;
                Err(ForeignError::Overlong { file: file(), expected })
            }
            None if rest > 0 => {
                Err(ForeignError::PartialDraw { file: file(), whole: self.given, rest })
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Read, Write};

    use super::super::{Draws, Format, all};
    use super::*;

    /// A pipe that gives three bytes at a time.
    struct Trickle(Cursor<Vec<u8>>);

    impl Read for Trickle {
        fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
            let few = buffer.len().min(3);
            self.0.read(&mut buffer[..few])
        }
    }

    fn bytes(values: &[f64]) -> Vec<u8> {
        values.iter().flat_map(|x| x.to_le_bytes()).collect()
    }

    fn file(bytes: &[u8]) -> tempfile::NamedTempFile {
        let mut file = tempfile::NamedTempFile::new().expect("a file");
        file.write_all(bytes).expect("written");
        file
    }

    #[test]
    fn numbers_come_back_from_file_and_pipe() {
        let mut values: Vec<f64> = (0..50_001).map(|i| f64::from(i).sqrt() - 100.0).collect();
        values[17] = f64::INFINITY;
        let file = file(&bytes(&values));
        let mut draws = Draws::open(file.path(), Format::Raw).expect("draws");
        assert_eq!(draws.known_length(), Some(50_001));
        let mut buffer = vec![f64::NAN; 3];
        assert_eq!(draws.read(&mut buffer, 20_000).expect("draws"), 20_000);
        assert_eq!(buffer, values[..20_000]);
        assert_eq!(all(draws).expect("draws"), values[20_000..]);

        let pipe = Trickle(Cursor::new(bytes(&values)));
        let draws = Draws::from_reader(pipe, "stdin", Format::Raw).expect("draws");
        assert_eq!(draws.known_length(), None);
        assert_eq!(all(draws).expect("draws"), values);
    }

    #[test]
    fn every_bit_survives() {
        let nan = f64::from_bits(0x7ff8_0000_dead_beef);
        let file = file(&bytes(&[nan, -0.0, f64::MIN_POSITIVE / 4.0]));
        let read = all(Draws::open(file.path(), Format::Raw).expect("draws")).expect("draws");
        let bits: Vec<u64> = read.iter().map(|x| x.to_bits()).collect();
        assert_eq!(bits, [nan.to_bits(), 1 << 63, 1 << 50]);
    }

    #[test]
    fn a_partial_draw_is_refused() {
        let message = "2 draws of 8 bytes; write little-endian float64 and nothing else";
        let mut bytes = bytes(&[1.0, 2.0]);
        bytes.extend([1, 2, 3]);
        let file = file(&bytes);
        let error = Draws::open(file.path(), Format::Raw).expect_err("a partial draw").to_string();
        assert!(error.ends_with(message) && error.contains("3 byte(s)"), "{error}");
        let draws = Draws::from_reader(Cursor::new(bytes), "stdin", Format::Raw).expect("draws");
        let error = all(draws).expect_err("a partial draw").to_string();
        assert_eq!(error, format!("stdin: 3 byte(s) are left after {message}"));
    }

    #[test]
    fn nothing_is_no_draws() {
        let error = Draws::from_reader(std::io::empty(), "stdin", Format::Raw);
        assert!(matches!(error, Err(ForeignError::Empty { .. })));
        let file = file(&[]);
        assert!(matches!(Draws::open(file.path(), Format::Raw), Err(ForeignError::Empty { .. })));
    }

    #[test]
    fn what_the_system_refuses_is_said() {
        let error = Draws::open(std::path::Path::new("/nowhere/x.f64"), Format::Raw);
        let error = error.expect_err("no file").to_string();
        assert!(error.starts_with("/nowhere/x.f64: "), "{error}");
    }
}
