//! Free flights, lookups and curves in layers and rods, against closed forms in 32 digits.
//!
//! ```text
//! E[min(s, S)] = Σ Tᵢ (1 − e^{−τᵢ})/σᵢ over the layers
//! lookups of a walk that each collision ends with chance e, K = ∫σ̂ e:  (1 − e^{−K})/e;  in a rod (1 − R − T)/e,
//!     R and T of a particle that is as likely to end
//! steps of a curve:  E[Δ²] = e^{J₂(s)} (e^{J₂(s') − J₂(s)} − 1),  J₂ = ∫σ̂ r²
//! ```

use super::rods::{leaving, moments_of, of_stated, rod_of, share};
use super::{Dice, Effort, Measure, Row, in_parts, text};
use crate::estimators::rules::{Single, Weight};
use crate::harness::checks::lookups::ERROR;
use crate::media::{Control, Piecewise};
use crate::numeric::{Known, Span, Wide};
use crate::theory::product::Product;
use crate::theory::{CountLaw, Mesh, ParticleRule, curve, flight, rod};

const PARTS: u64 = 16;

/// All rows.
#[must_use]
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(4, 150);
    in_parts(PARTS, |part| {
        let dice = &mut Dice::new(seed, "costs", part);
        let mut rows = vec![flights(dice, trials / 2), lookups(dice, trials), walks(dice, trials)];
        rows.extend(curves(dice, trials / 2));
        rows
    })
}

/// Mean free flights through layers, some of them empty.
fn flights(dice: &mut Dice, trials: u32) -> Row {
    let range = "1 … 5 layers, each τ = 1e-9 … 100 or empty";
    let mut row = Row::new("mean free flight", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let count = 1 + dice.below(5);
        let mut breaks = vec![0.0];
        let mut values = Vec::new();
        for i in 0..count {
            let width = dice.sized(-2.0, 1.0);
            breaks.push(breaks[i] + width);
            let is_empty = dice.below(4) == 0;
            values.push(if is_empty { 0.0 } else { dice.sized(-9.0, 2.0) / width });
        }
        let text = format!(
            "medium.piecewise-constant = {{ breaks = {breaks:?}, values = {values:?} }}\n\
             span = [0, {:e}]",
            breaks[count]
        );
        let place = || text.replace('\n', ", ");
        let Some(medium) = text::medium(&text) else {
            row.skip(place);
            continue;
        };
        let (mut exact, mut alive) = (Wide::default(), Wide::ONE);
        for (pair, &value) in breaks.windows(2).zip(&values) {
            let (width, sigma) = (Wide::from(pair[1]) - Wide::from(pair[0]), Wide::from(value));
            let depth = width * sigma;
            exact += alive * if value > 0.0 { -(-depth).exp_m1() / sigma } else { width };
            alive = alive * (-depth).exp();
        }
        let found = flight::predict(&Mesh::new(medium), CountLaw::always(0.0));
        row.see(of_stated(found.channels[0].truth, exact), place);
    }
    row
}

/// With the error that the check of the lookups takes.
pub(super) fn stated(law: &CountLaw) -> Known {
    Known::new(law.mean, law.mean * law.error.max(ERROR))
}

fn even(sigma: f64, length: f64) -> Option<Mesh> {
    let text = format!("medium.constant.extinction = {sigma:e}\nspan = [0, {length:e}]");
    text::medium(&text).map(Mesh::new)
}

/// Lookups of walks that collisions end.
fn lookups(dice: &mut Dice, trials: u32) -> Row {
    let range = "0.001 … 1000 collisions, r = 1e-9 … 2";
    let mut row = Row::new("lookups of product estimators", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let (length, collisions) = (dice.sized(-3.0, 3.0), dice.sized(-3.0, 3.0));
        let ratio = if dice.below(2) == 0 { dice.sized(-9.0, 0.0) } else { dice.between(0.0, 2.0) };
        let sampling = collisions / length;
        let sigma = ratio * sampling;
        let place = || format!("r = {ratio:e}, {collisions:e} collisions on {length:e}");
        let Some(mesh) = even(sigma, length) else {
            row.skip(place);
            continue;
        };
        let (flown, none) = (Piecewise::constant(sampling, mesh.support()), Control::None);
        let rule = Single::Terminating;
        let product = Product { laws: false, ..Product::new(&mesh, &flown, &none, &rule) };
        let Some(law) = product.predict().lookups else {
            row.skip(place);
            continue;
        };
        let left = (Wide::ONE - Wide::from(sigma) / Wide::from(sampling)).abs();
        let (ends, flown) = (Wide::ONE - left, Wide::product(sampling, length));
        let exact = if ends.high > 0.0 { -(-(flown * ends)).exp_m1() / ends } else { flown };
        row.see(of_stated(stated(&law), exact), place);
    }
    row
}

