//! Catoni's influence function, summed over draws without a logarithm per draw.
//!
//! ```text
//! ψ(t) = sign(t) ln(1 + |t| + t²/2),   Σᵢ ψ(a yᵢ + b)
//! e^{ψ(t)} ≤ 1 + t + t²/2 for every t
//! ```
//!
//! ψ grows like a logarithm, so that no single draw decides, and its exponential is bounded by a
//! parabola, so that sums of it are evidence for any law with a known variance. The sum is kept as
//! two running products, one over `t > 0` and one over `t < 0`; their exponents are split off every
//! 64 draws. The lanes are fixed, so that the same draws give the same bits on every machine.
//!
//! Source: O. Catoni, *Challenging the empirical mean and empirical variance: a deviation study*,
//! Annales de l'Institut Henri Poincaré B 48 (2012), 1148–1185, Eq. 2.1.

use fearless_simd::{Level, Simd, dispatch};

const LANES: usize = 8;
/// Draws between two splits of the exponents: eight factors to a lane, each below 1e38.
const FLUSH: usize = 64;
const MANTISSA: u64 = 0x000f_ffff_ffff_ffff;
const ONE: u64 = 0x3ff0_0000_0000_0000;
const INFINITE: i64 = 0x7ff;

/// ψ itself.
#[must_use]
pub fn psi(t: f64) -> f64 {
    let size = t.abs();
    // Beyond 1e100 only the square counts, and would overflow.
    let ln = if size > 1e100 {
        2.0 * size.ln() - std::f64::consts::LN_2
    } else {
        (size * (1.0 + 0.5 * size)).ln_1p()
    };
    ln.copysign(t)
}

/// The argument `a y + b` of one sum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Argument {
    /// a.
    pub slope: f64,
    /// b.
    pub shift: f64,
}

/// `N` sums of ψ over the same draws, each with its own argument.
#[derive(Debug, Clone, Copy)]
pub struct PsiSums<const N: usize> {
    products: [Product; N],
}

/// `∏ (1 + |t| + t²/2)^{sign t}`: mantissas in lanes, exponents apart.
#[derive(Debug, Clone, Copy)]
struct Product {
    above: [f64; LANES],
    below: [f64; LANES],
    exponent: [i64; LANES],
    /// The logarithm of what was too large for a product.
    large: f64,
}

impl<const N: usize> Default for PsiSums<N> {
    fn default() -> Self {
        let one = [1.0; LANES];
        let product = Product { above: one, below: one, exponent: [0; LANES], large: 0.0 };
        Self { products: [product; N] }
    }
}

impl<const N: usize> PsiSums<N> {
    /// Adds draws.
    pub fn absorb(&mut self, y: &[f64], arguments: &[Argument; N]) {
        let level = Level::new();
        dispatch!(level, simd => simd.vectorize(
            #[inline(always)]
            || absorb_all(&mut self.products, y, arguments)
        ));
    }

    /// The sums.
    #[must_use]
    pub fn totals(&self) -> [f64; N] {
        self.products.map(|product| {
            let mantissas: f64 =
                product.above.iter().zip(&product.below).map(|(a, b)| a.ln() - b.ln()).sum();
            let exponents: i64 = product.exponent.iter().sum();
            mantissas + exponents as f64 * std::f64::consts::LN_2 + product.large
        })
    }
}

#[inline(always)]
fn absorb_all<const N: usize>(products: &mut [Product; N], y: &[f64], arguments: &[Argument; N]) {
    for chunk in y.chunks(FLUSH) {
        for (product, &argument) in products.iter_mut().zip(arguments) {
            product.absorb(chunk, argument);
        }
    }
}

/// `1 + t + t²/2` for `t ≥ 0`.
#[inline(always)]
fn factor(t: f64) -> f64 {
    (0.5 * t + 1.0) * t + 1.0
}

impl Product {
    #[inline(always)]
    fn absorb(&mut self, chunk: &[f64], argument: Argument) {
        let (mut above, mut below) = (self.above, self.below);
        let (rows, rest) = chunk.as_chunks::<LANES>();
        for row in rows {
            for lane in 0..LANES {
                let t = argument.slope * row[lane] + argument.shift;
                let up = if t > 0.0 { t } else { 0.0 };
                above[lane] *= factor(up);
                below[lane] *= factor(up - t);
            }
        }
        for (lane, y) in rest.iter().enumerate() {
            let t = argument.slope * y + argument.shift;
            let up = if t > 0.0 { t } else { 0.0 };
            above[lane] *= factor(up);
            below[lane] *= factor(up - t);
        }
        let mut largest = 0;
        let mut exponent = self.exponent;
        for lane in 0..LANES {
            let (a, b) = (split(&mut above[lane]), split(&mut below[lane]));
            exponent[lane] += a - b;
            largest = largest.max(a).max(b);
        }
        if largest < INFINITE {
            (self.above, self.below, self.exponent) = (above, below, exponent);
        } else {
            let terms = chunk.iter().map(|y| psi(argument.slope * y + argument.shift));
            self.large += terms.sum::<f64>();
        }
    }
}

/// Brings a positive number into [1, 2) and answers its (biased) exponent.
#[inline(always)]
#[allow(clippy::cast_possible_wrap)] // an exponent has eleven bits
fn split(x: &mut f64) -> i64 {
    let bits = x.to_bits();
    *x = f64::from_bits((bits & MANTISSA) | ONE);
    (bits >> 52) as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    const ARGUMENTS: [Argument; 3] = [
        Argument { slope: 1.0, shift: 0.0 },
        Argument { slope: -0.3, shift: 0.01 },
        Argument { slope: 16.0, shift: 0.0 },
    ];

    fn agree(y: &[f64]) {
        let mut sums = PsiSums::<3>::default();
        sums.absorb(y, &ARGUMENTS);
        for (found, argument) in sums.totals().iter().zip(ARGUMENTS) {
            let terms = || y.iter().map(|y| psi(argument.slope * y + argument.shift));
            let (expected, size) = (terms().sum::<f64>(), terms().map(f64::abs).sum::<f64>());
            assert!((found - expected).abs() <= 1e-13 * (1.0 + size), "{found} {expected}");
        }
    }

    #[test]
    fn products_are_sums_of_logarithms() {
        agree(&[]);
        agree(&[0.7]);
        agree(&(0..1000).map(|i| (f64::from(i) * 0.37).sin() * 2.0).collect::<Vec<_>>());
        agree(&(0..64).map(|i| 10f64.powi(i - 32)).collect::<Vec<_>>());
    }

    #[test]
    fn huge_draws_do_not_overflow() {
        agree(&[1e300, -1e200, 1e80, 1e80, -1e80, 3.0]);
        agree(&[1e60; 64]);
        agree(&[1e300; 200]);
    }

    #[test]
    fn psi_is_odd_and_below_the_parabola() {
        for i in -400..=400 {
            let t = 0.05 * f64::from(i);
            assert_eq!(psi(-t), -psi(t));
            assert!(psi(t).exp() <= (1.0 + t + 0.5 * t * t) * (1.0 + 1e-14), "{t}");
        }
    }
}
