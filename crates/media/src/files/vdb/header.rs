//! The header of a file, the entry before each grid, and the beginning of a grid.

use super::super::bytes::Bytes;
use super::transform::Transform;
use super::{Unreadable, damaged, shown, wrong};

/// Versions with this layout.
const VERSIONS: std::ops::RangeInclusive<u32> = 222..=224;

/// The type of a grid of floats; one of halves has a suffix.
const FLOATS: &str = "Tree_float_5_4_3";
const HALVES: &str = "_HalfFloat";

/// Entry before each grid.
pub(super) struct GridHeader {
    /// Name, with the number that `OpenVDB` adds to equal names.
    pub(super) key: String,
    pub(super) kind: String,
    /// The key of the grid with the tree that this grid shares, or empty.
    pub(super) parent: String,
    /// Positions after this entry, in ascending order: the grid's beginning, its blocks' beginning and its end.
    pub(super) places: [usize; 3],
}

impl GridHeader {
    pub(super) fn read(bytes: &mut Bytes) -> Result<Self, Unreadable> {
        let [key, kind, parent] = [bytes.text()?, bytes.text()?, bytes.text()?];
        let [begin, blocks, end] = bytes.words()?;
        if end > bytes.len() as u64 {
            let (name, length) = (shown(&key), bytes.len());
            return damaged(format!("it ends at byte {length}, and its grid {name} at byte {end}"));
        }
        // A grid without a tree of its own has no blocks.
        let blocks = if parent.is_empty() { blocks } else { end };
        let parts = [bytes.at() as u64, begin, blocks, end];
        if !parts.is_sorted() {
            return damaged(format!(
                "the parts of its grid {} are not one after the other",
                shown(&key)
            ));
        }
        // No position is beyond the file.
        let places = [begin, blocks, end].map(|place| usize::try_from(place).unwrap_or(usize::MAX));
        Ok(Self { key, kind, parent, places })
    }

    /// The name for users of the file: `density`, or `density[1]` where several grids have the same name.
    pub(super) fn name(&self) -> String {
        match self.key.split_once('\x1e') {
            Some((name, number)) => format!("{name}[{number}]"),
            None => self.key.clone(),
        }
    }

    /// Returns whether the type is a tree of floats.
    pub(super) fn has_floats(&self) -> bool {
        self.kind.strip_suffix(HALVES).unwrap_or(&self.kind) == FLOATS
    }

    /// Returns whether floats are stored as halves.
    pub(super) fn has_halves(&self) -> bool {
        self.kind.ends_with(HALVES)
    }

    /// Name in a list of grids, with the type if that is not a tree of floats.
    pub(super) fn shown(&self) -> String {
        let name = shown(&self.name());
        if self.has_floats() { name } else { format!("{name} ({})", shown(&self.kind)) }
    }
}

/// The header, and the entry before each grid.
pub(super) fn entries(bytes: &mut Bytes) -> Result<Vec<GridHeader>, Unreadable> {
    if !matches!(bytes.take(8), Ok(b" BDV\0\0\0\0")) {
        return wrong("it does not begin as OpenVDB's files do", "write it by OpenVDB");
    }
    let version = bytes.number()?;
    if !VERSIONS.contains(&version) {
        let (from, to) = (VERSIONS.start(), VERSIONS.end());
        return wrong(
            format!("it has the version {version}"),
            format!("versions {from} to {to} are read: write it anew by OpenVDB 10"),
        );
    }
    bytes.take(8)?;
    match bytes.byte()? {
        0 => {
            let help = "write it into a file, by openvdb.write or openvdb::io::File";
            return wrong("it was written as a stream: it does not say where grids begin", help);
        }
        1 => {}
        other => {
            return damaged(format!("its offsets are marked {other}, which is neither 0 nor 1"));
        }
    }
    bytes.take(36)?;
    metadata(bytes, |_, _, _| Ok(()))?;
    let mut entries = Vec::new();
    for _ in 0..bytes.number()? {
        let entry = GridHeader::read(bytes)?;
        bytes.seek(entry.places[2]);
        entries.push(entry);
    }
    if entries.is_empty() {
        return wrong("it has no grid", "write one into it");
    }
    Ok(entries)
}

/// Reads names, types and values.
fn metadata(
    bytes: &mut Bytes,
    mut tell: impl FnMut(&str, &str, &[u8]) -> Result<(), Unreadable>,
) -> Result<(), Unreadable> {
    for _ in 0..bytes.number()? {
        let [name, kind] = [bytes.text()?, bytes.text()?];
        let length = bytes.number()? as usize;
        tell(&name, &kind, bytes.take(length)?)?;
    }
    Ok(())
}

/// The beginning of a grid: packing, metadata, and transform.
pub(super) struct Head {
    pub(super) compression: u32,
    pub(super) class: String,
    /// Number of active voxels.
    pub(super) voxels: Option<u64>,
    pub(super) transform: Transform,
}

impl Head {
    pub(super) fn read(bytes: &mut Bytes, entry: &GridHeader) -> Result<Self, Unreadable> {
        bytes.seek(entry.places[0]);
        let compression = bytes.number()?;
        let (mut class, mut voxels) = (String::new(), None);
        metadata(bytes, |name, kind, value| {
            match (name, kind) {
                ("class", "string") => class = String::from_utf8_lossy(value).into_owned(),
                ("file_voxel_count", "int64") => {
                    voxels = value.try_into().ok().map(u64::from_le_bytes);
                }
                _ => {}
            }
            Ok(())
        })?;
        Ok(Self { compression, class, voxels, transform: Transform::read(bytes)? })
    }
}
