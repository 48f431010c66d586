//! The rod: reflectance and transmittance, and predictions for walks in it.
//!
//! Expected values are closed forms where the albedo and the phase are constant. Elsewhere they are the mean of the
//! light's own walk (σ̂ = σ_t, analog) by the two-stream equations. Moments of every rule at any σ̂(x) solve the
//! same equations with other rates.
//!
//! A moment may diverge: where the weight grows faster than the particle leaves, the echoes between two parts of
//! the rod add up to infinity. The length at which that begins is the moment's critical length. An experiment with
//! a divergent second moment has no variance and is refused. Where only the fourth diverges the mean is tested and
//! the variance is not.
//!
//! Source: derived from the rules of L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády,
//! *Unbiased Light Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum
//! 36 (2017), sections 3.1–3.3 and 4.1. The criticality of second moments is that of T. E. Booth and
//! E. D. Cashwell, *Analysis of Error in Monte Carlo Transport Calculations*, Nuclear Science and
//! Engineering 71 (1979).

mod closed;
pub mod grid;
pub mod moments;

use self::grid::Walk;
use self::moments::{Existence, Joint, Precision};
use super::particle::ParticleRule;
use super::prediction::Covariance;
use super::raw::{POWERS, RESOLVED, RawMoments};
use super::{Channel, CountLaw, Mesh, Prediction, Tails};
use crate::problems::rod::Quantity;
use crate::problems::{Problem, Rod};
use media::Piecewise;
use numeric::{Known, Span};

/// The exact answer of every channel; `None` where the rod has too many steps for theory.
pub fn truth(mesh: &Mesh, rod: &Rod) -> Option<Vec<Known>> {
    let support = mesh.support();
    let depth = rod.medium().optical_depth(support);
    let share = |field: &Piecewise| one_value(field, support);
    let closed = share(&rod.albedo).zip(share(&rod.forward));
    let closed = closed.map(|(albedo, forward)| closed::leaving(depth, albedo, forward));
    let needed = |quantity: &&Quantity| closed.is_none() || !has_closed_form(**quantity);
    let open: Vec<Quantity> = rod.channels.iter().filter(needed).copied().collect();
    let mut solved = Vec::new();
    if !open.is_empty() {
        let walk = Walk::new(mesh, rod, None, ParticleRule::Analog)?;
        let numbers = moments::romberg(&walk, Precision::FULL, &|grid| {
            open.iter().map(|&quantity| moments::power(grid, quantity, 1)).collect()
        });
        solved = numbers?;
    }
    let mut solved = solved.into_iter();
    let known = rod.channels.iter().map(|quantity| match (closed, quantity) {
        (Some([r, _]), Quantity::Reflected) => Some(r),
        (Some([_, t]), Quantity::Transmitted) => Some(t),
        (Some([r, t]), Quantity::Absorbed) => {
            // In a white rod rounding may make the rest negative.
            let rest = ((1.0 - r.value) - t.value).max(0.0);
            Some(Known { value: rest, error: r.error + t.error + f64::EPSILON, ..r })
        }
        _ => solved.next().map(known),
    });
    known.collect()
}

/// The exact answer of every channel; NaN where it is unknown.
fn truth_or_nan(mesh: &Mesh, rod: &Rod) -> Vec<Known> {
    truth(mesh, rod).unwrap_or_else(|| vec![Known::UNKNOWN; rod.channels.len()])
}

fn has_closed_form(quantity: Quantity) -> bool {
    matches!(quantity, Quantity::Reflected | Quantity::Transmitted | Quantity::Absorbed)
}

/// The value of a field, if it has only one on an interval.
fn one_value(field: &Piecewise, span: Span) -> Option<f64> {
    field.on(span).single_value()
}

/// Reason why a walk has no variance that draws can be compared with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoVariance {
    /// The second moment diverges: the rod would have to end at this distance.
    Diverges(f64),
    /// The second moment is next to its divergence, and known to this relative error only; above 1, it may diverge.
    Blurred(f64),
    /// The rod has too many steps for theory.
    TooLong,
}

