//! Means of weights that depend on all null collisions between the ray's origin and a point.
//!
//! Let `x = Π (1 − σ_t/σ̂)` over the collisions of a walk through a majorant σ̂ that are all null. The densities of
//! delta tracking and of a technique that chooses points differ by `r = R x`. Computed are
//!
//! ```text
//! E[x^a r^m/(1 + r^β)^k],   R > 0,   β = 1 (balance) or 2 (power)
//! ```
//!
//! by the Mellin transform of the weights and the moments of x, which is a Poisson product:
//!
//! ```text
//! r^m/(1 + r^β)^k = (1/2πi) ∫ Γ(z) Γ(k − z)/(β Γ(k)) r^e de,   z = (m − e)/β,   0 < Re z < k
//! E[x^e] = exp(−∫ σ̂ (1 − (1 − σ_t/σ̂)^e))
//! ```
//!
//! On a vertical line the integrand falls like `e^{−π|ω|/β}`, and the trapezoidal rule errs by
//! `e^{−2πd/h}` where the strip of half-width d about the line has no pole.
//!
//! Source: derived; the rule's error is that of L. Trefethen, J. Weideman, *The Exponentially Convergent
//! Trapezoidal Rule*, SIAM Review 56 (2014), section 5.

use std::f64::consts::PI;

use num_complex::Complex64;

use super::shadows::PANELS;
use crate::mesh::Panel;
use crate::{Heuristic, Mesh};
use media::Piecewise;
use numeric::Span;
use numeric::quadrature::GaussLegendre;

/// The step of ω: poles are half a unit away, so that the rule errs by `e^{−π/h}` = 6e-19 of the integrand there.
const STEP: f64 = 0.075;
/// The end of ω/β, where `e^{−πω}` is 2e-18.
const END: f64 = 13.0;
/// Lines `Re e = ½, 1½, …`.
const LINES: usize = 5;
/// Moments, k = 1 … 4.
const MOMENTS: usize = 4;
/// Error of the trapezoidal rule, in units of the integrand next to the poles.
const MISSED: f64 = 1e-17;
/// Roundings of a term, in units of ε.
const ROUNDINGS: f64 = 16.0;

/// The k-th moments of a weight, k = 0 … 4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weighted {
    /// `E[…]`.
    pub powers: [f64; 5],
    /// Bounds on their errors.
    pub errors: [f64; 5],
}

/// Technique that made the path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Made {
    /// Delta tracking: `E[x (r^β/(1 + r^β))^k]`.
    ByCollision,
    /// The other one: `E[(r/(1 + r^β))^k]`.
    ByPoint,
}

impl Made {
    /// a, and m for each k.
    fn exponents(self, beta: usize) -> [usize; 2] {
        match self {
            Self::ByCollision => [1, beta],
            Self::ByPoint => [0, 1],
        }
    }
}

/// Integrals `∫ σ̂ (1 − (1 − σ_t/σ̂)^e)` along a ray at all exponents, for evaluation at any point.
pub struct NullPaths<'a> {
    mesh: &'a Mesh,
    sampling: &'a Piecewise,
    beta: usize,
    /// Number of ω.
    count: usize,
    rule: GaussLegendre,
    /// The relative error of the integrals.
    off: f64,
    ends: Vec<f64>,
    /// Integrals up to each end, line by line.
    sums: Vec<Vec<Complex64>>,
    /// σ̂ and σ_t of panels on which both are constant.
    flat: Vec<Option<[f64; 2]>>,
    /// `Γ(z) Γ(k − z)/(β Γ(k))`, by technique, line and k.
    kernels: Vec<Vec<Complex64>>,
}

impl<'a> NullPaths<'a> {
    /// Integrates along the ray, `σ̂ ≥ σ_t`.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a few hundred
    pub fn new(mesh: &'a Mesh, sampling: &'a Piecewise, heuristic: Heuristic) -> Self {
        let beta = if heuristic == Heuristic::Power { 2 } else { 1 };
        let count = (beta as f64 * END / STEP) as usize + 1;
        let mut paths = Self {
            mesh,
            sampling,
            beta,
            count,
            rule: GaussLegendre::new(16),
            off: 0.0,
            ends: vec![mesh.support().from],
            sums: vec![vec![Complex64::ZERO; LINES * count]],
            flat: Vec::new(),
            kernels: Vec::new(),
        };
        paths.kernels = [Made::ByCollision, Made::ByPoint]
            .into_iter()
            .flat_map(|made| (0..LINES - 1).map(move |line| (made, line)))
            .flat_map(|(made, line)| (1..=MOMENTS).map(move |k| (made, line, k)))
            .map(|(made, line, k)| paths.kernel(made, line, k))
            .collect();
        paths.integrate();
        paths
    }

