//! Free flights, lookups and curves in layers, against closed forms in 32 digits.
//!
//! ```text
//! E[min(s, S)] = Σ Tᵢ (1 − e^{−τᵢ})/σᵢ over the layers
//! lookups of a walk that each collision ends with probability e, K = ∫σ̂ e:  (1 − e^{−K})/e
//! steps of a curve:  E[Δ²] = e^{J₂(s)} (e^{J₂(s') − J₂(s)} − 1),  J₂ = ∫σ̂ r²
//! ```

use super::depths::knots;
use super::fields::{homogeneous, pieces};
use super::prelude::*;
use super::rods::lookups;
use theory::CountDistribution;
use theory::collisions::rules::{Single, Weight};
use theory::ray::curve::predict as predict_curve;
use theory::ray::free_flight;
use theory::ray::product::Product;

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let row = TrialRow::stated("mean free flight", "1 … 5 layers, each τ = 1e-9 … 100 or empty");
    let mut rows = run.fill([32, 1200], [row], Layers::any, flights);
    let row =
        TrialRow::stated("lookups of product estimators", "0.001 … 1000 collisions, r = 1e-9 … 2");
    rows.extend(run.fill([64, 2400], [row], Terminating::any, collisions));
    let range = "5 distances, ratio tracking, r = 1e-3 … 3, τ = 1e-6 … 30";
    let of_curves = ["transmittance", "variance", "variance of steps"]
        .map(|what| TrialRow::stated(format!("{what} along a curve"), range));
    rows.extend(run.fill([32, 1200], of_curves, Curve::any, curves));
    rows
}

parameters! {
    /// Layers: width, optical depth, and whether one in four is empty.
    Layers {
        layers: Vec<(f64, f64, u8)> = vec((sized(-2.0, 1.0), sized(-9.0, 2.0), 0..4_u8), 1..=5),
    }
    /// Walks that collisions end.
    Terminating {
        length: f64 = sized(-3.0, 3.0),
        collisions: f64 = sized(-3.0, 3.0),
        ratio: f64 = prop_oneof![sized(-9.0, 0.0), between(0.0, 2.0)],
    }
    /// Ratio tracking that is read at distances.
    Curve {
        length: f64 = sized(-3.0, 3.0),
        depth: f64 = sized(-6.0, 1.48),
        ratio: f64 = sized(-3.0, 0.5),
        places: [f64; 5] = [between(0.0, 1.0); 5],
    }
}

fn flights(Layers { layers }: &Layers, seen: &mut Seen) {
    let widths: Vec<f64> = layers.iter().map(|layer| layer.0).collect();
    let value = |&(width, depth, kind): &_| if kind == 0 { 0.0 } else { depth / width };
    let (breaks, values): (_, Vec<f64>) = (knots(0.0, &widths), layers.iter().map(value).collect());
    let (mut exact, mut alive) = (DoubleDouble::default(), DoubleDouble::ONE);
    for (pair, &sigma) in breaks.windows(2).zip(&values) {
        let width = DoubleDouble::from(pair[1]) - pair[0];
        let depth = width * sigma;
        exact += alive * if sigma > 0.0 { -(-depth).exp_m1() / sigma } else { width };
        alive = alive * (-depth).exp();
    }
    let computed =
        free_flight::predict(&Mesh::new(pieces(&breaks, &values)), CountDistribution::always(0.0));
    seen.stated(0, computed.channels[0].truth, exact);
}

fn collisions(walk: &Terminating, seen: &mut Seen) -> Option<()> {
    let &Terminating { length, collisions, ratio } = walk;
    let sampling = collisions / length;
    let sigma = ratio * sampling;
    let mesh = Mesh::new(homogeneous(sigma, length));
    let (flown, none) = (Piecewise::constant(sampling, mesh.support()), Control::None);
    let rule = Single::Terminating;
    let product =
        Product { with_distributions: false, ..Product::new(&mesh, &flown, &none, &rule) };
    let distribution = product.predict().lookups?;
    let ends = 1.0 - (1.0 - DoubleDouble::from(sigma) / sampling).abs();
    let flown = DoubleDouble::product(sampling, length);
    let exact = if ends.high > 0.0 { -(-(flown * ends)).exp_m1() / ends } else { flown };
    seen.stated(0, lookups(&distribution), exact);
    Some(())
}

/// The truth at distances of one walk, its variance, and that of its steps.
fn curves(curve: &Curve, seen: &mut Seen) {
    let Curve { length, depth, ratio, mut places } = curve.clone();
    let sigma = depth / length;
    let sampling = sigma / ratio;
    places.sort_by(f64::total_cmp);
    let distances = places.map(|place| length * place);
    let mesh = Mesh::new(homogeneous(sigma, length));
    let flown = Piecewise::constant(sampling, Span::new(0.0, length));
    let computed = predict_curve(&Product::new(&mesh, &flown, &Control::None, &Weight), &distances);
    let rate = DoubleDouble::product(sigma, sigma) / sampling;
    let mut before = DoubleDouble::default();
    for (i, &distance) in distances.iter().enumerate() {
        let (channel, step) = (&computed.channels[i], &computed.increments[i]);
        seen.stated(0, channel.truth, (-DoubleDouble::product(sigma, distance)).exp());
        let passed = rate * distance;
        if passed.high > 300.0 {
            seen.skip(1);
            break;
        }
        if let Some(moments) = channel.moments {
            seen.see(1, passed.exp_m1().relative_error(moments.relative[0]) / moments.error);
        }
        if step.error > 0.0 {
            let exact = before.exp() * (passed - before).exp_m1();
            seen.see(2, exact.relative_error(step.variance) / step.error);
        }
        before = passed;
    }
}