/// Lookups of walks in a rod.
fn walks(dice: &mut Dice, trials: u32) -> Row {
    let range = "3 rules, r = 0.1 … 3, τ = 1e-3 … 10";
    let mut row = Row::new("lookups of walks in a rod", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let (depth, forward) = (dice.sized(-3.0, 1.0), share(dice));
        let (albedo, ratio) = (dice.between(0.05, 1.0), dice.sized(-1.0, 0.5));
        let sampling = depth / ratio;
        let rule = if ratio <= 1.0 && dice.below(2) == 0 {
            ParticleRule::Terminating
        } else {
            [ParticleRule::NonTerminating, ParticleRule::Weighted][dice.below(2)]
        };
        let place =
            || format!("{rule:?}, τ = {depth:e}, r = {ratio:e}, a = {albedo:e}, p_f = {forward:e}");
        let found = rod_of(depth, &[albedo], forward).and_then(|(mesh, rod)| {
            let flown = Piecewise::constant(sampling, mesh.support());
            rod::predict(&mesh, &rod, &flown, rule, false).lookups
        });
        let Some(law) = found else {
            row.skip(place);
            continue;
        };
        let (flown, p) = (Wide::from(sampling), Wide::from(forward));
        let [q, s] = moments_of(rule, Wide::from(depth) / flown, albedo, 0);
        let ends = Wide::ONE - q - s;
        let [r, t] = leaving([flown * (Wide::ONE - q - s * p), flown * s * (Wide::ONE - p)]);
        // A walk that nothing ends collides as often as one that nothing turns.
        let exact = if ends.high > 1e-25 { (Wide::ONE - r - t) / ends } else { flown };
        row.see(of_stated(stated(&law), exact), place);
    }
    row
}

/// The truth at distances of one walk, its variance, and that of its steps.
fn curves(dice: &mut Dice, trials: u32) -> Vec<Row> {
    let range = "5 distances, ratio tracking, r = 1e-3 … 3, τ = 1e-6 … 30";
    let row = |what| Row::new(what, range, Measure::OfStated, 1.0);
    let mut truths = row("transmittance along a curve");
    let mut variances = row("variance along a curve");
    let mut steps = row("variance of steps along a curve");
    for _ in 0..trials {
        let (length, depth) = (dice.sized(-3.0, 3.0), dice.sized(-6.0, 1.48));
        let ratio = dice.sized(-3.0, 0.5);
        let sigma = depth / length;
        let sampling = sigma / ratio;
        let mut distances: Vec<f64> = (0..5).map(|_| length * dice.between(0.0, 1.0)).collect();
        distances.sort_by(f64::total_cmp);
        let place = || format!("τ = {depth:e}, r = {ratio:e}, at {distances:?}");
        let Some(mesh) = even(sigma, length) else {
            truths.skip(place);
            continue;
        };
        let flown = Piecewise::constant(sampling, Span::new(0.0, length));
        let found =
            curve::predict(&Product::new(&mesh, &flown, &Control::None, &Weight), &distances);
        let rate = Wide::product(sigma, sigma) / Wide::from(sampling);
        let mut before = Wide::default();
        for (i, &distance) in distances.iter().enumerate() {
            let (channel, step) = (&found.channels[i], &found.increments[i]);
            truths.see(of_stated(channel.truth, (-Wide::product(sigma, distance)).exp()), place);
            let passed = rate * Wide::from(distance);
            if passed.high > 300.0 {
                variances.skip(place);
                break;
            }
            if let Some(moments) = channel.moments {
                let off = passed.exp_m1().relative_error(moments.relative[0]);
                variances.see(off / moments.error, place);
            }
            let exact = before.exp() * (passed - before).exp_m1();
            if step.error > 0.0 {
                steps.see(exact.relative_error(step.variance) / step.error, place);
            }
            before = passed;
        }
    }
    vec![truths, variances, steps]
}