    fn integrate(&mut self) {
        let (mesh, sampling, support) = (self.mesh, self.sampling, self.mesh.support());
        let mut cuts = sampling.knots().to_vec();
        cuts.extend(mesh.roots(|t, x| sampling.value(t) - x));
        cuts.retain(|&t| support.contains_inside(t));
        let beta = self.beta as f64;
        let fine = mesh.refined(&cuts, &|_, panel| {
            let nodes = || panel.t.iter().zip(panel.extinction);
            let row = |e: Complex64, part: fn(Complex64) -> f64| -> Vec<f64> {
                let loss = |(&t, &x): (&f64, &f64)| part(loss(sampling.value(t), x, e));
                nodes().map(loss).collect()
            };
            let slow = Complex64::new(0.5, beta);
            let fast = Complex64::new(0.5, 4.0 * beta);
            let last = Complex64::from(LINES as f64 - 0.5);
            let im: fn(Complex64) -> f64 = |x| x.im;
            vec![row(slow, |x| x.re), row(slow, im), row(fast, im), row(last, |x| x.re)]
        });
        self.off = fine.relative_error();
        let panels: Vec<Panel<'_>> = fine.panels().collect();
        // In media of many pieces several panels share an entry.
        let is_many = mesh.medium().breaks().len() > PANELS;
        let together = if is_many { panels.len().div_ceil(PANELS) } else { 1 };
        let mut missed = 0.0f64;
        for group in panels.chunks(together) {
            let (first, sigma) = (sampling.value(group[0].t[0]), group[0].extinction[0]);
            let mut nodes = group.iter().flat_map(|panel| panel.t.iter().zip(panel.extinction));
            let is_flat = nodes.all(|(&t, &x)| sampling.value(t) == first && x == sigma);
            self.flat.push(is_flat.then_some([first, sigma]));
            let (entry, before) = (self.flat.len() - 1, &self.sums[self.sums.len() - 1]);
            let mut sum = before.clone();
            for panel in group {
                self.add(entry, panel.span, 0..LINES, &mut sum);
            }
            let span = Span::new(group[0].span.from, group[group.len() - 1].span.to);
            if group.len() > 1 {
                let mut at_once = before.clone();
                self.add(entry, span, 0..LINES, &mut at_once);
                let apart = at_once.iter().zip(&sum).map(|(a, b)| (a - b).norm());
                missed = apart.fold(missed, f64::max);
            }
            self.ends.push(span.to);
            self.sums.push(sum);
        }
        let whole = self.sums[self.sums.len() - 1].iter().map(|x| x.norm()).fold(0.0, f64::max);
        if missed > 0.0 {
            self.off += missed / whole;
        }
    }

    fn exponent(line: usize, number: usize) -> Complex64 {
        Complex64::new(line as f64 + 0.5, number as f64 * STEP)
    }

    /// `Γ(z) Γ(k − z)/(β Γ(k))`, `Γ(z) Γ(1 − z) = π/sin πz`.
    fn kernel(&self, made: Made, line: usize, k: usize) -> Vec<Complex64> {
        let [_, m] = made.exponents(self.beta);
        let beta = self.beta as f64;
        let at = |number: usize| {
            let z = ((m * k) as f64 - Self::exponent(line, number)) / beta;
            let first = PI / (beta * (PI * z).sin());
            (1..k).fold(first, |product, j| product * (j as f64 - z) / j as f64)
        };
        (0..self.count).map(at).collect()
    }

