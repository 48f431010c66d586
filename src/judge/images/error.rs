//! What keeps pictures from being judged.
#![allow(missing_docs)] // messages name the fields

use std::io;

use super::picture::Size;

/// Why pictures could not be read or judged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// The system refused.
    #[error("{file}: {cause}; give a file that can be read")]
    Unreadable { file: String, cause: io::Error },
    /// The name does not tell a format.
    #[error("{file}: its name ends with none of .npy, .pfm and .exr; give images as one of these")]
    Format { file: String },
    /// The file is not what its name says, or only a part of it.
    #[error("{file}: not {what} that can be read ({cause}); {cure}")]
    Faulty { file: String, what: &'static str, cause: String, cure: &'static str },
    /// An array of a shape that is no picture.
    #[error("{file}: an array of shape {shape}; save {wanted}")]
    Shape { file: String, shape: String, wanted: &'static str },
    /// Pictures of different sizes.
    #[error("{file}: {found}, but {other} has {expected}; give pictures of one size")]
    Differ { file: String, found: Size, other: String, expected: Size },
    /// Values that do not fill the picture.
    #[error(
        "{found} value(s) for {passes} pass(es) of {expected}; give one for each, and at least one"
    )]
    Count { expected: Size, passes: usize, found: usize },
    /// One pass alone.
    #[error(
        "there is one pass; give two or more: an array of shape (passes, height, width[, channels]), \
         or several files of one pass each"
    )]
    OnePass,
    /// A pixel of a claim that makes no sense.
    #[error(
        "the {what} of row {row}, column {column}, channel {channel} is {value}, not {wanted}; mend it"
    )]
    Pixel {
        what: &'static str,
        row: usize,
        column: usize,
        channel: usize,
        value: f64,
        wanted: String,
    },
    /// A number that makes no sense.
    #[error("{what} = {value} is not {wanted}; give {what} as {wanted}")]
    Number { what: &'static str, value: f64, wanted: &'static str },
    /// A tolerance that rounding would eat.
    #[error(
        "a tolerance of {tolerance:e} is below 4 times what rounding may add to a pixel, {floor:.1e} of the \
         picture's mean; give a wider tolerance, a smaller rounding, or images of more digits"
    )]
    Blurred { tolerance: f64, floor: f64 },
    /// A truth of 0 everywhere without a tolerance.
    #[error(
        "a truth of 0 everywhere has no relative tolerance; give a tolerance, which is then absolute"
    )]
    NoUnit,
}
