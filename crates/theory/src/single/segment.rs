//! An estimated transmittance of one segment: moments of its value and of its lookups.

use super::shadows::thinned;
use crate::prediction::raw::{self, POWERS, PerPower, poisson};
use crate::ray::survival::{Survival, factorial_rates};
use media::Medium;
use numeric::adaptive::{Halved, Limits, halve};
use numeric::quadrature::GaussLegendre;
use numeric::{Known, Span};

/// Tracking of the transmittance of a shadow ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tracking {
    /// In closed form.
    Exact,
    /// By ratio tracking through a constant σ̂, with a constant control.
    Ratio {
        /// σ̂ > 0, 1/length.
        sampling: f64,
        /// σ_c, 1/length.
        control: f64,
    },
    /// By delta tracking through a constant majorant.
    Delta {
        /// σ̄, 1/length.
        sampling: f64,
    },
}

/// The moments of an estimated transmittance X and of its lookups N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// `E[X^k]` for [`POWERS`].
    pub powers: PerPower,
    /// `E[N^k]` for k = 0 … 4.
    pub lookups: [f64; 5],
    /// `E[N^k; the walk came through]` for k = 0 … 4.
    pub through: [f64; 5],
    /// A bound on the errors of the exponents A, `E[X^k] = e^{−A}`, k to 4: the relative error of `powers`.
    pub error: f64,
    /// An upper bound on these exponents and on the sums of absolute values of their terms.
    pub size: f64,
}

/// Roundings of a loss, and of its sum over nodes, in units of ε times [`size`].
const ROUNDINGS: f64 = 8.0;

/// Loss per length of the k-th power: `kσ_c + σ̂(1 − w^k)`, given σ_c and the residual `σ_t − σ_c`.
///
/// ```text
/// σ̂(1 − w^k) = (σ_t − σ_c)(1 + w + … + w^{k−1}),   w = 1 − (σ_t − σ_c)/σ̂
/// ```
///
/// The difference would have a rounding error of ε σ̂, however small the residual.
#[inline]
pub fn loss(k: i32, control: f64, residual: f64, weight: f64) -> f64 {
    let sum = (0..k).fold(0.0, |sum, _| sum * weight + 1.0);
    f64::from(k) * control + residual * sum
}

/// Losses of all [`POWERS`], with common sums.
#[inline]
pub fn losses(control: f64, residual: f64, weight: f64) -> PerPower {
    let (mut k, mut sum, mut result) = (0, 0.0, [0.0; POWERS.len()]);
    for (i, power) in POWERS.into_iter().enumerate() {
        while k < power {
            (k, sum) = (k + 1, sum * weight + 1.0);
        }
        result[i] = f64::from(power) * control + residual * sum;
    }
    result
}

/// Sum of the absolute values of the terms of [`loss`] for k = 4: an upper bound for smaller k, too.
#[inline]
pub fn size(control: f64, residual: f64, weight: f64) -> f64 {
    loss(4, control.abs(), residual.abs(), weight.abs())
}

/// The error of exponents that are integrals of losses.
pub fn rounding(size: f64) -> f64 {
    f64::EPSILON * (1.0 + ROUNDINGS * size)
}

impl Segment {
    /// A transmittance that is known.
    pub fn exact(depth: Known) -> Self {
        let powers = POWERS.map(|k| (-f64::from(k) * depth.value).exp());
        let none = [1.0, 0.0, 0.0, 0.0, 0.0];
        let error = 4.0 * depth.error + f64::EPSILON;
        Self { powers, lookups: none, through: none, error, size: 4.0 * depth.value }
    }

    /// The transmittance 1 of a segment without a medium.
    pub fn free() -> Self {
        Self::exact(Known::new(0.0, 0.0))
    }

