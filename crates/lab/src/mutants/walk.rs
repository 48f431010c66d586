//! The walks of `estimators/transmittance/product.rs` and `estimators/free_flight/woodcock.rs`, step by step.
//!
//! ```text
//! X = T_c ∏ W(tᵢ),  tᵢ a Poisson process of rate σ̂ on the support
//! s = the first tᵢ with uᵢ < σ_t(tᵢ)/σ̂(tᵢ);  S if there is none
//! ```
//!
//! With [`RIGHT`] they make the estimators' draws, bit for bit. The invariant says what should happen:
//! a survivor of a collision with ratio r and chance q loses `X(1 − (1 − r)/q)`, whatever the
//! fault makes of its weight.

use super::fault::{Fault, Memory, RIGHT};
use super::{About, Mutant, Target, with};
use estimators::transmittance::product::Invariant;
use estimators::{Draw, Setup};
use media::Lookups;
use numeric::rng::Stream;
use theory::problems::{FreeFlight, Problem, Transmittance};
use theory::rules::Collision;

/// A draw of a product estimator with a fault.
#[inline]
pub fn draw_product<R: Collision>(
    (rule, fault): &(R, Fault),
    setup: &Setup<Transmittance>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw {
    let mut cursor = setup.sampling.begin();
    let mut weight = setup.control_transmittance;
    let mut invariant = Invariant::open(weight);
    let mut memory = Memory::new(setup.mesh.support(), weight, rng);
    loop {
        memory.from = cursor.t;
        let depth = (fault.flight)(&mut memory, rng);
        let number = R::DECIDES.then(|| (fault.number)(&mut memory, rng));
        let Some(sampling) = (fault.fly)(&setup.sampling, &mut cursor, depth) else { break };
        let extinction = (fault.look)(&memory, medium, cursor.t);
        let residual = extinction - (fault.control)(&memory, &setup.control, cursor.t);
        memory.lookups += 1;
        let ratio = (fault.ratio)(&setup.sampling, residual, sampling);
        let outcome = (fault.outcome)(rule.outcome(ratio), ratio);
        if outcome.survival < 1.0 {
            let number = number.unwrap_or_else(|| (fault.number)(&mut memory, rng));
            let killed = number >= outcome.survival;
            if (fault.real)(&memory, killed) {
                let defect = invariant.defect(weight);
                return Draw { value: [0.0], lookups: memory.lookups, defect };
            }
        }
        invariant.take(weight, (1.0 - residual * (1.0 / sampling)) / outcome.survival);
        memory.before = weight;
        weight = (fault.weigh)(&memory, weight, outcome.weight);
        if let Some(value) = (fault.stop)(&memory, weight, rng) {
            let defect = invariant.defect(weight);
            return Draw { value: [value], lookups: memory.lookups, defect };
        }
    }
    let value = (fault.end)(&mut memory, &setup.control, weight);
    Draw { value: [value], lookups: memory.lookups, defect: invariant.defect(value) }
}

/// A draw of Woodcock tracking of the free flight with a fault.
#[inline]
fn draw_flight(
    fault: &Fault,
    setup: &Setup<FreeFlight>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw {
    let ray = setup.problem.medium().span();
    let mut cursor = setup.sampling.begin();
    let mut memory = Memory::new(setup.mesh.support(), 1.0, rng);
    loop {
        memory.from = cursor.t;
        let depth = (fault.flight)(&mut memory, rng);
        let number = (fault.number)(&mut memory, rng);
        let Some(sampling) = (fault.fly)(&setup.sampling, &mut cursor, depth) else { break };
        memory.lookups += 1;
        let real = number < (fault.look)(&memory, medium, cursor.t) * (1.0 / sampling);
        if (fault.real)(&memory, real) || (fault.stop)(&memory, 1.0, rng).is_some() {
            return Draw::free([(fault.distance)(ray, cursor.t)], memory.lookups);
        }
    }
    let _ = (fault.end)(&mut memory, &setup.control, 1.0);
    Draw::free([(fault.escape)(&memory, ray)], memory.lookups)
}

/// A product estimator's mutant.
pub fn product<R: Collision>(
    name: &'static str,
    bug: &'static str,
    target: Target,
    check: &'static str,
    rule: R,
    fault: Fault,
) -> Mutant<Transmittance> {
    let about = About { name, bug, target, check };
    let (faulty, honest) = (with((rule, fault), draw_product), with((rule, RIGHT), draw_product));
    Mutant::new(about, faulty, honest).on_faulty_setup(fault)
}

/// A free-flight sampler's mutant.
pub fn flight(
    name: &'static str,
    bug: &'static str,
    target: Target,
    check: &'static str,
    fault: Fault,
) -> Mutant<FreeFlight> {
    let about = About { name, bug, target, check };
    Mutant::new(about, with(fault, draw_flight), with(RIGHT, draw_flight)).on_faulty_setup(fault)
}
