//! Special functions and quantiles that verdicts are read off, at the levels and sizes they meet.

use std::f64::consts::PI;

use super::{Dice, Effort, Measure, Row, in_parts};
use crate::numeric::Wide;
use crate::numeric::quadrature::GaussLegendre;
use crate::stats::catoni::{Argument, PsiSums};
use crate::stats::{anderson_darling, binomial, chi_square, normal};
use crate::theory::CountLaw;

const PARTS: u64 = 16;

/// All rows.
#[must_use]
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(4, 160);
    in_parts(PARTS, |part| {
        let dice = &mut Dice::new(seed, "tails", part);
        let mut rows = normal_law(dice, 4 * trials);
        rows.push(even_degrees(dice, trials));
        rows.push(many_degrees(dice, trials / 2));
        rows.push(binomial_ends(dice, trials / 4 + 1));
        rows.push(poisson(dice, trials / 8 + 1));
        rows.push(catoni(dice, trials / 4 + 1));
        rows.push(anderson_darling(dice, trials / 16 + 1));
        rows
    })
}

/// `Q(z) = ½ erfc(z/√2)` in 32 digits, for `z ≥ 0`.
pub(super) fn normal_tail(z: Wide) -> Wide {
    let density = (-(z * z).scaled(-1)).exp() / Wide::PI.scaled(1).sqrt();
    if z.high < 5.0 {
        // ½ − φ Σ z^{2n+1}/(1·3·5…(2n+1))
        let (mut term, mut sum) = (z, z);
        for n in 1..140 {
            term = term * z * z / Wide::from(f64::from(2 * n + 1));
            sum += term;
        }
        return Wide::from(0.5) - density * sum;
    }
    let fraction = (1..300).rev().fold(z, |below, k| z + Wide::from(f64::from(k)) / below);
    density / fraction
}

fn normal_law(dice: &mut Dice, trials: u32) -> Vec<Row> {
    let range = "levels 1e-300 … 0.5";
    let mut quantile = Row::new("normal quantile", range, Measure::Relative, 1e-9);
    let mut erfc = Row::new("erf and erfc", "0 … 26", Measure::Relative, 4.0 * f64::EPSILON);
    let half_root = Wide::from(0.5).sqrt();
    for i in 0..trials {
        let level = if i % 2 == 0 { dice.sized(-300.0, -0.4) } else { dice.sized(-13.0, -0.4) };
        let z = normal::upper_quantile(level);
        let density = (-(Wide::from(z) * Wide::from(z)).scaled(-1)).exp();
        let density = density / Wide::PI.scaled(1).sqrt();
        let off = (normal_tail(Wide::from(z)) - Wide::from(level)) / density;
        quantile.see((off.value() / z).abs(), || format!("level {level:e}"));
        let x = dice.sized(-8.0, 1.41);
        let tail = normal_tail(Wide::from(x) / half_root).scaled(1);
        erfc.see(tail.relative_error(libm::erfc(x)), || format!("erfc {x:e}"));
        if (0.1..5.0).contains(&x) {
            erfc.see((Wide::ONE - tail).relative_error(libm::erf(x)), || format!("erf {x:e}"));
        }
    }
    vec![quantile, erfc]
}

