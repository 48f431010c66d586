//! `NanoVDB`'s files: grids of `OpenVDB` as they lie in memory.
//!
//! ```text
//! a segment   magic "NanoVDB0" or "NanoVDB2" (8 bytes), version (u32), number of grids and codec (2 u16)
//!             for each grid: sizes in memory and in the file, hash of the name, active voxels (4 u64), type, class (2 u32),
//!             boxes (6 f64, 6 i32), voxel (3 f64), length of the name (u32), nodes and tiles (7 u32), codec (u16), 2 bytes,
//!             version (u32), name with its 0; then the grids themselves
//! a grid      GridData (672 bytes), TreeData (64), root with its tiles, nodes of 32³, 16³ and 8³: see `nodes.rs`
//! codec       0 none; 1 length (u64) and zlib; 2 length (u64) and Blosc, for each 2³⁰ bytes
//! ```
//!
//! All numbers are little-endian. Read are versions 32.x, whose layout is one, grids of the types Float, Fp4, Fp8, Fp16
//! and FpN. A file that begins with "NanoVDB1" is one grid as it lies in memory. Other types are named in the error.
//!
//! No crate reads these files. No place that the file names is trusted: each part is taken from the bytes that are
//! there, and no more nodes are visited than fit into them.
//!
//! Source: K. Museth, *NanoVDB: A GPU-Friendly and Portable VDB Data Structure For Real-Time Rendering And Simulation*,
//! SIGGRAPH Talks 2021; the layout is that of `NanoVDB.h`, `PNanoVDB.h` and `io/IO.h`, versions 32.4 and 32.9.

mod nodes;
mod unpacking;

use super::vdb::{Grid, Transform};
use super::{Fault, damaged, shown, wrong};

/// The major version, which changes with the layout.
const MAJOR: u32 = 32;

/// Bytes before the tree.
const GRID: usize = 672;

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

/// What a file says of one of its grids.
#[derive(Debug, Clone, PartialEq)]
pub struct Listed {
    /// Its name: `density`, or `density[1]` where there are several of a name.
    pub name: String,
    /// Its type, such as `Float`.
    pub kind: String,
    /// Its class, such as `fog volume`; empty where none is said.
    pub class: String,
    /// How many voxels are active.
    pub active: u64,
    /// The version that wrote it, such as `32.4.2`.
    pub version: String,
    /// How it is packed: `none`, `zip` or `Blosc`.
    pub codec: &'static str,
    number: u32,
    /// Bytes in memory.
    size: u64,
    /// Where it is in the file.
    place: [usize; 2],
}

impl Listed {
    /// Whether [`read`] reads its type.
    pub fn is_read(&self) -> bool {
        nodes::Values::of(self.number).is_some()
    }

    fn shown(&self) -> String {
        let name = shown(&self.name);
        if self.is_read() { name } else { format!("{name} ({})", self.kind) }
    }
}

/// The bytes from a place on.
fn part(bytes: &[u8], from: usize, count: usize) -> Result<&[u8], Fault> {
    match bytes.get(from..).and_then(|rest| rest.get(..count)) {
        Some(found) => Ok(found),
        None => damaged(format!("it ends within the {count} bytes from byte {from} on")),
    }
}

/// An array of bytes at a place.
fn array<const N: usize>(bytes: &[u8], from: usize) -> Result<[u8; N], Fault> {
    let mut array = [0; N];
    array.copy_from_slice(part(bytes, from, N)?);
    Ok(array)
}

fn number(bytes: &[u8], from: usize) -> Result<u32, Fault> {
    array(bytes, from).map(u32::from_le_bytes)
}

fn word(bytes: &[u8], from: usize) -> Result<u64, Fault> {
    array(bytes, from).map(u64::from_le_bytes)
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

/// A segment's grids; where the next segment begins.
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

/// A grid as it lies in memory, without a header of the file.
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

const CONVERT: &str = "grids of the types Float, Fp4, Fp8, Fp16 and FpN are read: write one of them by nanovdb_convert";

/// Reads the grid of a name; without one, the file's only grid of floats.
///
/// # Errors
///
/// Whatever keeps the file from being one of the kind that is described above, with such a grid.
pub fn read(file: &[u8], name: Option<&str>) -> Result<Grid, Fault> {
    let grids = list(file)?;
    let all = || grids.iter().map(Listed::shown).take(20).collect::<Vec<_>>().join(", ");
    let found = match name {
        Some(name) => grids.iter().find(|grid| grid.name == name),
        None => match grids.iter().filter(|grid| grid.is_read()).collect::<Vec<_>>()[..] {
            [] => return wrong(format!("it has no grid of floats, but {}", all()), CONVERT),
            [only] => Some(only),
            _ => {
                return wrong(
                    format!("it has several grids: {}", all()),
                    "choose one: `grid = \"…\"`",
                );
            }
        },
    };
    let Some(found) = found else {
        let message = format!("it has no grid {}, but {}", shown(name.unwrap_or_default()), all());
        return wrong(message, "choose one of its grids of floats");
    };
    let Some(values) = nodes::Values::of(found.number) else {
        let message = format!("its grid {} has the type {}", shown(&found.name), found.kind);
        return wrong(message, CONVERT);
    };
    let [from, to] = found.place;
    let grid = unpacking::unpacked(&file[from..to], found.codec, found.size)?;
    let tree = nodes::read(&grid, values)?;
    if tree.active != found.active {
        let (said, found) = (found.active, tree.active);
        return damaged(format!("{said} voxels are announced to be active, and {found} are"));
    }
    let (name, class) = (found.name.clone(), found.class.clone());
    Ok(Grid { name, class, transform: transform(&grid)?, tree })
}

/// The map in double precision, 296 bytes from the beginning of a grid.
fn transform(grid: &[u8]) -> Result<Transform, Fault> {
    let double = |at: usize| word(grid, at).map(f64::from_bits);
    let (mut matrix, mut shift) = ([[0.0; 3]; 3], [0.0; 3]);
    for i in 0..3 {
        for (j, entry) in matrix[i].iter_mut().enumerate() {
            *entry = double(296 + 88 + 8 * (3 * i + j))?;
        }
        shift[i] = double(296 + 232 + 8 * i)?;
    }
    Transform { matrix, shift }.checked()
}
