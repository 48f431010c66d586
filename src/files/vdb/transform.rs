//! From the coordinates of voxels to those of the world.
//!
//! ```text
//! world = scale · index + shift, axis by axis
//! ```
//!
//! Rotated and sheared lattices are not read, for their axes are not those of the world; nor are frusta, in which
//! straight rays are bent.

use super::bytes::Bytes;
use super::header::shown;
use super::{Fault, damaged, wrong};

/// A scale and a translation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform {
    /// World units per voxel along each axis: not zero, and below it where the axis is mirrored.
    pub scale: [f64; 3],
    /// Where the voxel (0, 0, 0) stands.
    pub shift: [f64; 3],
}

impl Transform {
    pub(super) fn read(bytes: &mut Bytes) -> Result<Self, Fault> {
        let kind = bytes.text()?;
        let read = match kind.as_str() {
            "TranslationMap" => Self { scale: [1.0; 3], shift: bytes.doubles()? },
            "ScaleMap" | "UniformScaleMap" => Self { scale: scale(bytes)?, shift: [0.0; 3] },
            "ScaleTranslateMap" | "UniformScaleTranslateMap" => {
                let shift = bytes.doubles()?;
                Self { scale: scale(bytes)?, shift }
            }
            "AffineMap" | "UnitaryMap" => Self::of_matrix(bytes.doubles()?)?,
            "NonlinearFrustumMap" => {
                let help = "resample it to a grid with a scale and a translation";
                return wrong("its voxels stand in a frustum, in which rays are bent", help);
            }
            other => return damaged(format!("its transform is {}, which is none", shown(other))),
        };
        let numbers = read.scale.iter().chain(&read.shift);
        if read.scale.contains(&0.0) || !numbers.clone().all(|x| x.is_finite()) {
            let message = format!(
                "its transform has the scale {:?} and the shift {:?}",
                read.scale, read.shift
            );
            return wrong(message, "give it a scale that is finite and not 0");
        }
        Ok(read)
    }

    /// Of a matrix that points are multiplied with from the left: its last row is the translation.
    fn of_matrix(matrix: [f64; 16]) -> Result<Self, Fault> {
        let at = |row: usize, column: usize| matrix[4 * row + column];
        let places = (0..4).flat_map(|row| (0..4).map(move |column| (row, column)));
        if places.clone().any(|(row, column)| row != column && row < 3 && at(row, column) != 0.0) {
            return wrong(
                "its transform turns or shears the lattice",
                "resample it to one with a scale and a translation, by openvdb::tools::resampleToMatch",
            );
        }
        if at(3, 3) != 1.0 {
            return damaged("its transform is not affine");
        }
        Ok(Self { scale: [0, 1, 2].map(|j| at(j, j)), shift: [0, 1, 2].map(|j| at(3, j)) })
    }
}

/// A scale, and what is known by it: the size of a voxel, and three kinds of inverses.
fn scale(bytes: &mut Bytes) -> Result<[f64; 3], Fault> {
    let scale: [f64; 3] = bytes.doubles()?;
    let size: [f64; 3] = bytes.doubles()?;
    bytes.doubles::<9>()?;
    if scale.map(f64::abs) != size {
        return damaged(format!("its voxels are scaled by {scale:?} and {size:?} large"));
    }
    Ok(scale)
}
