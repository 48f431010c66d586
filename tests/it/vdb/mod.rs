//! Grids of `OpenVDB`: results of its own samplers, exact optical depths, and messages about files without a medium.
//! The files and the expected values are made by `tests/data/vdb/make.py`.

mod damage;

use std::path::{Path, PathBuf};

use serde_json::Value;
use trueflight::geometry::{Bounds, Point};
use trueflight::media::grid_file::{self, GridChoice, Samples, Unreadable};
use trueflight::media::{Body, Volume};

use crate::common::{body, differs, failing, judged, mistakes, none, options, source};
use trueflight::case::Case;
use trueflight::case::CaseText;

fn path(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/vdb").join(file)
}

fn samples(file: &str, grid: Option<&str>) -> Result<Samples, Unreadable> {
    let choice = GridChoice { grid: grid.map(str::to_owned), ..GridChoice::default() };
    grid_file::read(&path(file), &choice)
}

fn numbers(value: &Value) -> Vec<f64> {
    let numbers = value.as_array().expect("a list").iter();
    numbers.map(|x| x.as_f64().expect("a number")).collect()
}

fn point(value: &Value) -> [f64; 3] {
    numbers(value).try_into().expect("three numbers")
}

/// Returns the grid of an entry along a ray, with more settings.
fn read(folder: &str, entry: &Value, ray: [[f64; 3]; 2], more: &str) -> Body {
    let (file, grid) = (&entry["file"], &entry["grid"]);
    let name = if grid == "" { String::new() } else { format!("grid = {grid}, ") };
    let [from, to] = ray;
    let direction: [f64; 3] = std::array::from_fn(|j| to[j] - from[j]);
    let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
    body(&format!(
        "volume.grid = {{ file = \"{folder}/{}\", {name}{more} }}
         ray = {{ origin = {from:?}, direction = {direction:?}, length = {length:?} }}",
        file.as_str().expect("a name")
    ))
}

fn volume(body: &Body) -> &Volume {
    let Body::Volume { volume, .. } = body else { panic!("a volume") };
    &**volume
}

#[test]
fn values_and_depths_are_those_of_openvdb() {
    assert_eq!(agrees("vdb", 1e-12), 19);
}

/// Compares the grids of a folder below `tests/data` with its `expected.json`, and the stated errors of optical depths
/// with the largest allowed one. Returns the number of grids.
pub fn agrees(folder: &str, largest_error: f64) -> usize {
    let file = path("..").join(folder).join("expected.json");
    let text = std::fs::read_to_string(file).expect("values");
    let entries: Vec<Value> = serde_json::from_str(&text).expect("values");
    let mut wrong = Vec::new();
    for entry in &entries {
        let name = format!("{} {}", entry["file"], entry["grid"]);
        let rays = entry["rays"].as_array().expect("rays");
        let ends = |ray: &Value| [point(&ray["from"]), point(&ray["to"])];
        let linear = read(folder, entry, ends(&rays[0]), "");
        let nearest = read(folder, entry, ends(&rays[0]), "interpolation = \"nearest\"");
        let Bounds::Box(found) = volume(&linear).bounds() else { panic!("a box") };
        for j in 0..3 {
            wrong.extend(differs(&name, found.low.0[j], point(&entry["low"])[j], 1e-13));
            wrong.extend(differs(&name, found.high.0[j], point(&entry["high"])[j], 1e-13));
        }
        for seen in entry["points"].as_array().expect("points") {
            let at = Point(point(&seen["at"]));
            let [linear, nearest] = [&linear, &nearest].map(|body| volume(body).extinction_at(at));
            // Places of up to 40 voxels have a rounding error along three axes, and values up to 2 change by as much
            // per voxel; the library interpolates in single precision, by seven sums and products.
            let single = 14.0 * f64::from(f32::EPSILON);
            for (key, found, most) in
                [("value", linear, 1e-13), ("box", linear, single), ("nearest", nearest, 1e-8)]
            {
                let Some(expected) = seen[key].as_f64() else { continue };
                let off = (found - expected).abs();
                if off > most {
                    wrong.push(format!("{name}: {key} at {at:?} is {off:e} off"));
                }
            }
        }
        for ray in rays {
            let medium = read(folder, entry, ends(ray), "").medium();
            let depth = medium.optical_depth(medium.span());
            let expected = ray["depth"].as_f64().expect("a number");
            wrong.extend(differs(
                &format!("{name}: τ"),
                depth.value,
                expected,
                1e-12 * expected.max(1.0),
            ));
            assert!(depth.error < largest_error * expected.max(1.0), "{name}: {depth:?}");
        }
    }
    none(&wrong);
    entries.len()
}

