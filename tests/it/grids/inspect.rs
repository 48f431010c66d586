//! `trueflight inspect`: the content of files, and faults in them.

use std::path::Path;

use serde_json::Value;

use super::{data, run, text};

fn inspected(files: &[&str]) -> Vec<Value> {
    let output = run(&data("."), &[&["inspect", "--format", "json"][..], files].concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

#[test]
fn grids_are_told_by_name_size_box_and_values() {
    // Voxel n of 27 has (n² mod 8)/4 + 1/8, half a unit apart; 18 of 27 are a quarter or less: see make.py and later.cpp.
    let later = &inspected(&["grids/later.nvdb"])[0];
    assert_eq!(
        (later["name"].as_str(), later["class"].as_str()),
        (Some("density"), Some("fog volume"))
    );
    assert_eq!(numbers(&later["size"]), [3.0; 3]);
    assert_eq!(
        [numbers(&later["low"]), numbers(&later["high"])],
        [[4.0, 1.5, -7.5], [6.0, 3.5, -5.5]]
    );
    assert_eq!(numbers(&later["voxel"]), [0.5; 3]);
    let values: Vec<f64> = (0..27).map(|n| f64::from(n * n % 8) / 4.0 + 0.125).collect();
    let mean = values.iter().sum::<f64>() / 27.0;
    let most = values.iter().copied().fold(0.0, f64::max);
    assert_eq!([&later["least"], &later["most"]].map(Value::as_f64), [Some(0.125), Some(most)]);
    assert!((later["mean"].as_f64().expect("a mean") - mean).abs() < 1e-12);
    assert_eq!((later["background"].as_f64(), later["active"].as_u64()), (Some(0.0), Some(27)));
    let several = inspected(&["vdb/several.vdb"]);
    let names: Vec<&str> =
        several.iter().map(|item| item["name"].as_str().expect("a name")).collect();
    assert_eq!(names, ["density", "shared", "velocity", "mask", "heat[0]", "heat[1]"]);
    let note = |item: &Value| item["notes"].to_string();
    assert!(note(&several[2]).contains("not read") && several[2]["kind"] == "Tree_vec3s_5_4_3");
    let level = &inspected(&["vdb/level-set.vdb"])[0];
    assert!(note(level).contains("no medium: its grid is a level set"), "{level}");
    assert!(level["least"].as_f64().expect("a distance") < 0.0);
    let filled = &inspected(&["grids/filled.vdb"])[0];
    assert!(note(filled).contains("ends at its box") && filled["background"] == 0.5, "{filled}");
    let turned = &inspected(&["grids/turned.vdb"])[0];
    assert!(turned["details"].to_string().contains("turned or sheared"), "{turned}");
    let torus = &inspected(&["field/31-ray-misses/torus.vdb"])[0];
    assert!(torus["most"].as_f64().is_some_and(|most| most > 0.0), "{torus}");
}

#[test]
fn arrays_volumes_and_channels_are_told() {
    let axes = &inspected(&["field/23-npy-axes/zyx.npy"])[0];
    assert_eq!(numbers(&axes["size"]), [2.0, 3.0, 4.0]);
    assert!(axes["details"].to_string().contains("a grid of 4 × 3 × 2 voxels"), "{axes}");
    let colours = inspected(&["field/02-vol-variants/rgb.vol"]);
    assert_eq!(colours.len(), 3);
    assert_eq!(colours[2]["name"], "channel 2");
    let bytes = &inspected(&["field/02-vol-variants/u8.vol"])[0];
    assert!(bytes["kind"].as_str().is_some_and(|kind| kind.starts_with("uint8")));
    assert!(bytes["most"].as_f64().is_some_and(|most| most <= 1.0));
}

#[test]
fn images_and_draws_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let there = folder.path();
    let image = b"Pf\n2 1\n-1.0\n";
    let pixels: Vec<u8> = [0.25_f32, 0.75].iter().flat_map(|x| x.to_le_bytes()).collect();
    std::fs::write(there.join("a.pfm"), [&image[..], &pixels].concat()).expect("written");
    std::fs::write(there.join("a.csv"), "T,cost\n0.5,3\n1.5,5\n").expect("written");
    std::fs::write(there.join("a.f64"), 2.5_f64.to_le_bytes()).expect("written");
    std::fs::write(
        there.join("a.exr"),
        super::windows::exr([0, 0, 1, 0], [0, 0, 3, 3], &[1.0, 2.0]),
    )
    .expect("written");
    let output = run(there, &["inspect", "--format", "json", "a.pfm", "a.csv", "a.f64", "a.exr"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let items: Vec<Value> = serde_json::from_slice(&output.stdout).expect("JSON");
    let told: Vec<(&str, Vec<f64>, f64)> = items
        .iter()
        .map(|item| {
            (
                item["name"].as_str().expect("a name"),
                numbers(&item["size"]),
                item["mean"].as_f64().expect("a mean"),
            )
        })
        .collect();
    assert_eq!(
        told,
        [
            ("", vec![2.0, 1.0], 0.5),
            ("T", vec![2.0], 1.0),
            ("cost", vec![2.0], 4.0),
            ("", vec![1.0], 2.5),
            ("", vec![2.0, 1.0], 1.5),
        ]
    );
    let details = items[4]["details"].to_string();
    for words in [
        "channels Y",
        "compression none",
        "data window (0, 0) to (1, 0), display window (0, 0) to (3, 3)",
    ] {
        assert!(details.contains(words), "{details}");
    }
    let table = text(&run(there, &["inspect", "a.exr", "a.csv"]).stdout);
    assert!(
        table.contains("a.exr: OpenEXR") && table.contains("2 × 1 pixels (columns, rows)"),
        "{table}"
    );
    let csv = text(&run(there, &["inspect", "--format", "csv", "a.csv"]).stdout);
    assert!(csv.starts_with("file,format,name,kind,") && csv.lines().count() == 3, "{csv}");
}

#[test]
fn what_cannot_be_read_is_one_error_each_and_exit_code_2() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, bytes: &[u8]| {
        std::fs::write(folder.path().join(name), bytes).expect("written");
    };
    write("a.vol", b"VOL");
    write("a.npy", b"none");
    write("a.vdb", b" BDV");
    write("a.nvdb", b"NanoVDB0");
    write("a.pbrt", b"Shape \"sphere\"");
    write("a.exr", b"v/1\x01");
    write("a.pfm", b"P6\n1 1\n255\n");
    write("a.csv", b"");
    write("a.f64", b"1234");
    write("a.xyz", b"1");
    write("good.f64", &1.0_f64.to_le_bytes());
    for (file, words) in [
        ("a.vol", "header of 48 bytes"),
        ("a.npy", "header cannot be read"),
        ("a.vdb", "does not begin as OpenVDB"),
        ("a.nvdb", "it ends within"),
        ("a.pbrt", "makes no medium"),
        ("a.exr", "it ends within the"),
        ("a.pfm", "begins with `P6`"),
        ("a.csv", "no draws"),
        ("a.f64", "more than"),
        ("a.xyz", "its ending is none that is read"),
        ("none.vol", "No such file"),
        (".", "it is a folder"),
    ] {
        let output = run(folder.path(), &["inspect", file]);
        let error = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{file}: {error}");
        assert!(
            error.contains(words) && error.starts_with("error: cannot inspect"),
            "{file}: {error}"
        );
        assert_eq!(error.trim_end().lines().count(), 1, "{error}");
    }
    // The other files are still shown.
    let output = run(folder.path(), &["inspect", "a.vol", "good.f64"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stdout).contains("good.f64: raw draws"));
    assert_eq!(run(Path::new("."), &["inspect"]).status.code(), Some(2));
}
