//! Walks through a rod of coloured scatterers, all channels by one draw.

pub mod independent;
pub mod spectral_mis;
pub mod spectral_tracking;
pub mod walk;

use crate::estimators::estimators;
use crate::problems::SpectralRod;

estimators! {
    SpectralRod:
    independent::Independent,
    spectral_tracking::SpectralTracking,
    spectral_mis::SpectralMis,
}