    /// A product of Poisson factors with the given exponents, in the order of [`POWERS`], and the given mean number
    /// of collisions. Walks always come through. `error` is that of the exponents, `size` that of sums of losses.
    pub fn product(exponents: [f64; 5], collisions: f64, [error, size]: [f64; 2]) -> Self {
        let (powers, lookups) = (exponents.map(|x| (-x).exp()), poisson(collisions));
        Self { powers, lookups, through: lookups, error, size }
    }

    /// 1 with probability `e^{−τ}`, else 0, by delta tracking through `∫σ̄ = flown`; `factorial[k − 1]` is
    /// `E[N (N − 1) … (N − k + 1)]`, see [`crate::ray::survival`].
    pub fn decided(depth: Known, flown: f64, factorial: [f64; 4]) -> Self {
        let probability = (-depth.value).exp();
        let lookups = raw::of_factorial(factorial);
        // Walks that come through make a Poisson number of null collisions.
        let through = poisson(flown - depth.value).map(|moment| probability * moment);
        let (error, size) = (depth.error + f64::EPSILON, depth.value);
        Self { powers: [probability; POWERS.len()], lookups, through, error, size }
    }

    /// The transmittance of a shadow ray.
    pub fn of_shadow(tracking: Tracking, medium: Option<&Medium>, rule: &GaussLegendre) -> Self {
        let Some(medium) = medium else { return Self::free() };
        let support = medium.support();
        let depth = medium.optical_depth(support);
        match tracking {
            Tracking::Exact => Self::exact(depth),
            Tracking::Ratio { sampling, control } => {
                let lost = |_: f64, sigma: f64| {
                    let residual = sigma - control;
                    let weight = 1.0 - residual / sampling;
                    let [a, b, c, d, e] = losses(control, residual, weight);
                    [a, b, c, d, e, size(control, residual, weight)]
                };
                let (value, apart) = along(medium, rule, lost);
                let [_, b, c, d, e, size] = value;
                let apart = apart[1..4].iter().fold(0.0, |maximum: f64, &apart| maximum.max(apart));
                let error = [rounding(size) + apart.max(4.0 * depth.error), size];
                let exponents = [depth.value, b, c, d, e];
                Self::product(exponents, sampling * support.length(), error)
            }
            Tracking::Delta { sampling } => {
                let factorial = if medium.breaks().len() > FEW {
                    counted(medium, rule, sampling)
                } else {
                    let (factorial, _) = along(medium, rule, |t, _| {
                        let depth = medium.optical_depth(Span::new(support.from, t)).value;
                        let nulls = sampling * (t - support.from) - depth;
                        factorial_rates(sampling, depth, nulls)
                    });
                    factorial
                };
                Self::decided(depth, sampling * support.length(), factorial)
            }
        }
    }
}

/// Limits of the panels of one integral.
const LIMITS: Limits = Limits { halvings: 5, panels: 10_000 };
/// Relative difference of two resolutions at which panels are fine enough: halving a panel of 16 nodes divides the
/// error by 2³², so that the finer resolution is then accurate to rounding.
const AGREED: f64 = 1e-11;

/// Maximum number of pieces along a ray with closed optical depths at all nodes.
const FEW: usize = 32;

/// Factorial moments of delta tracking along a ray of many pieces, with optical depths by running integrals.
fn counted(medium: &Medium, rule: &GaussLegendre, sampling: f64) -> [f64; 4] {
    let support = medium.support();
    let (ends, _) = thinned(support.cut(medium.breaks()));
    let (mut result, rates) = (Survival::default(), vec![sampling; rule.nodes.len()]);
    for span in Span::between(&ends).flat_map(Span::halves) {
        let sigma = medium.extinctions(&rule.nodes_on(span));
        let nulls: Vec<f64> = sigma.iter().map(|sigma| sampling - sigma).collect();
        result.add(rule, span.length(), [&rates, &sigma, &nulls]);
    }
    result.factorial()
}

