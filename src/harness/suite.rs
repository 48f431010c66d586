//! The cases that are built into the binary.

use std::path::PathBuf;

use super::source::Source;

/// The names of the built-in cases with their text.
const CASES: &[(&str, &str)] = &[];

/// Every built-in case, in the order of the suite.
#[must_use]
pub fn suite() -> Vec<Source> {
    CASES.iter().map(|&(name, text)| source(name, text)).collect()
}

/// The built-in case of a name.
#[must_use]
pub fn find(name: &str) -> Option<Source> {
    CASES.iter().find(|case| case.0 == name).map(|&(name, text)| source(name, text))
}

fn source(name: &str, text: &str) -> Source {
    Source {
        name: name.to_owned(),
        path: PathBuf::from(format!("{name}.toml")),
        text: text.to_owned(),
    }
}
