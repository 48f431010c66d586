//! Frames of Blosc 1, as `OpenVDB` writes them: blocks of LZ4, their bytes shuffled.
//!
//! ```text
//! version 2, version of the format, flags, bytes of a number (4 u8), bytes, bytes of a block, bytes of the frame (3 u32)
//! flags: 1 shuffled, 2 stored as it is, 4 bits shuffled, 16 blocks not split, from 32 on the scheme: 1 is LZ4
//! then where each block begins (u32), from the first byte of the frame on; a block is one stream, or one for each
//! byte of a number: length (u32) and bytes, which are stored as they are where they are no fewer than those they stand for
//! ```
//!
//! Source: *Blosc Chunk Format*, `README_CHUNK_FORMAT.rst` of c-blosc 1.21; LZ4 by the crate `lz4_flex`.

use super::super::bytes::Bytes;
use super::{Unreadable, damaged, wrong};

/// Minimum number of bytes of a stream into which a block is split, and maximum number of streams.
const LEAST_STREAM: usize = 128;
const MAX_STREAMS: usize = 16;

/// Unpacks a frame into exactly the length of `into`.
pub(in crate::files) fn unpack(frame: &[u8], into: &mut [u8]) -> Result<(), Unreadable> {
    let mut head = Bytes::new(frame);
    let [version, _, flags, width] = head.number()?.to_le_bytes();
    let [size, block, whole] = [head.number()?, head.number()?, head.number()?].map(|n| n as usize);
    let width = usize::from(width);
    if version != 2 || size != into.len() || whole != frame.len() || width == 0 {
        return damaged("a frame of Blosc does not hold the values that it must");
    }
    if flags & 2 != 0 {
        let stored = head.take(size)?;
        into.copy_from_slice(stored);
        return Ok(());
    }
    if flags >> 5 != 1 || flags & 4 != 0 {
        return wrong(
            format!("values are packed by Blosc in a scheme of its own (flags {flags})"),
            "LZ4 is read, which OpenVDB writes: write the file anew by OpenVDB",
        );
    }
    if block == 0 {
        return damaged("a frame of Blosc has blocks without length");
    }
    let mut shuffled = vec![0; block.min(size)];
    for part in into.chunks_mut(block) {
        let begin = head.number()? as usize;
        let is_split = flags & 16 == 0
            && part.len() == block
            && width <= MAX_STREAMS
            && block / width >= LEAST_STREAM;
        let streams = if is_split { width } else { 1 };
        let mut source = Bytes::at_byte(frame, begin);
        if flags & 1 != 0 && width > 1 {
            let shuffled = &mut shuffled[..part.len()];
            unpack_streams(&mut source, streams, shuffled)?;
            unshuffle(shuffled, width, part);
        } else {
            unpack_streams(&mut source, streams, part)?;
        }
    }
    Ok(())
}

fn unpack_streams(source: &mut Bytes, streams: usize, into: &mut [u8]) -> Result<(), Unreadable> {
    if !into.len().is_multiple_of(streams) {
        return damaged("a block of Blosc cannot be split");
    }
    for part in into.chunks_exact_mut(into.len() / streams) {
        let length = source.number()? as usize;
        let packed = source.take(length)?;
        if length == part.len() {
            part.copy_from_slice(packed);
            continue;
        }
        let unpacked = lz4_flex::block::decompress_into(packed, part);
        if unpacked.ok() != Some(part.len()) {
            return damaged("a block of LZ4 does not hold the values that it must");
        }
    }
    Ok(())
}

/// Joins first bytes, second bytes and so on to numbers; bytes of an incomplete number are at the end.
fn unshuffle(from: &[u8], width: usize, into: &mut [u8]) {
    let count = from.len() / width;
    for (place, byte) in from[..count * width].iter().enumerate() {
        into[place % count * width + place / count] = *byte;
    }
    into[count * width..].copy_from_slice(&from[count * width..]);
}
