//! ln, exp, cos, sin and atan as branch-free polynomials, written once for every lane type.
//!
//! What a draw computes must not depend on the platform's mathematical library, so draws use these
//! and nothing else. Only additions, multiplications, divisions and fused multiply-adds occur, all
//! of them exactly rounded by IEEE 754: an element of a pack has the bits of the scalar. Theory
//! code, which is compared within error bounds and never bit by bit, uses the standard library
//! instead.
//!
//! The polynomials interpolate at Chebyshev nodes (found in 60-digit arithmetic), which leaves 2e-17
//! of the functions. With rounding, measured by the tests below over the whole range in use, fused
//! or not: `ln` 5e-16 relative, `exp` 4e-16 relative, `cos` and `sin` 5e-16 absolute for
//! `|x| ≤ 1e5` and `|cos πx|` 5e-16 absolute (the argument's own rounding, `|x|·1.1e-16`, is not
//! counted).

use super::Lane;

/// ln 2 in two parts; the first has 32 trailing zero bits, so that `k·LN_2_HIGH` is exact.
const LN_2_HIGH: f64 = 6.931_471_803_691_238e-1;
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;

/// π in three parts of 33, 33 and 53 bits (the split of fdlibm's π/2, doubled).
const PI_1: f64 = 3.141_592_653_468_251_2;
const PI_2: f64 = 1.215_420_101_260_793_2e-10;
const PI_3: f64 = 4.044_532_497_591_901e-21;

/// `(2 artanh(√z)/√z − 2)/z` for `z ≤ (√2 − 1)²/(√2 + 1)²`.
const LN: [f64; 7] = [
    0.666_666_666_666_667,
    0.399_999_999_998_995_05,
    0.285_714_286_259_754_87,
    0.222_222_111_347_950_8,
    0.181_828_891_252_617_23,
    0.153_317_216_005_560_42,
    0.146_164_496_850_434_06,
];

/// `(e^x − 1 − x)/x²` for `|x| ≤ ½ ln 2`.
const EXP: [f64; 10] = [
    0.500_000_000_000_000_1,
    0.166_666_666_666_666_69,
    0.041_666_666_666_624_164,
    0.008_333_333_333_330_065,
    0.001_388_888_891_719_671_9,
    0.000_198_412_698_630_405_45,
    2.480_152_132_236_869_2e-5,
    2.755_726_848_031_002_4e-6,
    2.762_007_587_998_336_7e-7,
    2.510_037_583_256_123_4e-8,
];

/// `(cos √z − 1)/z` for `z ≤ π²/4`.
const COS: [f64; 8] = [
    -0.5,
    0.041_666_666_666_666_34,
    -0.001_388_888_888_886_070_9,
    2.480_158_729_244_621_3e-5,
    -2.755_731_776_732_053e-7,
    2.087_663_086_742_299_4e-9,
    -1.146_468_988_572_002_9e-11,
    4.627_675_985_018_171_6e-14,
];

/// `(sin √z/√z − 1)/z` for `z ≤ π²/4`.
const SIN: [f64; 8] = [
    -0.166_666_666_666_666_66,
    0.008_333_333_333_333_316,
    -0.000_198_412_698_412_549_74,
    2.755_731_921_916_323_4e-6,
    -2.505_210_761_699_618_2e-8,
    1.605_897_731_246_408_7e-10,
    -7.643_970_296_798_572e-13,
    2.731_444_766_986_399_5e-15,
];

/// `(cos(π√z) − 1)/z` for `z ≤ ¼`.
const COS_PI: [f64; 8] = [
    -4.934_802_200_544_679,
    4.058_712_126_416_736,
    -1.335_262_768_851_880_3,
    0.235_330_630_272_157_7,
    -0.025_806_890_025_875_39,
    0.001_929_562_652_479_866,
    -0.000_104_582_863_683_265_85,
    4.166_399_462_726_949e-6,
];

/// `Σ cₙ xⁿ`: pairs of terms, and Horner's rule in x² for the pairs. Half as long a chain as Horner's rule
/// in x for one more multiplication; the order of operations, so every bit, is fixed by this page.
#[inline(always)]
pub fn by_pairs<L: Lane, const N: usize>(x: L, c: &[f64; N]) -> L {
    let square = x * x;
    let last = (N - 1) / 2;
    let mut sum = pair(last, x, c);
    for i in (0..last).rev() {
        sum = sum.times_plus(square, pair(i, x, c));
    }
    sum
}

/// `Σ cₙ xⁿ` by Horner's rule, for lanes that do not wait.
#[inline(always)]
pub fn horner<L: Lane, const N: usize>(x: L, c: &[f64; N]) -> L {
    let mut sum = x.each(c[N - 1]);
    for i in (0..N - 1).rev() {
        sum = sum.times_plus(x, x.each(c[i]));
    }
    sum
}

