//! Double and single precision, as walks use them.

use crate::numeric::{Lane, Narrow as F32};

/// Numbers of 2⁻²⁴.
pub const LATTICE: f64 = 16_777_216.0;

/// A precision.
pub trait Precision: Lane<Mask = bool> {
    /// A uniform number of a word, as renderers make it.
    fn uniform(word: u64) -> Self;
    /// The chance that such a number is below.
    fn chance(self) -> f64;
    /// As a double.
    fn double(self) -> f64;
}

impl Precision for f64 {
    #[inline(always)]
    fn uniform(word: u64) -> Self {
        (word >> 11) as f64 * (0.5 * f64::EPSILON)
    }

    #[inline(always)]
    fn chance(self) -> f64 {
        self.clamp(0.0, 1.0)
    }

    #[inline(always)]
    fn double(self) -> f64 {
        self
    }
}

impl Precision for F32 {
    #[inline(always)]
    fn uniform(word: u64) -> Self {
        Self::of((word >> 40) as f64 / LATTICE)
    }

    #[inline(always)]
    fn chance(self) -> f64 {
        ((f64::from(self.0) * LATTICE).ceil() / LATTICE).clamp(0.0, 1.0)
    }

    #[inline(always)]
    fn double(self) -> f64 {
        f64::from(self.0)
    }
}
