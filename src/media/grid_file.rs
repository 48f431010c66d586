//! Voxel grids in files: Mitsuba's `.vol`, `NumPy`'s `.npy`, and `OpenVDB`'s `.vdb` (see `grid_vdb.rs`).
//!
//! ```text
//! .vol   "VOL", version 3 (1 byte), then little-endian: type 1 (i32), nx ny nz channels (i32),
//!        low and high corner of the box (6 f32), samples (f32), x fastest, then y, then z
//! .npy   float32 or float64 of shape (nz, ny, nx) in C order: x fastest, as in .vol
//! ```
//!
//! The `.vol` layout is that of the `gridvolume` plugin of Mitsuba 3 (W. Jakob et al., *Mitsuba 3
//! renderer*, 2022); channels other than 1 and versions other than 3 are refused. A grid has at
//! most 2²⁷ samples, and every sample is finite and not negative.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use super::grid_vdb;
use crate::catalogue::number;
use crate::files::npy;
use crate::geometry::{Aabb, Point};

/// The samples of a grid, x fastest.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// How many samples stand along x, y and z.
    pub size: [usize; 3],
    /// `values[(z·ny + y)·nx + x]`.
    pub values: Vec<f64>,
    /// The corners of the box that the file gives, whether or not they are those of a box.
    pub bounds: Option<Aabb>,
}

/// What is wrong with a file, and what would be right.
#[derive(Debug, Clone, PartialEq)]
pub struct Unreadable {
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: String,
}

/// The largest number of samples, 1 GiB of doubles.
pub const MOST_SAMPLES: u64 = 1 << 27;

pub(super) fn wrong<T>(
    message: impl Into<String>,
    help: impl Into<String>,
) -> Result<T, Unreadable> {
    Err(Unreadable { message: message.into(), help: help.into() })
}

/// Whether a file is read as one of `OpenVDB`'s, which holds grids with names and says where they stand.
pub fn is_vdb(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "vdb")
}

/// Reads a `.vol`, `.npy` or `.vdb` file, by its ending; of the last the grid of a name, or its only one.
///
/// # Errors
///
/// Whatever keeps the file from being a grid of finite, non-negative samples.
pub fn read(path: &Path, grid: Option<&str>) -> Result<Samples, Unreadable> {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    let reader: &dyn Fn(File) -> Result<Samples, Unreadable> = match ending {
        "vol" => &read_vol,
        "npy" => &read_npy,
        "vdb" => &|file| grid_vdb::read(file, grid),
        _ => return wrong("the file is none of .vol, .npy and .vdb", "convert it to one of them"),
    };
    let file = match File::open(path) {
        Ok(file) => file,
        Err(error) => {
            return wrong(error.to_string(), "the name is relative to the case file's folder");
        }
    };
    let samples = reader(file)?;
    match samples.values.iter().position(|x| !(x.is_finite() && *x >= 0.0)) {
        None => Ok(samples),
        Some(index) => {
            let [nx, ny, _] = samples.size;
            let (x, y, z) = (index % nx, index / nx % ny, index / nx / ny);
            let message = format!("sample ({x}, {y}, {z}) is {}", number(samples.values[index]));
            wrong(message, "an extinction is finite and not negative")
        }
    }
}

/// The three sizes as indices, if they make a grid of a size that fits.
pub(super) fn sizes(size: [u64; 3]) -> Result<[usize; 3], Unreadable> {
    let [x, y, z] = size;
    let count = size.iter().try_fold(1u64, |product, &n| product.checked_mul(n));
    let fits = count.is_some_and(|count| (1..=MOST_SAMPLES).contains(&count));
    match size.map(usize::try_from) {
        [Ok(x), Ok(y), Ok(z)] if fits => Ok([x, y, z]),
        _ => wrong(
            format!("the file holds {x} × {y} × {z} samples"),
            format!("a grid has from 1 to {MOST_SAMPLES} samples"),
        ),
    }
}

fn read_vol(file: File) -> Result<Samples, Unreadable> {
    let mut header = [0; 48];
    let mut reader = BufReader::new(file);
    if reader.read_exact(&mut header).is_err() {
        return wrong("the file ends within its header of 48 bytes", "write the file anew");
    }
    if &header[..3] != b"VOL" || header[3] != 3 {
        return wrong("the file does not begin with `VOL` and version 3", "write it by Mitsuba 3");
    }
    let word = |n: usize| std::array::from_fn::<u8, 4, _>(|i| header[4 + 4 * n + i]);
    let integer = |n| i32::from_le_bytes(word(n));
    if integer(0) != 1 {
        return wrong(
            format!("the samples have the type {}", integer(0)),
            "type 1 is read: float32",
        );
    }
    if integer(4) != 1 {
        return wrong(format!("the file has {} channels", integer(4)), "one channel is read");
    }
    // A negative size becomes 0, which is refused.
    let size = sizes([1, 2, 3].map(|n| u64::try_from(integer(n)).unwrap_or(0)))?;
    let corner = |n: usize| Point([0, 1, 2].map(|i| f64::from(f32::from_le_bytes(word(n + i)))));
    let bounds = Aabb { low: corner(5), high: corner(8) };
    let bytes = samples(reader, 4 * size.iter().product::<usize>())?;
    let (words, _) = bytes.as_chunks::<4>();
    let values = words.iter().map(|&word| f64::from(f32::from_le_bytes(word))).collect();
    Ok(Samples { size, values, bounds: Some(bounds) })
}

