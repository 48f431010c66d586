//! The headers of `OpenEXR` files, including kinds that the crate `exr` refuses without a name.
//!
//! ```text
//! magic, version and flags (2 u32): 0x200 one part of tiles, 0x800 deep, 0x1000 several parts
//! a header: attributes, each a name and a type that end with 0, a length (i32) and a value; 0
//! of several parts: header after header; 0
//! ```
//!
//! Source: *`OpenEXR` File Layout*, Academy Software Foundation.

use super::super::bytes::Bytes;
use super::super::{Unreadable, damaged};

/// Compressions by their number.
const COMPRESSIONS: [&str; 12] = [
    "none", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB", "HTJ2K256",
    "HTJ2K32",
];

/// The first compression that is not read.
const FIRST_UNREAD: u8 = 8;

/// A rectangle of pixels, its ends included.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PixelWindow {
    /// The first column and row.
    pub low: [i32; 2],
    /// The last column and row.
    pub high: [i32; 2],
}

impl PixelWindow {
    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        let count = |axis: usize| i64::from(self.high[axis]) - i64::from(self.low[axis]) + 1;
        [0, 1].map(|axis| usize::try_from(count(axis)).unwrap_or(0))
    }
}

impl std::fmt::Display for PixelWindow {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let ([left, top], [right, bottom]) = (self.low, self.high);
        write!(f, "({left}, {top}) to ({right}, {bottom})")
    }
}

/// A channel of a part.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExrChannel {
    /// Name, such as `R` or `diffuse.R`.
    pub name: String,
    /// `uint32`, `float16` or `float32`.
    pub kind: &'static str,
    /// Columns and rows of pixels for each value: 1 and 1 where each pixel has one.
    pub sampling: [i32; 2],
}

/// Contents of a header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExrPart {
    /// Name; empty in a file of one part without a name.
    pub name: String,
    /// `scan lines`, `tiles`, `deep scan lines` or `deep tiles`.
    pub kind: &'static str,
    /// Compression of the pixels.
    pub compression: String,
    /// True if the compression is supported.
    pub is_read: bool,
    /// The pixels that are stored.
    pub data: PixelWindow,
    /// The picture.
    pub display: PixelWindow,
    /// Channels, by name.
    pub channels: Vec<ExrChannel>,
}

impl ExrPart {
    /// Returns whether pixels have several samples each.
    pub fn is_deep(&self) -> bool {
        self.kind.starts_with("deep")
    }
}

/// The parts of a file.
///
/// # Errors
///
/// What is wrong with the headers.
pub fn parts(bytes: &[u8]) -> Result<Vec<ExrPart>, String> {
    all(&mut Bytes::new(bytes)).map_err(|fault| fault.message)
}

fn all(bytes: &mut Bytes) -> Result<Vec<ExrPart>, Unreadable> {
    if bytes.number().ok() != Some(0x0131_2f76) {
        return damaged("it does not begin as OpenEXR files do");
    }
    let version = bytes.number()?;
    if version & 0xff != 2 {
        return damaged(format!("it has the version {}, not 2", version & 0xff));
    }
    let (is_tiled, is_deep, has_parts) =
        (version & 0x200 != 0, version & 0x800 != 0, version & 0x1000 != 0);
    let usual = match (is_deep, is_tiled) {
        (false, false) => "scan lines",
        (false, true) => "tiles",
        (true, false) => "deep scan lines",
        (true, true) => "deep tiles",
    };
    let mut parts = vec![part(bytes, usual)?];
    while has_parts && bytes.rest().first() != Some(&0) {
        parts.push(part(bytes, usual)?);
    }
    Ok(parts)
}

fn window(value: &[u8]) -> Result<PixelWindow, Unreadable> {
    let [left, top, right, bottom] = Bytes::new(value).integers()?;
    let window = PixelWindow { low: [left, top], high: [right, bottom] };
    if window.size().contains(&0) {
        return damaged(format!("its window {window} holds no pixel"));
    }
    Ok(window)
}

fn part(bytes: &mut Bytes, usual: &'static str) -> Result<ExrPart, Unreadable> {
    let (mut name, mut kind, mut code) = (String::new(), usual, None);
    let (mut data, mut display, mut list) = (None, None, None);
    loop {
        let attribute = bytes.terminated()?;
        if attribute.is_empty() {
            break;
        }
        bytes.terminated()?;
        let length = bytes.number()? as usize;
        let value = bytes.take(length)?;
        match attribute {
            b"name" => name = String::from_utf8_lossy(value).into_owned(),
            b"type" => {
                kind = match value {
                    b"scanlineimage" => "scan lines",
                    b"tiledimage" => "tiles",
                    b"deepscanline" => "deep scan lines",
                    b"deeptile" => "deep tiles",
                    _ => usual,
                }
            }
            b"compression" => code = value.first().copied(),
            b"dataWindow" => data = Some(window(value)?),
            b"displayWindow" => display = Some(window(value)?),
            b"channels" => list = Some(channels(value)?),
            _ => {}
        }
    }
    let (Some(code), Some(data), Some(display), Some(channels)) = (code, data, display, list)
    else {
        return damaged("its header lacks channels, a compression or a window");
    };
    let known = COMPRESSIONS.get(usize::from(code));
    let compression = known.map_or_else(|| format!("number {code}"), |name| (*name).to_owned());
    Ok(ExrPart { name, kind, compression, is_read: code < FIRST_UNREAD, data, display, channels })
}

fn channels(value: &[u8]) -> Result<Vec<ExrChannel>, Unreadable> {
    let (mut bytes, mut channels) = (Bytes::new(value), Vec::new());
    loop {
        let name = String::from_utf8_lossy(bytes.terminated()?).into_owned();
        if name.is_empty() {
            return Ok(channels);
        }
        let kind = match bytes.number()? {
            0 => "uint32",
            1 => "float16",
            2 => "float32",
            other => return damaged(format!("its channel {name} has the type {other}")),
        };
        let [_, x, y] = bytes.integers()?;
        channels.push(ExrChannel { name, kind, sampling: [x, y] });
    }
}
