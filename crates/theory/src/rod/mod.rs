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

pub mod bidirectional;
pub mod closed;
pub mod line;
pub mod lit;
pub mod moments;
pub mod spectral;
pub mod walk;

use self::moments::Joint;
use self::walk::RodWalk;
use super::prediction::Covariance;
use super::{Channel, CountDistribution, Mesh, Prediction, Tails};
use crate::ParticleRule;
use crate::prediction::raw::{POWERS, RESOLVED, RawMoments};
use crate::problems::rod::RodQuantity;
use crate::problems::{Problem, Rod};
use media::Piecewise;
use numeric::Known;

/// The exact answer of every channel; `None` where the rod has too many panels for theory.
pub fn truth(mesh: &Mesh, rod: &Rod) -> Option<Vec<Known>> {
    let support = mesh.support();
    let depth = rod.medium().optical_depth(support);
    let share = |field: &Piecewise| field.on(support).single_value();
    let closed = share(&rod.albedo).zip(share(&rod.forward));
    let closed = closed.and_then(|(albedo, forward)| closed::known(depth, albedo, forward, 0.0));
    let needed = |quantity: &&RodQuantity| closed.is_none() || !has_closed_form(**quantity);
    let open: Vec<RodQuantity> = rod.channels.iter().filter(needed).copied().collect();
    let mut solved = Vec::new();
    if !open.is_empty() {
        let walk = RodWalk::new(mesh, rod, None, ParticleRule::Analog);
        solved = powers(&walk, &open, 1)?;
    }
    let mut solved = solved.into_iter();
    let known = rod.channels.iter().map(|quantity| match (closed, quantity) {
        (Some([r, _]), RodQuantity::Reflected) => Some(r),
        (Some([_, t]), RodQuantity::Transmitted) => Some(t),
        (Some([r, t]), RodQuantity::Absorbed) => {
            // In a white rod rounding may make the rest negative.
            let rest = ((1.0 - r.value) - t.value).max(0.0);
            Some(Known { value: rest, error: r.error + t.error + f64::EPSILON, ..r })
        }
        _ => solved.next(),
    });
    known.collect()
}

/// The exact answer of every channel; NaN where it is unknown.
fn truth_or_nan(mesh: &Mesh, rod: &Rod) -> Vec<Known> {
    truth(mesh, rod).unwrap_or_else(|| vec![Known::UNKNOWN; rod.channels.len()])
}

fn has_closed_form(quantity: RodQuantity) -> bool {
    matches!(quantity, RodQuantity::Reflected | RodQuantity::Transmitted | RodQuantity::Absorbed)
}

/// Reason why a walk has no variance that draws can be compared with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoVariance {
    /// The second moment diverges: the rod would have to end at this distance.
    Diverges(f64),
    /// The second moment is next to its divergence, and known to this relative error only; above 1, it may diverge.
    Unresolved(f64),
    /// The second moment is below the least double that has all its digits.
    Underflows,
    /// The rod has too many panels for theory.
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
    let walk = RodWalk::new(mesh, rod, Some(sampling), rule);
    walk.exists(2)?;
    let Some(result) = powers(&walk, &rod.channels, 2) else {
        return Err(NoVariance::Unresolved(f64::INFINITY));
    };
    let is_faint = |known: &Known| known.value * f64::EPSILON < f64::MIN_POSITIVE;
    // Nothing at all is exact.
    let underflows = |(known, truth): (&Known, &Known)| is_faint(known) && truth.value > 0.0;
    if result.iter().any(is_faint) && result.iter().zip(&truth_or_nan(mesh, rod)).any(underflows) {
        return Err(NoVariance::Underflows);
    }
    match blur(&result) {
        blur if blur <= RESOLVED => Ok(()),
        blur => Err(NoVariance::Unresolved(blur)),
    }
}

/// `E[X^k]` of some channels with their errors.
fn powers(walk: &RodWalk<'_>, channels: &[RodQuantity], k: i32) -> Option<Vec<Known>> {
    walk.known(k, &|line| {
        channels
            .iter()
            .map(|&quantity| moments::power(line, quantity, walk.rod.width(), k))
            .collect()
    })
}

