//! What keeps a file from being a list of numbers.

use std::io;

use super::Column;

/// Why numbers could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ForeignError {
    /// The system refused.
    #[error("{file}: {cause}; give a file or a pipe that can be read")]
    Unreadable {
        /// The file as named by the caller.
        file: String,
        /// What the system said.
        cause: io::Error,
    },
    /// There is no number at all.
    #[error("{file}: no draws; write at least one number")]
    Empty {
        /// The file.
        file: String,
    },
    /// The file ends too early.
    #[error("{file}: ends after {found} of {expected} draws; write it to the end")]
    Truncated {
        /// The file.
        file: String,
        /// How many whole draws it holds.
        found: u64,
        /// How many its header announces.
        expected: u64,
    },
    /// The file goes on where it should end.
    #[error("{file}: goes on after its {expected} draws; write one array a file")]
    Overlong {
        /// The file.
        file: String,
        /// How many draws its header announces.
        expected: u64,
    },
    /// The file ends within a number.
    #[error(
        "{file}: {rest} byte(s) are left after {whole} draws of 8 bytes; \
         write little-endian float64 and nothing else"
    )]
    PartialDraw {
        /// The file.
        file: String,
        /// How many whole draws came before.
        whole: u64,
        /// How many bytes are left.
        rest: usize,
    },
    /// There is no NPY header.
    #[error("{file}: not an npy file ({cause}); write it by numpy.save")]
    NotNpy {
        /// The file.
        file: String,
        /// What is wrong with the header.
        cause: io::Error,
    },
    /// The array holds something else than real numbers of 4 or 8 bytes.
    #[error("{file}: an array of type {found}; save it as float64 or float32, by x.astype('<f8')")]
    ElementType {
        /// The file.
        file: String,
        /// The type, as `NumPy` writes it.
        found: String,
    },
    /// The array has several axes.
    #[error(
        "{file}: an array of shape {shape}, whose order of draws is not known; \
         save one axis, by x.ravel() or x[:, k], or choose a column k of an array of shape (draws, values) by --column"
    )]
    Shape {
        /// The file.
        file: String,
        /// The shape, as `NumPy` writes it.
        shape: String,
    },
    /// The array has a column for each draw.
    #[error(
        "{file}: an array of shape {shape}, fewer draws than values; a row is a draw: did you mean x.T?"
    )]
    Transposed {
        /// The file.
        file: String,
        /// The shape, as `NumPy` writes it.
        shape: String,
    },
    /// Another number of values than a draw of the case has.
    #[error(
        "{file}: a draw has {found} value{}, but the case has the channels {channels}; write draws of {wanted}, or choose one \
         of the channels by --channel",
        if *found == 1 { "" } else { "s" }
    )]
    Channels {
        /// The file.
        file: String,
        /// Number of values of a draw.
        found: usize,
        /// The names of the channels.
        channels: String,
        /// Numbers of values that are possible, in words.
        wanted: String,
    },
    /// Numbers without a shape, of which nothing says how many a draw has.
    #[error(
        "{file}: numbers without a shape do not tell how many values a draw has, of the channels {channels} that the case \
         has; write npy of shape (draws, values) or csv, or one channel and choose it by --channel"
    )]
    NoShape {
        /// The file.
        file: String,
        /// The names of the channels.
        channels: String,
    },
    /// A column of numbers that have none.
    #[error(
        "{file}: raw float64 has no columns; write npy of shape (draws, values) or csv, or leave --column out"
    )]
    NoColumns {
        /// The file.
        file: String,
    },
    /// The last draw lacks values.
    #[error(
        "{file}: {numbers} numbers are no whole number of draws of {values} values; write all values of each draw"
    )]
    PartialRow {
        /// The file.
        file: String,
        /// Number of numbers in the file.
        numbers: u64,
        /// Number of values of a draw.
        values: usize,
    },
    /// A table of several columns, and none was chosen.
    #[error("{file}: {count} columns ({}); choose one by name or index", columns.join(", "))]
    ManyColumns {
        /// The file.
        file: String,
        /// How many.
        count: usize,
        /// The first of their names, or of their places where they have no names.
        columns: Vec<String>,
    },
    /// The chosen column is not there.
    #[error("{file}: no {column} among {}; choose one of these", columns.join(", "))]
    NoColumn {
        /// The file.
        file: String,
        /// What was chosen.
        column: Column,
        /// The names that are there, or the places where they have no names.
        columns: Vec<String>,
    },
    /// Several columns have the chosen name.
    #[error("{file}: {count} columns are called `{name}`; choose one by index")]
    SameName {
        /// The file.
        file: String,
        /// The name.
        name: String,
        /// How many bear it.
        count: usize,
    },
    /// A line with another number of columns than the first.
    #[error(
        "{file}, line {line}: {found} column(s) where the first line has {expected}; mend the line"
    )]
    RaggedLine {
        /// The file.
        file: String,
        /// The line; the first is 1.
        line: u64,
        /// How many columns it has.
        found: u64,
        /// How many the first line has.
        expected: u64,
    },
    /// A line that does not end.
    #[error("{file}, line {line}: longer than {longest} bytes; write one draw a line")]
    LongLine {
        /// The file.
        file: String,
        /// The line; the first is 1.
        line: u64,
        /// The longest line that is read.
        longest: u64,
    },
    /// A word that is not a number.
    #[error("{file}, line {line}, column {column}: `{text}` is not a number; write it as 1.25e-3")]
    NotANumber {
        /// The file.
        file: String,
        /// The line; the first is 1.
        line: u64,
        /// The column; the first is 0.
        column: usize,
        /// The word.
        text: String,
    },
}

impl ForeignError {
    pub(super) fn unreadable(file: &str, cause: io::Error) -> Self {
        Self::Unreadable { file: file.to_owned(), cause }
    }
}
