//! `judge --images`: pictures in NPY, PFM and EXR, and faults in some.

use std::path::Path;

use exr::prelude::{Blocks, LineOrder};
use exr::prelude::{Compression, Encoding, Image, SpecificChannels, Vec2, WritableImage};
use trueflight::judge::images::files::{picture, stack};
use trueflight::judge::images::{ImageError, Size};

use super::{Place, npy, raw};

/// Numbers that are exact in half precision, in 3 columns and 2 rows.
const GREY: [f32; 6] = [0.5, 1.0, -0.25, 3.0, 0.0, 1024.0];

fn colours() -> Vec<f32> {
    GREY.iter().flat_map(|x| [*x, 2.0 * x, 0.5 - x]).collect()
}

fn doubles(values: &[f32]) -> Vec<f64> {
    values.iter().map(|&x| f64::from(x)).collect()
}

fn singles(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// Returns a float map of 2 rows.
fn pfm(values: &[f32], columns: usize) -> Vec<u8> {
    let row = values.len() / 2;
    let kind = if row == columns { "Pf" } else { "PF" };
    let header = format!("{kind}\n{columns} 2\n-1.0\n").into_bytes();
    [header, singles(&values[row..]), singles(&values[..row])].concat()
}

/// Returns an uncompressed EXR of 2 rows by the specification, with the named channels in their order in the file.
fn plain_exr(channels: &[(&str, Vec<f32>)], columns: usize) -> Vec<u8> {
    let mut bytes = vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        bytes.extend([name.as_bytes(), b"\0", kind.as_bytes(), b"\0"].concat());
        bytes.extend(i32::try_from(value.len()).expect("short").to_le_bytes());
        bytes.extend(value);
    };
    let mut list = Vec::new();
    for (name, _) in channels {
        list.extend(
            [name.as_bytes(), b"\0", &[2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]].concat(),
        );
    }
    list.push(0);
    let last = i32::try_from(columns).expect("short") - 1;
    let window: Vec<u8> = [0, 0, last, 1].iter().flat_map(|x: &i32| x.to_le_bytes()).collect();
    attribute("channels", "chlist", &list);
    attribute("compression", "compression", &[0]);
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &1f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1f32.to_le_bytes());
    bytes.push(0);
    let line = 4 * columns * channels.len();
    let first = bytes.len() + 16;
    for row in 0..2 {
        bytes.extend(((first + row * (8 + line)) as u64).to_le_bytes());
    }
    for row in 0..2 {
        bytes.extend(i32::try_from(row).expect("short").to_le_bytes());
        bytes.extend(i32::try_from(line).expect("short").to_le_bytes());
        for (_, values) in channels {
            bytes.extend(singles(&values[row * columns..(row + 1) * columns]));
        }
    }
    bytes
}

/// Writes the same colours by the crate `exr`.
fn packed_exr(path: &Path, compression: Compression, blocks: Blocks) {
    let colours = colours();
    let channels = SpecificChannels::rgb(|Vec2(column, row): Vec2<usize>| {
        let first = 3 * (row * 3 + column);
        (colours[first], colours[first + 1], colours[first + 2])
    });
    let mut image = Image::from_channels((3, 2), channels);
    image.layer_data.encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
    image.write().non_parallel().to_file(path).expect("written");
}

