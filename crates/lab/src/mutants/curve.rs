//! Wrong curves of the transmittance.
//!
//! ```text
//! T̂(s) = T_c(s) ∏_{tᵢ < s} (1 − r(tᵢ)),  T_c(s) = exp(−∫₀ˢ σ_c),  all s from one walk
//! ```
//!
//! The curve sees what its last value hides: a reversed medium, a collision that counts too early,
//! a control that is right at the end only. One walk for each distance has the right means and
//! variances, and no covariances.

use super::line::{self, Notes, RIGHT, Slip};
use super::{Mutant, MutantRow, On, family, on, one_by_one};
use estimators::Setup;
use estimators::transmittance_curve::double::Curve;
use gate::CheckId;
use numeric::Lane;
use theory::problems::TransmittanceCurve;
use theory::problems::transmittance::CurveValues;

/// A curve without a control.
const PLAIN: On<()> = on("transmittance/curve-known-bugs", 0, ());
/// A curve with a control that has knots on the ray.
const CONTROL: On<()> = on("transmittance/curve-known-bugs", 1, ());

/// A bug in a step, in `T_c(s)`, in the number of walks, or in the finished curve.
#[derive(Clone, Copy)]
struct Bug {
    slip: Slip,
    prepare: fn(&mut Setup<TransmittanceCurve>),
    /// True if every distance has a walk of its own.
    is_fresh: bool,
    finish: fn(&mut CurveValues),
}

const NONE: Bug = Bug { slip: RIGHT, prepare: |_| {}, is_fresh: false, finish: |_| {} };

const fn step(slip: Slip) -> Bug {
    Bug { slip, ..NONE }
}

#[rustfmt::skip] // one mutant, one entry
const LINES: &[MutantRow<(), Bug>] = &[
    ("curve-reversed", "σ_t(S − t) is looked up for σ_t(t)", PLAIN, CheckId::Curve, step(line::REVERSED)),
    ("curve-collision-too-early", "the first collision beyond a distance counts before it", PLAIN, CheckId::Mean, step(line::OF_LAST_COLLISION)),
    ("curve-shifted", "every value is that of the distance before, and the first is 1", PLAIN, CheckId::Mean, Bug { finish: shifted, ..NONE }),
    ("curve-control-whole", "T_c is that of the whole ray at every distance", CONTROL, CheckId::Mean, Bug { prepare: whole_control, ..NONE }),
    ("curve-control-to-collision", "between collisions the curve is flat: T_c is taken at the last collision before s", CONTROL, CheckId::Mean, Bug { prepare: |setup| setup.fields.control_curve.fill(1.0), ..step(Slip { computed: Some(with_decay), ..RIGHT }) }),
    ("curve-log2", "log2 for ln in the flight", CONTROL, CheckId::Lookups, step(line::LOG2)),
    ("curve-of-fresh-walks", "every distance has a walk of its own", PLAIN, CheckId::Covariance, Bug { is_fresh: true, ..NONE }),
];

/// The family.
pub fn mutants() -> Vec<Mutant<TransmittanceCurve>> {
    let draws = |(): &(), &bug: &Bug| {
        one_by_one(move |setup, medium, random| {
            let mut draw = || line::draw(Curve::new(setup), &bug.slip, setup, medium, random);
            let mut curve = draw();
            if bug.is_fresh {
                for k in 0..curve.value.count - 1 {
                    curve.value.at[k] = draw().value.at[k];
                }
            }
            (bug.finish)(&mut curve.value);
            curve
        })
    };
    let mutants = family(LINES, &NONE, draws).into_iter().zip(LINES);
    mutants.map(|(mutant, line)| Mutant { prepare: line.4.prepare, ..mutant }).collect()
}

/// Every value is that of the distance before.
fn shifted(curve: &mut CurveValues) {
    curve.at[..curve.count].rotate_right(1);
    curve.at[0] = 1.0;
}

/// `T_c(s) = T_c(S)`.
fn whole_control(setup: &mut Setup<TransmittanceCurve>) {
    let whole = setup.fields.control.optical_depth(setup.fields.mesh.support()).value;
    setup.fields.control_curve.fill((-whole).exp());
}

/// σ_t with which the weight of a walk decays as the control does, collision by collision.
fn with_decay(walk: &mut Notes, computed: f64) -> f64 {
    let decay = Lane::exp(-walk.control_depth(walk.from, walk.t));
    let control = walk.control.extinction(walk.t);
    let kept = ((computed - control) * walk.mean_free_path).one_minus() * decay;
    kept.one_minus() / walk.mean_free_path + control
}
