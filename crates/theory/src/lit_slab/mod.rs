//! The slab with a light behind it: the radiance at a camera by one scattering, and predictions for draws that find
//! the light by hits and by shadow rays.
//!
//! A draw is scattered at z with density `a σ_t e^{−τ(z)}`. Its shadow ray N and its hit F have directions of their own
//! and are independent:
//!
//! ```text
//! E[N^k] = ∫₀¹ n_k du,   E[F^k] = ∫₀¹ q h_k du,   over the directions to the light, see [`directions`]
//! E[X^k] = ∫ a σ_t e^{−τ(z)} Σ_j (k over j) E[N^j] E[F^{k−j}] dz
//! ```
//!
//! `n_k` and `h_k` are those of a rod along the direction, with q in place of p(ω) and collisions 1/μ times as
//! dense, see [`crate::lit_rod::connections`]; where q > 1 and weights depend on null collisions, see [`contour`].
//! Every number is computed twice, on finer and on coarser panels, and their difference bounds its error. No moment
//! is infinite: lights are a distance away, or fill a cap.
//!
//! Source: derived from the densities of B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral
//! formulation of light transport*, ACM Transactions on Graphics 38 (2019), sections 4 and 5.

pub mod column;
pub mod contour;
pub mod directions;
mod lookups;

use self::column::{Column, Node};
use self::contour::Contour;
use self::directions::{Direction, Resolution};
use super::lit_rod::connections::{Vertex, Weights};
use super::lit_rod::{Combination, OF_POLYNOMIALS, ROUNDING, Shadow, Techniques};
use super::raw::{HIGHEST, POWERS, Powers, RESOLVED, Raw, RawMoments, binomial};
use super::{Channel, CountLaw, Mesh, Prediction, Tails};
use crate::problems::LitSlab;
use crate::problems::lit_slab::Light;
use media::Piecewise;
use numeric::Known;

/// Maximum τ/μ in the lowest direction.
const DEEPEST: f64 = 64.0;
/// Rounding error of the integrals of a contour, relative to √q.
const OF_CONTOUR: f64 = 1e-14;

/// Techniques that can find a light: one without a size is found by shadow rays alone, of weight 1.
pub fn possible(techniques: Techniques, light: Light) -> Techniques {
    let combination =
        if light.can_be_hit() { techniques.combination } else { Combination::NextEvent };
    Techniques { combination, ..techniques }
}

/// The optical depth of the slab in the lowest direction, if it exceeds what theory resolves.
pub fn slant_depth(mesh: &Mesh, problem: &LitSlab) -> Option<f64> {
    let depth = mesh.optical_depth().value / problem.light.lowest();
    (depth > DEEPEST).then_some(depth)
}

/// Prediction for draws of techniques through σ̂.
///
/// Without `laws`, as for lines in plots, only variances and mean lookups are valid.
pub fn predict(
    mesh: &Mesh,
    problem: &LitSlab,
    sampling: &Piecewise,
    techniques: Techniques,
    laws: bool,
) -> Prediction {
    if slant_depth(mesh, problem).is_some() {
        let channels = vec![Channel::unbiased(Known::UNKNOWN, None, Tails::LIGHT)];
        return Prediction { channels, ..Prediction::default() };
    }
    let truth = truth(mesh, problem, sampling);
    let techniques = possible(techniques, problem.light);
    let highest = if laws { HIGHEST } else { 2 };
    let [fine, coarse] = [Resolution::fine(), Resolution::coarse()]
        .map(|resolution| Scores::new(mesh, problem, sampling, (techniques, highest), &resolution));
    let raw = RawMoments(std::array::from_fn(|i| {
        let k = POWERS[i].unsigned_abs() as usize;
        if k > highest { Known::INFINITE } else { fine.known(&coarse, techniques, (k, i)) }
    }));
    Prediction::single(raw.channel(truth, RESOLVED), fine.count(&coarse))
}

/// Radiance at the camera.
pub fn truth(mesh: &Mesh, problem: &LitSlab, sampling: &Piecewise) -> Known {
    let combination = Combination::NextEvent;
    mean(mesh, problem, sampling, Techniques { shadow: Some(Shadow::Exact), combination })
}

