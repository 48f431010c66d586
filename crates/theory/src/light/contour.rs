//! Means of weights that depend on all null collisions of a path: integrals along lines in the complex plane.
//!
//! Let `x = Π (1 − σ_t/σ̂)` over the collisions of a walk through a majorant σ̂ that are all null. The densities of a
//! technique that walks and of one that chooses a point differ by `ρ = q x`. With β = 1 (balance) or 2 (power), the
//! k-th powers of both scores are
//!
//! ```text
//! of a point       (ρ/(1 + ρ^β))^k          a = 0,  m = k
//! of a collision   x (ρ^β/(1 + ρ^β))^k      a = 1,  m = βk
//! ```
//!
//! The Mellin transform of the weights and the moments of x, a Poisson product, give their means:
//!
//! ```text
//! x^a ρ^m/(1 + ρ^β)^k = (1/2πi) ∫ Γ(z) Γ(k − z)/(β Γ(k)) x^a ρ^e de,   z = (m − e)/β,   0 < Re z < k
//! E[x^s] = exp(−∫ σ̂ (1 − (1 − σ_t/σ̂)^s)),   s = e + a
//! ```
//!
//! All scores share a line: `Re s = ½` where q > 1, `3/2` where q is little less than 1, and `n + ½` with the highest
//! power n below. Poles between the line and the strip `0 < Re z < k` add terms of the weight's series. Their means
//! are moments of x:
//!
//! ```text
//! q ≤ 1   Σ_j (−1)^j (k + j − 1 over j) q^{m + βj} E[x^{a + m + βj}],   a + m + βj < Re s
//! q > 1   E[x], of a collision
//! ```
//!
//! No term is much larger than the first, so that relative digits are kept however small q and x are. The integrand falls
//! like `e^{−π|ω|/β}`, and the trapezoidal rule errs by `e^{−π/h}`: the nearest pole is half a unit away.
//!
//! Source: derived; the rule's error is that of L. N. Trefethen, J. A. C. Weideman, *The Exponentially Convergent
//! Trapezoidal Rule*, SIAM Review 56 (2014), section 5.

use std::f64::consts::PI;
use std::ops::Range;

use num_complex::Complex64;

use crate::light::Heuristic;
use crate::prediction::raw::{HIGHEST, Powers, binomial};

/// The step of ω: the rule errs by `e^{−π/h}` = 6e-19 of the integrand next to the poles.
const STEP: f64 = 0.075;
/// The end of ω/β for n = 0, where `e^{−πω}` is 4e-17, and its growth with n: kernels grow like `ω^{n − 1}/(n − 1)!`.
const END: [f64; 2] = [12.0, 0.5];
/// Smallest q of the line in the middle.
const NEAR_ONE: f64 = 0.35;
/// Error of the trapezoidal rule, in units of the kernel times the integrand next to the poles.
const MISSED: f64 = 3e-18;
/// Relative rounding error of a term of a mean, in units of ε, besides that of the exponents.
pub const ROUNDINGS: f64 = 8.0;

/// Technique that made the path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Made {
    /// The one that chooses a point: `E[(ρ/(1 + ρ^β))^k]`.
    ByPoint,
    /// The one that walks: `E[x (ρ^β/(1 + ρ^β))^k]`.
    ByCollision,
}

/// Means of the scores of both techniques, by [`Made`] and k; 0 for k = 0.
#[derive(Debug, Clone, Copy, Default)]
pub struct TechniqueScores {
    /// `E[…]`.
    pub means: [Powers; 2],
    /// Bounds on their errors.
    pub errors: [Powers; 2],
}

/// Kernels of the weights of a heuristic on the nodes of the lines.
///
/// A row of numbers of theirs holds one for each integer power of x from 1, then, line by line, the real and the
/// imaginary parts at the nodes.
pub struct Contour {
    highest: usize,
    /// Nodes of a line, all of them and those up to ω = β.
    count: usize,
    unit: usize,
    lines: Vec<ContourLine>,
}

struct ContourLine {
    /// Re s.
    real: f64,
    /// Real parts, then imaginary parts of the kernels of all scores, node by node, times the weights of the nodes.
    kernels: Vec<f64>,
    /// By score.
    poles: Vec<Poles>,
}

