//! Analog free flight: the distance to the first real collision.
//!
//! ```text
//! P(s > t) = T(t),  with an atom T(S) at the end of the ray
//! E[(min(s, S) − m)^k] = ∫ σ_t T (t − m)^k dt + T(S) (S − m)^k,   m = ∫₀^S T dt
//! ```

use super::mesh::Panel;
use crate::{Channel, CountDistribution, Distribution, Mesh, Moments, Prediction, Tails};
use numeric::sum::Sum;
use numeric::{Known, Span};

/// Number of equally probable classes of the flight distances; tests may join adjacent ones.
pub const CLASSES: usize = 1020;

/// Mean depth and its moments, and the distribution of the distance, measured from the ray's beginning.
pub fn predict(mesh: &Mesh, lookups: CountDistribution) -> Prediction {
    let ray = mesh.medium().span();
    let fine = mesh.refined(&[], &|mesh, panel| {
        let running = mesh.running(panel, panel.extinction);
        vec![running.iter().map(|depth| (-depth).exp()).collect()]
    });
    let escape = mesh.optical_depth().exp_neg();
    let mean = mean_depth(&fine);
    let relative = [2, 3, 4].map(|k| {
        let collided = over_panels(&fine, |panel, transmittance| {
            let nodes = panel.t.iter().zip(panel.extinction).zip(transmittance);
            nodes
                .map(|((&t, &sigma), &alive)| sigma * alive * (t - ray.from - mean).powi(k))
                .collect()
        });
        let escaped = escape.value * (ray.length() - mean).powi(k);
        if mean == 0.0 { 0.0 } else { (collided + escaped) / mean.powi(k) }
    });
    // A distance is a difference of positions, and these have the resolution of the ray's end.
    let grain = f64::EPSILON * ray.to.abs().max(ray.from.abs());
    let truth = Known::estimated(mean, mean * (mesh.relative_error() + 1e-14) + grain);
    let moments = Moments::estimated(mean, relative, mesh.relative_error() + 1e-13);
    let channel = Channel::unbiased(truth, moments, Tails::LIGHT);
    let distribution = distances(mesh, ray, escape.value);
    Prediction { distribution, ..Prediction::single(channel, lookups) }
}

/// `∫ T dt` over the ray, the intervals outside the support included.
fn mean_depth(mesh: &Mesh) -> f64 {
    let (ray, support) = (mesh.medium().span(), mesh.support());
    let escape = mesh.optical_depth().exp_neg().value;
    let inside = over_panels(mesh, |_, transmittance| transmittance.to_vec());
    if support.is_empty() {
        return ray.length();
    }
    (support.from - ray.from) + inside + escape * (ray.to - support.to)
}

/// `∫` of a function of a panel and of T at its nodes.
fn over_panels(mesh: &Mesh, f: impl Fn(Panel<'_>, &[f64]) -> Vec<f64>) -> f64 {
    let mut sum = Sum::default();
    let mut depth = Sum::default();
    for panel in mesh.panels() {
        let before = depth.value();
        let running = mesh.running(panel, panel.extinction);
        let transmittance: Vec<f64> = running.iter().map(|d| (-(before + d)).exp()).collect();
        sum.add(mesh.integral(panel, &f(panel, &transmittance)));
        depth.add(mesh.integral(panel, panel.extinction));
    }
    sum.value()
}

/// The quantiles of the distance at equal probabilities.
fn distances(mesh: &Mesh, ray: Span, escape: f64) -> Option<Distribution> {
    if escape >= 1.0 {
        return None;
    }
    let collided = 1.0 - escape;
    let bins: Option<Vec<f64>> = (1..CLASSES)
        .map(|i| {
            let depth = -(-collided * i as f64 / CLASSES as f64).ln_1p();
            mesh.medium().free_flight(depth).map(|t| t - ray.from)
        })
        .collect();
    Some(Distribution::Distances { bins: bins?, end: ray.length(), from: ray.from, escape })
}