/// `E[X]` of techniques, equal for all that are unbiased.
pub fn mean(mesh: &Mesh, problem: &LitSlab, sampling: &Piecewise, techniques: Techniques) -> Known {
    let [fine, coarse] = [Resolution::fine(), Resolution::coarse()]
        .map(|resolution| Scores::new(mesh, problem, sampling, (techniques, 1), &resolution));
    fine.known(&coarse, techniques, (1, 0))
}

/// Numbers at one resolution.
struct Scores {
    /// `E[X^k]`.
    powers: Powers,
    /// `E[M^k]`.
    lookups: Raw,
    /// The largest q.
    largest: f64,
    /// Relative error of all numbers from the mesh.
    error: f64,
}

impl Scores {
    fn new(
        mesh: &Mesh,
        problem: &LitSlab,
        sampling: &Piecewise,
        (techniques, highest): (Techniques, usize),
        resolution: &Resolution,
    ) -> Self {
        let weights = Weights::new(techniques, highest);
        let contour = match techniques.combination {
            Combination::Mis(_, heuristic) if techniques.has_nulls() => {
                Some(Contour::new(heuristic, highest))
            }
            _ => None,
        };
        let powers = (weights.products, contour.as_ref());
        let column = Column::new(mesh, problem, sampling, powers, resolution);
        let mut found = Self {
            powers: [0.0; HIGHEST + 1],
            lookups: lookups::raw(&column, problem, techniques, resolution),
            largest: 1.0,
            error: column.error(problem.light.lowest()),
        };
        for node in 0..column.nodes.len() {
            let directions = resolution.directions(problem, column.nodes[node].before);
            let scattered = |direction: &Direction| match &contour {
                Some(contour) if direction.ratio > 1.0 => {
                    by_contour(&column, node, direction, &weights, contour)
                }
                _ => {
                    let products = column.products(node, direction.cosine, weights.products);
                    weights.vertex(direction.ratio, &products)
                }
            };
            found.add(&column.nodes[node], &directions, problem.albedo, (highest, &scattered));
        }
        found
    }

    /// Adds the contribution of scattering at a depth.
    fn add(
        &mut self,
        node: &Node,
        directions: &[Direction],
        albedo: f64,
        (highest, scattered): (usize, &dyn Fn(&Direction) -> Vertex),
    ) {
        let (mut cast, mut hit) = ([0.0; HIGHEST + 1], [0.0; HIGHEST + 1]);
        for direction in directions {
            self.largest = self.largest.max(direction.ratio);
            let vertex = scattered(direction);
            for k in 1..=highest {
                cast[k] += direction.weight * vertex.connected[k];
                hit[k] += direction.weight * direction.ratio * vertex.hit[k];
            }
        }
        (cast[0], hit[0]) = (1.0, 1.0);
        let reached = node.weight * albedo * node.extinction * (-node.depth).exp();
        for k in 1..=highest {
            let both: f64 = (0..=k).map(|j| binomial(k, j) * cast[j] * hit[k - j]).sum();
            self.powers[k] += reached * both;
        }
    }

    /// `E[X^k]` with an error from a coarser resolution; the index of k among [`POWERS`] is given, too.
    fn known(&self, coarse: &Self, techniques: Techniques, (k, place): (usize, usize)) -> Known {
        let (value, other) = (self.powers[k], coarse.powers[k]);
        let of_weights = if techniques.has_nulls() {
            OF_POLYNOMIALS[place] + OF_CONTOUR * self.largest.sqrt()
        } else {
            0.0
        };
        let off = ROUNDING + self.error + of_weights;
        Known::estimated(value, (value - other).abs() + off * value)
    }

    fn count(&self, coarse: &Self) -> CountLaw {
        let [_, mean, ..] = self.lookups;
        let error = (coarse.lookups[1] - mean).abs() / mean + ROUNDING + self.error;
        CountLaw::of_raw(0.0, self.lookups, error)
    }
}

/// A scattering where q > 1 and weights depend on null collisions.
fn by_contour(
    column: &Column,
    node: usize,
    direction: &Direction,
    weights: &Weights,
    contour: &Contour,
) -> Vertex {
    let Direction { cosine, ratio, .. } = *direction;
    let products = column.products(node, cosine, 1);
    let exponents = column.exponents(node);
    let [connected, hit] = contour.means(ratio, products[1], &exponents, cosine);
    weights.vertex_by(ratio, &products, |_, k| [connected[k], hit[k]])
}
