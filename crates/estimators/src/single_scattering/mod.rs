//! Estimators of the radiance by single scattering of a point light.

pub mod attenuation_driven;
pub mod attenuation_resampled;
pub mod delta_tracking;
mod interactions;
pub mod main_part;
pub mod plan;
pub mod points;
pub mod ray_setup;
pub mod scattering_driven;
pub mod shadow;
mod shared;
pub mod shared_walk;
pub mod source_delta_mis;
pub mod source_driven;
pub mod source_scattering_mis;
pub mod vertices;

use crate::estimators;
use theory::problems::SingleScattering;

estimators! {
    SingleScattering on ControlledLine:
    attenuation_driven::AttenuationDriven,
    attenuation_resampled::AttenuationResampled,
    shared_walk::SharedWalk,
    source_driven::SourceDriven,
    scattering_driven::ScatteringDriven,
    delta_tracking::DeltaTracking,
    source_scattering_mis::SourceScatteringMis,
    source_delta_mis::SourceDeltaMis,
}
