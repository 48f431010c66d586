//! What keeps a file from being a list of numbers.
#![allow(missing_docs)] // messages name the fields

use std::io;

use super::Column;

/// Why numbers could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ForeignError {
    /// The system refused.
    #[error("{file}: {cause}; give a file or a pipe that can be read")]
    Unreadable { file: String, cause: io::Error },
    /// There is no number at all.
    #[error("{file}: no draws; write at least one number")]
    Empty { file: String },
    /// The file ends too early.
    #[error("{file}: ends after {found} of {expected} draws; write it to the end")]
    Truncated { file: String, found: u64, expected: u64 },
    /// The file goes on where it should end.
    #[error("{file}: goes on after its {expected} draws; write one array a file")]
    Overlong { file: String, expected: u64 },
    /// The file ends within a number.
    #[error(
        "{file}: {rest} byte(s) are left after {whole} draws of 8 bytes; \
         write little-endian float64 and nothing else"
    )]
    PartialDraw { file: String, whole: u64, rest: usize },
    /// There is no NPY header.
    #[error("{file}: not an npy file ({cause}); write it by numpy.save")]
    NotNpy { file: String, cause: io::Error },
    /// The array holds something else than real numbers of 4 or 8 bytes.
    #[error("{file}: an array of type {found}; save it as float64 or float32, by x.astype('<f8')")]
    ElementType { file: String, found: String },
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
    /// Another number of values than a draw of the case has.
    #[error(
        "{file}: a draw has {found} value{}, but the case has the channels {channels}; write draws of {wanted}, or choose one \
         of the channels by --channel",
        if *found == 1 { "" } else { "s" }
    )]
    Channels { file: String, found: usize, channels: String, wanted: String },
    /// Numbers without a shape, of which nothing says how many a draw has.
    #[error(
        "{file}: numbers without a shape do not tell how many values a draw has, of the channels {channels} that the case \
         has; write npy of shape (draws, values) or csv, or one channel and choose it by --channel"
    )]
    NoShape { file: String, channels: String },
    /// A column of numbers that have none.
    #[error(
        "{file}: raw float64 has no columns; write npy of shape (draws, values) or csv, or leave --column out"
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
    /// A line with another number of columns than the first.
    #[error(
        "{file}, line {line}: {found} column(s) where the first line has {expected}; mend the line"
    )]
    RaggedLine { file: String, line: u64, found: u64, expected: u64 },
    /// A line that does not end.
    #[error("{file}, line {line}: longer than {longest} bytes; write one draw a line")]
    LongLine { file: String, line: u64, longest: u64 },
    /// A word that is not a number.
    #[error("{file}, line {line}, column {column}: `{text}` is not a number; write it as 1.25e-3")]
    NotANumber { file: String, line: u64, column: usize, text: String },
}

impl ForeignError {
    pub(super) fn unreadable(file: &str, cause: io::Error) -> Self {
        Self::Unreadable { file: file.to_owned(), cause }
    }
}
