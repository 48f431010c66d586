//! The manual's page: its programs run, and every function and key is on it.

use std::fs;

use tempfile::TempDir;

use crate::build::{Link, Program, here};

fn page() -> String {
    fs::read_to_string(here().join("../../docs/c.md")).expect("the page")
}

#[test]
fn programs_of_the_page_run() {
    let (page, folder) = (page(), TempDir::new().expect("a folder"));
    for (fence, ending) in [("```c\n", "c"), ("```cpp\n", "cpp")] {
        let blocks = page.split(fence).skip(1).filter_map(|rest| rest.split("```").next());
        let blocks: Vec<&str> = blocks.collect();
        assert!(!blocks.is_empty(), "no program in {ending}");
        for block in blocks {
            let source = folder.path().join("shown").with_extension(ending);
            fs::write(&source, block).expect("written");
            let source = source.to_str().expect("a path");
            assert_eq!(Program::new(source, Link::Static, &[]).run(), (Some(0), String::new()));
        }
    }
}

#[test]
fn every_function_and_key_is_on_the_page() {
    let header = fs::read_to_string(here().join("include/trueflight.h")).expect("a header");
    let page = page();
    let words = header.split(|c: char| !c.is_alphanumeric() && c != '_');
    // A function's name is followed by its arguments, a key's by its number.
    let (keys, functions): (Vec<&str>, Vec<&str>) = words
        .filter(|word| word.to_lowercase().starts_with("tf_"))
        .filter(|word| !word.starts_with("TF_STATUS_") && !word.starts_with("TF_VERDICT_"))
        .filter(|word| {
            header.contains(&format!("{word}(")) || header.contains(&format!("{word} = "))
        })
        .partition(|word| header.contains(&format!("{word} = ")));
    assert!(functions.len() > 15 && keys.len() > 12, "{functions:?}, {keys:?}");
    for name in functions.into_iter().chain(keys) {
        let is_there = [format!("`{name}`"), format!("`{name}(")];
        assert!(is_there.iter().any(|name| page.contains(name)), "{name} is not on the page");
    }
}
