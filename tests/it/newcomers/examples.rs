//! Every complete case in README, manual and package pages is run as a newcomer would: it passes, with exit code 0.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::none;
use crate::common::place::Place;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns README, the pages of the manual and those of the bindings.
fn pages() -> Vec<PathBuf> {
    let mut pages = vec![root().join("README.md"), root().join("bindings/python/README.md")];
    let manual = fs::read_dir(root().join("docs")).expect("the manual");
    pages.extend(manual.map(|entry| entry.expect("an entry").path()));
    pages.retain(|page| page.extension().is_some_and(|ending| ending == "md"));
    pages.sort();
    pages
}

/// Returns the blocks of TOML with a table of this name, each with a name of its own.
fn shown(table: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for page in pages() {
        let text = fs::read_to_string(&page).expect("a page");
        let stem = page.file_stem().expect("a name").to_string_lossy().into_owned();
        let blocks = text.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
        for (i, block) in blocks.filter(|block| block.contains(table)).enumerate() {
            found.push((format!("{stem}-{i}"), block.to_owned()));
        }
    }
    found
}

/// Returns a folder with the files that cases name, by the same paths as in the checkout.
fn place() -> Place {
    let place = Place::new(&[]);
    for data in ["tests/data/vdb", "tests/data/field/23-npy-axes"] {
        fs::create_dir_all(place.path().join(data)).expect("a folder");
        for entry in fs::read_dir(root().join(data)).expect("the folder") {
            let from = entry.expect("an entry").path();
            let to = place.path().join(data).join(from.file_name().expect("a name"));
            fs::copy(from, to).expect("a copy");
        }
    }
    place
}

/// Lists the cases that do not end with 0, or have a row that is neither a pass nor declared before the draws.
fn wrong(command: &str, cases: &[(String, String)]) -> Vec<String> {
    let place = place();
    let mut wrong = Vec::new();
    for (name, text) in cases {
        fs::write(place.path().join(format!("{name}.toml")), text).expect("a case");
        let output = place.run(&format!("{command} {name}.toml"));
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        let failed = ["fail ", "inconclusive "].iter().any(|word| said.contains(word));
        if output.status.code() != Some(0) || failed {
            let error = String::from_utf8_lossy(&output.stderr).into_owned();
            wrong.push(format!("{command} {name}: {:?}\n{said}{error}", output.status.code()));
        }
    }
    wrong
}

/// Returns the cases that give a number of draws, and those that do not.
fn cases() -> [Vec<(String, String)>; 2] {
    let cases = shown("[problem.");
    assert!(cases.len() >= 15, "only {} cases are shown", cases.len());
    let (given, open) = cases.into_iter().partition(|(_, text)| text.contains("\ndraws = "));
    [given, open]
}

/// `check` makes a tenth of the draws if a case does not give a number.
#[test]
fn every_case_that_is_shown_passes() {
    let [given, open] = cases();
    none(&wrong("run", &given));
    none(&wrong("check", &open));
}

#[test]
#[ignore = "long: a million draws of each experiment, a minute of two cores"]
fn every_case_that_is_shown_passes_when_it_is_run() {
    none(&wrong("run", &cases()[1]));
}

#[test]
fn every_picture_that_is_shown_is_rendered() {
    let pictures = shown("[picture.");
    assert!(!pictures.is_empty());
    let small = |text: &String| text.replace("size = [128, 128]", "size = [16, 16]");
    let pictures: Vec<_> =
        pictures.iter().map(|(name, text)| (name.clone(), small(text))).collect();
    none(&wrong("render", &pictures));
}

#[test]
fn the_examples_folder_passes() {
    let place = Place::new(&[]);
    let case = root().join("examples/openvdb.toml");
    place.says(0, &format!("run '{}'", case.display()));
}
