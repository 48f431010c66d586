//! Free flight by inversion: solve τ(0, s) = −ln(1 − ξ).
//!
//! Unbiased for: every medium, with the exact distribution.
//!
//! ```text
//! s = τ⁻¹(−ln u),  u uniform in (0, 1];  a depth beyond τ(0, S) escapes and scores S
//! ```
//!
//! For τ ≤ 700; exact for every field with an exact optical depth. Where the optical depth has no closed inverse, a
//! table that is made once gives the starting point, and Newton's steps on the exact depth find the root to 1e-15
//! of it. σ_t is only the slope of a step, on which the root does not depend: no lookups.
//!
//! The optical depth is theory, which uses the platform's library: the last bits of these draws, and
//! of these alone, may differ between machines.
//!
//! Source: Szirmay-Kalos et al. 2017, Eq. 4.
//!
//! ```toml
//! title = "An example of inversion"
//!
//! [problem.free-flight]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! estimators = ["inversion"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use crate::{Draw, Estimator, Inputs, Kernel, Knowledge, Refusal, Request, Setup, Traits, walks};
use numeric::rng::exponential;
use theory::problems::{FreeFlight, Problem};
use theory::ray::free_flight;
use theory::{CountDistribution, Prediction};

/// Inversion; it has no settings.
#[derive(Debug, Clone)]
pub struct Inversion;

impl Estimator<FreeFlight> for Inversion {
    const INPUTS: Inputs = Inputs::NONE;
    const PLAIN: Option<Self> = Some(Self);

    fn traits(&self) -> Traits {
        Traits { needs: Some(Knowledge::InverseDepth), ..Traits::of(Self::INPUTS) }
    }

    fn domain(&self, setup: &Setup<FreeFlight>) -> Result<(), Refusal> {
        super::resolved(setup)
    }

    fn predict(&self, setup: &Setup<FreeFlight>) -> Prediction {
        free_flight::predict(&setup.fields.mesh, CountDistribution::always(0.0))
    }

    #[inline(always)]
    fn fill(&self, _: Kernel, setup: &Setup<FreeFlight>, request: Request) {
        let (ray, inverse) = (setup.problem.medium().span(), setup.problem.inverse());
        walks::one_by_one(
            setup,
            request,
            #[inline(always)]
            |_, random| {
                let end = inverse.free_flight(exponential(random)).unwrap_or(ray.to);
                Draw::free([end - ray.from], 0)
            },
        );
    }
}