/// Prediction for the walk of a rule through σ̂. It has the expected value alone where [`has_variance`] refuses the
/// walk, and not even that where the rod is too long.
///
/// Without `with_distributions`, as for lines in plots, only variances and mean lookups are valid.
pub fn predict(
    mesh: &Mesh,
    rod: &Rod,
    sampling: &Piecewise,
    rule: ParticleRule,
    with_distributions: bool,
) -> Prediction {
    let truth = truth_or_nan(mesh, rod);
    let result = SolvedRod::of(&RodWalk::new(mesh, rod, Some(sampling), rule), with_distributions);
    let channel = |(index, (quantity, &truth)): (usize, (&RodQuantity, &Known))| {
        let channel = match &result {
            Some(result) => result.raw[index].channel(truth, RESOLVED),
            None => Channel::unbiased(truth, None, Tails::LIGHT),
        };
        Channel { name: quantity.name(), ..channel }
    };
    let channels = rod.channels.iter().zip(&truth).enumerate().map(channel);
    Prediction {
        channels: channels.collect(),
        lookups: result.as_ref().map(|result| CountDistribution::of_factorial(result.lookups)),
        covariances: result
            .as_ref()
            .map_or_else(Vec::new, |result| covariances(&rod.channels, &truth, result)),
        ..Prediction::default()
    }
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
struct SolvedRod {
    /// Raw moments of each channel.
    raw: Vec<RawMoments>,
    /// Factorial moments of the number of lookups.
    lookups: [Known; 4],
    /// Joint moments with the absorbed energy, where that is a channel and the moments exist.
    joint: Option<Joint>,
}

impl SolvedRod {
    fn of(walk: &RodWalk<'_>, with_distributions: bool) -> Option<Self> {
        walk.exists(2).ok()?;
        // The first moment exists wherever the second does; the third is of no use without the fourth.
        let highest =
            [8, 4].into_iter().find(|&k| with_distributions && walk.exists(k).is_ok()).unwrap_or(2);
        let channels = &walk.rod.channels;
        let is_joint = highest >= 4 && channels.contains(&RodQuantity::Absorbed);
        let numbers = walk.known(highest, &|line| {
            let mut numbers = moments::lookups(line)?.to_vec();
            for &quantity in channels {
                for k in POWERS.into_iter().filter(|&k| k <= highest) {
                    numbers.push(moments::power(line, quantity, walk.rod.width(), k)?);
                }
            }
            if is_joint {
                numbers.extend(moments::joint(line)?.as_flattened());
            }
            Some(numbers)
        })?;
        let mut numbers = numbers.into_iter();
        let mut next = || numbers.next().unwrap_or(Known::INFINITE);
        let lookups = std::array::from_fn(|_| next());
        let mut of_channel =
            || RawMoments(POWERS.map(|k| if k <= highest { next() } else { Known::INFINITE }));
        let raw: Vec<RawMoments> = channels.iter().map(|_| of_channel()).collect();
        let seconds: Vec<Known> = raw.iter().map(RawMoments::second).collect();
        (blur(&seconds) <= RESOLVED).then_some(())?;
        let joint =
            is_joint.then(|| std::array::from_fn(|_| std::array::from_fn(|_| next().value)));
        Some(Self { raw, lookups, joint })
    }
}

/// The largest relative error of some moments.
fn blur(result: &[Known]) -> f64 {
    let worst = |maximum: f64, blur: f64| if blur <= maximum { maximum } else { blur };
    result.iter().map(|known| known.relative_error()).fold(0.0, worst)
}

/// The covariances of adjacent channels. A particle leaves at one end and after one number of scatterings: the
/// products of such channels are 0.
fn covariances(channels: &[RodQuantity], truth: &[Known], result: &SolvedRod) -> Vec<Covariance> {
    let mut covariances = Vec::new();
    for (first, pair) in channels.windows(2).enumerate() {
        let means = [truth[first].value, truth[first + 1].value];
        let squares = [first, first + 1].map(|channel| result.raw[channel].second().value);
        let joint = match (pair, result.joint) {
            ([RodQuantity::Absorbed, _], Some(joint)) => joint,
            ([RodQuantity::Absorbed, _], None)
            | ([_, RodQuantity::Absorbed] | [RodQuantity::Flux(_), _], _) => continue,
            _ => [[0.0; 2]; 2],
        };
        let [[ab, abb], [aab, aabb]] = joint;
        let pair = [first, first + 1];
        covariances.push(Covariance::of_raw(pair, means, squares, [ab, aab, abb, aabb]));
    }
    covariances
}
