//! `judge --images` by the command: estimated variances and references.

use std::path::Path;

use trueflight::rng::{Address, unit};

use super::super::{Place, npy, raw};
use super::{Law, draws, values};

/// Passes of a user fail with an exact variance, and pass with it declared as estimated.
#[test]
fn the_command_takes_estimated_variances_and_references() {
    let field =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/field/08-estimated-variance");
    let file = |name: &str| field.join(name).display().to_string();
    let place = Place::new(&[]);
    let known = format!("--images --truth-image {}", file("truth.npy"));
    let estimated = format!("{known} --variance-image {}", file("variance-estimated.npy"));
    let passes = file("passes.npy");
    place.expect(1, &format!("{estimated} {passes}"), &["--variance-passes N"]);
    let (code, text) = place.says(&format!("{estimated} --variance-passes 64 {passes}"), &[]);
    assert!(code == 0 || code == 3, "{text}");
    assert!(text.contains("estimate of 64 passes"), "{text}");
    place.expect(2, &format!("{known} --variance-passes 64 {passes}"), &["--variance-image"]);
    place.expect(2, &format!("{estimated} --variance-passes 1 {passes}"), &["--variance-passes"]);
    place.expect(2, &format!("{estimated} --truth-passes 0 {passes}"), &["--truth-passes"]);
    place.expect(2, &format!("--images --same-distribution --truth 1 {passes}"), &["--against"]);
    place.expect(
        2,
        &format!("--images --against {passes} --truth 1 {passes}"),
        &["cannot be used"],
    );
    place.expect(2, &format!("{known} --truth 1 --truth-passes 3 {passes}"), &["--truth"]);
    place.expect(2, &format!("--images --truth 1 --truth-passes 3 {passes}"), &["--truth-image"]);
    place.expect(2, &format!("--against {passes} {passes}"), &["--images"]);
    place.expect(2, &format!("--images --against nowhere.npy {passes}"), &["nowhere.npy"]);
    place.expect(3, &format!("--images --against {passes} {passes}"), &["share values"]);
    place.expect(2, &format!("{known} --kurtosis 0.5 {passes}"), &["kurtosis"]);
}

/// Returns passes of 96 × 96 pixels that a filter of 3 × 3 blends, with a brighter square.
fn blended(seed: u64, factor: f64) -> Vec<u8> {
    let mut rng = Address { seed, experiment: 33, block: 0, lane: 0 }.stream();
    let mut values = Vec::new();
    for _ in 0..32 {
        let noise: Vec<f64> = (0..98 * 98).map(|_| -(1.0 - unit(&mut rng)).ln()).collect();
        for (row, column) in (0..96).flat_map(|row| (0..96).map(move |column| (row, column))) {
            let is_bad = (32..64).contains(&row) && (32..64).contains(&column);
            let places = (0..9).map(|k| (row + k / 3) * 98 + column + k % 3);
            let mean = places.map(|place| noise[place]).sum::<f64>() / 9.0;
            values.push(if is_bad { factor * mean } else { mean });
        }
    }
    npy("<f8", "(32, 96, 96)", &raw(&values))
}

#[test]
fn averages_of_blocks_wider_than_a_filter_are_judged_as_pixels() {
    let place = Place::new(&[
        ("good.npy", &blended(1, 1.0)),
        ("bad.npy", &blended(2, 1.3)),
        ("other.npy", &blended(3, 1.0)),
    ]);
    let against = "--images --against other.npy --tile";
    place.expect(3, &format!("{against} 16 bad.npy"), &["different distributions", "--average N"]);
    place.expect(1, &format!("{against} 16 --same-distribution bad.npy"), &["rows 32 to 63"]);
    // Tiles of 4 × 4 blocks of 8 × 8 pixels; 0.3 √(32 · 1024/2) = 38 standard errors.
    place.expect(
        1,
        &format!("{against} 4 --average 8 bad.npy"),
        &["12 × 12 pixels", "rows 4 to 7"],
    );
    let (code, text) = place.says(&format!("{against} 4 --average 8 good.npy"), &[]);
    assert_ne!(code, 1, "{text}");
    let known = "--images --truth 1 --variance-stack other.npy --tile";
    place.expect(3, &format!("{known} 16 bad.npy"), &["not independent"]);
    place.expect(
        1,
        &format!("{known} 4 --average 8 bad.npy"),
        &["4 × 4 at row 4, column 4", ": fail"],
    );
    place.expect(2, "--images --truth 1 --variance 1 --average 2 good.npy", &["cannot be used"]);
    place.expect(2, &format!("{known} 4 --average 0 good.npy"), &["--average"]);
}

#[test]
fn the_command_writes_the_p_values() {
    let bytes = |seed, change: fn(usize) -> f64| {
        npy("<f8", "(16, 24, 24)", &raw(&draws(seed, 16, Law::Normal, change)))
    };
    let dark = |pixel: usize| if pixel < 8 * 24 { 0.7 } else { 1.0 };
    let one = |_: usize| 1.0;
    let place = Place::new(&[
        ("a.npy", &bytes(1, one)),
        ("b.npy", &bytes(2, one)),
        ("c.npy", &bytes(3, dark)),
    ]);
    place.expect(
        0,
        "--images --against a.npy --tile 8 b.npy",
        &["permutations of passes", "but only"],
    );
    let out = "--images --against a.npy --tile 8 --out out --junit report.xml c.npy";
    place.expect(1, out, &["tiles are off", "a.npy"]);
    let png = std::fs::read(place.path().join("out/p-values.png")).expect("a picture");
    assert!(png.starts_with(b"\x89PNG") && png.len() < 60_000, "{}", png.len());
    let table = std::fs::read_to_string(place.path().join("out/tiles.csv")).expect("a table");
    assert!(table.lines().next().is_some_and(|line| line.contains(",z,p,")), "{table}");
    let json = place.json("--images --against a.npy --tile 8 b.npy", &[]);
    assert!(json["reason"].as_str().is_some_and(|said| said.starts_with("but only a bias above")));
    assert_eq!(json["comparison"]["method"], "permutation");
    // A folder of passes is a stack; its files are taken in the order of their names.
    let folder = place.path().join("reference");
    std::fs::create_dir(&folder).expect("a folder");
    for pass in 0..4 {
        let bytes = npy("<f8", "(24, 24)", &raw(&values(4 + pass, 1, Law::Normal)));
        std::fs::write(folder.join(format!("{pass}.npy")), bytes).expect("a file");
    }
    place.expect(
        3,
        "--images --against reference --tile 24 --tolerance 1e-3 b.npy",
        &["4 passes of the reference"],
    );
    std::fs::create_dir(place.path().join("empty")).expect("a folder");
    place.expect(2, "--images --against empty b.npy", &["without images"]);
}
