//! Moments of product estimators in media of any thickness at any σ̂, against their closed form.
//!
//! ```text
//! constant σ_t, σ_c and σ̂ on a length ℓ:  J_k = σ̂ℓ E[(1 − W)^k],
//! m₂ = expm1 J₂, and so on as in `theory::moments`, without cancellation and in 32 digits
//! ```

use super::{Dice, Effort, Measure, Row, in_parts, text};
use crate::estimators::rules::{Single, Weight};
use crate::media::{Control, Piecewise};
use crate::numeric::{Span, Wide};
use crate::theory::prediction::transmittance;
use crate::theory::product::Product;
use crate::theory::{Mesh, Rule};

const PARTS: u64 = 32;

/// All rows.
#[must_use]
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(6, 200);
    in_parts(PARTS, |part| {
        let dice = &mut Dice::new(seed, "moments", part);
        let wide = "τ = 1e-12 … 1e3, σ̂/σ_t = 1e-9 … 1e9";
        let special = "r near 0, 1, 2, ±1e3; τ = 1e-6 … 50 collisions";
        let mut rows = of_products(dice, trials, wide, |dice| {
            let length = dice.sized(-9.0, 9.0);
            let extinction = dice.sized(-12.0, 3.0) / length;
            Case { extinction, control: 0.0, sampling: extinction * dice.sized(-9.0, 9.0), length }
        });
        rows.extend(of_products(dice, trials, special, |dice| {
            let near = [0.0, 1.0, 2.0, 1e3, -1e3][dice.below(5)];
            let ratio = near + dice.sign() * dice.sized(-14.0, -1.0);
            let sampling = dice.sized(-3.0, 3.0);
            let control = sampling * dice.between(0.0, 2.0) + (-ratio * sampling).max(0.0);
            let extinction = (control + ratio * sampling).max(0.0);
            Case { extinction, control, sampling, length: dice.sized(-6.0, 1.7) / sampling }
        }));
        rows.push(transmittances(dice, trials));
        rows
    })
}

#[derive(Debug, Clone, Copy)]
struct Case {
    extinction: f64,
    control: f64,
    sampling: f64,
    length: f64,
}

/// Survival and loss at a collision, in 32 digits.
struct Outcome {
    death: Wide,
    loss: Wide,
}

impl Outcome {
    fn new(rule: Single, ratio: Wide) -> Self {
        let left = Wide::ONE - ratio;
        let is_below = left.high >= 0.0;
        if let Single::NonTerminating { albedo } = rule {
            let scattered = ratio.abs() * Wide::from(albedo);
            let sum = scattered + left.abs();
            let loss = if is_below { Wide::ONE - sum } else { Wide::ONE + sum };
            return Self { death: scattered / sum, loss };
        }
        let loss = if is_below { Wide::default() } else { Wide::from(2.0) };
        Self { death: Wide::ONE - left.abs(), loss }
    }

    /// `E[(1 − W)^k]`.
    fn mean_loss(&self, k: u32) -> Wide {
        self.death + (Wide::ONE - self.death) * self.loss.powi(k)
    }
}

/// `m₂` and `m₄` of J₂, J₃ and J₄.
fn central([j2, j3, j4]: [Wide; 3]) -> [Wide; 2] {
    let n = |x: f64| Wide::from(x);
    if j2.high.abs() > 1.0 {
        let [e2, e3, e4] = [j2, j2 * n(3.0) - j3, j2 * n(6.0) - j3.scaled(2) + j4].map(Wide::exp);
        return [j2.exp_m1(), e4 - e3.scaled(2) + e2 * n(6.0) - n(3.0)];
    }
    let (u, v, z) = (j2.exp_m1(), (-j3).exp_m1(), j4.exp_m1());
    let cube = (Wide::ONE + u).powi(3);
    let mixed = u.scaled(2) * (n(3.0) + u * (n(3.0) + u)) + cube * v * (n(6.0) + v * (n(4.0) + v));
    let fourth = u * u * (n(3.0) + u * (n(16.0) + u * (n(15.0) + u * (n(6.0) + u))))
        + cube * v * mixed
        + (j2 * n(6.0) - j3.scaled(2)).exp() * z;
    [u, fourth]
}

