//! Catoni's influence function, summed over draws without a logarithm per draw.
//!
//! ```text
//! ψ(t) = sign(t) ln(1 + |t| + t²/2),   Σᵢ ψ(a yᵢ + b)
//! e^{ψ(t)} ≤ 1 + t + t²/2 for every t
//! ```
//!
//! ψ grows like a logarithm, so that no single draw decides, and its exponential is bounded by a parabola, so that
//! sums of it are evidence for any distribution with a known variance. The sum is kept as two running products, one
//! over `t > 0` and one over `t < 0`. Their exponents are split off every 1024 draws; logarithms are taken where
//! that overflows. The lanes are fixed, so that the width of a machine's registers changes no bit.
//!
//! Source: O. Catoni, *Challenging the empirical mean and empirical variance: a deviation study*,
//! Annales de l'Institut Henri Poincaré B 48 (2012), 1148–1185, Eq. 2.1.

use numeric::Lane;
use numeric::fused::{self, Loop};

const LANES: usize = 8;
/// Draws between two splits of the exponents: a hundred and twenty-eight factors to a lane, which overflow only
/// if their geometric mean exceeds 250.
const FLUSH: usize = 1024;
const MANTISSA: u64 = 0x000f_ffff_ffff_ffff;
const ONE: u64 = 0x3ff0_0000_0000_0000;
const INFINITE: i64 = 0x7ff;
/// Beyond this only the square is significant, and it would overflow.
const LARGE: f64 = 1e100;

/// ψ itself.
pub fn psi(t: f64) -> f64 {
    let size = t.abs();
    let ln = if size > LARGE {
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
    products: [CatoniProduct; N],
}

/// `∏ (1 + |t| + t²/2)^{sign t}`: mantissas in lanes, exponents apart.
#[derive(Debug, Clone, Copy)]
struct CatoniProduct {
    above: [f64; LANES],
    below: [f64; LANES],
    exponent: [i64; LANES],
    /// The logarithm of the factors that are too large for a product.
    large: f64,
}

impl<const N: usize> Default for PsiSums<N> {
    fn default() -> Self {
        let one = [1.0; LANES];
        let product = CatoniProduct { above: one, below: one, exponent: [0; LANES], large: 0.0 };
        Self { products: [product; N] }
    }
}

impl<const N: usize> PsiSums<N> {
    /// Adds draws.
    pub fn absorb(&mut self, y: &[f64], arguments: &[Argument; N]) {
        fused::run(Each { products: &mut self.products, y, arguments });
    }

    /// Adds draws, each with its number of occurrences.
    pub fn absorb_counted(&mut self, y: &[f64], times: &[f64], arguments: &[Argument; N]) {
        fused::run(Counted { products: &mut self.products, y, times, arguments });
    }

    /// The sums.
    pub fn totals(&self) -> [f64; N] {
        self.products.map(|product| {
            let mantissas: f64 =
                product.above.iter().zip(&product.below).map(|(a, b)| a.ln() - b.ln()).sum();
            let exponents: i64 = product.exponent.iter().sum();
            mantissas + exponents as f64 * std::f64::consts::LN_2 + product.large
        })
    }
}

/// Draws with their numbers of occurrences, for all sums.
struct Counted<'a> {
    products: &'a mut [CatoniProduct],
    y: &'a [f64],
    times: &'a [f64],
    arguments: &'a [Argument],
}

impl Loop for Counted<'_> {
    #[inline(always)]
    fn run(self) {
        let (rows, rest) = self.y.as_chunks::<LANES>();
        let (times, last_times) = self.times.as_chunks::<LANES>();
        for (product, argument) in self.products.iter_mut().zip(self.arguments) {
            let mut sums = [0.0; LANES];
            for (row, times) in rows.iter().zip(times) {
                let terms = terms(row, argument);
                for lane in 0..LANES {
                    sums[lane] += times[lane] * terms[lane];
                }
            }
            let lanes: f64 = sums.iter().sum();
            let rest = rest.iter().zip(last_times);
            product.large += lanes + rest.map(|(&y, n)| n * terms(&[y], argument)[0]).sum::<f64>();
        }
    }
}

/// `ψ(a y + b)` by this crate's own logarithm.
#[inline(always)]
fn terms<const N: usize>(y: &[f64; N], argument: &Argument) -> [f64; N] {
    let (mut terms, mut are_small) = ([0.0; N], true);
    for lane in 0..N {
        let t = y[lane] * argument.slope + argument.shift;
        let size = t.abs();
        let ln = Lane::ln((size * 0.5 + 1.0) * size + 1.0);
        terms[lane] = if t < 0.0 { -ln } else { ln };
        are_small &= size <= LARGE;
    }
    // NaN, and numbers with an overflowing square, are summed one by one.
    if !are_small {
        for lane in 0..N {
            let t = y[lane] * argument.slope + argument.shift;
            terms[lane] = if t.abs() <= LARGE { terms[lane] } else { psi(t) };
        }
    }
    terms
}

