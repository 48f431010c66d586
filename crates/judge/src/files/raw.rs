//! Numbers of a fixed width, one after the other or in rows with some columns that are read.

use super::bytes::{self, Mistaken};
use super::{Bytes, ForeignError, Layout};
use media::files::number::NumberType;

/// Number of bytes that are read at a time: they stay in the second-level cache until converted.
const CHUNK: usize = 1 << 17;

/// A stream of words.
pub(super) struct Words {
    bytes: Bytes,
    file: String,
    word: NumberType,
    /// Number of words that a header announces; the stream ends there.
    announced: Option<u64>,
    /// Number of words, if it is known.
    length: Option<u64>,
    /// Number of numbers of a draw, for messages.
    width: u64,
    given: u64,
    chunk: Vec<u8>,
    /// Bytes that were read and not yet returned, `chunk[start..end]`.
    start: usize,
    end: usize,
}

/// Opens little-endian numbers without a header; `length` counts the bytes of the file.
pub(super) fn open(
    source: Bytes,
    file: &str,
    length: Option<u64>,
    layout: &Layout,
    word: NumberType,
) -> Result<NumberRows, ForeignError> {
    if layout.column.is_some() {
        return Err(ForeignError::NoColumns { file: file.to_owned() });
    }
    if layout.takes_all() && layout.derived > 0 {
        let channels = layout.channels.join(", ");
        return Err(ForeignError::NoShape { file: file.to_owned(), channels });
    }
    // Draws of several values lie one after the other.
    let width = if layout.takes_all() { layout.channels.len() } else { 1 };
    let size = word.width() as u64;
    if let Some(length) = length
        && length % size != 0
    {
        let rest = usize::try_from(length % size).unwrap_or_default();
        let (whole, width) = (length / size, word.width());
        return Err(ForeignError::PartialDraw { file: file.to_owned(), whole, rest, width });
    }
    let mut words = Words::new(source, file, word, None);
    // The first bytes show whether there are any, in a pipe too.
    if words.fill()? == 0 {
        return Err(ForeignError::Empty { file: file.to_owned() });
    }
    let (first, file) = (&words.chunk[..words.end], file.to_owned());
    match bytes::mistaken(first, word.width()) {
        Some(Mistaken::Single) => return Err(ForeignError::LooksSingle { file }),
        Some(Mistaken::Double) => return Err(ForeignError::LooksDouble { file }),
        Some(Mistaken::Swapped(value)) => return Err(ForeignError::LooksSwapped { file, value }),
        None => {}
    }
    words.length = length.map(|bytes| bytes / size);
    if let Some(numbers) = words.length.filter(|numbers| numbers % width as u64 != 0) {
        return Err(ForeignError::PartialRow { file, numbers, values: width });
    }
    Ok(NumberRows::new(words, width, (0..width).collect(), false))
}

