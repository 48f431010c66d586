//! Estimators of the radiance by single scattering of a point light.

pub mod attenuation_driven;
pub mod attenuation_resampled;
pub mod connection;
pub mod delta_tracking;
pub mod main_part;
mod packet;
pub mod scattering_driven;
pub mod shared_walk;
pub mod source_delta_mis;
pub mod source_driven;
pub mod source_scattering_mis;
mod technique;

use crate::estimators;
use theory::problems::SingleScattering;

pub use connection::Connection;

/// How an estimator draws by packets: its technique and its shadow rays, as in
/// `in_packets!(self => (Kind::Collision, self.shadow))`.
macro_rules! in_packets {
    ($this:ident => $kind:expr) => {
        const IN_PACKETS: bool = true;

        fn draw_packets<'a>(
            &$this,
            level: fearless_simd::Level,
            setup: &$crate::Setup<theory::problems::SingleScattering>,
            medium: &media::Lookups,
            request: $crate::kernels::packet::Request<'a>,
        ) -> Option<$crate::kernels::packet::Request<'a>> {
            $crate::single_scattering::packet::walks(level, setup, $kind, medium, request)
        }
    };
}
use in_packets;

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