/// Poles between a line and the strip of a score.
struct Poles {
    /// Coefficients, and exponents of q and of x.
    terms: Vec<(f64, usize, usize)>,
    /// Absolute value of the kernel next to the poles.
    nearest: f64,
}

impl Contour {
    /// Kernels up to a power, for q ≤ 1 or for any q; without a heuristic, integer powers of x alone.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a few hundred
    pub fn new(heuristic: Option<Heuristic>, highest: usize, is_any: bool) -> Self {
        let Some(heuristic) = heuristic else {
            return Self { highest, count: 0, unit: 0, lines: Vec::new() };
        };
        let beta = if heuristic == Heuristic::Power { 2 } else { 1 };
        let nodes = |end: f64| (beta as f64 * end / STEP) as usize;
        let (count, unit) = (nodes(END[0] + END[1] * highest as f64) + 1, nodes(1.0));
        let reals = [highest, 1, 0].into_iter().map(|power| power as f64 + 0.5);
        let lines = reals
            .take(if is_any { 3 } else { 1 })
            .map(|real| ContourLine::new(beta, highest, count, real))
            .collect();
        Self { highest, count, unit, lines }
    }

    /// Returns whether complex powers of x are needed.
    pub fn has_lines(&self) -> bool {
        !self.lines.is_empty()
    }

    /// Length of a row.
    pub fn width(&self) -> usize {
        self.highest + 2 * self.count * self.lines.len()
    }

    /// Indices of the numbers in a row that are the least smooth functions of w: the highest power, and the parts at
    /// ω = β and 4β on the last line.
    pub fn steepest(&self) -> [usize; 4] {
        let first = self.width() - 2 * self.count;
        let real = first + self.unit;
        [self.highest - 1, real, real + self.count, real + self.count + 3 * self.unit]
    }

    /// Index of the line for a ratio q.
    pub fn line(&self, ratio: f64) -> usize {
        let line = usize::from(ratio > NEAR_ONE) + usize::from(ratio > 1.0);
        line.min(self.lines.len().saturating_sub(1))
    }