/// `∫ f(t, σ_t)` over the support of a medium, and the difference of two resolutions: Gauss panels between its
/// breaks, halved until these agree.
fn along<const N: usize>(
    medium: &Medium,
    rule: &GaussLegendre,
    f: impl Fn(f64, f64) -> [f64; N],
) -> ([f64; N], [f64; N]) {
    along_all(std::slice::from_ref(medium), rule, &|t, sigma| f(t, sigma[0]))
}

/// `∫ f(t, σ_t)` for several media with one support.
pub fn along_all<const N: usize>(
    media: &[Medium],
    rule: &GaussLegendre,
    f: &dyn Fn(f64, &[f64]) -> [f64; N],
) -> ([f64; N], [f64; N]) {
    let support = media[0].support();
    let (ends, is_thinned) = thinned(support.cut(media.iter().flat_map(Medium::breaks).collect()));
    let over = |span: Span| {
        let nodes = rule.nodes_on(span);
        let sigma: Vec<_> = media.iter().map(|medium| medium.extinctions(&nodes)).collect();
        let (mut sum, mut here) = ([0.0; N], vec![0.0; media.len()]);
        for (i, (t, weight)) in rule.on(span).enumerate() {
            here.iter_mut().zip(&sigma).for_each(|(here, sigma)| *here = sigma[i]);
            sum.iter_mut().zip(f(t, &here)).for_each(|(sum, x)| *sum += weight * x);
        }
        sum
    };
    let limits = Limits { halvings: if is_thinned { 0 } else { LIMITS.halvings }, ..LIMITS };
    let is_fine = |here: &Halved<N>, scale: &[f64; N]| {
        here.change().iter().zip(scale).all(|(x, scale)| x.abs() <= AGREED * scale.max(1.0))
    };
    let [mut value, mut change] = [[0.0; N]; 2];
    for here in halve(&mut Span::between(&ends), limits, &over, &is_fine) {
        value.iter_mut().zip(here.value()).for_each(|(sum, x)| *sum += x);
        change.iter_mut().zip(here.change()).for_each(|(sum, x)| *sum += x);
    }
    (value, change.map(f64::abs))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn losses_of_small_residuals_keep_their_digits() {
        // σ̂(1 − w⁴) = 4r − 6r²/σ̂ + …, r = 1e-3: the difference would be off by ε σ̂ = 1e-7.
        let (sampling, residual) = (1e9, 1e-3);
        let weight = 1.0 - residual / sampling;
        assert!((loss(4, 0.0, residual, weight) / 4e-3 - 1.0).abs() < 1e-11);
        // Elsewhere both are equal, beyond weights of −1, too, where losses are gains.
        for (residual, control) in [(0.3, 0.0), (1.7, 0.2), (2.9, 0.1), (-0.4, 0.5)] {
            let weight: f64 = 1.0 - residual;
            let together = losses(control, residual, weight);
            for (k, of_all) in POWERS.into_iter().zip(together) {
                let apart = f64::from(k) * control + (1.0 - weight.powi(k));
                let result = loss(k, control, residual, weight);
                assert!(result.to_bits() == of_all.to_bits(), "{k}");
                assert!((result - apart).abs() < 1e-14 * (1.0 + weight.powi(k).abs()), "{k}");
                assert!(k > 4 || result.abs() <= size(control, residual, weight));
            }
        }
    }

    #[test]
    fn delta_tracking_of_a_homogeneous_segment() {
        // σ = σ̄ = 1: the first collision ends every walk, so N is 1 with probability 1 − e^{−τ}.
        let length: f64 = 1.5;
        let first = 1.0 - (-length).exp();
        let segment = Segment::decided(Known::exact(length), length, [first, 0.0, 0.0, 0.0]);
        assert_eq!(segment.lookups, [1.0, first, first, first, first]);
        assert_eq!(segment.through[1..], [0.0; 4]);
        assert_eq!(segment.through[0], segment.powers[0]);
    }
}
