//! Scattering points through the main part of the extinction: a control of straight pieces.
//!
//! ```text
//! p(s) = σ_m(s) e^{−∫₀ˢ σ_m} / (1 − e^{−τ_m}),   ∫₀ˢ σ_m = −ln(1 − u(1 − e^{−τ_m}))
//! ```
//!
//! The inverse has a closed form because the pieces are straight. It needs `σ_m > 0` wherever `σ_t > 0`: otherwise
//! light is missed.

use crate::setup::Residual;
use crate::{Refusal, Setup};
use media::{Control, Piecewise};
use numeric::digits::rounded;
use numeric::{Known, Lane, Span};
use theory::problems::{Problem, SingleScattering};
use theory::single::predict::DENSITY;

/// The main part.
#[derive(Clone, Copy)]
pub struct MainPart<'a> {
    pieces: &'a Piecewise,
    support: Span,
    /// `1 − e^{−τ_m}`.
    absorbed: f64,
}

impl<'a> MainPart<'a> {
    /// The control of a setup; `None` if that has no straight pieces.
    #[inline(always)]
    pub fn of(setup: &'a Setup<SingleScattering>) -> Option<Self> {
        let Control::Pieces(pieces) = &setup.fields.control else { return None };
        let support = setup.problem.medium().support();
        Some(Self { pieces, support, absorbed: 1.0 - setup.fields.control_transmittance() })
    }

    /// The point of a uniform number.
    #[inline(always)]
    pub fn point<L: Lane>(&self, u: L) -> L {
        let depth = -Lane::ln(u.each(1.0) - u * self.absorbed);
        // Rounding may carry the last point past the end.
        self.pieces.flown(depth).or_less(u.each(self.support.to))
    }

    /// Density of [`Self::point`], 1/length.
    #[inline(always)]
    pub fn density<L: Lane>(&self, s: L) -> L {
        let depth = self.pieces.depths(self.support.from, s);
        self.pieces.value(s) * Lane::exp(-depth) / s.each(self.absorbed)
    }

    /// [`Self::point`], out of line where packs are narrow.
    #[inline(always)]
    pub fn outlined_point<L: Lane>(self, u: L) -> L {
        u.outlined_if_narrow(
            #[inline(always)]
            move || self.point(u),
        )
    }

    /// [`Self::density`], out of line where packs are narrow.
    #[inline(always)]
    pub fn outlined_density<L: Lane>(self, s: L) -> L {
        s.outlined_if_narrow(
            #[inline(always)]
            move || self.density(s),
        )
    }

    #[inline(always)]
    fn depth(&self, s: f64) -> Known {
        let before = Span::new(self.support.from, s);
        media::OpticalDepth::optical_depth(self.pieces, before)
    }

    /// A relative error bound of the density.
    pub fn blur(&self, s: f64) -> f64 {
        DENSITY + self.depth(s).error
    }
}

/// Checks that the control consists of straight pieces that are nowhere negative, and not zero throughout.
///
/// # Errors
///
/// What the control is instead.
pub fn require_straight(setup: &Setup<SingleScattering>) -> Result<(), Refusal> {
    let needs = "a control of straight pieces, as `explorers`, `mean` or `constant`";
    let Control::Pieces(pieces) = &setup.fields.control else {
        let actual =
            if setup.fields.control.is_none() { "there is none" } else { "it is another field" };
        return Err(Refusal::mismatch(needs, actual));
    };
    let (lowest, highest) = pieces
        .corner_values()
        .fold((f64::INFINITY, 0.0f64), |(low, high), value| (low.min(value), high.max(value)));
    // The end of a line that falls to 0 is rounded.
    if lowest < -ROUNDING * highest {
        return Err(Refusal::mismatch(
            "a control σ_m ≥ 0",
            format!("it falls to {}", rounded(lowest)),
        ));
    }
    let absorbed = 1.0 - setup.fields.control_transmittance();
    if setup.fields.control.optical_depth(setup.fields.mesh.support()).value == 0.0 {
        return Err(Refusal::mismatch("a control σ_m > 0 somewhere", "it is zero throughout"));
    }
    if absorbed < THINNEST {
        // Below it 1 − e^{−τ_m} has too few digits to place points.
        let needs = "a control with ∫σ_m ≥ 1e-6";
        return Err(Refusal::mismatch(needs, format!("1 − exp(−∫σ_m) = {absorbed:e}")));
    }
    Ok(())
}

/// Maximum depth below 0 of the corner of a line, relative to its maximum.
const ROUNDING: f64 = 1e-12;

/// Minimum `1 − e^{−τ_m}`: below it too few digits are left to place points.
const THINNEST: f64 = 1e-6;

/// Checks that the control consists of straight pieces that are positive wherever σ_t is.
///
/// # Errors
///
/// What the control is instead, or where it is zero.
pub fn require(setup: &Setup<SingleScattering>) -> Result<(), Refusal> {
    require_straight(setup)?;
    let Control::Pieces(pieces) = &setup.fields.control else { return Ok(()) };
    let sampling = &pieces.on(setup.fields.mesh.support());
    let as_sampling = Residual { sampling, control: &Control::None, ..setup.residual() };
    as_sampling.require_coverage().map_err(|refusal| match refusal {
        Refusal::Inequality { at, .. } => Refusal::Inequality {
            needs: "a control σ_m > 0 wherever σ_t > 0".into(),
            actual: "σ_m = 0 while σ_t is not".into(),
            at,
        },
        other => other,
    })
}
