//! Estimators of the radiance by single scattering of a point light.

pub mod connection;
pub mod main_part;

use crate::estimators::estimators;
use crate::problems::SingleScattering;

pub use connection::Connection;

estimators! {
    SingleScattering:
    attenuation_driven::AttenuationDriven,
    attenuation_resampled::AttenuationResampled,
    shared_walk::SharedWalk,
    source_driven::SourceDriven,
    scattering_driven::ScatteringDriven,
    delta_tracking::DeltaTracking,
    source_scattering_mis::SourceScatteringMis,
    source_delta_mis::SourceDeltaMis,
}
