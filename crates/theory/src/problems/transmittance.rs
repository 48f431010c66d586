//! The transmittance of a ray.
//!
//! ```text
//! T = exp(−∫ σ_t(t) dt)
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `medium` with `span = [from, to]` | a field in 1-D and where it is asked about | one of the two |
//! | `volume` with `ray = { origin, direction, length }` | a field in 3-D and a ray through it | is required |
//! | `sampling` | σ̂ of every estimator without its own | required unless swept |
//! | `control` | σ_c of every estimator that takes one and has none of its own | none |
//! | `sweep` | one of `sampling`, `sampling-scale`, `albedo`, `control`, `points`, `density` | none |
//! | `estimators` | what is tested | required |
//!
//! Beyond `τ = 300` the square of T is no longer a double: draws, truth and moments are then in units
//! of `e^{−τ}`, and T itself is never formed.
//!
//! The answer is exact because every field of the catalogue knows its optical depth.

use super::Problem;
use media::catalogue::Settings;
use media::{Body, Medium};

/// Beyond this optical depth values are in units of `e^{−τ}`.
const THICK: f64 = 300.0;

/// The transmittance of the whole ray.
pub struct Transmittance {
    medium: Medium,
}

impl Transmittance {
    /// Of the medium's ray.
    pub fn new(medium: Medium) -> Self {
        Self { medium }
    }
}

impl Problem for Transmittance {
    type Value = [f64; 1];

    fn read(body: Option<&Body>, _: &Settings) -> Option<Self> {
        Some(Self { medium: body?.medium() })
    }

    fn medium(&self) -> &Medium {
        &self.medium
    }

    fn log_unit(&self, depth: f64) -> f64 {
        if depth > THICK { depth } else { 0.0 }
    }
}
