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

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::claim::ImageError;
use super::picture::{Picture, Size, Stack};
use media::files::exr::{self, PixelWindow};
use media::files::npy::{self, Header};
use media::files::number::NumberType;
use media::files::{Pixels, pfm};
use media::formats::Format;

/// Relative rounding error of numbers of 24 bits.
const SINGLE: f64 = 0.5 * f32::EPSILON as f64;

/// Relative rounding error of numbers of 11 bits.
const HALF: f64 = 1.0 / 2048.0;

/// Reads a picture.
///
/// # Errors
///
/// The file cannot be read, or is not a picture.
pub fn picture(path: &Path) -> Result<Picture, ImageError> {
    picture_in(path, Frame::default())
}

/// Reads a picture, and places it in a frame.
///
/// # Errors
///
/// The file cannot be read, or is not a picture.
pub fn picture_in(path: &Path, frame: Frame) -> Result<Picture, ImageError> {
    let file = path.display().to_string();
    match Format::of(path) {
        Some(Format::Npy) => npy_picture(path, &file),
        Some(Format::Pfm) => {
            let cure = "write Pf or PF, columns, rows, -1 and all values as float32";
            of_pixels(pfm::read(&bytes(path, &file)?), ["a pfm file", cure], file)
        }
        Some(Format::Exr) => {
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

/// Reads a stack from one file, or from several with a pass each.
///
/// # Errors
///
/// A file cannot be read or is not a picture, sizes differ, or there is only one pass.
pub fn stack(paths: &[impl AsRef<Path>]) -> Result<Stack, ImageError> {
    stack_in(paths, Frame::of(paths)?)
}

/// Reads a stack, and places its passes in a frame.
///
/// # Errors
///
/// A file cannot be read or is not a picture, sizes differ, or there is only one pass.
pub fn stack_in(paths: &[impl AsRef<Path>], frame: Frame) -> Result<Stack, ImageError> {
    let [first, others @ ..] = paths else { return Err(ImageError::OnePass) };
    let first = first.as_ref();
    if others.is_empty() {
        return match Format::of(first) {
            Some(Format::Npy) => npy_stack(first, &first.display().to_string()),
            _ => picture_in(first, frame).and(Err(ImageError::OnePass)),
        };
    }
    let Picture { size, mut values, mut rounding } = picture_in(first, frame)?;
    for path in others {
        let other = picture_in(path.as_ref(), frame)?;
        if other.size != size {
            return Err(ImageError::Differ {
                file: path.as_ref().display().to_string(),
                actual: other.size,
                other: first.display().to_string(),
                expected: size,
            });
        }
        values.extend(other.values);
        rounding = rounding.max(other.rounding);
    }
    Ok(Stack { rounding, ..Stack::new(paths.len(), size, values)? })
}

/// Returns whether files of a format may be images.
pub fn is_image(format: Format) -> bool {
    matches!(format, Format::Npy | Format::Pfm | Format::Exr)
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

const STACK: &str = "(passes, height, width) or (passes, height, width, channels), each 1 or more";
const PICTURE: &str = "(height, width) or (height, width, channels), each 1 or more";

/// Reads a picture from an array.
fn npy_picture(path: &Path, file: &str) -> Result<Picture, ImageError> {
    let array = Array::read(
        path,
        file,
        &|shape| match *shape {
            [rows, columns] => Some((1, Size { rows, columns, channels: 1 })),
            [rows, columns, channels] => Some((1, Size { rows, columns, channels })),
            _ => None,
        },
        PICTURE,
    )?;
    Ok(Picture { rounding: array.rounding, ..Picture::new(array.size, array.values)? })
}

/// Reads a stack from an array.
fn npy_stack(path: &Path, file: &str) -> Result<Stack, ImageError> {
    let array = Array::read(
        path,
        file,
        &|shape| match *shape {
            [passes, rows, columns] => Some((passes, Size { rows, columns, channels: 1 })),
            [passes, rows, columns, channels] => Some((passes, Size { rows, columns, channels })),
            _ => None,
        },
        STACK,
    )?;
    Ok(Stack { rounding: array.rounding, ..Stack::new(array.passes, array.size, array.values)? })
}

/// Number of passes and their size by the lengths of the axes.
type Reading<'a> = &'a dyn Fn(&[usize]) -> Option<(usize, Size)>;

struct Array {
    passes: usize,
    size: Size,
    values: Vec<f64>,
    rounding: f64,
}

impl Array {
    fn read(
        path: &Path,
        file: &str,
        reading: Reading,
        required: &'static str,
    ) -> Result<Self, ImageError> {
        let unreadable = |cause| ImageError::Unreadable { file: file.to_owned(), cause };
        let faulty = |cause: String, cure| ImageError::Faulty {
            file: file.to_owned(),
            what: "an npy file",
            cause,
            cure,
        };
        let mut source = File::open(path).map_err(unreadable)?;
        let header = npy::bytes(&mut source).map_err(unreadable)?;
        let array = npy::parse(&header)
            .map_err(|cause| faulty(cause.to_string(), "write it by numpy.save"))?;
        let word = NumberType::float(&array.kind).ok_or_else(|| {
            faulty(format!("its numbers are {}", array.kind), "save it as float64 or float32")
        })?;
        let shape =
            || ImageError::Shape { file: file.to_owned(), shape: array.written_shape(), required };
        let (passes, size) = lengths(&array).and_then(|axes| reading(&axes)).ok_or_else(shape)?;
        let is_turned =
            array.fortran_order && array.shape.iter().filter(|&&axis| axis > 1).count() > 1;
        if is_turned {
            let cause = "its first axis varies fastest".to_owned();
            return Err(faulty(cause, "save numpy.ascontiguousarray of it"));
        }
        let count = array.count().filter(|&count| count > 0).ok_or_else(shape)?;
        let mut bytes = Vec::new();
        source.read_to_end(&mut bytes).map_err(unreadable)?;
        let (actual, width) = (bytes.len(), word.width());
        if Some(actual as u64) != count.checked_mul(width as u64) {
            let cause =
                format!("{actual} bytes follow the header, not {count} numbers of {width} bytes");
            return Err(faulty(cause, "write one array to its end"));
        }
        let mut values = Vec::with_capacity(actual / width);
        word.convert(&bytes, &mut values);
        let rounding = if width == 4 { SINGLE } else { 0.0 };
        Ok(Self { passes, size, values, rounding })
    }
}

fn lengths(array: &Header) -> Option<Vec<usize>> {
    let axes = array.shape.iter().map(|&axis| usize::try_from(axis).ok().filter(|&axis| axis > 0));
    axes.collect()
}

/// Length in bytes of all but rare headers.
const HEAD: u64 = 1 << 16;

/// Maximum number of pixels of a frame: a small file may announce any display window.
const MAX_PIXELS: usize = 1 << 27;

/// Frame in which pixels are placed; none if files are compared as they are stored.
///
/// An `OpenEXR` file stores the pixels of its data window, and the place of that window in the picture, the display
/// window. Files with the same data window are compared as they are stored. If data windows differ, as after cropping
/// of black borders, pixels are placed in the display window, which must then be the same. Outside its data window a
/// file is 0, and pixels beyond the display window are left out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Frame(Option<PixelWindow>);

impl Frame {
    /// Returns the frame of files that are compared with each other.
    ///
    /// # Errors
    ///
    /// Data windows differ, and so do display windows. Faults of a file are reported when its pixels are read.
    pub fn of(paths: &[impl AsRef<Path>]) -> Result<Self, ImageError> {
        let windows = paths.iter().filter_map(|path| {
            let path = path.as_ref();
            Some((path, windows(path)?))
        });
        let windows: Vec<_> = windows.collect();
        let Some(((first, [data, display]), others)) = windows.split_first() else {
            return Ok(Self(None));
        };
        if others.iter().all(|(_, [other, _])| other == data) {
            return Ok(Self(None));
        }
        match others.iter().find(|(_, [_, other])| other != display) {
            None if display
                .size()
                .iter()
                .try_fold(1, |n: usize, &m| n.checked_mul(m))
                .is_some_and(|n| n <= MAX_PIXELS) =>
            {
                Ok(Self(Some(*display)))
            }
            None => Err(ImageError::Faulty {
                file: first.display().to_string(),
                what: "an image beside the others",
                cause: format!("its display window {display} has more than {MAX_PIXELS} pixels"),
                cure: "write all with one data window",
            }),
            Some((path, [data, other])) => Err(ImageError::Faulty {
                file: path.display().to_string(),
                what: "an image beside the others",
                cause: format!(
                    "its data window {data} lies in the display window {other}, and that of {} is {display}",
                    first.display()
                ),
                cure: "write all with one display window: pixels are not compared by their position in the file",
            }),
        }
    }

    /// Places the pixels of a data window in the frame.
    fn laid(self, pixels: Pixels, data: PixelWindow) -> Pixels {
        let Self(Some(frame)) = self else { return pixels };
        let ([columns, rows], [width, height]) = (frame.size(), pixels.size);
        let channels = pixels.channels;
        // Distance of the data window from the left and the upper edge of the frame.
        let [right, below] =
            [0, 1].map(|axis| i64::from(data.low[axis]) - i64::from(frame.low[axis]));
        let mut values = vec![0.0; columns * rows * channels];
        for (row, line) in
            (0_i64..).zip(pixels.values.chunks_exact((width * channels).max(1)).take(height))
        {
            let Some(row) = usize::try_from(row + below).ok().filter(|&row| row < rows) else {
                continue;
            };
            for (column, pixel) in (0_i64..).zip(line.chunks_exact(channels)) {
                if let Some(column) = usize::try_from(column + right).ok().filter(|&c| c < columns)
                {
                    let first = (row * columns + column) * channels;
                    values[first..first + channels].copy_from_slice(pixel);
                }
            }
        }
        Pixels { size: [columns, rows], values, ..pixels }
    }
}

/// Returns the data window and the display window of a picture; `None` without windows, or for an unreadable file.
fn windows(path: &Path) -> Option<[PixelWindow; 2]> {
    if Format::of(path) != Some(Format::Exr) {
        return None;
    }
    let (mut file, mut bytes) = (File::open(path).ok()?, Vec::new());
    file.by_ref().take(HEAD).read_to_end(&mut bytes).ok()?;
    if exr::parts(&bytes).is_err() {
        file.read_to_end(&mut bytes).ok()?;
    }
    let parts = exr::parts(&bytes).ok()?;
    let first = parts.first()?;
    Some([first.data, first.display])
}
