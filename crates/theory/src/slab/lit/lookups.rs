//! Moments of the number of lookups of a draw.
//!
//! Given the first real collision at z, null collisions before it are Poisson with mean ν(z). Its shadow ray and
//! its further flight are independent of them and of each other. A flight from y to the end along μ that stops at a real
//! collision makes the lookups of [`crate::ray::survival`] with `σ̂/μ`, `K = τ/μ` and `A = ν/μ`. A ratio-tracked shadow ray
//! makes a Poisson number of mean ∫σ̂/μ. Directions that miss the light make none.

use super::column::LitColumn;
use super::directions::{Direction, LitResolution};
use crate::light::{Shadow, Techniques};
use crate::prediction::raw::{Raw, added, of_factorial, poisson};
use crate::problems::LitSlab;
use crate::ray::survival::factorial_rates;

/// Optical depth at which rays are cut off: one in 1e26 goes farther.
const FAR: f64 = 60.0;

/// `E[M^k]`, k = 0 … 4, and the mean number of lookups of shadow rays.
pub fn raw(
    column: &LitColumn,
    problem: &LitSlab,
    techniques: Techniques,
    resolution: &LitResolution,
) -> (Raw, f64) {
    let [depth, nulls] = column.whole;
    let mut result = poisson(nulls).map(|moment| (-depth).exp() * moment);
    let mut of_shadow_rays = 0.0;
    for (i, node) in column.nodes.iter().enumerate() {
        let reached = node.weight * node.extinction * (-node.depth).exp();
        let collided = added([1.0; 5], poisson(node.nulls));
        let (mut cast, mut flown) = ([0.0; 5], [0.0; 5]);
        let (mut weight, mut hits) = (0.0, 0.0);
        for direction in resolution.directions(problem, node.before) {
            let stopping = || stopping(column, i, &direction);
            let of_shadow = match techniques.shadow {
                None | Some(Shadow::Exact) => [1.0, 0.0, 0.0, 0.0, 0.0],
                Some(Shadow::Ratio) => {
                    let left = depth - node.depth + nulls - node.nulls;
                    poisson(left / direction.cosine)
                }
                Some(Shadow::Delta) => stopping(),
            };
            add(&mut cast, direction.weight, of_shadow);
            weight += direction.weight;
            if techniques.has_hits() {
                let share = direction.weight * direction.ratio;
                add(&mut flown, share, stopping());
                hits += share;
            }
        }
        cast[0] += 1.0 - weight;
        flown[0] += 1.0 - hits;
        let scattered = added(collided, added(cast, flown));
        let a = problem.albedo;
        of_shadow_rays += reached * a * cast[1];
        for (k, sum) in result.iter_mut().enumerate() {
            *sum += reached * (a * scattered[k] + (1.0 - a) * collided[k]);
        }
    }
    (result, of_shadow_rays)
}

fn add(sum: &mut Raw, weight: f64, moments: Raw) {
    for (sum, moment) in sum.iter_mut().zip(moments) {
        *sum += weight * moment;
    }
}

/// `E[K^k]` of a flight from a node to the end that stops at a real collision.
fn stopping(column: &LitColumn, from: usize, direction: &Direction) -> Raw {
    let (here, cosine) = (&column.nodes[from], direction.cosine);
    let first = from - from % column.per_panel;
    let own = column.rest_of_panel(from);
    let mut factorial = [0.0; 4];
    for (i, node) in column.nodes[first..].iter().enumerate() {
        let depth = (node.depth - here.depth) / cosine;
        if depth > FAR {
            break;
        }
        let weight = own.get(i).copied().unwrap_or(node.weight);
        let nulls = (node.nulls - here.nulls) / cosine;
        let rates = factorial_rates(node.sampling / cosine, depth, nulls);
        for k in 0..4 {
            factorial[k] += weight * rates[k];
        }
    }
    of_factorial(factorial)
}
