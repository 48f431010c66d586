//! The bytes of a grid, unpacked.

use std::borrow::Cow;

use super::super::vdb::unpack_blosc;
use super::{Fault, damaged, part, word};

/// Bytes of a piece that Blosc packs.
const PIECE: usize = 1 << 30;

/// Maximum number of bytes that LZ4 makes of one byte.
const MAX_EXPANSION: usize = 256;

/// Unpacks a grid to its size in memory.
pub(super) fn unpacked<'a>(
    stored: &'a [u8],
    codec: &str,
    size: u64,
) -> Result<Cow<'a, [u8]>, Fault> {
    let size = usize::try_from(size).unwrap_or(usize::MAX);
    let found = match codec {
        "zip" => {
            let packed = piece(stored, 0)?;
            match miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(packed, size) {
                Ok(bytes) => Cow::Owned(bytes),
                Err(_) => return damaged("a zipped grid is not one that must be there"),
            }
        }
        "Blosc" => {
            if size / MAX_EXPANSION > stored.len() {
                return damaged(format!(
                    "{size} bytes of a grid are announced, and {} are stored",
                    stored.len()
                ));
            }
            let (mut bytes, mut at) = (vec![0; size], 0);
            for into in bytes.chunks_mut(PIECE) {
                let packed = piece(stored, at)?;
                unpack_blosc(packed, into)?;
                at += 8 + packed.len();
            }
            Cow::Owned(bytes)
        }
        _ => Cow::Borrowed(stored),
    };
    if found.len() != size {
        return damaged(format!(
            "a grid of {size} bytes is announced, and {} are there",
            found.len()
        ));
    }
    Ok(found)
}

/// Bytes with their length before them.
fn piece(stored: &[u8], at: usize) -> Result<&[u8], Fault> {
    let length = usize::try_from(word(stored, at)?).unwrap_or(usize::MAX);
    part(stored, at + 8, length)
}
