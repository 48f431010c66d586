//! `NanoVDB`'s files: grids of `OpenVDB` in their memory layout.
//!
//! ```text
//! a segment   magic "NanoVDB0" or "NanoVDB2" (8 bytes), version (u32), number of grids and codec (2 u16)
//!             for each grid: sizes in memory and in the file, hash of the name, active voxels (4 u64), type, class (2 u32),
//!             boxes (6 f64, 6 i32), voxel (3 f64), length of the name (u32), nodes and tiles (7 u32), codec (u16), 2 bytes,
//!             version (u32), name with its 0; then the grids themselves
//! a grid      GridData (672 bytes), TreeData (64), root with its tiles, nodes of 32³, 16³ and 8³: see `nodes.rs`
//! codec       0 none; 1 length (u64) and zlib; 2 length (u64) and Blosc, for each 2³⁰ bytes
//! ```
//!
//! All numbers are little-endian. Supported are versions 32.x, which have one layout, and grids of the types Float,
//! Fp4, Fp8, Fp16 and `FpN`. A file that begins with `NanoVDB1` is one grid in its memory layout. Other types are
//! named in the error.
//!
//! No crate reads these files. No position in the file is trusted: each part is taken from existing bytes, and no
//! more nodes are visited than fit into them.
//!
//! Source: K. Museth, *`NanoVDB`: A GPU-Friendly and Portable VDB Data Structure For Real-Time Rendering And Simulation*,
//! SIGGRAPH Talks 2021; the layout is that of `NanoVDB.h`, `PNanoVDB.h` and `io/IO.h`, versions 32.4 and 32.9.

mod listing;
mod nodes;
mod unpacking;

use super::bytes::Bytes;
use super::vdb::{Transform, VdbGrid};
use super::{Unreadable, chosen, damaged, shown, wrong};
pub use listing::{NvdbEntry, list};

/// Bytes before the tree.
const GRID: usize = 672;

const CONVERT: &str = "grids of the types Float, Fp4, Fp8, Fp16 and FpN are read: write one of them by nanovdb_convert";

/// Reads the grid of a name; without a name, the file's only grid of floats.
///
/// # Errors
///
/// The file is not one of the kind that is described above, or has no such grid.
pub fn read(file: &[u8], name: Option<&str>) -> Result<VdbGrid, Unreadable> {
    let grids = list(file)?;
    let about = |grid: &NvdbEntry| (grid.name.clone(), grid.is_read(), grid.shown());
    let result = chosen(&grids, name, about, CONVERT)?;
    let Some(values) = nodes::LeafValues::of(result.number) else {
        let message = format!("its grid {} has the type {}", shown(&result.name), result.kind);
        return wrong(message, CONVERT);
    };
    let [from, to] = result.place;
    let grid = unpacking::unpacked(&file[from..to], result.codec, result.size)?;
    let tree = nodes::read(&grid, values)?;
    if tree.active != result.active {
        let (said, result) = (result.active, tree.active);
        return damaged(format!("{said} voxels are announced to be active, and {result} are"));
    }
    let (name, class) = (result.name.clone(), result.class.clone());
    Ok(VdbGrid { name, class, transform: transform(&grid)?, tree })
}

/// The map in double precision, 296 bytes from the beginning of a grid.
fn transform(grid: &[u8]) -> Result<Transform, Unreadable> {
    let rows: [f64; 9] = Bytes::at_byte(grid, 296 + 88).doubles()?;
    let shift = Bytes::at_byte(grid, 296 + 232).doubles()?;
    let matrix = [0, 1, 2].map(|i| [0, 1, 2].map(|j| rows[3 * i + j]));
    Transform { matrix, shift }.checked()
}
