//! Wrong curves of the transmittance.
//!
//! ```text
//! T̂(s) = T_c(s) ∏_{tᵢ < s} (1 − r(tᵢ)),  T_c(s) = exp(−∫₀ˢ σ_c),  all s from one walk
//! ```
//!
//! The curve sees what its last value hides: a reversed medium, a collision that counts too early,
//! a control that is right at the end only. One walk for each distance has the right means and
//! variances, and no covariances.

use super::target::{CURVE, CURVE_CONTROL};
use super::{About, Mutant, with};
use estimators::transmittance::product::Invariant;
use estimators::{Draw, Setup};
use media::{Extinction, Lookups};
use numeric::rng::{Stream, exponential};
use numeric::{Lane, Span};
use theory::problems::TransmittanceCurve;
use theory::problems::transmittance::{CurveValues, MAX_DISTANCES};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<TransmittanceCurve>> {
    let by = |slip| with(slip, |&slip, setup, medium, rng| curve(slip, setup, medium, rng));
    let of = |name, bug, target, check, slip| Mutant::new(About { name, bug, target, check }, by(slip), by(Slip::None));
    let fresh = About { name: "curve-of-fresh-walks", bug: "every distance has a walk of its own", target: CURVE, check: "covariance" };
    vec![
        of("curve-reversed", "σ_t(S − t) is looked up for σ_t(t)", CURVE, "curve", Slip::Reversed),
        of("curve-collision-too-early", "the first collision beyond a distance counts before it", CURVE, "mean", Slip::TooEarly),
        of("curve-shifted", "every value is that of the distance before, and the first is 1", CURVE, "mean", Slip::Shifted),
        of("curve-control-whole", "T_c is that of the whole ray at every distance", CURVE_CONTROL, "mean", Slip::WholeControl),
        of("curve-control-to-collision", "between collisions the curve is flat: T_c is taken at the last collision before s", CURVE_CONTROL, "mean", Slip::ControlToCollision),
        of("curve-log2", "log2 for ln in the flight", CURVE_CONTROL, "lookups", Slip::Log2),
        Mutant::new(fresh, with((), |(), setup, medium, random| fresh_walks(setup, medium, random)), by(Slip::None)),
    ]
}

/// What goes wrong.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    None,
    Reversed,
    TooEarly,
    Shifted,
    WholeControl,
    ControlToCollision,
    Log2,
}

/// The double particle model's curve, see `estimators/transmittance_curve/double.rs`.
fn curve(
    slip: Slip,
    setup: &Setup<TransmittanceCurve>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<CurveValues> {
    let support = setup.mesh.support();
    let distances = setup.problem.ascending();
    let mut values = CurveValues { at: [0.0; MAX_DISTANCES], count: distances.len() };
    let mut next = 0;
    let mut pass = |until: f64, last: f64, weight: f64| {
        while next < distances.len() && distances[next] <= until {
            let to = match slip {
                Slip::WholeControl => support.to,
                Slip::ControlToCollision => last,
                _ => distances[next],
            };
            let upto = Span::new(support.from, to).intersect(support);
            let depth = setup.control.optical_depth(upto).value;
            values.at[next] = weight * Lane::exp(-depth);
            next += 1;
        }
    };
    let mut cursor = setup.sampling.begin();
    let mut weight = 1.0;
    let mut invariant = Invariant::open(weight);
    let mut lookups = 0;
    loop {
        let last = cursor.t;
        let scale = if slip == Slip::Log2 { std::f64::consts::LOG2_E } else { 1.0 };
        let depth = exponential(rng) * scale;
        let Some(sampling) = setup.sampling.fly(&mut cursor, depth) else {
            pass(f64::INFINITY, last, weight);
            break;
        };
        if slip != Slip::TooEarly {
            pass(cursor.t, last, weight);
        }
        let reversed = support.from + (support.to - cursor.t);
        let at = if slip == Slip::Reversed { reversed } else { cursor.t };
        let residual = medium.extinction(at) - setup.control.extinction(cursor.t);
        let due = 1.0 - residual * (1.0 / sampling);
        invariant.take(weight, due);
        weight *= due;
        lookups += 1;
        if slip == Slip::TooEarly {
            pass(cursor.t, last, weight);
        }
    }
    if slip == Slip::Shifted {
        values.at.rotate_right(1);
        values.at[0] = 1.0;
    }
    Draw { value: values, lookups, defect: invariant.defect(weight) }
}

/// K walks for K distances, with the lookups of the last.
fn fresh_walks(
    setup: &Setup<TransmittanceCurve>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<CurveValues> {
    let walk = |rng: &mut Stream| curve(Slip::None, setup, medium, rng);
    let mut draw = walk(rng);
    for k in 0..draw.value.count - 1 {
        let fresh = walk(rng);
        draw.value.at[k] = fresh.value.at[k];
    }
    draw
}
