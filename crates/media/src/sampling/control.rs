//! The part of a medium that is integrated exactly.

use super::Piecewise;
use crate::{Extinction, Medium, OpticalDepth};
use numeric::{Known, Lane, Span};

/// A control variate `σ_c(t)`: any field with a closed-form optical depth, or none.
///
/// The transmittance factors as `T = T_c · T_residual` with `T_c = exp(−∫σ_c)`; only the residual `σ_t − σ_c`, of
/// either sign, is estimated.
#[derive(Clone)]
pub enum Control {
    /// `σ_c = 0`.
    None,
    /// Straight pieces: constant, mean, minimum, explorers.
    Pieces(Piecewise),
    /// A further field of the catalogue on the same ray.
    Field(Medium),
}

impl Control {
    /// `σ_c(t)` in 1/length.
    #[inline(always)]
    pub fn extinction<L: Lane>(&self, t: L) -> L {
        match self {
            Self::None => t.each(0.0),
            Self::Pieces(pieces) => match pieces.single_value() {
                Some(value) => t.each(value),
                None => pieces.extinction(t),
            },
            // One by one: kernels are not compiled for every pair of fields.
            Self::Field(field) => t.map(|t| field.extinction(t)),
        }
    }

    /// The value, where there is only one.
    pub fn single_value(&self) -> Option<f64> {
        match self {
            Self::None => Some(0.0),
            Self::Pieces(pieces) => pieces.single_value(),
            Self::Field(_) => None,
        }
    }

    /// `∫σ_c` over a span inside the medium's support.
    pub fn optical_depth(&self, span: Span) -> Known {
        match self {
            Self::None => Known::new(0.0, 0.0),
            Self::Pieces(pieces) => pieces.optical_depth(span),
            Self::Field(field) => field.optical_depth(span),
        }
    }

    /// `∫σ_c` from one distance to others.
    #[inline(always)]
    pub fn depths<L: Lane>(&self, from: f64, to: L) -> L {
        match self {
            Self::None => to.each(0.0),
            Self::Pieces(pieces) => pieces.depths(from, to),
            Self::Field(field) => to.map(|to| field.optical_depth(Span::new(from, to)).value),
        }
    }

    /// The kinks of the control, in any order.
    pub fn breaks(&self) -> Vec<f64> {
        match self {
            Self::None => Vec::new(),
            Self::Pieces(pieces) => pieces.knots().to_vec(),
            Self::Field(field) => {
                let support = field.support();
                let mut breaks = field.breaks();
                breaks.extend([support.from, support.to]);
                breaks
            }
        }
    }

    /// Returns whether there is no control.
    pub fn is_none(&self) -> bool {
        matches!(self, Self::None)
    }
}
