//! Mistakes of decomposition and of local majorants.
//!
//! ```text
//! decomposition   X = 1 if the control's flight passes S and no residual collision comes before it
//! local majorant  beyond a segment's end, go back to the boundary and start again
//! ```

use super::line::{Slip, Wrong};
use super::product::known;
use super::{Line, Mutant, Target, family, filled};
use estimators::transmittance::decomposition::Residual;
use estimators::transmittance::local_majorant::Segments;
use estimators::walks;
use theory::problems::Transmittance;

/// `σ_c = 0.3`, `σ̂ = 0.9`.
const DECOMPOSITION: Target = known(11);
/// Three segments.
const LOCAL_MAJORANT: Target = known(12);

#[derive(Clone, Copy, PartialEq)]
enum Bug {
    None,
    Whole,
    Passes,
    Overshoots,
}

#[rustfmt::skip] // one mutant, one entry
const LINES: &[Line<Bug>] = &[
    ("decomposition-whole", "the chance of a real collision is σ_t/σ̂, not (σ_t − σ_c)/σ̂", DECOMPOSITION, "mean", Bug::Whole),
    ("decomposition-passes", "a draw without a residual collision is 1, wherever the control's flight ended", DECOMPOSITION, "atoms", Bug::Passes),
    ("local-majorant-overshoot", "a flight beyond a segment's end goes on from where it came to, not from the boundary", LOCAL_MAJORANT, "mean", Bug::Overshoots),
];

/// The family.
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    let draws = |target, &bug: &Bug| {
        filled(move |setup, request| {
            if target == LOCAL_MAJORANT {
                let slip = if bug == Bug::Overshoots { Slip::Overshoots } else { Slip::None };
                let segments = Segments::of(setup).expect("a σ̂ above 0");
                walks::in_turn(&Wrong::new(segments, slip, setup), setup, request);
                return;
            }
            let mut walk = Residual::new(setup);
            match bug {
                Bug::Whole => walk.subtracted = 0.0,
                Bug::Passes => walk.end = f64::NEG_INFINITY,
                _ => {}
            }
            walks::in_turn(&walk, setup, request);
        })
    };
    family(LINES, &Bug::None, draws)
}
