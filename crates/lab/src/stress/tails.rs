//! Special functions and quantiles of verdicts, at the levels and sizes of runs.

use std::f64::consts::PI;

use super::prelude::*;
use gate::stats::catoni::{Argument, PsiSums};
use gate::stats::{anderson_darling, binomial, chi_square, normal};
use theory::CountDistribution;

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let level = || prop_oneof![sized(-300.0, -0.4), sized(-13.0, -0.4)];
    let row = TrialRow::relative("normal quantile", "levels 1e-300 … 0.5", 1e-9);
    let mut rows = run.fill([256, 10_240], [row], level, quantile);
    let row = TrialRow::relative("erf and erfc", "0 … 26", 4.0 * f64::EPSILON);
    rows.extend(run.fill([256, 10_240], [row], || sized(-8.0, 1.41), error_function));
    let range = "2 … 400 degrees, levels down to 1e-200";
    let row = TrialRow::relative("χ² tail, closed form", range, 1e-10);
    rows.extend(run.fill([64, 2560], [row], EvenDegrees::any, even_degrees));
    let range = "100 … 1e9 degrees, levels 1e-12 … 0.3, both tails";
    let row = TrialRow::relative("χ² tails, many degrees", range, 1e-8);
    let degrees = || (sized(2.0, 9.0), sign(), between(0.5, 7.0));
    rows.extend(run.fill([32, 1280], [row], degrees, many_degrees));
    let range = "1e4 … 1e9 trials, levels up to 1 − 1e-12";
    let row = TrialRow::relative("Clopper–Pearson limits", range, 1e-8);
    rows.extend(run.fill([32, 656], [row], Successes::any, binomial_ends));
    let row = TrialRow::relative("Poisson probabilities", "means 1e-3 … 2000, P > 1e-18", 1e-12);
    rows.extend(run.fill([16, 336], [row], || sized(-3.0, 3.3), poisson));
    let row = TrialRow::relative("Catoni's sums", "4096 draws of 1e-12 … 1e150, both signs", 1e-13);
    rows.extend(run.fill([32, 656], [row], catoni_draws, catoni));
    let row = TrialRow::relative("Anderson–Darling tail", "A² = 0.1 … 700, p = 1 … 1e-300", 1e-11);
    let square = || prop_oneof![sized(-1.0, 1.6), sized(1.6, 2.84)];
    rows.extend(run.fill([16, 176], [row], square, anderson_darling));
    rows
}

parameters! {
    /// Pairs of degrees, and a place near the mean plus a distance.
    EvenDegrees {
        pairs: usize = 1..=200_usize,
        share: f64 = between(0.2, 2.0),
        beyond: f64 = sized(-1.0, 2.6),
    }
    /// Trials, the share of successes, and 1 less a level.
    Successes {
        trials: f64 = sized(4.0, 9.0),
        share: f64 = sized(-2.3, -0.31),
        missing: f64 = sized(-12.0, -1.0),
    }
}

/// `Q(z) = ½ erfc(z/√2)` in 32 digits, for `z ≥ 0`.
pub(super) fn normal_tail(z: DoubleDouble) -> DoubleDouble {
    let density = (-(z * z).scaled(-1)).exp() / DoubleDouble::PI.scaled(1).sqrt();
    if z.high < 5.0 {
        // ½ − φ Σ z^{2n+1}/(1·3·5…(2n+1))
        let (mut term, mut sum) = (z, z);
        for n in 1..140 {
            term = term * z * z / f64::from(2 * n + 1);
            sum += term;
        }
        return 0.5 - density * sum;
    }
    let fraction = (1..300).rev().fold(z, |below, k| z + f64::from(k) / below);
    density / fraction
}

