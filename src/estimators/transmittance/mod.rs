//! Estimators of the transmittance of a ray.

use crate::estimators::estimators;
use crate::problems::Transmittance;

estimators! {
    Transmittance:
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
