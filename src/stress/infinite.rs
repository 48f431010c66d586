//! Media without end, and those that begin at a plane: Case's formula and Chandrasekhar's H-function by the
//! trapezoidal rule in 32 digits.
//!
//! A rule with even steps of t converges like `e^{−2πd/h}`, d the distance of the nearest singularity from
//! the real axis. Case's integral in `ν = tanh y`, `y = ln(1 + e^t)`, and that of H in `x = e^t`,
//!
//! ```text
//! ln H(μ) = −(μ/π) ∫₀^∞ ln(1 − a artan(x)/x) dx/(1 + μ²x²)
//! ```
//!
//! have theirs at π/2: h = 1/6 leaves 1e-26.

use super::trial::{Trial, share};
use super::{Effort, Row, in_parts};
use numeric::{Known, Wide};
use theory::h_function::{self, h_function};
use theory::space::infinite;

/// Steps of t per unit.
const STEPS: i32 = 6;

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(1, 12);
    let (nodes, angles) = (cut_nodes(), angles());
    in_parts(16, "infinite", seed, |part| {
        let range = "c = 0 … 1 − 1e-15, distances 1e-8 …";
        let rows = [
            Row::stated("collisions within a radius", format!("{range} 1e4")),
            Row::stated("fluence of a point source", format!("{range} 600")),
        ];
        part.run(trials, rows, |t| case(t, &nodes));
        let range = "a = 0 … 1 − 1e-15, mean cosines −1 … 1";
        part.run(20 * trials, [Row::stated("squared distance at absorption", range)], totals);
        let (name, range) = ("Chandrasekhar's H-function", "a = 0 … 1, μ = 1e-9 … 1");
        let rows = [Row::relative(name, range, h_function::ERROR)];
        part.run(trials, rows, |t| half_space(t, &angles));
    })
}

fn n(x: f64) -> Wide {
    Wide::from(x)
}

/// A place of Case's integral: y, ν and `dν` there.
struct Node {
    y: Wide,
    nu: Wide,
    weight: Wide,
}

fn cut_nodes() -> Vec<Node> {
    // Below e⁻⁷⁶ lies 1e-33 of the integral, above e³¹ 1e-27.
    let steps = -76 * STEPS..=31 * STEPS;
    let node = |i: i32| {
        let w = (n(f64::from(i)) / f64::from(STEPS)).exp();
        // tanh ln(1 + w), without the exponential.
        let square = w * w + w.scaled(1) + 2.0;
        let nu = (w * w + w.scaled(1)) / square;
        let rest = ((w + 1.0) / square).powi(2).scaled(2);
        Node { y: w.ln_1p(), nu, weight: rest * w / (1.0 + w) / f64::from(STEPS) }
    };
    steps.map(node).collect()
}

/// `1 − (1 + x)e^{−x}`.
fn within(x: Wide) -> Wide {
    if x.high > 1.0 {
        return 1.0 - (1.0 + x) * (-x).exp();
    }
    let (mut sum, mut power) = (Wide::default(), -x);
    for k in 2..=34 {
        let k = f64::from(k);
        power = -(power * x) / k;
        sum += power * (k - 1.0);
    }
    sum
}

/// κ and `1 − κ²`; nothing is left of the pole where it is not asked for.
fn pole(albedo: f64) -> Option<[Wide; 2]> {
    if albedo < 0.01 {
        return None;
    }
    let c = n(albedo);
    let (mut low, mut high) = (0.0, 1.0 / albedo + 1.0);
    for _ in 0..200 {
        let y = 0.5 * (low + high);
        if y / f64::tanh(y) > 1.0 / albedo { high = y } else { low = y }
    }
    // y coth y − 1 = 1/c − 1, of which 1 − c is exact; in 32 digits two steps are left to do.
    let mut y = n((0.5 * (low + high)).max((3.0 * (1.0 - albedo)).sqrt()));
    let wanted = (1.0 - c) / c;
    for _ in 0..4 {
        let (sine, cosine) = hyperbolic(y);
        let f = (y * cosine - sine) / sine - wanted;
        let slope = cosine / sine - y / (sine * sine);
        y = y - f / slope;
    }
    let (sine, cosine) = hyperbolic(y);
    Some([sine / cosine, 1.0 / (cosine * cosine)])
}

/// sinh and cosh.
fn hyperbolic(y: Wide) -> (Wide, Wide) {
    let grown = y.exp_m1();
    let inverse = 1.0 / (grown + 1.0);
    ((grown + grown * inverse).scaled(-1), (grown + 1.0 + inverse).scaled(-1))
}

fn case(t: &mut Trial, nodes: &[Node]) {
    let albedo = share(t.dice).min(1.0 - 1e-15);
    let c = n(albedo);
    let of_node = |node: &Node| {
        let a = 1.0 - c * node.nu * node.y;
        let b = Wide::PI.scaled(-1) * c * node.nu;
        node.weight / (a * a + b * b)
    };
    let g: Vec<Wide> = nodes.iter().map(of_node).collect();
    let pole = pole(albedo);
    for _ in 0..8 {
        let near = t.dice.sized(-8.0, 2.77);
        let far = if t.dice.below(4) == 0 { t.dice.sized(0.0, 4.0) } else { near };
        t.place = format!("c = {albedo:e}, σ_t r = {far:e}");
        let found = infinite::collisions_within(albedo, far);
        t.stated(0, found, collisions(n(far), nodes, &g, pole, c));
        t.place = format!("c = {albedo:e}, σ_t r = {near:e}");
        t.stated(1, infinite::fluence(albedo, near), around(n(near), nodes, &g, pole, c));
    }
}