    /// Adds the losses on an interval of a panel.
    fn add(&self, panel: usize, span: Span, lines: std::ops::Range<usize>, sum: &mut [Complex64]) {
        let mut turn = Vec::with_capacity(self.count);
        let mut at = |weight: f64, sampling: f64, sigma: f64| {
            let kept = (1.0 - sigma / sampling).max(0.0);
            let whole = weight * sampling;
            if sampling <= 0.0 {
                return;
            }
            turn.clear();
            if kept > 0.0 {
                let step = Complex64::cis(STEP * kept.ln());
                let powers = std::iter::successors(Some(Complex64::ONE), |turn| Some(turn * step));
                turn.extend(powers.take(self.count));
            } else {
                turn.resize(self.count, Complex64::ZERO);
            }
            let mut size = whole * kept.sqrt() * kept.powi(i32::try_from(lines.start).unwrap_or(0));
            for line in lines.clone() {
                let row = &mut sum[line * self.count..(line + 1) * self.count];
                for (sum, turn) in row.iter_mut().zip(&turn) {
                    *sum += whole - size * turn;
                }
                size *= kept;
            }
        };
        if let Some([sampling, sigma]) = self.flat[panel] {
            at(span.length(), sampling, sigma);
            return;
        }
        let sigma = self.mesh.medium().extinctions(&self.rule.nodes_on(span));
        for ((t, weight), sigma) in self.rule.on(span).zip(sigma) {
            at(weight, self.sampling.value(t), sigma);
        }
    }

    /// `−ln E[x^e]` up to a point, on some of the lines.
    fn losses(&self, s: f64, lines: std::ops::Range<usize>) -> Vec<Complex64> {
        let last = self.ends.len() - 1;
        let panel = self.ends.partition_point(|&end| end <= s).saturating_sub(1).min(last);
        let mut sum = self.sums[panel].clone();
        let rest = Span::new(self.ends[panel], s);
        if !rest.is_empty() && panel < last {
            self.add(panel, rest, lines, &mut sum);
        }
        sum
    }

    /// The moments of the weights of paths to a point, r = R x.
    pub fn weights(&self, made: Made, s: f64, ratio: f64) -> Weighted {
        let (mut powers, mut errors) = ([1.0, 0.0, 0.0, 0.0, 0.0], [0.0; 5]);
        if ratio <= 0.0 {
            return Weighted { powers, errors };
        }
        let [by, m] = made.exponents(self.beta);
        // Where R < 1 the line is next to the pole that is as small as the answer.
        let line = |k: usize| if ratio < 1.0 { (m * k).min(LINES - 1) - 1 } else { 0 };
        let lines = by + line(1)..by + line(MOMENTS) + 1;
        let mut means = self.losses(s, lines.clone());
        let asked = &mut means[lines.start * self.count..lines.end * self.count];
        let size = asked.iter().fold(0.0f64, |most, loss| most.max(loss.norm()));
        for loss in &mut *asked {
            *loss = (-*loss).exp();
        }
        let rounding = f64::EPSILON * (ROUNDINGS + size) + self.off * size;
        let step = Complex64::cis(STEP * ratio.ln());
        for k in 1..=MOMENTS {
            let line = line(k);
            let kernel = &self.kernels[(made as usize * (LINES - 1) + line) * MOMENTS + k - 1];
            let mean = &means[(line + by) * self.count..][..self.count];
            let low = ratio.powi(i32::try_from(line).unwrap_or(0));
            let mut turn = Complex64::from(0.5 * low * ratio.sqrt());
            let (mut sum, mut size) = (0.0, 0.0);
            for (number, (kernel, mean)) in kernel.iter().zip(mean).enumerate() {
                let term = kernel * mean * turn;
                sum += term.re;
                size += term.l1_norm();
                turn *= if number == 0 { 2.0 * step } else { step };
            }
            powers[k] = sum * STEP / PI;
            errors[k] = rounding * size * STEP / PI + MISSED * low * (1.0 + ratio);
        }
        Weighted { powers, errors }
    }
}

/// `σ̂ (1 − (1 − σ_t/σ̂)^e)`.
fn loss(sampling: f64, sigma: f64, exponent: Complex64) -> Complex64 {
    let kept = (1.0 - sigma / sampling).max(0.0);
    if sampling <= 0.0 {
        Complex64::ZERO
    } else if kept > 0.0 {
        sampling * (1.0 - (exponent * kept.ln()).exp())
    } else {
        Complex64::from(sampling)
    }
}
