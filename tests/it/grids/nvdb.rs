//! Files of `NanoVDB` against those of `OpenVDB` that they were made from, see `tests/data/grids/make.py`.

use trueflight::media::grid_file::{self, GridChoice, Samples, Unreadable};

use super::{data, refused, written};
use crate::common::mutated::Choices;

fn read(file: &str, grid: Option<&str>) -> Result<Samples, Unreadable> {
    let choice = GridChoice { grid: grid.map(str::to_owned), ..GridChoice::default() };
    grid_file::read(&data(file), &choice)
}

/// Returns a zipped file with its grid uncompressed, and that grid alone.
fn plain(file: &str) -> [Vec<u8>; 2] {
    let bytes = std::fs::read(data(file)).expect("a file");
    let length = |at: usize| {
        usize::try_from(u32::from_le_bytes(bytes[at..at + 4].try_into().expect("4")))
            .expect("small")
    };
    let begin = 16 + 176 + length(16 + 136);
    let size = length(16);
    let grid = miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(&bytes[begin + 8..], size)
        .expect("zip");
    assert_eq!(grid.len(), size);
    let mut head = bytes[..begin].to_vec();
    // The codecs of the segment and of the grid, and the grid's size in the file.
    head[14] = 0;
    head[16 + 168] = 0;
    head.copy_within(16..24, 24);
    [[head, grid.clone()].concat(), grid]
}

#[test]
fn grids_are_those_that_they_were_made_from() {
    for (nano, open, grid) in [
        ("grids/mixed-zip.nvdb", "vdb/mixed-blosc.vdb", None),
        ("grids/mixed-blosc.nvdb", "vdb/mixed-blosc.vdb", None),
        ("grids/mixed-fp4.nvdb", "grids/mixed-fp4.vdb", None),
        ("grids/mixed-fp8.nvdb", "grids/mixed-fp8.vdb", None),
        ("grids/mixed-fp16.nvdb", "grids/mixed-fp16.vdb", None),
        ("grids/mixed-fpN.nvdb", "grids/mixed-fpN.vdb", None),
        ("grids/tiles.nvdb", "vdb/tiles.vdb", None),
        ("grids/mirrored.nvdb", "vdb/mirrored.vdb", None),
        ("grids/filled.nvdb", "grids/filled.vdb", None),
        ("grids/turned.nvdb", "grids/turned.vdb", None),
        ("grids/several.nvdb", "vdb/several.vdb", Some("density")),
        ("grids/several.nvdb", "vdb/several.vdb", Some("shared")),
        ("grids/several.nvdb", "vdb/several.vdb", Some("heat[1]")),
    ] {
        let [nano, open] =
            [nano, open].map(|file| read(file, grid).unwrap_or_else(|e| panic!("{file}: {e:?}")));
        assert_eq!(nano.size, open.size, "{grid:?}");
        assert_eq!(nano.values, open.values, "{grid:?}");
        assert_eq!((nano.turned, nano.remark), (open.turned, open.remark));
        assert_eq!(nano.bounds, open.bounds);
    }
}

#[test]
fn plain_files_and_grids_as_they_lie_in_memory_are_read() {
    for file in ["grids/mixed-zip.nvdb", "grids/later.nvdb", "grids/later-fp8.nvdb"] {
        let zipped = read(file, None).expect("a grid");
        let [whole, grid] = plain(file);
        assert_eq!(
            written("a.nvdb", &whole, &GridChoice::default()).expect("a grid"),
            zipped,
            "{file}"
        );
        if file.contains("later") {
            assert_eq!(
                written("a.nvdb", &grid, &GridChoice::default()).expect("a grid"),
                zipped,
                "{file}"
            );
        }
    }
}

