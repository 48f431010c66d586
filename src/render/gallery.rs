//! The pictures that are built into the binary, one line each.

use std::path::PathBuf;

use crate::harness::Source;

macro_rules! pictures {
    ($($name:literal,)*) => {
        &[$(($name, include_str!(concat!("../../pictures/", $name, ".toml")))),*]
    };
}

/// The names of the built-in pictures with their text.
const PICTURES: &[(&str, &str)] = pictures![
    "figure-6",
    "figure-7",
    "figure-9",
    "figure-10",
    "figure-12-300",
    "figure-12-50",
    "white-furnace",
];

/// Every built-in picture, in the order of the gallery.
#[must_use]
pub fn gallery() -> Vec<Source> {
    PICTURES.iter().map(|&(name, text)| source(name, text)).collect()
}

/// The built-in picture of a name.
#[must_use]
pub fn find(name: &str) -> Option<Source> {
    PICTURES.iter().find(|picture| picture.0 == name).map(|&(name, text)| source(name, text))
}

fn source(name: &str, text: &str) -> Source {
    let path = PathBuf::from(format!("pictures/{name}.toml"));
    Source { name: name.to_owned(), path, text: text.to_owned() }
}