impl Words {
    pub(super) fn new(bytes: Bytes, file: &str, word: NumberType, announced: Option<u64>) -> Self {
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

    fn known_length(&self) -> Option<u64> {
        self.length
    }

    /// Appends the next numbers, until the buffer holds `at_most`.
    fn read(&mut self, numbers: &mut Vec<f64>, at_most: usize) -> Result<(), ForeignError> {
        let width = self.word.width();
        let before = numbers.len();
        while numbers.len() < at_most {
            let left = self.announced.map_or(u64::MAX, |all| all - self.given);
            let required =
                (at_most - numbers.len()).min(usize::try_from(left).unwrap_or(usize::MAX));
            if required == 0 || (self.end - self.start < width && self.fill()? < width) {
                break;
            }
            let count = required.min((self.end - self.start) / width);
            let stop = self.start + count * width;
            self.word.convert(&self.chunk[self.start..stop], numbers);
            self.start = stop;
            self.given += count as u64;
        }
        if numbers.len() < at_most && numbers.len() == before { self.check_end() } else { Ok(()) }
    }

    /// Moves the remaining bytes to the front and reads until there is a word or the source ends; returns the number of
    /// bytes.
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

    /// Returns the error of numbers that end within a draw.
    fn partial_row(&self, numbers: u64, values: usize) -> ForeignError {
        match self.announced {
            Some(announced) => {
                let (actual, expected) = (numbers / values as u64, announced / values as u64);
                ForeignError::Truncated { file: self.file.clone(), actual, expected }
            }
            None => ForeignError::PartialRow { file: self.file.clone(), numbers, values },
        }
    }

    /// Checks that the source ends where it should.
    fn check_end(&mut self) -> Result<(), ForeignError> {
        let rest = if self.end > self.start { self.end - self.start } else { self.fill()? };
        let file = || self.file.clone();
        match self.announced {
            Some(announced) if self.given < announced => {
                let (actual, expected) = (self.given / self.width, announced / self.width);
                Err(ForeignError::Truncated { file: file(), actual, expected })
            }
            Some(announced) if rest > 0 => {
                let expected = announced / self.width;
                Err(ForeignError::Overlong { file: file(), expected })
            }
            None if rest > 0 => {
                let width = self.word.width();
                Err(ForeignError::PartialDraw { file: file(), whole: self.given, rest, width })
            }
            _ => Ok(()),
        }
    }
}

/// Rows of numbers.
pub(super) struct NumberRows {
    words: Words,
    /// Number of numbers in a row.
    width: usize,
    /// The columns that are read.
    places: Vec<usize>,
    /// Numbers that were read and not yet returned.
    row: Vec<f64>,
    /// True if whole columns follow each other: then all numbers are read first.
    by_column: bool,
    /// All numbers, if whole columns follow each other, and the number of rows that were returned.
    all: Option<(Vec<f64>, usize)>,
    /// Number of numbers that were read.
    numbers: u64,
}

impl NumberRows {
    pub(super) fn new(mut words: Words, width: usize, places: Vec<usize>, by_column: bool) -> Self {
        words.width = width as u64;
        Self { words, width, places, row: Vec::new(), by_column, all: None, numbers: 0 }
    }

    /// Returns the number of rows, if it is known.
    pub(super) fn known_length(&self) -> Option<u64> {
        self.words.known_length().map(|numbers| numbers / self.width as u64)
    }

    /// Returns the number of values of a draw.
    pub(super) fn values(&self) -> usize {
        self.places.len()
    }

    /// Appends the next draws to the columns, `at_most` of them.
    pub(super) fn read(
        &mut self,
        columns: &mut [Vec<f64>],
        at_most: usize,
    ) -> Result<(), ForeignError> {
        if let ([column], 1) = (&mut *columns, self.width) {
            return self.words.read(column, at_most);
        }
        if self.by_column {
            return self.read_by_column(columns, at_most);
        }
        self.row.clear();
        self.words.read(&mut self.row, at_most.saturating_mul(self.width))?;
        self.numbers += self.row.len() as u64;
        if !self.row.len().is_multiple_of(self.width) {
            return Err(self.words.partial_row(self.numbers, self.width));
        }
        for row in self.row.chunks_exact(self.width) {
            for (column, &place) in columns.iter_mut().zip(&self.places) {
                column.push(row[place]);
            }
        }
        Ok(())
    }

    fn read_by_column(
        &mut self,
        columns: &mut [Vec<f64>],
        at_most: usize,
    ) -> Result<(), ForeignError> {
        let (all, given) = match &mut self.all {
            Some((all, given)) => (all, given),
            none => {
                let mut all = Vec::new();
                self.words.read(&mut all, usize::MAX)?;
                // A second read finds missing or surplus bytes.
                self.words.read(&mut Vec::new(), usize::MAX)?;
                let (all, given) = none.insert((all, 0));
                (all, given)
            }
        };
        let rows = all.len() / self.width;
        let count = at_most.min(rows - *given);
        for (column, &place) in columns.iter_mut().zip(&self.places) {
            let first = place * rows + *given;
            column.extend_from_slice(&all[first..first + count]);
        }
        *given += count;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Read, Write};

