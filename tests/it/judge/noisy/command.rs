//! `judge --images` by the command: estimated variances and references.

use std::path::Path;

use super::super::{Place, npy, raw};
use super::{Law, draws, values};

/// The passes of the field: fails as an exact variance, passes as what it is.
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
    place.expect(2, &format!("--images --same-law --truth 1 {passes}"), &["--against"]);
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
    // A folder of passes is a stack; its files come in the order of their names.
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