/// The bytes after a header, if there are as many as wanted and no more.
fn samples(file: impl Read, wanted: usize) -> Result<Vec<u8>, Unreadable> {
    let mut bytes = Vec::new();
    // One byte more than wanted shows that a file is too long.
    let rest = file.take(wanted as u64 + 1).read_to_end(&mut bytes);
    if rest.is_ok() && bytes.len() == wanted {
        return Ok(bytes);
    }
    let than = if bytes.len() < wanted { "shorter" } else { "longer" };
    let message = format!("the file is {than} than its {wanted} bytes of samples");
    wrong(message, "write the file anew, with nothing but the samples after the header")
}

fn read_npy(file: File) -> Result<Samples, Unreadable> {
    let cure = "save a float32 or float64 array of shape (nz, ny, nx) by numpy.save";
    let mut file = BufReader::new(file);
    let header = match npy::bytes(&mut file).and_then(|header| npy::parse(&header)) {
        Ok(header) => header,
        Err(error) => return wrong(format!("the header cannot be read: {error}"), cure),
    };
    let &[nz, ny, nx] = header.shape.as_slice() else {
        return wrong(format!("the array has {} dimensions, not 3", header.shape.len()), cure);
    };
    if header.fortran_order {
        return wrong("the array is in Fortran order", "save numpy.ascontiguousarray of it");
    }
    let size = sizes([nx, ny, nz])?;
    let Some(word) = npy::Word::named(&header.kind) else {
        return wrong(format!("the samples have the type {}", header.kind), cure);
    };
    let bytes = samples(file, word.width() * size.iter().product::<usize>())?;
    let mut values = Vec::new();
    word.convert(&bytes, &mut values);
    Ok(Samples { size, values, bounds: None })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::npy::tests::header;

    fn vol(size: [i32; 3], kind: i32, channels: i32, values: &[f32]) -> Vec<u8> {
        let mut bytes = b"VOL\x03".to_vec();
        let integers = [kind, size[0], size[1], size[2], channels];
        bytes.extend(integers.iter().flat_map(|n| n.to_le_bytes()));
        let corners = [0.0f32, 0.0, 0.0, 1.0, 2.0, 3.0];
        bytes.extend(corners.iter().chain(values).flat_map(|x| x.to_le_bytes()));
        bytes
    }

    fn written(name: &str, bytes: &[u8]) -> Result<Samples, Unreadable> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).expect("written");
        read(&path, None)
    }

    #[test]
    fn a_vol_file_is_read() {
        let samples = written("a.vol", &vol([2, 1, 1], 1, 1, &[0.5, 1.0])).expect("a grid");
        assert_eq!((samples.size, samples.values), ([2, 1, 1], vec![0.5, 1.0]));
        assert_eq!(samples.bounds.map(|b| b.high), Some(Point([1.0, 2.0, 3.0])));
    }

    #[test]
    fn bad_vol_files_are_refused() {
        let good = vol([2, 1, 1], 1, 1, &[0.5, 1.0]);
        let long = [&good[..], &[0]].concat();
        let cases = [
            (good[..20].to_vec(), "header"),
            (good[..52].to_vec(), "shorter"),
            (long, "longer"),
            ([b"VOX", &good[3..]].concat(), "VOL"),
            (vol([2, 1, 1], 2, 1, &[0.5, 1.0]), "type 2"),
            (vol([2, 1, 1], 1, 3, &[0.5, 1.0]), "3 channels"),
            (vol([-2, 1, 1], 1, 1, &[0.5, 1.0]), "0 × 1 × 1"),
            (vol([i32::MAX, i32::MAX, i32::MAX], 1, 1, &[]), "samples"),
            (vol([2, 1, 1], 1, 1, &[0.5, f32::NAN]), "(1, 0, 0) is NaN"),
            (vol([1, 2, 1], 1, 1, &[0.5, -1.0]), "(0, 1, 0) is -1"),
        ];
        for (bytes, words) in cases {
            let error = written("a.vol", &bytes).expect_err(words);
            assert!(error.message.contains(words), "{error:?} lacks {words}");
        }
    }

    fn npy(shape: &str, order: &str, values: &[f32]) -> Vec<u8> {
        let words = values.iter().flat_map(|x| x.to_le_bytes());
        header("'<f4'", order, shape).into_iter().chain(words).collect()
    }

    #[test]
    fn an_npy_file_is_read_with_x_fastest() {
        let bytes = npy("(1, 2, 3)", "False", &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        let samples = written("a.npy", &bytes).expect("a grid");
        assert_eq!(samples.size, [3, 2, 1]);
        assert_eq!(samples.values, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    }

    #[test]
    fn bad_npy_files_are_refused() {
        let cases = [
            (npy("(4,)", "False", &[1.0; 4]), "1 dimensions"),
            (npy("(1, 2, 2)", "True", &[1.0; 4]), "Fortran"),
            (npy("(1, 2, 2)", "False", &[f32::INFINITY; 4]), "(0, 0, 0) is inf"),
            ([header("'<i4'", "False", "(1, 1, 1)"), vec![0; 4]].concat(), "<i4"),
            (b"no such thing".to_vec(), "header"),
        ];
        for (bytes, words) in cases {
            let error = written("a.npy", &bytes).expect_err(words);
            assert!(error.message.contains(words), "{error:?} lacks {words}");
        }
        let whole = npy("(1, 2, 2)", "False", &[1.0; 4]);
        let error = written("a.npy", &whole[..whole.len() - 3]).expect_err("truncated");
        assert!(error.message.contains("shorter"));
        let longer = [&whole[..], &[0]].concat();
        assert!(written("a.npy", &longer).expect_err("longer").message.contains("longer"));
        assert!(written("a.raw", &whole).is_err());
        assert!(read(Path::new("nowhere.vol"), None).is_err());
    }
}
