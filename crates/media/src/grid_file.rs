//! Voxel grids in files, by the extension of their names.
//!
//! ```text
//! .vol    Mitsuba: float32, float16 or uint8 (255 is 1), of one channel or of several (files/vol.rs)
//! .npy    NumPy: an array of three axes of real numbers, in C or Fortran order; `axes` names the order of the axes
//! .vdb    OpenVDB (files/vdb), .nvdb NanoVDB (files/nvdb): see grid_vdb.rs
//! .pbrt   pbrt: the density of a `uniformgrid` medium (files/pbrt)
//! ```
//!
//! A grid has at most 2²⁷ samples, and every sample is finite and not negative.

use std::path::Path;

use super::axes::Axes;
use super::grid_vdb;
use crate::files::number::NumberType;
use crate::files::vol::Vol;
use crate::files::{npy, nvdb, pbrt, vdb};
use crate::formats::Format;
use numeric::digits::number;
use numeric::geometry::{Aabb, Point};

pub(super) use crate::files::wrong;

/// The samples of a grid, x fastest.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Samples {
    /// Number of samples along x, y and z.
    pub size: [usize; 3],
    /// `values[(z·ny + y)·nx + x]`.
    pub values: Vec<f64>,
    /// The corners of the box in the file; they may not form one.
    pub bounds: Option<Aabb>,
    /// Positions of the samples, if their axes are not those of the world.
    pub turned: Option<Turned>,
    /// A remark for users of the grid; often empty.
    pub remark: String,
}

/// A lattice with axes of its own: sample i is at origin + steps · i.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turned {
    /// The position of the first sample.
    pub origin: [f64; 3],
    /// Column j is the step from a sample to the next along axis j.
    pub steps: [[f64; 3]; 3],
}

pub use crate::files::Unreadable;

/// The largest number of samples, 1 GiB of doubles.
pub const MAX_SAMPLES: u64 = 1 << 27;

impl Format {
    /// Returns whether the file has the positions of its voxels.
    pub fn has_transform(self) -> bool {
        matches!(self, Self::Vdb | Self::Nvdb)
    }

    /// Returns whether grids have names.
    pub fn has_names(self) -> bool {
        matches!(self, Self::Vdb | Self::Nvdb | Self::Pbrt)
    }
}

/// Part of a file that is read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GridChoice {
    /// The name of a grid; `None` for the only one.
    pub grid: Option<String>,
    /// The channel, counted from 0; `None` for the only one.
    pub channel: Option<usize>,
    /// The order of an array's axes.
    pub axes: Axes,
}

/// Function that reads a grid from the bytes of a file.
pub type GridReader = fn(&[u8], &GridChoice) -> Result<Samples, Unreadable>;

/// Returns the reader of grids of a format; `None` for formats that hold none.
pub fn reader(format: Format) -> Option<GridReader> {
    Some(match format {
        Format::Vol => |bytes, choice| read_vol(bytes, choice.channel),
        Format::Npy => |bytes, choice| read_npy(bytes, choice.axes),
        Format::Vdb => {
            |bytes, choice| grid_vdb::samples(&vdb::read(bytes, choice.grid.as_deref())?)
        }
        Format::Nvdb => {
            |bytes, choice| grid_vdb::samples(&nvdb::read(bytes, choice.grid.as_deref())?)
        }
        Format::Pbrt => |bytes, choice| read_pbrt(bytes, choice.grid.as_deref()),
        Format::Exr | Format::Pfm | Format::Table | Format::Doubles | Format::Singles => {
            return None;
        }
    })
}

/// Reads a grid.
///
/// # Errors
///
/// The file is no grid of finite, non-negative samples.
pub fn read(path: &Path, choice: &GridChoice) -> Result<Samples, Unreadable> {
    let Some(reader) = Format::of(path).and_then(reader) else {
        let grids = Format::list(|format| reader(format).is_some());
        return wrong(format!("the file is none of {grids}"), "convert it to one of them");
    };
    let bytes = match std::fs::read(path) {
        Ok(bytes) => bytes,
        Err(error) => {
            return wrong(error.to_string(), "the name is relative to the case file's folder");
        }
    };
    let samples = reader(&bytes, choice)?;
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
    let fits = count.is_some_and(|count| (1..=MAX_SAMPLES).contains(&count));
    match size.map(usize::try_from) {
        [Ok(x), Ok(y), Ok(z)] if fits => Ok([x, y, z]),
        _ => wrong(
            format!("the file holds {x} × {y} × {z} samples"),
            format!("a grid has from 1 to {MAX_SAMPLES} samples"),
        ),
    }
}

fn plain(size: [usize; 3], values: Vec<f64>, corners: Option<[[f64; 3]; 2]>) -> Samples {
    let bounds = corners.map(|[low, high]| Aabb { low: Point(low), high: Point(high) });
    Samples { size, values, bounds, ..Samples::default() }
}

fn read_vol(bytes: &[u8], channel: Option<usize>) -> Result<Samples, Unreadable> {
    let vol = Vol::read(bytes)?;
    let size = sizes(vol.size)?;
    let last = vol.channels.saturating_sub(1);
    let channel = match channel {
        Some(channel) if (channel as u64) < vol.channels => channel,
        Some(channel) => {
            let message = format!("the file has no channel {channel}: it has {}", vol.channels);
            return wrong(message, format!("choose one from 0 to {last}"));
        }
        None if vol.channels == 1 => 0,
        None => {
            return wrong(
                format!("the file has {} channels", vol.channels),
                format!("choose one: `channel = 0`, up to {last}"),
            );
        }
    };
    Ok(plain(size, vol.values(channel), Some(vol.corners)))
}

fn read_pbrt(bytes: &[u8], name: Option<&str>) -> Result<Samples, Unreadable> {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return wrong("the file is no text", "give a scene file of pbrt that is not packed");
    };
    let grid = pbrt::read(text, name)?;
    Ok(plain(sizes(grid.size)?, grid.density, Some(grid.corners)))
}

/// The words of an error about an array.
const ARRAY: &str = "save an array of real numbers with three axes, (nz, ny, nx), by numpy.save";

fn read_npy(mut bytes: &[u8], axes: Axes) -> Result<Samples, Unreadable> {
    let header = match npy::bytes(&mut bytes).and_then(|header| npy::parse(&header)) {
        Ok(header) => header,
        Err(error) => return wrong(format!("the header cannot be read: {error}"), ARRAY),
    };
    let &[a, b, c] = header.shape.as_slice() else {
        let shape = header.written_shape();
        return wrong(format!("the array has the shape {shape}, not three axes"), ARRAY);
    };
    let Ok(shape) = sizes([a, b, c]) else {
        let shape = header.written_shape();
        return wrong(
            format!("the array has the shape {shape}"),
            format!("a grid has from 1 to {MAX_SAMPLES} samples"),
        );
    };
    let Some(number) = NumberType::named(&header.kind) else {
        return wrong(format!("the samples have the type {}", header.kind), ARRAY);
    };
    let expected = number.width() * shape.iter().product::<usize>();
    if bytes.len() != expected {
        let than = if bytes.len() < expected { "shorter" } else { "longer" };
        let message = format!("the file is {than} than its {expected} bytes of samples");
        return wrong(
            message,
            "write the file anew, with nothing but the samples after the header",
        );
    }
    let (size, values) = axes.sorted(shape, header.fortran_order, number.all(bytes));
    Ok(plain(size, values, None))
}
