//! README and manual: every link leads somewhere, every page is in the table of contents, every case file shown
//! can be read, and every command shown is one.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{none, source};
use trueflight::case::Case;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// README, CONTRIBUTING, ARCHITECTURE and the pages of the manual, with their texts.
fn pages() -> Vec<(PathBuf, String)> {
    let mut paths: Vec<PathBuf> =
        ["README.md", "CONTRIBUTING.md", "ARCHITECTURE.md"].map(|name| root().join(name)).into();
    let manual = fs::read_dir(root().join("docs")).expect("the manual");
    paths.extend(manual.map(|entry| entry.expect("an entry").path()));
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "md"));
    paths.sort();
    let read = |path: PathBuf| (path.clone(), fs::read_to_string(path).expect("a page"));
    paths.into_iter().map(read).collect()
}

/// The contents of the blocks in a language.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    let from_fence = text.split(fence.as_str()).skip(1);
    from_fence.filter_map(|rest| rest.split("```").next()).collect()
}

#[test]
fn every_link_leads_somewhere() {
    let mut wrong = Vec::new();
    for (path, text) in pages() {
        for target in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = target.split('#').next().unwrap_or_default();
            let is_here = !file.is_empty() && !file.contains("://") && !file.contains(' ');
            if is_here && !path.parent().expect("a folder").join(file).exists() {
                wrong.push(format!("{}: {target}", path.display()));
            }
        }
    }
    none(&wrong);
}

#[test]
fn every_page_is_in_the_table_of_contents() {
    let contents = fs::read_to_string(root().join("docs/SUMMARY.md")).expect("a summary");
    let mut wrong = Vec::new();
    for (path, _) in pages().iter().filter(|(path, _)| path.parent() != Some(root())) {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        if name != "SUMMARY.md" && !contents.contains(&format!("({name})")) {
            wrong.push(name);
        }
    }
    none(&wrong);
}

#[test]
fn the_first_page_is_short() {
    let lines = |name: &str| fs::read_to_string(root().join(name)).expect("read").lines().count();
    assert!(lines("README.md") <= 250 && lines("ARCHITECTURE.md") <= 150);
}

#[test]
fn every_case_file_shown_can_be_read() {
    let (mut wrong, mut read) = (Vec::new(), 0);
    for (path, text) in pages() {
        for block in blocks(&text, "toml").into_iter().filter(|block| block.contains("[problem.")) {
            read += 1;
            if let Err(error) = Case::read(&source("shown", block)) {
                wrong.push(format!("{}: {}", path.display(), error.render(false)));
            }
        }
    }
    none(&wrong);
    assert!(read >= 5, "only {read} cases are shown");
}

/// With `--help` at its end a command is parsed, and does nothing else.
#[test]
fn every_command_shown_is_one() {
    let (mut wrong, mut parsed) = (Vec::new(), 0);
    for (path, text) in pages() {
        for line in blocks(&text, "console").into_iter().flat_map(str::lines) {
            let Some((_, command)) = line.split_once("trueflight ") else { continue };
            let command = command.split(['#', '|', ';']).next().unwrap_or_default();
            if !line.starts_with('$') || line.contains("cargo install") {
                continue;
            }
            let arguments = command.split_whitespace().map(|word| word.trim_matches(['"', '\'']));
            let mut trueflight = Command::new(env!("CARGO_BIN_EXE_trueflight"));
            let output = trueflight.args(arguments).arg("--help").output().expect("it runs");
            parsed += 1;
            if !output.status.success() {
                let error = String::from_utf8_lossy(&output.stderr).into_owned();
                wrong.push(format!("{}: {line}: {error}", path.display()));
            }
        }
    }
    none(&wrong);
    assert!(parsed >= 15, "only {parsed} commands are shown");
}
