//! The non-terminating walk with Russian roulette on small weights.
//!
//! Unbiased for: σ̂ ≥ σ_t, for which theory bounds the variance; refused elsewhere.
//!
//! ```text
//! after a collision with |w| < w₀: the walk goes on with probability |w|/w₀ and weight sgn(w) w₀, else it ends
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `below` | w₀ in (0, 1] | 0.1 |
//!
//! Roulette changes no mean: survivors get the weight that the others lose. Which particles play depends on their
//! weight. The moment equations, which hold for weight 1 and scale, therefore do not close. The means and a bound
//! on the variances are known, but no number of lookups. For `σ̂ ≥ σ_t`, where weights never exceed 1,
//!
//! ```text
//! 0 ≤ X ≤ 1,  so that Var[X] ≤ E[X](1 − E[X])
//! ```
//!
//! and means are tested with that bound. Elsewhere it is refused. It is also refused if the absorbed energy or the
//! flux, which have no such bound, is a channel.
//!
//! Source: H. Kahn, *Use of Different Monte Carlo Sampling Techniques*, RAND P-766 (1955); the walk: that
//! of `non-terminating`.
//!
//! ```toml
//! title = "An example of roulette"
//!
//! [problem.rod]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.8
//! forward = 0.6
//! sampling = 1.6
//! estimators = ["roulette"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::ByRule;
use super::walk::{self, RuleAndRoulette};
use crate::{Estimator, Inputs, Kernel, Refusal, Request, Setup, Traits};
use media::catalogue::{Domain, Settings};
use theory::problems::Rod;
use theory::problems::rod::RodQuantity;
use theory::{ParticleRule, Prediction, rod};

/// The non-terminating rule with roulette; σ̂ is its input.
#[derive(Debug, Clone, Copy)]
pub struct Roulette {
    /// w₀.
    pub below: f64,
}

impl Roulette {
    #[inline(always)]
    fn steps(self) -> RuleAndRoulette {
        RuleAndRoulette { rule: ParticleRule::NonTerminating, roulette: Some(self.below) }
    }
}

impl Estimator<Rod> for Roulette {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Self> {
        let below = settings.number_or("below", Domain::Positive, 0.1)?;
        if below > 1.0 {
            let help = "a particle begins with weight 1";
            settings.fault("below", format!("`below` is {below}"), help);
            return None;
        }
        Some(Self { below })
    }

    fn traits(&self) -> Traits {
        Traits { settings: format!("below {}", self.below), ..Traits::of(Self::INPUTS) }
    }

    fn domain(&self, setup: &Setup<Rod>) -> Result<(), Refusal> {
        let is_score =
            |seen: &RodQuantity| matches!(seen, RodQuantity::Absorbed | RodQuantity::Flux(_));
        if setup.problem.channels.iter().any(is_score) {
            return Err(Refusal::mismatch(
                "channels whose draws are at most 1",
                "what is scored on the way has no bound",
            ));
        }
        setup.residual().require_few_collisions("∫σ̂ ≤ 1e6")?;
        setup.residual().require_ratio_at_most(1.0, "σ̂ ≥ σ_t everywhere")?;
        Rod::realisable(setup, ParticleRule::NonTerminating)
    }

    fn predict(&self, setup: &Setup<Rod>) -> Prediction {
        rod::bounded(&setup.fields.mesh, &setup.problem)
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<Rod>, request: Request) {
        walk::fill(self.steps(), kernel, setup, request);
    }
}
