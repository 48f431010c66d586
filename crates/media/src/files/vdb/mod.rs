//! `OpenVDB`'s files: sparse grids of floats, by name.
//!
//! ```text
//! magic " BDV" and 4 zeros, version, library (2 u32), whether grids have offsets (1 byte), UUID (36 bytes),
//! metadata, number of grids; then for each grid
//!   its name, its type, the name of the grid whose tree it shares, where it begins, its blocks begin and it ends;
//!   compression, metadata, transform, topology of the tree; then the blocks: the values of its leaves
//! ```
//!
//! All numbers are little-endian; a text is its length (u32) and its bytes. The reader supports versions 222 to 224
//! (`OpenVDB` 10 writes the last; this layout is common to all three) and grids of the type `Tree_float_5_4_3`.
//! Their numbers are float32 or float16, packed by every scheme that the library writes: none, zip, Blosc with LZ4,
//! with and without the mask of active values. Transforms are affine; frusta are refused.
//!
//! No count in the file is trusted: memory is allocated as bytes are read, and positions in the file must be those
//! where its parts end. The crate `vdb-rs` (0.6) trusts them, panics at other versions, and needs a C compiler.
//!
//! Source: K. Museth, *VDB: High-Resolution Sparse Volumes with Dynamic Topology*, ACM Transactions on Graphics 32
//! (2013), for the tree; the layout is that of `openvdb/io` and `openvdb/tree` in `OpenVDB` 10.

mod blosc;
mod header;
mod packing;
mod transform;
mod tree;

pub(in crate::files) use blosc::unpack as unpack_blosc;
use header::{GridHeader, Head};
use packing::Packing;
pub(in crate::files) use packing::{count_on, is_on};
pub use transform::Transform;
pub(in crate::files) use tree::{EDGES, Growing};
pub use tree::{LEAF, Leaf, Tile, Tree};

pub use super::Unreadable;
use super::bytes::Bytes;
use super::{chosen, damaged, shown, wrong};

/// A grid of floats.
#[derive(Debug, Clone, PartialEq)]
pub struct VdbGrid {
    /// Name.
    pub name: String,
    /// Class from the metadata, such as `fog volume` or `level set`; empty without one.
    pub class: String,
    /// Transform from indices to the world.
    pub transform: Transform,
    /// Voxels.
    pub tree: Tree,
}

/// Entry of a grid in a file, without its tree.
#[derive(Debug, Clone, PartialEq)]
pub struct VdbEntry {
    /// Name.
    pub name: String,
    /// Type, such as `Tree_float_5_4_3`.
    pub kind: String,
    /// Class, such as `fog volume`; empty without one.
    pub class: String,
    /// Number of active voxels, if the file states it.
    pub active: Option<u64>,
    /// Transform from indices to the world.
    pub transform: Transform,
    /// True if [`read`] supports the type.
    pub is_read: bool,
}

/// An entry, or the name of a grid and the fault of its beginning.
pub type Entered = Result<VdbEntry, (String, Unreadable)>;

/// Lists the grids of a file.
///
/// # Errors
///
/// The file is not one of the kind that is described above.
pub fn list(file: &[u8]) -> Result<Vec<Entered>, Unreadable> {
    let mut bytes = Bytes::new(file);
    let entries = header::entries(&mut bytes)?;
    let mut listed = Vec::new();
    for entry in &entries {
        let head = Head::read(&mut bytes, entry);
        listed.push(head.map_err(|fault| (entry.name(), fault)).map(|head| VdbEntry {
            name: entry.name(),
            kind: entry.kind.clone(),
            class: head.class,
            active: head.voxels,
            transform: head.transform,
            is_read: entry.has_floats(),
        }));
    }
    Ok(listed)
}

/// Reads the grid of a name; without a name, the file's only grid of floats.
///
/// # Errors
///
/// The file is not one of the kind that is described above, or has no such grid.
pub fn read(file: &[u8], name: Option<&str>) -> Result<VdbGrid, Unreadable> {
    let mut bytes = Bytes::new(file);
    let entries = header::entries(&mut bytes)?;
    let about = |entry: &GridHeader| (entry.name(), entry.has_floats(), entry.shown());
    let entry = chosen(&entries, name, about, CONVERT)?;
    if !entry.has_floats() {
        let message =
            format!("its grid {} has the type {}", shown(&entry.name()), shown(&entry.kind));
        return wrong(message, CONVERT);
    }
    grid(&mut bytes, entry, &entries)
}

const CONVERT: &str = "a grid of the type Tree_float_5_4_3 is read: OpenVDB's FloatGrid";

fn grid(
    bytes: &mut Bytes,
    entry: &GridHeader,
    entries: &[GridHeader],
) -> Result<VdbGrid, Unreadable> {
    let own = Head::read(bytes, entry)?;
    // A grid that shares its tree has only a transform.
    let (head, owner) = if entry.parent.is_empty() {
        (None, entry)
    } else {
        let owner = entries.iter().find(|other| other.key == entry.parent && other.has_floats());
        let Some(owner) = owner.filter(|owner| owner.parent.is_empty()) else {
            return damaged(format!(
                "it has no grid {}, whose tree is shared",
                shown(&entry.parent)
            ));
        };
        (Some(Head::read(bytes, owner)?), owner)
    };
    let head = head.as_ref().unwrap_or(&own);
    let packing = Packing::new(head.compression, owner.has_halves())?;
    let tree = Tree::read(bytes, packing, owner.places)?;
    if let Some(voxels) = head.voxels.filter(|&voxels| voxels != tree.active) {
        let message =
            format!("{voxels} voxels are announced to be active, and {} are", tree.active);
        return wrong(
            message,
            "the file is damaged, or its `file_voxel_count` is another grid's: write it anew",
        );
    }
    Ok(VdbGrid { name: entry.name(), class: own.class, transform: own.transform, tree })
}
