//! Grids in files of every format, the output of `plan` and `inspect`, and rays that miss everything.

mod arrays;
mod inspect;
mod nvdb;
mod pbrt;
mod rays;
mod vol;
mod windows;

use std::path::{Path, PathBuf};
use std::process::Output;

use assert_cmd::Command;
use trueflight::media::grid_file::{self, GridChoice, Samples, Unreadable};

/// Returns a file below `tests/data`.
fn data(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(file)
}

/// Reads bytes as a file of a name.
fn written(name: &str, bytes: &[u8], choice: &GridChoice) -> Result<Samples, Unreadable> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("written");
    grid_file::read(&path, choice)
}

/// Asserts that bytes are refused with these words and this cure.
fn refused(name: &str, bytes: &[u8], choice: &GridChoice, words: &str) {
    let Unreadable { message, help } = written(name, bytes, choice).expect_err(words);
    assert!(message.contains(words), "{message}, not {words}");
    assert!(!help.is_empty(), "{words} has no cure");
}

/// Runs the command in a folder.
fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::cargo_bin("trueflight").expect("the binary");
    command.current_dir(folder).env_remove("NO_COLOR").env("COLUMNS", "200");
    command.args(arguments).output().expect("it runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

/// Rotated lattices, and a background that is not 0, against `OpenVDB`'s samplers and rational arithmetic.
#[test]
fn turned_lattices_and_backgrounds_are_those_of_openvdb() {
    // A rotated place is a sum of three products along each axis, with as many roundings.
    assert_eq!(crate::vdb::agrees("grids", 4e-12), 7);
}

#[test]
fn a_background_ends_at_its_box_and_plan_says_so() {
    let samples =
        grid_file::read(&data("grids/filled.vdb"), &GridChoice::default()).expect("a grid");
    assert_eq!(samples.size, [5; 3]);
    assert!(samples.remark.contains("background 0.5 ends at its box"), "{}", samples.remark);
    let bounds = samples.bounds.expect("a box");
    assert_eq!([bounds.low.0, bounds.high.0], [[-1.0; 3], [3.0; 3]]);
    let negative = grid_file::read(&data("grids/negative.vdb"), &GridChoice::default());
    let Unreadable { message, help } = negative.expect_err("negative");
    assert!(message.contains("background is -0.5") && help.contains("not negative"), "{message}");
}

/// Draws through rotated grids agree with the exact transmittance.
#[test]
fn estimators_pass_in_a_turned_grid() {
    let folder = data("grids");
    let read = |file: &str| {
        format!(
            "title = \"t\"
            [problem.transmittance]
            volume.grid = {{ file = \"{0}/{file}\", extinction = 0.5 }}
            ray = {{ origin = [0.46, -0.45, 3.22], direction = [1, 0.2, -0.3], length = 9 }}
            sampling.constant.value = 2
            estimators = [{{ ratio = {{}} }}, {{ woodcock = {{}} }}]",
            folder.display()
        )
    };
    for file in ["turned.vdb", "turned.nvdb", "turned-filled.vdb"] {
        let ray = if file.contains("filled") {
            "origin = [-3, 1, 1], direction = [1, 0.1, 0]"
        } else {
            "origin = [0.46, -0.45, 3.22], direction = [1, 0.2, -0.3]"
        };
        let text =
            read(file).replace("origin = [0.46, -0.45, 3.22], direction = [1, 0.2, -0.3]", ray);
        let rows = crate::common::rows(&text, 200_000);
        let words = crate::common::failing(&rows);
        assert!(rows[0].truth.is_some_and(|truth| truth < 0.95), "{file}: {:?}", rows[0].truth);
        crate::common::none(&words);
    }
}
