//! Free flights, lookups and curves in layers and rods, against closed forms in 32 digits.
//!
//! ```text
//! E[min(s, S)] = Σ Tᵢ (1 − e^{−τᵢ})/σᵢ over the layers
//! lookups of a walk that each collision ends with chance e, K = ∫σ̂ e:  (1 − e^{−K})/e;  in a rod (1 − R − T)/e,
//!     R and T of a particle that is as likely to end
//! steps of a curve:  E[Δ²] = e^{J₂(s)} (e^{J₂(s') − J₂(s)} − 1),  J₂ = ∫σ̂ r²
//! ```

use super::rods::{Walked, leaving};
use super::text::{self, homogeneous, one_line};
use super::trial::Trial;
use super::{Effort, Row, in_parts};
use crate::checks::lookups::ERROR;
use media::{Control, Piecewise};
use numeric::{Known, Span, Wide};
use theory::product::Product;
use theory::rules::{Single, Weight};
use theory::{CountLaw, Mesh, curve, flight, rod};

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(4, 150);
    in_parts(16, "costs", seed, |part| {
        let range = "1 … 5 layers, each τ = 1e-9 … 100 or empty";
        part.run(trials / 2, [Row::stated("mean free flight", range)], flights);
        let range = "0.001 … 1000 collisions, r = 1e-9 … 2";
        part.run(trials, [Row::stated("lookups of product estimators", range)], lookups);
        let range = "3 rules, r = 0.1 … 3, τ = 1e-3 … 10";
        part.run(trials, [Row::stated("lookups of walks in a rod", range)], walks);
        let range = "5 distances, ratio tracking, r = 1e-3 … 3, τ = 1e-6 … 30";
        let rows = ["transmittance", "variance", "variance of steps"];
        part.run(
            trials / 2,
            rows.map(|what| Row::stated(format!("{what} along a curve"), range)),
            curves,
        );
    })
}

/// Mean free flights through layers, some of them empty.
fn flights(t: &mut Trial) -> Option<()> {
    let count = 1 + t.dice.below(5);
    let (mut breaks, mut values) = (vec![0.0], Vec::new());
    for i in 0..count {
        let width = t.dice.sized(-2.0, 1.0);
        breaks.push(breaks[i] + width);
        let is_empty = t.dice.below(4) == 0;
        values.push(if is_empty { 0.0 } else { t.dice.sized(-9.0, 2.0) / width });
    }
    let text = text::layers(&breaks, &values);
    t.place = one_line(&text);
    let medium = text::medium(&text)?;
    let (mut exact, mut alive) = (Wide::default(), Wide::ONE);
    for (pair, &sigma) in breaks.windows(2).zip(&values) {
        let width = Wide::from(pair[1]) - pair[0];
        let depth = width * sigma;
        exact += alive * if sigma > 0.0 { -(-depth).exp_m1() / sigma } else { width };
        alive = alive * (-depth).exp();
    }
    let found = flight::predict(&Mesh::new(medium), CountLaw::always(0.0));
    t.stated(0, found.channels[0].truth, exact);
    Some(())
}

/// With the error that the check of the lookups takes.
pub(super) fn stated(law: &CountLaw) -> Known {
    Known::new(law.mean, law.mean * law.error.max(ERROR))
}

/// Lookups of walks that collisions end.
fn lookups(t: &mut Trial) -> Option<()> {
    let dice = &mut *t.dice;
    let (length, collisions) = (dice.sized(-3.0, 3.0), dice.sized(-3.0, 3.0));
    let ratio = if dice.below(2) == 0 { dice.sized(-9.0, 0.0) } else { dice.between(0.0, 2.0) };
    let sampling = collisions / length;
    let sigma = ratio * sampling;
    t.place = format!("r = {ratio:e}, {collisions:e} collisions on {length:e}");
    let mesh = Mesh::new(homogeneous(sigma, length)?);
    let (flown, none) = (Piecewise::constant(sampling, mesh.support()), Control::None);
    let rule = Single::Terminating;
    let product = Product { laws: false, ..Product::new(&mesh, &flown, &none, &rule) };
    let law = product.predict().lookups?;
    let ends = 1.0 - (1.0 - Wide::from(sigma) / sampling).abs();
    let flown = Wide::product(sampling, length);
    let exact = if ends.high > 0.0 { -(-(flown * ends)).exp_m1() / ends } else { flown };
    t.stated(0, stated(&law), exact);
    Some(())
}

/// Lookups of walks in a rod.
fn walks(t: &mut Trial) -> Option<()> {
    let walked = Walked::new(t.dice, 2);
    t.place = walked.place();
    let (mesh, rod, flown) = walked.rod()?;
    let law = rod::predict(&mesh, &rod, &flown, walked.rule, false).lookups?;
    let flown = Wide::from(walked.sampling);
    let [q, s] = walked.moments(0);
    let ends = 1.0 - q - s;
    let p = Wide::from(walked.forward);
    let [r, through] = leaving([flown * (1.0 - q - s * p), flown * s * (1.0 - p)]);
    // A walk that nothing ends collides as often as one that nothing turns.
    let exact = if ends.high > 1e-25 { (1.0 - r - through) / ends } else { flown };
    t.stated(0, stated(&law), exact);
    Some(())
}

/// The truth at distances of one walk, its variance, and that of its steps.
fn curves(t: &mut Trial) -> Option<()> {
    let dice = &mut *t.dice;
    let (length, depth) = (dice.sized(-3.0, 3.0), dice.sized(-6.0, 1.48));
    let ratio = dice.sized(-3.0, 0.5);
    let sigma = depth / length;
    let sampling = sigma / ratio;
    let mut distances: Vec<f64> = (0..5).map(|_| length * dice.between(0.0, 1.0)).collect();
    distances.sort_by(f64::total_cmp);
    t.place = format!("τ = {depth:e}, r = {ratio:e}, at {distances:?}");
    let mesh = Mesh::new(homogeneous(sigma, length)?);
    let flown = Piecewise::constant(sampling, Span::new(0.0, length));
    let found = curve::predict(&Product::new(&mesh, &flown, &Control::None, &Weight), &distances);
    let rate = Wide::product(sigma, sigma) / sampling;
    let mut before = Wide::default();
    for (i, &distance) in distances.iter().enumerate() {
        let (channel, step) = (&found.channels[i], &found.increments[i]);
        t.stated(0, channel.truth, (-Wide::product(sigma, distance)).exp());
        let passed = rate * distance;
        if passed.high > 300.0 {
            t.skip(1);
            break;
        }
        if let Some(moments) = channel.moments {
            t.see(1, passed.exp_m1().relative_error(moments.relative[0]) / moments.error);
        }
        if step.error > 0.0 {
            let exact = before.exp() * (passed - before).exp_m1();
            t.see(2, exact.relative_error(step.variance) / step.error);
        }
        before = passed;
    }
    Some(())
}
