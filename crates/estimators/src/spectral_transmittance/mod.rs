//! Estimators of the transmittance of a chromatic medium, all channels by one draw.

pub mod common_ratio;
pub mod hero;
pub mod independent;
pub mod spectral_mis;
pub mod spectral_tracking;
pub mod steps;
pub mod walk;

use crate::estimators;
use theory::problems::SpectralTransmittance;

/// Implements the trait of estimators for a page by its walk (common or of heroes), its distribution of heroes, and
/// its tracker.
macro_rules! trackers {
    ($this:ident => $walk:ident, $heroes:expr, $tracker:expr) => {
        const INPUTS: $crate::Inputs = $crate::Inputs::SAMPLING;

        fn predict(&$this, setup: &Setup<SpectralTransmittance>) -> theory::Prediction {
            let spectrum = $crate::spectral_transmittance::walk::spectrum(setup, $heroes, $tracker);
            spectrum.predict(&setup.problem.luminance)
        }

        $crate::walks::drawn!($this, setup: SpectralTransmittance => {
            use $crate::spectral_transmittance::{steps::Right, walk::AlongRay};
            AlongRay::$walk(setup, $heroes, $tracker, Right)
        });
    };
}
use trackers;

estimators! {
    SpectralTransmittance:
    independent::Independent,
    hero::Hero,
    spectral_tracking::SpectralTracking,
    spectral_mis::SpectralMis,
    common_ratio::CommonRatio,
}
