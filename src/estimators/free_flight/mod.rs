//! Samplers of the free flight along a ray.

use crate::estimators::estimators;
use crate::problems::FreeFlight;

estimators! {
    FreeFlight:
    inversion::Inversion,
    woodcock::Woodcock,
}
