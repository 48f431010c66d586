//! Means of weights that depend on null collisions, for any ρ: integrals along a line in the complex plane.
//!
//! A shadow ray scores `(ρ w_nee)^k` and a hit `w_uni^k`, with ρ = q x and x = Π (1 − r) over the null collisions
//! of a Poisson process. Powers of x, complex ones too, have known means, `E[x^s] = exp(−∫ σ̂ (1 − (1 − r)^s))`.
//! Mellin's inversion makes weights of them, `0 < Re s < k`:
//!
//! ```text
//! (ρ/(1 + ρ))^k        = 1/(2πi) ∫ ρ^s Γ(s) Γ(k − s)/Γ(k) ds
//! (ρ/(1 + ρ²))^k       = 1/(2πi) ∫ ρ^s Γ((k − s)/2) Γ((k + s)/2)/(2Γ(k)) ds
//! ρ^{2k−1}/(1 + ρ²)^k  = 1/(2πi) ∫ ρ^s Γ((2k − 1 − s)/2) Γ((1 + s)/2)/(2Γ(k)) ds
//! ```
//!
//! All integrals run on the line Re s = 1/2, half a unit from the nearest poles, by the trapezoidal rule. Its error
//! there is e^{−π/h}; kernels fall as e^{−π|Im s|}, those of ρ² as e^{−π|Im s|/2}. With `w = ρ²/(1 + ρ²)` or ρ/(1 +
//! ρ),
//!
//! ```text
//! E[x w^k] = T − Σ_{i=1}^k b_i/q,   b_i = E[(ρ/(1 + ρ))^i] or E[ρ^{2i−1}/(1 + ρ²)^i]
//! ```
//!
//! Errors are 1e-15 √ρ. Where ρ ≤ 1 polynomials keep relative digits, too, see [`crate::lit_rod::connections`].
//!
//! Source: derived; the trapezoidal rule: L. N. Trefethen, J. A. C. Weideman, *The Exponentially Convergent Trapezoidal
//! Rule*, SIAM Review 56 (2014).

use std::f64::consts::PI;

use crate::Heuristic;
use crate::raw::{HIGHEST, Powers};

/// Step h: e^{−π/h} is 8e-20.
const STEP: f64 = 1.0 / 14.0;
/// Maximum Im s, for kernels of ρ.
const FURTHEST: f64 = 14.0;

type Complex = [f64; 2];

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// `scale/a`.
fn over(scale: f64, a: Complex) -> Complex {
    let square = a[0] * a[0] + a[1] * a[1];
    [scale * a[0] / square, -scale * a[1] / square]
}

/// Kernels at the nodes of the line, times their weights.
pub struct Contour {
    /// Im s.
    pub frequencies: Vec<f64>,
    /// Kernels of the scores of shadow rays, one row for each power.
    connected: Vec<Vec<Complex>>,
    /// Kernels of b; empty where they equal those of shadow rays.
    falling: Vec<Vec<Complex>>,
}

/// `1 − E[x^s]` in the exponent, by nodes of the line.
pub struct Exponents<'a> {
    /// Real parts of `∫ σ̂ (1 − (1 − r)^s)`.
    pub real: &'a [f64],
    /// Imaginary parts.
    pub imaginary: &'a [f64],
}

impl Contour {
    /// The contour of a heuristic, up to a power.
    pub fn new(heuristic: Heuristic, highest: usize) -> Self {
        let furthest = match heuristic {
            Heuristic::Balance => FURTHEST,
            Heuristic::Power => 2.0 * FURTHEST,
        };
        let next = |frequency: &f64| Some(frequency + STEP).filter(|&f| f <= furthest);
        let frequencies: Vec<f64> = std::iter::successors(Some(0.0), next).collect();
        let rows = |kernel: fn(usize, f64) -> Complex| -> Vec<Vec<Complex>> {
            let weighted = |k: usize, frequency: f64| {
                // The other half of the line is the conjugate of this one.
                let weight = STEP / PI * if frequency == 0.0 { 0.5 } else { 1.0 };
                kernel(k, frequency).map(|part| weight * part)
            };
            let row = |k| frequencies.iter().map(|&frequency| weighted(k, frequency)).collect();
            (1..=highest).map(row).collect()
        };
        let (connected, falling) = match heuristic {
            Heuristic::Balance => (rows(balanced), Vec::new()),
            Heuristic::Power => (rows(squared), rows(falling)),
        };
        Self { frequencies, connected, falling }
    }

