//! The packed values of a node.
//!
//! ```text
//! what is said of inactive values (1 byte)
//!   0 they are the background   1 minus the background   2 one value   6 they are stored as the active ones
//!   3 background and minus it, by a mask   4 one value and the background, by a mask   5 two values, by a mask
//! those values (f32 each), that mask; then the active values alone, or all
//!   as they are, or their length (i64) and so many bytes of zip or Blosc; a length below 1 says: as they are
//! ```
//!
//! Where inactive values are not masked, all values are stored for any first byte.

use exr::prelude::f16;

use super::super::bytes::Bytes;
use super::{Unreadable, blosc, damaged, wrong};

const ZIP: u32 = 1;
const ACTIVE_MASK: u32 = 2;
const BLOSC: u32 = 4;

/// Packing of the values of a grid.
#[derive(Debug, Clone, Copy)]
pub(super) struct Packing {
    compression: u32,
    /// Bytes of a value.
    width: usize,
}

/// Returns whether a mask is on at an index.
pub(in crate::files) fn is_on(mask: &[u8], place: usize) -> bool {
    mask[place / 8] >> (place % 8) & 1 == 1
}

/// Number of indices at which a mask is on.
pub(in crate::files) fn count_on(mask: &[u8]) -> usize {
    mask.iter().map(|byte| byte.count_ones() as usize).sum()
}

impl Packing {
    pub(super) fn new(compression: u32, has_halves: bool) -> Result<Self, Unreadable> {
        if compression > (ZIP | ACTIVE_MASK | BLOSC) {
            let message = format!("its grid is packed by an unknown scheme ({compression})");
            return wrong(message, "write it anew by OpenVDB, with zip, Blosc or no compression");
        }
        Ok(Self { compression, width: if has_halves { 2 } else { 4 } })
    }

    /// The values of a node, given the mask of the active ones.
    pub(super) fn values(
        self,
        bytes: &mut Bytes,
        active: &[u8],
        background: f32,
    ) -> Result<Vec<f32>, Unreadable> {
        let (all, said) = (8 * active.len(), bytes.byte()?);
        if said > 6 {
            return damaged(format!("what it says of inactive values is {said}, not 0 to 6"));
        }
        let mut inactive = [if said == 0 { background } else { -background }, background];
        if matches!(said, 2 | 4 | 5) {
            inactive[0] = bytes.float()?;
        }
        if said == 5 {
            inactive[1] = bytes.float()?;
        }
        let choice = if matches!(said, 3..=5) { bytes.take(active.len())? } else { &[] };
        if self.compression & ACTIVE_MASK == 0 || said == 6 {
            return self.numbers(bytes, all);
        }
        let mut stored = self.numbers(bytes, count_on(active))?.into_iter();
        let value = |place| {
            if is_on(active, place) {
                return stored.next().unwrap_or(background);
            }
            inactive[usize::from(!choice.is_empty() && is_on(choice, place))]
        };
        Ok((0..all).map(value).collect())
    }

    /// Reads `count` unpacked numbers.
    fn numbers(self, bytes: &mut Bytes<'_>, count: usize) -> Result<Vec<f32>, Unreadable> {
        let size = self.width * count;
        let mut room = Vec::new();
        // For zero halves even the length is missing.
        let is_nothing = self.width == 2 && count == 0;
        let stored = if self.compression & (ZIP | BLOSC) == 0 || is_nothing {
            bytes.take(size)?
        } else {
            self.unpacked(bytes, size, &mut room)?
        };
        Ok(if self.width == 2 {
            let words = stored.as_chunks::<2>().0.iter();
            words.map(|&word| f16::from_le_bytes(word).to_f32()).collect()
        } else {
            stored.as_chunks::<4>().0.iter().map(|&word| f32::from_le_bytes(word)).collect()
        })
    }

    fn unpacked<'r, 'a: 'r>(
        self,
        bytes: &mut Bytes<'a>,
        size: usize,
        room: &'r mut Vec<u8>,
    ) -> Result<&'r [u8], Unreadable> {
        let length = bytes.word()?.cast_signed();
        if length <= 0 {
            if length.unsigned_abs() != size as u64 {
                return damaged(format!("{length} bytes are announced where {size} are stored"));
            }
            return bytes.take(size);
        }
        let packed = bytes.take(usize::try_from(length).unwrap_or(usize::MAX))?;
        if size == 0 {
            return Ok(&[]);
        }
        room.resize(size, 0);
        if self.compression & BLOSC != 0 {
            blosc::unpack(packed, room)?;
        } else {
            let unpack = miniz_oxide::inflate::decompress_slice_iter_to_slice;
            if unpack(room, std::iter::once(packed), true, false) != Ok(size) {
                return damaged("zipped values are not those that must be there");
            }
        }
        Ok(room)
    }
}
