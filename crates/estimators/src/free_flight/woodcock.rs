//! Free flight by Woodcock (delta) tracking: fly through a majorant to the first real collision.
//!
//! Unbiased for: σ̂ ≥ σ_t, with the exact distribution; refused elsewhere.
//!
//! ```text
//! s = the first tᵢ with uᵢ < σ_t(tᵢ)/σ̄(tᵢ),  tᵢ a Poisson process of rate σ̄;  S if there is none
//! ```
//!
//! Refused for τ > 700, too. Lookups are those of `woodcock` for the
//! transmittance: `E = ∫ σ̄ T dt`.
//!
//! Source: E. R. Woodcock, T. Murphy, P. Hemmings, T. Longworth, *Techniques used in the GEM code
//! for Monte Carlo neutronics calculations*, ANL-7050 (1965).

use fearless_simd::Level;

use crate::kernels::packet::{self, Request};
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::{Extinction, Lookups};
use numeric::rng::Stream;
use theory::problems::{FreeFlight, Problem};
use theory::rules::Null;
use theory::{Prediction, flight};

/// Woodcock tracking; σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct Woodcock;

impl Estimator<FreeFlight> for Woodcock {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const PLAIN: Option<Self> = Some(Self);
    const SKIPS: bool = true;
    const IN_PACKETS: bool = true;

    fn domain(&self, setup: &Setup<FreeFlight>) -> Result<(), Refusal> {
        setup.require_ratio_at_most(1.0, "σ̂ ≥ σ_t everywhere")?;
        super::resolved(setup)
    }

    fn predict(&self, setup: &Setup<FreeFlight>) -> Prediction {
        let product = setup.product(&Null);
        let mesh = product.mesh(&[]);
        let all = product.integrals(&mesh, &[mesh.support().to])[0];
        flight::predict(&setup.mesh, product.lookups(&mesh, &all))
    }

    #[inline(always)]
    fn draw(&self, setup: &Setup<FreeFlight>, medium: &Lookups, rng: &mut Stream) -> Draw {
        let ray = setup.problem.medium().span();
        let mut cursor = setup.sampling.begin();
        let mut lookups = 0;
        loop {
            let (depth, number) = (-rng.ln_uniform(), rng.uniform());
            let Some(sampling) = setup.sampling.fly(&mut cursor, depth) else { break };
            lookups += 1;
            if number < medium.extinction(cursor.t) * (1.0 / sampling) {
                return Draw::free([cursor.t - ray.from], lookups);
            }
        }
        Draw::free([ray.length()], lookups)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<FreeFlight>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        packet::flight(level, setup, medium, request)
    }
}
