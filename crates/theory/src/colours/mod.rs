//! Draws that score several channels: of one channel each, mixed over heroes, or bounded.
//!
//! ```text
//! independent   E[X_λ^k] = w_λ^{1−k} E[x_λ^k],  x_λ a draw of the channel by itself, w_λ its probability
//!               E[X_λ X_μ] = 0
//! hero          a number that depends on the hero alone has the mixture of the distributions
//! balanced      0 ≤ X_λ ≤ 1/w_λ, hence E[X_λ²] ≤ E[X_λ]/w_λ
//! ```

pub mod bound;
pub mod probabilities;
pub mod rates;
pub mod scatterers;

pub use self::probabilities::{Chance, Chances};

use super::Channel;
use super::prediction::Covariance;
use crate::prediction::raw::RawMoments;
use crate::problems::channels::channel_name;
use numeric::Known;
use std::ops::{Add, Mul};

/// Raw moments of a draw that is of a channel with this probability, divided by it, else 0.
pub fn independent(alone: &RawMoments, probability: f64) -> RawMoments {
    let RawMoments([one, two, three, four, eight]) = *alone;
    let scaled = |known: Known, k: i32| known * probability.powi(1 - k);
    RawMoments([one, scaled(two, 2), scaled(three, 3), scaled(four, 4), scaled(eight, 8)])
}

/// Covariances of each channel and the next, where one of both is 0 in every draw, from `E[X]` and `E[X²]`.
pub fn exclusive(channels: &[[f64; 2]]) -> Vec<Covariance> {
    let of = |(first, pair): (usize, &[[f64; 2]])| {
        let [means, squares] = [0, 1].map(|k| [pair[0][k], pair[1][k]]);
        Covariance::of_raw([first, first + 1], means, squares, [0.0; 4])
    };
    channels.windows(2).enumerate().map(of).collect()
}

/// Moments of a number that depends on the hero alone, mixed over heroes with these probabilities; `None` without
/// heroes.
pub fn mixed<T, const N: usize>(heroes: impl IntoIterator<Item = (f64, [T; N])>) -> Option<[T; N]>
where
    T: Copy + Add<Output = T> + Mul<f64, Output = T>,
{
    let scaled = heroes.into_iter().map(|(probability, moments)| moments.map(|x| x * probability));
    scaled.reduce(|sum, moments| std::array::from_fn(|k| sum[k] + moments[k]))
}

/// A channel of draws between 0 and `1/w`, as of the balance heuristic over heroes: `E[X²] ≤ E[X]/w`.
pub fn bounded(truth: Known, probability: f64) -> Channel {
    Channel::bounded(truth, (truth.value + truth.error) / probability)
}

/// Gives channels the names of their numbers.
pub fn named(mut channels: Vec<Channel>) -> Vec<Channel> {
    let count = channels.len();
    for (index, channel) in channels.iter_mut().enumerate() {
        channel.name = channel_name(index, count);
    }
    channels
}
