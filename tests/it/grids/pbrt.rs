//! Grids in scene files of pbrt.

use trueflight::media::grid_file::{GridChoice, Samples};

use super::{refused, written};

const SMOKE: &str = "# A scene
Camera \"perspective\" \"float fov\" 45
WorldBegin
MakeNamedMedium \"smoke\" \"string type\" \"uniformgrid\" \"integer nx\" 2 \"integer ny\" [ 1 ]
  \"integer nz\" [2] # samples
  \"point3 p0\" [ 0 0 0 ] \"point3 p1\" [ 2 1 4 ] \"rgb sigma_a\" [ 1 1 1 ] \"bool preset\" true
  \"float density\" [ 0.5 1
    2e0 .25 ] \"float g\" 0
Shape \"sphere\" \"float radius\" 1
";

fn read(text: &str) -> Samples {
    written("a.pbrt", text.as_bytes(), &GridChoice::default())
        .unwrap_or_else(|error| panic!("{error:?}"))
}

fn corners(samples: &Samples) -> [[f64; 3]; 2] {
    let bounds = samples.bounds.expect("a box");
    [bounds.low.0, bounds.high.0]
}

#[test]
fn a_grid_is_read_with_its_box() {
    let samples = read(SMOKE);
    assert_eq!((samples.size, &samples.values[..]), ([2, 1, 2], &[0.5, 1.0, 2.0, 0.25][..]));
    assert_eq!(corners(&samples), [[0.0; 3], [2.0, 1.0, 4.0]]);
    // Without corners the box is that of a unit; the third version of pbrt says "point" and "heterogeneous".
    let unit = SMOKE.replace("\"point3 p0\" [ 0 0 0 ] \"point3 p1\" [ 2 1 4 ]", "");
    assert_eq!(corners(&read(&unit)), [[0.0; 3], [1.0; 3]]);
    let third = SMOKE.replace("point3", "point").replace("uniformgrid", "heterogeneous");
    assert_eq!(read(&third), samples);
    let turned =
        SMOKE.replace("[ 0 0 0 ]", "[ 2 1 4 ]").replacen("p1\" [ 2 1 4 ]", "p1\" [ 0 0 0 ]", 1);
    assert_eq!(corners(&read(&turned)), corners(&samples));
}

/// Directives before the medium move its box, and those of a camera do not.
#[test]
fn the_box_moves_with_its_scene() {
    let at = |directives: &str| {
        corners(&read(&SMOKE.replace("WorldBegin\n", &format!("WorldBegin\n{directives}\n"))))
    };
    assert_eq!(at("Translate 1 2 3"), [[1.0, 2.0, 3.0], [3.0, 3.0, 7.0]]);
    assert_eq!(at("Translate 1 0 0 Scale 2 2 2"), [[1.0, 0.0, 0.0], [5.0, 2.0, 8.0]]);
    assert_eq!(at("Scale 2 2 2 Translate 1 0 0"), [[2.0, 0.0, 0.0], [6.0, 2.0, 8.0]]);
    assert_eq!(at("AttributeBegin Translate 9 9 9 AttributeEnd"), [[0.0; 3], [2.0, 1.0, 4.0]]);
    let matrix = "[ 2 0 0 0  0 1 0 0  0 0 1 0  5 0 0 1 ]";
    assert_eq!(
        at(&format!("Translate 7 7 7 Transform {matrix}")),
        [[5.0, 0.0, 0.0], [9.0, 1.0, 4.0]]
    );
    assert_eq!(
        at(&format!("Translate 1 0 0 ConcatTransform {matrix}")),
        [[6.0, 0.0, 0.0], [10.0, 1.0, 4.0]]
    );
    let before = SMOKE.replace("Camera", "LookAt 0 0 5 0 0 0 0 1 0\nCamera");
    assert_eq!(corners(&read(&before)), [[0.0; 3], [2.0, 1.0, 4.0]]);
    // A mirror along x reverses the samples.
    let mirrored = read(&SMOKE.replace("WorldBegin", "WorldBegin Scale -1 1 1"));
    assert_eq!(corners(&mirrored), [[-2.0, 0.0, 0.0], [0.0, 1.0, 4.0]]);
    assert_eq!(mirrored.values, [1.0, 0.5, 0.25, 2.0]);
}