/// The terms 2i and 2i + 1 over `x^2i`.
#[inline(always)]
fn pair<L: Lane, const N: usize>(i: usize, x: L, c: &[f64; N]) -> L {
    if 2 * i + 1 < N { x.linear(c[2 * i + 1], c[2 * i]) } else { x.each(c[2 * i]) }
}

/// Natural logarithm of a positive, normal double.
///
/// ```text
/// x = m·2^k, √½ ≤ m < √2;  s = (m − 1)/(m + 1);  ln x = k ln 2 + 2s(1 + s²/3 + s⁴/5 + …)
/// ```
#[inline(always)]
pub fn ln<L: Lane>(x: L) -> L {
    let (m, k) = x.split();
    let s = (m - 1.0) / (m + 1.0);
    let z = s * s;
    // 2s + s·z·p keeps the rounding of the correction far below that of 2s.
    let near = (s * z).times_plus(z.polynomial(&LN), s + s);
    k.times_plus(x.each(std::f64::consts::LN_2), near)
}

/// `e^x`; zero below −708, infinite above 709.
///
/// ```text
/// k = round(x / ln 2), f = x − k ln 2, |f| ≤ 0.347;  e^x = 2^k (1 + f + f² p(f))
/// ```
#[inline(always)]
pub fn exp<L: Lane>(x: L) -> L {
    let (low, high) = (x.each(-708.0), x.each(709.0));
    let within = x.or_more(low).or_less(high);
    let k = (within * std::f64::consts::LOG2_E).nearest();
    let f = k.times_plus(x.each(-LN_2_HIGH), within);
    let f = k.times_plus(x.each(-LN_2_LOW), f);
    let one = x.each(1.0);
    let p = f.polynomial(&EXP).times_plus(f * f, f) + one;
    // 2^k in two steps: k = 1024 has no double of its own.
    let half = (k * 0.5).nearest();
    let power = p * half.power_of_two() * (k - half).power_of_two();
    let power = L::select(x.below(low), x.each(0.0), power);
    L::select(high.below(x), x.each(f64::INFINITY), power)
}

/// `x` less the nearest multiple `k` of π, and `k`.
#[inline(always)]
fn reduce_by_pi<L: Lane>(x: L) -> (L, L) {
    let k = (x * std::f64::consts::FRAC_1_PI).nearest();
    let f = k.times_plus(x.each(-PI_1), x);
    let f = k.times_plus(x.each(-PI_2), f);
    (k.times_plus(x.each(-PI_3), f), k)
}

/// `cos x` for `|x| < 1e9` radians.
///
/// ```text
/// f = x − kπ, |f| ≤ π/2;  cos x = (−1)^k (1 + f² p(f²))
/// ```
#[inline(always)]
pub fn cos<L: Lane>(x: L) -> L {
    let (f, k) = reduce_by_pi(x);
    let z = f * f;
    z.polynomial(&COS).times_plus(z, x.each(1.0)).alternate(k)
}

/// `sin x` for `|x| < 1e9` radians.
///
/// ```text
/// f = x − kπ, |f| ≤ π/2;  sin x = (−1)^k f(1 + f² p(f²))
/// ```
#[inline(always)]
pub fn sin<L: Lane>(x: L) -> L {
    let (f, k) = reduce_by_pi(x);
    let z = f * f;
    (f * z).times_plus(z.polynomial(&SIN), f).alternate(k)
}

/// `|cos πx|` for `|x| < 2^51` half turns: the reduction is exact, and the sign is not needed.
///
/// ```text
/// f = x − round(x), |f| ≤ ½;  |cos πx| = 1 + f² p(f²)
/// ```
#[inline(always)]
pub fn cos_pi_size<L: Lane>(x: L) -> L {
    let f = x - x.nearest();
    let z = f * f;
    z.polynomial(&COS_PI).times_plus(z, x.each(1.0))
}

/// `atan x` in radians, for every finite x.
///
/// ```text
/// atan x = 2 atan(x/(1 + √(1 + x²))), four times;  then |x| ≤ tan(π/32) and
/// atan x = x − x³/3 + x⁵/5 − …
/// ```
///
/// Scalar: it serves what is prepared once for all draws. Relative error 1e-15.
pub fn atan(x: f64) -> f64 {
    let mut x = x;
    // x²: beyond 1e150 it overflows, and the angle is a right one to the last bit.
    x = x.clamp(-1e150, 1e150);
    for _ in 0..4 {
        x /= 1.0 + (1.0 + x * x).sqrt();
    }
    let z = x * x;
    let series = (0..9).rev().fold(0.0, |sum, n| 1.0 / f64::from(2 * n + 1) - z * sum);
    16.0 * x * series
}

