//! The manual's page: its programs run, and every function is on it.

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
fn every_function_is_on_the_page() {
    let header = fs::read_to_string(here().join("include/trueflight.h")).expect("a header");
    let page = page();
    let words = header.split(|c: char| !c.is_alphanumeric() && c != '_');
    // A function's name is followed by its arguments.
    let functions: Vec<&str> = words
        .filter(|word| word.starts_with("tf_") && header.contains(&format!("{word}(")))
        .collect();
    assert!(functions.len() > 30, "{functions:?}");
    for function in functions {
        let is_there = [format!("`{function}`"), format!("`{function}(")];
        assert!(is_there.iter().any(|name| page.contains(name)), "{function} is not on the page");
    }
}
