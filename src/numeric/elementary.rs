//! ln, exp, cos and sin as branch-free polynomials: the same bits on every machine.
//!
//! What a draw computes must not depend on the platform's mathematical library, so draws use these
//! and nothing else. Only additions, multiplications and divisions occur, none of them fused, all
//! of them exactly rounded by IEEE 754. Theory code, which is compared within error bounds and
//! never bit by bit, uses the standard library instead.
//!
//! Errors, measured by the tests below over the whole range in use: `ln` 5e-16 relative,
//! `exp` 4e-16 relative, `cos` and `sin` 5e-16 absolute for `|x| ≤ 1e5` (the argument's own
//! rounding, `|x|·1.1e-16`, is not counted).

/// Adding and subtracting `1.5·2^52` rounds a double of size below `2^51` to the nearest integer.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// ln 2 in two parts; the first has 32 trailing zero bits, so that `k·LN_2_HIGH` is exact.
const LN_2_HIGH: f64 = 6.931_471_803_691_238e-1;
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;

/// π in three parts of 33, 33 and 53 bits (the split of fdlibm's π/2, doubled).
const PI_1: f64 = 3.141_592_653_468_251_2;
const PI_2: f64 = 1.215_420_101_260_793_2e-10;
const PI_3: f64 = 4.044_532_497_591_901e-21;

/// `2/(2n + 3)`: `ln` after its first term.
const LN: [f64; 11] = [
    2.0 / 3.0,
    2.0 / 5.0,
    2.0 / 7.0,
    2.0 / 9.0,
    2.0 / 11.0,
    2.0 / 13.0,
    2.0 / 15.0,
    2.0 / 17.0,
    2.0 / 19.0,
    2.0 / 21.0,
    2.0 / 23.0,
];

/// `1/(n + 2)!`: `exp` after its first two terms.
const EXP: [f64; 12] = [
    0.5,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
    1.0 / 479_001_600.0,
    1.0 / 6_227_020_800.0,
];

/// `(−1)^{n+1}/(2n + 2)!`: `cos` after its first term.
const COS: [f64; 10] = [
    -0.5,
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 20_922_789_888_000.0,
    -1.0 / 6_402_373_705_728_000.0,
    1.0 / 2_432_902_008_176_640_000.0,
];

/// `(−1)^{n+1}/(2n + 3)!`: `sin` after its first term.
const SIN: [f64; 10] = [
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 355_687_428_096_000.0,
    -1.0 / 121_645_100_408_832_000.0,
    1.0 / 51_090_942_171_709_440_000.0,
];

/// `Σ cₙ xⁿ`: Horner's rule on the even and on the odd terms apart, so that the processor works on
/// both at once; the order of operations, and so every bit, is fixed by this page.
#[inline(always)]
fn polynomial<const N: usize>(x: f64, c: &[f64; N]) -> f64 {
    let square = x * x;
    let last_even = (N - 1) & !1;
    let last_odd = N - 1 - (N & 1);
    let (mut even, mut odd) = (c[last_even], c[last_odd]);
    let mut n = last_even;
    while n >= 2 {
        n -= 2;
        even = even * square + c[n];
    }
    let mut n = last_odd;
    while n >= 3 {
        n -= 2;
        odd = odd * square + c[n];
    }
    even + x * odd
}

/// Natural logarithm of a positive, normal double.
///
/// ```text
/// x = m·2^k, √½ ≤ m < √2;  s = (m − 1)/(m + 1);  ln x = k ln 2 + 2s(1 + s²/3 + s⁴/5 + …)
/// ```
#[inline(always)]
#[must_use]
#[allow(clippy::cast_possible_wrap, clippy::cast_sign_loss)] // an exponent fits in 12 bits
pub fn ln(x: f64) -> f64 {
    // √½ has the bits 0x3fe6a09e…: subtracting them moves the cut between exponents there.
    let bits = x.to_bits();
    let shifted = bits.wrapping_sub(0x3fe6_a09e_667f_3bcd);
    let k = (shifted as i64) >> 52;
    let m = f64::from_bits(bits.wrapping_sub((k as u64) << 52));
    let s = (m - 1.0) / (m + 1.0);
    let z = s * s;
    let p = polynomial(z, &LN);
    // 2s + s·z·p keeps the rounding of the correction far below that of 2s.
    let k = k as f64;
    k * LN_2_HIGH + (2.0 * s + (s * z * p + k * LN_2_LOW))
}

