//! The cases that are built into the binary.

use std::path::PathBuf;

use super::source::Source;

/// The name of a case file with its text.
macro_rules! case {
    ($name:literal) => {
        ($name, include_str!(concat!("../../cases/", $name, ".toml")))
    };
}

/// The names of the built-in cases with their text: every estimator, every kind of medium, free
/// flight, a curve, and estimators that must be caught. They draw in well under a minute and read
/// no further files.
const CASES: &[(&str, &str)] = &[
    case!("transmittance/eq21-overview"),
    case!("transmittance/eq21-oblique"),
    case!("transmittance/constant-sampling"),
    case!("transmittance/layers-with-gap"),
    case!("transmittance/ramps"),
    case!("transmittance/exponential"),
    case!("transmittance/gaussian"),
    case!("transmittance/sines"),
    case!("transmittance/noise-4"),
    case!("transmittance/grid-trilinear"),
    case!("transmittance/negative-extinction"),
    case!("transmittance/biased-ray-marching"),
    case!("transmittance/biased-misuse"),
    case!("free-flight/eq21-central"),
    case!("free-flight/layers-with-gap"),
    case!("transmittance-curve/eq21-figure-8"),
];

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
