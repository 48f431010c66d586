//! The nodes of a grid in memory.
//!
//! ```text
//! tree    at byte 672: where leaves, nodes of 16³, nodes of 32³ and the root begin, from here on (4 u64)
//! root    box (6 i32), number of tiles (u32), background (f32), …; at byte 64 the tiles of 32 bytes:
//!         key (u64: x, y and z without their lower 12 bits, 21 bits each, z lowest), child from the root on or 0 (i64),
//!         whether it is active (u32), value (f32)
//! 32³     box, flags (32 bytes), mask of active values, mask of children (4096 bytes each), …;
//!         at byte 8256 a value (f32) or a child from here on (i64) for each of 32³ places, 8 bytes each
//! 16³     the same with masks of 512 bytes, and the table at byte 1088
//! leaf    box (12 bytes), edges (3 bytes), flags (1 byte), mask of active values (64 bytes), …; at byte 96 the values:
//!         float32, or codes of 4, 8, 16 or 2^(flags/32) bits: value = minimum + code · quantum, (2 f32 at byte 80)
//! ```
//!
//! Within a node z is fastest, then y, then x.

use super::super::vdb::{EDGES, Growing, LEAF, Leaf, Tile, Tree, count_on, is_on};
use super::{Bytes, GRID, Unreadable, damaged};

/// Storage of the values of leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LeafValues {
    /// float32.
    Whole,
    /// Codes of `2^log` bits.
    Codes {
        /// The binary logarithm of the number of bits.
        log: u32,
    },
    /// Codes with a number of bits that each leaf states.
    Varied,
}

impl LeafValues {
    /// The values of a type.
    pub(super) fn of(kind: u32) -> Option<Self> {
        match kind {
            1 => Some(Self::Whole),
            13 => Some(Self::Codes { log: 2 }),
            14 => Some(Self::Codes { log: 3 }),
            15 => Some(Self::Codes { log: 4 }),
            16 => Some(Self::Varied),
            _ => None,
        }
    }
}

/// Bytes of a leaf before its values.
const LEAF_HEAD: usize = 96;
const ROOT_HEAD: usize = 64;
const ROOT_TILE: usize = 32;

/// An inner level: the binary logarithm of places along an axis, and the beginning of its table.
struct Level {
    log: usize,
    table: usize,
    edge: i32,
}

const LEVELS: [Level; 2] =
    [Level { log: 5, table: 8256, edge: EDGES[1] }, Level { log: 4, table: 1088, edge: EDGES[2] }];

struct NodeReader<'a> {
    bytes: &'a [u8],
    values: LeafValues,
    tree: Growing,
    /// Bytes of the nodes that were visited.
    visited: usize,
}

/// Reads the tree of a grid.
pub(super) fn read(bytes: &[u8], values: LeafValues) -> Result<Tree, Unreadable> {
    let root = from(GRID, Bytes::at_byte(bytes, GRID + 24).word()?.cast_signed())?;
    let mut head = Bytes::at_byte(bytes, root + 24);
    let (tiles, background) = (head.number()?, head.float()?);
    let mut reader = NodeReader { bytes, values, tree: Growing::new(background), visited: 0 };
    for tile in 0..tiles as usize {
        reader.root_tile(root, root + ROOT_HEAD + ROOT_TILE * tile)?;
    }
    Ok(reader.tree.tree)
}

/// The position at a distance from another.
fn from(place: usize, distance: i64) -> Result<usize, Unreadable> {
    let actual = i64::try_from(place).ok().and_then(|place| place.checked_add(distance));
    match actual.and_then(|actual| usize::try_from(actual).ok()) {
        Some(actual) => Ok(actual),
        None => damaged(format!("a node stands {distance} bytes from byte {place} on")),
    }
}

