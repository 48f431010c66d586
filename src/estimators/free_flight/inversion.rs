//! Free flight by inversion: solve τ(0, s) = −ln(1 − ξ).
//!
//! ```text
//! s = τ⁻¹(−ln u),  u uniform in (0, 1];  a depth beyond τ(0, S) escapes and scores S
//! ```
//!
//! For τ ≤ 700; exact for every field whose optical depth is; where that has no closed inverse, the root is
//! bracketed to the last bits. It evaluates the optical depth, never σ_t: no lookups.
//!
//! The optical depth is theory, which uses the platform's library: the last bits of these draws, and
//! of these alone, may differ between machines.
//!
//! Source: Szirmay-Kalos et al. 2017, Eq. 4.

use crate::catalogue::Settings;
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup};
use crate::media::Extinction;
use crate::problems::{FreeFlight, Problem};
use crate::rng::{Stream, exponential};
use crate::theory::{CountLaw, Prediction, flight};

/// Inversion; it has no settings.
#[derive(Debug, Clone)]
pub struct Inversion;

impl Estimator<FreeFlight> for Inversion {
    const INPUTS: Inputs = Inputs::NONE;

    fn read(_: &Settings) -> Option<Self> {
        Some(Self)
    }

    fn domain(&self, setup: &Setup<FreeFlight>) -> Result<(), Refusal> {
        super::resolved(setup)
    }

    fn predict(&self, setup: &Setup<FreeFlight>) -> Prediction {
        flight::predict(&setup.mesh, CountLaw::always(0.0))
    }

    #[inline(always)]
    fn draw<M: Extinction>(
        &self,
        setup: &Setup<FreeFlight>,
        _: &M,
        rng: &mut Stream,
    ) -> Draw<[f64; 1]> {
        let medium = setup.problem.medium();
        let ray = medium.span();
        let end = medium.free_flight(exponential(rng)).unwrap_or(ray.to);
        Draw::free([end - ray.from], 0)
    }
}
