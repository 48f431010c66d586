//! Transmittance estimators with draws of discrete values: their distributions.

use crate::prediction::count::poisson;
use crate::prediction::transmittance;
use crate::{Channel, CountDistribution, Distribution, Mesh, Moments, Prediction, Tails};

/// Prediction for draws that are all `T e^{log_unit}`, with a constant number of lookups.
pub fn exact(mesh: &Mesh, log_unit: f64, lookups: usize) -> Prediction {
    let depth = mesh.optical_depth();
    let value = transmittance(depth, log_unit).value;
    let channel = Channel::transmittance(depth, log_unit, Moments::certain(value), Tails::LIGHT);
    Prediction {
        distribution: Some(Distribution::Atoms(vec![(value, 1.0)])),
        ..Prediction::single(channel, CountDistribution::always(lookups as f64))
    }
}

/// Adds the distribution of a draw that is 1 with probability T, else 0.
#[must_use]
pub fn zero_or_one(prediction: Prediction) -> Prediction {
    let alive = prediction.channels[0].truth.value;
    let distribution = Some(Distribution::Atoms(vec![(0.0, 1.0 - alive), (1.0, alive)]));
    Prediction { distribution, ..prediction }
}

/// Maximum mean of a Poisson number with values that are listed.
const LARGEST_MEAN: f64 = 1e4;

/// Values `scale · factor^n` of a Poisson number n with a mean; `None` where they are too many.
pub fn powers(scale: f64, factor: f64, mean: f64) -> Option<Distribution> {
    if mean > LARGEST_MEAN {
        return None;
    }
    let mut atoms: Vec<(f64, f64)> = Vec::new();
    let mut value = scale;
    for probability in poisson(mean) {
        match atoms.iter_mut().find(|atom| atom.0 == value) {
            // A factor of 0 or ±1 puts many n on one atom.
            Some(atom) => atom.1 += probability,
            None => atoms.push((value, probability)),
        }
        value *= factor;
    }
    Some(Distribution::Atoms(atoms))
}
