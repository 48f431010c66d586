//! Media without end, and those that begin at a plane: Case's formula and Chandrasekhar's H-function by the
//! trapezoidal rule in 32 digits.
//!
//! A rule with even steps of t converges like `e^{−2πd/h}`, d the distance of the nearest singularity from
//! the real axis. Case's integral in `ν = tanh y`, `y = ln(1 + e^t)`, and that of H in `φ = ½π/(1 + e^{−t})`,
//!
//! ```text
//! ln H(μ) = −(μ/π) ∫ ln(1 − aφ cot φ) dφ/(cos²φ + μ² sin²φ)
//! ```
//!
//! have theirs at π/2: h = 1/6 leaves 1e-26.

use super::prelude::*;
use crate::h_function::{self, h_function};
use theory::space::infinite;

/// Steps of t per unit.
const STEPS: i32 = 6;

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let (nodes, angles) = (cut_nodes(), angles());
    let range = "c = 0 … 1 − 1e-15, distances 1e-8 …";
    let of_case = [
        TrialRow::stated("collisions within a radius", format!("{range} 1e4")),
        TrialRow::stated("fluence of a point source", format!("{range} 600")),
    ];
    let mut rows = run.fill([16, 192], of_case, Distances::any, |p, seen| case(p, &nodes, seen));
    let row = TrialRow::stated(
        "squared distance at absorption",
        "a = 0 … 1 − 1e-15, mean cosines −1 … 1",
    );
    rows.extend(run.fill([320, 3840], [row], || (share(), between(-1.0, 1.0)), totals));
    let range = "a = 0 … 1, μ = 1e-9 … 1";
    let row = TrialRow::relative("Chandrasekhar's H-function", range, h_function::ERROR);
    rows.extend(run.fill([16, 192], [row], Cosines::any, |p, seen| half_space(p, &angles, seen)));
    rows
}

parameters! {
    /// Distances from a point source in mean free paths.
    Distances {
        albedo: f64 = share(),
        near: Vec<f64> = vec(sized(-8.0, 2.77), 8),
        far: Vec<f64> = vec(prop_oneof![3 => sized(-8.0, 2.77), 1 => sized(0.0, 4.0)], 8),
    }
    /// Directions out of a half space.
    Cosines {
        albedo: f64 = share(),
        cosines: Vec<f64> = vec(prop_oneof![1 => sized(-9.0, 0.0), 2 => between(0.0, 1.0)], 8),
    }
}

fn n(x: f64) -> DoubleDouble {
    DoubleDouble::from(x)
}

/// A place of Case's integral: y, ν and `dν` there.
struct CaseNode {
    y: DoubleDouble,
    nu: DoubleDouble,
    weight: DoubleDouble,
}

fn cut_nodes() -> Vec<CaseNode> {
    // Below e⁻⁷⁶ lies 1e-33 of the integral, above e³¹ 1e-27.
    let steps = -76 * STEPS..=31 * STEPS;
    let node = |i: i32| {
        let w = (n(f64::from(i)) / f64::from(STEPS)).exp();
        // tanh ln(1 + w), without the exponential.
        let square = w * w + w.scaled(1) + 2.0;
        let nu = (w * w + w.scaled(1)) / square;
        let rest = ((w + 1.0) / square).powi(2).scaled(2);
        CaseNode { y: w.ln_1p(), nu, weight: rest * w / (1.0 + w) / f64::from(STEPS) }
    };
    steps.map(node).collect()
}

/// `1 − (1 + x)e^{−x}`.
fn within(x: DoubleDouble) -> DoubleDouble {
    if x.high > 1.0 {
        return 1.0 - (1.0 + x) * (-x).exp();
    }
    let (mut sum, mut power) = (DoubleDouble::default(), -x);
    for k in 2..=34 {
        let k = f64::from(k);
        power = -(power * x) / k;
        sum += power * (k - 1.0);
    }
    sum
}

/// Returns κ and `1 − κ²`; `None` where the contribution of the pole is negligible.
fn pole(albedo: f64) -> Option<[DoubleDouble; 2]> {
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
    let expected = (1.0 - c) / c;
    for _ in 0..4 {
        let (sine, cosine) = hyperbolic(y);
        let f = (y * cosine - sine) / sine - expected;
        let slope = cosine / sine - y / (sine * sine);
        y = y - f / slope;
    }
    let (sine, cosine) = hyperbolic(y);
    Some([sine / cosine, 1.0 / (cosine * cosine)])
}

/// sinh and cosh.
fn hyperbolic(y: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let grown = y.exp_m1();
    let inverse = 1.0 / (grown + 1.0);
    ((grown + grown * inverse).scaled(-1), (grown + 1.0 + inverse).scaled(-1))
}