    /// `E[(ρ w_nee)^k]` and `E[x w_uni^k]` for each power k, 0 at k = 0, from q, T and the exponents along a direction.
    pub fn means(
        &self,
        ratio: f64,
        transmittance: f64,
        exponents: &Exponents<'_>,
        cosine: f64,
    ) -> [Powers; 2] {
        let (mut connected, mut falling) = ([0.0; HIGHEST + 1], [0.0; HIGHEST + 1]);
        let logarithm = ratio.ln();
        for (node, &frequency) in self.frequencies.iter().enumerate() {
            let size = (0.5 * logarithm - exponents.real[node] / cosine).exp();
            let angle = frequency * logarithm - exponents.imaginary[node] / cosine;
            let (sine, cosine) = angle.sin_cos();
            let add = |sums: &mut Powers, rows: &[Vec<Complex>]| {
                for (sum, row) in sums[1..].iter_mut().zip(rows) {
                    let [real, imaginary] = row[node];
                    *sum += size * (real * cosine - imaginary * sine);
                }
            };
            add(&mut connected, &self.connected);
            add(&mut falling, &self.falling);
        }
        if self.falling.is_empty() {
            falling = connected;
        }
        let mut hit = [0.0; HIGHEST + 1];
        let mut lost = 0.0;
        for k in 1..=self.connected.len() {
            lost += falling[k];
            hit[k] = transmittance - lost / ratio;
        }
        [connected, hit]
    }
}

fn factorial(n: usize) -> f64 {
    (1..=n).map(|i| i as f64).product()
}

/// `Γ(s) Γ(k − s)/Γ(k) = Π_{m=1}^{k−1} (m − s) · π/sin πs`, and `sin πs = cosh(π Im s)` on the line.
fn balanced(k: usize, frequency: f64) -> Complex {
    let scale = PI / (PI * frequency).cosh() / factorial(k - 1);
    (1..k).fold([scale, 0.0], |product, m| times(product, [m as f64 - 0.5, -frequency]))
}

/// σ = s/2 with the cosine and the sine of πσ.
fn half(frequency: f64) -> [Complex; 3] {
    let (real, imaginary) = (0.25, 0.5 * frequency);
    let (sine, cosine) = (PI * real).sin_cos();
    let (up, across) = ((PI * imaginary).cosh(), (PI * imaginary).sinh());
    [[real, imaginary], [cosine * up, -sine * across], [sine * up, cosine * across]]
}

/// `Γ(k/2 − σ) Γ(k/2 + σ)/(2Γ(k))`.
fn squared(k: usize, frequency: f64) -> Complex {
    let [sigma, cosine, sine] = half(frequency);
    let square = times(sigma, sigma);
    let scale = 0.5 * PI / factorial(k - 1);
    let raised = |base: Complex, at: f64| times(base, [at * at - square[0], -square[1]]);
    if k.is_multiple_of(2) {
        let base = times(sigma, over(scale, sine));
        (1..k / 2).fold(base, |product, i| raised(product, i as f64))
    } else {
        let base = over(scale, cosine);
        (0..k / 2).fold(base, |product, i| raised(product, i as f64 + 0.5))
    }
}

/// `Γ(k − 1/2 − σ) Γ(1/2 + σ)/(2Γ(k))`.
fn falling(k: usize, frequency: f64) -> Complex {
    let [sigma, cosine, _] = half(frequency);
    let base = over(0.5 * PI / factorial(k - 1), cosine);
    (1..k).fold(base, |product, i| times(product, [i as f64 - 0.5 - sigma[0], -sigma[1]]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean of a function of x for a Poisson number of null collisions, each with the factor `left` = 1 − r.
    fn poisson(mean: f64, f: impl Fn(f64) -> f64, left: f64) -> f64 {
        let (mut sum, mut chance, mut x) = (0.0, (-mean).exp(), 1.0);
        for n in 1..200 {
            sum += chance * f(x);
            chance *= mean / f64::from(n);
            x *= left;
        }
        sum
    }

    #[test]
    fn means_are_sums_over_the_number_of_null_collisions() {
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            let contour = Contour::new(heuristic, HIGHEST);
            for (mean, left, cosine) in [(0.9, 0.4, 0.9), (3.0, 0.05, 0.6), (8.0, 0.7, 1.0)] {
                let size = f64::sqrt(left);
                let exponent = |frequency: &f64| {
                    let (sine, cosine) = (frequency * f64::ln(left)).sin_cos();
                    [mean * (1.0 - size * cosine), -mean * size * sine]
                };
                let parts: Vec<[f64; 2]> = contour.frequencies.iter().map(exponent).collect();
                let real: Vec<f64> = parts.iter().map(|part| part[0]).collect();
                let imaginary: Vec<f64> = parts.iter().map(|part| part[1]).collect();
                let exponents = Exponents { real: &real, imaginary: &imaginary };
                let along = mean / cosine;
                let transmittance = (-along * (1.0 - left)).exp();
                for ratio in [1.0, 1.7, 30.0, 2000.0] {
                    let [connected, hit] = contour.means(ratio, transmittance, &exponents, cosine);
                    for k in 1..=8_i32 {
                        let raised = |x: f64| heuristic.raised(ratio * x);
                        let shadow = |x: f64| (ratio * x / (1.0 + raised(x))).powi(k);
                        let weight = |x: f64| x * (raised(x) / (1.0 + raised(x))).powi(k);
                        let place = usize::try_from(k).expect("small");
                        for (found, exact) in [
                            (connected[place], poisson(along, shadow, left)),
                            (hit[place], poisson(along, weight, left)),
                        ] {
                            let off = (found - exact).abs();
                            assert!(
                                off < 2e-14 * ratio.sqrt(),
                                "{heuristic:?} {k} {ratio}: {off:e}"
                            );
                        }
                    }
                }
            }
        }
    }
}
