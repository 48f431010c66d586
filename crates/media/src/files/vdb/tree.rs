//! The tree of a grid: tiles of one value, and leaves of 8³ voxels.
//!
//! ```text
//! root      background (f32), numbers of tiles and of children (2 u32)
//!           a tile: origin (3 i32), value (f32), whether it is active (1 byte); a child: origin, and
//! 32³ of 128³ voxels    mask of children, mask of active values, values; then its children
//! 16³ of 8³ voxels      the same
//! leaf      mask of active values; among the blocks, in the same order, that mask and its values
//! ```
//!
//! Within a node z is fastest, then y, then x. Two trees of nodes at the same place are refused.

use std::collections::BTreeSet;

use super::super::bytes::Bytes;
use super::packing::{Packing, count_on, is_on};
use super::{Unreadable, damaged, wrong};

/// Number of voxels of a leaf along each axis.
pub const LEAF: i32 = 8;

/// Maximum number of voxels in tiles, once there are more than [`MAX_TILES`] tiles.
const MAX_VOXELS: u64 = 1 << 27;
const MAX_TILES: usize = 1 << 12;

/// Bytes of a leaf's mask.
const MASK: usize = 64;

/// The edges of tiles, in voxels: of the root, of its children and of theirs.
pub(in crate::files) const EDGES: [i32; 3] = [4096, 128, LEAF];

/// A cube of one value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tile {
    /// Lowest corner.
    pub origin: [i32; 3],
    /// Voxels along each axis.
    pub edge: i32,
    /// The value of all voxels, active or not.
    pub value: f32,
}

/// A cube of 8³ voxels.
#[derive(Debug, Clone, PartialEq)]
pub struct Leaf {
    /// Lowest corner.
    pub origin: [i32; 3],
    /// The value of each voxel, active or not: z fastest, then y, then x.
    pub values: Vec<f32>,
}

/// Contents of a grid; voxels outside tiles and leaves are background.
#[derive(Debug, Clone, PartialEq)]
pub struct Tree {
    /// The value elsewhere.
    pub background: f32,
    /// Tiles of other values.
    pub tiles: Vec<Tile>,
    /// Leaves.
    pub leaves: Vec<Leaf>,
    /// Number of active voxels.
    pub active: u64,
}

impl Tree {
    /// Reads topology and blocks, which begin and end at the last two places.
    pub(super) fn read(
        bytes: &mut Bytes,
        packing: Packing,
        [_, blocks, end]: [usize; 3],
    ) -> Result<Self, Unreadable> {
        let buffers = bytes.number()?;
        if buffers != 1 {
            return damaged(format!("its tree has {buffers} buffers instead of one"));
        }
        let tree = Growing::new(bytes.float()?);
        let mut reader = TreeReader { bytes, packing, tree, masks: Vec::new() };
        reader.root()?;
        if reader.bytes.at() != blocks {
            return damaged("the topology of its tree does not end where its values begin");
        }
        reader.blocks()?;
        if reader.bytes.at() != end {
            return damaged("the values of its tree do not end where its grid does");
        }
        Ok(reader.tree.tree)
    }
}

/// A tree while it is read.
pub(in crate::files) struct Growing {
    /// The part that is read.
    pub(in crate::files) tree: Tree,
    /// Number of voxels in tiles of other values than the background.
    filled: u64,
}

impl Growing {
    /// An empty tree.
    pub(in crate::files) fn new(background: f32) -> Self {
        let (tiles, leaves) = (Vec::new(), Vec::new());
        Self { tree: Tree { background, tiles, leaves, active: 0 }, filled: 0 }
    }

    /// Adds a tile. Tiles do not overlap. Many of them with more voxels than a medium may have are refused, because
    /// a small file can contain very many. A few are kept, so that the error of the medium can state its size.
    pub(in crate::files) fn tile(&mut self, tile: Tile, is_active: bool) -> Result<(), Unreadable> {
        let voxels = u64::from(tile.edge.unsigned_abs()).pow(3);
        if is_active {
            self.tree.active = self.tree.active.saturating_add(voxels);
        }
        if tile.value != self.tree.background {
            self.filled = self.filled.saturating_add(voxels);
            if self.filled > MAX_VOXELS && self.tree.tiles.len() > MAX_TILES {
                let message = format!("its tiles fill more than {MAX_VOXELS} voxels");
                return wrong(
                    message,
                    "sample it more coarsely, or cut it to the part that is needed",
                );
            }
            self.tree.tiles.push(tile);
        }
        Ok(())
    }
}

