//! `results/` has the files that documents show and the recorded numbers, and is small.

use std::collections::BTreeSet;

use super::{manual, read, root};
use crate::common::none;

/// Limit in bytes, those of folders included as `du -sb` counts them.
const LIMIT: u64 = 4_000_000;
const FOLDER: u64 = 4096;

/// Returns the files that are kept, as `results/.gitignore` lists them.
fn kept() -> BTreeSet<String> {
    let ignored = read("results/.gitignore");
    let names = ignored.lines().filter_map(|line| line.strip_prefix("!/"));
    names.map(str::to_owned).collect()
}

#[test]
fn results_are_small() {
    let (mut bytes, mut folders) = (0, BTreeSet::from([String::new()]));
    for name in kept() {
        let path = root().join("results").join(&name);
        bytes += std::fs::metadata(&path).unwrap_or_else(|error| panic!("{name}: {error}")).len();
        let parts: Vec<&str> = name.split('/').collect();
        folders.extend((1..parts.len()).map(|depth| parts[..depth].join("/")));
    }
    let total = bytes + FOLDER * folders.len() as u64;
    assert!(total <= LIMIT, "results/ has {total} bytes, of at most {LIMIT}");
}

#[test]
fn nothing_else_is_in_the_repository() {
    let mut git = std::process::Command::new("git");
    let output = git.current_dir(root()).args(["ls-files", "-z", "results"]).output();
    // Sources without a history cannot be compared.
    let Some(output) =
        output.ok().filter(|output| output.status.success() && !output.stdout.is_empty())
    else {
        return;
    };
    let text = String::from_utf8(output.stdout).expect("names");
    let names = text.split('\0').filter_map(|name| name.strip_prefix("results/"));
    let tracked: BTreeSet<String> = names.map(str::to_owned).collect();
    assert_eq!(tracked, kept());
}

#[test]
fn every_result_is_shown_or_named() {
    let notes = read("results/README.md");
    let pages = manual();
    let is_named = |name: &str| {
        let file = name.rsplit('/').next().unwrap_or(name);
        let folder = name.rsplit_once('/').map_or("", |(folder, _)| folder);
        let by_star = notes.contains("three-rules-a*.csv") && file.starts_with("three-rules-a");
        let by_folder = ["bench", "stress", "bench/transmittance"].contains(&folder);
        notes.contains(file) || by_star || by_folder
    };
    let is_linked =
        |name: &str| pages.iter().any(|(_, text)| text.contains(&format!("results/{name}")));
    let kept = kept();
    let own = ["README.md", ".gitignore"];
    let wrong = kept
        .iter()
        .filter(|name| !own.contains(&name.as_str()) && !is_named(name) && !is_linked(name));
    none(&wrong.cloned().collect::<Vec<_>>());
    // A plot is stored in one format only.
    let plots = kept.iter().filter_map(|name| name.strip_suffix(".svg"));
    let twins = plots.filter(|plot| kept.contains(&format!("{plot}.png")));
    none(&twins.map(str::to_owned).collect::<Vec<_>>());
    // Files that notes and pages name by path exist.
    for (page, text) in &pages {
        for name in text.split("../results/").skip(1) {
            let name = name.split([')', ']', '`', ' ', '\n']).next().unwrap_or_default();
            let is_there = kept.contains(name)
                || kept.iter().any(|own| own.starts_with(name.trim_end_matches('/')));
            assert!(is_there, "{page} names results/{name}");
        }
    }
}
