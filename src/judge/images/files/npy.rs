//! Pictures and stacks as arrays of `NumPy`.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::SINGLE;
use crate::judge::images::error::ImageError;
use crate::judge::images::picture::{Picture, Size, Stack};
use media::files::npy::{self, Header, Word};

const STACK: &str = "(passes, height, width) or (passes, height, width, channels), each 1 or more";
const PICTURE: &str = "(height, width) or (height, width, channels), each 1 or more";

/// Reads a picture.
pub(super) fn picture(path: &Path, file: &str) -> Result<Picture, ImageError> {
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

/// Reads a stack.
pub(super) fn stack(path: &Path, file: &str) -> Result<Stack, ImageError> {
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

/// Passes and their size by the lengths of the axes.
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
        wanted: &'static str,
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
        let word = Word::named(&array.kind).ok_or_else(|| {
            faulty(format!("its numbers are {}", array.kind), "save it as float64 or float32")
        })?;
        let shape =
            || ImageError::Shape { file: file.to_owned(), shape: array.written_shape(), wanted };
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
        let (found, width) = (bytes.len(), word.width());
        if Some(found as u64) != count.checked_mul(width as u64) {
            let cause =
                format!("{found} bytes follow the header, not {count} numbers of {width} bytes");
            return Err(faulty(cause, "write one array to its end"));
        }
        let mut values = Vec::with_capacity(found / width);
        word.convert(&bytes, &mut values);
        let rounding = if width == 4 { SINGLE } else { 0.0 };
        Ok(Self { passes, size, values, rounding })
    }
}

fn lengths(array: &Header) -> Option<Vec<usize>> {
    let axes = array.shape.iter().map(|&axis| usize::try_from(axis).ok().filter(|&axis| axis > 0));
    axes.collect()
}
