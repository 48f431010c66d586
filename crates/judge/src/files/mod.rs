//! Draws that another program wrote: numbers in a file or a pipe, read in constant memory.
//!
//! ```text
//! csv, txt       one number a line, or columns of a table separated by commas
//! npy            float32 or float64 of either byte order, of shape (draws) or (draws, values)
//! f64, bin, raw  little-endian float64, nothing else; several values of a draw follow each other
//! f32            the same in float32
//! ```
//!
//! NaN and ∞ are read as they are: the gate judges them. A file that is not a list of numbers is a [`ForeignError`];
//! nothing is skipped.

mod bytes;
mod csv;
mod layout;
mod npy;
mod raw;

use std::convert::Infallible;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::str::FromStr;

pub use layout::Layout;

use super::{BUFFER, Block, Source};
use media::files::number::NumberType;
use media::formats;
use numeric::digits::counted;

/// Format of numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum NumberFormat {
    /// A table of text, columns separated by commas.
    Csv {
        /// Column to read; a table of one column needs no choice.
        column: Option<Column>,
        /// Column with the lookups of a draw, if any.
        lookups: Option<Column>,
    },
    /// `NumPy`'s array file.
    Npy,
    /// Little-endian float64.
    Raw,
    /// Little-endian float32.
    RawSingle,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Column {
    /// By its name in the first line.
    Name(String),
    /// By its place; the first is 0.
    Index(usize),
}

impl FromStr for Column {
    type Err = Infallible;

    /// A whole number is a place, anything else a name.
    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(text.parse().map_or_else(|_| Self::Name(text.to_owned()), Self::Index))
    }
}

impl std::fmt::Display for Column {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Name(name) => write!(f, "column `{name}`"),
            Self::Index(index) => write!(f, "column {index}, counted from 0,"),
        }
    }
}

impl NumberFormat {
    /// Returns the format of a file's ending; `None` for an unknown ending.
    pub fn of_path(path: &Path) -> Option<Self> {
        Some(match formats::Format::of(path)? {
            formats::Format::Table => Self::Csv { column: None, lookups: None },
            formats::Format::Npy => Self::Npy,
            formats::Format::Doubles => Self::Raw,
            formats::Format::Singles => Self::RawSingle,
            _ => return None,
        })
    }
}

/// Source of bytes.
type Bytes = Box<dyn Read + Send>;

/// An open source of draws.
pub struct DrawSource {
    source: DrawReader,
}

enum DrawReader {
    Csv(Box<csv::CsvTable>),
    Rows(Box<raw::NumberRows>),
}

impl std::fmt::Debug for DrawSource {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Draws").field("known_length", &self.known_length()).finish_non_exhaustive()
    }
}

impl DrawSource {
    /// Opens a file.
    ///
    /// # Errors
    ///
    /// The file cannot be read, holds no draws, is not of this format, or its length shows that it
    /// is cut off.
    pub fn open(path: &Path, format: NumberFormat) -> Result<Self, ForeignError> {
        Self::open_as(path, format, &Layout::default())
    }

    /// Opens a file with several values per draw, or with several columns.
    ///
    /// # Errors
    ///
    /// The errors of [`DrawSource::open`], and files with other columns.
    pub fn open_as(
        path: &Path,
        format: NumberFormat,
        layout: &Layout,
    ) -> Result<Self, ForeignError> {
        let name = path.display().to_string();
        let unreadable = |cause| ForeignError::unreadable(&name, cause);
        let file = File::open(path).map_err(unreadable)?;
        let data = file.metadata().map_err(unreadable)?;
        let bytes = data.is_file().then_some(data.len());
        Self::new(Box::new(file), &name, format, bytes, layout)
    }

    /// Reads a pipe, or any other source that is not a file; `name` stands for it in errors.
    ///
    /// # Errors
    ///
    /// The pipe cannot be read, holds no draws, or is not of this format.
    pub fn from_reader(
        reader: impl Read + Send + 'static,
        name: &str,
        format: NumberFormat,
    ) -> Result<Self, ForeignError> {
        Self::from_reader_as(reader, name, format, &Layout::default())
    }

    /// Reads a pipe with several values per draw, or with several columns.
    ///
    /// # Errors
    ///
    /// The errors of [`DrawSource::from_reader`], and sources with other columns.
    pub fn from_reader_as(
        reader: impl Read + Send + 'static,
        name: &str,
        format: NumberFormat,
        layout: &Layout,
    ) -> Result<Self, ForeignError> {
        Self::new(Box::new(reader), name, format, None, layout)
    }

