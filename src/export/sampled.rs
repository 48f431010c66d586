//! A field as a renderer sees it: samples in single precision in the middle of cells.
//!
//! ```text
//! sample (i, j, k) = σ_t at low + ((i, j, k) + ½) · (high − low)/n,   rounded to single precision
//! ```
//!
//! Written as a `.vol` file, see `trueflight explain grid`, whose truth is that of the page `grid`.

use super::single;
use media::{Medium, Volume};
use numeric::geometry::{Aabb, Point};

/// The name of the file.
pub const FILE: &str = "density.vol";

/// The name of the file of one channel of several, counted from 0.
pub fn file_of(channel: usize) -> String {
    format!("density-{}.vol", channel + 1)
}

/// Samples in a box.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    /// How many along x, y and z.
    pub size: [usize; 3],
    /// `values[(z·ny + y)·nx + x]`, 1/length.
    pub values: Vec<f32>,
    /// The box, of corners in single precision.
    pub bounds: Aabb,
    /// Whether a lookup takes the nearest sample; otherwise it is trilinear.
    pub nearest: bool,
}

impl Sampled {
    /// A field in space.
    pub fn of_volume(volume: &Volume, bounds: Aabb, size: [usize; 3], nearest: bool) -> Self {
        let bounds =
            Aabb { low: Point(bounds.low.0.map(single)), high: Point(bounds.high.0.map(single)) };
        let place = |axis: usize, index: usize| {
            let edge = bounds.high.0[axis] - bounds.low.0[axis];
            bounds.low.0[axis] + (index as f64 + 0.5) * edge / size[axis] as f64
        };
        let mut values = Vec::with_capacity(size.iter().product());
        for z in 0..size[2] {
            for y in 0..size[1] {
                for x in 0..size[0] {
                    let at = Point([place(0, x), place(1, y), place(2, z)]);
                    values.push(rounded(volume.extinction_at(at)));
                }
            }
        }
        Self { size, values, bounds, nearest }
    }

    /// A field along a line, as layers along z that begin at 0, in a box as wide to both sides as it is long.
    ///
    /// Two samples in x and y: where samples beyond the box are zero, one would not be the same on its whole width.
    pub fn of_line(medium: &Medium, cells: usize) -> Self {
        let support = medium.support();
        let length = single(support.length());
        let step = support.length() / cells as f64;
        let layer = |z: usize| rounded(medium.extinction(support.from + (z as f64 + 0.5) * step));
        let values = (0..cells).flat_map(|z| [layer(z); 4]).collect();
        let bounds = Aabb { low: Point([-length, -length, 0.0]), high: Point([length; 3]) };
        Self { size: [2, 2, cells], values, bounds, nearest: false }
    }

    /// The largest sample, which is the majorant of renderers.
    pub fn peak(&self) -> f64 {
        self.values.iter().fold(0.0, |peak, &value| peak.max(f64::from(value)))
    }

    /// Whether every sample can be an extinction.
    pub fn is_extinction(&self) -> bool {
        self.values.iter().all(|value| value.is_finite() && *value >= 0.0)
    }
}

/// The bytes of a `.vol` file of one channel, or of three: of two the second stands for the third, too.
pub fn vol(channels: &[&Sampled]) -> Vec<u8> {
    let Some(first) = channels.first() else { return Vec::new() };
    let count = if channels.len() > 1 { 3 } else { 1 };
    let mut bytes = b"VOL\x03".to_vec();
    let size = first.size.map(|n| i32::try_from(n).unwrap_or(i32::MAX));
    for integer in [1, size[0], size[1], size[2], count] {
        bytes.extend(integer.to_le_bytes());
    }
    let Aabb { low, high } = first.bounds;
    for corner in [low, high] {
        corner.0.iter().for_each(|&x| bytes.extend(rounded(x).to_le_bytes()));
    }
    let of_channel = |channel: i32| {
        usize::try_from(channel).ok().and_then(|n| channels.get(n)).or(channels.last())
    };
    let channels: Vec<&Sampled> = (0..count).filter_map(of_channel).copied().collect();
    for index in 0..first.values.len() {
        for grid in &channels {
            bytes.extend(grid.values[index].to_le_bytes());
        }
    }
    bytes
}

#[allow(clippy::cast_possible_truncation)] // samples are of single precision
fn rounded(x: f64) -> f32 {
    x as f32
}
