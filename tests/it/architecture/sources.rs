//! The sources, read as text.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A file of the repository.
pub struct File {
    /// The path below the folder.
    pub path: PathBuf,
    pub text: String,
}

impl File {
    /// Every file of the crate.
    pub fn all() -> Vec<Self> {
        let files = Self::below("src");
        assert!(files.len() > 50, "the sources were not found");
        files
    }

    /// Every file below a folder of the repository.
    pub fn below(folder: &str) -> Vec<Self> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        let mut files = Vec::new();
        let mut folders = vec![root.clone()];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(&folder).expect("a folder") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|extension| extension == "rs") {
                    let text = std::fs::read_to_string(&path).expect("a text");
                    let path = path.strip_prefix(&root).expect("below it").to_owned();
                    files.push(Self { path, text });
                }
            }
        }
        files.sort_by(|a, b| a.path.cmp(&b.path));
        assert!(!files.is_empty(), "nothing is in {folder}");
        files
    }

    pub fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// The top-level module.
    pub fn module(&self) -> String {
        let first = self.path.components().next().expect("a component").as_os_str();
        first.to_string_lossy().trim_end_matches(".rs").to_owned()
    }

    /// How many `super` lead from the file's module to the crate's root.
    pub fn depth(&self) -> usize {
        let names = self.path.components().count();
        if self.path.ends_with("mod.rs") { names - 1 } else { names }
    }
}

/// Identifiers, `::` and single marks; comments and texts in quotes are left out.
pub fn tokens(text: &str) -> Vec<String> {
    let mut tokens = Vec::new();
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '/' if chars.peek() == Some(&'/') => {
                chars.by_ref().take_while(|&c| c != '\n').for_each(drop);
            }
            '"' => {
                while let Some(c) = chars.next() {
                    match c {
                        '\\' => drop(chars.next()),
                        '"' => break,
                        _ => {}
                    }
                }
            }
            ':' if chars.peek() == Some(&':') => {
                chars.next();
                tokens.push("::".into());
            }
            c if c.is_alphanumeric() || c == '_' => {
                let mut word = String::from(c);
                while let Some(&c) = chars.peek().filter(|c| c.is_alphanumeric() || **c == '_') {
                    word.push(c);
                    chars.next();
                }
                tokens.push(word);
            }
            c if c.is_whitespace() => {}
            c => tokens.push(c.into()),
        }
    }
    tokens
}

/// The first names of a path's continuation: one, or those between braces. Macros are no modules.
pub fn heads(tokens: &[String]) -> Vec<String> {
    if tokens.first().is_some_and(|token| token == "{") {
        let mut depth = 0;
        let mut heads = Vec::new();
        for (i, token) in tokens.iter().enumerate() {
            match token.as_str() {
                "{" => depth += 1,
                "}" => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                break;
            }
            if depth == 1 && (token == "{" || token == ",") {
                heads.extend(tokens.get(i + 1).filter(|next| *next != "}").cloned());
            }
        }
        return heads;
    }
    let is_macro = tokens.get(1).is_some_and(|token| token == "!");
    tokens.first().filter(|_| !is_macro).cloned().into_iter().collect()
}

/// The top-level modules that a file names.
pub fn used(file: &File) -> BTreeSet<String> {
    let tokens = tokens(&file.text);
    let is = |i: usize, word: &str| tokens.get(i).is_some_and(|token| token == word);
    let mut used = BTreeSet::new();
    let mut i = 0;
    while i < tokens.len() {
        let follows = !(i > 0 && is(i - 1, "::"));
        let from_root = is(i, "crate") || is(i, "trueflight");
        if follows && from_root && is(i + 1, "::") {
            used.extend(heads(&tokens[i + 2..]));
        }
        let mut supers = 0;
        while is(i + 2 * supers, "super") && is(i + 2 * supers + 1, "::") {
            supers += 1;
        }
        if supers > 0 && supers == file.depth() {
            used.extend(heads(&tokens[i + 2 * supers..]));
        }
        i += 1 + 2 * supers;
    }
    used
}

/// The part of a file before its unit tests.
pub fn product(file: &File) -> File {
    let end = file.text.find("#[cfg(test)]").unwrap_or(file.text.len());
    File { path: file.path.clone(), text: file.text[..end].to_owned() }
}

#[test]
fn the_reader_of_edges_sees_every_way_to_write_one() {
    let file = |text: &str| File { path: "theory/a.rs".into(), text: text.into() };
    let modules = |text: &str| used(&file(text)).into_iter().collect::<Vec<_>>().join(" ");
    assert_eq!(modules("use crate::media::Medium;"), "media");
    assert_eq!(
        modules("use crate::{media::{self, Body}, rng, stats::{Tally}};"),
        "media rng stats"
    );
    assert_eq!(modules("fn f() { crate::harness::run::draw() }"), "harness");
    assert_eq!(modules("$crate::rng::Stream"), "rng");
    assert_eq!(modules("use super::super::report;"), "report");
    assert_eq!(modules("use super::mesh; // crate::media"), "");
    assert_eq!(modules("\"crate::media\"; crate::page!(mesh)"), "");
}