    fn new(
        bytes: Bytes,
        name: &str,
        format: NumberFormat,
        length: Option<u64>,
        layout: &Layout,
    ) -> Result<Self, ForeignError> {
        let source = match format {
            NumberFormat::Csv { column, lookups } => {
                let column = column.or_else(|| layout.column.clone());
                let layout = Layout { column, ..layout.clone() };
                let table = csv::CsvTable::open(bytes, name, &layout, lookups.as_ref())?;
                DrawReader::Csv(Box::new(table))
            }
            NumberFormat::Npy => DrawReader::Rows(npy::open(bytes, name, length, layout)?.into()),
            NumberFormat::Raw | NumberFormat::RawSingle => {
                let word = match format {
                    NumberFormat::Raw => NumberType::of_width(8, false),
                    _ => NumberType::of_width(4, false),
                };
                DrawReader::Rows(raw::open(bytes, name, length, layout, word)?.into())
            }
        };
        Ok(Self { source })
    }

    /// Returns the number of all draws, if the file gives it.
    pub fn known_length(&self) -> Option<u64> {
        match &self.source {
            DrawReader::Csv(_) => None,
            DrawReader::Rows(rows) => rows.known_length(),
        }
    }

    /// Returns the number of values of a draw.
    pub fn values(&self) -> usize {
        match &self.source {
            DrawReader::Csv(table) => table.values(),
            DrawReader::Rows(rows) => rows.values(),
        }
    }

    /// Replaces the buffer's contents by the first values of the next draws, `at_most` of them, and returns their
    /// number; 0 at the end. It is smaller than `at_most` only at the end.
    ///
    /// # Errors
    ///
    /// The source cannot be read further, or its next bytes are not a draw. The buffer then holds the draws before.
    pub fn read(&mut self, buffer: &mut Vec<f64>, at_most: usize) -> Result<usize, ForeignError> {
        let mut block = Block::new(self.values());
        let read = self.fill(&mut block, at_most);
        *buffer = block.columns.swap_remove(0);
        read.map(|()| buffer.len())
    }
}

impl Source for DrawSource {
    type Error = ForeignError;

    fn fill(&mut self, block: &mut Block, maximum: usize) -> Result<(), ForeignError> {
        match &mut self.source {
            DrawReader::Csv(table) => table.read(&mut block.columns, &mut block.lookups, maximum),
            DrawReader::Rows(rows) => rows.read(&mut block.columns, maximum),
        }
    }
}