    /// Parts of a row on the real and imaginary parts of a line.
    fn parts<'r>(&self, row: &'r [f64], line: usize) -> (&'r [f64], &'r [f64]) {
        row[self.highest + 2 * self.count * line..][..2 * self.count].split_at(self.count)
    }

    /// Places in a row of the integer powers, and of all lines or of one.
    pub fn places(&self, line: Option<usize>) -> [Range<usize>; 2] {
        let begin = |line: usize| self.highest + 2 * self.count * line;
        let lines = line.map_or(0..self.lines.len(), |line| line..line + 1);
        [0..self.highest, begin(lines.start)..begin(lines.end)]
    }

    /// `σ̂ (1 − w^s)` of all lines.
    pub fn rates(&self, kept: f64, sampling: f64) -> Vec<f64> {
        let mut row = vec![0.0; self.width()];
        self.losses(kept, None, &mut row);
        for loss in &mut row {
            *loss *= sampling;
        }
        row
    }

    /// Writes the row of `1 − w^s`, of all lines or of one.
    pub fn losses(&self, kept: f64, line: Option<usize>, row: &mut [f64]) {
        let (powers, lines) = row.split_at_mut(self.highest);
        let mut power = 1.0;
        for loss in powers {
            power *= kept;
            *loss = 1.0 - power;
        }
        if self.lines.is_empty() {
            return;
        }
        let step = if kept > 0.0 { Complex64::cis(STEP * kept.ln()) } else { Complex64::ZERO };
        let parts = lines.chunks_exact_mut(2 * self.count).enumerate();
        for (i, part) in parts.filter(|&(i, _)| line.is_none_or(|line| line == i)) {
            let (real, imaginary) = part.split_at_mut(self.count);
            let mut power = Complex64::from(kept.powf(self.lines[i].real));
            for (real, imaginary) in real.iter_mut().zip(imaginary) {
                (*real, *imaginary) = (1.0 - power.re, -power.im);
                power = product(power, step);
            }
        }
    }

    /// `E[x^s]` at the integer powers and on a line, given the row of `∫ σ̂ (1 − w^s)` in units of a scale.
    pub fn moments(&self, line: usize, integrals: &[f64], scale: f64) -> Vec<f64> {
        let powers = integrals[..self.highest].iter().map(|x| (-scale * x).exp());
        if self.lines.is_empty() {
            return powers.collect();
        }
        let mut moments = Vec::with_capacity(self.highest + 2 * self.count);
        moments.extend(powers);
        let (real, imaginary) = self.parts(integrals, line);
        moments.extend(real.iter().map(|x| (-scale * x).exp()));
        for i in 0..self.count {
            let size = moments[self.highest + i];
            let (sine, cosine) = (scale * imaginary[i]).sin_cos();
            moments[self.highest + i] = size * cosine;
            moments.push(-size * sine);
        }
        moments
    }

    /// The largest `|∫ σ̂ (1 − w^s)|` on a line.
    pub fn size(&self, line: usize, integrals: &[f64]) -> f64 {
        let (real, imaginary) = self.parts(integrals, line);
        real.iter().zip(imaginary).map(|(x, y)| x.hypot(*y)).fold(0.0, f64::max)
    }

    /// Means for a ratio q, from the moments of x on a line. `off` is their relative error; where it is 0 no errors are computed.
    pub fn scores(&self, line: usize, ratio: f64, moments: &[f64], off: f64) -> TechniqueScores {
        let mut result = TechniqueScores::default();
        if ratio <= 0.0 {
            return result;
        }
        let line = &self.lines[line];
        let width = 2 * self.highest;
        let [mut sums, mut sizes] = [[0.0; 2 * HIGHEST]; 2];
        let (powers, rest) = moments.split_at(self.highest);
        let (real, imaginary) = rest.split_at(self.count);
        let step = Complex64::cis(STEP * ratio.ln());
        let mut turn = Complex64::from(ratio.powf(line.real));
        let kernels = line.kernels.chunks_exact(2 * width);
        for ((&real, &imaginary), kernels) in real.iter().zip(imaginary).zip(kernels) {
            let x = product(turn, Complex64::new(real, imaginary));
            let (reals, imaginaries) = kernels.split_at(width);
            for ((sum, a), b) in sums.iter_mut().zip(reals).zip(imaginaries) {
                *sum += a * x.re - b * x.im;
            }
            if off > 0.0 {
                for ((sum, a), b) in sizes.iter_mut().zip(reals).zip(imaginaries) {
                    *sum += (a * x.re).abs() + (b * x.im).abs();
                }
            }
            turn = product(turn, step);
        }
        let beside = MISSED * ratio.powf(line.real - 0.5) * (1.0 + ratio);
        for (i, poles) in line.poles.iter().enumerate() {
            let (made, k) = (i / self.highest, i % self.highest + 1);
            let unit = if made == 0 { 1.0 } else { 1.0 / ratio };
            let (mut mean, mut size) = (unit * sums[i], unit * sizes[i]);
            for &(coefficient, of_ratio, of_x) in &poles.terms {
                let term = coefficient
                    * ratio.powi(i32::try_from(of_ratio).unwrap_or(i32::MAX))
                    * powers[of_x - 1];
                mean += term;
                size += term.abs();
            }
            result.means[made][k] = mean;
            result.errors[made][k] = off * size + beside * unit * poles.nearest;
        }
        result
    }
}