/// `P(χ² > x) = e^{−x/2} Σ_{j<m} (x/2)^j/j!` for 2m degrees.
fn even_degrees(dice: &mut Dice, trials: u32) -> Row {
    let range = "2 … 400 degrees, levels down to 1e-200";
    let mut row = Row::new("χ² tail, closed form", range, Measure::Relative, 1e-10);
    for _ in 0..trials {
        let pairs = 1 + dice.below(200);
        let x = pairs as f64 * dice.between(0.2, 2.0) + dice.sized(-1.0, 2.6);
        let half = Wide::from(x);
        let (mut term, mut sum) = (Wide::ONE, Wide::ONE);
        for j in 1..pairs {
            term = term * half / Wide::from(j as f64);
            sum += term;
        }
        // Half the exponent at a time: e^{−745} has no digits left.
        let faint = (-half.scaled(-1)).exp();
        let exact = faint * sum * faint;
        if exact.high <= 1e-200 {
            row.skip(|| format!("{} degrees at {:e}", 2 * pairs, 2.0 * x));
        } else {
            let found = chi_square::upper(2.0 * x, 2.0 * pairs as f64);
            row.see(exact.relative_error(found), || {
                format!("{} degrees at {:e}", 2 * pairs, 2.0 * x)
            });
        }
    }
    row
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
fn deviance(x: Wide, m: Wide) -> Wide {
    let ratio = (m - x) / x;
    x * (ratio - ratio.ln_1p())
}

/// `ln n! − ln(√(2πn) (n/e)ⁿ)` for n ≥ 30.
fn remainder(n: f64) -> f64 {
    let z = 1.0 / (n * n);
    (1.0 / 12.0 - z * (1.0 / 360.0 - z * (1.0 / 1260.0 - z / 1680.0))) / n
}

/// Both tails against a quadrature of the density, whose exponent has 32 digits.
fn many_degrees(dice: &mut Dice, trials: u32) -> Row {
    let range = "100 … 1e9 degrees, levels 1e-12 … 0.3, both tails";
    let mut row = Row::new("χ² tails, many degrees", range, Measure::Relative, 1e-8);
    for _ in 0..trials {
        let a = 0.5 * dice.sized(2.0, 9.0);
        let z = dice.sign() * dice.between(0.5, 7.0);
        let x = a + z * a.sqrt();
        if x <= 0.1 * a {
            row.skip(|| format!("{:e} degrees, z = {z:.3}", 2.0 * a));
            continue;
        }
        let density = |t: f64| {
            let exponent = deviance(Wide::from(a), Wide::from(t)).value() + remainder(a);
            if t > 0.0 { (-exponent).exp() * (a / (2.0 * PI)).sqrt() / t } else { 0.0 }
        };
        let step = 0.125 * z.signum() * a.sqrt();
        let exact = integral(x, step, density);
        let tail = if z > 0.0 { chi_square::upper } else { chi_square::lower };
        let found = tail(2.0 * x, 2.0 * a);
        row.see((found / exact - 1.0).abs(), || format!("{:e} degrees, z = {z:.3}", 2.0 * a));
    }
    row
}

/// The tail at each end of the interval, as an integral of the density of the end.
fn binomial_ends(dice: &mut Dice, trials: u32) -> Row {
    let range = "1e4 … 1e9 trials, levels up to 1 − 1e-12";
    let mut row = Row::new("Clopper–Pearson limits", range, Measure::Relative, 1e-8);
    for _ in 0..trials {
        let n = dice.sized(4.0, 9.0).round();
        let k = (n * dice.sized(-2.3, -0.31)).round();
        let level = 1.0 - dice.sized(-12.0, -1.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // counts
        let (low, high) = binomial::interval(k as u64, n as u64, level);
        let tail = 0.5 * (1.0 - level);
        let mass = |k: f64, p: f64| {
            let [n, k, p] = [n, k, p].map(Wide::from);
            let exponent = deviance(k, n * p) + deviance(n - k, n * (Wide::ONE - p));
            let [n, k] = [n, k].map(Wide::value);
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
            let off = (exact - tail) / slope;
            row.see((off / end).abs(), || format!("{k} of {n}, level 1 − {:e}", 1.0 - level));
        }
    }
    row
}

/// Probabilities by recurrence from the mode against `e^{−m} mⁿ/n!`.
fn poisson(dice: &mut Dice, trials: u32) -> Row {
    let range = "means 1e-3 … 2000, P > 1e-18";
    let mut row = Row::new("Poisson probabilities", range, Measure::Relative, 1e-12);
    for _ in 0..trials {
        let mean = dice.sized(-3.0, 3.3);
        let law = CountLaw::poisson(mean);
        let mut ln_mass = -Wide::from(mean);
        let ln_mean = Wide::from(mean).ln();
        for (n, &found) in law.pmf.iter().enumerate() {
            if n > 0 {
                ln_mass = ln_mass + ln_mean - Wide::from(n as f64).ln();
            }
            let exact = ln_mass.exp();
            if exact.high > 1e-18 {
                row.see(exact.relative_error(found), || format!("P({n}) of mean {mean:e}"));
            }
        }
    }
    row
}

/// Products of factors against sums of logarithms.
fn catoni(dice: &mut Dice, trials: u32) -> Row {
    let range = "4096 draws of 1e-12 … 1e150, both signs";
    let mut row = Row::new("Catoni's sums", range, Measure::Relative, 1e-13);
    let argument = Argument { slope: 1.0, shift: 0.0 };
    for _ in 0..trials {
        let widest = [3.0, 150.0][dice.below(2)];
        let y: Vec<f64> = (0..4096).map(|_| dice.sign() * dice.sized(-12.0, widest)).collect();
        let (mut exact, mut size) = (Wide::default(), 0.0);
        for &y in &y {
            let t = Wide::from(y.abs());
            let psi = (t * (Wide::ONE + t.scaled(-1))).ln_1p();
            size += psi.value();
            exact += if y < 0.0 { -psi } else { psi };
        }
        let mut sums = PsiSums::<1>::default();
        y.chunks(1000).for_each(|y| sums.absorb(y, &[argument]));
        let off = (Wide::from(sums.totals()[0]) - exact).abs().value();
        row.see(off / size, || format!("up to 1e{widest}"));
    }
    row
}

/// Smirnov's sum for the upper tail against Anderson and Darling's series for the lower one, which shares
/// no term with it, and beyond x = 40 against the first term's expansion.
fn anderson_darling(dice: &mut Dice, trials: u32) -> Row {
    let range = "A² = 0.1 … 700, p = 1 … 1e-300";
    let mut row = Row::new("Anderson–Darling tail", range, Measure::Relative, 1e-11);
    for i in 0..trials {
        let x = if i % 2 == 0 { dice.sized(-1.0, 1.6) } else { dice.sized(1.6, 2.84) };
        let exact = if x < 40.0 { Wide::ONE - below(x) } else { Wide::from(far_tail(x)) };
        row.see(exact.relative_error(anderson_darling::upper_tail(x)), || format!("A² = {x:e}"));
    }
    row
}

/// `P(A² ≤ x)` as Anderson and Darling give it (Journal of the American Statistical Association 49,
/// 1954, equation 10), in 32 digits; the trapezoidal rule knows such integrals to all digits.
///
/// ```text
/// (√(2π)/x) Σ_j (−½ over j)(4j + 1) e^{−c} ∫₀^∞ exp(x/(8(w² + 1)) − c w²) dw,  c = (4j + 1)²π²/(8x)
/// ```
fn below(x: f64) -> Wide {
    const STEP: f64 = 0.055;
    let eighth = Wide::from(x).scaled(-3);
    let mut sum = Wide::default();
    let mut ways = Wide::ONE;
    for j in 0..16 {
        let odd = f64::from(4 * j + 1);
        let c = Wide::from(odd) * Wide::from(odd) * Wide::PI * Wide::PI / eighth.scaled(6);
        if c.high > 90.0 {
            break;
        }
        let mut integral = (eighth - c).exp().scaled(-1);
        for i in 1.. {
            let square = Wide::product(f64::from(i), STEP) * Wide::product(f64::from(i), STEP);
            let exponent = eighth / (square + Wide::ONE) - c * (square + Wide::ONE);
            if exponent.high < -90.0 {
                break;
            }
            integral += exponent.exp();
        }
        sum += ways * Wide::from(odd) * integral;
        let n = Wide::from(f64::from(j));
        ways = -(ways * (n + Wide::from(0.5)) / (n + Wide::ONE));
    }
    sum * Wide::from(STEP) * Wide::PI.scaled(1).sqrt() / Wide::from(x)
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
