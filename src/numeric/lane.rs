//! The number type that formulas are written in.
//!
//! A field of a medium is one formula, generic over a lane type. Today the only lane is `f64`;
//! packs of several doubles implement the same trait and reuse every formula unchanged. Control
//! flow (loops, early exits) stays scalar and is never written in lanes.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::elementary;

/// A double, or a pack of doubles that is treated element by element.
///
/// `ln`, `exp`, `cos` and `sin` are this crate's own polynomials ([`elementary`]): the same bits
/// in every lane type and on every platform.
pub trait Lane:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// The same value in every element.
    #[must_use]
    fn splat(value: f64) -> Self;

    /// Applies a scalar function to each element, for fields that gather or hash.
    #[must_use]
    fn map(self, f: impl FnMut(f64) -> f64) -> Self;

    /// `e^x`.
    #[must_use]
    fn exp(self) -> Self;

    /// `cos x`, `x` in radians, `|x| < 1e9`.
    #[must_use]
    fn cos(self) -> Self;

    /// `sin x`, `x` in radians, `|x| < 1e9`.
    #[must_use]
    fn sin(self) -> Self;
}

impl Lane for f64 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn map(self, mut f: impl FnMut(f64) -> f64) -> Self {
        f(self)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        elementary::exp(self)
    }

    #[inline(always)]
    fn cos(self) -> Self {
        elementary::cos(self)
    }

    #[inline(always)]
    fn sin(self) -> Self {
        elementary::sin(self)
    }
}
