//! Mitsuba's grids: encodings, channels, and headers that are wrong.

use trueflight::geometry::Point;
use trueflight::media::grid_file::{GridChoice, Samples};

use super::{data, refused, run, text, written};

/// Returns a `.vol` file with the box from (0, 0, 0) to (1, 2, 3).
fn vol(size: [i32; 3], kind: i32, channels: i32, samples: &[u8]) -> Vec<u8> {
    let mut bytes = b"VOL\x03".to_vec();
    let integers = [kind, size[0], size[1], size[2], channels];
    bytes.extend(integers.iter().flat_map(|n| n.to_le_bytes()));
    bytes.extend([0.0_f32, 0.0, 0.0, 1.0, 2.0, 3.0].iter().flat_map(|x| x.to_le_bytes()));
    bytes.extend(samples);
    bytes
}

fn singles(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn channel(channel: usize) -> GridChoice {
    GridChoice { channel: Some(channel), ..GridChoice::default() }
}

#[test]
fn samples_are_read_in_every_encoding() {
    // 0.5, 1, 0 and 2 as float32 and as float16; 0, 51, 102 and 255 as bytes are 0, 0.2, 0.4 and 1.
    let single = singles(&[0.5, 1.0, 0.0, 2.0]);
    let half = [0x00, 0x38, 0x00, 0x3c, 0x00, 0x00, 0x00, 0x40];
    for (kind, samples, values) in [
        (1, &single[..], [0.5, 1.0, 0.0, 2.0]),
        (2, &half, [0.5, 1.0, 0.0, 2.0]),
        (3, &[0, 51, 102, 255], [0.0, 0.2, 0.4, 1.0]),
    ] {
        let read = written("a.vol", &vol([2, 2, 1], kind, 1, samples), &GridChoice::default());
        let Samples { size, values: found, bounds, .. } = read.expect("a grid");
        assert_eq!((size, &found[..]), ([2, 2, 1], &values[..]), "encoding {kind}");
        assert_eq!(bounds.map(|bounds| bounds.high), Some(Point([1.0, 2.0, 3.0])));
    }
}

/// The channels of a sample are adjacent.
#[test]
fn a_channel_is_chosen() {
    let bytes = vol([2, 1, 1], 1, 3, &singles(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
    for (number, values) in [(0, [1.0, 4.0]), (1, [2.0, 5.0]), (2, [3.0, 6.0])] {
        assert_eq!(written("a.vol", &bytes, &channel(number)).expect("a grid").values, values);
    }
    let coded = vol([2, 1, 1], 3, 3, &[0, 51, 102, 255, 204, 153]);
    assert_eq!(written("A.VOL", &coded, &channel(1)).expect("a grid").values, [0.2, 0.8]);
    refused("a.vol", &bytes, &GridChoice::default(), "3 channels");
    refused("a.vol", &bytes, &channel(3), "no channel 3: it has 3");
}

#[test]
fn wrong_files_are_refused() {
    let samples = singles(&[0.5, 1.0]);
    let good = vol([2, 1, 1], 1, 1, &samples);
    let max = i32::MAX;
    for (bytes, words) in [
        (Vec::new(), "header"),
        (good[..20].to_vec(), "header"),
        (good[..52].to_vec(), "shorter"),
        ([&good[..], &[0]].concat(), "longer"),
        ([b"VOX", &good[3..]].concat(), "VOL"),
        ([b"VOL\x02", &good[4..]].concat(), "version 2"),
        (vol([2, 1, 1], 4, 1, &samples), "directions"),
        (vol([2, 1, 1], 7, 1, &samples), "encoding 7"),
        (vol([2, 1, 1], -1, 1, &samples), "encoding -1"),
        (
            vol([2, 1, 1], 2, 1, &samples),
            "longer than its 2 × 1 × 1 samples of 1 channel in float16",
        ),
        (vol([-2, 1, 1], 1, 1, &samples), "[-2, 1, 1]"),
        (vol([0, 1, 1], 1, 1, &[]), "0 × 1 × 1"),
        (vol([2, 1, 1], 1, 0, &[]), "no channel"),
        (vol([max, max, max], 1, 1, &[]), "shorter"),
        (vol([1_000_000_000, 1, 1], 3, 3, &[]), "shorter"),
        (vol([max, max, max], 1, max, &samples), "shorter"),
        (vol([2, 1, 1], 1, 1, &singles(&[0.5, f32::NAN])), "(1, 0, 0) is NaN"),
        (vol([1, 2, 1], 1, 1, &singles(&[0.5, -1.0])), "(0, 1, 0) is -1"),
        (vol([1, 1, 1], 2, 1, &[0x00, 0x7c]), "is inf"),
    ] {
        refused("a.vol", &bytes, &channel(0), words);
    }
}

/// The files of the field.
#[test]
fn the_files_of_the_field_are_planned() {
    let folder = data("field/02-vol-variants");
    for file in ["t-u8.toml", "t-f16.toml"] {
        let output = run(&folder, &["plan", file]);
        assert_eq!(output.status.code(), Some(0), "{file}: {}", text(&output.stderr));
        assert!(text(&output.stdout).contains("voxels (x, y, z), box"), "{}", text(&output.stdout));
    }
    let output = run(&folder, &["plan", "t-rgb.toml"]);
    assert_eq!(output.status.code(), Some(2));
    let error = text(&output.stderr);
    assert!(error.contains("3 channels") && error.contains("`channel = 0`"), "{error}");
}
