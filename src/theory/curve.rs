//! One walk, many distances: moments and covariances of the double particle's `T̂(s)`.
//!
//! With `A = X(s₁)/T₁` and the independent increment `Y = (X(s₂)/T₂)/A`, both of mean 1,
//!
//! ```text
//! Cov[X₁, X₂] = T₁T₂ m₂(A)
//! E[(X₁−T₁)²(X₂−T₂)²] = T₁²T₂² [m₄(A)(1 + m₂(Y)) + 2 m₃(A) m₂(Y) + m₂(A) m₂(Y)]
//! ```
//!
//! Source: Szirmay-Kalos et al. 2017, section 4.2 and Figure 8; the covariance follows from
//! Eq. 13, since increments over disjoint stretches are independent.

use super::prediction::Covariance;
use super::product::{Integrals, Product};
use super::{Channel, Moments, Prediction};
use crate::numeric::Span;

/// Predicts `T̂` at ascending distances.
#[must_use]
pub fn predict(product: &Product<'_>, distances: &[f64]) -> Prediction {
    let mesh = product.mesh(distances);
    let support = mesh.support();
    let ends: Vec<f64> = distances.iter().map(|&s| s.clamp(support.from, support.to)).collect();
    let upto = product.integrals(&mesh, &ends);
    let whole = product.integrals(&mesh, &[support.to])[0];
    let start = mesh.medium().span().from;
    let channels: Vec<Channel> = distances
        .iter()
        .zip(&upto)
        .map(|(&s, integrals)| {
            let truth = mesh.medium().optical_depth(Span::new(start, s)).exp_neg();
            let error = mesh.relative_error();
            let moments = Moments::of_product(truth.value, integrals.losses, error);
            Channel {
                name: format!("T({s})"),
                ..Channel::unbiased(truth, moments, integrals.tails())
            }
        })
        .collect();
    let covariances = pairs(&channels, &upto);
    let length = support.length();
    Prediction {
        channels,
        lookups: Some(product.lookups(&mesh, &whole)),
        law: None,
        covariances,
        increments: Vec::new(),
        stable_share: (length > 0.0).then(|| (whole.stable / length).min(1.0)),
    }
}

fn pairs(channels: &[Channel], upto: &[Integrals]) -> Vec<Covariance> {
    let mut covariances = Vec::new();
    for j in 1..channels.len() {
        for i in 0..j {
            let (Some(first), Some(second)) = (channels[i].moments, channels[j].moments) else {
                continue;
            };
            let step: [f64; 4] = std::array::from_fn(|k| upto[j].losses[k] - upto[i].losses[k]);
            let increment = Moments::of_product(1.0, step, first.error).relative[0];
            let [m2, m3, m4] = first.relative;
            let scale = first.scale * second.scale;
            let square = m4 * (1.0 + increment) + 2.0 * m3 * increment + m2 * increment;
            let variance = scale * scale * (square - m2 * m2);
            covariances.push(Covariance { pair: [i, j], value: scale * m2, variance });
        }
    }
    covariances
}
