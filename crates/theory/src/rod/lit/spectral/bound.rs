//! Bound on `E[X²]` of hits and shadow rays together over heroes, in rods with different media in all channels.
//!
//! Let `p_h` and `q_h` be the densities of a path by the hits and by the shadow rays of the hero h. Let `c_v` and
//! `h_v` be the scores of the shadow ray of the vertex v, and of the hit after it, in the channel λ. Both are
//! `f_λ/D`, by the balance heuristic, on the same paths:
//!
//! ```text
//! D = Σ_h w_h (p_h + q_h) ≥ w_λ (p_λ + q_λ)
//! E[c_v²] + E[h_v²] = ∫ f_λ²/D ≤ V_v/w_λ,   V_v the same sum where the channel λ walks alone
//! ```
//!
//! The hit without scattering is at most 1/w, and then there is no other score. At most one of all other hits
//! occurs. With the triangle inequality for the rest, and `u_v = √V_v`,
//!
//! ```text
//! w_λ E[X²] ≤ T_λ + (max Σ_v √(u_v² − b_v²) + √Σ_v b_v²)² ≤ T_λ + (Σ_v u_v + ½ max_v u_v)²
//! ```
//!
//! `V_v` is that of one scattering, carried through v scatterings before it. If `V_{v+2} ≤ s V_v` everywhere in the
//! rod, this holds from there on, as all terms are positive: the rest is two geometric series. (Where light mostly
//! turns, every other `V_v` is small.)
//!
//! Source: derived.

use crate::Mesh;
use crate::light::Techniques;
use crate::light::vertex::Vertex;
use crate::problems::LitRod;
use crate::rod::line::{Importance, Line};
use crate::rod::lit::connections::connections;
use crate::rod::lit::walk;
use crate::rod::walk::RodPoint;
use media::Piecewise;
use numeric::Known;

/// Maximum rest of the sum, relative to the terms before it.
const ENOUGH: f64 = 1e-6;
/// Maximum number of vertices.
const MAX_VERTICES: usize = 4000;

/// A bound on `w_λ E[X_λ²]` of one channel with its σ̂; `None` where theory has no line for it.
pub fn weighted_square(
    mesh: &Mesh,
    rod: &LitRod,
    sampling: &Piecewise,
    techniques: Techniques,
) -> Option<f64> {
    let scattered =
        walk(mesh, &rod.rod, sampling).known(2, &|line| Some(vec![spread(line, techniques)?]))?;
    let Known { value: spread, error, .. } = scattered[0];
    let Known { value, error: of_depth, .. } = mesh.optical_depth().exp_neg();
    Some(value + of_depth + (spread + error).powi(2))
}

/// `Σ_v u_v + ½ max_v u_v`.
fn spread(line: &Line, techniques: Techniques) -> Option<f64> {
    let connections = connections(line, techniques, 2);
    let real = line.straight(1)?;
    let last = |i: usize, node: &RodPoint| {
        let worth = |vertex: &Vertex| vertex.connected[2] + vertex.towards * vertex.hit[2];
        connections[i].each_ref().map(|vertex| node.scattering() * worth(vertex))
    };
    let earlier = |here: &Importance| {
        let carried = |i: usize, node: &RodPoint| {
            node.spread(here.at(i)).map(|worth| node.scattering() * worth)
        };
        real.solve(&carried, [0.0; 2])
    };
    let root = |importance: &Importance| importance.entering.max(0.0).sqrt();
    let mut before = real.solve(&last, [0.0; 2]);
    let mut here = earlier(&before);
    let (mut sum, mut maximum) = (0.0, 0.0f64);
    for _ in 0..MAX_VERTICES {
        let own = root(&before);
        sum += own;
        maximum = maximum.max(own);
        let next = earlier(&here);
        let share = largest_share(line, &next, &before).sqrt();
        let two = root(&here) + root(&next);
        let rest = if share > 0.0 { two / (1.0 - share) } else { two };
        if share < 1.0 && rest <= ENOUGH * sum {
            return Some(sum + rest + 0.5 * maximum);
        }
        (before, here) = (here, next);
    }
    None
}

/// Maximum ratio of one vertex's values to another's, over all nodes.
fn largest_share(line: &Line, worth: &Importance, other: &Importance) -> f64 {
    let mut largest = 0.0f64;
    for i in 0..line.nodes().len() {
        for (worth, other) in worth.at(i).into_iter().zip(other.at(i)) {
            if worth > 0.0 {
                largest = largest.max(worth / other);
            }
        }
    }
    largest
}
