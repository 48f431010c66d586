//! Rays that miss their volume: every command says so.

use trueflight::plan::Plan;
use trueflight::record::build;

use super::{data, run, text};
use crate::common::{case, mistakes, options};

fn notes(text: &str) -> Vec<String> {
    let cases = [case("test", text)];
    let record = build::planned(&Plan::new(&cases, &options(1, 1000)));
    record.results.cases[0].notes.clone()
}

/// Returns the notes on a ray through a volume, for a problem with some settings.
fn through(problem: &str, volume: &str, ray: &str, settings: &str) -> Vec<String> {
    notes(&format!(
        "title = \"t\"\n[problem.{problem}]\nvolume = {volume}\nray = {{ {ray} }}\n{settings}"
    ))
}

const CUBE: &str =
    "{ constant = { extinction = 1, bounds.box = { low = [0, 0, 0], high = [1, 1, 1] } } }";
const GRID: &str =
    "{ grid = { random.size = [4, 4, 4], bounds.box = { low = [0, 0, 0], high = [1, 1, 1] } } }";
const BALL: &str =
    "{ constant = { extinction = 1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } } }";
const ALONG: &str = "estimators = [{ closed-form = {} }]";

#[test]
fn a_ray_that_misses_is_told_with_the_box_and_the_cure() {
    for volume in [CUBE, GRID] {
        let told = |ray: &str| through("transmittance", volume, ray, ALONG);
        let place = "the ray meets nothing of the volume, whose box is [0, 0, 0] to [1, 1, 1]: it ";
        assert_eq!(
            told("origin = [-5, 0.5, 0.5], direction = [1, 0, 0], length = 4"),
            [format!("{place}ends at 4, before the volume begins at 5; make `length` larger")]
        );
        assert_eq!(
            told("origin = [-5, 0.5, 0.5], direction = [-2, 0, 0], length = 40"),
            [format!("{place}points away from it; turn `direction` about, or move `origin`")]
        );
        assert_eq!(
            told("origin = [-5, 1.5, 0.5], direction = [1, 0, 0], length = 40"),
            [format!("{place}passes beside it; move `origin`, or turn `direction`")]
        );
        assert!(told("origin = [-5, 0.5, 0.5], direction = [1, 0, 0], length = 40").is_empty());
        assert!(told("origin = [0.5, 0.5, 0.5], direction = [1, 0, 0], length = 0.1").is_empty());
    }
    let ball = through(
        "transmittance",
        BALL,
        "origin = [-5, 2, 0], direction = [1, 0, 0], length = 40",
        ALONG,
    );
    assert!(ball[0].contains("whose ball has the radius 1 about [0, 0, 0]"), "{ball:?}");
}

#[test]
fn a_ray_through_nothing_but_zeros_is_told() {
    let told = notes(
        "title = \"t\"\n[problem.transmittance]\nvolume.constant = { extinction = 0, bounds.box = { low = [0, 0, 0], high = [1, 1, 1] } }\n\
         ray = { origin = [-1, 0.5, 0.5], direction = [1, 0, 0], length = 9 }\nestimators = [{ closed-form = {} }]",
    );
    assert_eq!(
        told,
        [
            "the ray meets nothing of the volume, whose box is [0, 0, 0] to [1, 1, 1]: it is in there from 1 to 2, and \
          σ_t is 0 along the whole ray"
        ]
    );
    let ray = "origin = [0, 0, 0], direction = [1, 0, 0], length = 0";
    let none = through("transmittance", CUBE, ray, ALONG);
    assert_eq!(none, ["the ray has the length 0, and meets nothing of the volume"]);
    let line = notes(
        "title = \"t\"\n[problem.transmittance]\nmedium.constant.extinction = 0\nspan = [0, 1]\nestimators = [{ closed-form = {} }]",
    );
    assert_eq!(line, ["σ_t is 0 along the whole span"]);
}