#[test]
fn a_medium_is_chosen_by_its_name() {
    let two = format!("{SMOKE}{}", SMOKE.replace("\"smoke\"", "\"fog\"").replace("0.5 1", "3 4"));
    let fog = GridChoice { grid: Some("fog".into()), ..GridChoice::default() };
    assert_eq!(
        written("a.pbrt", two.as_bytes(), &fog).expect("a grid").values,
        [3.0, 4.0, 2.0, 0.25]
    );
    refused("a.pbrt", two.as_bytes(), &GridChoice::default(), "several media: \"smoke\", \"fog\"");
    let none = GridChoice { grid: Some("mist".into()), ..GridChoice::default() };
    refused("a.pbrt", two.as_bytes(), &none, "no medium \"mist\", but \"smoke\", \"fog\"");
    // Media without grids do not make a choice necessary.
    let air = format!("MakeNamedMedium \"air\" \"string type\" \"homogeneous\"\n{SMOKE}");
    assert_eq!(read(&air), read(SMOKE));
}

#[test]
fn wrong_scenes_are_refused() {
    for (from, to, words) in [
        ("MakeNamedMedium", "Texture", "makes no medium"),
        ("\"float density\"", "\"float temperature\"", "no \"float density\""),
        ("uniformgrid", "rgbgrid", "of the type \"rgbgrid\""),
        ("uniformgrid\"", "nanovdb\" \"string filename\" \"a.nvdb\"", "\"nanovdb\""),
        ("nx\" 2", "nx\" 3", "4 densities for 3 × 1 × 2"),
        ("nx\" 2", "nx\" 0", "samples along its axes"),
        ("nx\" 2", "nx\" 1e300", "samples along its axes"),
        ("nx\" 2", "nx\" 4000000000", "4 densities for 4000000000"),
        ("nx\" 2", "nx\" two", "line 4: \"two\" is not a number"),
        ("0.5 1", "0.5 x", "line 7: \"x\" is not a number"),
        ("0.5 1", "0.5 -1", "(1, 0, 0) is -1"),
        ("0.5 1", "0.5 nan", "is NaN"),
        (".25 ]", ".25", "\"float g\" is not a number"),
        (
            ".25 ] \"float g\" 0\nShape \"sphere\" \"float radius\" 1\n",
            ".25",
            "a list does not end",
        ),
        ("\"float radius\" 1", "\"float radius", "a text does not end"),
        ("[ 2 1 4 ]", "[ 2 1 ]", "without three numbers"),
        ("WorldBegin", "WorldBegin Rotate 30 0 0 1", "stands under Rotate"),
        ("WorldBegin", "WorldBegin Translate 1 2", "lacks one of its three numbers"),
        ("WorldBegin", "WorldBegin Transform [ 1 0 ]", "16 numbers"),
        ("\"smoke\"", "smoke", "a medium has no name"),
    ] {
        assert!(SMOKE.contains(from), "{from}");
        refused("a.pbrt", SMOKE.replacen(from, to, 1).as_bytes(), &GridChoice::default(), words);
    }
    refused(
        "a.pbrt",
        b"Include \"smoke-grid.pbrt\"",
        &GridChoice::default(),
        "includes \"smoke-grid.pbrt\"",
    );
    refused("a.pbrt", b"", &GridChoice::default(), "no medium");
    refused("a.pbrt", &[0xff, 0xfe], &GridChoice::default(), "no text");
}

/// pbrt's samples are 0 beyond the box, so that σ_t falls to half towards its faces.
#[test]
fn a_grid_of_pbrt_is_zero_beyond_its_box() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("a.pbrt"), SMOKE).expect("written");
    let there = folder.path().join("a.pbrt");
    let text = format!(
        "title = \"t\"\n[problem.transmittance]\nvolume.grid = {{ file = \"{}\" }}\n\
         ray = {{ origin = [-1, 0.5, 1], direction = [1, 0, 0], length = 9 }}\nestimators = [{{ closed-form = {{}} }}]",
        there.display()
    );
    // Along x at the height of the first row: 0 at −0.5, 0.5 at 0.5, 1 at 1.5, 0 at 2.5; the box is from 0 to 2.
    let depth: f64 = 0.5 * (0.25 + 0.5) * 0.5 + 0.75 + 0.5 * (1.0 + 0.5) * 0.5;
    let truth = crate::common::predicted(&text)[0].truth.expect("a transmittance");
    assert!((truth / (-depth).exp() - 1.0).abs() < 1e-14, "{truth}");
}
