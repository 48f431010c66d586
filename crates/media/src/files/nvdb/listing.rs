//! The grids of a file, segment by segment.

use super::super::{Fault, damaged, shown, wrong};
use super::{GRID, array, nodes, number, part, word};

/// The major version, which changes with the layout.
const MAJOR: u32 = 32;

/// The types by their number.
const TYPES: [&str; 27] = [
    "unknown",
    "Float",
    "Double",
    "Int16",
    "Int32",
    "Int64",
    "Vec3f",
    "Vec3d",
    "Mask",
    "Half",
    "UInt32",
    "Boolean",
    "RGBA8",
    "Fp4",
    "Fp8",
    "Fp16",
    "FpN",
    "Vec4f",
    "Vec4d",
    "Index",
    "OnIndex",
    "IndexMask",
    "OnIndexMask",
    "PointIndex",
    "Vec3u8",
    "Vec3u16",
    "UInt8",
];

/// The classes by their number.
const CLASSES: [&str; 9] = [
    "",
    "level set",
    "fog volume",
    "staggered",
    "point index",
    "point data",
    "topology",
    "voxel volume",
    "index",
];

/// Entry of a grid in a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Listed {
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

impl Listed {
    /// Returns true if [`super::read`] supports the type.
    pub fn is_read(&self) -> bool {
        nodes::Values::of(self.number).is_some()
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

fn named(list: &[&str], number: u32) -> String {
    let name = usize::try_from(number).ok().and_then(|number| list.get(number));
    name.map_or_else(|| format!("number {number}"), |name| (*name).to_owned())
}

/// Lists the grids of a file.
///
/// # Errors
///
/// The file is not one of the kind that is described above.
pub fn list(file: &[u8]) -> Result<Vec<Listed>, Fault> {
    if file.starts_with(b"NanoVDB1") {
        return Ok(vec![raw(file)?]);
    }
    if file.starts_with(b"0BDVonaN") || file.starts_with(b"2BDVonaN") {
        return wrong(
            "it was written with its high bytes first",
            "write it on a little-endian machine",
        );
    }
    let (mut listed, mut at) = (Vec::<Listed>::new(), 0);
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

/// Lists a segment's grids; returns the place of the next segment.
fn segment(file: &[u8], mut at: usize, listed: &mut Vec<Listed>) -> Result<usize, Fault> {
    if !matches!(part(file, at, 8), Ok(b"NanoVDB0" | b"NanoVDB2")) {
        let place = if at == 0 { String::new() } else { format!(" at byte {at}") };
        return wrong(
            format!("it does not begin as NanoVDB's files do{place}"),
            "write it by NanoVDB, for instance by nanovdb_convert from an OpenVDB file",
        );
    }
    let written = number(file, at + 8)?;
    if written >> 21 != MAJOR {
        return wrong(
            format!("it has the version {}", version(written)),
            format!("versions {MAJOR}.x are read: write it anew by nanovdb_convert"),
        );
    }
    let count = u16::from_le_bytes(array(file, at + 12)?);
    at += 16;
    let mut lengths = Vec::new();
    for _ in 0..count {
        let meta = part(file, at, 176)?;
        let length = number(meta, 136)? as usize;
        let name = part(file, at + 176, length)?;
        let name =
            String::from_utf8_lossy(name.split(|&byte| byte == 0).next().unwrap_or_default());
        let codec = match u16::from_le_bytes(array(meta, 168)?) {
            0 => "none",
            1 => "zip",
            2 => "Blosc",
            other => return damaged(format!("its grid {} has the codec {other}", shown(&name))),
        };
        let (kind, class) = (number(meta, 32)?, number(meta, 36)?);
        lengths.push(word(meta, 8)?);
        listed.push(Listed {
            name: name.into_owned(),
            kind: named(&TYPES, kind),
            class: named(&CLASSES, class),
            active: word(meta, 24)?,
            version: version(number(meta, 172)?),
            codec,
            number: kind,
            size: word(meta, 0)?,
            place: [0; 2],
        });
        at += 176 + length;
    }
    let first = listed.len() - usize::from(count);
    for (grid, length) in listed[first..].iter_mut().zip(lengths) {
        let end = usize::try_from(length).ok().and_then(|length| at.checked_add(length));
        let Some(end) = end.filter(|&end| end <= file.len()) else {
            let (name, length) = (shown(&grid.name), file.len());
            return damaged(format!("it ends at byte {length}, within its grid {name}"));
        };
        grid.place = [at, end];
        at = end;
    }
    Ok(at)
}

/// A grid as it is in memory, without a header of the file.
fn raw(file: &[u8]) -> Result<Listed, Fault> {
    let (written, size) = (number(file, 16)?, word(file, 32)?);
    if written >> 21 != MAJOR {
        let message = format!("it has the version {}", version(written));
        return wrong(message, format!("versions {MAJOR}.x are read"));
    }
    let name = part(file, 40, 256)?.split(|&byte| byte == 0).next().unwrap_or_default();
    let (class, kind) = (number(file, 632)?, number(file, 636)?);
    let Some(end) = usize::try_from(size).ok().filter(|&end| end <= file.len()) else {
        return damaged(format!("it ends at byte {}, within its grid of {size} bytes", file.len()));
    };
    Ok(Listed {
        name: String::from_utf8_lossy(name).into_owned(),
        kind: named(&TYPES, kind),
        class: named(&CLASSES, class),
        active: word(file, GRID + 56)?,
        version: version(written),
        codec: "none",
        number: kind,
        size,
        place: [0, end],
    })
}
