//! Mistakes with the control.
//!
//! ```text
//! X = T_c ∏ (1 − (σ_t(tᵢ) − σ_c(tᵢ))/σ̂(tᵢ)),  T_c = exp(−∫₀^S σ_c)
//! ```
//!
//! `T_c` belongs to the whole ray, beyond the last collision too, and the σ_c of the lookups is the
//! one whose integral `T_c` holds: the bias is the mismatch of the two integrals in the exponent.

use super::fault::{Fault, Memory};
use super::target::{DEEP, EXPLORERS, NEGATIVE};
use super::walk::product;
use super::{Mutant, Target};
use crate::estimators::Setup;
use crate::estimators::rules::Weight;
use crate::media::{Control, Piecewise};
use crate::numeric::{Lane, Span};
use crate::problems::{Problem, Transmittance};

/// The family.
#[must_use]
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    fn on<F: Fault>(target: Target, name: &'static str, check: &'static str, fault: F, bug: &'static str) -> Mutant<Transmittance> {
        product(name, bug, target, check, Weight, fault)
    }
    vec![
        on(NEGATIVE, "control-forgotten", "mean", Forgotten,
            "T_c is left out of the draw"),
        on(NEGATIVE, "control-to-last-collision", "mean", ToLastCollision,
            "the control is integrated up to the last collision only"),
        on(EXPLORERS, "control-riemann", "mean", Riemann,
            "∫σ_c is a sum of eight left values"),
        on(NEGATIVE, "control-wrong-sign", "mean", WrongSign,
            "the residual is σ_t + σ_c"),
        on(NEGATIVE, "control-in-front-only", "mean", InFrontOnly,
            "T_c multiplies the draw, but the lookups do not subtract σ_c"),
        on(NEGATIVE, "control-twice", "mean", Twice,
            "T_c is multiplied in twice"),
        on(EXPLORERS, "control-nearest", "variance", Nearest,
            "σ_c is that of the nearest knot in the lookups and linear in the integral"),
        on(EXPLORERS, "control-of-last-collision", "mean", OfLastCollision,
            "σ_c is looked up at the collision before"),
        on(DEEP, "control-underflow", "mean", Underflow,
            "T_c is computed in single precision and underflows"),
    ]
}

/// `T_c = 1`.
#[derive(Clone, Copy)]
struct Forgotten;

impl Fault for Forgotten {
    fn prepare<P: Problem>(&self, setup: Setup<P>) -> Setup<P> {
        Setup { control_transmittance: 1.0, ..setup }
    }
}

/// `T_c = exp(−∫₀^{t_N} σ_c)`.
#[derive(Clone, Copy)]
struct ToLastCollision;

impl Fault for ToLastCollision {
    fn end(&self, memory: &mut Memory, control: &Control, weight: f64) -> f64 {
        let rest = control.optical_depth(Span::new(memory.from, memory.support.to));
        weight * Lane::exp(rest.value)
    }
}

/// `T_c = exp(−h Σ σ_c(jh))`.
#[derive(Clone, Copy)]
struct Riemann;

impl Fault for Riemann {
    fn prepare<P: Problem>(&self, setup: Setup<P>) -> Setup<P> {
        let support = setup.mesh.support();
        let step = support.length() / 8.0;
        let left = |j: u32| setup.control.extinction(support.from + f64::from(j) * step);
        let depth = step * (0..8).map(left).sum::<f64>();
        Setup { control_transmittance: Lane::exp(-depth), ..setup }
    }
}

/// `r = (σ_t + σ_c)/σ̂`.
#[derive(Clone, Copy)]
struct WrongSign;

impl Fault for WrongSign {
    fn control(&self, _: &Memory, control: &Control, t: f64) -> f64 {
        -control.extinction(t)
    }
}

/// `r = σ_t/σ̂`.
#[derive(Clone, Copy)]
struct InFrontOnly;

impl Fault for InFrontOnly {
    fn control(&self, _: &Memory, _: &Control, _: f64) -> f64 {
        0.0
    }
}

/// `T_c²`.
#[derive(Clone, Copy)]
struct Twice;

impl Fault for Twice {
    fn end(&self, memory: &mut Memory, control: &Control, weight: f64) -> f64 {
        weight * Lane::exp(-control.optical_depth(memory.support).value)
    }
}

/// Steps between the middles of the knots: by the trapezoidal rule their integral is that of the
/// lines, so that the mean stays and the variance does not.
#[derive(Clone, Copy)]
struct Nearest;

impl Fault for Nearest {
    fn prepare<P: Problem>(&self, setup: Setup<P>) -> Setup<P> {
        let Control::Pieces(lines) = &setup.control else { return setup };
        let knots = lines.knots();
        let (first, last) = (knots[0], knots[knots.len() - 1]);
        let middles = knots.windows(2).map(|ends| 0.5 * (ends[0] + ends[1]));
        let breaks: Vec<f64> =
            std::iter::once(first).chain(middles).chain(std::iter::once(last)).collect();
        let values: Vec<f64> = knots.iter().map(|&knot| lines.value(knot)).collect();
        Setup { control: Control::Pieces(Piecewise::steps(&breaks, &values)), ..setup }
    }
}

/// `r = (σ_t(tᵢ) − σ_c(tᵢ₋₁))/σ̂`.
#[derive(Clone, Copy)]
struct OfLastCollision;

impl Fault for OfLastCollision {
    fn control(&self, memory: &Memory, control: &Control, _: f64) -> f64 {
        control.extinction(memory.from)
    }
}

/// `T_c` through a number of 32 bits: 0 beyond an optical depth of 104, and already without its
/// last bits beyond 87.
#[derive(Clone, Copy)]
struct Underflow;

impl Fault for Underflow {
    #[allow(clippy::cast_possible_truncation)] // the bug
    fn prepare<P: Problem>(&self, setup: Setup<P>) -> Setup<P> {
        let control_transmittance = f64::from(setup.control_transmittance as f32);
        Setup { control_transmittance, ..setup }
    }
}
