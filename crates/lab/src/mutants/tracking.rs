//! Mistakes of decomposition and of local majorants.
//!
//! ```text
//! decomposition   X = 1 if the control's flight passes S and no residual collision comes before it
//! local majorant  beyond a segment's end, go back to the boundary and start again
//! ```

use super::target::{DECOMPOSITION, LOCAL_MAJORANT};
use super::{About, Mutant, filled, with};
use estimators::transmittance::decomposition::Residual;
use estimators::{Draw, Kernel, Request, Setup, walks};
use media::{Extinction, Lookups};
use numeric::rng::Stream;
use numeric::{Lane, Row};
use theory::problems::Transmittance;

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    let right: fn(Residual) -> Residual = |right| right;
    let of = |name, bug, check, wrong: fn(Residual) -> Residual| {
        Mutant::new(About { name, bug, target: DECOMPOSITION, check }, filled(wrong, decomposition), filled(right, decomposition))
    };
    let local = |overshoots| with(overshoots, |&overshoots, setup, medium, rng| local_majorant(overshoots, setup, medium, rng));
    let overshoot = About { name: "local-majorant-overshoot", bug: "a flight beyond a segment's end goes on from where it came to, not from the boundary", target: LOCAL_MAJORANT, check: "mean" };
    vec![
        of("decomposition-whole", "the chance of a real collision is σ_t/σ̂, not (σ_t − σ_c)/σ̂", "mean", |right| Residual { subtracted: 0.0, ..right }),
        of("decomposition-passes", "a draw without a residual collision is 1, wherever the control's flight ended", "atoms", |right| Residual { end: f64::NEG_INFINITY, ..right }),
        Mutant::new(overshoot, local(true), local(false)),
    ]
}

/// Decomposition tracking, with a walk made wrong.
fn decomposition(
    wrong: fn(Residual) -> Residual,
    kernel: Kernel,
    setup: &Setup<Transmittance>,
    request: Request,
) {
    walks::fill(&wrong(Residual::new(setup)), kernel, setup, request);
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
