//! Cases that cannot be exported, and the messages.

use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use trueflight::export::Target;

use super::scene;

/// Runs `trueflight export` in a folder.
fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::cargo_bin("trueflight").expect("the binary");
    command.current_dir(folder).arg("export").args(arguments).output().expect("it runs")
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("text")
}

#[test]
fn cases_that_no_renderer_can_show_are_refused_with_a_cure() {
    let cases = [
        ("rod/known-bugs", Target::Mitsuba, "asks"),
        ("slab/known-bugs-diffuse", Target::Mitsuba, "incidence.collimated"),
        ("ball/albedos", Target::Mitsuba, "all directions"),
        ("slab/known-bugs", Target::Pbrt, "0.9999"),
        ("furnace/known-bugs", Target::Pbrt, "Rayleigh"),
        ("single-scattering/homogeneous", Target::Mitsuba, "bounds.box"),
        ("ball/environment", Target::Mitsuba, "ball/black-light"),
        ("ball/escape", Target::Mitsuba, "all directions"),
        ("transmittance/eq21-missing", Target::Mitsuba, "misses"),
        ("rod/spectral-albedos", Target::Mitsuba, "one channel or several"),
    ];
    for (case, target, words) in cases {
        let Err(error) = scene(case, target, None) else { panic!("{case} was exported") };
        let error = error.to_string();
        assert!(error.contains(case) && error.contains(words), "{case}: {error}");
    }
}

#[test]
fn what_varies_or_is_no_number_of_single_precision_is_no_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "title = \"a sweep\"\n[problem.transmittance]\nmedium.constant.extinction = 1\nspan = [0, 1]\n\
                sampling.constant.value = 1\nestimators = [{ woodcock = {} }]\n";
    std::fs::write(folder.path().join("one.toml"), text).expect("a file");
    let swept = format!("{text}sweep.density.values = [1, 2]\n");
    std::fs::write(folder.path().join("swept.toml"), swept).expect("a file");
    let export = |case| run(folder.path(), &[case, "--to", "mitsuba", "--out", "scene"]);
    let output = export("swept.toml");
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("leave `sweep` out"), "{}", stderr(&output));
    let large = text.replace("extinction = 1", "extinction = 1e39").replace("[0, 1]", "[0, 1e-38]");
    std::fs::write(folder.path().join("large.toml"), large).expect("a file");
    let output = export("large.toml");
    assert!(stderr(&output).contains("single precision"), "{}", stderr(&output));
    let thick = text.replace("extinction = 1", "extinction = 400");
    std::fs::write(folder.path().join("thick.toml"), thick).expect("a file");
    let output = export("thick.toml");
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("needs τ ≤ 300"), "{}", stderr(&output));
    assert!(!folder.path().join("scene").exists(), "a folder is left");
    assert_eq!(export("one.toml").status.code(), Some(0));
}

#[test]
fn nothing_is_left_where_nothing_can_be_exported() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = run(folder.path(), &["rod/known-bugs", "--to", "mitsuba", "--out", "scene"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).starts_with("error: rod/known-bugs cannot be exported to mitsuba"));
    assert!(!folder.path().join("scene").exists());
}

#[test]
fn cases_that_are_not_there_and_folders_that_cannot_be_written_are_errors() {
    let folder = tempfile::tempdir().expect("a folder");
    let told = |arguments: &[&str], words: &str| {
        let output = run(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(words), "{}", stderr(&output));
    };
    told(
        &["nowhere", "--to", "mitsuba", "--out", "scene"],
        "nowhere: there is no such file, folder or built-in case",
    );
    std::fs::write(folder.path().join("bad.toml"), "title = 3\n").expect("a file");
    told(&["bad.toml", "--to", "pbrt", "--out", "scene"], "bad.toml");
    assert!(!folder.path().join("scene").exists());
    let good = "transmittance/eq21-overview";
    std::fs::write(folder.path().join("file"), "in the way").expect("a file");
    told(&[good, "--to", "mitsuba", "--out", "file"], "give another folder with --out");
    told(&[good, "--to", "mitsuba", "--out", "file/below"], "give another folder with --out");
    told(&[good, "--to", "cycles", "--out", "scene"], "mitsuba");
    told(&[good, "--to", "mitsuba"], "--out");
    told(&[good, "--to", "mitsuba", "--out", "scene", "--cells", "1"], "--cells");
    // A folder is in the place of a file: nothing is moved.
    std::fs::create_dir_all(folder.path().join("half/truth.json")).expect("a folder");
    told(&[good, "--to", "mitsuba", "--out", "half"], "truth.json");
    assert_eq!(std::fs::read_dir(folder.path().join("half")).expect("a folder").count(), 1);
}

#[test]
fn an_export_tells_what_its_pixels_must_be() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = ["furnace/eq21", "--to", "mitsuba", "--out", "scene", "--cells", "8"];
    let output = run(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let told = String::from_utf8(output.stdout).expect("text");
    assert!(
        told.contains("radiance.xml: radiance 1 ±") && told.contains("4 files in scene"),
        "{told}"
    );
    assert!(told.contains("note: the medium is white"), "{told}");
}
