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
//! dense, see [`crate::rod::lit::connections`].
//! Every number is computed twice, on finer and on coarser panels, and their difference bounds its error. No moment
//! is infinite: lights are a distance away, or fill a cap.
//!
//! Source: derived from the densities of B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral
//! formulation of light transport*, ACM Transactions on Graphics 38 (2019), sections 4 and 5.

pub mod column;
pub mod directions;
mod lookups;

use self::column::{DepthNode, LitColumn};
use self::directions::{Direction, LitResolution};
use crate::light::contour::ROUNDINGS;
use crate::light::vertex::{Vertex, Weights};
use crate::light::{Combination, Shadow, Techniques};
use crate::prediction::raw::{HIGHEST, POWERS, Powers, RESOLVED, Raw, RawMoments, binomial};
use crate::problems::LitSlab;
use crate::problems::lit_slab::LightBehind;
use crate::rod::lit::ROUNDING;
use crate::{Channel, CountDistribution, Mesh, Prediction, Tails};
use media::Piecewise;
use numeric::Known;

/// Maximum τ/μ in the lowest direction.
const DEEPEST: f64 = 64.0;

/// Techniques that can find a light: one without a size is found by shadow rays alone, of weight 1.
pub fn possible(techniques: Techniques, light: LightBehind) -> Techniques {
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
/// Without `with_distributions`, as for lines in plots, only variances and mean lookups are valid.
pub fn predict(
    mesh: &Mesh,
    problem: &LitSlab,
    sampling: &Piecewise,
    techniques: Techniques,
    with_distributions: bool,
) -> Prediction {
    if slant_depth(mesh, problem).is_some() {
        let channels = vec![Channel::unbiased(Known::UNKNOWN, None, Tails::LIGHT)];
        return Prediction { channels, ..Prediction::default() };
    }
    let truth = truth(mesh, problem, sampling);
    let techniques = possible(techniques, problem.light);
    let highest = if with_distributions { HIGHEST } else { 2 };
    let [fine, coarse] = [LitResolution::fine(), LitResolution::coarse()].map(|resolution| {
        ResolutionScores::new(mesh, problem, sampling, (techniques, highest), &resolution)
    });
    let raw = RawMoments(std::array::from_fn(|i| {
        let k = POWERS[i].unsigned_abs() as usize;
        if k > highest { Known::INFINITE } else { fine.known(&coarse, k) }
    }));
    let shadow_lookups = techniques.shadow.map(|_| fine.shadow_lookups);
    let single = Prediction::single(raw.channel(truth, RESOLVED), fine.count(&coarse));
    Prediction { shadow_lookups, ..single }
}

/// Radiance at the camera.
pub fn truth(mesh: &Mesh, problem: &LitSlab, sampling: &Piecewise) -> Known {
    let combination = Combination::NextEvent;
    mean(mesh, problem, sampling, Techniques { shadow: Some(Shadow::Exact), combination })
}

/// `E[X]` of techniques, equal for all that are unbiased.
pub fn mean(mesh: &Mesh, problem: &LitSlab, sampling: &Piecewise, techniques: Techniques) -> Known {
    let [fine, coarse] = [LitResolution::fine(), LitResolution::coarse()].map(|resolution| {
        ResolutionScores::new(mesh, problem, sampling, (techniques, 1), &resolution)
    });
    fine.known(&coarse, 1)
}

/// Numbers at one resolution.
struct ResolutionScores {
    /// `E[X^k]`.
    powers: Powers,
    /// Bounds on the errors of `E[X^k]` from weights.
    errors: Powers,
    /// `E[M^k]`.
    lookups: Raw,
    /// Mean number of lookups of shadow rays.
    shadow_lookups: f64,
    /// Relative error of all numbers from the mesh.
    error: f64,
}

impl ResolutionScores {
    fn new(
        mesh: &Mesh,
        problem: &LitSlab,
        sampling: &Piecewise,
        (techniques, highest): (Techniques, usize),
        resolution: &LitResolution,
    ) -> Self {
        let weights = Weights::new(techniques, highest, true);
        let column = LitColumn::new(mesh, problem, sampling, &weights.contour, resolution);
        let error = column.error(problem.light.lowest());
        let off = ROUNDINGS * f64::EPSILON + error;
        let (lookups, shadow_lookups) = lookups::raw(&column, problem, techniques, resolution);
        let mut result = Self {
            powers: [0.0; HIGHEST + 1],
            errors: [0.0; HIGHEST + 1],
            lookups,
            shadow_lookups,
            error,
        };
        for node in &column.nodes {
            let directions = resolution.directions(problem, node.before);
            let scattered = |&Direction { cosine, ratio, .. }: &Direction| {
                let line = weights.contour.line(ratio);
                let moments = weights.contour.moments(line, &node.beyond, 1.0 / cosine);
                weights.vertex(ratio, &moments, off)
            };
            result.add(node, &directions, problem.albedo, (highest, &scattered));
        }
        result
    }

    /// Adds the contribution of scattering at a depth.
    fn add(
        &mut self,
        node: &DepthNode,
        directions: &[Direction],
        albedo: f64,
        (highest, scattered): (usize, &dyn Fn(&Direction) -> Vertex),
    ) {
        // Of shadow rays and of hits.
        let [mut means, mut errors] = [[[0.0; HIGHEST + 1]; 2]; 2];
        for direction in directions {
            let vertex = scattered(direction);
            let shares = [direction.weight, direction.weight * direction.ratio];
            for (i, powers) in [vertex.connected, vertex.hit].into_iter().enumerate() {
                for k in 1..=highest {
                    means[i][k] += shares[i] * powers[k];
                    errors[i][k] += shares[i] * vertex.errors[i][k];
                }
            }
        }
        (means[0][0], means[1][0]) = (1.0, 1.0);
        let ([cast, hit], [of_cast, of_hit]) = (means, errors);
        let reached = node.weight * albedo * node.extinction * (-node.depth).exp();
        for k in 1..=highest {
            for j in 0..=k {
                let share = reached * binomial(k, j);
                self.powers[k] += share * cast[j] * hit[k - j];
                self.errors[k] += share * (of_cast[j] * hit[k - j] + cast[j] * of_hit[k - j]);
            }
        }
    }

    /// `E[X^k]` with an error from a coarser resolution.
    fn known(&self, coarse: &Self, k: usize) -> Known {
        let off = (ROUNDING + self.error) * self.powers[k] + self.errors[k];
        Known::of_resolutions(self.powers[k], coarse.powers[k]).blurred(off)
    }

    fn count(&self, coarse: &Self) -> CountDistribution {
        let [_, mean, ..] = self.lookups;
        let error = (coarse.lookups[1] - mean).abs() / mean + ROUNDING + self.error;
        CountDistribution::of_raw(0.0, self.lookups, error)
    }
}
