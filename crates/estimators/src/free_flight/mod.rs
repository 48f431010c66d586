//! Samplers of the free flight along a ray.

pub mod inversion;
pub mod woodcock;

use crate::{Refusal, Setup, estimators};
use numeric::digits::rounded;
use theory::problems::FreeFlight;

/// Maximum optical depth: beyond it theory's quadratures do not resolve where the flights end.
const DEEPEST: f64 = 700.0;

/// Checks that theory resolves where flights end.
fn resolved(setup: &Setup<FreeFlight>) -> Result<(), Refusal> {
    let depth = setup.fields.mesh.optical_depth().value;
    if depth <= DEEPEST {
        return Ok(());
    }
    Err(Refusal::mismatch("an optical depth of at most 700", format!("τ = {}", rounded(depth))))
}

estimators! {
    FreeFlight on ControlledLine:
    inversion::Inversion,
    woodcock::Woodcock,
}
