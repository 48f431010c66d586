//! Packages of crates: one version everywhere and beside the path of every dependency, licences, and no more than what
//! the build reads.

use super::{files, read, root};
use crate::common::none;

const VERSION: &str = env!("CARGO_PKG_VERSION");

fn manifest(path: &str) -> toml::Table {
    read(path).parse().unwrap_or_else(|error| panic!("{path}: {error}"))
}

#[test]
fn the_version_is_the_same_everywhere() {
    let named = [
        ("CHANGELOG.md", format!("## {VERSION}")),
        ("CITATION.cff", format!("\nversion: {VERSION}\n")),
        ("bindings/c/CMakeLists.txt", format!("VERSION {VERSION} ")),
        ("docs/install.md", format!("trueflight-{VERSION}-x86_64-linux.tar.gz")),
    ];
    let mut wrong: Vec<String> = named
        .iter()
        .filter(|(page, text)| !read(page).contains(text))
        .map(|(page, text)| format!("{page}: no {text:?}"))
        .collect();
    let manifests = files("bindings").into_iter().filter(|path| path.ends_with("Cargo.toml"));
    let mut count = 0;
    for path in manifests.map(|path| path.to_string_lossy().into_owned()) {
        count += 1;
        if manifest(&path)["package"]["version"].as_str() != Some(VERSION) {
            wrong.push(format!("{path}: another version"));
        }
    }
    none(&wrong);
    assert!(count >= 4, "only {count} manifests were read");
}

#[test]
fn packages_list_their_files_and_hold_both_licences() {
    let (mut wrong, mut count) = (Vec::new(), 0);
    for path in files("crates").into_iter().filter(|path| path.ends_with("Cargo.toml")) {
        count += 1;
        let name = path.to_string_lossy().into_owned();
        if manifest(&name)["package"].get("include").is_none() {
            wrong.push(format!("{name}: no `include`"));
        }
        let missing = ["LICENSE-MIT", "LICENSE-APACHE"].into_iter();
        let missing = missing.filter(|file| !root().join(&path).with_file_name(file).is_file());
        wrong.extend(missing.map(|file| format!("{name}: no {file} beside it")));
    }
    none(&wrong);
    assert!(count >= 6, "only {count} manifests were read");
}

/// A dependency without a version is only left out of a package where it is one of tests.
#[test]
fn dependencies_by_path_have_the_version() {
    let workspace = manifest("Cargo.toml");
    let shared = workspace["workspace"]["dependencies"].as_table().expect("dependencies");
    let (mut wrong, mut count) = (Vec::new(), 0);
    let crates = files("crates").into_iter().map(|path| path.to_string_lossy().into_owned());
    for path in crates.filter(|path| path.ends_with("Cargo.toml")).chain(["Cargo.toml".into()]) {
        let manifest = manifest(&path);
        let Some(own) = manifest.get("dependencies").and_then(toml::Value::as_table) else {
            continue;
        };
        for (name, dependency) in own {
            let is_shared = dependency.get("workspace").is_some();
            let dependency = if is_shared { &shared[name] } else { dependency };
            if dependency.get("path").is_none() {
                continue;
            }
            count += 1;
            if dependency.get("version").and_then(toml::Value::as_str) != Some(VERSION) {
                wrong.push(format!("{path}: {name} has no version {VERSION} beside its path"));
            }
        }
    }
    none(&wrong);
    assert!(count >= 10, "only {count} dependencies were read");
}
