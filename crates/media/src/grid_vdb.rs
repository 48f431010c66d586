//! Grids of `OpenVDB` and `NanoVDB` as samples on a lattice.
//!
//! ```text
//! samples at the indices from (low − 1) to (high + 1), the first and the last voxel that are not background
//! box from the world's place of (low − 1) to that of (high + 1): samples stand on its faces, and those are background
//! ```
//!
//! Linear interpolation between them is that of `OpenVDB`'s `BoxSampler`, inside the box. A tile counts as its
//! voxels of one value, and inactive voxels have their stored values. `OpenVDB`'s background has no end; a medium
//! ends at the box, and is 0 beyond. A mirrored axis is reversed together with its voxels. Where the transform
//! rotates or shears the lattice, rays are transformed into index space, and the bounds are the box about the
//! rotated one.

use super::grid_file::{Samples, Turned, Unreadable, sizes, wrong};
use crate::files::vdb::{LEAF, Transform, Tree, VdbGrid};
use numeric::digits::number;
use numeric::geometry::{Aabb, Point};

/// The samples of a grid.
///
/// # Errors
///
/// The grid has other than finite, non-negative samples, or no end.
pub fn samples(grid: &VdbGrid) -> Result<Samples, Unreadable> {
    if grid.class == "level set" {
        let help = "make a fog volume of it, by openvdb::tools::sdfToFogVolume";
        return wrong("its grid is a level set: distances from a surface", help);
    }
    let background = grid.tree.background;
    if !(background.is_finite() && background >= 0.0) {
        let message = format!("its background is {}", number(background.into()));
        return wrong(message, "an extinction is finite and not negative");
    }
    check_values(&grid.tree)?;
    let Some([low, high]) = reach(&grid.tree) else {
        return wrong("its grid is empty", "give one with voxels other than the background");
    };
    let mut samples = dense(grid, low.map(|n| n - 1), high.map(|n| n + 1))?;
    if background != 0.0 {
        let background = number(background.into());
        samples.remark = format!("its background {background} ends at its box: beyond it σ_t is 0");
    }
    Ok(samples)
}

/// Each value with the lowest corner and the edge of its voxels: once for a tile, 8³ times for a leaf.
pub fn values(tree: &Tree) -> impl Iterator<Item = ([i64; 3], i64, f32)> {
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

/// The lowest and the highest index of voxels that are not background, along each axis.
pub fn reach(tree: &Tree) -> Option<[[i64; 3]; 2]> {
    let others = values(tree).filter(|&(_, _, value)| value != tree.background);
    let ends = others.map(|(from, edge, _)| [from, from.map(|n| n + edge - 1)]);
    ends.reduce(|[low, high], [from, to]| {
        [0, 1].map(|end| {
            std::array::from_fn(|j| if end == 0 { low[j].min(from[j]) } else { high[j].max(to[j]) })
        })
    })
}

/// All samples between two indices.
fn dense(grid: &VdbGrid, low: [i64; 3], high: [i64; 3]) -> Result<Samples, Unreadable> {
    let edges: [u64; 3] = std::array::from_fn(|j| high[j].abs_diff(low[j]) + 1);
    let size = sizes(edges).map_err(|Unreadable { message, help }| Unreadable {
        message: format!("{message}, from index {low:?} to {high:?}"),
        help: format!("{help}: cut out a part, by openvdb::tools::clip, or make its voxels larger"),
    })?;
    let scale = grid.transform.scale();
    let mut samples = vec![f64::from(grid.tree.background); size.iter().product()];
    for (from, edge, value) in values(&grid.tree) {
        if value == grid.tree.background {
            continue;
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the lattice
        let [x, y, z]: [usize; 3] = std::array::from_fn(|j| {
            let is_mirrored = scale.is_some_and(|scale| scale[j] < 0.0);
            (if is_mirrored { high[j] - (from[j] + edge - 1) } else { from[j] - low[j] }) as usize
        });
        let edge = usize::try_from(edge).unwrap_or_default();
        for row in
            (z..z + edge).flat_map(|z| (y..y + edge).map(move |y| (z * size[1] + y) * size[0]))
        {
            samples[row + x..row + x + edge].fill(value.into());
        }
    }
    let (bounds, turned) = if let Some(scale) = scale {
        (along_axes(scale, grid.transform.shift, [low, high])?, None)
    } else {
        let (bounds, turned) = turned(&grid.transform, [low, high])?;
        (bounds, Some(turned))
    };
    let bounds = Some(bounds);
    Ok(Samples { size, values: samples, bounds, turned, ..Samples::default() })
}

const TOO_FAR: &str = "move the grid nearer to 0, or scale it";

/// The box of samples between two indices on a lattice along the axes of the world.
fn along_axes(
    scale: [f64; 3],
    shift: [f64; 3],
    [low, high]: [[i64; 3]; 2],
) -> Result<Aabb, Unreadable> {
    let face = |j: usize, index: i64| scale[j] * index as f64 + shift[j];
    let ends: [[f64; 2]; 3] = std::array::from_fn(|j| [face(j, low[j]), face(j, high[j])]);
    // Where the scale is lost in the rounding of the shift, or either is too large, the faces are not where the
    // voxels are.
    let is_kept = |j: usize| {
        let edge = scale[j].abs() * high[j].abs_diff(low[j]) as f64;
        let [a, b] = ends[j];
        ((b - a).abs() - edge).abs() <= 1e-9 * edge && edge.is_normal() && a.is_finite()
    };
    if !(0..3).all(is_kept) {
        return wrong(
            format!(
                "doubles do not tell its voxels apart at the scale {scale:?} and the shift {shift:?}"
            ),
            TOO_FAR,
        );
    }
    Ok(Aabb { low: Point(ends.map(|[a, b]| a.min(b))), high: Point(ends.map(|[a, b]| a.max(b))) })
}

/// The box about samples between two indices, and the positions of the samples.
fn turned(transform: &Transform, [low, high]: [[i64; 3]; 2]) -> Result<(Aabb, Turned), Unreadable> {
    let corner = |n: usize| {
        transform
            .world(std::array::from_fn(|j| if n >> j & 1 == 1 { high[j] } else { low[j] } as f64))
    };
    let corners: [[f64; 3]; 8] = std::array::from_fn(corner);
    let end = |j: usize, pick: fn(f64, f64) -> f64| {
        corners.iter().map(|corner| corner[j]).reduce(pick).unwrap_or_default()
    };
    let bounds = Aabb {
        low: Point([0, 1, 2].map(|j| end(j, f64::min))),
        high: Point([0, 1, 2].map(|j| end(j, f64::max))),
    };
    let (voxel, shift) = (transform.voxel(), transform.shift);
    let is_kept = |j: usize| {
        let maximum = bounds.low.0[j].abs().max(bounds.high.0[j].abs()).max(shift[j].abs());
        maximum.is_finite()
            && voxel.iter().all(|edge| edge.is_normal() && maximum * f64::EPSILON < 1e-9 * edge)
    };
    if !(0..3).all(is_kept) {
        return wrong(
            format!("doubles do not tell its voxels of {voxel:?} apart at the shift {shift:?}"),
            TOO_FAR,
        );
    }
    Ok((bounds, Turned { origin: corners[0], steps: transform.matrix }))
}
