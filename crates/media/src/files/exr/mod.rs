//! `OpenEXR` pictures. They are read by the crate `exr`: scan lines or tiles, of every compression that it supports
//! (none, RLE, ZIPS, ZIP, PIZ, PXR24, B44 and B44A). They are written without compression.
//!
//! ```text
//! magic, version 2; attributes: name, type, length and value; 0
//! where each line begins (u64); each line: its number from the top and its length (2 i32), then its channels by name
//! ```
//!
//! The crate's writer would cost 3.5 s of compile time, more than these lines are worth.
//!
//! Source: *`OpenEXR` File Layout*, Academy Software Foundation.

mod header;

use std::io::Cursor;

use exr::block::UncompressedBlock;
use exr::block::reader::ChunksReader;
use exr::prelude::{SampleType, Vec2};

use super::Pixels;
use super::number::NumberType;
pub use header::{ExrChannel, ExrPart, PixelWindow, parts};

/// Maximum number of values of a picture: 2 GiB in memory.
const MAX_VALUES: usize = 1 << 28;

/// The bytes of a picture of one layer and of several images of it, each with a prefix to the names of its channels:
/// `Y`, or `R`, `G` and `B`, as float32, in scan lines that are not compressed.
///
/// # Errors
///
/// There are more rows or columns than the format counts.
pub fn write(
    size: [usize; 2],
    channels: usize,
    images: &[(&str, &[f64])],
) -> Result<Vec<u8>, String> {
    let names = if channels > 1 { &["R", "G", "B"][..] } else { &["Y"] };
    let mut list: Vec<(String, usize, &[f64])> = Vec::new();
    for &(prefix, image) in images {
        let named =
            names.iter().zip(0..).map(|(name, place)| (format!("{prefix}{name}"), place, image));
        list.extend(named);
    }
    list.sort_by(|one, other| one.0.cmp(&other.0));
    let [columns, rows] = size;
    let (Ok(last_column), Ok(last_row), Ok(length)) = (
        i32::try_from(columns.saturating_sub(1)),
        i32::try_from(rows.saturating_sub(1)),
        i32::try_from(columns.saturating_mul(4 * list.len())),
    ) else {
        return Err(format!("{columns} × {rows} pixels are more than an EXR holds"));
    };
    let window = [0, 0, last_column, last_row].map(i32::to_le_bytes).concat();
    // Each name, float32, four bytes without meaning for float32, and a value for each column and row.
    let described = |(name, _, _): &(String, usize, &[f64])| {
        [name.as_bytes(), &[0, 2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]].concat()
    };
    let described = [list.iter().flat_map(described).collect(), vec![0]].concat();
    let one = 1.0_f32.to_le_bytes();
    let mut bytes = vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
    let attributes: [(&str, &str, &[u8]); 8] = [
        ("channels", "chlist", &described),
        ("compression", "compression", &[0]),
        ("dataWindow", "box2i", &window),
        ("displayWindow", "box2i", &window),
        ("lineOrder", "lineOrder", &[0]),
        ("pixelAspectRatio", "float", &one),
        ("screenWindowCenter", "v2f", &[0; 8]),
        ("screenWindowWidth", "float", &one),
    ];
    for (name, kind, value) in attributes {
        bytes.extend([name.as_bytes(), b"\0", kind.as_bytes(), b"\0"].concat());
        // Names are short, and so are their list and all other values.
        bytes.extend(u32::try_from(value.len()).map_err(|error| error.to_string())?.to_le_bytes());
        bytes.extend(value);
    }
    bytes.push(0);
    // The begin of each line, which is eight bytes and its values long.
    let line = 8 + 4 * list.len() * columns;
    let first = bytes.len() + 8 * rows;
    bytes.extend((0..rows).flat_map(|row| ((first + row * line) as u64).to_le_bytes()));
    for (row, number) in (0..rows).zip(0_i32..) {
        bytes.extend([number, length].map(i32::to_le_bytes).concat());
        for (_, place, image) in &list {
            let values = image.iter().skip(row * columns * channels + place).step_by(channels);
            #[expect(clippy::cast_possible_truncation)] // the format's precision
            bytes.extend(values.take(columns).flat_map(|&x| (x as f32).to_le_bytes()));
        }
    }
    Ok(bytes)
}

/// Reads the first layer of a picture: R, G, B, else Y, else its first channel.
///
/// # Errors
///
/// The file is damaged, or of an unsupported kind.
pub fn read(bytes: Vec<u8>) -> Result<Pixels, String> {
    refuse(&parts(&bytes)?)?;
    let wrong = |error: exr::error::Error| error.to_string();
    let reader = exr::block::read(Cursor::new(bytes), false).map_err(wrong)?;
    let header = reader.headers().first().ok_or("it has no layer")?.clone();
    let list = &header.channels.list;
    let place = |name: &str| list.iter().position(|channel| channel.name.eq(name));
    let kept = match (place("R"), place("G"), place("B")) {
        (Some(red), Some(green), Some(blue)) => vec![red, green, blue],
        _ => vec![place("Y").unwrap_or(0)],
    };
    let has_halves = kept.iter().any(|&place| list[place].sample_type == SampleType::F16);
    let Vec2(columns, rows) = header.layer_size;
    let channels = kept.len();
    // A small file may announce any size.
    if rows.saturating_mul(columns).saturating_mul(channels) > MAX_VALUES {
        return Err(format!("{rows} × {columns} pixels are more than {MAX_VALUES} values"));
    }
    let is_kept = |layer: usize, level: Vec2<usize>| layer == 0 && level == Vec2(0, 0);
    let chunks = reader.filter_chunks(false, |_, _, block| is_kept(block.layer, block.level));
    let mut chunks = chunks.map_err(wrong)?;
    // Pixels without a chunk stay NaN.
    let mut values = vec![f64::NAN; rows * columns * channels];
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
            let first = (row * columns + column) * channels + channel;
            let places = (first..values.len()).step_by(channels);
            let number = number(list[line.location.channel].sample_type);
            let numbers = number.map_or_else(Vec::new, |number| number.all(line.value));
            for (place, number) in places.zip(numbers) {
                values[place] = number;
            }
        }
    }
    Ok(Pixels { size: [columns, rows], channels, values, has_halves })
}

/// Refuses what the crate does not read, with its name. The crate reads no file that has a deep part, even if
/// another part is wanted.
fn refuse(parts: &[ExrPart]) -> Result<(), String> {
    let named = |part: &ExrPart| match parts.len() {
        1 => String::new(),
        _ => format!(" (part \"{}\")", part.name),
    };
    if let Some(deep) = parts.iter().find(|part| part.is_deep()) {
        return Err(format!("it has {}{}, which must be flattened first", deep.kind, named(deep)));
    }
    if let Some(packed) = parts.iter().find(|part| !part.is_read) {
        let compression = &packed.compression;
        return Err(format!(
            "its compression is {compression}{}, which is not read: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44 and B44A are",
            named(packed)
        ));
    }
    let thin = |channel: &&ExrChannel| channel.sampling != [1, 1];
    if let Some(thin) = parts.iter().flat_map(|part| &part.channels).find(thin) {
        return Err(format!("its channel {} has not a value for each pixel", thin.name));
    }
    Ok(())
}

/// The type of a channel's numbers: the crate keeps the byte order of the file, low bytes first.
fn number(kind: SampleType) -> Option<NumberType> {
    NumberType::named(match kind {
        SampleType::F16 => "<f2",
        SampleType::F32 => "<f4",
        SampleType::U32 => "<u4",
    })
}