#[test]
fn all_formats_hold_the_same_numbers() {
    let (colours, every) = (colours(), |k: usize| move |pixel: &[f32]| pixel[k]);
    let plane = |k: usize| colours.chunks(3).map(every(k)).collect::<Vec<f32>>();
    let rgb = [("A", vec![1.0; 6]), ("B", plane(2)), ("G", plane(1)), ("R", plane(0))];
    let place = Place::new(&[
        ("grey.npy", &npy("<f8", "(2, 3)", &raw(&doubles(&GREY)))),
        ("grey.pfm", &pfm(&GREY, 3)),
        ("grey.exr", &plain_exr(&[("A", vec![1.0; 6]), ("Y", GREY.to_vec())], 3)),
        ("depth.exr", &plain_exr(&[("Z", GREY.to_vec())], 3)),
        ("colours.npy", &npy("<f4", "(2, 3, 3)", &singles(&colours))),
        ("colours.pfm", &pfm(&colours, 3)),
        ("colours.exr", &plain_exr(&rgb, 3)),
    ]);
    let tiles = Blocks::Tiles(Vec2(2, 2));
    let mut names = vec!["colours.npy", "colours.pfm", "colours.exr"];
    for (name, compression, blocks) in [
        ("zip.exr", Compression::ZIP16, Blocks::ScanLines),
        ("rle.exr", Compression::RLE, Blocks::ScanLines),
        ("piz.exr", Compression::PIZ, Blocks::ScanLines),
        ("tiles.exr", Compression::ZIP1, tiles),
    ] {
        packed_exr(&place.path().join(name), compression, blocks);
        names.push(name);
    }
    let read =
        |name: &str| picture(&place.path().join(name)).unwrap_or_else(|error| panic!("{error}"));
    for name in ["grey.npy", "grey.pfm", "grey.exr", "depth.exr"] {
        assert_eq!(read(name).size(), Size { rows: 2, columns: 3, channels: 1 }, "{name}");
        assert_eq!(read(name).values(), doubles(&GREY), "{name}");
    }
    for name in names {
        assert_eq!(read(name).size(), Size { rows: 2, columns: 3, channels: 3 }, "{name}");
        assert_eq!(read(name).values(), doubles(&colours), "{name}");
    }
}

/// A changed byte or a cut file gives a picture, or an error with the reason.
#[test]
fn broken_files_are_errors() {
    let place = Place::new(&[]);
    let (whole, broken) = (place.path().join("whole.exr"), place.path().join("broken.exr"));
    let (mut read, mut refused) = (0, 0);
    for compression in [Compression::Uncompressed, Compression::ZIP16, Compression::PIZ] {
        packed_exr(&whole, compression, Blocks::ScanLines);
        let bytes = std::fs::read(&whole).expect("a file");
        for index in 0..bytes.len() {
            let flipped = [1, 0x80, 0xff].map(|bits| {
                let mut flipped = bytes.clone();
                flipped[index] ^= bits;
                flipped
            });
            for bytes in flipped.into_iter().chain([bytes[..index].to_vec()]) {
                std::fs::write(&broken, bytes).expect("written");
                match picture(&broken) {
                    Ok(_) => read += 1,
                    Err(error) => {
                        refused += 1;
                        assert!(error.to_string().contains("broken.exr: "), "{error}");
                    }
                }
            }
        }
    }
    // Values, names and windows may be anything; sizes, kinds and ends may not.
    assert!(read > 100 && refused > 1000, "{read} read, {refused} refused");
}

#[test]
fn several_files_are_a_stack_as_one_array_is() {
    let values: Vec<f32> = (0..24_u8).map(f32::from).collect();
    let passes: Vec<&[f32]> = values.chunks(6).collect();
    let place = Place::new(&[
        ("stack.npy", &npy("<f4", "(4, 2, 3)", &singles(&values))),
        ("0.npy", &npy("<f4", "(2, 3)", &singles(passes[0]))),
        ("1.pfm", &pfm(passes[1], 3)),
        ("2.exr", &plain_exr(&[("Y", passes[2].to_vec())], 3)),
        ("3.PFM", &pfm(passes[3], 3)),
        ("colours.pfm", &pfm(&colours(), 3)),
    ]);
    let at =
        |names: &[&str]| -> Vec<_> { names.iter().map(|name| place.path().join(name)).collect() };
    let whole = stack(&at(&["stack.npy"])).expect("a stack");
    assert_eq!((whole.passes(), whole.size()), (4, Size { rows: 2, columns: 3, channels: 1 }));
    assert_eq!(stack(&at(&["0.npy", "1.pfm", "2.exr", "3.PFM"])).expect("a stack"), whole);
    let error = stack(&at(&["0.npy", "colours.pfm"])).expect_err("two sizes");
    assert!(matches!(error, ImageError::Differ { .. }), "{error}");
    assert!(matches!(stack(&at(&["1.pfm"])), Err(ImageError::OnePass)));
}

