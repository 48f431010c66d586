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

use crate::colours::bound::{self, FlightMoments};
use crate::colours::rates::{Proposal, Rates};
use crate::prediction::raw::{POWERS, RESOLVED, RawMoments};
use crate::problems::SpectralFurnace;
use crate::{Channel, Moments, Prediction, Tails, colours};
use media::phase::Phase;
use media::phase::isotropic::Isotropic;
use numeric::Known;
use numeric::geometry::Bounds;

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
    covariances.retain(|result| result.variance > ROUNDING);
    Prediction { channels, covariances, ..Prediction::default() }
}

/// Prediction for all channels by the balance heuristic, given the probability of each hero.
pub fn balanced(heroes: &[f64]) -> Prediction {
    let channels = heroes.iter().map(|weight| match 1.0 / weight - 1.0 {
        maximum if maximum > 0.0 => Channel { variance_bound: Some(maximum), ..channel(None) },
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

/// Bound on `E[X²]` of a channel where draws are relative to the density of a walk, Φ given. Each channel has one σ_t.
///
/// # Errors
///
/// The factor of the second moment between two scatterings, where it is too large.
pub fn second_moment_bound(
    problem: &SpectralFurnace,
    rates: &Rates,
    extinctions: &[f64],
    (walk, channel, phi): (Proposal, usize, f64),
) -> Result<f64, f64> {
    let square = bound::square(rates, walk, channel, extinctions, phi);
    let diameter = problem.bounds.diameter();
    let is_isotropic = problem.channels.iter().all(|own| own.phase == Phase::Isotropic(Isotropic));
    let shorter = is_isotropic && square.lost > 0.0;
    // Lines from a place in a ball are at most as long as a radius on average, and e^{−x} is convex.
    let then = match problem.bounds {
        Bounds::Sphere { radius, .. } if shorter => radius,
        _ => diameter,
    };
    let [first, then] = [diameter, then].map(|length| FlightMoments::of(square.lost, length));
    let result = bound::largest(first, then, [square.scattered, square.absorbed]);
    // A hero may never be absorbed where another channel is.
    let is_finite = square.absorbed.is_finite();
    result.ok_or(if is_finite { square.scattered * then.collides } else { f64::INFINITY })
}
