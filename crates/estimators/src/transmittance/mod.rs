//! Estimators of the transmittance of a ray.

pub mod closed_form;
pub mod decomposition;
pub mod double;
pub mod local_majorant;
pub mod next_flight;
pub mod product;
pub mod ratio;
pub mod ray_marching;
pub mod regular;
pub mod residual_ratio;
pub mod scoring;
pub mod single;
pub mod unidirectional_mis;
pub mod weighted_delta;
pub mod woodcock;

use crate::estimators;
use theory::problems::Transmittance;

estimators! {
    Transmittance on ControlledLine:
    closed_form::ClosedForm,
    regular::Regular,
    woodcock::Woodcock,
    local_majorant::LocalMajorant,
    decomposition::Decomposition,
    ratio::Ratio,
    residual_ratio::ResidualRatio,
    single::SingleParticle,
    double::DoubleParticle,
    weighted_delta::WeightedDelta,
    next_flight::NextFlight,
    unidirectional_mis::UnidirectionalMis,
    ray_marching::RayMarching,
}
