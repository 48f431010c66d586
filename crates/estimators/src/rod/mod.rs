//! Walks of a particle through a rod.

pub mod adaptive;
pub mod analog;
pub mod non_terminating;
pub mod roulette;
pub mod terminating;
pub mod walk;
pub mod weighted;

use crate::recipes::inequality;
use crate::{Estimated, Kernel, Refusal, Request, Setup, estimators};
use theory::collisions::particle::RatioRange;
use theory::problems::Rod;
use theory::rod::{self, NoVariance};
use theory::{ParticleRule, Prediction};
use walk::RuleAndRoulette;

/// A problem with walks that collide by a rule; its estimators have common pages.
pub trait ByRule: Estimated {
    /// Checks that a rule exists, that σ̂ covers the medium, and that the variance is finite.
    ///
    /// # Errors
    ///
    /// The reason why not.
    fn realisable(setup: &Setup<Self>, rule: ParticleRule) -> Result<(), Refusal>;

    /// Returns the prediction for a draw.
    fn predict(setup: &Setup<Self>, rule: ParticleRule) -> Prediction;

    /// Makes the draws of a request.
    fn fill(rule: ParticleRule, kernel: Kernel, setup: &Setup<Self>, request: Request);
}

impl ByRule for Rod {
    fn realisable(setup: &Setup<Self>, rule: ParticleRule) -> Result<(), Refusal> {
        setup.residual().require_coverage()?;
        setup.residual().require_few_collisions("∫σ̂ ≤ 1e6")?;
        if rule.range() != RatioRange::Every {
            let albedo = &setup.problem.albedo;
            let limit = |t: f64| rule.limits(albedo.value(t))[1];
            setup.residual().require_ratio_within(
                albedo.knots(),
                limit,
                inequality(rule.range()),
            )?;
        }
        if setup.problem.parts > 0
            && setup.fields.sampling.corner_values().any(|value| value <= 0.0)
        {
            let needs = "σ̂ > 0 on the whole rod to see its flux";
            return Err(Refusal::mismatch(needs, "σ̂ = 0 somewhere"));
        }
        let mesh = &setup.fields.mesh;
        let needs = "a finite variance";
        match rod::has_variance(mesh, &setup.problem, &setup.fields.sampling, rule) {
            Ok(()) => Ok(()),
            Err(NoVariance::Diverges(at)) => Err(Refusal::Inequality {
                needs: needs.into(),
                actual: "σ̂ is so far below σ_t that E[X²] diverges: the critical length ends"
                    .to_owned(),
                at,
            }),
            Err(NoVariance::Unresolved(error)) if error < 1.0 => Err(Refusal::mismatch(
                needs,
                format!("E[X²] is known to {error:.0e} only: σ̂ is next to where it diverges"),
            )),
            Err(NoVariance::Unresolved(_)) => Err(Refusal::mismatch(
                needs,
                "σ̂ is so near to where E[X²] diverges that theory does not tell on which side",
            )),
            Err(NoVariance::Underflows) => Err(Refusal::mismatch(
                "draws whose squares are doubles",
                "so little leaves the rod that E[X²] is below 1e-292",
            )),
            Err(NoVariance::TooLong) => Err(Refusal::mismatch(
                "a rod that theory can cut into 5000 panels",
                "σ̂ or σ_t is too large on it",
            )),
        }
    }

    fn predict(setup: &Setup<Self>, rule: ParticleRule) -> Prediction {
        rod::predict(
            &setup.fields.mesh,
            &setup.problem,
            &setup.fields.sampling,
            rule,
            setup.distributions,
        )
    }

    fn fill(rule: ParticleRule, kernel: Kernel, setup: &Setup<Self>, request: Request) {
        walk::fill(RuleAndRoulette { rule, roulette: None }, kernel, setup, request);
    }
}

/// Implements the trait of estimators for a rule, as in `by_rule!(Adaptive)`.
macro_rules! by_rule {
    ($Page:ident) => {
        impl<P: $crate::rod::ByRule> $crate::Estimator<P> for $Page {
            const INPUTS: $crate::Inputs = $crate::Inputs::SAMPLING;
            const PLAIN: Option<Self> = Some(Self);

            fn domain(&self, setup: &$crate::Setup<P>) -> Result<(), $crate::Refusal> {
                P::realisable(setup, theory::ParticleRule::$Page)
            }

            fn predict(&self, setup: &$crate::Setup<P>) -> theory::Prediction {
                P::predict(setup, theory::ParticleRule::$Page)
            }

            fn fill(
                &self,
                kernel: $crate::Kernel,
                setup: &$crate::Setup<P>,
                request: $crate::Request,
            ) {
                P::fill(theory::ParticleRule::$Page, kernel, setup, request);
            }
        }
    };
}
use by_rule;

estimators! {
    Rod on Line:
    terminating::Terminating,
    non_terminating::NonTerminating,
    adaptive::Adaptive,
    analog::Analog,
    weighted::Weighted,
    roulette::Roulette,
}
