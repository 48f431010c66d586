//! The distance to the first real collision along a ray.
//!
//! ```text
//! P(s > t) = T(t);  a ray that leaves scores its full length: an atom of T(S) at S
//! E[min(s, S)] = ∫₀^S T(t) dt
//! ```
//!
//! Settings are those of `transmittance`. A draw is the distance from the ray's beginning. The
//! whole distribution is tested, not only its mean, by `run` and, of another program's draws, by
//! `judge`.
//!
//! Another program may write a flight that leaves as S, as any larger number, as `inf` or as `-1`.
//! NaN and other negative numbers are no distances; `judge` names them.
//!
//! ```toml
//! title = "An example of free-flight"
//!
//! [problem.free-flight]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.6
//! estimators = ["inversion", "woodcock"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use std::slice;
use std::sync::OnceLock;

use super::Problem;
use media::catalogue::Settings;
use media::{Body, Inverse, Medium};

/// The free flight along a ray.
pub struct FreeFlight {
    medium: Medium,
    inverse: OnceLock<Inverse>,
}

impl FreeFlight {
    /// Distances at which optical depths are reached; computed at the first call.
    pub fn inverse(&self) -> &Inverse {
        self.inverse.get_or_init(|| self.medium.inverse())
    }
}

impl Problem for FreeFlight {
    type Value = [f64; 1];

    fn read(body: Option<&Body>, _: &Settings) -> Option<Self> {
        Some(Self { medium: body?.medium(), inverse: OnceLock::new() })
    }

    fn media(&self) -> &[Medium] {
        slice::from_ref(&self.medium)
    }
}
