//! Ray marching: moments of the exponential of a Riemann sum with one random offset.
//!
//! ```text
//! τ(u) = h Σⱼ σ_t((j + u) h),  h = ℓ/steps,   E[X^k] = ∫₀¹ exp(−k τ(u)) du
//! ```

use crate::{Channel, CountDistribution, Mesh, Moments, Prediction, Tails};
use media::Extinction;
use numeric::quadrature::GaussLegendre;
use numeric::{Known, Lane, Span};

/// Panels of the quadrature over the offset, many because σ_t may have kinks.
const PANELS: usize = 256;

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
    let value = |u: f64| (log_unit - depth(mesh.medium(), mesh.support(), steps, u)).exp();
    let (mean, moments) = if jitter {
        let rule = GaussLegendre::new(4);
        let width = 1.0 / PANELS as f64;
        let over_offset = |f: &dyn Fn(f64) -> f64| -> f64 {
            let panel = |i: usize| {
                let from = width * i as f64;
                rule.integrate(from, from + width, |u| f(value(u)))
            };
            (0..PANELS).map(panel).sum()
        };
        let mean = over_offset(&|x| x);
        let relative = [2, 3, 4].map(|k| over_offset(&|x| ((x - mean) / mean).powi(k)));
        (mean, Moments::estimated(mean, relative, 1e-6))
    } else {
        let mean = value(0.5);
        (mean, Moments::certain(mean))
    };
    let truth = Channel::transmittance(mesh.optical_depth(), log_unit, moments, Tails::LIGHT);
    let channel = Channel { mean: Known::estimated(mean, 1e-9 * mean), ..truth };
    let random_numbers = Some(f64::from(u8::from(jitter)));
    Prediction {
        random_numbers,
        ..Prediction::single(channel, CountDistribution::always(f64::from(steps)))
    }
}
