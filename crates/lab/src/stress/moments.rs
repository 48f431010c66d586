//! Moments of product estimators in media of any thickness at any σ̂, against their closed form.
//!
//! ```text
//! constant σ_t, σ_c and σ̂ on a length ℓ:  J_k = σ̂ℓ E[(1 − W)^k],
//! m₂ = expm1 J₂, and so on as in `theory::prediction::moments`, without cancellation and in 32 digits
//! ```

use super::fields::homogeneous;
use super::prelude::*;
use theory::collisions::Rule;
use theory::collisions::rules::{Single, Weight};
use theory::prediction::transmittance;
use theory::ray::product::Product;

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let trials = [192, 6400];
    let rows = TrialRow::moments("products", "τ = 1e-12 … 1e3, σ̂/σ_t = 1e-9 … 1e9");
    let mut rows = run.fill(trials, rows, of_any_size, products);
    let special = TrialRow::moments("products", "r near 0, 1, 2, ±1e3; τ = 1e-6 … 50 collisions");
    rows.extend(run.fill(trials, special, of_special_ratios, products));
    let row = TrialRow::stated("transmittance", "τ = 1e-12 … 1e9, in units of e^{−τ} beyond 300");
    rows.extend(run.fill(trials, [row], Depth::any, transmittances));
    rows
}

/// A homogeneous medium, and how it is walked.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// σ_t.
    pub extinction: f64,
    /// σ_c.
    pub control: f64,
    /// σ̂.
    pub sampling: f64,
    /// Length of the ray.
    pub length: f64,
    /// Albedo of the non-terminating rule.
    pub albedo: f64,
}

parameters! {
    /// A homogeneous medium.
    Depth {
        length: f64 = sized(-9.0, 9.0),
        depth: f64 = sized(-12.0, 9.0),
    }
}

fn of_any_size() -> impl Strategy<Value = Case> {
    (sized(-9.0, 9.0), sized(-12.0, 3.0), sized(-9.0, 9.0), between(0.0, 1.0)).prop_map(
        |(length, depth, ratio, albedo)| {
            let extinction = depth / length;
            Case { extinction, control: 0.0, sampling: extinction * ratio, length, albedo }
        },
    )
}

fn of_special_ratios() -> impl Strategy<Value = Case> {
    let ratio = (any_of(&[0.0, 1.0, 2.0, 1e3, -1e3]), sign(), sized(-14.0, -1.0))
        .prop_map(|(near, sign, off)| near + sign * off);
    let rest = (sized(-3.0, 3.0), between(0.0, 2.0), sized(-6.0, 1.7), between(0.0, 1.0));
    (ratio, rest).prop_map(|(ratio, (sampling, share, collisions, albedo))| {
        let control = sampling * share + (-ratio * sampling).max(0.0);
        let extinction = (control + ratio * sampling).max(0.0);
        Case { extinction, control, sampling, length: collisions / sampling, albedo }
    })
}

/// `E[(1 − W)^k]` at a collision, in 32 digits, for k = 2, 3, 4.
fn losses(rule: Single, ratio: DoubleDouble) -> [DoubleDouble; 3] {
    let left = 1.0 - ratio;
    let is_below = left.high >= 0.0;
    let (death, loss) = if let Single::NonTerminating { albedo } = rule {
        let scattered = ratio.abs() * albedo;
        let sum = scattered + left.abs();
        (scattered / sum, if is_below { 1.0 - sum } else { 1.0 + sum })
    } else {
        (1.0 - left.abs(), if is_below { DoubleDouble::default() } else { DoubleDouble::from(2.0) })
    };
    [2, 3, 4].map(|k| death + (1.0 - death) * loss.powi(k))
}

/// `m₂` and `m₄` of J₂, J₃ and J₄.
fn central([j2, j3, j4]: [DoubleDouble; 3]) -> [DoubleDouble; 2] {
    // J₄ may be large beside a small J₂: then nothing cancels, and e^{J₄} alone may overflow.
    if j2.high.abs().max(j4.high.abs()) > 1.0 {
        let [e2, e3, e4] = [j2, j2 * 3.0 - j3, j2 * 6.0 - j3.scaled(2) + j4].map(DoubleDouble::exp);
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

/// Compares the variance and the fourth moment of all product estimators of transmittance.
pub fn products(case: &Case, seen: &mut Seen) {
    let &Case { extinction, control, sampling, length, albedo } = case;
    let mesh = Mesh::new(homogeneous(extinction, length));
    let span = Span::new(0.0, length);
    let (flown, main) = (Piecewise::constant(sampling, span), Piecewise::constant(control, span));
    let main = if control == 0.0 { Control::None } else { Control::Pieces(main) };
    let ratio = (DoubleDouble::from(extinction) - control) / sampling;
    let non_terminating = Single::NonTerminating { albedo };
    let terminating = (0.0..=2.0).contains(&ratio.high).then_some(Single::Terminating);
    let mut of_rule = |name: &str, rule: &dyn Rule, losses: [DoubleDouble; 3]| {
        seen.at(name);
        let computed =
            Product { with_distributions: false, ..Product::new(&mesh, &flown, &main, rule) }
                .predict();
        let Some(moments) = computed.channels[0].moments else {
            seen.skip(0);
            return seen.skip(1);
        };
        let losses = losses.map(|loss| loss * DoubleDouble::product(sampling, length));
        let [j2, j3, j4] = losses;
        let exponents = [j2, j2 * 6.0 - j3.scaled(2) + j4];
        let pairs = [moments.relative[0], moments.relative[2]].into_iter().zip(central(losses));
        for (row, ((computed, exact), exponent)) in pairs.zip(exponents).enumerate() {
            // What overflows must be infinite, never not a number, and nothing else may be.
            if exponent.high > 690.0 || !exact.high.is_finite() {
                seen.see(row, if computed > 1e290 { 0.0 } else { f64::NAN });
            } else if exact.high.abs() < 1e-300 {
                seen.skip(row);
            } else {
                seen.see(row, exact.relative_error(computed) / moments.error);
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
}

/// T itself, and T in units of `e^{−τ}` where it underflows.
fn transmittances(&Depth { length, depth }: &Depth, seen: &mut Seen) {
    let extinction = depth / length;
    let medium = homogeneous(extinction, length);
    let depth = medium.optical_depth(medium.span());
    let unit = if depth.value > 300.0 { depth.value } else { 0.0 };
    let computed = transmittance(depth, unit);
    let exact = (unit - DoubleDouble::product(extinction, length)).exp();
    seen.see(0, off(computed.value, exact) / computed.error);
}
