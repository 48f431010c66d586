//! Wrong curves of the transmittance.
//!
//! ```text
//! T̂(s) = T_c(s) ∏_{tᵢ < s} (1 − r(tᵢ)),  T_c(s) = exp(−∫₀ˢ σ_c),  all s from one walk
//! ```
//!
//! The curve sees what its last value hides: a reversed medium, a collision that counts too early,
//! a control that is right at the end only. One walk for each distance has the right means and
//! variances, and no covariances.

use super::line::{Slip, Wrong};
use super::{Line, Mutant, Target, family, on, with};
use estimators::transmittance_curve::double::Curve;
use estimators::{Draw, Setup, walks};
use media::Lookups;
use numeric::rng::Stream;
use theory::problems::TransmittanceCurve;
use theory::problems::transmittance::CurveValues;

/// A curve without a control.
const PLAIN: Target = on("transmittance/curve-known-bugs", 0);
/// A curve with a control that has knots on the ray.
const CONTROL: Target = on("transmittance/curve-known-bugs", 1);

/// A bug in a step, in `T_c(s)`, or in the number of walks.
#[derive(Clone, Copy, PartialEq)]
enum Bug {
    Step(Slip),
    WholeControl,
    FreshWalks,
}

#[rustfmt::skip] // one mutant, one entry
const LINES: &[Line<Bug>] = &[
    ("curve-reversed", "σ_t(S − t) is looked up for σ_t(t)", PLAIN, "curve", Bug::Step(Slip::Reversed)),
    ("curve-collision-too-early", "the first collision beyond a distance counts before it", PLAIN, "mean", Bug::Step(Slip::OfLastCollision)),
    ("curve-shifted", "every value is that of the distance before, and the first is 1", PLAIN, "mean", Bug::Step(Slip::Shifted)),
    ("curve-control-whole", "T_c is that of the whole ray at every distance", CONTROL, "mean", Bug::WholeControl),
    ("curve-control-to-collision", "between collisions the curve is flat: T_c is taken at the last collision before s", CONTROL, "mean", Bug::Step(Slip::ControlToCollision)),
    ("curve-log2", "log2 for ln in the flight", CONTROL, "lookups", Bug::Step(Slip::Deeper(std::f64::consts::LOG2_E))),
    ("curve-of-fresh-walks", "every distance has a walk of its own", PLAIN, "covariance", Bug::FreshWalks),
];

/// The family.
pub fn mutants() -> Vec<Mutant<TransmittanceCurve>> {
    let mutants = family(LINES, &Bug::Step(Slip::None), |_, &bug| with(bug, draw));
    let each = mutants.into_iter().zip(LINES).map(|(mutant, line)| match line.4 {
        Bug::WholeControl => Mutant {
            prepare: |setup: &mut Setup<TransmittanceCurve>| {
                let whole = setup.fields.control.optical_depth(setup.fields.mesh.support()).value;
                setup.fields.control_curve.fill((-whole).exp());
            },
            ..mutant
        },
        // The walk itself has the decay of the control.
        Bug::Step(Slip::ControlToCollision) => Mutant {
            prepare: |setup: &mut Setup<TransmittanceCurve>| setup.fields.control_curve.fill(1.0),
            ..mutant
        },
        _ => mutant,
    });
    each.collect()
}

/// A curve of one walk, or of a walk for each distance, with the lookups of one.
fn draw(
    bug: &Bug,
    setup: &Setup<TransmittanceCurve>,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw<CurveValues> {
    let slip = if let Bug::Step(slip) = *bug { slip } else { Slip::None };
    let walk = Wrong::new(Curve::new(setup), slip, setup);
    let mut draw: Draw<CurveValues> = walks::draw(&walk, &setup.fields.sampling, medium, random);
    if *bug == Bug::FreshWalks {
        for k in 0..draw.value.count - 1 {
            let fresh: Draw<CurveValues> =
                walks::draw(&walk, &setup.fields.sampling, medium, random);
            draw.value.at[k] = fresh.value.at[k];
        }
    }
    draw
}
