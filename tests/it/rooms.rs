//! The figures of ARCHITECTURE show the folders and types that there are.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::common::none;

fn read(path: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::read_to_string(root.join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Returns the texts of the figure's elements that have such an attribute.
fn texts<'a>(figure: &'a str, attribute: &str) -> Vec<&'a str> {
    let elements =
        figure.lines().filter(|line| line.starts_with("<text") && line.contains(attribute));
    elements.filter_map(|line| line.split_once('>')?.1.split('<').next()).collect()
}

/// Returns the names of the folders in a folder.
fn folders(path: &str) -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let entries =
        fs::read_dir(root.join(path)).expect("a folder").map(|entry| entry.expect("an entry"));
    let folders = entries.filter(|entry| entry.path().is_dir());
    folders.map(|entry| entry.file_name().into_string().expect("a name")).collect()
}

#[test]
fn the_figure_of_rooms_has_every_folder_of_the_harness_and_every_crate() {
    let figure = read("docs/pictures/rooms.svg");
    let bold = texts(&figure, "font-size=\"15\"");
    let others = texts(&figure, "font-size=\"12\"").into_iter().filter(|text| text.contains(" · "));
    let shown: BTreeSet<String> = bold
        .into_iter()
        .chain(others.flat_map(|text| text.split(" · ")))
        .map(str::to_owned)
        .collect();
    let rooms: BTreeSet<String> =
        [folders("src"), folders("crates")].concat().into_iter().collect();
    assert_eq!(shown, rooms);
}

#[test]
fn the_figure_of_the_way_of_data_has_types_that_are_in_their_files() {
    let figure = read("docs/pictures/walk.svg");
    let (types, files) = (texts(&figure, "class=\"type\""), texts(&figure, "class=\"file\""));
    assert_eq!((types.len(), files.len()), (18, 18));
    let is_there = |name: &str, file: &str| {
        let kinds = ["struct", "enum", "trait"].map(|kind| format!("pub {kind} {name}"));
        let ends = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric());
        read(file)
            .lines()
            .any(|line| kinds.iter().any(|kind| line.strip_prefix(&**kind).is_some_and(ends)))
    };
    let missing = types.iter().zip(&files).filter(|(name, file)| !is_there(name, file));
    let missing: Vec<String> =
        missing.map(|(name, file)| format!("{name} is not in {file}")).collect();
    none(&missing);
}
