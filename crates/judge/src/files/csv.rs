//! Table of text, of which one or several columns are read.
//!
//! ```text
//! T,X          a first line of names is optional, unless the column is chosen by name
//! 0.5,0.25     numbers as 1, 0.5, −1.25e-3, nan, inf; spaces around them do not matter
//! ```
//!
//! Empty lines, and lines that begin with `#`, are no draws.

use ::csv::{ByteRecord, ErrorKind, Reader, ReaderBuilder};

use super::{Bytes, Column, ForeignError, Layout};

/// Maximum number of characters of a wrong field that are shown.
const SHOWN: usize = 40;
/// Maximum number of column names that are shown.
pub(super) const LISTED: usize = 20;

/// An open table.
pub(super) struct CsvTable {
    reader: Reader<Lines>,
    file: String,
    /// Indices of the columns that are read.
    places: Vec<usize>,
    /// Number of columns of the first line.
    columns: u64,
    record: ByteRecord,
    /// Index of the column of lookups, if one is read.
    lookups: Option<usize>,
    /// True if the draw in `record`, with which the table was opened, was not returned yet.
    is_first: bool,
}

impl CsvTable {
    /// Opens a table, finds the columns, and reads its first draw.
    pub(super) fn open(
        bytes: Bytes,
        file: &str,
        layout: &Layout,
        lookups: Option<&Column>,
    ) -> Result<Self, ForeignError> {
        let reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .comment(Some(b'#'))
            .buffer_capacity(CHUNK)
            .from_reader(Lines::new(bytes));
        let record = ByteRecord::new();
        let file_name = file.to_owned();
        let mut table = Self {
            reader,
            file: file_name,
            places: Vec::new(),
            columns: 0,
            record,
            lookups: None,
            is_first: true,
        };
        let empty = || Err(ForeignError::Empty { file: file.to_owned() });
        if !table.advance()? {
            return empty();
        }
        table.columns = table.record.len() as u64;
        let mut named = false;
        if let Some(lookups) = lookups {
            let (place, is_named) = table.choose(Some(lookups))?;
            (table.lookups, named) = (Some(place), is_named);
        }
        let (places, is_named) = table.places(layout)?;
        (table.places, named) = (places, named || is_named);
        if named && !table.advance()? {
            return empty();
        }
        let mut first = vec![0.0; table.places.len()];
        table.draw(&mut first)?;
        Ok(table)
    }

    /// Returns the number of values of a draw.
    pub(super) fn values(&self) -> usize {
        self.places.len()
    }

    /// Appends the next draws with their lookups, until the columns hold `at_most`.
    pub(super) fn read(
        &mut self,
        columns: &mut [Vec<f64>],
        lookups: &mut Vec<f64>,
        at_most: usize,
    ) -> Result<(), ForeignError> {
        let mut draw = vec![0.0; self.places.len()];
        for _ in 0..at_most {
            if !std::mem::take(&mut self.is_first) && !self.advance()? {
                break;
            }
            let count = self.draw(&mut draw)?;
            columns.iter_mut().zip(&draw).for_each(|(column, x)| column.push(*x));
            if self.lookups.is_some() {
                lookups.push(count);
            }
        }
        Ok(())
    }

    /// Finds the columns of a draw; returns whether the first line has names.
    fn places(&self, layout: &Layout) -> Result<(Vec<usize>, bool), ForeignError> {
        if layout.channels.len() < 2 || layout.column.is_some() {
            return self.choose(layout.column.as_ref()).map(|(place, named)| (vec![place], named));
        }
        let names: Vec<String> = self.record.iter().map(text).collect();
        if let Some(places) = layout.named(&names) {
            return Ok((places, true));
        }
        // Names other than those of the channels: columns by their order, without the lookups.
        let own: Vec<usize> = (0..names.len()).filter(|&k| Some(k) != self.lookups).collect();
        let places =
            layout.places(&self.file, own.len(), || layout.mismatch(&self.file, own.len()))?;
        let places: Vec<usize> = places.into_iter().map(|place| own[place]).collect();
        let named = places.iter().any(|&place| self.record.get(place).is_some_and(is_name));
        Ok((places, named))
    }

