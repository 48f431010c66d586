//! The rod with an emitter at its end: radiance at a camera at its beginning, and predictions for walks that find
//! the emitter by hits and by shadow rays.
//!
//! The truth is the rod's transmittance, see [`crate::rod`]. Four moments of every combination of techniques, at any
//! σ̂(x) that is a majorant, solve two-stream equations ([`moments`]); real, null and shadow lookups too.
//!
//! Source: derived from the densities of B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral
//! formulation of light transport*, ACM Transactions on Graphics 38 (2019), sections 4 and 5.

pub mod connections;
pub mod moments;
pub mod spectral;

use super::truth;
use super::walk::RodWalk;
use crate::light::Techniques;
use crate::prediction::raw::{HIGHEST, POWERS, RESOLVED, RawMoments};
use crate::problems::{LitRod, Rod};
use crate::{Channel, CountDistribution, Mesh, ParticleRule, Prediction, Tails};
use media::Piecewise;
use numeric::Known;

/// Relative rounding error of sums of Poisson moments.
pub(crate) const ROUNDING: f64 = 1e-14;
/// Relative error of the moments of weights that depend on null collisions, k = 1, 2, 3, 4 and 8, see
/// [`crate::light::contour`].
const OF_WEIGHTS: [f64; 5] = [1e-14, 1e-13, 5e-13, 3e-12, 4e-12];

/// The delta-tracking walk on a rod.
pub(super) fn walk<'a>(mesh: &Mesh, rod: &'a Rod, sampling: &'a Piecewise) -> RodWalk<'a> {
    RodWalk::new(mesh, rod, Some(sampling), ParticleRule::Analog).with_orders()
}

/// Returns whether theory can cut a rod into panels.
pub fn is_within_reach(mesh: &Mesh, problem: &LitRod, sampling: &Piecewise) -> bool {
    walk(mesh, &problem.rod, sampling).is_within_reach()
}

/// Prediction for walks with techniques through σ̂.
///
/// Without `with_distributions`, as for lines in plots, only variances and mean lookups are valid.
pub fn predict(
    mesh: &Mesh,
    problem: &LitRod,
    sampling: &Piecewise,
    techniques: Techniques,
    with_distributions: bool,
) -> Prediction {
    let answer = answer(mesh, problem);
    let result = WalkMoments::of(mesh, problem, sampling, techniques, with_distributions);
    let Some(WalkMoments { lookups, shadow_lookups, raw }) = result else {
        return Prediction::uncounted(Channel::unbiased(answer, None, Tails::LIGHT));
    };
    let distribution = CountDistribution::of_factorial(lookups);
    Prediction { shadow_lookups, ..Prediction::single(raw.channel(answer, RESOLVED), distribution) }
}

/// Radiance at the camera; NaN where it is unknown.
pub fn answer(mesh: &Mesh, problem: &LitRod) -> Known {
    let result = truth(mesh, &problem.rod).and_then(|result| result.first().copied());
    result.unwrap_or(Known::UNKNOWN)
}

/// Raw moments of a draw and of its lookups.
pub struct WalkMoments {
    /// `E[M(M − 1)…(M − k + 1)]` of the lookups, k = 1 … 4.
    pub lookups: [Known; 4],
    /// Mean number of lookups of shadow rays, if there are any.
    pub shadow_lookups: Option<f64>,
    /// Raw moments of the draw.
    pub raw: RawMoments,
}

impl WalkMoments {
    /// Raw moments of walks with techniques through σ̂; `None` where theory has no answer. Without `with_distributions` the first
    /// two only.
    pub fn of(
        mesh: &Mesh,
        problem: &LitRod,
        sampling: &Piecewise,
        techniques: Techniques,
        with_distributions: bool,
    ) -> Option<Self> {
        let highest = if with_distributions { HIGHEST } else { 2 };
        let numbers = walk(mesh, &problem.rod, sampling).known(2, &|line| {
            let mut numbers = moments::lookups(line, techniques)?.to_vec();
            numbers.extend(moments::scattered(line, techniques, highest)?);
            Some(numbers)
        })?;
        let shadow_lookups = techniques.shadow.map(|_| numbers[4].value);
        let scattered = &numbers[5..];
        let unscattered = mesh.optical_depth().exp_neg();
        let raw = std::array::from_fn(|i| {
            let k = POWERS[i].unsigned_abs() as usize;
            let moment = scattered.get(k - 1);
            moment.map_or(Known::INFINITE, |&moment| with_hit(moment, unscattered, i, techniques))
        });
        let lookups = std::array::from_fn(|k| numbers[k]);
        Some(Self { lookups, shadow_lookups, raw: RawMoments(raw) })
    }
}

/// Adds the unscattered hit, which scores 1, to a moment; `power` is its index in `POWERS`.
pub fn with_hit(
    scattered: Known,
    unscattered: Known,
    power: usize,
    techniques: Techniques,
) -> Known {
    let of_weights = if techniques.has_nulls() { OF_WEIGHTS[power] } else { 0.0 };
    let sum = scattered + unscattered;
    sum.blurred((ROUNDING + of_weights) * sum.value)
}