/// Draws one by one, for all sums.
struct Each<'a, const N: usize> {
    products: &'a mut [CatoniProduct; N],
    y: &'a [f64],
    arguments: &'a [Argument; N],
}

impl<const N: usize> Loop for Each<'_, N> {
    #[inline(always)]
    fn run(self) {
        for chunk in self.y.chunks(FLUSH) {
            // All products in memory before exponents are split off: then a compiler keeps the lanes of each in one register.
            let mut next = *self.products;
            for (next, argument) in next.iter_mut().zip(self.arguments) {
                next.multiply(chunk, argument);
            }
            for (number, next) in next.iter_mut().enumerate() {
                let (product, argument) = (&mut self.products[number], &self.arguments[number]);
                if next.split() {
                    *product = *next;
                } else {
                    let terms = chunk.iter().map(|y| psi(argument.slope * y + argument.shift));
                    product.large += terms.sum::<f64>();
                }
            }
        }
    }
}

/// Twice the factors of the products above and below: one of them the factor, the other 1.
///
/// ```text
/// 2(1 + |t| + t²/2) = (|t| + 1)² + 1
/// ```
///
/// Each product is too large by 2 per draw, which cancels between them.
#[inline(always)]
fn factors(y: f64, argument: &Argument) -> (f64, f64) {
    let t = y.times_plus(argument.slope, argument.shift);
    let root = t.abs() + 1.0;
    let factor = root.times_plus(root, 1.0);
    if t < 0.0 { (2.0, factor) } else { (factor, 2.0) }
}

impl CatoniProduct {
    /// Multiplies by the factors of draws.
    #[inline(always)]
    fn multiply(&mut self, y: &[f64], argument: &Argument) {
        let (rows, rest) = y.as_chunks::<LANES>();
        // Copies for the loop, which keeps them in registers.
        let (mut above, mut below) = (self.above, self.below);
        for row in rows {
            for lane in 0..LANES {
                let (up, down) = factors(row[lane], argument);
                above[lane] *= up;
                below[lane] *= down;
            }
        }
        (self.above, self.below) = (above, below);
        for (lane, &y) in rest.iter().enumerate() {
            let (up, down) = factors(y, argument);
            self.above[lane] *= up;
            self.below[lane] *= down;
        }
    }

    /// Splits the exponents off; `false` where a product has overflowed.
    #[inline(always)]
    fn split(&mut self) -> bool {
        let mut largest = 0;
        for lane in 0..LANES {
            let (a, b) = (split(&mut self.above[lane]), split(&mut self.below[lane]));
            self.exponent[lane] += a - b;
            largest = largest.max(a).max(b);
        }
        largest < INFINITE
    }
}

/// Scales a positive number into [1, 2) and returns its (biased) exponent.
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
        for (result, argument) in sums.totals().iter().zip(ARGUMENTS) {
            let terms = || y.iter().map(|y| psi(argument.slope * y + argument.shift));
            let (expected, size) = (terms().sum::<f64>(), terms().map(f64::abs).sum::<f64>());
            assert!((result - expected).abs() <= 1e-13 * (1.0 + size), "{result} {expected}");
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
    fn counted_draws_are_the_draws_themselves() {
        let y: Vec<f64> = (0..37).map(|i| (f64::from(i) * 0.37).sin() * 2.0).collect();
        let far = [1e99, -1e101, 1e300, 0.0, 1e-300, -1e-9];
        for y in [&y[..], &far, &[]] {
            let times: Vec<u32> = (0..5).cycle().map(|n| n + 1).take(y.len()).collect();
            let counted_times: Vec<f64> = times.iter().map(|&n| f64::from(n)).collect();
            let (mut counted, mut one_by_one) = (PsiSums::<3>::default(), PsiSums::<3>::default());
            counted.absorb_counted(y, &counted_times, &ARGUMENTS);
            for (&y, &times) in y.iter().zip(&times) {
                for _ in 0..times {
                    one_by_one.absorb(&[y], &ARGUMENTS);
                }
            }
            for (a, b) in counted.totals().iter().zip(one_by_one.totals()) {
                assert!((a - b).abs() <= 1e-13 * (1.0 + b.abs()), "{a} {b}");
            }
        }
    }

    #[test]
    fn a_counted_draw_that_is_no_number_is_not_lost() {
        let mut sums = PsiSums::<3>::default();
        sums.absorb_counted(&[0.5, f64::NAN], &[3.0, 1.0], &ARGUMENTS);
        assert!(sums.totals().iter().all(|sum| sum.is_nan()));
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
