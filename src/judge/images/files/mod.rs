//! Pictures and stacks in files.
//!
//! ```text
//! npy   float32 or float64 of either byte order, in C order:
//!       a stack (passes, height, width[, channels]), or a picture (height, width[, channels])
//! pfm   a picture of 1 or 3 channels, of either byte order
//! exr   the first layer of a picture: R, G, B, else Y, else its first channel; alpha is left out
//! ```
//!
//! One file is a stack, several are one pass each. `OpenEXR` files with different data windows are laid into their display
//! window, see [`Frame`].

mod frame;
mod npy;

use std::path::Path;

use super::error::ImageError;
use super::picture::{Picture, Size, Stack};
use media::files::{Pixels, exr, pfm};

pub use frame::Frame;

/// The relative rounding of numbers of 24 bits.
const SINGLE: f64 = 0.5 * f32::EPSILON as f64;

/// The relative rounding of numbers of 11 bits.
const HALF: f64 = 1.0 / 2048.0;

/// Reads a picture.
///
/// # Errors
///
/// The file cannot be read, or is no picture.
pub fn picture(path: &Path) -> Result<Picture, ImageError> {
    picture_in(path, Frame::default())
}

/// Reads a picture as it is laid beside others.
///
/// # Errors
///
/// The file cannot be read, or is no picture.
pub fn picture_in(path: &Path, frame: Frame) -> Result<Picture, ImageError> {
    let file = path.display().to_string();
    match ending(path).as_deref() {
        Some("npy") => npy::picture(path, &file),
        Some("pfm") => {
            let cure = "write Pf or PF, columns, rows, -1 and all values as float32";
            of_pixels(pfm::read(&bytes(path, &file)?), ["a pfm file", cure], file)
        }
        Some("exr") => {
            let cure = "give a whole file with one layer of R, G, B or Y as half or float, compressed by ZIP or not at \
                        all, or npy or pfm";
            let bytes = bytes(path, &file)?;
            let data = exr::parts(&bytes).ok().and_then(|parts| Some(parts.first()?.data));
            let read = exr::read(bytes).map(|pixels| match data {
                Some(data) => frame.laid(pixels, data),
                None => pixels,
            });
            of_pixels(read, ["an exr file", cure], file)
        }
        _ => Err(ImageError::Format { file }),
    }
}

/// Reads a stack of one file, or of several with a pass each.
///
/// # Errors
///
/// A file cannot be read or is no picture, they are of different sizes, or there is one pass alone.
pub fn stack(paths: &[impl AsRef<Path>]) -> Result<Stack, ImageError> {
    stack_in(paths, Frame::of(paths)?)
}

/// Reads a stack as it is laid beside others.
///
/// # Errors
///
/// A file cannot be read or is no picture, they are of different sizes, or there is one pass alone.
pub fn stack_in(paths: &[impl AsRef<Path>], frame: Frame) -> Result<Stack, ImageError> {
    let [first, others @ ..] = paths else { return Err(ImageError::OnePass) };
    let first = first.as_ref();
    if others.is_empty() {
        return match ending(first).as_deref() {
            Some("npy") => npy::stack(first, &first.display().to_string()),
            _ => picture_in(first, frame).and(Err(ImageError::OnePass)),
        };
    }
    let Picture { size, mut values, mut rounding } = picture_in(first, frame)?;
    for path in others {
        let other = picture_in(path.as_ref(), frame)?;
        if other.size != size {
            return Err(ImageError::Differ {
                file: path.as_ref().display().to_string(),
                found: other.size,
                other: first.display().to_string(),
                expected: size,
            });
        }
        values.extend(other.values);
        rounding = rounding.max(other.rounding);
    }
    Ok(Stack { rounding, ..Stack::new(paths.len(), size, values)? })
}

fn ending(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_ascii_lowercase())
}

fn of_pixels(
    read: Result<Pixels, String>,
    [what, cure]: [&'static str; 2],
    file: String,
) -> Result<Picture, ImageError> {
    let pixels = read.map_err(|cause| ImageError::Faulty { file, what, cause, cure })?;
    let Pixels { size: [columns, rows], channels, values, has_halves } = pixels;
    let rounding = if has_halves { HALF } else { SINGLE };
    Ok(Picture { rounding, ..Picture::new(Size { rows, columns, channels }, values)? })
}

fn bytes(path: &Path, file: &str) -> Result<Vec<u8>, ImageError> {
    std::fs::read(path).map_err(|cause| ImageError::Unreadable { file: file.to_owned(), cause })
}