/// `Φ(b) − Φ(a)` in 32 digits, a ≤ b, on one side of 0 by the tails there.
pub(super) fn normal_between(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble {
    if a.high > 0.0 {
        normal_tail(a) - normal_tail(b)
    } else if b.high < 0.0 {
        normal_tail(-b) - normal_tail(-a)
    } else {
        1.0 - normal_tail(-a) - normal_tail(b)
    }
}

fn quantile(&level: &f64, seen: &mut Seen) {
    let z = normal::upper_quantile(level);
    let density =
        (-DoubleDouble::product(z, z).scaled(-1)).exp() / DoubleDouble::PI.scaled(1).sqrt();
    let off = (normal_tail(DoubleDouble::from(z)) - level) / density;
    seen.see(0, (off.value() / z).abs());
}

fn error_function(&x: &f64, seen: &mut Seen) {
    let tail = normal_tail(x / DoubleDouble::from(0.5).sqrt()).scaled(1);
    seen.relative(0, libm::erfc(x), tail);
    if (0.1..5.0).contains(&x) {
        seen.relative(0, libm::erf(x), 1.0 - tail);
    }
}

/// `P(χ² > x) = e^{−x/2} Σ_{j<m} (x/2)^j/j!` for 2m degrees.
fn even_degrees(
    &EvenDegrees { pairs, share, beyond }: &EvenDegrees,
    seen: &mut Seen,
) -> Option<()> {
    let x = pairs as f64 * share + beyond;
    let half = DoubleDouble::from(x);
    let (mut term, mut sum) = (DoubleDouble::ONE, DoubleDouble::ONE);
    for j in 1..pairs {
        term = term * half / j as f64;
        sum += term;
    }
    // Half the exponent at a time: e^{−745} has no digits left.
    let faint = (-half.scaled(-1)).exp();
    let exact = faint * sum * faint;
    if exact.high <= 1e-200 {
        return None;
    }
    seen.relative(0, chi_square::upper(2.0 * x, 2.0 * pairs as f64), exact);
    Some(())
}

/// `∫ density` from `x` on in steps of a deviation, until nothing is left.
fn integral(x: f64, step: f64, density: impl Fn(f64) -> f64) -> f64 {
    let rule = GaussLegendre::new(16);
    let panel = |i: i32| {
        let (a, b) = (f64::from(i) * step, f64::from(i + 1) * step);
        rule.integrate(a, b, |h| density(x + h)).abs()
    };
    (0..120).map(panel).sum()
}

/// `x ln(x/m) + m − x` in 32 digits.
fn deviance(x: DoubleDouble, m: DoubleDouble) -> DoubleDouble {
    let ratio = (m - x) / x;
    x * (ratio - ratio.ln_1p())
}

/// `ln n! − ln(√(2πn) (n/e)ⁿ)` for n ≥ 30.
fn remainder(n: f64) -> f64 {
    let z = 1.0 / (n * n);
    (1.0 / 12.0 - z * (1.0 / 360.0 - z * (1.0 / 1260.0 - z / 1680.0))) / n
}

/// Both tails against a quadrature of the density, with 32 digits of its exponent.
fn many_degrees(&(degrees, sign, deviations): &(f64, f64, f64), seen: &mut Seen) -> Option<()> {
    let (a, z) = (0.5 * degrees, sign * deviations);
    let x = a + z * a.sqrt();
    if x <= 0.1 * a {
        return None;
    }
    let density = |t: f64| {
        let exponent =
            deviance(DoubleDouble::from(a), DoubleDouble::from(t)).value() + remainder(a);
        if t > 0.0 { (-exponent).exp() * (a / (2.0 * PI)).sqrt() / t } else { 0.0 }
    };
    let exact = integral(x, 0.125 * z.signum() * a.sqrt(), density);
    let tail = if z > 0.0 { chi_square::upper } else { chi_square::lower };
    seen.see(0, (tail(2.0 * x, 2.0 * a) / exact - 1.0).abs());
    Some(())
}

/// The tail at each end of the interval, as an integral of the density of the end.
fn binomial_ends(&Successes { trials, share, missing }: &Successes, seen: &mut Seen) {
    let n = trials.round();
    let k = (n * share).round();
    let level = 1.0 - missing;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // counts
    let (low, high) = binomial::interval(k as u64, n as u64, level);
    let tail = 0.5 * (1.0 - level);
    let mass = |k: f64, p: f64| {
        let [wide_n, wide_k, p] = [n, k, p].map(DoubleDouble::from);
        let exponent = deviance(wide_k, wide_n * p) + deviance(wide_n - wide_k, wide_n * (1.0 - p));
        let scale = (2.0 * PI * k * (n - k) / n).sqrt();
        (remainder(n) - remainder(k) - remainder(n - k) - exponent.value()).exp() / scale
    };
    // dP(X ≥ k)/dp = (k/p) P(X = k), dP(X ≤ k)/dp = −((n − k)/(1 − p)) P(X = k).
    let deviation = (k * (n - k) / n).sqrt() / n;
    let inside = |p: f64| 0.0 < p && p < 1.0;
    let above = |p: f64| if inside(p) { k / p * mass(k, p) } else { 0.0 };
    let below = |p: f64| if inside(p) { (n - k) / (1.0 - p) * mass(k, p) } else { 0.0 };
    let ends = [
        (low, integral(low, -0.125 * deviation, above), above(low)),
        (high, integral(high, 0.125 * deviation, below), below(high)),
    ];
    for (end, exact, slope) in ends {
        // How far the end is from where the tail would be right.
        seen.see(0, ((exact - tail) / slope / end).abs());
    }
}

/// Probabilities by recurrence from the mode against `e^{−m} mⁿ/n!`.
fn poisson(&mean: &f64, seen: &mut Seen) {
    let (mut ln_mass, ln_mean) = (-DoubleDouble::from(mean), DoubleDouble::from(mean).ln());
    for (n, &computed) in CountDistribution::poisson(mean).pmf.iter().enumerate() {
        if n > 0 {
            ln_mass = ln_mass + ln_mean - DoubleDouble::from(n as f64).ln();
        }
        let exact = ln_mass.exp();
        if exact.high > 1e-18 {
            seen.at(format_args!("P({n})"));
            seen.relative(0, computed, exact);
        }
    }
}

/// Products of factors against sums of logarithms.
fn catoni(y: &Vec<f64>, seen: &mut Seen) {
    let (mut exact, mut size) = (DoubleDouble::default(), 0.0);
    for &y in y {
        let size_of_y = DoubleDouble::from(y.abs());
        let psi = (size_of_y * (1.0 + size_of_y.scaled(-1))).ln_1p();
        size += psi.value();
        exact += if y < 0.0 { -psi } else { psi };
    }
    let mut sums = PsiSums::<1>::default();
    y.chunks(1000).for_each(|y| sums.absorb(y, &[Argument { slope: 1.0, shift: 0.0 }]));
    seen.see(0, off(sums.totals()[0], exact) / size);
}

/// Draws of both signs.
fn catoni_draws() -> impl Strategy<Value = Vec<f64>> {
    any_of(&[3.0, 150.0]).prop_flat_map(|widest| {
        vec((sign(), sized(-12.0, widest)).prop_map(|(sign, size)| sign * size), 4096)
    })
}

/// Smirnov's sum for the upper tail against Anderson and Darling's series for the lower one, which shares
/// no term with it, and beyond x = 40 against the first term's expansion.
fn anderson_darling(&x: &f64, seen: &mut Seen) {
    let exact = if x < 40.0 { 1.0 - below(x) } else { DoubleDouble::from(far_tail(x)) };
    seen.relative(0, anderson_darling::upper_tail(x), exact);
}

/// `P(A² ≤ x)` by the formula of Anderson and Darling (Journal of the American Statistical Association 49,
/// 1954, equation 10), in 32 digits; the trapezoidal rule is exact for such integrals to all digits.
///
/// ```text
/// (√(2π)/x) Σ_j (−½ over j)(4j + 1) e^{−c} ∫₀^∞ exp(x/(8(w² + 1)) − c w²) dw,  c = (4j + 1)²π²/(8x)
/// ```
fn below(x: f64) -> DoubleDouble {
    const STEP: f64 = 0.055;
    let eighth = DoubleDouble::from(x).scaled(-3);
    let mut sum = DoubleDouble::default();
    let mut ways = DoubleDouble::ONE;
    for j in 0..16 {
        let odd = f64::from(4 * j + 1);
        let c = DoubleDouble::product(odd, odd) * DoubleDouble::PI * DoubleDouble::PI
            / eighth.scaled(6);
        if c.high > 90.0 {
            break;
        }
        let mut integral = (eighth - c).exp().scaled(-1);
        for i in 1.. {
            let square = DoubleDouble::product(f64::from(i), STEP)
                * DoubleDouble::product(f64::from(i), STEP);
            let exponent = eighth / (square + 1.0) - c * (square + 1.0);
            if exponent.high < -90.0 {
                break;
            }
            integral += exponent.exp();
        }
        sum += ways * odd * integral;
        let n = DoubleDouble::from(f64::from(j));
        ways = -(ways * (n + 0.5) / (n + 1.0));
    }
    sum * STEP * DoubleDouble::PI.scaled(1).sqrt() / x
}

/// The first term of Smirnov's sum, with `u = 2 + q²` in panels; the second is `e^{−4x}` of it.
///
/// ```text
/// (1/π) ∫ e^{−xu/2} 2q dq/√(u |cos πv|/π),  v = √(u + ¼),  |cos πv| = sin(πq²/(v + 3/2))
/// ```
fn far_tail(x: f64) -> f64 {
    let rule = GaussLegendre::new(20);
    let scale = (2.0 / x).sqrt();
    let integrand = |y: f64| {
        let square = (y * scale) * (y * scale);
        let u = 2.0 + square;
        let sine = (PI * square / ((u + 0.25).sqrt() + 1.5)).sin();
        (-y * y).exp() * 2.0 * scale * y * scale / (u * sine / PI).sqrt()
    };
    let panels = (0..14).map(|i| f64::from(i) * 0.5);
    (-x).exp() / PI * panels.map(|a| rule.integrate(a, a + 0.5, integrand)).sum::<f64>()
}
