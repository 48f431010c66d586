//! The cases that are built into the binary: a choice of those under `cases/`, one line each.

use crate::case::source::{BuiltIn, Source};

/// Lists the built-in cases by their path below `cases/`, without `.toml`.
macro_rules! cases {
    ($($name:literal,)*) => {
        BuiltIn {
            folder: "",
            files: &[$(($name, include_str!(concat!("../../cases/", $name, ".toml")))),*],
        }
    };
}

/// The names of the built-in cases with their text.
const CASES: BuiltIn = cases![
    "transmittance/eq21-overview",
    "transmittance/next-flight",
    "transmittance/negative-extinction",
    "transmittance/ratio-exactly-one",
    "transmittance/decomposition",
    "transmittance/local-majorants",
    "transmittance/layers-with-gap",
    "transmittance/exponential",
    "transmittance/gaussian",
    "transmittance/grid-trilinear",
    "transmittance/grid-nearest",
    "transmittance/noise-4",
    "transmittance/pilot",
    "transmittance/biased-ray-marching",
    "transmittance/biased-misuse",
    "transmittance/eq21-missing",
    "transmittance/sines",
    "transmittance/ramps",
    "transmittance/tight-control",
    "transmittance/known-bugs",
    "transmittance/deep",
    "free-flight/eq21-central",
    "free-flight/layers-with-gap",
    "free-flight/exponential",
    "free-flight/known-bugs",
    "spectral-transmittance/layers",
    "spectral-transmittance/smooth",
    "transmittance-curve/eq21-figure-8",
    "transmittance-curve/noise-figure-5",
    "transmittance-curve/known-bugs",
    "rod/three-rules-a0.7",
    "rod/roulette",
    "rod/known-bugs",
    "spectral-rod/three-albedos",
    "spectral-rod/near-albedos",
    "lit-rod/homogeneous",
    "lit-rod/rising",
    "lit-rod/albedos",
    "lit-slab/known-bugs",
    "lit-slab/distant",
    "lit-slab/cap-wide",
    "spectral-lit-rod/three-colours",
    "spectral-lit-rod/one-medium",
    "spectral-lit-rod/as-printed",
    "spectral-lit-rod/contrast",
    "single-scattering/homogeneous",
    "single-scattering/known-bugs",
    "single-scattering/null-paths-layers",
    "spectral-single-scattering/known-bugs",
    "spectral-single-scattering/without-mis",
    "slab/known-bugs",
    "slab/known-bugs-diffuse",
    "spectral-slab/known-bugs",
    "chromatic-slab/three-colours",
    "chromatic-slab/like-colours",
    "furnace/eq21",
    "furnace/known-bugs",
    "spectral-furnace/known-bugs",
    "spectral-furnace/like-colours",
    "lambertian/known-bugs",
    "lambertian/known-bugs-cells",
    "infinite-medium/known-bugs",
    "sphere/known-bugs",
    "sphere/known-bugs-paths",
    "sphere/techniques",
    "sphere/techniques-homogeneous",
    "sphere/techniques-lamp",
    "sphere/environment",
    "bidirectional-rod/known-bugs",
];

/// The cases of `trueflight self-test`, which are no part of the suite.
const CALIBRATION: BuiltIn = cases![
    "transmittance/calibration",
    "free-flight/calibration",
    "transmittance-curve/calibration",
];

/// A case of which `explain` shows a part, where no case of the suite has that estimator.
const SHOWN: BuiltIn = cases!["lambertian/eq21",];

/// Every case that `explain` may show a part of.
pub fn shown() -> Vec<Source> {
    [suite(), SHOWN.all()].concat()
}

/// The cases on which the gate itself is tested.
pub fn calibration() -> Vec<Source> {
    CALIBRATION.all()
}

/// Every built-in case, in the order of the suite.
pub fn suite() -> Vec<Source> {
    CASES.all()
}

/// The built-in case of a name.
pub fn find(name: &str) -> Option<Source> {
    CASES.find(name).or_else(|| CALIBRATION.find(name))
}
