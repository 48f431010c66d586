//! Integrals along rays through a ball.
//!
//! ```text
//! ∫ σ_t(t) S(t) e^{−τ(0, t)} dt,   S the polynomials of the shells that the ray crosses
//! ```

use super::shells::{Centre, FunctionalRow, GaussRules, Shell, Shells, whole};
use numeric::quadrature::GaussLegendre;

/// Maximum optical depth over which one Gauss rule resolves the exponential.
const SMOOTH: f64 = 2.0;
/// Nodes beyond those that integrate the polynomial times σ_t.
const BEYOND: usize = 5;
/// Minimum number of nodes: they integrate σ_t exactly where it is cubic in `r²`.
const FEWEST: usize = 9;
/// Maximum number of nodes.
pub(super) const MAX_NODES: usize = 32;

/// A ball with a radial extinction.
#[derive(Clone, Copy)]
pub struct Ball<'a> {
    /// R.
    pub radius: f64,
    /// Content of the centre.
    pub centre: Centre,
    /// σ_t as a function of `r²`.
    pub extinction: &'a dyn Fn(f64) -> f64,
}

/// A ray or a part of one, from `from` to `to`, distances from its foot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chord {
    /// The square of its distance from the centre.
    pub offset2: f64,
    /// Begin, as a distance from the foot.
    pub from: f64,
    /// End, as a distance from the foot.
    pub to: f64,
    /// True if it ends on the black sphere.
    pub hits: bool,
}

impl Ball<'_> {
    /// The ray that begins at a distance from its foot and looks on.
    pub fn chord(&self, offset2: f64, from: f64) -> Chord {
        let half = (self.radius * self.radius - offset2).max(0.0).sqrt();
        let from = from.max(-half);
        if let Centre::Black(core) = self.centre
            && from < 0.0
            && offset2 < core * core
        {
            let to = -(core * core - offset2).sqrt();
            return Chord { offset2, from, to: to.max(from), hits: true };
        }
        Chord { offset2, from, to: half.max(from), hits: false }
    }

    /// Adds `weight ∫ σ_t S e^{−τ} dt` to a row, and returns `e^{−τ}` at the ray's end.
    pub fn collect(
        &self,
        chord: &Chord,
        shells: &Shells,
        rules: &GaussRules,
        weight: f64,
        row: &mut FunctionalRow,
    ) -> f64 {
        let mut depth = 0.0;
        crossings(chord, shells, |shell, from, to| {
            let nodes = (shell.nodes + BEYOND).max(FEWEST);
            let part = Chord { from, to, ..*chord };
            self.panel(&part, rules.of(nodes), &mut depth, |places, shares| {
                for share in shares.iter_mut() {
                    *share *= weight;
                }
                row.add(shell, places, shares);
            });
        });
        (-depth).exp()
    }

    /// Integrates one panel, in parts: passes `r²` and `σ_t e^{−τ} dt` at the nodes to `each`, and adds to the
    /// optical depth.
    fn panel(
        &self,
        part: &Chord,
        rule: &GaussLegendre,
        depth: &mut f64,
        mut each: impl FnMut(&[f64], &mut [f64]),
    ) {
        let &Chord { offset2, from, to, .. } = part;
        let middle = 0.5 * (from + to);
        let guess = (self.extinction)(offset2 + middle * middle) * (to - from);
        let parts = (guess / SMOOTH).ceil().clamp(1.0, 64.0);
        let length = (to - from) / parts;
        let [mut places, mut sigma, mut shares] = [[0.0; MAX_NODES]; 3];
        let count = rule.nodes.len().min(MAX_NODES);
        let (places, sigma) = (&mut places[..count], &mut sigma[..count]);
        let shares = &mut shares[..count];
        for part in 0..whole(parts) {
            let begin = from + length * part as f64;
            for (i, x) in rule.nodes.iter().enumerate().take(count) {
                let t = begin + length * x;
                places[i] = offset2 + t * t;
                sigma[i] = (self.extinction)(places[i]);
            }
            for (i, share) in shares.iter_mut().enumerate() {
                let running: f64 = rule.running[i].iter().zip(&*sigma).map(|(w, s)| w * s).sum();
                *share = rule.weights[i] * length * sigma[i] * (-*depth - length * running).exp();
            }
            each(places, shares);
            let mean: f64 = rule.weights.iter().zip(&*sigma).map(|(w, s)| w * s).sum();
            *depth += length * mean;
        }
    }
}

/// The parts of a ray in each shell, in their order.
fn crossings(chord: &Chord, shells: &Shells, mut each: impl FnMut(&Shell, f64, f64)) {
    let at = |r2: f64| (r2 - chord.offset2).max(0.0).sqrt();
    // Inwards, through the shell of the foot, and out again.
    for shell in shells.shells.iter().rev() {
        let (outer, inner) = (-at(shell.to), -at(shell.from));
        let (from, to) = (outer.max(chord.from), inner.min(chord.to));
        if from < to {
            each(shell, from, to);
        }
    }
    for shell in &shells.shells {
        let (from, to) = (at(shell.from).max(chord.from), at(shell.to).min(chord.to));
        if from < to {
            each(shell, from, to);
        }
    }
}
