//! Mistakes with the control.
//!
//! ```text
//! X = T_c ∏ (1 − (σ_t(tᵢ) − σ_c(tᵢ))/σ̂(tᵢ)),  T_c = exp(−∫₀^S σ_c)
//! ```
//!
//! `T_c` belongs to the whole ray, beyond the last collision too, and the σ_c of the lookups is the
//! one whose integral `T_c` holds: the bias is the mismatch of the two integrals in the exponent.

use super::Mutant;
use super::fault::{Fault, RIGHT};
use super::target::{DEEP, EXPLORERS, NEGATIVE};
use super::walk::product;
use media::{Control, Piecewise};
use numeric::{Lane, Span};
use theory::problems::Transmittance;
use theory::rules::Weight;

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    vec![
        product("control-forgotten", "T_c is left out of the draw", NEGATIVE, "mean", Weight, FORGOTTEN),
        product("control-to-last-collision", "the control is integrated up to the last collision only", NEGATIVE, "mean", Weight, TO_LAST_COLLISION),
        product("control-riemann", "∫σ_c is a sum of eight left values", EXPLORERS, "mean", Weight, RIEMANN),
        product("control-wrong-sign", "the residual is σ_t + σ_c", NEGATIVE, "mean", Weight, WRONG_SIGN),
        product("control-in-front-only", "T_c multiplies the draw, but the lookups do not subtract σ_c", NEGATIVE, "mean", Weight, IN_FRONT_ONLY),
        product("control-twice", "T_c is multiplied in twice", NEGATIVE, "mean", Weight, TWICE),
        product("control-nearest", "σ_c is that of the nearest knot in the lookups and linear in the integral", EXPLORERS, "variance", Weight, NEAREST),
        product("control-of-last-collision", "σ_c is looked up at the collision before", EXPLORERS, "mean", Weight, OF_LAST_COLLISION),
        product("control-underflow", "T_c is computed in single precision and underflows", DEEP, "mean", Weight, UNDERFLOW),
    ]
}

/// `T_c = 1`.
const FORGOTTEN: Fault = Fault { prepare: |setup| *setup.control_transmittance = 1.0, ..RIGHT };

/// `T_c = exp(−∫₀^{t_N} σ_c)`.
const TO_LAST_COLLISION: Fault = Fault {
    end: |memory, control, weight| {
        let rest = control.optical_depth(Span::new(memory.from, memory.support.to));
        weight * Lane::exp(rest.value)
    },
    ..RIGHT
};

/// `T_c = exp(−h Σ σ_c(jh))`.
const RIEMANN: Fault = Fault {
    prepare: |setup| {
        let support = setup.mesh.support();
        let step = support.length() / 8.0;
        let left = |j: u32| setup.control.extinction(support.from + f64::from(j) * step);
        let depth = step * (0..8).map(left).sum::<f64>();
        *setup.control_transmittance = Lane::exp(-depth);
    },
    ..RIGHT
};

/// `r = (σ_t + σ_c)/σ̂`.
const WRONG_SIGN: Fault = Fault { control: |_, control, t| -control.extinction(t), ..RIGHT };

/// `r = σ_t/σ̂`.
const IN_FRONT_ONLY: Fault = Fault { control: |_, _, _| 0.0, ..RIGHT };

/// `T_c²`.
const TWICE: Fault = Fault {
    end: |memory, control, weight| weight * Lane::exp(-control.optical_depth(memory.support).value),
    ..RIGHT
};

/// Steps between the middles of the knots: by the trapezoidal rule their integral is that of the
/// lines, so that the mean stays and the variance does not.
const NEAREST: Fault = Fault {
    prepare: |setup| {
        let Control::Pieces(lines) = &*setup.control else { return };
        let knots = lines.knots();
        let (first, last) = (knots[0], knots[knots.len() - 1]);
        let middles = Span::between(knots).map(Span::middle);
        let breaks: Vec<f64> =
            std::iter::once(first).chain(middles).chain(std::iter::once(last)).collect();
        let values: Vec<f64> = knots.iter().map(|&knot| lines.value(knot)).collect();
        *setup.control = Control::Pieces(Piecewise::steps(&breaks, &values));
    },
    ..RIGHT
};

/// `r = (σ_t(tᵢ) − σ_c(tᵢ₋₁))/σ̂`.
const OF_LAST_COLLISION: Fault =
    Fault { control: |memory, control, _| control.extinction(memory.from), ..RIGHT };

/// `T_c` through a number of 32 bits: 0 beyond an optical depth of 104, and already without its
/// last bits beyond 87.
#[allow(clippy::cast_possible_truncation)] // the bug
const UNDERFLOW: Fault = Fault {
    prepare: |setup| {
        *setup.control_transmittance = f64::from(*setup.control_transmittance as f32);
    },
    ..RIGHT
};
