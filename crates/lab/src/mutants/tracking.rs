//! Mistakes of trackers with loops of their own: decomposition and local majorants.
//!
//! ```text
//! decomposition   X = 1 if the control's flight passes S and no residual collision comes before it
//! local majorant  beyond a segment's end, go back to the boundary and start again
//! ```

use super::target::{DECOMPOSITION, LOCAL_MAJORANT};
use super::{About, Mutant, with};
use estimators::{Draw, Setup};
use media::{Extinction, Lookups};
use numeric::rng::Stream;
use numeric::{Lane, Row};
use theory::problems::Transmittance;

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    let by = |whole, passes| with(Decomposition { whole, passes }, decomposition);
    let of = |name, bug, check, whole, passes| {
        Mutant::new(About { name, bug, target: DECOMPOSITION, check }, by(whole, passes), by(false, false))
    };
    let local = |overshoots| with(overshoots, |&overshoots, setup, medium, rng| local_majorant(overshoots, setup, medium, rng));
    let overshoot = About { name: "local-majorant-overshoot", bug: "a flight beyond a segment's end goes on from where it came to, not from the boundary", target: LOCAL_MAJORANT, check: "mean" };
    vec![
        of("decomposition-whole", "the chance of a real collision is σ_t/σ̂, not (σ_t − σ_c)/σ̂", "mean", true, false),
        of("decomposition-passes", "a draw without a residual collision is 1, wherever the control's flight ended", "atoms", false, true),
        Mutant::new(overshoot, local(true), local(false)),
    ]
}

/// What goes wrong in decomposition tracking.
struct Decomposition {
    /// Collides with all of σ_t.
    whole: bool,
    /// Forgets the control's flight at the end.
    passes: bool,
}

/// See `estimators/transmittance/decomposition.rs`.
fn decomposition(
    bug: &Decomposition,
    setup: &Setup<Transmittance>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw {
    let support = setup.mesh.support();
    let control = setup.control.extinction(support.from);
    let (depth, _) = (-rng.ln_uniform(), rng.word());
    let flown = depth.times_plus(1.0 / control, support.from);
    let subtracted = if bug.whole { 0.0 } else { control };
    let mut cursor = setup.sampling.begin();
    let mut lookups = 0;
    loop {
        let (depth, number) = (-rng.ln_uniform(), rng.uniform());
        let Some(sampling) = setup.sampling.fly(&mut cursor, depth) else { break };
        if flown <= cursor.t {
            break;
        }
        lookups += 1;
        if number < (medium.extinction(cursor.t) - subtracted) * (1.0 / sampling) {
            return Draw::free([0.0], lookups);
        }
    }
    let stopped = flown < support.to && !bug.passes;
    Draw::free([f64::from(u8::from(!stopped))], lookups)
}

/// Local majorants, see `estimators/transmittance/local_majorant.rs`; who overshoots does not go back to the
/// boundary.
fn local_majorant(
    overshoots: bool,
    setup: &Setup<Transmittance>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw {
    let mut lookups = 0;
    let mut came_to = setup.mesh.support().from;
    for &Row([begin, end, path, ..]) in setup.sampling.stretches() {
        let mut t = if overshoots { came_to.max(begin) } else { begin };
        while t < end {
            let (depth, number) = (-rng.ln_uniform(), rng.uniform());
            t = depth.times_plus(path, t);
            if !t.below(end) {
                break;
            }
            lookups += 1;
            if number < medium.extinction(t) * path {
                return Draw::free([0.0], lookups);
            }
        }
        came_to = t;
    }
    Draw::free([1.0], lookups)
}
