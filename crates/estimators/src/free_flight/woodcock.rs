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
//!
//! ```toml
//! title = "An example of woodcock"
//!
//! [problem.free-flight]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.6
//! estimators = ["woodcock"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use crate::walks::{self, Route, TentativeCollision, Walk};
use crate::{Estimator, Inputs, Kernel, Refusal, Request, Setup, Traits};
use media::sampling::BothWays;
use numeric::rng::Random;
use numeric::{Lane, Span, kept};
use theory::Prediction;
use theory::collisions::rules::Null;
use theory::problems::{FreeFlight, Problem};
use theory::ray::free_flight;

/// Woodcock tracking; σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct Woodcock;

impl Estimator<FreeFlight> for Woodcock {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const PLAIN: Option<Self> = Some(Self);

    fn traits(&self) -> Traits {
        Traits { skips: true, ..Traits::of(Self::INPUTS) }
    }

    fn domain(&self, setup: &Setup<FreeFlight>) -> Result<(), Refusal> {
        setup.residual().require_ratio_at_most(1.0, "σ̂ ≥ σ_t everywhere")?;
        super::resolved(setup)
    }

    fn predict(&self, setup: &Setup<FreeFlight>) -> Prediction {
        let product = setup.product(&Null);
        let mesh = product.mesh(&[]);
        let all = product.integrals(&mesh, &[mesh.support().to])[0];
        free_flight::predict(&setup.fields.mesh, product.lookups(&mesh, &all))
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<FreeFlight>, request: Request) {
        walks::fill(&Flights::new(setup), kernel, setup, request);
    }
}

kept! {
    /// A walk to its first real collision.
    pub struct Flight<L> {
        /// The distance of the last tentative collision.
        t: L,
    }
}

/// The walk of Woodcock tracking to the first real collision.
#[derive(Clone, Copy)]
pub struct Flights {
    ray: Span,
}

impl Flights {
    /// The walk on a setup.
    #[inline(always)]
    pub fn new(setup: &Setup<FreeFlight>) -> Self {
        Self { ray: setup.problem.medium().span() }
    }
}

impl Walk for Flights {
    type State<L: Lane> = Flight<L>;

    const IS_FIXED: bool = true;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> Flight<L> {
        Flight { t: one }
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        flight: &mut Flight<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        let inside = route.here.fly(depth);
        flight.t = route.here.reached();
        inside
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        _: &mut Flight<L>,
        _: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        _: &mut impl Random<L>,
    ) -> L::Mask {
        extinctions.inside & !extinctions.number.below(extinctions.ratio())
    }

    #[inline(always)]
    fn value<L: Lane>(&self, flight: &Flight<L>, left: L::Mask, _: usize) -> L {
        L::select(left, flight.t.each(self.ray.length()), flight.t - self.ray.from)
    }
}
