//! Transform from the coordinates of voxels to those of the world.
//!
//! ```text
//! world = matrix · index + shift
//! ```
//!
//! Frusta, in which straight rays are bent, are not supported.

use super::super::bytes::Bytes;
use super::{Unreadable, damaged, shown, wrong};
use numeric::geometry::Point;

/// Minimum relative volume of a voxel: flatter lattices are degenerate in double precision.
const FLATTEST: f64 = 1e-9;

/// An affine map from indices to the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform {
    /// World units per voxel: column j is the step from a voxel to the next along index j.
    pub matrix: [[f64; 3]; 3],
    /// World coordinates of the voxel (0, 0, 0).
    pub shift: [f64; 3],
}

impl Transform {
    /// A scale along the axes and a translation.
    fn along_axes(scale: [f64; 3], shift: [f64; 3]) -> Self {
        let entry = |i: usize, j: usize| if i == j { scale[j] } else { 0.0 };
        Self { matrix: [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))), shift }
    }

    /// World units per voxel along each axis, below 0 where an axis is mirrored; `None` where the lattice is turned or
    /// sheared.
    pub fn scale(&self) -> Option<[f64; 3]> {
        let places = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
        let is_plain = places.clone().all(|(i, j)| i == j || self.matrix[i][j] == 0.0);
        is_plain.then(|| [0, 1, 2].map(|j| self.matrix[j][j]))
    }

    /// World coordinates of a position in index space.
    pub fn world(&self, index: [f64; 3]) -> [f64; 3] {
        let row = |i: usize| (0..3).map(|j| self.matrix[i][j] * index[j]).sum::<f64>();
        [0, 1, 2].map(|i| row(i) + self.shift[i])
    }

    /// The edges of a voxel.
    pub fn voxel(&self) -> [f64; 3] {
        self.columns().map(Point::norm)
    }

    fn columns(&self) -> [Point; 3] {
        [0, 1, 2].map(|j| Point([0, 1, 2].map(|i| self.matrix[i][j])))
    }

    pub(super) fn read(bytes: &mut Bytes) -> Result<Self, Unreadable> {
        let kind = bytes.text()?;
        let read = match kind.as_str() {
            "TranslationMap" => Self::along_axes([1.0; 3], bytes.doubles()?),
            "ScaleMap" | "UniformScaleMap" => Self::along_axes(scale(bytes)?, [0.0; 3]),
            "ScaleTranslateMap" | "UniformScaleTranslateMap" => {
                let shift = bytes.doubles()?;
                Self::along_axes(scale(bytes)?, shift)
            }
            "AffineMap" | "UnitaryMap" => Self::of_matrix(bytes.doubles()?)?,
            "NonlinearFrustumMap" => {
                let help = "resample it to a grid with an affine transform";
                return wrong("its voxels stand in a frustum, in which rays are bent", help);
            }
            other => return damaged(format!("its transform is {}, which is none", shown(other))),
        };
        read.checked()
    }

    /// Checks that the transform is finite and does not flatten voxels.
    pub(in crate::files) fn checked(self) -> Result<Self, Unreadable> {
        let mut numbers = self.matrix.iter().flatten().chain(&self.shift);
        let [a, b, c] = self.columns().map(|edge| Point(edge.0.map(|x| x / edge.norm())));
        let volume = a.dot(b.cross(c));
        if numbers.all(|x| x.is_finite()) && volume.abs() > FLATTEST {
            return Ok(self);
        }
        let (matrix, shift) = (self.matrix, self.shift);
        let message = format!("its transform has the matrix {matrix:?} and the shift {shift:?}");
        wrong(
            message,
            "give it a scale that is finite and not 0, and axes that are not in one plane",
        )
    }

    /// The transform of a matrix that points are multiplied with from the left: its last row is the translation.
    fn of_matrix(matrix: [f64; 16]) -> Result<Self, Unreadable> {
        let at = |row: usize, column: usize| matrix[4 * row + column];
        if (0..3).any(|row| at(row, 3) != 0.0) || at(3, 3) != 1.0 {
            return damaged("its transform is not affine");
        }
        let matrix = [0, 1, 2].map(|i| [0, 1, 2].map(|j| at(j, i)));
        Ok(Self { matrix, shift: [0, 1, 2].map(|j| at(3, j)) })
    }
}

/// A scale, and the derived data in the file: the size of a voxel, and three kinds of inverses.
fn scale(bytes: &mut Bytes) -> Result<[f64; 3], Unreadable> {
    let scale: [f64; 3] = bytes.doubles()?;
    let size: [f64; 3] = bytes.doubles()?;
    bytes.doubles::<9>()?;
    if scale.map(f64::abs) != size {
        return damaged(format!("its voxels are scaled by {scale:?} and {size:?} large"));
    }
    Ok(scale)
}
