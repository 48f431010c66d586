//! Predictions for furnaces in several channels, with draws that score all of them.
//!
//! ```text
//! E[X_λ] = 1 in every medium
//! independent    E[X_λ^k] = w_λ^{1−k},  E[X_λ X_μ] = 0
//! balanced       0 ≤ X_λ ≤ 1/w_λ, so that Var X_λ ≤ 1/w_λ − 1
//! relative to the density of one walker    E[X_λ²] bounded as in [`crate::colours::bound`]
//! ```
//!
//! The bound is that of any variable between 0 and b of mean m, `m (b − m)`: R. Bhatia, C. Davis, *A better bound on the
//! variance*, American Mathematical Monthly 107 (2000).

use crate::prediction::raw::{POWERS, RESOLVED, RawMoments};
use crate::{Channel, Moments, Prediction, Tails, colours};
use numeric::Known;

/// Rounding of a walk's weights.
const ROUNDING: f64 = 1e-12;

/// 1, the value of every channel.
const TRUTH: Known = Known::new(1.0, ROUNDING);

fn channel(moments: impl Into<Option<Moments>>) -> Channel {
    Channel::unbiased(TRUTH, moments, Tails::LIGHT)
}

/// Prediction for one channel a draw, given the probability of each.
pub fn independent(heroes: &[f64]) -> Prediction {
    let alone = RawMoments(POWERS.map(|_| Known::new(1.0, 0.0)));
    let channels = heroes.iter().map(|&weight| {
        if weight >= 1.0 {
            return channel(Moments::certain(1.0));
        }
        let raw = colours::independent(&alone, weight);
        let exact = raw.channel(Known::exact(1.0), RESOLVED);
        let moments = exact.moments.map(|moments| moments.in_units_of(TRUTH));
        Channel { truth: TRUTH, mean: TRUTH, moments, ..exact }
    });
    let channels = colours::named(channels.collect());
    let squares: Vec<[f64; 2]> = heroes.iter().map(|weight| [1.0, 1.0 / weight]).collect();
    let mut covariances = colours::exclusive(&squares);
    // The product of two channels that are drawn equally often is equal in every draw: there is nothing to test.
    covariances.retain(|found| found.variance > ROUNDING);
    Prediction { channels, covariances, ..Prediction::default() }
}

/// Prediction for all channels by the balance heuristic, given the probability of each hero.
pub fn balanced(heroes: &[f64]) -> Prediction {
    let channels = heroes.iter().map(|weight| match 1.0 / weight - 1.0 {
        most if most > 0.0 => Channel { variance_bound: Some(most), ..channel(None) },
        _ => channel(Moments::certain(1.0)),
    });
    Prediction { channels: colours::named(channels.collect()), ..Prediction::default() }
}

/// Prediction for all channels relative to the density of one walker, given bounds on `E[X²]`.
pub fn relative(second_moment_bounds: &[f64]) -> Prediction {
    let bounded = |square: &f64| Channel {
        variance_bound: Some((square - 1.0).max(ROUNDING)),
        ..channel(None)
    };
    let channels = second_moment_bounds.iter().map(bounded).collect();
    Prediction { channels: colours::named(channels), ..Prediction::default() }
}
