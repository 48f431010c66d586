//! The distance to the first real collision along a ray.
//!
//! ```text
//! P(s > t) = T(t);  a ray that leaves scores its full length: an atom of T(S) at S
//! E[min(s, S)] = ∫₀^S T(t) dt
//! ```
//!
//! Settings are those of `transmittance`. A draw is the distance from the ray's beginning. The
//! whole distribution is tested, not only its mean.

use super::Problem;
use crate::catalogue::Settings;
use crate::media::{Body, Medium};

/// The free flight along a ray.
pub struct FreeFlight {
    medium: Medium,
}

impl Problem for FreeFlight {
    type Value = [f64; 1];

    fn read(body: Option<&Body>, _: &Settings) -> Option<Self> {
        Some(Self { medium: body?.medium() })
    }

    fn medium(&self) -> &Medium {
        &self.medium
    }
}