impl ContourLine {
    fn new(beta: usize, highest: usize, count: usize, real: f64) -> Self {
        let scores = [Made::ByPoint, Made::ByCollision]
            .into_iter()
            .flat_map(|made| (1..=highest).map(move |k| (made, k)));
        let kernel = |made: Made, k: usize, number: usize| {
            let (a, m) = exponents(made, k, beta);
            let s = Complex64::new(real, number as f64 * STEP);
            let z = ((a + m) as f64 - s) / beta as f64;
            // Γ(z) Γ(1 − z) = π/sin πz.
            let first = PI / (beta as f64 * (PI * z).sin());
            (1..k).fold(first, |product, j| product * (j as f64 - z) / j as f64)
        };
        let poles = scores.clone().map(|(made, k)| {
            let (a, m) = exponents(made, k, beta);
            let right =
                (0..).map(|j| (j, a + m + beta * j)).take_while(|&(_, s)| (s as f64) < real);
            let term = |(j, s): (usize, usize)| {
                let sign = if j.is_multiple_of(2) { 1.0 } else { -1.0 };
                (sign * binomial(k + j - 1, j), s - a, s)
            };
            let mut terms: Vec<(f64, usize, usize)> = right.map(term).collect();
            if made == Made::ByCollision && real < 1.0 {
                terms.push((1.0, 0, 1));
            }
            Poles { terms, nearest: kernel(made, k, 0).norm() }
        });
        let poles = poles.collect();
        let mut kernels = Vec::with_capacity(4 * highest * count);
        for number in 0..count {
            // The other half of the line is the conjugate of this one.
            let weight = STEP / PI * if number == 0 { 0.5 } else { 1.0 };
            let row = scores.clone().map(|(made, k)| weight * kernel(made, k, number));
            let row: Vec<Complex64> = row.collect();
            kernels.extend(row.iter().map(|kernel| kernel.re));
            kernels.extend(row.iter().map(|kernel| kernel.im));
        }
        Self { real, kernels, poles }
    }
}

/// `a b`: operators of complex numbers that assign are not inlined.
#[inline(always)]
fn product(a: Complex64, b: Complex64) -> Complex64 {
    Complex64::new(a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re)
}

/// a and m of a score.
fn exponents(made: Made, k: usize, beta: usize) -> (usize, usize) {
    match made {
        Made::ByPoint => (0, k),
        Made::ByCollision => (1, beta * k),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean of a function of x for a Poisson number of null collisions, each with the factor `left` = 1 − r.
    fn poisson(mean: f64, f: impl Fn(f64) -> f64, left: f64) -> f64 {
        let (mut sum, mut probability, mut x) = (0.0, (-mean).exp(), 1.0);
        for n in 1..200 {
            sum += probability * f(x);
            probability *= mean / f64::from(n);
            x *= left;
        }
        sum
    }

    #[test]
    fn means_are_sums_over_the_number_of_null_collisions() {
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            for (highest, is_any) in
                [1, 2, 4, HIGHEST].into_iter().flat_map(|n| [(n, true), (n, false)])
            {
                let contour = Contour::new(Some(heuristic), highest, is_any);
                for (mean, left) in [(0.0, 0.5), (0.9, 0.4), (5.0, 0.05), (8.0, 0.7), (30.0, 0.9)] {
                    let mut row = vec![0.0; contour.width()];
                    contour.losses(left, None, &mut row);
                    let ratios = [1e-9, 0.003, 0.4, 1.0, 1.7, 30.0, 2000.0];
                    for ratio in ratios.into_iter().filter(|&ratio| is_any || ratio <= 1.0) {
                        let line = contour.line(ratio);
                        let moments = contour.moments(line, &row, mean);
                        let off = f64::EPSILON * (ROUNDINGS + mean);
                        let TechniqueScores { means, errors } =
                            contour.scores(line, ratio, &moments, off);
                        for (k, power) in (1..=highest).zip(1..) {
                            let point = |x: f64| ratio * x / (1.0 + heuristic.raised(ratio * x));
                            let kept =
                                |x: f64| point(x) * heuristic.raised(ratio * x) / (ratio * x);
                            let exact = [
                                poisson(mean, |x| point(x).powi(power), left),
                                poisson(mean, |x| x * kept(x).powi(power), left),
                            ];
                            for (made, exact) in exact.into_iter().enumerate() {
                                let (apart, error) =
                                    ((means[made][k] - exact).abs(), errors[made][k]);
                                let place = format!(
                                    "{heuristic:?} {highest} {k} {made} {mean} {ratio}: {exact:e} {error:e} {apart:e}"
                                );
                                assert!(apart <= error + 1e-14 * exact, "{place}");
                                if !is_any && made == 0 {
                                    assert!(apart <= 2e-12 * exact, "{place}");
                                    assert!(error <= 1e-8 * exact, "{place}");
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}
