//! Draws that another program wrote: numbers in a file or a pipe, read in constant memory.
//!
//! ```text
//! csv, txt       one number a line, or columns of a table separated by commas
//! npy            float32 or float64 of either byte order, of shape (draws) or (draws, values)
//! f64, bin, raw  little-endian float64, nothing else; several values of a draw follow each other
//! ```
//!
//! NaN and ∞ are read as they are: the gate judges them. Whatever keeps a file from being a list of
//! numbers is a [`ForeignError`]; nothing is skipped.

mod csv;
mod error;
mod layout;
mod lines;
mod npy;
mod raw;
mod rows;

use std::convert::Infallible;
use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::str::FromStr;

pub use error::ForeignError;
pub use layout::Layout;

use super::{BUFFER, Block, Source};

/// How numbers are written.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// A table of text, columns separated by commas.
    Csv {
        /// Which column to read; a table of one column needs no choice.
        column: Option<Column>,
        /// Which column has the lookups of a draw, if any.
        lookups: Option<Column>,
    },
    /// `NumPy`'s array file.
    Npy,
    /// Little-endian float64.
    Raw,
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

impl Format {
    /// The format that a file's ending stands for; `None` where it stands for none.
    pub fn of_path(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "csv" | "txt" => Some(Self::Csv { column: None, lookups: None }),
            "npy" => Some(Self::Npy),
            "f64" | "bin" | "raw" => Some(Self::Raw),
            _ => None,
        }
    }
}

/// Where bytes come from.
type Bytes = Box<dyn Read + Send>;

/// An open source of draws.
pub struct Draws {
    source: Reader,
}

enum Reader {
    Csv(Box<csv::Table>),
    Rows(Box<rows::Rows>),
}

impl std::fmt::Debug for Draws {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Draws").field("known_length", &self.known_length()).finish_non_exhaustive()
    }
}

impl Draws {
    /// Opens a file.
    ///
    /// # Errors
    ///
    /// The file cannot be read, holds no draws, is not of this format, or its length shows that it
    /// is cut off.
    pub fn open(path: &Path, format: Format) -> Result<Self, ForeignError> {
        Self::open_as(path, format, &Layout::default())
    }

    /// Opens a file of draws that have several values, or of several columns.
    ///
    /// # Errors
    ///
    /// Those of [`Draws::open`], and where the file has other columns.
    pub fn open_as(path: &Path, format: Format, layout: &Layout) -> Result<Self, ForeignError> {
        let name = path.display().to_string();
        let unreadable = |cause| ForeignError::unreadable(&name, cause);
        let file = File::open(path).map_err(unreadable)?;
        let data = file.metadata().map_err(unreadable)?;
        let bytes = data.is_file().then_some(data.len());
        Self::new(Box::new(file), &name, format, bytes, layout)
    }

    /// Reads a pipe, or anything else that is no file; `name` is what errors call it.
    ///
    /// # Errors
    ///
    /// The pipe cannot be read, holds no draws, or is not of this format.
    pub fn from_reader(
        reader: impl Read + Send + 'static,
        name: &str,
        format: Format,
    ) -> Result<Self, ForeignError> {
        Self::from_reader_as(reader, name, format, &Layout::default())
    }

    /// Reads a pipe of draws that have several values, or of several columns.
    ///
    /// # Errors
    ///
    /// Those of [`Draws::from_reader`], and where there are other columns.
    pub fn from_reader_as(
        reader: impl Read + Send + 'static,
        name: &str,
        format: Format,
        layout: &Layout,
    ) -> Result<Self, ForeignError> {
        Self::new(Box::new(reader), name, format, None, layout)
    }

    fn new(
        bytes: Bytes,
        name: &str,
        format: Format,
        length: Option<u64>,
        layout: &Layout,
    ) -> Result<Self, ForeignError> {
        let source = match format {
            Format::Csv { column, lookups } => {
                let column = column.or_else(|| layout.column.clone());
                let layout = Layout { column, ..layout.clone() };
                let table = csv::Table::open(bytes, name, &layout, lookups.as_ref())?;
                Reader::Csv(Box::new(table))
            }
            Format::Npy => Reader::Rows(npy::open(bytes, name, length, layout)?.into()),
            Format::Raw => Reader::Rows(raw::open(bytes, name, length, layout)?.into()),
        };
        Ok(Self { source })
    }

    /// How many draws there are in all, where the file says so.
    pub fn known_length(&self) -> Option<u64> {
        match &self.source {
            Reader::Csv(_) => None,
            Reader::Rows(rows) => rows.known_length(),
        }
    }

    /// Number of values of a draw.
    pub fn values(&self) -> usize {
        match &self.source {
            Reader::Csv(table) => table.values(),
            Reader::Rows(rows) => rows.values(),
        }
    }

    /// Replaces the buffer's contents by the first values of the next draws, `at_most` of them; answers how many, 0 at
    /// the end. Fewer than asked for come only at the end.
    ///
    /// # Errors
    ///
    /// The source cannot be read on, or what follows is not a draw. The buffer then holds the draws
    /// before.
    pub fn read(&mut self, buffer: &mut Vec<f64>, at_most: usize) -> Result<usize, ForeignError> {
        let mut block = Block::new(self.values());
        let read = self.fill(&mut block, at_most);
        *buffer = block.columns.swap_remove(0);
        read.map(|()| buffer.len())
    }
}

impl Source for Draws {
    type Error = ForeignError;

    fn fill(&mut self, block: &mut Block, most: usize) -> Result<(), ForeignError> {
        match &mut self.source {
            Reader::Csv(table) => table.read(&mut block.columns, &mut block.lookups, most),
            Reader::Rows(rows) => rows.read(&mut block.columns, most),
        }
    }
}

/// How many draws a file holds: by its length or its header, else by reading it through.
///
/// # Errors
///
/// The file cannot be read, or something in it is not a draw.
pub fn count(path: &Path, format: Format, layout: &Layout) -> Result<u64, ForeignError> {
    let mut draws = Draws::open_as(path, format, layout)?;
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

/// Every draw, in small pieces.
#[cfg(test)]
fn all(mut draws: Draws) -> Result<Vec<f64>, ForeignError> {
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
    fn endings_stand_for_formats() {
        let of = |path: &str| Format::of_path(Path::new(path));
        assert_eq!(of("a/draws.CSV"), Some(Format::Csv { column: None, lookups: None }));
        assert_eq!(of("draws.txt"), Some(Format::Csv { column: None, lookups: None }));
        assert_eq!(of("draws.v2.npy"), Some(Format::Npy));
        for path in ["x.f64", "x.bin", "x.raw"] {
            assert_eq!(of(path), Some(Format::Raw));
        }
        assert_eq!(of("draws"), None);
        assert_eq!(of("draws.npz"), None);
    }

    #[test]
    fn a_column_is_a_place_or_a_name() {
        assert_eq!("3".parse(), Ok(Column::Index(3)));
        assert_eq!("T".parse(), Ok(Column::Name("T".into())));
    }
}