/// Reason why numbers could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs)] // messages name the fields
pub enum ForeignError {
    /// The system refused.
    #[error("{file}: {cause}; give a file or a pipe that can be read")]
    Unreadable { file: String, cause: io::Error },
    /// There is no number at all.
    #[error("{file}: no draws; write at least one number")]
    Empty { file: String },
    /// The file ends too early.
    #[error("{file}: ends after {actual} of {expected} draws; write it to the end")]
    Truncated { file: String, actual: u64, expected: u64 },
    /// The file continues behind its end.
    #[error("{file}: goes on after its {expected} draws; write one array a file")]
    Overlong { file: String, expected: u64 },
    /// The file ends within a number.
    #[error(
        "{file}: {} more than {} of {width} bytes; \
         write little-endian float64 and nothing else, or float32 and say so by --input f32",
        counted(*rest as u64, "byte"),
        counted(*whole, "draw")
    )]
    PartialDraw { file: String, whole: u64, rest: usize, width: usize },
    /// Numbers of 4 bytes where 8 are expected.
    #[error("{file}: its bytes are float32, not float64; give --input f32, or name the file .f32")]
    LooksSingle { file: String },
    /// Numbers of 8 bytes where 4 are expected.
    #[error("{file}: its bytes are float64, not float32; give --input f64, or name the file .f64")]
    LooksDouble { file: String },
    /// Numbers of the other byte order.
    #[error(
        "{file}: values of absurd size, such as {value:e}, as of big-endian numbers; write them little-endian, by \
         x.astype('<f8').tofile, or as npy"
    )]
    LooksSwapped { file: String, value: f64 },
    /// There is no NPY header.
    #[error("{file}: not an npy file ({cause}); write it by numpy.save")]
    NotNpy { file: String, cause: io::Error },
    /// The array holds something else than real numbers of 4 or 8 bytes.
    #[error("{file}: an array of type {actual}; save it as float64 or float32, by x.astype('<f8')")]
    ElementType { file: String, actual: String },
    /// The array has several axes.
    #[error(
        "{file}: an array of shape {shape}, whose order of draws is not known; \
         save one axis, by x.ravel() or x[:, k], or choose a column k of an array of shape (draws, values) by --column"
    )]
    Shape { file: String, shape: String },
    /// The array has a column for each draw.
    #[error(
        "{file}: an array of shape {shape}, fewer draws than values; a row is a draw: did you mean x.T?"
    )]
    Transposed { file: String, shape: String },
    /// Number of values that differs from that of a draw of the case.
    #[error(
        "{file}: a draw has {}, but the case has the channels {channels}; write draws of {required}, or choose one \
         of the channels by --channel",
        counted(*actual as u64, "value")
    )]
    Channels { file: String, actual: usize, channels: String, required: String },
    /// Numbers without a shape: the number of values of a draw is unknown.
    #[error(
        "{file}: numbers without a shape do not tell how many values a draw has, of the channels {channels} that the case \
         has; write npy of shape (draws, values) or csv, or one channel and choose it by --channel"
    )]
    NoShape { file: String, channels: String },
    /// Column of lookups in a format without columns.
    #[error(
        "{file}: raw numbers have no columns; write npy of shape (draws, values) or csv, or leave --column out"
    )]
    NoColumns { file: String },
    /// The last draw lacks values.
    #[error(
        "{file}: {numbers} numbers are no whole number of draws of {values} values; write all values of each draw"
    )]
    PartialRow { file: String, numbers: u64, values: usize },
    /// A table of several columns, and none was chosen.
    #[error("{file}: {count} columns ({}); choose one by name or index", columns.join(", "))]
    ManyColumns { file: String, count: usize, columns: Vec<String> },
    /// The chosen column is not there.
    #[error("{file}: no {column} among {}; choose one of these", columns.join(", "))]
    NoColumn { file: String, column: Column, columns: Vec<String> },
    /// Several columns have the chosen name.
    #[error("{file}: {count} columns are called `{name}`; choose one by index")]
    SameName { file: String, name: String, count: usize },
    /// Columns that something else than commas separates.
    #[error(
        "{file}: `{line}` has {separator} between its columns; separate columns by commas, and write numbers with points"
    )]
    Separator { file: String, line: String, separator: &'static str },
    /// Two columns of digits, which may be one number.
    #[error(
        "{file}: `{line}` is two columns, or a number with a decimal comma; write it with a point, or choose a column by index"
    )]
    DecimalComma { file: String, line: String },
    /// A line with another number of columns than the first.
    #[error(
        "{file}, line {line}: {} where the first line has {expected}; mend the line",
        counted(*actual, "column")
    )]
    RaggedLine { file: String, line: u64, actual: u64, expected: u64 },
    /// A line that does not end.
    #[error("{file}, line {line}: longer than {longest} bytes; write one draw a line")]
    LongLine { file: String, line: u64, longest: u64 },
    /// A word that is not a number.
    #[error("{file}, line {line}, column {column}: `{text}` is not a number; write it as 1.25e-3")]
    NotANumber { file: String, line: u64, column: usize, text: String },
}

impl ForeignError {
    fn unreadable(file: &str, cause: io::Error) -> Self {
        Self::Unreadable { file: file.to_owned(), cause }
    }
}

/// Returns the number of draws in a file: by its length or its header, else by reading it to the end.
///
/// # Errors
///
/// The file cannot be read, or something in it is not a draw.
pub fn count(path: &Path, format: NumberFormat, layout: &Layout) -> Result<u64, ForeignError> {
    let mut draws = DrawSource::open_as(path, format, layout)?;
    if let Some(length) = draws.known_length() {
        return Ok(length);
    }
    let (mut block, mut count) = (Block::new(draws.values()), 0);
    loop {
        block.clear();
        draws.fill(&mut block, BUFFER)?;
        match block.draws() {
            0 => return Ok(count),
            read => count += read as u64,
        }
    }
}

/// Returns every draw, read in small pieces.
#[cfg(test)]
fn all(mut draws: DrawSource) -> Result<Vec<f64>, ForeignError> {
    let (mut all, mut buffer) = (Vec::new(), Vec::new());
    while draws.read(&mut buffer, 997)? > 0 {
        all.append(&mut buffer);
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_is_a_place_or_a_name() {
        assert_eq!("3".parse(), Ok(Column::Index(3)));
        assert_eq!("T".parse(), Ok(Column::Name("T".into())));
    }
}
