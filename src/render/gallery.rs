//! The pictures that are built into the binary, one line each.

use crate::case::Source;
use crate::case::source::BuiltIn;

macro_rules! pictures {
    ($($name:literal,)*) => {
        BuiltIn {
            folder: "pictures/",
            files: &[$(($name, include_str!(concat!("../../pictures/", $name, ".toml")))),*],
        }
    };
}

/// The built-in pictures, in the order of the gallery.
const PICTURES: BuiltIn = pictures![
    "figure-6",
    "figure-7",
    "figure-9",
    "figure-10",
    "figure-12-300",
    "figure-12-50",
    "white-furnace",
    "spectral-noise",
    "spectral-density",
];

/// Every built-in picture, in the order of the gallery.
pub fn gallery() -> Vec<Source> {
    PICTURES.all()
}

/// The built-in picture of a name.
pub fn find(name: &str) -> Option<Source> {
    PICTURES.find(name)
}