/// Checks that a walk has a variance that theory resolves.
///
/// # Errors
///
/// The reason why not.
pub fn has_variance(
    mesh: &Mesh,
    rod: &Rod,
    sampling: &Piecewise,
    rule: ParticleRule,
) -> Result<(), NoVariance> {
    let walk = Walk::new(mesh, rod, Some(sampling), rule).ok_or(NoVariance::TooLong)?;
    match Existence::of(&walk, [2])[0] {
        Existence::Finite => Ok(()),
        Existence::Diverges(at) => Err(NoVariance::Diverges(at)),
        Existence::Unknown => Err(NoVariance::Blurred(f64::INFINITY)),
        Existence::Near => match blur(&powers(&walk, 2)) {
            blur if blur <= RESOLVED => Ok(()),
            blur => Err(NoVariance::Blurred(blur)),
        },
    }
}

/// `E[X^k]` of each channel with its error, where the moment is next to its divergence; infinite where grids do not
/// resolve it.
fn powers(walk: &Walk<'_>, k: i32) -> Vec<Known> {
    let channels = &walk.rod.channels;
    let numbers = moments::next_to_divergence(walk, &|grid| {
        channels.iter().map(|&quantity| moments::power(grid, quantity, k)).collect()
    });
    let known = |numbers: Vec<[f64; 2]>| numbers.into_iter().map(known).collect();
    numbers.map_or_else(|| vec![Known::INFINITE; channels.len()], known)
}

/// Prediction for the walk of a rule through σ̂. It has the expected value alone where [`has_variance`] refuses the
/// walk, and not even that where the rod is too long.
///
/// Without `laws`, as for lines in plots, only variances and mean lookups are valid.
pub fn predict(
    mesh: &Mesh,
    rod: &Rod,
    sampling: &Piecewise,
    rule: ParticleRule,
    laws: bool,
) -> Prediction {
    let truth = truth_or_nan(mesh, rod);
    let found = Walk::new(mesh, rod, Some(sampling), rule).and_then(|walk| Solved::of(&walk, laws));
    let channel = |(index, (quantity, &truth)): (usize, (&Quantity, &Known))| {
        let channel = match &found {
            Some(found) => found.raw[index].channel(truth, RESOLVED),
            None => Channel::unbiased(truth, None, Tails::LIGHT),
        };
        Channel { name: quantity.name(), ..channel }
    };
    let channels = rod.channels.iter().zip(&truth).enumerate().map(channel);
    Prediction {
        channels: channels.collect(),
        lookups: found.as_ref().map(|found| CountLaw::of_factorial(found.lookups)),
        covariances: found
            .as_ref()
            .map_or_else(Vec::new, |found| covariances(&rod.channels, &truth, found)),
        ..Prediction::default()
    }
}

/// `E[M(M − 1)…(M − k + 1)]`, k = 1 … 4, of the lookups of a walk, with absolute errors; `None` where its second
/// moments diverge or the rod is too long.
pub fn factorial_lookups(
    mesh: &Mesh,
    rod: &Rod,
    sampling: &Piecewise,
    rule: ParticleRule,
) -> Option<[Known; 4]> {
    let walk = Walk::new(mesh, rod, Some(sampling), rule)?;
    Solved::of(&walk, true).map(|found| found.lookups)
}

/// Prediction for an unbiased walk with draws in `[0, 1]`: expected values, and `Var[X] ≤ E[X](1 − E[X])`.
pub fn bounded(mesh: &Mesh, rod: &Rod) -> Prediction {
    let truth = truth_or_nan(mesh, rod);
    let channels = rod.channels.iter().zip(truth).map(|(quantity, truth)| Channel {
        name: quantity.name(),
        variance_bound: Some(truth.value * (1.0 - truth.value)),
        ..Channel::unbiased(truth, None, Tails::LIGHT)
    });
    Prediction { channels: channels.collect(), ..Prediction::default() }
}

