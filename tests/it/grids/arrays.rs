//! Arrays of `NumPy` as grids: the axis that is x, the order of the axes, and the type of the numbers.

use trueflight::media::axes::Axes;
use trueflight::media::grid_file::{GridChoice, Samples};

use super::{data, refused, run, text, written};
use crate::common::predicted;

fn npy(kind: &str, shape: &str, order: &str, numbers: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': {shape}, }}\n");
    let length = u16::try_from(header.len()).expect("short").to_le_bytes();
    [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes(), numbers].concat()
}

fn singles(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|x| x.to_le_bytes()).collect()
}

#[test]
fn the_last_axis_is_x_whatever_the_order_in_memory() {
    let samples = singles(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    let read =
        written("a.npy", &npy("<f4", "(1, 2, 3)", "False", &samples), &GridChoice::default());
    let Samples { size, values, .. } = read.expect("a grid");
    assert_eq!((size, values), ([3, 2, 1], vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0]));
    // In Fortran's order the first axis, of length 1, varies fastest, then y, then x.
    let read = written("a.npy", &npy("<f4", "(1, 2, 3)", "True", &samples), &GridChoice::default());
    let Samples { size, values, .. } = read.expect("a grid");
    assert_eq!((size, values), ([3, 2, 1], vec![0.0, 2.0, 4.0, 1.0, 3.0, 5.0]));
    // array[x, y, z] of shape (3, 2, 1).
    let choice =
        GridChoice { axes: Axes::named("xyz").expect("an order"), ..GridChoice::default() };
    let read = written("a.npy", &npy("<f4", "(3, 2, 1)", "False", &samples), &choice);
    let Samples { size, values, .. } = read.expect("a grid");
    assert_eq!((size, values), ([3, 2, 1], vec![0.0, 2.0, 4.0, 1.0, 3.0, 5.0]));
}

#[test]
fn numbers_of_every_type_are_samples() {
    for (kind, numbers) in [
        ("<f2", &[0x00, 0x3c, 0x00, 0x40][..]),
        (">f2", &[0x3c, 0x00, 0x40, 0x00]),
        (">f4", &[0x3f, 0x80, 0, 0, 0x40, 0, 0, 0]),
        ("|u1", &[1, 2]),
        ("<i4", &[1, 0, 0, 0, 2, 0, 0, 0]),
        (">u2", &[0, 1, 0, 2]),
        ("<i8", &[1, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0]),
    ] {
        let read =
            written("a.npy", &npy(kind, "(1, 1, 2)", "False", numbers), &GridChoice::default());
        assert_eq!(read.expect(kind).values, [1.0, 2.0], "{kind}");
    }
}

#[test]
fn wrong_arrays_are_refused() {
    let four = singles(&[1.0; 4]);
    let whole = npy("<f4", "(1, 2, 2)", "False", &four);
    for (bytes, words) in [
        (npy("<f4", "(4,)", "False", &four), "shape (4,)"),
        (npy("<f4", "(1, 2, 2, 1)", "False", &four), "shape (1, 2, 2, 1)"),
        (npy("<f4", "(1, 2, 2)", "False", &singles(&[f32::INFINITY; 4])), "(0, 0, 0) is inf"),
        (npy("<i4", "(1, 1, 1)", "False", &(-3_i32).to_le_bytes()), "(0, 0, 0) is -3"),
        (npy("<c8", "(1, 1, 2)", "False", &four), "<c8"),
        (npy("|O", "(1, 1, 2)", "False", &four), "|O"),
        (npy("<f4", "(1000000000, 1000000000, 1000000000)", "False", &four), "shape (1000000000, "),
        (npy("<f4", "(0, 2, 2)", "False", &[]), "shape (0, 2, 2)"),
        (b"no such thing".to_vec(), "header"),
        (whole[..whole.len() - 3].to_vec(), "shorter"),
        ([&whole[..], &[0]].concat(), "longer"),
    ] {
        refused("a.npy", &bytes, &GridChoice::default(), words);
    }
    refused("a.raw", &whole, &GridChoice::default(), "none of .vol, .npy, .vdb, .nvdb and .pbrt");
}

/// The arrays of the field hold the same grid, once as array[z, y, x] and once as array[x, y, z].
#[test]
fn the_arrays_of_the_field_have_one_transmittance() {
    let folder = data("field/23-npy-axes");
    let text = std::fs::read_to_string(folder.join("axes.toml")).expect("a case");
    let of = |file: &str, more: &str| {
        let there = format!("{}/{file}", folder.display());
        let text = text.replace("\"zyx.npy\"", &format!("\"{there}\"{more}"));
        predicted(&text)[0].truth.expect("a transmittance")
    };
    // The ray crosses the row of samples that are 5, along 3 of length 1 each.
    let expected = (-15.0_f64).exp();
    for (file, more) in
        [("zyx.npy", ""), ("zyx.npy", ", axes = \"zyx\""), ("xyz.npy", ", axes = \"xyz\"")]
    {
        assert!((of(file, more) / expected - 1.0).abs() < 1e-13, "{file}{more}");
    }
    assert_eq!(of("xyz.npy", ""), 1.0);
}

#[test]
fn plan_says_how_many_voxels_are_along_x_y_and_z() {
    let output = run(&data("field/23-npy-axes"), &["plan", "axes.toml"]);
    let text = text(&output.stdout);
    assert!(
        text.contains("grid zyx.npy: 4 × 3 × 2 voxels (x, y, z), box [0, 0, 0] to [4, 3, 2]"),
        "{text}"
    );
}