/// `e^x`; zero below −708, infinite above 709.
///
/// ```text
/// k = round(x / ln 2), f = x − k ln 2, |f| ≤ 0.347;  e^x = 2^k Σ f^n / n!, n ≤ 13
/// ```
#[inline(always)]
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // |k| ≤ 1024 here
pub fn exp(x: f64) -> f64 {
    if x < -708.0 {
        return 0.0;
    }
    if x > 709.0 {
        return f64::INFINITY;
    }
    let k = (x * std::f64::consts::LOG2_E + ROUNDER) - ROUNDER;
    let f = (x - k * LN_2_HIGH) - k * LN_2_LOW;
    let p = polynomial(f, &EXP) * f * f + f;
    // 2^k in two steps: k = 1024 has no double of its own.
    let half = (k * 0.5 + ROUNDER) - ROUNDER;
    let two = |n: f64| f64::from_bits(((n as i64 + 1023) as u64) << 52);
    (1.0 + p) * two(half) * two(k - half)
}

/// `x` less the nearest multiple of π, and that multiple's parity as a factor ±1.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // |k| < 2^51
fn reduce_by_pi(x: f64) -> (f64, f64) {
    let k = (x * std::f64::consts::FRAC_1_PI + ROUNDER) - ROUNDER;
    let f = ((x - k * PI_1) - k * PI_2) - k * PI_3;
    let odd = (k as i64 & 1) as u64;
    (f, f64::from_bits(1.0f64.to_bits() | (odd << 63)))
}

/// `cos x` for `|x| < 1e9` radians.
///
/// ```text
/// f = x − kπ, |f| ≤ π/2;  cos x = (−1)^k Σ (−1)^n f^{2n} / (2n)!, n ≤ 10
/// ```
#[inline(always)]
#[must_use]
pub fn cos(x: f64) -> f64 {
    let (f, sign) = reduce_by_pi(x);
    let z = f * f;
    let p = polynomial(z, &COS);
    sign * (1.0 + p * z)
}

/// `sin x` for `|x| < 1e9` radians.
///
/// ```text
/// f = x − kπ, |f| ≤ π/2;  sin x = (−1)^k Σ (−1)^n f^{2n+1} / (2n+1)!, n ≤ 10
/// ```
#[inline(always)]
#[must_use]
pub fn sin(x: f64) -> f64 {
    let (f, sign) = reduce_by_pi(x);
    let z = f * f;
    let p = polynomial(z, &SIN);
    sign * (f + f * z * p)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A deterministic scatter of points over `[low, high]`.
    fn scatter(low: f64, high: f64) -> impl Iterator<Item = f64> {
        (0..200_000).map(move |i| {
            let u = (f64::from(i) * 0.618_033_988_749_894_9).fract();
            low + (high - low) * u
        })
    }

    #[test]
    fn ln_is_relatively_exact_down_to_the_smallest_uniform() {
        for y in scatter(-37.0, 37.0) {
            let x = y.exp();
            let exact = libm::log(x);
            assert!((ln(x) - exact).abs() <= 5e-16 * exact.abs(), "ln({x})");
        }
        for n in 1..2000 {
            let x = 1.0 - f64::from(n) * f64::EPSILON / 2.0;
            let exact = libm::log(x);
            assert!((ln(x) - exact).abs() <= 5e-16 * exact.abs(), "ln({x})");
        }
        assert_eq!(ln(1.0), 0.0);
    }

    #[test]
    fn exp_is_relatively_exact() {
        for x in scatter(-700.0, 700.0).chain(scatter(-2.0, 2.0)) {
            let exact = libm::exp(x);
            assert!((exp(x) - exact).abs() <= 4e-16 * exact, "exp({x})");
        }
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(exp(-1e9), 0.0);
    }

    #[test]
    fn cos_and_sin_are_exact_to_5e_16() {
        for x in scatter(-1e5, 1e5).chain(scatter(-10.0, 10.0)) {
            assert!((cos(x) - libm::cos(x)).abs() <= 5e-16, "cos({x})");
            assert!((sin(x) - libm::sin(x)).abs() <= 5e-16, "sin({x})");
        }
        assert_eq!(cos(0.0), 1.0);
        assert_eq!(sin(0.0), 0.0);
    }
}