fn case(distances: &Distances, nodes: &[CaseNode], seen: &mut Seen) {
    let albedo = distances.albedo.min(1.0 - 1e-15);
    let c = n(albedo);
    let of_node = |node: &CaseNode| {
        let a = 1.0 - c * node.nu * node.y;
        let b = DoubleDouble::PI.scaled(-1) * c * node.nu;
        node.weight / (a * a + b * b)
    };
    let g: Vec<DoubleDouble> = nodes.iter().map(of_node).collect();
    let pole = pole(albedo);
    for &far in &distances.far {
        seen.at(format_args!("σ_t r = {far:e}"));
        let computed = infinite::collisions_within(albedo, far);
        seen.stated(0, computed, collisions(n(far), nodes, &g, pole, c));
    }
    for &near in &distances.near {
        seen.at(format_args!("σ_t r = {near:e}"));
        seen.stated(1, infinite::fluence(albedo, near), around(n(near), nodes, &g, pole, c));
    }
}

fn collisions(
    r: DoubleDouble,
    nodes: &[CaseNode],
    g: &[DoubleDouble],
    pole: Option<[DoubleDouble; 2]>,
    c: DoubleDouble,
) -> DoubleDouble {
    let terms = nodes.iter().zip(g).map(|(node, &g)| {
        let x = r / node.nu;
        if x.high > 80.0 { g } else { g * within(x) }
    });
    let sum: DoubleDouble = terms.sum();
    let Some([kappa, rest]) = pole else { return sum };
    sum + rest.scaled(1) / (c * (c - rest)) * within(kappa * r)
}

fn around(
    r: DoubleDouble,
    nodes: &[CaseNode],
    g: &[DoubleDouble],
    pole: Option<[DoubleDouble; 2]>,
    c: DoubleDouble,
) -> DoubleDouble {
    let terms = nodes.iter().zip(g).filter(|(node, _)| r.high < 740.0 * node.nu.high);
    let sum: DoubleDouble =
        terms.map(|(node, &g)| g * (-(r / node.nu)).exp() / (node.nu * node.nu)).sum();
    let settled = pole.map(|[kappa, rest]| {
        kappa * kappa * rest.scaled(1) / (c * (c - rest)) * (-(kappa * r)).exp()
    });
    (sum + settled.unwrap_or_default()) / (DoubleDouble::PI.scaled(2) * r)
}

/// The square of the distance where collisions end.
fn totals(&(albedo, cosine): &(f64, f64), seen: &mut Seen) {
    let albedo = albedo.min(1.0 - 1e-15);
    let exact = 2.0 / ((1.0 - n(albedo)) * (1.0 - DoubleDouble::product(albedo, cosine)));
    let computed = infinite::square_at_absorption(albedo, cosine);
    seen.stated(0, Known::new(computed, infinite::ROUNDING * computed), exact);
}

/// A place `x = tan φ` of the integral of H.
struct Angle {
    sine: DoubleDouble,
    cosine: DoubleDouble,
    /// `dφ`.
    weight: DoubleDouble,
    /// `1 − φ cot φ = 1 − artan(x)/x`.
    bent: DoubleDouble,
}

fn angles() -> Vec<Angle> {
    let angle = |i: i32| {
        let w = (n(f64::from(i)) / f64::from(STEPS)).exp();
        let quarter = DoubleDouble::PI.scaled(-1);
        // φ or π/2 − φ, whichever is smaller.
        let near = quarter / (1.0 + if i < 0 { 1.0 / w } else { w });
        let [sine, cosine] = near.sin_cos();
        let (phi, sine, cosine) =
            if i < 0 { (near, sine, cosine) } else { (quarter - near, cosine, sine) };
        let weight = quarter * w / (1.0 + w).powi(2) / f64::from(STEPS);
        let square = phi * phi;
        // The difference has no digits left where φ is small.
        let bent = if phi.high < 1e-6 {
            square / 3.0 * (1.0 + square / 15.0)
        } else {
            (sine - phi * cosine) / sine
        };
        Angle { sine, cosine, weight, bent }
    };
    (-50 * STEPS..=50 * STEPS).map(angle).collect()
}

fn half_space(parameters: &Cosines, angles: &[Angle], seen: &mut Seen) {
    let Cosines { albedo, cosines } = parameters;
    let log = |angle: &Angle| ((1.0 - n(*albedo)) + *albedo * angle.bent).ln();
    let logs: Vec<DoubleDouble> = angles.iter().map(log).collect();
    for &cosine in cosines {
        let mu = n(cosine);
        let term = |(angle, &log): (&Angle, &DoubleDouble)| {
            log * angle.weight / (angle.cosine.powi(2) + (mu * angle.sine).powi(2))
        };
        let integral: DoubleDouble = angles.iter().zip(&logs).map(term).sum();
        seen.at(format_args!("μ = {cosine:e}"));
        seen.relative(0, h_function(*albedo, cosine), (-(mu * integral / DoubleDouble::PI)).exp());
    }
}
