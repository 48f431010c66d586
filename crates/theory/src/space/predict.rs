//! Predictions for the sums over the collisions of walks in space.
//!
//! Sums without a known or bounded variance are judged by pilot draws.

use super::content;
use super::energy::WalkBound;
use super::infinite;
use crate::problems::{InfiniteMedium, Lambertian, MultipleScattering};
use crate::{Channel, CountDistribution, Moments, Prediction, Tails};
use numeric::{Grade, Known};

/// Relative rounding error of a sum over the collisions of a walk.
const ROUNDING: f64 = 1e-12;
/// Maximum relative error of `∫σ_t dV` that draws are compared with.
const BLURRED: f64 = 1e-3;

/// Energy of a particle, 1 on average, given a bound on its variance and `∫σ̂` straight through.
pub fn energy_channel(bound: f64, depth: f64) -> Channel {
    // A walk that nothing ends makes about depth² collisions, and each rounds.
    let rounding = ROUNDING + 4.0 * f64::EPSILON * depth * depth;
    let certain = Channel::unbiased(Known::new(1.0, rounding), Moments::certain(1.0), Tails::LIGHT);
    if bound == 0.0 {
        return certain;
    }
    Channel { moments: None, variance_bound: Some(bound), ..certain }
}

/// A channel of unknown variance, with light tails.
fn piloted(name: impl Into<String>, truth: Known) -> Channel {
    let unknown = Channel::unbiased(truth, None, Tails::LIGHT);
    Channel { name: name.into(), pilot_variance_allowed: true, ..unknown }
}

/// Prediction for the energy in a furnace; without a bound on the variance only the expected value is valid.
pub fn furnace(walks: &WalkBound) -> Prediction {
    let bound = walks.energy_variance().unwrap_or(f64::INFINITY);
    Prediction::uncounted(energy_channel(bound, walks.depth))
}

/// Prediction for the light of a sky that is seen beside the volume; through the volume the mean is unknown.
pub fn sky(problem: &MultipleScattering) -> Prediction {
    if problem.entry().is_some() {
        let unknown = Known::new(0.0, f64::INFINITY);
        return Prediction::uncounted(Channel::unbiased(unknown, None, Tails::LIGHT));
    }
    let seen = problem.background();
    let channel = Channel::unbiased(Known::exact(seen), Moments::certain(seen), Tails::LIGHT);
    Prediction::single(channel, CountDistribution::always(0.0))
}

/// Channels of walks under light from all sides, in their order; collisions follow path lengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WalkChannels {
    /// Energy.
    pub energy: bool,
    /// Path length and collisions, where nothing is absorbed.
    pub white: bool,
    /// Tentative collisions.
    pub tentative: bool,
}

impl WalkChannels {
    /// Returns whether there is a channel.
    pub fn any(self) -> bool {
        self.energy || self.white || self.tentative
    }
}

/// `∫σ_t dV`, if its error is small enough.
pub fn held(problem: &Lambertian) -> Option<Known> {
    let held = problem.content(|| content::content(&*problem.scene.volume));
    held.filter(|known| known.error <= BLURRED * known.value && known.value > 0.0)
}

/// Prediction for walks under light from all sides, given `∫σ̂ dV` where it is known.
pub fn lambertian(
    problem: &Lambertian,
    walks: &WalkBound,
    has: WalkChannels,
    tentative: Option<f64>,
) -> Prediction {
    let mut channels = Vec::new();
    let bound = walks.energy_variance().filter(|_| has.energy);
    let named = |bound| Channel { name: "energy".into(), ..energy_channel(bound, walks.depth) };
    channels.extend(bound.map(named));
    let over = problem.four_over_surface();
    let mut count = |name: &str, known: Known| {
        let scaled = known * over;
        channels.push(piloted(name, scaled.blurred(4.0 * f64::EPSILON * scaled.value)));
    };
    if has.white {
        count("path length", Known::exact(problem.bounds().content()));
        count("collisions", held(problem).unwrap_or(Known::UNKNOWN));
    }
    if let Some(content) = tentative.filter(|_| has.tentative) {
        count("tentative collisions", Known::exact(content));
    }
    if channels.is_empty() {
        // The setup is refused, or its draws are made in spite of that and have no prediction.
        channels.push(energy_channel(f64::INFINITY, 0.0));
    }
    Prediction { channels, ..Prediction::default() }
}

/// Moments of a multiple of the number of collisions up to one that ends the walk, with probability p each:
/// mean 1/p, variance (1 − p)/p², skewness (2 − p)/√(1 − p), kurtosis 9 + p²/(1 − p).
fn geometric(mean: f64, end: f64) -> Moments {
    let rest = 1.0 - end;
    let relative = [rest, (2.0 - end) * rest, (9.0 * rest + end * end) * rest];
    Moments { scale: mean, relative, error: infinite::ROUNDING, grade: Grade::Proven }
}

/// Prediction for walks from a point source in an infinite medium, given the probability that a tentative collision
/// ends the walk, where it is equal for all of them, and `r`, where it is constant.
pub fn infinite(problem: &InfiniteMedium, end: Option<f64>, ratio: Option<f64>) -> Prediction {
    let (sigma, albedo) = (problem.extinction, problem.albedo());
    let rounded = |value: f64| Known::new(value, infinite::ROUNDING * value.abs());
    let within = |radius: &f64| {
        let truth = infinite::collisions_within(albedo, sigma * radius);
        piloted(format!("collisions within {radius}"), truth)
    };
    let mut channels: Vec<Channel> = problem.radii.iter().map(within).collect();
    let cosine = problem.scene.phase.moment(1);
    let square = infinite::square_at_absorption(albedo, cosine) / (sigma * sigma);
    channels.push(piloted("squared distance", rounded(square)));
    let collisions = piloted("collisions", rounded(1.0 / (1.0 - albedo)));
    // Where every collision is real and nothing is scattered, there is exactly one.
    let is_certain = albedo == 0.0 && ratio == Some(1.0);
    let end = if is_certain { Some(1.0) } else { end.filter(|&end| end > 0.0) };
    let is_majorant = ratio.is_some_and(|ratio| ratio <= 1.0);
    // A real collision counts r: then the score of a walk depends only on its length.
    channels.push(match end.filter(|_| is_majorant) {
        Some(end) => {
            let truth = collisions.truth;
            let moments = Some(geometric(truth.value, end).in_units_of(truth));
            Channel { moments, pilot_variance_allowed: false, ..collisions }
        }
        None => collisions,
    });
    let distribution = |end: f64| {
        let moments = geometric(1.0 / end, end);
        let (variance, kurtosis) = (moments.variance(), moments.kurtosis().unwrap_or(1.0));
        if variance <= 0.0 {
            return CountDistribution::always(1.0);
        }
        let (mean, error, pmf) = (1.0 / end, infinite::ROUNDING, Vec::new());
        let (moments_error, grade) = (error, Grade::Proven);
        CountDistribution { mean, variance, error, grade, moments_error, kurtosis, pmf }
    };
    Prediction { channels, lookups: end.map(distribution), ..Prediction::default() }
}