fn collisions(r: Wide, nodes: &[Node], g: &[Wide], pole: Option<[Wide; 2]>, c: Wide) -> Wide {
    let terms = nodes.iter().zip(g).map(|(node, &g)| {
        let x = r / node.nu;
        if x.high > 80.0 { g } else { g * within(x) }
    });
    let sum: Wide = terms.sum();
    let Some([kappa, rest]) = pole else { return sum };
    sum + rest.scaled(1) / (c * (c - rest)) * within(kappa * r)
}

fn around(r: Wide, nodes: &[Node], g: &[Wide], pole: Option<[Wide; 2]>, c: Wide) -> Wide {
    let terms = nodes.iter().zip(g).filter(|(node, _)| r.high < 740.0 * node.nu.high);
    let sum: Wide = terms.map(|(node, &g)| g * (-(r / node.nu)).exp() / (node.nu * node.nu)).sum();
    let settled = pole.map(|[kappa, rest]| {
        kappa * kappa * rest.scaled(1) / (c * (c - rest)) * (-(kappa * r)).exp()
    });
    (sum + settled.unwrap_or_default()) / (Wide::PI.scaled(2) * r)
}

/// The square of the distance where collisions end.
fn totals(t: &mut Trial) {
    let albedo = share(t.dice).min(1.0 - 1e-15);
    let cosine = t.dice.between(-1.0, 1.0);
    let exact = 2.0 / ((1.0 - n(albedo)) * (1.0 - Wide::product(albedo, cosine)));
    let found = infinite::square_at_absorption(albedo, cosine);
    t.place = format!("a = {albedo:e}, g = {cosine:e}");
    t.stated(0, Known::new(found, infinite::ROUNDING * found), exact);
}

/// x, its arc tangent over x, and `dx`.
fn angles() -> Vec<[Wide; 3]> {
    let steps = -50 * STEPS..=50 * STEPS;
    let angle = |i: i32| {
        let x = (n(f64::from(i)) / f64::from(STEPS)).exp();
        // What the double leaves: tan of the difference, which is the difference.
        let near = n(x.high.atan());
        let [sine, cosine] = near.sin_cos();
        let arc = near + (x * cosine - sine) / (cosine + x * sine);
        let ratio = if x.high < 1e-8 { 1.0 - x * x / 3.0 } else { arc / x };
        [x, ratio, x / f64::from(STEPS)]
    };
    steps.map(angle).collect()
}

/// `1 − artan(x)/x`, which cancels where x is small.
fn bent(&[x, ratio, _]: &[Wide; 3]) -> Wide {
    if x.high >= 0.02 {
        return 1.0 - ratio;
    }
    let terms = (1..12).rev().map(|k| {
        let term = 1.0 / n(f64::from(2 * k + 1));
        if k % 2 == 1 { term } else { -term }
    });
    terms.fold(Wide::default(), |sum, term| sum * (x * x) + term) * (x * x)
}

fn half_space(t: &mut Trial, angles: &[[Wide; 3]]) {
    let albedo = share(t.dice);
    let log = |angle| ((1.0 - n(albedo)) + albedo * bent(angle)).ln();
    let logs: Vec<Wide> = angles.iter().map(log).collect();
    for _ in 0..8 {
        let grazes = t.dice.below(3) == 0;
        let cosine = if grazes { t.dice.sized(-9.0, 0.0) } else { t.dice.between(0.0, 1.0) };
        let mu = n(cosine);
        let terms = angles.iter().zip(&logs);
        let integral: Wide =
            terms.map(|(&[x, _, dx], &log)| log * dx / (1.0 + (mu * x).powi(2))).sum();
        t.place = format!("a = {albedo:e}, μ = {cosine:e}");
        t.relative(0, h_function(albedo, cosine), (-(mu * integral / Wide::PI)).exp());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::trial::of_stated;

    #[test]
    fn without_scattering_the_rule_has_closed_forms() {
        let nodes = cut_nodes();
        let g: Vec<Wide> = nodes.iter().map(|node| node.weight).collect();
        for r in [1e-6, 0.3, 40.0] {
            let exact = -(-n(r)).exp_m1();
            let found = collisions(n(r), &nodes, &g, None, Wide::default());
            assert!(((found - exact) / exact).abs().value() < 1e-24, "{r}");
        }
    }

    #[test]
    fn a_thousandth_of_the_stated_error_breaks_the_row() {
        let nodes = cut_nodes();
        let g: Vec<Wide> = nodes.iter().map(|node| node.weight).collect();
        // Far away, rounding of the exponent is most of the error.
        let exact = around(n(599.7), &nodes, &g, None, Wide::default());
        let found = infinite::fluence(0.0, 599.7);
        assert!(of_stated(found, exact) <= 1.0);
        let understated = Known::new(found.value, 1e-3 * found.error);
        assert!(of_stated(understated, exact) > 1.0, "{found:?}");
    }

    #[test]
    fn a_half_space_that_absorbs_nothing_has_the_value_of_the_tables() {
        // Chandrasekhar, table XI: H(1) = 2.9078 at a = 1.
        assert!((h_function(1.0, 1.0) - 2.9078).abs() < 5e-5);
    }
}