#[cfg(all(test, feature = "packs"))]
mod tests {
    use super::super::pack::{Hardware, Task, WIDTH, levels, on};
    use super::*;

    /// One of the functions on every lane type of this machine.
    trait Function {
        fn call<L: Lane>(x: L) -> L;
    }

    macro_rules! functions {
        ($($Name:ident = $function:ident),*) => {
            $(struct $Name;
            impl Function for $Name {
                #[inline(always)]
                fn call<L: Lane>(x: L) -> L {
                    $function(x)
                }
            })*
        };
    }
    functions!(Ln = ln, Exp = exp, Cos = cos, Sin = sin, CosPi = cos_pi_size);

    struct OfPack<F>([f64; WIDTH], std::marker::PhantomData<F>);
    impl<F: Function> Task for OfPack<F> {
        type Output = [f64; WIDTH];
        #[inline(always)]
        fn run<S: Hardware>(self, simd: S) -> [f64; WIDTH] {
            let mut values = [0.0; WIDTH];
            F::call(simd.load(&self.0)).store(&mut values);
            values
        }
    }

    /// Doubles are near the exact values, and packs have their bits.
    fn agree<F: Function>(points: impl Iterator<Item = f64>, bound: impl Fn(f64) -> (f64, f64)) {
        let points: Vec<f64> = points.collect();
        for &x in &points {
            let (exact, error) = bound(x);
            let value = F::call(x);
            assert!((value - exact).abs() <= error, "{x}: {value} for {exact}");
        }
        for level in levels() {
            for chunk in points.as_chunks::<WIDTH>().0 {
                let task = OfPack::<F>(*chunk, std::marker::PhantomData);
                let Ok(values) = on(level, task) else { continue };
                for (&x, value) in chunk.iter().zip(values) {
                    assert_eq!(value.to_bits(), F::call(x).to_bits(), "{x} at {level:?}");
                }
            }
        }
    }

    /// A deterministic scatter of points over `[low, high]`.
    fn scatter(low: f64, high: f64) -> impl Iterator<Item = f64> {
        (0..200_000).map(move |i| {
            let u = (f64::from(i) * 0.618_033_988_749_894_9).fract();
            low + (high - low) * u
        })
    }

    #[test]
    fn ln_is_relatively_exact_down_to_the_smallest_uniform() {
        let near_one = (1..2000).map(|n| 1.0 - f64::from(n) * f64::EPSILON / 2.0);
        let points = scatter(-37.0, 37.0).map(f64::exp).chain(near_one).chain(scatter(0.5, 2.0));
        agree::<Ln>(points, |x| (libm::log(x), 5e-16 * libm::log(x).abs()));
        assert_eq!(ln(1.0), 0.0);
    }

    #[test]
    fn exp_is_relatively_exact() {
        let points = scatter(-708.0, 709.0).chain(scatter(-2.0, 2.0));
        agree::<Exp>(points, |x| (libm::exp(x), 4e-16 * libm::exp(x)));
        assert_eq!([exp(0.0), exp(-1e9), exp(710.0)], [1.0, 0.0, f64::INFINITY]);
    }

    #[test]
    fn cos_and_sin_are_exact_to_5e_16() {
        let points = || scatter(-1e5, 1e5).chain(scatter(-10.0, 10.0));
        agree::<Cos>(points(), |x| (libm::cos(x), 5e-16));
        agree::<Sin>(points(), |x| (libm::sin(x), 5e-16));
        assert_eq!([cos(0.0), sin(0.0)], [1.0, 0.0]);
    }

    #[test]
    fn atan_is_relatively_exact() {
        for x in scatter(-30.0, 30.0).chain(scatter(-1.0, 1.0)).chain(scatter(-1e6, 1e6)) {
            let exact = libm::atan(x);
            assert!((atan(x) - exact).abs() <= 1e-15 * exact.abs(), "{x}");
        }
        assert!((atan(1e300) - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        assert_eq!(atan(0.0), 0.0);
    }

    #[test]
    fn cosines_of_half_turns_are_exact_to_5e_16_and_never_above_one() {
        // Halves of odd numbers are where |cos πx| is 0, integers where it is 1.
        let points = || scatter(-0.5, 0.5).chain(scatter(-1e-3, 1e-3)).chain(scatter(-1e5, 1e5));
        agree::<CosPi>(points(), |x| {
            let f = x - x.round();
            (libm::cos(std::f64::consts::PI * f), 5e-16)
        });
        assert!(points().all(|x| (0.0..=1.0).contains(&cos_pi_size(x))));
    }
}
