//! The cases that are built into the binary: a choice of those under `cases/` and `tests/cases/`, one line each.

use crate::case::source::{BuiltIn, Source};

/// Lists built-in cases by their path below `cases/`, without `.toml`; `in "tests/"` means `tests/cases/`.
macro_rules! cases {
    ($($name:literal $(in $folder:literal)?,)*) => {
        BuiltIn {
            folder: "",
            files: &[$(($name, include_str!(concat!("../../", $($folder,)? "cases/", $name, ".toml")))),*],
        }
    };
}

/// The names of the built-in cases with their text.
const CASES: BuiltIn = cases![
    "transmittance/eq21-overview",
    "transmittance/next-flight",
    "transmittance/negative-extinction",
    "transmittance/ratio-exactly-one" in "tests/",
    "transmittance/decomposition",
    "transmittance/local-majorants",
    "transmittance/layers-with-gap",
    "transmittance/exponential",
    "transmittance/gaussian" in "tests/",
    "transmittance/grid-trilinear",
    "transmittance/grid-nearest" in "tests/",
    "transmittance/noise-4" in "tests/",
    "transmittance/pilot",
    "transmittance/biased-ray-marching",
    "transmittance/biased-misuse" in "tests/",
    "transmittance/eq21-missing" in "tests/",
    "transmittance/sines" in "tests/",
    "transmittance/ramps" in "tests/",
    "transmittance/tight-control" in "tests/",
    "transmittance/known-bugs" in "tests/",
    "transmittance/deep" in "tests/",
    "free-flight/eq21-central",
    "free-flight/layers-with-gap",
    "free-flight/exponential",
    "free-flight/known-bugs" in "tests/",
    "spectral-transmittance/layers",
    "spectral-transmittance/smooth" in "tests/",
    "transmittance-curve/eq21-figure-8",
    "transmittance-curve/noise-figure-5",
    "transmittance-curve/known-bugs" in "tests/",
    "rod/three-rules-a0.7",
    "rod/roulette",
    "rod/known-bugs" in "tests/",
    "spectral-rod/three-albedos",
    "spectral-rod/near-albedos" in "tests/",
    "lit-rod/homogeneous",
    "lit-rod/rising" in "tests/",
    "lit-rod/albedos",
    "lit-slab/known-bugs" in "tests/",
    "lit-slab/distant",
    "lit-slab/cap-wide",
    "spectral-lit-rod/three-colours",
    "spectral-lit-rod/one-medium" in "tests/",
    "spectral-lit-rod/as-printed",
    "spectral-lit-rod/contrast",
    "single-scattering/homogeneous",
    "single-scattering/known-bugs" in "tests/",
    "single-scattering/null-paths-layers",
    "spectral-single-scattering/known-bugs" in "tests/",
    "spectral-single-scattering/without-mis",
    "slab/known-bugs" in "tests/",
    "slab/known-bugs-diffuse" in "tests/",
    "spectral-slab/known-bugs" in "tests/",
    "chromatic-slab/three-colours",
    "chromatic-slab/like-colours",
    "furnace/eq21",
    "furnace/known-bugs" in "tests/",
    "spectral-furnace/known-bugs" in "tests/",
    "spectral-furnace/like-colours",
    "lambertian/known-bugs" in "tests/",
    "lambertian/known-bugs-cells" in "tests/",
    "infinite-medium/known-bugs" in "tests/",
    "sphere/known-bugs" in "tests/",
    "sphere/known-bugs-paths" in "tests/",
    "sphere/techniques",
    "sphere/techniques-homogeneous" in "tests/",
    "sphere/techniques-lamp" in "tests/",
    "sphere/environment",
    "bidirectional-rod/known-bugs" in "tests/",
];

/// The cases of `trueflight self-test`, which are no part of the suite.
const CALIBRATION: BuiltIn = cases![
    "transmittance/calibration" in "tests/",
    "free-flight/calibration" in "tests/",
    "transmittance-curve/calibration" in "tests/",
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
