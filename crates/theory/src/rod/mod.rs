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
use self::moments::{Existence, Joint, POWERS, Precision};
use super::particle::ParticleRule;
use super::prediction::Covariance;
use super::{Channel, CountLaw, Mesh, Moments, Prediction, Tails, moments::not_negative};
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
        _ => solved.next().map(|[value, error]| Known::estimated(value, error)),
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
        Existence::Near => match RawMoments::blur(&powers(&walk, 2)) {
            blur if blur <= RESOLVED => Ok(()),
            blur => Err(NoVariance::Blurred(blur)),
        },
    }
}

/// `E[X^k]` of each channel with its error, where the moment is next to its divergence; infinite where grids do not
/// resolve it.
fn powers(walk: &Walk<'_>, k: i32) -> Vec<[f64; 2]> {
    let channels = &walk.rod.channels;
    let numbers = moments::next_to_divergence(walk, &|grid| {
        channels.iter().map(|&quantity| moments::power(grid, quantity, k)).collect()
    });
    numbers.unwrap_or_else(|| vec![[f64::INFINITY; 2]; channels.len()])
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
    let found =
        Walk::new(mesh, rod, Some(sampling), rule).and_then(|walk| RawMoments::of(&walk, laws));
    let channel = |(index, (quantity, &truth)): (usize, (&Quantity, &Known))| {
        let raw = found.as_ref().map(|found| &found.raw[index]);
        let moments = raw.map(|raw| central(truth, raw));
        let tails = raw.map_or(Tails::LIGHT, tails);
        Channel { name: quantity.name(), ..Channel::unbiased(truth, moments, tails) }
    };
    let channels = rod.channels.iter().zip(&truth).enumerate().map(channel);
    Prediction {
        channels: channels.collect(),
        lookups: found.as_ref().map(|found| CountLaw::of_known(found.lookups)),
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
) -> Option<[[f64; 2]; 4]> {
    let walk = Walk::new(mesh, rod, Some(sampling), rule)?;
    RawMoments::of(&walk, true).map(|found| found.lookups)
}

/// Prediction for an unbiased walk with draws in `[0, 1]`: expected values, and `Var[X] ≤ E[X](1 − E[X])`.
pub fn bounded(mesh: &Mesh, rod: &Rod) -> Prediction {
    let truth = truth_or_nan(mesh, rod);
    let channels = rod.channels.iter().zip(truth).map(|(quantity, truth)| Channel {
        name: quantity.name(),
        most_variance: Some(truth.value * (1.0 - truth.value)),
        ..Channel::unbiased(truth, None, Tails::LIGHT)
    });
    Prediction { channels: channels.collect(), ..Prediction::default() }
}

/// Raw moments of all channels.
struct RawMoments {
    /// `E[X^k]` of each channel for the powers of [`POWERS`], with an absolute error; infinite where
    /// it diverges.
    raw: Vec<[[f64; 2]; POWERS.len()]>,
    /// Factorial moments of the number of lookups, with absolute errors.
    lookups: [[f64; 2]; 4],
    /// Joint moments with the absorbed energy, where that is a channel and the moments exist.
    joint: Option<Joint>,
}

impl RawMoments {
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
        if !apart[1].as_ref().is_none_or(|found| Self::blur(found) <= RESOLVED) {
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
        let mut numbers = numbers.into_iter();
        let mut next = || numbers.next().unwrap_or([f64::INFINITY; 2]);
        let lookups = std::array::from_fn(|_| next());
        let mut of_channel = |channel: usize| {
            std::array::from_fn(|i| match &apart[i] {
                Some(found) => found[channel],
                None if is_finite(&i) => next(),
                None => [f64::INFINITY; 2],
            })
        };
        let raw = (0..channels.len()).map(&mut of_channel).collect();
        let joint = is_joint.then(|| std::array::from_fn(|_| std::array::from_fn(|_| next()[0])));
        Some(Self { raw, lookups, joint })
    }

    /// The largest relative error of some moments.
    fn blur(found: &[[f64; 2]]) -> f64 {
        let blur = |&[value, error]: &[f64; 2]| if value > 0.0 { error / value } else { error };
        let worst = |most: f64, blur: f64| if blur <= most { most } else { blur };
        found.iter().map(blur).fold(0.0, worst)
    }
}

/// Maximum relative error of a moment that is used.
const RESOLVED: f64 = 0.05;
/// Maximum size of moments, in units of the expected value, that are rounding.
const FAINT: f64 = 1e-9;

/// Central moments in units of the expected value. Higher ones that grids do not resolve, for weights that grow too
/// steeply, are infinite, as where they diverge.
pub(super) fn central(truth: Known, raw: &[[f64; 2]; POWERS.len()]) -> Moments {
    let m = truth.value;
    let [_, [two, e2], [three, e3], [four, e4], _] = *raw;
    let off = (e2 + 2.0 * m * truth.error) / (m * m);
    let [second, error] = not_negative((two - m * m) / (m * m), off);
    let third = (three - 3.0 * m * two + 2.0 * m.powi(3)) / m.powi(3);
    let fourth = (four - 4.0 * m * three + 6.0 * m * m * two - 3.0 * m.powi(4)) / m.powi(4);
    let of_truth = 4.0 * three.abs() + 12.0 * m * two + 12.0 * m.powi(3);
    let off = (e4 + 4.0 * m * e3 + 6.0 * m * m * e2 + of_truth * truth.error) / m.powi(4);
    // By Jensen's inequality the fourth moment is at least the square of the second.
    let is_resolved = off <= (RESOLVED * fourth).max(FAINT)
        && fourth >= (1.0 - RESOLVED) * second * second - FAINT;
    if !four.is_finite() || !is_resolved {
        return Moments::estimated(m, [second, f64::INFINITY, f64::INFINITY], error);
    }
    let [fourth, of_fourth] = not_negative(fourth.max(second * second), off);
    Moments::estimated(m, [second, third, fourth], error.max(of_fourth))
}

/// The rare-event size is that of `D ≤ ln(E[X⁴]/E[X²]²)`, by Jensen's inequality.
pub(super) fn tails(raw: &[[f64; 2]; POWERS.len()]) -> Tails {
    let [_, [two, _], _, fourth, eighth] = *raw;
    let or_infinite = |[moment, error]: [f64; 2], least: f64| {
        let is_resolved = error <= RESOLVED * moment && moment >= (1.0 - RESOLVED) * least;
        if is_resolved { moment } else { f64::INFINITY }
    };
    let four = or_infinite(fourth, two * two);
    let eight = or_infinite(eighth, four * four);
    Tails {
        rare_event_size: four / (two * two),
        eighth_moment_ratio: if eight.is_finite() { eight / (four * four) } else { f64::INFINITY },
    }
}

/// The covariances of adjacent channels. A particle leaves at one end and after one number of scatterings: the
/// products of such channels are 0.
fn covariances(channels: &[Quantity], truth: &[Known], found: &RawMoments) -> Vec<Covariance> {
    let mut covariances = Vec::new();
    for (first, pair) in channels.windows(2).enumerate() {
        let means = [truth[first].value, truth[first + 1].value];
        let squares = [found.raw[first][1][0], found.raw[first + 1][1][0]];
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
