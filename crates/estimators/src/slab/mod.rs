//! Walks of the single particle model through a slab.

pub mod adaptive;
pub mod analog;
pub mod non_terminating;
pub mod terminating;
pub mod walk;
pub mod weighted;

use super::rod::ByRule;
use crate::recipes::inequality;
use crate::{Kernel, Refusal, Request, Setup, estimators};
use numeric::digits::rounded;
use theory::collisions::particle::RatioRange;
use theory::problems::{Problem, Slab};
use theory::slab::{self, Answer, Existence, Pieces, Walk};
use theory::{ParticleRule, Prediction};

/// The walk of a rule, as theory describes it.
fn walk_of(setup: &Setup<Slab>, rule: ParticleRule) -> Walk {
    let cut = setup.fields.mesh.refined(setup.fields.sampling.knots(), &|_, _| Vec::new());
    let ratio = |t: f64, sigma: f64| {
        if sigma == 0.0 { 0.0 } else { sigma / setup.fields.sampling.value(t) }
    };
    let incidence = setup.problem.incidence;
    let kinks = rule.kinks(setup.problem.albedo);
    Walk {
        incidence,
        albedo: setup.problem.albedo,
        rule,
        pieces: Pieces::new(&setup.fields.mesh, &setup.fields.sampling, &kinks, &[incidence.light]),
        largest_ratio: cut.largest(ratio).map_or(0.0, |(_, ratio)| ratio),
        depth: setup.fields.mesh.optical_depth().value,
        laws: setup.distributions,
    }
}

/// The exact answer; `None` where theory does not resolve it.
fn truth(setup: &Setup<Slab>) -> Option<Answer> {
    let slab = &setup.problem;
    if !slab::resolves(&slab.incidence.phase) {
        return None;
    }
    let answer = slab::cached(&slab.incidence, setup.fields.mesh.optical_depth(), slab.albedo)?;
    let is_known = [answer.reflected, answer.transmitted].into_iter().all(slab::is_sharp);
    is_known.then_some(answer)
}

impl ByRule for Slab {
    fn realisable(setup: &Setup<Self>, rule: ParticleRule) -> Result<(), Refusal> {
        setup.residual().require_coverage()?;
        setup.residual().require_few_collisions("∫σ̂ ≤ 1e6")?;
        if rule.range() != RatioRange::Every {
            let limit = rule.limits(setup.problem.albedo)[1];
            setup.residual().require_ratio_at_most(limit, inequality(rule.range()))?;
        }
        if truth(setup).is_none() {
            let needs = "a reflectance and a transmittance above 1e-70 that adding and doubling resolve \
                         to 1e-4 (a > 0, g ≥ −0.93)";
            let slab = &setup.problem;
            let depth = slab.medium().optical_depth(setup.fields.mesh.support()).value;
            let (albedo, phase) = (slab.albedo, slab.incidence.phase.label());
            let found = format!("a = {albedo}, τ = {}, phase {phase}", rounded(depth));
            return Err(Refusal::mismatch(needs, found));
        }
        let found = match walk_of(setup, rule).second_moment() {
            Existence::Finite => return Ok(()),
            Existence::Diverges => {
                "σ̂ is so far below σ_t that E[X²] diverges: along the layers, or between them"
            }
            Existence::Unknown => {
                "σ̂ is so near to where E[X²] diverges that theory does not tell on which side"
            }
        };
        Err(Refusal::mismatch("a finite variance", found))
    }

    /// Without an answer its values are NaN, and are refused as such.
    fn predict(setup: &Setup<Self>, rule: ParticleRule) -> Prediction {
        walk_of(setup, rule).predict(&truth(setup).unwrap_or(Answer::UNKNOWN))
    }

    fn fill(rule: ParticleRule, kernel: Kernel, setup: &Setup<Self>, request: Request) {
        walk::fill(rule, kernel, setup, request);
    }
}

estimators! {
    Slab on Line:
    terminating::Terminating,
    non_terminating::NonTerminating,
    adaptive::Adaptive,
    analog::Analog,
    weighted::Weighted,
}
