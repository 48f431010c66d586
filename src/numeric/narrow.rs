//! Single precision as a lane: what a renderer on a graphics card computes with.
//!
//! Every sum, product, quotient and root is rounded to 24 bits. Logarithm, exponential, sine and cosine
//! are the true values rounded once, better than most hardware has them: what single precision costs
//! here is the least it costs anywhere. Tables, lattice hashes and list positions are as in doubles, and
//! their entries are rounded.
//!
//! Formulas that are generic over [`Lane`] (fields of media, rules of collisions) therefore exist in
//! single precision too. No draw of a run is made of these; `trueflight stress` compares both.

#![allow(clippy::cast_possible_truncation)] // to 24 bits

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{Lane, Row};

/// A number of 24 bits.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Narrow(pub f32);

impl Narrow {
    /// A double, rounded.
    #[must_use]
    pub fn of(x: f64) -> Self {
        Self(x as f32)
    }

    fn wide(self) -> f64 {
        f64::from(self.0)
    }
}

macro_rules! operators {
    ($($Trait:ident::$method:ident),*) => {
        $(
            impl $Trait for Narrow {
                type Output = Self;
                #[inline(always)]
                fn $method(self, other: Self) -> Self {
                    Self($Trait::$method(self.0, other.0))
                }
            }

            impl $Trait<f64> for Narrow {
                type Output = Self;
                #[inline(always)]
                fn $method(self, other: f64) -> Self {
                    Self($Trait::$method(self.0, other as f32))
                }
            }
        )*
    };
}
operators! { Add::add, Sub::sub, Mul::mul, Div::div }

impl Neg for Narrow {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Lane for Narrow {
    type Mask = bool;
    type Words = u64;

    #[inline(always)]
    fn each(self, value: f64) -> Self {
        Self::of(value)
    }

    #[inline(always)]
    fn replaced(self, mut replace: impl FnMut(&mut [f64])) -> Self {
        let mut element = [self.wide()];
        replace(&mut element);
        Self::of(element[0])
    }

    /// Rounded once, as such hardware does; a product of two such numbers is exact in a double, and
    /// the sum with a third is rounded twice only where that is a tie.
    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        Self::of(self.wide() * factor.wide() + term.wide())
    }

    #[inline(always)]
    fn root(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    fn size(self) -> Self {
        Self(self.0.abs())
    }

    #[inline(always)]
    fn below(self, other: Self) -> bool {
        self.0 < other.0
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> bool {
        self.0 <= other.0
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn nearest(self) -> Self {
        Self::of(self.wide().nearest())
    }

    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let (m, k) = self.wide().split();
        (Self::of(m), Self::of(k))
    }

    #[inline(always)]
    fn power_of_two(self) -> Self {
        Self::of(self.wide().power_of_two())
    }

    #[inline(always)]
    fn alternate(self, k: Self) -> Self {
        Self::of(self.wide().alternate(k.wide()))
    }

    #[inline(always)]
    fn words(self) -> u64 {
        self.wide().words()
    }

    #[inline(always)]
    fn where_bits(words: u64, bits: u64, wanted: u64, yes: Self, no: Self) -> Self {
        Self::of(f64::where_bits(words, bits, wanted, yes.wide(), no.wide()))
    }

    #[inline(always)]
    fn negated_where(self, words: u64, bit: u32) -> Self {
        Self::of(self.wide().negated_where(words, bit))
    }

    #[inline(always)]
    fn entry(self, list: &[f64]) -> Self {
        Self::of(self.wide().entry(list))
    }

    #[inline(always)]
    fn columns(self, table: &[Row]) -> [Self; 5] {
        self.wide().columns(table).map(Self::of)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        Self::of(Lane::ln(self.wide()))
    }

    #[inline(always)]
    fn exp(self) -> Self {
        Self::of(Lane::exp(self.wide()))
    }

    #[inline(always)]
    fn cos(self) -> Self {
        Self::of(Lane::cos(self.wide()))
    }

    #[inline(always)]
    fn sin(self) -> Self {
        Self::of(Lane::sin(self.wide()))
    }

    #[inline(always)]
    fn cos_pi_size(self) -> Self {
        Self::of(self.wide().cos_pi_size())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_operation_is_rounded_to_24_bits() {
        let (one, tiny) = (Narrow(1.0), Narrow::of(2f64.powi(-25)));
        assert_eq!((one + tiny).0, 1.0);
        assert_eq!((Narrow(1.0) / Narrow(3.0)).0, 1.0f32 / 3.0);
        assert_eq!((Narrow(16_777_216.0) + 1.0).0, 16_777_216.0);
        assert_eq!(Narrow(2.0).ln().0, std::f32::consts::LN_2);
        // One rounding: (1 + 2⁻²³)² − 1 keeps its last bit.
        let x = Narrow(1.0 + f32::EPSILON);
        assert_eq!(x.times_plus(x, -one).0, 2.0 * f32::EPSILON + f32::EPSILON * f32::EPSILON);
    }

    #[test]
    fn a_field_is_looked_up_in_single_precision() {
        use crate::numeric::elementary;
        let found = elementary::exp(1.0f64);
        assert!((f64::from(Lane::exp(Narrow(1.0)).0) - found).abs() < 1.2e-7);
        assert_ne!(f64::from(Lane::exp(Narrow(1.0)).0), found);
    }
}