impl NodeReader<'_> {
    fn root_tile(&mut self, root: usize, at: usize) -> Result<(), Unreadable> {
        let mut tile = Bytes::at_byte(self.bytes, at);
        let key = tile.word()?;
        let axis = |shift: u32| -> i32 {
            // Twenty bits of them are those of a coordinate.
            let high = (key >> shift) & 0xf_ffff;
            ((high as u32) << 12).cast_signed()
        };
        let origin = [axis(42), axis(21), axis(0)];
        let child = tile.word()?.cast_signed();
        if child != 0 {
            return self.node(0, from(root, child)?, origin);
        }
        let (active, value) = (tile.number()?, tile.float()?);
        self.tree.tile(Tile { origin, edge: EDGES[0], value }, active != 0)
    }

    /// A node of a level; its children are nodes of the next.
    fn node(&mut self, level: usize, at: usize, origin: [i32; 3]) -> Result<(), Unreadable> {
        let Level { log, table, edge } = LEVELS[level];
        let size = 1_usize << (3 * log);
        self.visit(table + 8 * size)?;
        let mut masks = Bytes::at_byte(self.bytes, at + 32);
        let (active, children) = (masks.take(size / 8)?, masks.take(size / 8)?);
        let entries = Bytes::at_byte(self.bytes, at + table).take(8 * size)?;
        for (place, entry) in entries.as_chunks::<8>().0.iter().enumerate() {
            let axis = |j: usize| place >> (log * (2 - j)) & ((1 << log) - 1);
            #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap)] // below 32
            let corner = std::array::from_fn(|j| origin[j].wrapping_add(axis(j) as i32 * edge));
            if !is_on(children, place) {
                let [a, b, c, d, ..] = *entry;
                let value = f32::from_le_bytes([a, b, c, d]);
                self.tree.tile(Tile { origin: corner, edge, value }, is_on(active, place))?;
                continue;
            }
            let child = from(at, i64::from_le_bytes(*entry))?;
            if level == 0 {
                self.node(1, child, corner)?;
            } else {
                self.leaf(child, corner)?;
            }
        }
        Ok(())
    }

    fn leaf(&mut self, at: usize, origin: [i32; 3]) -> Result<(), Unreadable> {
        let mut bytes = Bytes::at_byte(self.bytes, at);
        let head = bytes.take(LEAF_HEAD)?;
        let log = match self.values {
            LeafValues::Whole => 5,
            LeafValues::Codes { log } => log,
            LeafValues::Varied => u32::from(head[15] >> 5),
        };
        let count = usize::try_from(LEAF * LEAF * LEAF).unwrap_or_default();
        if log > 5 || (log == 5 && self.values != LeafValues::Whole) {
            return damaged(format!("the values of the leaf at {origin:?} have 2^{log} bits"));
        }
        let size = (count << log) / 8;
        self.visit(LEAF_HEAD + size)?;
        let stored = bytes.take(size)?;
        self.tree.tree.active += count_on(&head[16..80]) as u64;
        let values = if self.values == LeafValues::Whole {
            stored.as_chunks::<4>().0.iter().map(|&word| f32::from_le_bytes(word)).collect()
        } else {
            let [minimum, quantum] = Bytes::at_byte(head, 80).floats()?;
            (0..count).map(|place| code(stored, place, log) * quantum + minimum).collect()
        };
        self.tree.tree.leaves.push(Leaf { origin, values });
        Ok(())
    }

    /// Counts the bytes of a node: in a damaged file a node may be visited without end.
    fn visit(&mut self, size: usize) -> Result<(), Unreadable> {
        self.visited = self.visited.saturating_add(size);
        if self.visited > self.bytes.len() {
            return damaged("its nodes are more than there are bytes");
        }
        Ok(())
    }
}

/// A code of `2^log` bits, the lowest first.
fn code(stored: &[u8], place: usize, log: u32) -> f32 {
    let bit = place << log;
    let byte = stored[bit / 8];
    match log {
        0 => f32::from(byte >> (bit % 8) & 0x1),
        1 => f32::from(byte >> (bit % 8) & 0x3),
        2 => f32::from(byte >> (bit % 8) & 0xf),
        3 => f32::from(byte),
        _ => f32::from(u16::from_le_bytes([byte, stored[bit / 8 + 1]])),
    }
}