#[test]
fn bad_input_is_2_with_one_clear_error() {
    let values = vec![0.5; 24];
    let array = |shape: &str| npy("<f8", shape, &raw(&values));
    let exr = plain_exr(&[("Y", GREY.to_vec())], 3);
    let mut nan = vec![0.5; 6];
    nan[4] = f64::NAN;
    let place = Place::new(&[
        ("x.npy", &array("(4, 2, 3)")),
        ("flat.npy", &array("(24,)")),
        ("one.npy", &array("(1, 4, 6)")),
        ("five.npy", &array("(4, 2, 3, 1, 1)")),
        ("none.npy", &npy("<f8", "(4, 0, 3)", &[])),
        ("int.npy", &npy("<i8", "(4, 2, 3)", &raw(&values))),
        ("short.npy", &npy("<f8", "(4, 2, 4)", &raw(&values))),
        ("long.npy", &npy("<f8", "(3, 2, 3)", &raw(&values))),
        ("huge.npy", &npy("<f8", "(4294967295, 4294967295, 4294967295)", &raw(&values))),
        ("text.npy", b"no array"),
        ("a.pfm", &pfm(&GREY, 3)),
        ("cut.pfm", &pfm(&GREY, 3)[..30]),
        ("cut.exr", &exr[..exr.len() - 9]),
        ("text.exr", b"no picture"),
        ("a.png", b"no picture"),
        ("truth.npy", &npy("<f8", "(2, 3)", &raw(&[0.5; 6]))),
        ("wide.npy", &npy("<f8", "(3, 2)", &raw(&[0.5; 6]))),
        ("nan.npy", &npy("<f8", "(2, 3)", &raw(&nan))),
        ("minus.npy", &npy("<f8", "(2, 3)", &raw(&[-0.5; 6]))),
        ("file", b"no folder"),
    ]);
    let truth = "--images --truth 0.5 --range 0,1";
    for (arguments, word) in [
        (format!("{truth} nowhere.npy"), "nowhere.npy"),
        (format!("{truth} flat.npy"), "(passes, height, width)"),
        (format!("{truth} five.npy"), "(passes, height, width)"),
        (format!("{truth} none.npy"), "each 1 or more"),
        (format!("{truth} one.npy"), "there is one pass"),
        (format!("{truth} int.npy"), "<i8"),
        (format!("{truth} short.npy"), "192 bytes follow the header"),
        (format!("{truth} long.npy"), "192 bytes follow the header"),
        (format!("{truth} huge.npy"), "huge.npy"),
        (format!("{truth} text.npy"), "numpy.save"),
        (format!("{truth} a.pfm"), "there is one pass"),
        (format!("{truth} a.pfm cut.pfm"), "cut.pfm: not a pfm file"),
        (format!("{truth} a.pfm cut.exr"), "cut.exr: not an exr file"),
        (format!("{truth} a.pfm text.exr"), "text.exr: not an exr file"),
        (format!("{truth} a.pfm a.png"), ".npy, .pfm and .exr"),
        (format!("{truth} a.pfm x.npy"), "x.npy: 4 × 2 pixels of 3"),
        (format!("{truth} -"), "not read of a pipe"),
        (format!("{truth} --tile 0 x.npy"), "--tile"),
        (format!("{truth} --tolerance 0 x.npy"), "tolerance"),
        (format!("{truth} --rounding -1 x.npy"), "rounding"),
        (
            format!("{truth} --rounding 1e-3 --tolerance 2e-3 x.npy"),
            "4 times what rounding may add",
        ),
        (format!("{truth} --batch 2 x.npy"), "cannot be used with"),
        (format!("{truth} --junit x.npy x.npy"), "it holds images"),
        (format!("{truth} --out file x.npy"), "--out"),
        ("--images x.npy".to_owned(), "--truth"),
        ("--truth 0.5 --tile 2 x.npy".to_owned(), "--images"),
        ("--images --truth 0 --range -1,1 x.npy".to_owned(), "truth of 0 everywhere"),
        ("--images --truth nan x.npy".to_owned(), "not a finite number"),
        ("--images --truth 2 --range 0,1 x.npy".to_owned(), "not a number from 0 to 1"),
        ("--images --truth 0.5 --variance -1 x.npy".to_owned(), "row 0, column 0, channel 0 is -1"),
        ("--images --truth-image wide.npy x.npy".to_owned(), "the picture of the truth: 3 × 2"),
        ("--images --truth-image nan.npy x.npy".to_owned(), "row 1, column 1, channel 0 is NaN"),
        ("--images --truth 0.5 --variance-image minus.npy x.npy".to_owned(), "variance of row 0"),
        ("--images --truth-image x.npy x.npy".to_owned(), "the picture of the truth: 4 × 2"),
    ] {
        place.expect(2, &arguments, &[word]);
    }
    assert!(!place.path().join("out").exists());
}