/// A grid that `later.cpp` writes in a later version: voxel n has (n² mod 8)/4 + 1/8.
#[test]
fn a_later_version_is_read() {
    let Samples { size, values, bounds, .. } = read("grids/later.nvdb", None).expect("a grid");
    assert_eq!(size, [5; 3]);
    let bounds = bounds.expect("a box");
    // Indices from (6, −1, −21) to (10, 3, −17), half a unit each, from (1, 2, 3).
    assert_eq!([bounds.low.0, bounds.high.0], [[4.0, 1.5, -7.5], [6.0, 3.5, -5.5]]);
    for n in 0..27_usize {
        let at = ((n / 9 + 1) * 5 + n / 3 % 3 + 1) * 5 + n % 3 + 1;
        assert_eq!(values[at], (n * n % 8) as f64 / 4.0 + 0.125, "voxel {n}");
    }
    assert_eq!(values.iter().filter(|&&x| x == 0.0).count(), 125 - 27);
    let codes = read("grids/later-fp8.nvdb", None).expect("a grid");
    // Codes of 8 bits have an error of at most half of 1/255 of the range, 1.875.
    for (code, value) in codes.values.iter().zip(&values) {
        assert!((code - value).abs() <= 0.51 * 1.875 / 255.0, "{code} and {value}");
    }
}

#[test]
fn other_files_are_refused_with_the_cure() {
    for (file, grid, words, cure) in [
        (
            "grids/several.nvdb",
            None,
            "several grids: \"density\", \"heat[0]\", \"heat[1]\", \"mask\" (Boolean)",
            "grid =",
        ),
        ("grids/several.nvdb", Some("velocity"), "has the type Vec3f", "nanovdb_convert"),
        ("grids/several.nvdb", Some("mask"), "has the type Boolean", "nanovdb_convert"),
        ("grids/several.nvdb", Some("smoke"), "no grid \"smoke\"", "choose one"),
        ("grids/level-set.nvdb", None, "level set", "sdfToFogVolume"),
    ] {
        let Unreadable { message, help } = read(file, grid).expect_err(file);
        assert!(message.contains(words) && help.contains(cure), "{file}: {message}; {help}");
    }
    let [whole, grid] = plain("grids/later.nvdb");
    let with = |at: usize, new: &[u8]| {
        let mut bytes = whole.clone();
        bytes[at..at + new.len()].copy_from_slice(new);
        bytes
    };
    // The codec of a segment is ignored: each grid has its own.
    assert!(written("a.nvdb", &with(14, &[9]), &GridChoice::default()).is_ok());
    let root = 16 + 176 + 8 + 672 + 64;
    for (bytes, words) in [
        (Vec::new(), "no grid"),
        (b"NanoVDB".to_vec(), "does not begin"),
        (b" BDV\0\0\0\0".to_vec(), "does not begin"),
        (b"0BDVonaN".to_vec(), "high bytes first"),
        (with(8, &(31_u32 << 21 | 5 << 10).to_le_bytes()), "version 31.5.0"),
        (with(16 + 168, &[9]), "codec 9"),
        (with(16, &u64::MAX.to_le_bytes()), "is announced"),
        (with(24, &u64::MAX.to_le_bytes()), "within its grid"),
        (with(16 + 24, &[28]), "28 voxels are announced"),
        (with(root + 24, &u32::MAX.to_le_bytes()), "its nodes are more than there are bytes"),
        (with(root + 64 + 8, &i64::MIN.to_le_bytes()), "a node stands"),
        (grid[..700].to_vec(), "ends at byte 700"),
    ] {
        refused("a.nvdb", &bytes, &GridChoice::default(), words);
    }
}

/// Flipped bits give a grid of finite samples, or an error; never a panic, and never a huge allocation.
#[test]
fn damaged_files_are_read_or_refused() {
    let [whole, _] = plain("grids/later.nvdb");
    let head = 16 + 176 + 8;
    let mut choices = Choices(5);
    // Headers, tree and root; the masks and the first entries of nodes; the leaf, which is last.
    let places =
        (0..head + 672 + 64 + 96).chain((0..400).map(|_| head + 832 + choices.below(8192)));
    let places: Vec<usize> = places.chain(whole.len() - 2144..whole.len() - 2000).collect();
    let [mut refusals, mut others] = [0; 2];
    for at in places {
        let mut spoilt = whole.clone();
        spoilt[at] ^= 1 << choices.below(8);
        match crate::common::grids::reads_or_refuses("nvdb", &spoilt) {
            None => refusals += 1,
            Some(_) => others += 1,
        }
    }
    assert!(refusals > 50 && others > 50, "{refusals} refused, {others} read");
    for length in (0..1200).step_by(7).chain((1..40).map(|n| whole.len() - n)) {
        assert!(
            crate::common::grids::reads_or_refuses("nvdb", &whole[..length]).is_none(),
            "{length} bytes"
        );
    }
}
