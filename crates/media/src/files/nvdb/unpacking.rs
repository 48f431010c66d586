//! The bytes of a grid, unpacked.

use std::borrow::Cow;

use super::super::vdb::unpack_blosc;
use super::{Bytes, Unreadable, damaged};

/// Bytes of a piece that Blosc packs.
const PIECE: usize = 1 << 30;

/// Maximum number of bytes that LZ4 makes of one byte.
const MAX_EXPANSION: usize = 256;

/// Unpacks a grid to its size in memory.
pub(super) fn unpacked<'a>(
    stored: &'a [u8],
    codec: &str,
    size: u64,
) -> Result<Cow<'a, [u8]>, Unreadable> {
    let size = usize::try_from(size).unwrap_or(usize::MAX);
    let actual = match codec {
        "zip" => {
            let packed = piece(&mut Bytes::new(stored))?;
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
            let (mut actual, mut bytes) = (vec![0; size], Bytes::new(stored));
            for into in actual.chunks_mut(PIECE) {
                unpack_blosc(piece(&mut bytes)?, into)?;
            }
            Cow::Owned(actual)
        }
        _ => Cow::Borrowed(stored),
    };
    if actual.len() != size {
        return damaged(format!(
            "a grid of {size} bytes is announced, and {} are there",
            actual.len()
        ));
    }
    Ok(actual)
}

/// Bytes with their length before them.
fn piece<'a>(bytes: &mut Bytes<'a>) -> Result<&'a [u8], Unreadable> {
    let length = usize::try_from(bytes.word()?).unwrap_or(usize::MAX);
    bytes.take(length)
}
