//! Grids of `OpenVDB` as samples on a lattice.
//!
//! ```text
//! samples at the indices from (low − 1) to (high + 1), the first and the last voxel that are not background
//! box from scale·(low − 1) + shift to scale·(high + 1) + shift: samples stand on its faces, and those are background
//! ```
//!
//! Linear interpolation between them is what `OpenVDB`'s `BoxSampler` finds, everywhere: a tile is as many voxels of one
//! value, and inactive voxels have the value that is stored for them. A mirrored axis is turned about, voxels and all.

use std::fs::File;
use std::io::Read;

use super::grid_file::{Samples, Unreadable, sizes, wrong};
use crate::catalogue::number;
use crate::files::vdb::{self, Fault, Grid, LEAF, Tree};
use crate::geometry::{Aabb, Point};

/// Reads the grid of a name, or the only one.
pub(super) fn read(mut file: File, name: Option<&str>) -> Result<Samples, Unreadable> {
    let mut bytes = Vec::new();
    if let Err(error) = file.read_to_end(&mut bytes) {
        return wrong(error.to_string(), "give a file that can be read");
    }
    let grid =
        vdb::read(&bytes, name).map_err(|Fault { message, help }| Unreadable { message, help })?;
    drop(bytes);
    if grid.class == "level set" {
        let help = "make a fog volume of it, by openvdb::tools::sdfToFogVolume";
        return wrong("its grid is a level set: distances from a surface", help);
    }
    if grid.tree.background != 0.0 {
        return wrong(
            format!(
                "its background is {}, which fills all of space",
                number(grid.tree.background.into())
            ),
            "a medium has an end: give the grid the background 0, and fill the part that is meant",
        );
    }
    check_values(&grid.tree)?;
    let Some([low, high]) = reach(&grid.tree) else {
        return wrong("its grid is empty", "give one with voxels other than the background");
    };
    dense(&grid, low.map(|n| n - 1), high.map(|n| n + 1))
}

/// A value and the first voxel that has it: of a tile once, of a leaf 8³ times.
fn values(tree: &Tree) -> impl Iterator<Item = ([i64; 3], i64, f32)> {
    let tiles =
        tree.tiles.iter().map(|tile| (tile.origin.map(i64::from), tile.edge.into(), tile.value));
    let leaves = tree.leaves.iter().flat_map(|leaf| {
        let origin = leaf.origin.map(i64::from);
        leaf.values.iter().zip(0_i64..).map(move |(&value, n)| {
            let edge = i64::from(LEAF);
            (
                [origin[0] + n / (edge * edge), origin[1] + n / edge % edge, origin[2] + n % edge],
                1,
                value,
            )
        })
    });
    tiles.chain(leaves)
}

fn check_values(tree: &Tree) -> Result<(), Unreadable> {
    let Some(([x, y, z], _, value)) = values(tree).find(|(_, _, x)| !(x.is_finite() && *x >= 0.0))
    else {
        return Ok(());
    };
    wrong(
        format!("its voxel ({x}, {y}, {z}) is {}", number(value.into())),
        "an extinction is finite and not negative",
    )
}

/// The lowest and the highest index along each axis that are not background.
fn reach(tree: &Tree) -> Option<[[i64; 3]; 2]> {
    let others = values(tree).filter(|&(_, _, value)| value != tree.background);
    let ends = others.map(|(from, edge, _)| [from, from.map(|n| n + edge - 1)]);
    ends.reduce(|[low, high], [from, to]| {
        [0, 1].map(|end| {
            std::array::from_fn(|j| if end == 0 { low[j].min(from[j]) } else { high[j].max(to[j]) })
        })
    })
}

/// All samples between two indices.
fn dense(grid: &Grid, low: [i64; 3], high: [i64; 3]) -> Result<Samples, Unreadable> {
    let edges: [u64; 3] = std::array::from_fn(|j| high[j].abs_diff(low[j]) + 1);
    let size = sizes(edges).map_err(|Unreadable { message, help }| Unreadable {
        message: format!("{message}, from index {low:?} to {high:?}"),
        help: format!("{help}: cut out a part, by openvdb::tools::clip, or make its voxels larger"),
    })?;
    let transform = grid.transform;
    let mut samples = vec![f64::from(grid.tree.background); size.iter().product()];
    for (from, edge, value) in values(&grid.tree) {
        if value == grid.tree.background {
            continue;
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the lattice
        let [x, y, z]: [usize; 3] = std::array::from_fn(|j| {
            let is_mirrored = transform.scale[j] < 0.0;
            (if is_mirrored { high[j] - (from[j] + edge - 1) } else { from[j] - low[j] }) as usize
        });
        let edge = usize::try_from(edge).unwrap_or_default();
        for row in
            (z..z + edge).flat_map(|z| (y..y + edge).map(move |y| (z * size[1] + y) * size[0]))
        {
            samples[row + x..row + x + edge].fill(value.into());
        }
    }
    let face = |j: usize, index: i64| transform.scale[j] * index as f64 + transform.shift[j];
    let ends: [[f64; 2]; 3] = std::array::from_fn(|j| [face(j, low[j]), face(j, high[j])]);
    // Where the shift swallows the scale, or either is too large, the faces are not where the voxels say.
    let is_kept = |j: usize| {
        let edge = transform.scale[j].abs() * high[j].abs_diff(low[j]) as f64;
        let [a, b] = ends[j];
        ((b - a).abs() - edge).abs() <= 1e-9 * edge && edge.is_normal() && a.is_finite()
    };
    if !(0..3).all(is_kept) {
        let (scale, shift) = (transform.scale, transform.shift);
        return wrong(
            format!(
                "doubles do not tell its voxels apart at the scale {scale:?} and the shift {shift:?}"
            ),
            "move the grid nearer to 0, or scale it",
        );
    }
    let bounds =
        Aabb { low: Point(ends.map(|[a, b]| a.min(b))), high: Point(ends.map(|[a, b]| a.max(b))) };
    Ok(Samples { size, values: samples, bounds: Some(bounds) })
}
