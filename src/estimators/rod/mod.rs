//! Walks of a particle through a rod.

pub mod adaptive;
pub mod analog;
pub mod non_terminating;
pub mod packet;
pub mod roulette;
pub mod terminating;
pub mod walk;
pub mod weighted;

use crate::estimators::{Refusal, Setup, estimators};
use crate::problems::Rod;
use crate::theory::ParticleRule;
use crate::theory::rod::{self, NoVariance};

/// Whether a rule exists on a rod, reaches all of it, and has a variance there.
fn realisable(setup: &Setup<Rod>, rule: ParticleRule) -> Result<(), Refusal> {
    setup.require_coverage()?;
    setup.require_few_collisions("∫σ̂ ≤ 1e6")?;
    if !rule.needs().is_empty() {
        let albedo = &setup.problem.albedo;
        let limit = |t: f64| rule.limits(albedo.value(t))[1];
        setup.require_ratio_within(albedo.knots(), limit, rule.needs())?;
    }
    if setup.problem.parts > 0 && setup.sampling.corner_values().any(|value| value <= 0.0) {
        let needs = "σ̂ > 0 on the whole rod to see its flux";
        return Err(Refusal::mismatch(needs, "σ̂ = 0 somewhere"));
    }
    let mesh = &setup.mesh;
    let needs = "a finite variance";
    match rod::has_variance(mesh, &setup.problem, &setup.sampling, rule) {
        Ok(()) => Ok(()),
        Err(NoVariance::Diverges(at)) => Err(Refusal::Inequality {
            needs,
            found: "σ̂ is so far below σ_t that E[X²] diverges: the critical length ends".to_owned(),
            at,
        }),
        Err(NoVariance::Blurred(error)) if error < 1.0 => Err(Refusal::mismatch(
            needs,
            format!("E[X²] is known to {error:.0e} only: σ̂ is next to where it diverges"),
        )),
        Err(NoVariance::Blurred(_)) => Err(Refusal::mismatch(
            needs,
            "σ̂ is so near to where E[X²] diverges that theory does not tell on which side",
        )),
        Err(NoVariance::TooLong) => Err(Refusal::mismatch(
            "a rod that theory can cut into 1e4 steps",
            "σ̂ or σ_t is too large on it",
        )),
    }
}

/// The plumbing of a page: all that differs is the rule, as in `walks!(ParticleRule::Adaptive)`.
macro_rules! walks {
    ($rule:expr) => {
        const INPUTS: $crate::estimators::Inputs = $crate::estimators::Inputs::SAMPLING;
        const IN_PACKETS: bool = true;

        fn read(_: &$crate::catalogue::Settings) -> Option<Self> {
            Some(Self)
        }

        fn domain(
            &self,
            setup: &$crate::estimators::Setup<$crate::problems::Rod>,
        ) -> Result<(), $crate::estimators::Refusal> {
            $crate::estimators::rod::realisable(setup, $rule)
        }

        fn predict(
            &self,
            setup: &$crate::estimators::Setup<$crate::problems::Rod>,
        ) -> $crate::theory::Prediction {
            let (mesh, rod) = (&setup.mesh, &setup.problem);
            $crate::theory::rod::predict(mesh, rod, &setup.sampling, $rule, setup.laws)
        }

        #[inline(always)]
        fn draw(
            &self,
            setup: &$crate::estimators::Setup<$crate::problems::Rod>,
            medium: &$crate::media::Lookups,
            rng: &mut $crate::rng::Stream,
        ) -> $crate::estimators::Draw<$crate::problems::rod::Values> {
            $crate::estimators::rod::walk::draw(&$rule, setup, medium, rng)
        }

        fn draw_packets<'a>(
            &self,
            level: fearless_simd::Level,
            setup: &$crate::estimators::Setup<$crate::problems::Rod>,
            medium: &$crate::media::Lookups,
            request: $crate::kernels::packet::Request<'a>,
        ) -> Option<$crate::kernels::packet::Request<'a>> {
            $crate::estimators::rod::packet::walks(level, setup, ($rule, None), medium, request)
        }
    };
}
use walks;

estimators! {
    Rod:
    terminating::Terminating,
    non_terminating::NonTerminating,
    adaptive::Adaptive,
    analog::Analog,
    weighted::Weighted,
    roulette::Roulette,
}