/// Each problem that sends a ray through a volume.
#[test]
fn every_problem_with_a_ray_tells() {
    let beside = "origin = [-5, 3, 0.5], direction = [1, 0, 0], length = 40";
    let sampling = "sampling.constant.value = 2\n";
    let list = |volume: &str| format!("[{volume}, {volume}]");
    for (problem, volume, settings) in [
        ("free-flight", CUBE.to_owned(), ALONG.replace("closed-form", "inversion")),
        ("transmittance", CUBE.to_owned(), "distances = 2\nsampling.constant.value = 2\nestimators = [{ double = {} }]".to_owned()),
        ("transmittance", list(CUBE), format!("{sampling}estimators = [{{ spectral-mis = {{}} }}]")),
        ("single-scattering", CUBE.to_owned(), "light = { position = [0.5, 0.5, 3], power = 1 }\nalbedo = 0.5\nphase.isotropic = {}\nsampling.constant.value = 2\nestimators = [{ delta-tracking = {} }]".to_owned()),
    ] {
        let told = std::panic::catch_unwind(|| through(problem, &volume, beside, &settings));
        let told = told.unwrap_or_else(|_| panic!("{problem} is not read"));
        assert_eq!(told.len(), 1, "{problem}: {told:?}");
        assert!(told[0].starts_with("the ray meets nothing of the volume, whose box is"), "{problem}: {told:?}");
    }
}

/// The case of the field, from the command line to every report.
#[test]
fn the_ray_of_the_field_is_told_by_every_command() {
    let there = tempfile::tempdir().expect("a folder");
    for file in ["miss.toml", "torus.vdb"] {
        std::fs::copy(data("field/31-ray-misses").join(file), there.path().join(file))
            .expect("copied");
    }
    let words = "the ray meets nothing of the volume, whose box is [";
    for arguments in [
        &["plan", "miss.toml"][..],
        &["predict", "miss.toml"],
        &["run", "miss.toml", "--draws", "1000", "--out", "results"],
        &["check", "miss.toml", "--junit", "j.xml", "--markdown", "m.md", "--out", "o"],
    ] {
        let output = run(there.path(), arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
        assert!(text(&output.stdout).contains(words), "{arguments:?}: {}", text(&output.stdout));
    }
    for file in [
        "results/summary.csv",
        "results/record.json",
        "results/report.html",
        "j.xml",
        "m.md",
        "o/summary.csv",
        "o/record.json",
        "o/report.html",
    ] {
        let text = std::fs::read_to_string(there.path().join(file)).expect(file);
        let plain = text.replace("\\[", "[").replace("\\_", "_");
        assert!(plain.contains(words), "{file}");
    }
}

/// Furnaces refuse such a ray, and follow one that is too short to the end of the volume.
#[test]
fn furnaces_refuse_a_ray_beside_their_volume() {
    let text = |origin: &str| {
        format!(
            "title = \"t\"\n[problem.furnace]\nvolume = {CUBE}\nray = {{ origin = {origin}, direction = [1, 0, 0], length = 1 }}\n\
             albedo = 0.5\nphase.isotropic = {{}}\nsampling.constant.value = 2\nestimators = [{{ particle = {{ rule = \"analog\" }} }}]"
        )
    };
    let error = mistakes(&text("[-5, 3, 0.5]")).expect("a mistake").render(false);
    assert!(
        error.contains("the ray misses the volume, whose box is [0, 0, 0] to [1, 1, 1]"),
        "{error}"
    );
    assert!(notes(&text("[-5, 0.5, 0.5]")).is_empty());
}

/// Two of the shipped cases have rays that miss everything; all others have no notes.
#[test]
fn two_shipped_cases_have_a_note() {
    let cases = crate::common::shipped();
    let noted = cases.iter().filter(|case| !case.scenario.notes().is_empty());
    let names: Vec<&str> = noted.map(|case| case.name.as_str()).collect();
    assert_eq!(names, ["transmittance/eq21-missing", "transmittance/eq21-zero-length"]);
}
