//! Promises of documents: links and addresses that exist, results that are shown, commands and cases that are valid,
//! tables that agree with the catalogue, and error messages that end in a cure.

mod addresses;
mod cures;
mod explain;
mod packages;
mod pages;
mod results;
mod tables;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(name: &str) -> String {
    std::fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Returns all files below a folder of the repository, by their paths in it; without builds and hidden folders.
fn files(below: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![root().join(below)];
    while let Some(folder) = folders.pop() {
        for entry in
            std::fs::read_dir(&folder).expect("a folder").map(|entry| entry.expect("an entry"))
        {
            let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
            let is_built = ["target", "book", "out", "node_modules", "__pycache__", "corpus"]
                .contains(&name.as_str());
            if path.is_dir() && !is_built && (!name.starts_with('.') || name == ".ci") {
                folders.push(path);
            } else if path.is_file() {
                found.push(path.strip_prefix(root()).expect("below the root").to_owned());
            }
        }
    }
    found.sort();
    found
}

/// Returns the pages of the manual and README, by their paths, with their texts.
fn manual() -> Vec<(String, String)> {
    let pages = files("docs").into_iter().chain([
        "README.md".into(),
        "CONTRIBUTING.md".into(),
        "ARCHITECTURE.md".into(),
        "cases/README.md".into(),
    ]);
    let pages = pages.filter(|path| path.extension().is_some_and(|end| end == "md"));
    let names = pages.map(|path| path.to_string_lossy().into_owned());
    names.map(|name| (name.clone(), read(&name))).collect()
}

/// Runs the command, and returns its output.
fn trueflight(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_trueflight"));
    command.env_remove("NO_COLOR").env("COLUMNS", "80").args(arguments).output().expect("it runs")
}

fn stdout(arguments: &[&str]) -> String {
    let output = trueflight(arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "trueflight {}: {said}", arguments.join(" "));
    String::from_utf8(output.stdout).expect("text")
}

/// Page of the catalogue as `trueflight list` prints it.
#[derive(Debug, serde::Deserialize)]
struct Listed {
    part: String,
    name: String,
    summary: String,
}

fn listed() -> Vec<Listed> {
    serde_json::from_str(&stdout(&["list", "--format", "json"])).expect("rows")
}
