//! `OpenEXR` pictures, by the crate `exr`: scan lines or tiles, of every compression that it reads.

use std::io::Cursor;

use exr::block::UncompressedBlock;
use exr::block::reader::ChunksReader;
use exr::prelude::{SampleType, Vec2, f16};

use super::SINGLE;
use crate::judge::images::error::ImageError;
use crate::judge::images::picture::{Picture, Size};

/// The relative rounding of numbers of 11 bits.
const HALF: f64 = 1.0 / 2048.0;

/// The most values of a picture: 2 GiB in memory.
const MOST: usize = 1 << 28;

/// Reads a picture.
pub(super) fn picture(bytes: Vec<u8>, file: &str) -> Result<Picture, ImageError> {
    let faulty = |cause: String| ImageError::Faulty {
        file: file.to_owned(),
        what: "an exr file",
        cause,
        cure: "give a whole file with one layer of R, G, B or Y as half or float, or npy or pfm",
    };
    let wrong = |error: exr::error::Error| faulty(error.to_string());
    let reader = exr::block::read(Cursor::new(bytes), false).map_err(wrong)?;
    let header =
        reader.headers().first().ok_or_else(|| faulty("it has no layer".to_owned()))?.clone();
    if header.deep {
        return Err(faulty("its pixels are deep".to_owned()));
    }
    let list = &header.channels.list;
    let place = |name: &str| list.iter().position(|channel| channel.name.eq(name));
    let kept = match (place("R"), place("G"), place("B")) {
        (Some(red), Some(green), Some(blue)) => vec![red, green, blue],
        _ => vec![place("Y").unwrap_or(0)],
    };
    if let Some(thin) = list.iter().find(|channel| channel.sampling != Vec2(1, 1)) {
        return Err(faulty(format!("its channel {} has not a value for each pixel", thin.name)));
    }
    let is_half = kept.iter().any(|&place| list[place].sample_type == SampleType::F16);
    let Vec2(columns, rows) = header.layer_size;
    let size = Size { rows, columns, channels: kept.len() };
    // A small file may announce any size.
    if rows.saturating_mul(columns).saturating_mul(kept.len()) > MOST {
        return Err(faulty(format!("{rows} × {columns} pixels are more than {MOST} values")));
    }
    let is_kept = |layer: usize, level: Vec2<usize>| layer == 0 && level == Vec2(0, 0);
    let chunks = reader.filter_chunks(false, |_, _, block| is_kept(block.layer, block.level));
    let mut chunks = chunks.map_err(wrong)?;
    // What no chunk fills stays no number.
    let mut values = vec![f64::NAN; size.values()];
    while let Some(chunk) = chunks.next() {
        let block =
            UncompressedBlock::decompress_chunk(chunk.map_err(wrong)?, chunks.meta_data(), false);
        let block = block.map_err(wrong)?;
        for line in block.lines(&header.channels) {
            let Vec2(column, row) = line.location.position;
            let Some(channel) = kept.iter().position(|&place| place == line.location.channel)
            else {
                continue;
            };
            let first = (row * columns + column) * kept.len() + channel;
            let places = (first..values.len()).step_by(kept.len());
            for (place, number) in
                places.zip(numbers(line.value, list[line.location.channel].sample_type))
            {
                values[place] = number;
            }
        }
    }
    let rounding = if is_half { HALF } else { SINGLE };
    Ok(Picture { rounding, ..Picture::new(size, values)? })
}

/// The numbers of a line: the crate keeps the byte order of the file, low bytes first.
fn numbers(line: &[u8], kind: SampleType) -> Vec<f64> {
    let words = line.as_chunks::<4>().0.iter();
    match kind {
        SampleType::F16 => {
            let words = line.as_chunks::<2>().0.iter();
            words.map(|&word| f16::from_le_bytes(word).to_f64()).collect()
        }
        SampleType::F32 => words.map(|&word| f64::from(f32::from_le_bytes(word))).collect(),
        SampleType::U32 => words.map(|&word| f64::from(u32::from_le_bytes(word))).collect(),
    }
}
