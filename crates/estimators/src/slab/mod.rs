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
use numeric::Known;
use numeric::digits::{number, short};
use theory::collisions::particle::RatioRange;
use theory::problems::Slab;
use theory::problems::channels::End;
use theory::problems::slab::Incidence;
use theory::slab::{self, EnergyBounds, Existence, Pieces, Resolution, SlabWalk};
use theory::{ParticleRule, Prediction};

/// The walk of a rule, as theory describes it.
fn walk_of(setup: &Setup<Slab>, rule: ParticleRule) -> SlabWalk {
    let cut = setup.fields.mesh.refined(setup.fields.sampling.knots(), &|_, _| Vec::new());
    let ratio = |t: f64, sigma: f64| {
        if sigma == 0.0 { 0.0 } else { sigma / setup.fields.sampling.value(t) }
    };
    let incidence = setup.problem.incidence;
    let kinks = rule.kinks(setup.problem.albedo);
    SlabWalk {
        incidence,
        albedo: setup.problem.albedo,
        rule,
        pieces: Pieces::new(&setup.fields.mesh, &setup.fields.sampling, &kinks, &[incidence.light]),
        largest_ratio: cut.largest(&ratio).map_or(0.0, |(_, ratio)| ratio),
        depth: setup.fields.mesh.optical_depth().value,
        with_distributions: setup.distributions,
    }
}

/// Checks that theory knows what leaves a slab at some ends to 1e-4. `channel` follows the reason.
///
/// # Errors
///
/// The limit that is exceeded, and the value that exceeds it.
pub fn require_answer(
    incidence: &Incidence,
    depth: Known,
    albedo: f64,
    ends: &[End],
    channel: &str,
) -> Result<(), Refusal> {
    let phase = &incidence.phase;
    let refused = |needs, actual: String| Err(Refusal::mismatch(needs, actual + channel));
    if albedo > 0.0 && !slab::resolves(phase) {
        let needs = "a phase function that 144 directions resolve, or that peaks forward (Henyey–Greenstein of g ≥ −0.93)";
        return refused(needs, format!("phase {}", phase.label()));
    }
    let place = format!("a = {}, τ = {}", number(albedo), number(depth.value));
    let Some(answer) = slab::cached(incidence, depth, albedo) else {
        return refused("a reflectance and a transmittance that are finite", place);
    };
    for end in ends {
        let is_reflected = *end == End::Reflected;
        let known = if is_reflected { answer.reflected } else { answer.transmitted };
        if known.value < slab::FAINT {
            let needs = if is_reflected {
                "a reflectance above 1e-70"
            } else {
                "a transmittance above 1e-70"
            };
            return refused(needs, format!("it is {} at {place}", short(known.value, 3)));
        }
        if !slab::is_sharp(known) {
            let needs = if is_reflected {
                "a reflectance that adding and doubling resolve to 1e-4"
            } else {
                "a transmittance that adding and doubling resolve to 1e-4"
            };
            let error = short(known.relative_error(), 2);
            let limit = if Resolution::FINE.cuts(phase) {
                format!("the forward peak of phase {} is cut off", phase.label())
            } else if depth.value < 1.0 {
                "light grazes in so thin a slab".to_owned()
            } else {
                "rounding adds up in so thick a slab".to_owned()
            };
            return refused(needs, format!("its relative error is {error} at {place}: {limit}"));
        }
    }
    Ok(())
}

/// Names a channel at the end of a sentence.
pub fn in_channel(channel: usize) -> String {
    format!(", in channel {}", channel + 1)
}

impl ByRule for Slab {
    fn realisable(setup: &Setup<Self>, rule: ParticleRule) -> Result<(), Refusal> {
        setup.residual().require_coverage()?;
        setup.residual().require_few_collisions("∫σ̂ ≤ 1e6")?;
        if rule.range() != RatioRange::Every {
            let limit = rule.limits(setup.problem.albedo)[1];
            setup.residual().require_ratio_at_most(limit, inequality(rule.range()))?;
        }
        let (slab, depth) = (&setup.problem, setup.fields.mesh.optical_depth());
        let ends = [End::Reflected, End::Transmitted];
        require_answer(&slab.incidence, depth, slab.albedo, &ends, "")?;
        let actual = match walk_of(setup, rule).second_moment() {
            Existence::Finite => return Ok(()),
            Existence::Diverges => {
                "σ̂ is so far below σ_t that E[X²] diverges: along the layers, or between them"
            }
            Existence::Unknown => {
                "σ̂ is so near to where E[X²] diverges that theory does not tell on which side"
            }
        };
        Err(Refusal::mismatch("a finite variance", actual))
    }

    /// Without an answer its values are NaN, and are refused as such.
    fn predict(setup: &Setup<Self>, rule: ParticleRule) -> Prediction {
        let (slab, depth) = (&setup.problem, setup.fields.mesh.optical_depth());
        let answer = slab::cached(&slab.incidence, depth, slab.albedo);
        walk_of(setup, rule).predict(&answer.unwrap_or(EnergyBounds::UNKNOWN))
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
