//! The transmittance at many distances, all from one walk.
//!
//! ```text
//! T(s_k) = exp(−∫₀^{s_k} σ_t(t) dt),  k = 1 … K
//! ```
//!
//! Settings are those of `transmittance`, and
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `distances` | K, from 2 to 16: equally spaced up to the end of the ray | 8 |
//!
//! Means, variances and the covariance matrix are tested. The record also holds the ray's anatomy,
//! as in Figures 5 and 8 of Szirmay-Kalos et al. 2017.

use super::Problem;
use media::catalogue::Settings;
use media::{Body, Medium};

/// The most distances a curve can have.
pub const MOST: usize = 16;

/// The transmittance at ascending distances.
pub struct TransmittanceCurve {
    medium: Medium,
    distances: Vec<f64>,
}

/// The values of one draw, one per distance.
pub type Values = super::Values<MOST>;

impl TransmittanceCurve {
    /// The distances, ascending.
    pub fn ascending(&self) -> &[f64] {
        &self.distances
    }
}

impl Problem for TransmittanceCurve {
    type Value = Values;

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let count = settings.count_or("distances", 2..=MOST as u64, 8)?;
        let medium = body?.medium();
        let span = medium.span();
        let step = span.length() / count as f64;
        let mut distances: Vec<f64> = (1..count).map(|k| span.from + step * k as f64).collect();
        distances.push(span.to);
        Some(Self { medium, distances })
    }

    fn medium(&self) -> &Medium {
        &self.medium
    }

    fn distances(&self) -> Vec<f64> {
        self.distances.clone()
    }
}
