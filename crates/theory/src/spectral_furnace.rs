//! Predictions for furnaces in several channels, with draws that score all of them.
//!
//! ```text
//! E[X_λ] = 1 in every medium
//! independent    E[X_λ^k] = w_λ^{1−k},  E[X_λ X_μ] = 0
//! balanced       0 ≤ X_λ ≤ 1/w_λ, so that Var X_λ ≤ 1/w_λ − 1
//! relative to the density of one walker    E[X_λ²] bounded as in [`super::spectral::bound`]
//! ```
//!
//! The bound is that of any variable between 0 and b of mean m, `m (b − m)`: R. Bhatia, C. Davis, *A better bound on the
//! variance*, American Mathematical Monthly 107 (2000).

use super::prediction::Covariance;
use super::rod::moments::POWERS;
use super::rod::{central, tails};
use super::{Channel, Moments, Prediction, Tails};
use crate::problems::channels::channel_name;
use numeric::{Grade, Known};

/// Rounding of a walk's weights.
const ROUNDING: f64 = 1e-12;

fn channel(count: usize, index: usize, moments: Option<Moments>, tails: Tails) -> Channel {
    let name = channel_name(index, count);
    Channel { name, ..Channel::unbiased(Known::new(1.0, ROUNDING), moments, tails) }
}

/// Prediction for one channel a draw, given the probability of each.
pub fn independent(heroes: &[f64]) -> Prediction {
    let count = heroes.len();
    let channels = heroes.iter().enumerate().map(|(index, weight)| {
        if *weight >= 1.0 {
            return channel(count, index, Some(Moments::certain(1.0)), Tails::LIGHT);
        }
        let raw = POWERS.map(|k| [weight.powi(1 - k), 0.0]);
        let moments = central(Known::exact(1.0), &raw).graded(Grade::Proven);
        channel(count, index, Some(moments), tails(&raw))
    });
    let covariances = (1..count).map(|next| {
        let second_moment_bounds = [heroes[next - 1], heroes[next]].map(|weight| 1.0 / weight);
        Covariance::of_raw([next - 1, next], [1.0; 2], second_moment_bounds, [0.0; 4])
    });
    // The product of two channels that are drawn equally often is equal in every draw: there is nothing to test.
    let covariances = covariances.filter(|found| found.variance > ROUNDING);
    let (channels, covariances) = (channels.collect(), covariances.collect());
    Prediction { channels, covariances, ..Prediction::default() }
}

/// Prediction for all channels by the balance heuristic, given the probability of each hero.
pub fn balanced(heroes: &[f64]) -> Prediction {
    let count = heroes.len();
    let channels = heroes.iter().enumerate().map(|(index, weight)| {
        let most = 1.0 / weight - 1.0;
        if most <= 0.0 {
            return channel(count, index, Some(Moments::certain(1.0)), Tails::LIGHT);
        }
        let unknown = channel(count, index, None, Tails::LIGHT);
        Channel { most_variance: Some(most), ..unknown }
    });
    Prediction { channels: channels.collect(), ..Prediction::default() }
}

/// Prediction for all channels relative to the density of one walker, given bounds on `E[X²]`.
pub fn relative(second_moment_bounds: &[f64]) -> Prediction {
    let count = second_moment_bounds.len();
    let channels = second_moment_bounds.iter().enumerate().map(|(index, square)| {
        let unknown = channel(count, index, None, Tails::LIGHT);
        Channel { most_variance: Some((square - 1.0).max(ROUNDING)), ..unknown }
    });
    Prediction { channels: channels.collect(), ..Prediction::default() }
}
