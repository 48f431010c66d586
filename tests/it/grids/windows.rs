//! `OpenEXR` files with different data windows, and unreadable ones.

use trueflight::judge::images::ImageError;
use trueflight::judge::images::files::{Frame, picture, picture_in, stack};

use super::{run, text};

/// Returns an uncompressed picture of one channel by the specification, with its windows `[left, top, right, bottom]`.
pub fn exr(data: [i32; 4], display: [i32; 4], values: &[f32]) -> Vec<u8> {
    with_attributes(data, display, values, 0, 2, b"Y")
}

fn with_attributes(
    data: [i32; 4],
    display: [i32; 4],
    values: &[f32],
    compression: u8,
    version: u32,
    channel: &[u8],
) -> Vec<u8> {
    let mut bytes = [0x76, 0x2f, 0x31, 0x01].to_vec();
    bytes.extend(version.to_le_bytes());
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        bytes.extend([name.as_bytes(), b"\0", kind.as_bytes(), b"\0"].concat());
        bytes.extend(i32::try_from(value.len()).expect("short").to_le_bytes());
        bytes.extend(value);
    };
    let window = |ends: [i32; 4]| ends.map(i32::to_le_bytes).concat();
    let channels = [channel, &[0, 2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0]].concat();
    attribute("channels", "chlist", &channels);
    attribute("compression", "compression", &[compression]);
    attribute("dataWindow", "box2i", &window(data));
    attribute("displayWindow", "box2i", &window(display));
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &1f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1f32.to_le_bytes());
    bytes.push(0);
    let columns = usize::try_from(data[2] - data[0] + 1).expect("a width").max(1);
    let rows = values.len() / columns;
    let first = bytes.len() + 8 * rows;
    for row in 0..rows {
        bytes.extend(((first + row * (8 + 4 * columns)) as u64).to_le_bytes());
    }
    for (row, line) in values.chunks(columns).enumerate() {
        bytes.extend((data[1] + i32::try_from(row).expect("few")).to_le_bytes());
        bytes.extend(i32::try_from(4 * columns).expect("short").to_le_bytes());
        bytes.extend(line.iter().flat_map(|x| x.to_le_bytes()));
    }
    bytes
}

fn folder(files: &[(&str, Vec<u8>)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).expect("written");
    }
    folder
}

const DISPLAY: [i32; 4] = [0, 0, 3, 2];

#[test]
fn passes_of_other_data_windows_are_laid_into_the_display_window() {
    let there = folder(&[
        ("a.exr", exr([1, 1, 2, 2], DISPLAY, &[1.0, 2.0, 3.0, 4.0])),
        ("b.exr", exr([0, 0, 3, 2], DISPLAY, &[9.0; 12])),
        // Its last column and its first row are beyond the picture.
        ("c.exr", exr([2, -1, 4, 0], DISPLAY, &[5.0, 6.0, 7.0, 1.0, 2.0, 3.0])),
    ]);
    let paths = ["a.exr", "b.exr", "c.exr"].map(|name| there.path().join(name));
    let stack = stack(&paths).expect("a stack");
    let size = stack.size();
    assert_eq!((size.columns, size.rows), (4, 3));
    let frame = Frame::of(&paths).expect("a frame");
    let values = |at: usize| picture_in(&paths[at], frame).expect("a picture").values().to_vec();
    assert_eq!(values(0), [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 0.0, 0.0, 3.0, 4.0, 0.0]);
    assert_eq!(values(1), [9.0; 12]);
    assert_eq!(values(2), [0.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
}

/// Two windows of one size, shifted against each other: their pixels were once compared side by side.
#[test]
fn equal_sizes_at_other_places_are_not_compared_by_position() {
    let there = folder(&[
        ("a.exr", exr([0, 0, 1, 0], DISPLAY, &[1.0, 2.0])),
        ("b.exr", exr([2, 0, 3, 0], DISPLAY, &[1.0, 2.0])),
        ("c.exr", exr([2, 0, 3, 0], [2, 0, 3, 0], &[1.0, 2.0])),
    ]);
    let path = |name: &str| there.path().join(name);
    let both = stack(&[path("a.exr"), path("b.exr")]).expect("a stack");
    assert_eq!((both.size().columns, both.size().rows), (4, 3));
    let error = stack(&[path("a.exr"), path("c.exr")]).expect_err("no common picture");
    assert!(matches!(error, ImageError::Faulty { .. }), "{error}");
    let words = error.to_string();
    for part in ["(2, 0) to (3, 0)", "(0, 0) to (3, 2)", "not compared by their position"] {
        assert!(words.contains(part), "{words}");
    }
    // Files with the same window are compared as they are stored.
    let alike = stack(&[path("b.exr"), path("b.exr")]).expect("a stack");
    assert_eq!((alike.size().columns, alike.size().rows), (2, 1));
}

/// The truth is placed in the same frame as the passes.
#[test]
fn a_truth_of_another_window_is_laid_beside_the_passes() {
    let there = folder(&[
        ("a.exr", exr([0, 0, 1, 0], [0, 0, 1, 0], &[0.0, 1.0])),
        ("b.exr", exr([0, 0, 1, 0], [0, 0, 1, 0], &[0.0, 1.0])),
        ("truth.exr", exr([1, 0, 1, 0], [0, 0, 1, 0], &[1.0])),
    ]);
    let arguments =
        ["judge", "--images", "--truth-image", "truth.exr", "--variance", "0", "a.exr", "b.exr"];
    let output = run(there.path(), &arguments);
    assert!(output.status.code() != Some(2), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("verdict   pass"), "{}", text(&output.stdout));
}

#[test]
fn what_is_not_read_is_named() {
    let one = [0, 0, 0, 0];
    let vast = [0, 0, i32::MAX - 1, i32::MAX - 1];
    for (bytes, words) in [
        (with_attributes(one, one, &[1.0], 8, 2, b"Y"), "compression is DWAA, which is not read"),
        (with_attributes(one, one, &[1.0], 9, 2, b"Y"), "compression is DWAB"),
        (with_attributes(one, one, &[1.0], 10, 2, b"Y"), "compression is HTJ2K256"),
        (with_attributes(one, one, &[1.0], 99, 2, b"Y"), "compression is number 99"),
        (with_attributes(one, one, &[1.0], 0, 2 | 0x800, b"Y"), "deep scan lines"),
        (with_attributes(one, one, &[1.0], 0, 3, b"Y"), "version 3"),
        (with_attributes([0, 0, -1, 0], one, &[], 0, 2, b"Y"), "holds no pixel"),
        (exr([0, 0, 99_999, 99_999], one, &[]), "are more than"),
    ] {
        let there = folder(&[("a.exr", bytes)]);
        let error = picture(&there.path().join("a.exr")).expect_err(words).to_string();
        assert!(error.contains(words), "{error}");
    }
    let there =
        folder(&[("a.exr", exr(one, vast, &[1.0])), ("b.exr", exr([1, 0, 1, 0], vast, &[1.0]))]);
    let error = stack(&["a.exr", "b.exr"].map(|name| there.path().join(name))).expect_err("vast");
    assert!(error.to_string().contains("has more than"), "{error}");
}
