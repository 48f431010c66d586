//! Media and estimators of a program's own: the examples, and what is said when they are wrong.

use std::path::Path;

use trueflight::catalogue::{Addition, Page, Settings};
use trueflight::geometry::{Aabb, Bounds, Point};
use trueflight::harness::record::Verdict;
use trueflight::media::own::{Formula, SpaceFormula};
use trueflight::{Catalogue, cli};

use super::common::{judged, options, source};

#[path = "../../examples/own_medium.rs"]
mod own_medium;

#[path = "../../examples/own_binary/main.rs"]
#[allow(dead_code)] // its `main` takes the arguments of the process
mod own_binary;

#[test]
fn the_example_of_a_medium_passes() {
    own_medium::main();
}

fn of_the_example() -> Catalogue {
    own_binary::catalogue().expect("names that are free")
}

/// Runs a command of the example's program.
fn command(words: &[&str]) -> std::process::ExitCode {
    let words = ["own_binary", "--quiet"].iter().chain(words);
    cli::run_as(&of_the_example(), words).expect("arguments")
}

const CASE: &str = "examples/own_binary/two-rays.toml";

#[test]
fn the_example_of_a_program_draws_judges_and_plots() {
    let out = tempfile::tempdir().expect("a folder");
    let path = out.path().join("run");
    let folder = path.to_str().expect("a name");
    let code = command(&["run", CASE, "--out", folder, "--alpha", "1e-6"]);
    assert_eq!(format!("{code:?}"), format!("{:?}", std::process::ExitCode::SUCCESS));
    let csv = std::fs::read_to_string(path.join("summary.csv")).expect("a summary");
    let rows = csv.lines().filter(|line| line.contains(",haze,two-rays,")).count();
    assert_eq!(rows, 5, "{csv}");
    let files = walk(&path);
    assert!(files.iter().any(|file| file.contains(".png")), "{files:?}");
    let code = command(&["bench", CASE, "--rounds", "1", "--out", folder]);
    assert_eq!(format!("{code:?}"), format!("{:?}", std::process::ExitCode::SUCCESS));
}

fn walk(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("one"));
    let below = |path: std::path::PathBuf| {
        if path.is_dir() { walk(&path) } else { vec![path.display().to_string()] }
    };
    entries.flat_map(|entry| below(entry.path())).collect()
}

#[test]
fn what_an_own_medium_hides_is_found() {
    // The estimators of the catalogue in a medium of closures, against its truth by quadrature.
    let haze = Page { module: "haze", source: "Haze." };
    let bumpy = |t: f64| 0.5 + 0.5 * (3.0 * t).sin() + f64::from(t > 1.0);
    let line = move |_: &Settings| Some(Formula::new(bumpy).with_breaks(vec![1.0]));
    let corner = Page { module: "corner", source: "A corner." };
    let bounds = Bounds::Box(Aabb { low: Point([0.0; 3]), high: Point([1.0; 3]) });
    let space = move |_: &Settings| Some(SpaceFormula::new(bounds, 3.0, |[x, y, z]| x + y * z));
    let catalogue = Catalogue::builtin()
        .with(Addition::line(haze, line))
        .and_then(|catalogue| catalogue.with(Addition::volume(corner, space)))
        .expect("names that are free");
    let text = |problem: &str| format!("title = \"own\"\n{problem}");
    let line = text(
        r#"[problem.transmittance]
        medium.haze = {}
        span = [0, 3]
        sampling.constant.value = 2.0
        estimators = [{ woodcock = {} }, { ratio = {} }, { closed-form = {} },
            { ratio = { kernel = "order-free" } }, { next-flight = {} }]"#,
    );
    let space = text(
        r"[problem.transmittance]
        volume.corner = {}
        ray = { origin = [0.1, 0.2, -1], direction = [0.1, 0.2, 1], length = 4 }
        sampling.constant.value = 2.0
        estimators = [{ woodcock = {} }, { ratio = {} }, { closed-form = {} }]",
    );
    let ball = text(
        r#"[problem.furnace]
        volume.corner = {}
        ray = { origin = [0.1, 0.2, -1], direction = [0.1, 0.2, 1], length = 4 }
        albedo.constant.extinction = 0.7
        phase.isotropic = {}
        sampling.constant.value = 3.0
        estimators = [{ particle = { rule = "weighted" } }]"#,
    );
    for (name, text) in [("line", line), ("space", space), ("ball", ball)] {
        let case = catalogue.read(&source(name, &text));
        let case = case.unwrap_or_else(|error| panic!("{}", error.in_full()));
        let record = judged(&[case], &options(3, 1_000_000));
        for row in &record.results.cases[0].rows {
            assert_eq!(
                row.verdict,
                Some(Verdict::Pass),
                "{name} {}: {}",
                row.estimator,
                row.reason
            );
        }
    }
    // τ of the line by hand: ½·3 + ⅙(1 − cos 9) + 2.
    let depth = 3.5 + (1.0 - 9.0_f64.cos()) / 6.0;
    let found = trueflight::media::OpticalDepth::optical_depth(
        &Formula::new(bumpy).with_breaks(vec![1.0]),
        trueflight::numeric::Span::new(0.0, 3.0),
    );
    assert!((found.value - depth).abs() <= found.error.max(1e-15), "{found:?} {depth}");
    assert!(found.error < 1e-12, "{found:?}");
}

#[test]
fn names_are_taken_once() {
    let page = |module| Page { module, source: "Mine." };
    let add = |page| Addition::line(page, |_| Some(Formula::new(|_| 1.0)));
    let taken = Catalogue::builtin().with(add(page("constant"))).expect_err("a name taken");
    assert_eq!(
        taken.to_string(),
        "`constant` is the name of another page (media); choose another name"
    );
    let once = Catalogue::builtin().with(add(page("mine"))).expect("a free name");
    assert!(once.with(add(page("mine"))).is_err());
}

#[test]
fn wrong_cases_of_own_pages_are_shown_in_place() {
    let wrong = |from: &str, to: &str| {
        let text = std::fs::read_to_string(CASE).expect("the case").replace(from, to);
        let error = of_the_example().read(&source("wrong", &text)).err().expect("a mistake");
        error.in_full()
    };
    let found = wrong("medium.haze = {}", "medium.hase = {}");
    assert!(found.contains("did you mean `haze`?"), "{found}");
    let found = wrong("medium.haze = {}", "medium.haze = { scale = 1 }");
    assert!(found.contains("`scale` is not known here"), "{found}");
    let found = wrong("two-rays = {}", "two-ray = {}");
    assert!(found.contains("did you mean `two-rays`?"), "{found}");
    let volume =
        "volume.haze = {}\nray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 4 }";
    let found = wrong("medium.haze = {}\nspan = [0, 4]", volume);
    assert!(found.contains("no 3-D form"), "{found}");
}
