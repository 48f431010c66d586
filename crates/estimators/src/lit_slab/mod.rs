//! Estimators of the light behind a slab, by one scattering.

pub mod directional_mis;
pub mod full_mis;
pub mod next_event;
pub mod unidirectional;
pub mod walk;

use super::lit_rod::Lit;
use crate::recipes::inequality;
use crate::{Kernel, Refusal, Request, Setup, estimators};
use theory::light::{Combination, Techniques};
use theory::problems::LitSlab;
use theory::slab::lit;
use theory::{ParticleRule, Prediction};

impl Lit for LitSlab {
    fn realisable(setup: &Setup<Self>, techniques: Techniques) -> Result<(), Refusal> {
        let (problem, rule) = (&setup.problem, ParticleRule::Analog);
        if problem.albedo <= 0.0 {
            return Err(Refusal::mismatch("an albedo above 0", "a = 0: nothing is scattered"));
        }
        if !problem.light.can_be_hit() && techniques.combination == Combination::Unidirectional {
            let actual =
                "no direction that is drawn meets this one: unidirectional tracking finds nothing";
            return Err(Refusal::mismatch("a light with a size", actual));
        }
        setup.residual().require_few_collisions("∫σ̂ ≤ 1e6")?;
        setup
            .residual()
            .require_ratio_at_most(rule.limits(problem.albedo)[1], inequality(rule.range()))?;
        lit::slant_depth(&setup.fields.mesh, problem).map_or(Ok(()), |depth| {
            Err(Refusal::mismatch("τ/μ ≤ 64 in the lowest direction", format!("τ/μ = {depth:e}")))
        })
    }

    fn predict(setup: &Setup<Self>, techniques: Techniques) -> Prediction {
        let (mesh, problem, sampling) =
            (&setup.fields.mesh, &setup.problem, &setup.fields.sampling);
        lit::predict(mesh, problem, sampling, techniques, setup.distributions)
    }

    fn fill(techniques: Techniques, kernel: Kernel, setup: &Setup<Self>, request: Request) {
        let techniques = lit::possible(techniques, setup.problem.light);
        walk::fill(techniques, kernel, setup, request);
    }
}

estimators! {
    LitSlab on Line:
    unidirectional::Unidirectional,
    next_event::NextEvent,
    directional_mis::DirectionalMis,
    full_mis::FullMis,
}