    use super::super::{DrawSource, NumberFormat, all};
    use super::*;

    /// Pipe that returns three bytes at a time.
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
        let mut draws = DrawSource::open(file.path(), NumberFormat::Raw).expect("draws");
        assert_eq!(draws.known_length(), Some(50_001));
        let mut buffer = vec![f64::NAN; 3];
        assert_eq!(draws.read(&mut buffer, 20_000).expect("draws"), 20_000);
        assert_eq!(buffer, values[..20_000]);
        assert_eq!(all(draws).expect("draws"), values[20_000..]);

        let pipe = Trickle(Cursor::new(bytes(&values)));
        let draws = DrawSource::from_reader(pipe, "stdin", NumberFormat::Raw).expect("draws");
        assert_eq!(draws.known_length(), None);
        assert_eq!(all(draws).expect("draws"), values);
    }

    #[test]
    fn single_precision_is_told_from_double() {
        let values: Vec<f32> = (0..500_u16).map(|i| f32::from(i).sqrt() / 30.0).collect();
        let singles =
            |values: &[f32]| -> Vec<u8> { values.iter().flat_map(|x| x.to_le_bytes()).collect() };
        let zeros_and_ones: Vec<f32> = (0..500_u16).map(|i| f32::from(i % 3 / 2)).collect();
        for values in [&values, &zeros_and_ones] {
            let file = file(&singles(values));
            let refused = DrawSource::open(file.path(), NumberFormat::Raw);
            assert!(matches!(refused, Err(ForeignError::LooksSingle { .. })));
            let read = all(DrawSource::open(file.path(), NumberFormat::RawSingle).expect("draws"));
            assert!(read.expect("draws").iter().zip(values).all(|(x, y)| *x == f64::from(*y)));
        }
        // Doubles of all bits, of 24 bits, of few values and of single precision.
        let generator = |bits: u32| {
            let mut state = 1_u64;
            move || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                (state >> 11 >> (53 - bits)) as f64 / f64::from(bits).exp2()
            }
        };
        #[allow(clippy::cast_possible_truncation)] // rounds
        let rounded = |x: &f64| f64::from(*x as f32);
        for bits in [53, 32, 24, 1] {
            let mut next = generator(bits);
            let doubles: Vec<f64> = (0..500).map(|_| next()).collect();
            for doubles in [doubles.clone(), doubles.iter().map(rounded).collect()] {
                let file = file(&bytes(&doubles));
                assert!(DrawSource::open(file.path(), NumberFormat::Raw).is_ok(), "{bits} bits");
            }
        }
    }

    #[test]
    fn every_bit_survives() {
        let nan = f64::from_bits(0x7ff8_0000_dead_beef);
        let file = file(&bytes(&[nan, -0.0, f64::MIN_POSITIVE / 4.0]));
        let read =
            all(DrawSource::open(file.path(), NumberFormat::Raw).expect("draws")).expect("draws");
        let bits: Vec<u64> = read.iter().map(|x| x.to_bits()).collect();
        assert_eq!(bits, [nan.to_bits(), 1 << 63, 1 << 50]);
    }

    #[test]
    fn a_partial_draw_and_no_draw_are_refused() {
        let partial = [bytes(&[1.0, 2.0]), vec![1, 2, 3]].concat();
        let open = |bytes: &[u8]| DrawSource::open(file(bytes).path(), NumberFormat::Raw);
        let read = |bytes: &[u8]| {
            DrawSource::from_reader(Cursor::new(bytes.to_vec()), "stdin", NumberFormat::Raw)
        };
        let is_partial =
            |error| matches!(error, ForeignError::PartialDraw { whole: 2, rest: 3, .. });
        assert!(is_partial(open(&partial).expect_err("a partial draw")));
        assert!(is_partial(read(&partial).and_then(all).expect_err("a partial draw")));
        for none in [open(&[]), read(&[])] {
            assert!(matches!(none, Err(ForeignError::Empty { .. })));
        }
    }
}
