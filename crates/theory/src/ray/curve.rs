//! Moments and covariances of the double particle's `T̂(s)`: one walk, many distances.
//!
//! With `A = X(s₁)/T₁` and the independent increment `Y = (X(s₂)/T₂)/A`, both of mean 1,
//!
//! ```text
//! Cov[X₁, X₂] = T₁T₂ m₂(A)
//! E[(X₁−T₁)²(X₂−T₂)²] = T₁²T₂² [m₄(A)(1 + m₂(Y)) + 2 m₃(A) m₂(Y) + m₂(A) m₂(Y)]
//! ```
//!
//! Source: Szirmay-Kalos et al. 2017, section 4.2 and Figure 8; the covariance follows from Eq. 13, since
//! increments over disjoint intervals are independent.

use super::product::{Integrals, Product};
use crate::prediction::{Covariance, Increment};
use crate::{Channel, Moments, Prediction};
use numeric::Span;

/// Predicts `T̂` at ascending distances.
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
            let depth = mesh.medium().optical_depth(Span::new(start, s));
            let channel = integrals.channel(depth, 0.0, mesh.relative_error());
            Channel { name: format!("T({s})"), ..channel }
        })
        .collect();
    let covariances = pairs(&channels, &upto);
    Prediction {
        channels,
        lookups: Some(product.lookups(&mesh, &whole)),
        covariances,
        increments: increments(&upto, mesh.relative_error()),
        stable_share: product.stable_share(&mesh),
        ..Prediction::default()
    }
}

/// The steps from one distance to the next, the first from the beginning of the support.
fn increments(upto: &[Integrals], error: f64) -> Vec<Increment> {
    let mut last = [0.0; 4];
    let steps = upto.iter().map(|integrals| {
        let step: [f64; 4] = std::array::from_fn(|k| integrals.losses[k] - last[k]);
        let [_, j2, j3, j4] = std::mem::replace(&mut last, integrals.losses);
        let factor = Moments::of_product(1.0, step, 0.0);
        // e^{6J₂−4J₃+J₄} κ(Y)/e^{2J₂}.
        let kurtosis = factor.kurtosis().map(|kurtosis| (4.0 * (j2 - j3) + j4).exp() * kurtosis);
        let size: f64 = integrals.losses[1].abs();
        Increment {
            variance: j2.exp() * factor.relative[0],
            kurtosis: kurtosis.unwrap_or(1.0),
            // The step is a difference of integrals, each accurate to its own last digits.
            error: if step[1] == 0.0 { 0.0 } else { error * (size + size / step[1].abs()) },
        }
    });
    steps.collect()
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