struct TreeReader<'a, 'b> {
    bytes: &'b mut Bytes<'a>,
    packing: Packing,
    tree: Growing,
    /// The masks of the leaves.
    masks: Vec<&'a [u8]>,
}

impl TreeReader<'_, '_> {
    fn root(&mut self) -> Result<(), Unreadable> {
        let (tiles, children) = (self.bytes.number()?, self.bytes.number()?);
        let mut origins = BTreeSet::new();
        let mut new = |origin: [i32; 3]| {
            if origin.iter().all(|x| x % EDGES[0] == 0) && origins.insert(origin) {
                return Ok(origin);
            }
            damaged(format!("a node of its tree has its origin at {origin:?}"))
        };
        for _ in 0..tiles {
            let origin = new(self.bytes.integers()?)?;
            let value = self.bytes.float()?;
            let is_active = self.bytes.byte()?;
            self.tree.tile(Tile { origin, edge: EDGES[0], value }, is_active != 0)?;
        }
        for _ in 0..children {
            let origin = new(self.bytes.integers()?)?;
            self.node::<5>(1, origin)?;
        }
        Ok(())
    }

    /// A node of `2^LOG` tiles or children along each axis, with the edge of the level.
    fn node<const LOG: usize>(&mut self, level: usize, origin: [i32; 3]) -> Result<(), Unreadable> {
        let size = 1 << (3 * LOG);
        let children = self.bytes.take(size / 8)?;
        let active = self.bytes.take(size / 8)?;
        let values = self.packing.values(self.bytes, active, self.tree.tree.background)?;
        let edge = EDGES[level];
        let place = |at: usize| -> [i32; 3] {
            let axis = |j: usize| at >> (LOG * (2 - j)) & ((1 << LOG) - 1);
            #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap)] // below 32
            std::array::from_fn(|j| origin[j] + axis(j) as i32 * edge)
        };
        for (at, value) in values.into_iter().enumerate() {
            if !is_on(children, at) {
                self.tree.tile(Tile { origin: place(at), edge, value }, is_on(active, at))?;
            }
        }
        for at in (0..size).filter(|&at| is_on(children, at)) {
            if level == 1 {
                self.node::<4>(2, place(at))?;
            } else {
                let mask = self.bytes.take(MASK)?;
                self.tree.tree.active += count_on(mask) as u64;
                self.masks.push(mask);
                self.tree.tree.leaves.push(Leaf { origin: place(at), values: Vec::new() });
            }
        }
        Ok(())
    }

    fn blocks(&mut self) -> Result<(), Unreadable> {
        let Tree { background, ref mut leaves, .. } = self.tree.tree;
        for (leaf, known) in leaves.iter_mut().zip(&self.masks) {
            let mask = self.bytes.take(known.len())?;
            if mask != *known {
                return damaged(format!("the leaf at {:?} has two masks that differ", leaf.origin));
            }
            leaf.values = self.packing.values(self.bytes, mask, background)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_refused_while_they_take_little_memory() {
        // 5000 tiles of 4096³ voxels at the root: more than any medium may have, and more than are kept.
        let mut bytes = [1_u32.to_le_bytes(), 0.0_f32.to_le_bytes()].concat();
        bytes.extend([5000_u32.to_le_bytes(), 0_u32.to_le_bytes()].concat());
        for at in 0..5000_i32 {
            let origin = [at * EDGES[0], 0, 0].map(i32::to_le_bytes).concat();
            bytes.extend([&origin[..], &1.0_f32.to_le_bytes(), &[1]].concat());
        }
        let packing = Packing::new(0, false).expect("a packing");
        let fault = Tree::read(&mut Bytes::new(&bytes), packing, [0, bytes.len(), bytes.len()]);
        assert!(fault.is_err_and(|fault| fault.message.contains("tiles fill more than")));
    }
}