/// Moments of all channels and of the lookups.
struct Solved {
    /// Raw moments of each channel.
    raw: Vec<RawMoments>,
    /// Factorial moments of the number of lookups.
    lookups: [Known; 4],
    /// Joint moments with the absorbed energy, where that is a channel and the moments exist.
    joint: Option<Joint>,
}

impl Solved {
    fn of(walk: &Walk<'_>, laws: bool) -> Option<Self> {
        let precision = if laws { Precision::FULL } else { Precision::PLOTS };
        let [second, fourth, eighth] = if laws {
            Existence::of(walk, [2, 4, 8])
        } else {
            [Existence::of(walk, [2])[0], Existence::Unknown, Existence::Unknown]
        };
        if matches!(second, Existence::Diverges(_) | Existence::Unknown) {
            return None;
        }
        // The first moment exists wherever the second does; the third is of no use without the fourth.
        let existences = [Existence::Finite, second, fourth, fourth, eighth];
        let channels = &walk.rod.channels;
        let is_finite = |i: &usize| existences[*i] == Existence::Finite;
        let powers: Vec<i32> = (0..POWERS.len()).filter(is_finite).map(|i| POWERS[i]).collect();
        // Next to its divergence a moment has no answer on coarse grids, and is solved separately.
        let apart = |i: usize| match existences[i] {
            Existence::Near => Some(self::powers(walk, POWERS[i])),
            _ => None,
        };
        let apart: [_; POWERS.len()] = std::array::from_fn(apart);
        if !apart[1].as_ref().is_none_or(|found| blur(found) <= RESOLVED) {
            return None;
        }
        let is_joint = is_finite(&3) && channels.contains(&Quantity::Absorbed);
        let numbers = moments::romberg(walk, precision, &|grid| {
            let mut numbers = moments::lookups(grid)?.to_vec();
            for &quantity in channels {
                for &k in &powers {
                    numbers.push(moments::power(grid, quantity, k)?);
                }
            }
            if is_joint {
                numbers.extend(moments::joint(grid, true)?.as_flattened());
            }
            Some(numbers)
        })?;
        let mut numbers = numbers.into_iter().map(known);
        let mut next = || numbers.next().unwrap_or(Known::INFINITE);
        let lookups = std::array::from_fn(|_| next());
        let mut of_channel = |channel: usize| {
            RawMoments(std::array::from_fn(|i| match &apart[i] {
                Some(found) => found[channel],
                None if is_finite(&i) => next(),
                None => Known::INFINITE,
            }))
        };
        let raw = (0..channels.len()).map(&mut of_channel).collect();
        let joint =
            is_joint.then(|| std::array::from_fn(|_| std::array::from_fn(|_| next().value)));
        Some(Self { raw, lookups, joint })
    }
}

/// A number of Romberg's scheme with its difference.
fn known([value, error]: [f64; 2]) -> Known {
    Known::estimated(value, error)
}

/// The largest relative error of some moments.
fn blur(found: &[Known]) -> f64 {
    let worst = |most: f64, blur: f64| if blur <= most { most } else { blur };
    found.iter().map(|known| known.relative_error()).fold(0.0, worst)
}

/// The covariances of adjacent channels. A particle leaves at one end and after one number of scatterings: the
/// products of such channels are 0.
fn covariances(channels: &[Quantity], truth: &[Known], found: &Solved) -> Vec<Covariance> {
    let mut covariances = Vec::new();
    for (first, pair) in channels.windows(2).enumerate() {
        let means = [truth[first].value, truth[first + 1].value];
        let squares = [first, first + 1].map(|channel| found.raw[channel].second().value);
        let joint = match (pair, found.joint) {
            ([Quantity::Absorbed, _], Some(joint)) => joint,
            ([Quantity::Absorbed, _], None)
            | ([_, Quantity::Absorbed] | [Quantity::Flux(_), _], _) => continue,
            _ => [[0.0; 2]; 2],
        };
        let [[ab, abb], [aab, aabb]] = joint;
        let pair = [first, first + 1];
        covariances.push(Covariance::of_raw(pair, means, squares, [ab, aab, abb, aabb]));
    }
    covariances
}
