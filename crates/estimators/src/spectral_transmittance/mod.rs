//! Estimators of the transmittance of a chromatic medium, all channels by one draw.

pub mod common_ratio;
pub mod events;
pub mod hero;
pub mod independent;
pub mod page;
pub mod spectral_mis;
pub mod spectral_tracking;
pub mod walk;

use crate::estimators;
use theory::problems::SpectralTransmittance;

estimators! {
    SpectralTransmittance on ChannelMedia:
    independent::Independent,
    hero::Hero,
    spectral_tracking::SpectralTracking,
    spectral_mis::SpectralMis,
    common_ratio::CommonRatio,
}
