//! Cases that are built into the binary: a choice of those under `cases/` and `tests/cases/`, one line each.

use crate::case::spec::{BuiltIn, CaseText};

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
    "transmittance/spectral-layers",
    "transmittance/spectral-smooth" in "tests/",
    "transmittance/curve-eq21-figure-8",
    "transmittance/curve-noise-figure-5",
    "transmittance/curve-known-bugs" in "tests/",
    "rod/three-rules-a0.7",
    "rod/roulette",
    "rod/known-bugs" in "tests/",
    "rod/spectral-three-albedos",
    "rod/spectral-near-albedos" in "tests/",
    "rod/lit-homogeneous",
    "rod/lit-rising" in "tests/",
    "rod/lit-albedos",
    "slab/lit-known-bugs" in "tests/",
    "slab/lit-distant",
    "slab/lit-cap-wide",
    "rod/spectral-lit-three-colours",
    "rod/spectral-lit-one-medium" in "tests/",
    "rod/spectral-lit-as-printed",
    "rod/spectral-lit-contrast",
    "single-scattering/homogeneous",
    "single-scattering/known-bugs" in "tests/",
    "single-scattering/null-paths-layers",
    "single-scattering/spectral-known-bugs" in "tests/",
    "single-scattering/spectral-without-mis",
    "slab/known-bugs" in "tests/",
    "slab/known-bugs-diffuse" in "tests/",
    "slab/spectral-known-bugs" in "tests/",
    "slab/chromatic-three-colours",
    "slab/chromatic-like-colours",
    "furnace/eq21",
    "furnace/known-bugs" in "tests/",
    "furnace/spectral-known-bugs" in "tests/",
    "furnace/spectral-like-colours",
    "lambertian/known-bugs" in "tests/",
    "lambertian/known-bugs-cells" in "tests/",
    "infinite-medium/known-bugs" in "tests/",
    "ball/known-bugs" in "tests/",
    "ball/known-bugs-paths" in "tests/",
    "ball/techniques",
    "ball/techniques-homogeneous" in "tests/",
    "ball/techniques-lamp" in "tests/",
    "ball/environment",
    "rod/bidirectional-known-bugs" in "tests/",
];

/// Cases of `trueflight-lab self-test`, which are not part of the suite.
const CALIBRATION: BuiltIn = cases![
    "transmittance/calibration" in "tests/",
    "free-flight/calibration" in "tests/",
    "transmittance/curve-calibration" in "tests/",
];

/// Returns the cases that test the gate itself.
pub fn calibration() -> Vec<CaseText> {
    CALIBRATION.all()
}

/// Returns every built-in case, in the order of the suite.
pub fn suite() -> Vec<CaseText> {
    CASES.all()
}

/// Returns the built-in case of a name.
pub fn find(name: &str) -> Option<CaseText> {
    CASES.find(name).or_else(|| CALIBRATION.find(name))
}