fn of_products(
    dice: &mut Dice,
    trials: u32,
    range: &str,
    draw: impl Fn(&mut Dice) -> Case,
) -> Vec<Row> {
    let row = |what| Row::new(what, range, Measure::OfStated, 1.0);
    let (mut second, mut fourth) = (row("variance of products"), row("fourth moment of products"));
    for _ in 0..trials {
        let case = draw(dice);
        let Case { extinction, control, sampling, length } = case;
        let text = format!("medium.constant.extinction = {extinction:e}\nspan = [0, {length:e}]");
        let Some(medium) = text::medium(&text) else {
            second.skip(|| text.clone());
            fourth.skip(|| text.clone());
            continue;
        };
        let mesh = Mesh::new(medium);
        let span = Span::new(0.0, length);
        let (flown, main) =
            (Piecewise::constant(sampling, span), Piecewise::constant(control, span));
        let main = if control == 0.0 { Control::None } else { Control::Pieces(main) };
        let residual = Wide::from(extinction) - Wide::from(control);
        let ratio = residual / Wide::from(sampling);
        let collisions = Wide::product(sampling, length);
        let mut of_rule = |name: &str, rule: &dyn Rule, losses: [Wide; 3]| {
            let losses = losses.map(|loss| loss * collisions);
            let found =
                Product { laws: false, ..Product::new(&mesh, &flown, &main, rule) }.predict();
            let place = || format!("{name}, r = {:e}, {case:?}", ratio.high);
            let Some(moments) = found.channels[0].moments else {
                second.skip(place);
                fourth.skip(place);
                return;
            };
            let [_, j3, j4] = losses;
            let exponents = [losses[0], losses[0] * Wide::from(6.0) - j3.scaled(2) + j4];
            let exact = central(losses);
            let pairs = [(&mut second, moments.relative[0]), (&mut fourth, moments.relative[2])];
            for (((row, found), exact), exponent) in pairs.into_iter().zip(exact).zip(exponents) {
                // What overflows must be infinite, never not a number, and nothing else may be.
                if exponent.high > 690.0 || !exact.high.is_finite() {
                    row.see(if found > 1e290 { 0.0 } else { f64::NAN }, place);
                    continue;
                }
                if exact.high.abs() < 1e-300 {
                    row.skip(place);
                    continue;
                }
                row.see(exact.relative_error(found) / moments.error, place);
            }
        };
        let powers = [2, 3, 4].map(|k| ratio.powi(k));
        of_rule("ratio", &Weight, powers);
        let mut rules = vec![Single::NonTerminating { albedo: dice.between(0.0, 1.0) }];
        if (0.0..=2.0).contains(&ratio.high) {
            rules.push(Single::Terminating);
        }
        for rule in rules {
            let outcome = Outcome::new(rule, ratio);
            let losses = [2, 3, 4].map(|k| outcome.mean_loss(k));
            if losses.iter().all(|loss| loss.high.is_finite()) {
                of_rule(&format!("{rule:?}"), &rule, losses);
            }
        }
    }
    vec![second, fourth]
}

/// T itself, and T in units of `e^{−τ}` where it underflows.
fn transmittances(dice: &mut Dice, trials: u32) -> Row {
    let range = "τ = 1e-12 … 1e9, in units of e^{−τ} beyond 300";
    let mut row = Row::new("transmittance", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let (length, depth) = (dice.sized(-9.0, 9.0), dice.sized(-12.0, 9.0));
        let extinction = depth / length;
        let text = format!("medium.constant.extinction = {extinction:e}\nspan = [0, {length:e}]");
        let Some(medium) = text::medium(&text) else {
            row.skip(|| text.clone());
            continue;
        };
        let depth = medium.optical_depth(medium.span());
        let unit = if depth.value > 300.0 { depth.value } else { 0.0 };
        let found = transmittance(depth, unit);
        let exact = (Wide::from(unit) - Wide::product(extinction, length)).exp();
        let off = (Wide::from(found.value) - exact).abs().value();
        row.see(off / found.error, || format!("τ = {:e}", depth.value));
    }
    row
}
