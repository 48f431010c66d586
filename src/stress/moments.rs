//! Moments of product estimators in media of any thickness at any σ̂, against their closed form.
//!
//! ```text
//! constant σ_t, σ_c and σ̂ on a length ℓ:  J_k = σ̂ℓ E[(1 − W)^k],
//! m₂ = expm1 J₂, and so on as in `theory::moments`, without cancellation and in 32 digits
//! ```

use super::text::homogeneous;
use super::trial::{Dice, Trial, off};
use super::{Effort, Row, in_parts};
use media::{Control, Piecewise};
use numeric::{Span, Wide};
use theory::prediction::transmittance;
use theory::product::Product;
use theory::rules::{Single, Weight};
use theory::{Mesh, Rule};

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(6, 200);
    let ranges: [(&str, Draw); 2] = [
        ("τ = 1e-12 … 1e3, σ̂/σ_t = 1e-9 … 1e9", of_any_size),
        ("r near 0, 1, 2, ±1e3; τ = 1e-6 … 50 collisions", of_special_ratios),
    ];
    in_parts(32, "moments", seed, |part| {
        for (range, draw) in ranges {
            part.run(trials, Row::moments("products", range), |t| products(t, draw));
        }
        let range = "τ = 1e-12 … 1e9, in units of e^{−τ} beyond 300";
        part.run(trials, [Row::stated("transmittance", range)], transmittances);
    })
}

#[derive(Debug, Clone, Copy)]
struct Case {
    extinction: f64,
    control: f64,
    sampling: f64,
    length: f64,
}

/// Draws parameters.
type Draw = fn(&mut Dice) -> Case;

fn of_any_size(dice: &mut Dice) -> Case {
    let length = dice.sized(-9.0, 9.0);
    let extinction = dice.sized(-12.0, 3.0) / length;
    Case { extinction, control: 0.0, sampling: extinction * dice.sized(-9.0, 9.0), length }
}

fn of_special_ratios(dice: &mut Dice) -> Case {
    let near = [0.0, 1.0, 2.0, 1e3, -1e3][dice.below(5)];
    let ratio = near + dice.sign() * dice.sized(-14.0, -1.0);
    let sampling = dice.sized(-3.0, 3.0);
    let control = sampling * dice.between(0.0, 2.0) + (-ratio * sampling).max(0.0);
    let extinction = (control + ratio * sampling).max(0.0);
    Case { extinction, control, sampling, length: dice.sized(-6.0, 1.7) / sampling }
}

/// `E[(1 − W)^k]` at a collision, in 32 digits, for k = 2, 3, 4.
fn losses(rule: Single, ratio: Wide) -> [Wide; 3] {
    let left = 1.0 - ratio;
    let is_below = left.high >= 0.0;
    let (death, loss) = if let Single::NonTerminating { albedo } = rule {
        let scattered = ratio.abs() * albedo;
        let sum = scattered + left.abs();
        (scattered / sum, if is_below { 1.0 - sum } else { 1.0 + sum })
    } else {
        (1.0 - left.abs(), if is_below { Wide::default() } else { Wide::from(2.0) })
    };
    [2, 3, 4].map(|k| death + (1.0 - death) * loss.powi(k))
}

/// `m₂` and `m₄` of J₂, J₃ and J₄.
fn central([j2, j3, j4]: [Wide; 3]) -> [Wide; 2] {
    if j2.high.abs() > 1.0 {
        let [e2, e3, e4] = [j2, j2 * 3.0 - j3, j2 * 6.0 - j3.scaled(2) + j4].map(Wide::exp);
        return [j2.exp_m1(), e4 - e3.scaled(2) + e2 * 6.0 - 3.0];
    }
    let (u, v, z) = (j2.exp_m1(), (-j3).exp_m1(), j4.exp_m1());
    let cube = (1.0 + u).powi(3);
    let mixed = u.scaled(2) * (3.0 + u * (3.0 + u)) + cube * v * (6.0 + v * (4.0 + v));
    let fourth = u * u * (3.0 + u * (16.0 + u * (15.0 + u * (6.0 + u))))
        + cube * v * mixed
        + (j2 * 6.0 - j3.scaled(2)).exp() * z;
    [u, fourth]
}

fn products(t: &mut Trial, draw: Draw) -> Option<()> {
    let case = draw(t.dice);
    let Case { extinction, control, sampling, length } = case;
    t.place = format!("{case:?}");
    let mesh = Mesh::new(homogeneous(extinction, length)?);
    let span = Span::new(0.0, length);
    let (flown, main) = (Piecewise::constant(sampling, span), Piecewise::constant(control, span));
    let main = if control == 0.0 { Control::None } else { Control::Pieces(main) };
    let ratio = (Wide::from(extinction) - control) / sampling;
    let non_terminating = Single::NonTerminating { albedo: t.dice.between(0.0, 1.0) };
    let terminating = (0.0..=2.0).contains(&ratio.high).then_some(Single::Terminating);
    let mut of_rule = |name: &str, rule: &dyn Rule, losses: [Wide; 3]| {
        t.place = format!("{name}, r = {:e}, {case:?}", ratio.high);
        let found = Product { laws: false, ..Product::new(&mesh, &flown, &main, rule) }.predict();
        let Some(moments) = found.channels[0].moments else {
            t.skip(0);
            return t.skip(1);
        };
        let losses = losses.map(|loss| loss * Wide::product(sampling, length));
        let [j2, j3, j4] = losses;
        let exponents = [j2, j2 * 6.0 - j3.scaled(2) + j4];
        let pairs = [moments.relative[0], moments.relative[2]].into_iter().zip(central(losses));
        for (row, ((found, exact), exponent)) in pairs.zip(exponents).enumerate() {
            // What overflows must be infinite, never not a number, and nothing else may be.
            if exponent.high > 690.0 || !exact.high.is_finite() {
                t.see(row, if found > 1e290 { 0.0 } else { f64::NAN });
            } else if exact.high.abs() < 1e-300 {
                t.skip(row);
            } else {
                t.see(row, exact.relative_error(found) / moments.error);
            }
        }
    };
    of_rule("ratio", &Weight, [2, 3, 4].map(|k| ratio.powi(k)));
    for rule in [Some(non_terminating), terminating].into_iter().flatten() {
        let losses = losses(rule, ratio);
        if losses.iter().all(|loss| loss.high.is_finite()) {
            of_rule(&format!("{rule:?}"), &rule, losses);
        }
    }
    Some(())
}

/// T itself, and T in units of `e^{−τ}` where it underflows.
fn transmittances(t: &mut Trial) -> Option<()> {
    let (length, depth) = (t.dice.sized(-9.0, 9.0), t.dice.sized(-12.0, 9.0));
    let extinction = depth / length;
    let medium = homogeneous(extinction, length)?;
    let depth = medium.optical_depth(medium.span());
    let unit = if depth.value > 300.0 { depth.value } else { 0.0 };
    let found = transmittance(depth, unit);
    let exact = (unit - Wide::product(extinction, length)).exp();
    t.place = format!("τ = {:e}", depth.value);
    t.see(0, off(found.value, exact) / found.error);
    Some(())
}