#[test]
fn all_packings_hold_the_same_values() {
    for (first, others) in [
        ("mixed-blosc", &["mixed-blosc-all", "mixed-zip-mask", "mixed-zip", "mixed-mask"][..]),
        ("half-blosc", &["half-zip-mask", "half-mask"]),
        ("small-blosc", &["small-none"]),
    ] {
        let first = samples(&format!("{first}.vdb"), None).expect("a grid");
        for other in others {
            assert_eq!(first, samples(&format!("{other}.vdb"), None).expect("a grid"), "{other}");
        }
    }
    let [whole, half] =
        ["mixed-blosc.vdb", "half-blosc.vdb"].map(|file| samples(file, None).expect("a grid"));
    assert_ne!(whole, half);
    for (x, half) in whole.values.iter().zip(&half.values) {
        assert!((x - half).abs() <= x / 2048.0, "{x} and {half}");
    }
}

#[test]
fn files_that_are_no_medium_are_refused_with_the_cure() {
    let table: [(&str, Option<&str>, &str, &str); 14] = [
        (
            "several.vdb",
            None,
            "several grids: \"density\", \"shared\", \"velocity\" (\"Tree_vec3s_5_4_3\"), \
          \"mask\" (\"Tree_bool_5_4_3\"), \"heat[0]\", \"heat[1]\"",
            "`grid = ",
        ),
        ("several.vdb", Some("heat"), "no grid \"heat\", but \"density\"", "choose one"),
        ("several.vdb", Some("velocity"), "has the type \"Tree_vec3s_5_4_3\"", "FloatGrid"),
        ("several.vdb", Some("mask"), "has the type \"Tree_bool_5_4_3\"", "FloatGrid"),
        ("mixed-blosc.vdb", Some("smoke"), "no grid \"smoke\", but \"density\"", "choose one"),
        ("empty.vdb", None, "grid is empty", "other than the background"),
        ("nan.vdb", None, "voxel (1, 2, -3) is NaN", "finite and not negative"),
        ("level-set.vdb", None, "is a level set", "sdfToFogVolume"),
        (
            "vast.vdb",
            None,
            "4098 × 4098 × 4098 samples, from index [-1, -1, -1]",
            "openvdb::tools::clip",
        ),
        ("frustum.vdb", None, "frustum", "resample"),
        ("make.py", None, "none of .vol, .npy, .vdb, .nvdb and .pbrt", "convert"),
        ("absent.vdb", None, "No such file", "relative to the case file"),
        ("several.vdb", Some("heat[2]"), "no grid \"heat[2]\"", "choose one"),
        ("several.vdb", Some(""), "no grid \"\"", "choose one"),
    ];
    for (file, grid, words, cure) in table {
        let Unreadable { message, help } = samples(file, grid).expect_err(file);
        assert!(message.contains(words) && help.contains(cure), "{file}: {message}; {help}");
    }
    assert_eq!(samples("several.vdb", Some("heat[1]")).expect("a grid").size, [4; 3]);
}

/// Draws through a grid of the file agree with its exact optical depth.
#[test]
fn the_example_passes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let text = std::fs::read_to_string(folder.join("openvdb.toml")).expect("a case");
    let example = CaseText { name: "openvdb".into(), path: folder.join("openvdb.toml"), text };
    let case = Case::read(&example).unwrap_or_else(|error| panic!("{}", error.render(false)));
    let record = judged(&[case], &options(1, 200_000));
    let rows = record.results.cases[0].rows().collect::<Vec<_>>();
    assert_eq!(rows.len(), 2);
    none(&failing(&rows));
}

#[test]
fn settings_that_the_file_decides_are_refused_in_their_place() {
    let text = "title = \"t\"
        [problem.transmittance]
        volume.grid = { file = \"uniform.vdb\", samples = \"centres\", border = \"zero\", \
          bounds.box = { low = [0, 0, 0], high = [1, 1, 1] } }
        ray = { origin = [0, 0, 0], direction = [1, 0, 0], length = 9 }
        estimators = [{ analog-free-flight = {} }]";
    let mut broken = source("broken", text);
    broken.path = path("broken.toml");
    let error = Case::read(&broken).err().expect("mistakes").render(false);
    for key in ["samples", "border", "bounds"] {
        let words = format!("`{key}` has no say");
        assert!(error.contains(&words) && error.contains("broken.toml:3"), "{error}");
    }
    let absent = mistakes(&text.replace("uniform.vdb", "a.npy\", grid = \"density"));
    assert!(absent.expect("mistakes").render(false).contains("`grid` has no say in .npy"));
}