    /// Finds a column by the first line; returns whether that line has names.
    fn choose(&self, column: Option<&Column>) -> Result<(usize, bool), ForeignError> {
        let file = || self.file.clone();
        let names: Vec<String> = self.record.iter().map(text).collect();
        let listed = || {
            let named = self.record.iter().all(|field| field.is_empty() || is_name(field));
            let word = |k: usize| if named { brief(&names[k]) } else { k.to_string() };
            let rest = names.len().saturating_sub(LISTED);
            let more = (rest > 0).then(|| format!("… {rest} more"));
            (0..names.len().min(LISTED)).map(word).chain(more).collect()
        };
        let count = names.len();
        let place = match column {
            None if count > 1 => {
                let (file, line) = (file(), brief(&names.join(",")));
                let are_digits = |text: &String| text.parse::<u64>().is_ok();
                let is_number = !is_name(names[0].as_bytes());
                return Err(if is_number && line.contains(';') {
                    ForeignError::Separator { file, line, separator: "semicolons" }
                } else if is_number && count == 2 && are_digits(&names[1]) {
                    ForeignError::DecimalComma { file, line }
                } else {
                    ForeignError::ManyColumns { file, count, columns: listed() }
                });
            }
            None => 0,
            Some(&Column::Index(index)) if index < count => index,
            Some(Column::Name(name)) => {
                let mut actual = (0..names.len()).filter(|&k| names[k] == name.trim());
                if let Some(index) = actual.next() {
                    let count = 1 + actual.count();
                    if count > 1 {
                        let name = name.clone();
                        return Err(ForeignError::SameName { file: file(), name, count });
                    }
                    return Ok((index, true));
                }
                if let Some(error) = self.separated(&names[0], Some(name)) {
                    return Err(error);
                }
                let (column, columns) = (Column::Name(name.clone()), listed());
                return Err(ForeignError::NoColumn { file: file(), column, columns });
            }
            Some(column) => {
                let (column, columns) = (column.clone(), listed());
                return Err(ForeignError::NoColumn { file: file(), column, columns });
            }
        };
        Ok((place, self.record.get(place).is_some_and(is_name)))
    }

    /// Reads the next line; false at the end.
    fn advance(&mut self) -> Result<bool, ForeignError> {
        self.reader.get_mut().begin_record();
        self.reader.read_byte_record(&mut self.record).map_err(|error| {
            let cause = match error.into_kind() {
                ErrorKind::Io(cause) if cause.kind() == std::io::ErrorKind::FileTooLarge => {
                    let line = self.reader.position().line();
                    return ForeignError::LongLine {
                        file: self.file.clone(),
                        line,
                        longest: MAX_LINE,
                    };
                }
                ErrorKind::Io(cause) => cause,
                other => std::io::Error::other(format!("{other:?}")),
            };
            ForeignError::unreadable(&self.file, cause)
        })
    }

    /// Returns the error of a table in which something else than commas separates columns: parts of the only field are
    /// numbers, or have the chosen name.
    fn separated(&self, field: &str, required: Option<&str>) -> Option<ForeignError> {
        let separators = [(';', "semicolons"), ('\t', "tabs"), (' ', "blanks")];
        let is_part =
            |part: &str| number(part.as_bytes()).is_some() || Some(part.trim()) == required;
        let is_split =
            |separator: char| field.contains(separator) && field.split(separator).any(is_part);
        let actual = separators.into_iter().find(|(separator, _)| is_split(*separator));
        let (_, separator) = actual.filter(|_| self.columns == 1)?;
        Some(ForeignError::Separator { file: self.file.clone(), line: brief(field), separator })
    }

    /// Appends the values of the draw in the current line; returns its lookups.
    #[inline]
    fn draw(&self, values: &mut [f64]) -> Result<f64, ForeignError> {
        if self.record.len() as u64 != self.columns {
            return Err(self.fault(0));
        }
        let read =
            |place: usize| self.record.get(place).and_then(number).ok_or_else(|| self.fault(place));
        for (value, &place) in values.iter_mut().zip(&self.places) {
            *value = read(place)?;
        }
        self.lookups.map_or(Ok(0.0), read)
    }

    /// Returns the error of the current line, in the column if its number of columns is right.
    #[cold]
    fn fault(&self, column: usize) -> ForeignError {
        let line = self.reader.get_ref().line(self.reader.position().byte());
        let file = self.file.clone();
        let actual = self.record.len() as u64;
        if actual != self.columns {
            return ForeignError::RaggedLine { file, line, actual, expected: self.columns };
        }
        let text = self.record.get(column).map(text).unwrap_or_default();
        let wrong = ForeignError::NotANumber { file, line, column, text: brief(&text) };
        self.separated(&text, None).unwrap_or(wrong)
    }
}

/// Parses a field as a number.
#[inline]
fn number(field: &[u8]) -> Option<f64> {
    std::str::from_utf8(field.trim_ascii()).ok()?.parse().ok()
}

