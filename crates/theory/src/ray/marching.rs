//! Ray marching: moments of the exponential of a Riemann sum with one random offset.
//!
//! ```text
//! τ(u) = h Σⱼ σ_t((j + u) h),  h = ℓ/steps,   E[X^k] = ∫₀¹ exp(−k τ(u)) du
//! ```

use crate::{Channel, CountDistribution, Mesh, Moments, Prediction, Tails};
use media::Extinction;
use numeric::adaptive::{Halved, Limits, halve};
use numeric::quadrature::GaussLegendre;
use numeric::{Known, Lane, Span};

/// Limits of the panels over the offset.
const LIMITS: Limits = Limits { halvings: 40, panels: 4096 };
/// Number of panels that are tried first.
const EVEN: f64 = 16.0;
/// Maximum number of kinks of σ_t at which panels end. More of them average out over the steps.
const MAX_KINKS: usize = 1024;
/// Relative difference of two resolutions at which panels are fine enough.
const AGREED: f64 = 1e-13;
/// Rounding of σ_t, in units of ε.
const OF_LOOKUP: f64 = 16.0;

/// `τ(u)`: the function that draws and predictions share.
#[inline(always)]
pub fn depth<M: Extinction, L: Lane>(medium: &M, support: Span, steps: u32, u: L) -> L {
    let step = support.length() / f64::from(steps);
    let mut sum = u.each(0.0);
    for j in 0..steps {
        sum = sum + medium.extinction((u + f64::from(j)) * step + support.from);
    }
    sum * step
}

/// Prediction of draws in units of `exp(−log_unit)`, with a random offset (`jitter`) or with `u = ½`.
pub fn predict(mesh: &Mesh, log_unit: f64, steps: u32, jitter: bool) -> Prediction {
    let at = |u: f64| depth(mesh.medium(), mesh.support(), steps, u);
    let value = |u: f64| (log_unit - at(u)).exp();
    // A sum of terms that are not negative.
    let rounding = f64::EPSILON * (4.0 + at(0.5) * (OF_LOOKUP + f64::from(steps)));
    let (mean, moments) = if jitter {
        let offsets = offsets(mesh, steps);
        let [mean] = over(&offsets, |u| [value(u)]);
        // Ends of panels are rounded, too.
        let ends = f64::EPSILON * f64::from(steps) * offsets.len() as f64;
        let mean = mean.blurred((rounding + ends) * mean.value);
        let result = over(&offsets, |u| {
            let apart = value(u) / mean.value - 1.0;
            [2, 3, 4].map(|k| apart.powi(k))
        });
        let [m2, m3, m4] = result.map(|known| known.value);
        // An error of the mean moves μ₂ by its square and μ₄ by 4 μ₃ of it; draws by their own rounding.
        let off = mean.relative_error() + rounding;
        let of_second = result[0].error + off * (off + 2.0 * m2.sqrt());
        let of_fourth = result[2].error + 4.0 * off * (off + m4.powf(0.75) + m3.abs());
        let error = if m2 > 0.0 { (of_second / m2).max(of_fourth / m4) } else { 0.0 };
        (mean, Moments::estimated(mean.value, [m2, m3, m4], error))
    } else {
        let mean = value(0.5);
        (Known::new(mean, rounding * mean), Moments::certain(mean))
    };
    let truth = Channel::transmittance(mesh.optical_depth(), log_unit, moments, Tails::LIGHT);
    let channel = Channel { mean, ..truth };
    Prediction::single(channel, CountDistribution::always(f64::from(steps)))
}

/// Panels of the offset, between the places at which a step meets a kink of σ_t.
fn offsets(mesh: &Mesh, steps: u32) -> Vec<f64> {
    let (from, whole) = (mesh.support().from, Span::new(0.0, 1.0));
    let step = mesh.support().length() / f64::from(steps);
    let kinks = mesh.medium().breaks();
    let mut cuts = whole.even_cuts(EVEN);
    if kinks.len() <= MAX_KINKS {
        cuts.extend(kinks.into_iter().map(|t| ((t - from) / step).rem_euclid(1.0)));
    }
    whole.cut(cuts)
}

/// `∫₀¹ f(u) du`, with the difference of two resolutions.
fn over<const N: usize>(offsets: &[f64], f: impl Fn(f64) -> [f64; N]) -> [Known; N] {
    let rule = GaussLegendre::new(8);
    let panel = |span: Span| {
        let mut sum = [0.0; N];
        for (u, weight) in rule.on(span) {
            sum.iter_mut().zip(f(u)).for_each(|(sum, value)| *sum += weight * value);
        }
        sum
    };
    let is_fine = |here: &Halved<N>, scale: &[f64; N]| {
        here.change().iter().zip(scale).all(|(change, scale)| change.abs() <= AGREED * scale)
    };
    let mut result = [Known::estimated(0.0, 0.0); N];
    for here in halve(&mut Span::between(offsets), LIMITS, &panel, &is_fine) {
        for (i, known) in result.iter_mut().enumerate() {
            *known = *known + Known::estimated(here.value()[i], here.change()[i].abs());
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use media::Medium;
    use media::Piecewise;
    use media::piecewise_linear::Pieces;
    use std::sync::Arc;

    /// One step of a unit ray meets the dense part with the probability p: X is 1 or e^{−6}.
    #[test]
    fn a_jump_of_the_medium_is_within_the_stated_error() {
        let (break_at, span) = (0.3717, Span::new(0.0, 1.0));
        let steps = Piecewise::steps(&[0.0, break_at, 1.0], &[0.0, 6.0]);
        let mesh = Mesh::new(Medium::new(Arc::new(Pieces::<true>(steps)), span, span));
        let channel = &predict(&mesh, 0.0, 1, true).channels[0];
        let (p, low) = (1.0 - break_at, (-6.0f64).exp());
        let mean = (1.0 - p) + p * low;
        let variance = p * (1.0 - p) * (1.0 - low).powi(2) / (mean * mean);
        let moments = channel.moments.expect("moments");
        assert!((channel.mean.value - mean).abs() <= channel.mean.error);
        assert!(channel.mean.error < 1e-13 && moments.error < 1e-12, "{moments:?}");
        assert!((moments.relative[0] / variance - 1.0).abs() <= moments.error, "{moments:?}");
    }
}
