//! The grids of a file, segment by segment.

use super::super::{Unreadable, damaged, shown, wrong};
use super::{Bytes, GRID, nodes};

/// The major version, which changes with the layout.
const MAJOR: u32 = 32;

/// The types by their number.
const TYPES: &str = "unknown|Float|Double|Int16|Int32|Int64|Vec3f|Vec3d|Mask|Half|UInt32|Boolean|RGBA8|Fp4|Fp8|Fp16|FpN|\
    Vec4f|Vec4d|Index|OnIndex|IndexMask|OnIndexMask|PointIndex|Vec3u8|Vec3u16|UInt8";

/// The classes by their number.
const CLASSES: &str =
    "|level set|fog volume|staggered|point index|point data|topology|voxel volume|index";

/// Entry of a grid in a file.
#[derive(Debug, Clone, PartialEq)]
pub struct NvdbEntry {
    /// Name: `density`, or `density[1]` where several grids have the same name.
    pub name: String,
    /// Type, such as `Float`.
    pub kind: String,
    /// Class, such as `fog volume`; empty without one.
    pub class: String,
    /// Number of active voxels.
    pub active: u64,
    /// The version that wrote it, such as `32.4.2`.
    pub version: String,
    /// Codec: `none`, `zip` or `Blosc`.
    pub codec: &'static str,
    pub(super) number: u32,
    /// Bytes in memory.
    pub(super) size: u64,
    /// First byte in the file, and the byte after the last.
    pub(super) place: [usize; 2],
}

impl NvdbEntry {
    /// Returns whether [`super::read`] supports the type.
    pub fn is_read(&self) -> bool {
        nodes::LeafValues::of(self.number).is_some()
    }

    /// Name in a list of grids, with the type if that is not supported.
    pub(super) fn shown(&self) -> String {
        let name = shown(&self.name);
        if self.is_read() { name } else { format!("{name} ({})", self.kind) }
    }
}

fn version(number: u32) -> String {
    format!("{}.{}.{}", number >> 21, number >> 10 & 0x7ff, number & 0x3ff)
}

/// The name of a number in a list.
fn named(list: &str, number: u32) -> String {
    let name = list.split('|').nth(number as usize);
    name.map_or_else(|| format!("number {number}"), str::to_owned)
}

/// Lists the grids of a file.
///
/// # Errors
///
/// The file is not one of the kind that is described above.
pub fn list(file: &[u8]) -> Result<Vec<NvdbEntry>, Unreadable> {
    if file.starts_with(b"NanoVDB1") {
        return Ok(vec![raw(file)?]);
    }
    if file.starts_with(b"0BDVonaN") || file.starts_with(b"2BDVonaN") {
        return wrong(
            "it was written with its high bytes first",
            "write it on a little-endian machine",
        );
    }
    let (mut listed, mut at) = (Vec::<NvdbEntry>::new(), 0);
    while at < file.len() {
        at = segment(file, at, &mut listed)?;
    }
    if listed.is_empty() {
        return wrong("it has no grid", "write one into it");
    }
    let names: Vec<String> = listed.iter().map(|grid| grid.name.clone()).collect();
    for (place, grid) in listed.iter_mut().enumerate() {
        if names.iter().filter(|name| **name == grid.name).count() > 1 {
            let before = names[..place].iter().filter(|name| **name == grid.name).count();
            grid.name = format!("{}[{before}]", grid.name);
        }
    }
    Ok(listed)
}

/// Checks the version of a segment or a grid, and returns its name.
fn supported(written: u32) -> Result<String, Unreadable> {
    if written >> 21 != MAJOR {
        return wrong(
            format!("it has the version {}", version(written)),
            format!("versions {MAJOR}.x are read: write it anew by nanovdb_convert"),
        );
    }
    Ok(version(written))
}

/// A text before its first 0.
fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes.split(|&byte| byte == 0).next().unwrap_or_default()).into_owned()
}

/// Lists a segment's grids; returns the place of the next segment.
fn segment(file: &[u8], at: usize, listed: &mut Vec<NvdbEntry>) -> Result<usize, Unreadable> {
    let mut bytes = Bytes::at_byte(file, at);
    if !matches!(bytes.take(8), Ok(b"NanoVDB0" | b"NanoVDB2")) {
        let place = if at == 0 { String::new() } else { format!(" at byte {at}") };
        return wrong(
            format!("it does not begin as NanoVDB's files do{place}"),
            "write it by NanoVDB, for instance by nanovdb_convert from an OpenVDB file",
        );
    }
    supported(bytes.number()?)?;
    let count = bytes.short()?;
    bytes.short()?;
    let (first, mut lengths) = (listed.len(), Vec::new());
    for _ in 0..count {
        let [size, length, _, active] = bytes.words()?;
        let [number, class] = [bytes.number()?, bytes.number()?];
        // Boxes, and the size of a voxel.
        bytes.take(96)?;
        let name = bytes.number()? as usize;
        // Numbers of nodes and tiles.
        bytes.take(28)?;
        let codec = bytes.short()?;
        bytes.short()?;
        let written = bytes.number()?;
        let name = text(bytes.take(name)?);
        let codec = match codec {
            0 => "none",
            1 => "zip",
            2 => "Blosc",
            other => return damaged(format!("its grid {} has the codec {other}", shown(&name))),
        };
        lengths.push(length);
        listed.push(NvdbEntry {
            name,
            kind: named(TYPES, number),
            class: named(CLASSES, class),
            active,
            version: version(written),
            codec,
            number,
            size,
            place: [0; 2],
        });
    }
    for (grid, length) in listed[first..].iter_mut().zip(lengths) {
        let begin = bytes.at();
        if bytes.take(usize::try_from(length).unwrap_or(usize::MAX)).is_err() {
            let (name, length) = (shown(&grid.name), file.len());
            return damaged(format!("it ends at byte {length}, within its grid {name}"));
        }
        grid.place = [begin, bytes.at()];
    }
    Ok(bytes.at())
}

/// A grid as it is in memory, without a header of the file.
fn raw(file: &[u8]) -> Result<NvdbEntry, Unreadable> {
    let at = |place| Bytes::at_byte(file, place);
    let (version, size) = (supported(at(16).number()?)?, at(32).word()?);
    let (name, mut types) = (text(at(40).take(256)?), at(632));
    let (class, number) = (types.number()?, types.number()?);
    let Some(end) = usize::try_from(size).ok().filter(|&end| end <= file.len()) else {
        return damaged(format!("it ends at byte {}, within its grid of {size} bytes", file.len()));
    };
    Ok(NvdbEntry {
        name,
        kind: named(TYPES, number),
        class: named(CLASSES, class),
        active: at(GRID + 56).word()?,
        version,
        codec: "none",
        number,
        size,
        place: [0, end],
    })
}