/// Returns whether a field is a name.
fn is_name(field: &[u8]) -> bool {
    number(field).is_none() && !like_a_number(field)
}

/// Returns whether a field begins as numbers do: then it is a malformed number, not a name.
fn like_a_number(field: &[u8]) -> bool {
    let begins = |byte: &u8| byte.is_ascii_digit() || b"+-.".contains(byte);
    field.trim_ascii().first().is_none_or(begins)
}

/// Returns the beginning of a text that may be long.
fn brief(text: &str) -> String {
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// Returns a field as text, to show or to compare.
fn text(field: &[u8]) -> String {
    String::from_utf8_lossy(field.trim_ascii()).into_owned()
}

/// Number of bytes that are read at a time.
const CHUNK: usize = 1 << 17;
/// Longest line: a table of draws has few numbers per line.
const MAX_LINE: u64 = 1 << 16;
/// Maximum number of bytes between two records, quoted lines, comments and empty lines included.
const MAX_GAP: u64 = 1 << 24;

/// Keeps the last bytes it passed on, so that the number of a wrong line can be counted. The csv crate counts the line
/// before instead, after empty lines or Windows' line ends.
struct Lines {
    bytes: Bytes,
    /// Number of lines that ended before the chunk.
    before: u64,
    /// Number of bytes before the chunk.
    start: u64,
    /// Number of bytes since a line ended, and since a record began, which may have quoted line ends.
    since: u64,
    taken: u64,
    chunk: Vec<u8>,
}

impl Lines {
    fn new(bytes: Bytes) -> Self {
        Self { bytes, before: 0, start: 0, since: 0, taken: 0, chunk: Vec::new() }
    }

    /// Begins another record with the next byte.
    fn begin_record(&mut self) {
        self.taken = 0;
    }

    /// Returns the line, from 1 on, that holds the last of the first `end` bytes.
    fn line(&self, end: u64) -> u64 {
        let last = usize::try_from(end.saturating_sub(self.start + 1)).unwrap_or(usize::MAX);
        1 + self.before + ends(&self.chunk[..last.min(self.chunk.len())])
    }
}

impl std::io::Read for Lines {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.since > MAX_LINE || self.taken > MAX_GAP {
            return Err(std::io::ErrorKind::FileTooLarge.into());
        }
        let count = self.bytes.read(buffer)?;
        let last = buffer[..count].iter().rposition(|&byte| byte == b'\n');
        self.since = last.map_or(self.since + count as u64, |at| (count - 1 - at) as u64);
        self.taken += count as u64;
        // At the end of the source the last chunk is kept.
        if count > 0 {
            self.before += ends(&self.chunk);
            self.start += self.chunk.len() as u64;
            self.chunk.clear();
            self.chunk.extend_from_slice(&buffer[..count]);
        }
        Ok(count)
    }
}

/// Returns the number of lines that end within the bytes.
fn ends(bytes: &[u8]) -> u64 {
    // Sums of bytes are fast, and a chunk of 255 cannot overflow one.
    let few = |chunk: &[u8]| chunk.iter().map(|&byte| u8::from(byte == b'\n')).sum::<u8>();
    bytes.chunks(255).map(|chunk| u64::from(few(chunk))).sum()
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::super::{DrawSource, NumberFormat, all};
    use super::*;

    fn table(column: Option<&str>) -> NumberFormat {
        NumberFormat::Csv { column: column.and_then(|column| column.parse().ok()), lookups: None }
    }

    fn read(text: &str, column: Option<&str>) -> Result<Vec<f64>, ForeignError> {
        let reader = Cursor::new(text.as_bytes().to_vec());
        all(DrawSource::from_reader(reader, "x.csv", table(column))?)
    }

    fn error(text: &str, column: Option<&str>) -> String {
        read(text, column).expect_err("an error").to_string()
    }

    #[test]
    fn one_column_needs_neither_name_nor_header() {
        for text in
            ["0.5\n-1e-3\n2\n", "T\n0.5\n-1e-3\n2", "\u{feff}T\r\n 0.5 \r\n-1e-3\r\n\r\n+2\r\n"]
        {
            assert_eq!(read(text, None).expect("draws"), [0.5, -1e-3, 2.0], "{text:?}");
        }
        assert_eq!(read("# numpy.savetxt\n1.0e+00\n", None).expect("draws"), [1.0]);
        let draws = read("nan\n-Infinity\n1e999\n", None).expect("draws");
        assert!(draws[0].is_nan() && draws[1..] == [f64::NEG_INFINITY, f64::INFINITY]);
    }

    #[test]
    fn a_column_is_chosen_by_name_or_by_place() {
        let text = "id,\"T (500 nm)\",X\na,0.5,1\nb,0.25,2\n";
        assert_eq!(read(text, Some("T (500 nm)")).expect("draws"), [0.5, 0.25]);
        assert_eq!(read(text, Some("X")).expect("draws"), [1.0, 2.0]);
        assert_eq!(read(text, Some("2")).expect("draws"), [1.0, 2.0]);
        assert_eq!(read("1,2\n3,4\n", Some("1")).expect("draws"), [2.0, 4.0]);
    }

    #[test]
    fn faults_are_named_with_their_place_and_a_cure() {
        for (text, column, said) in [
            ("T,X\n1,2\n", None, ": 2 columns (T, X); choose one by name or index"),
            ("1,2.5\n", None, ": 2 columns (0, 1); choose"),
            ("T (a;b),X\n1,2\n", None, ": 2 columns (T (a;b), X); choose"),
            ("5,\n", None, ": 2 columns (0, 1); choose"),
            ("0,25\n", None, ": `0,25` is two columns, or a number with a decimal comma; write"),
            ("0,5;1,5\n", None, ": `0,5;1,5` has semicolons between its columns; separate"),
            ("T,X\n1,2\n", Some("Y"), ": no column `Y` among T, X; choose"),
            ("1,2\n", Some("7"), ": no column 7, counted from 0, among 0, 1; choose"),
            ("T,T\n1,2\n", Some("T"), ": 2 columns are called `T`; choose"),
            ("T,X\n1,2\n\n3\n", Some("T"), ", line 4: 1 column where the first line has 2; mend"),
            ("1\n2,5\n", None, ", line 2: 2 columns"),
            ("T,X\n1,2\n3,4x\n", Some("X"), ", line 3, column 1: `4x` is not a number; write it"),
            // A first line that begins as a number does is not a name: no draw is lost.
            ("1.2.3\n1\n", None, ", line 1, column 0: `1.2.3`"),
            ("T\nU\n1\n", None, ", line 2, column 0: `U`"),
            ("1\n\"\"\n", None, ", line 2, column 0: ``"),
        ] {
            let error = error(text, column);
            assert!(error.starts_with(&format!("x.csv{said}")), "{text:?}: {error}");
        }
    }

    #[test]
    fn lines_are_counted_across_line_ends_and_chunks() {
        let line_of = |text: &str| match read(text, None) {
            Err(ForeignError::NotANumber { line, .. }) => line,
            other => panic!("{other:?}"),
        };
        for end in ["\n", "\r\n", "\n\n", "\n# why\n"] {
            let lines = end.matches('\n').count() as u64;
            for draws in [0, 1, 2, 100_000] {
                for start in ["", "\u{feff}"] {
                    for last in ["", "\n", "\r\n1\n"] {
                        let text = format!("{start}{}1x{last}", format!("0.5{end}").repeat(draws));
                        assert_eq!(line_of(&text), lines * draws as u64 + 1, "{end:?} {last:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn no_line_and_no_line_but_names_are_no_draws() {
        for text in ["", "\n\n", "T\n", "# 1\n"] {
            assert_eq!(error(text, None), "x.csv: no draws; write at least one number");
        }
    }

    #[test]
    fn draws_before_a_fault_are_given() {
        let reader = Cursor::new(b"1\n2\nx\n".to_vec());
        let format = table(None);
        let mut draws = DrawSource::from_reader(reader, "x.csv", format).expect("a table");
        let mut buffer = Vec::new();
        assert!(draws.read(&mut buffer, 10).is_err());
        assert_eq!(buffer, [1.0, 2.0]);
        assert_eq!(draws.known_length(), None);
    }

    #[test]
    fn little_of_a_bad_line_is_shown() {
        let long = "x".repeat(60_000);
        let message = error(&format!("1\n{long}\n"), None);
        assert!(message.len() < 200 && message.contains("xxx…"), "{message}");
        let message = error(&format!("{}\n", vec!["1"; 30_000].join(",")), None);
        assert!(message.len() < 200 && message.contains("30000 columns"), "{message}");
        let message = error(&format!("{long},T\n1,2\n"), Some("U"));
        assert!(message.len() < 200, "{message}");
    }

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
            let draws = DrawSource::from_reader(
                reader,
                "x.csv",
                NumberFormat::Csv { column: None, lookups: None },
            );
            let error = draws.and_then(all).expect_err("an endless line").to_string();
            assert!(error.contains("longer than 65536 bytes"), "{error}");
        }
    }
}
