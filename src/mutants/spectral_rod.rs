//! Wrong walks through rods of coloured scatterers.

use super::target::{SPECTRAL_ROD_MIS, SPECTRAL_ROD_TRACKING};
use super::{About, Mutant, with};
use crate::estimators::heroes::Heroes;
use crate::estimators::spectral_rod::walk::walk;
use crate::estimators::{Draw, Setup};
use crate::media::Lookups;
use crate::media::body::MOST_CHANNELS;
use crate::problems::SpectralRod;
use crate::problems::spectral_rod::Values;
use crate::rng::Stream;

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<SpectralRod>> {
    let of = |name, bug, target, draw: Draws, slip| {
        let by = |slip| with((draw, slip), |&(draw, slip), setup, medium, rng| draw(slip, setup, medium, rng));
        Mutant::new(About { name, bug, target, check: "mean" }, by(slip), by(Slip::None))
    };
    vec![
        of("spectral-rod-dropped", "the last channel is missing from the denominator", SPECTRAL_ROD_MIS, balanced, Slip::Dropped),
        of("spectral-rod-albedo-twice", "the hero's albedo is a chance and stays in the weight", SPECTRAL_ROD_MIS, balanced, Slip::AlbedoTwice),
        of("spectral-rod-hero-anew", "every scattering has the density of a hero of its own: the mean albedo", SPECTRAL_ROD_MIS, balanced, Slip::Anew),
        of("spectral-rod-chance-kept", "the weight is not divided by the chance to be scattered", SPECTRAL_ROD_TRACKING, tracked, Slip::ChanceKept),
        of("spectral-rod-largest-albedo", "weights are divided by the largest albedo, not by the chance", SPECTRAL_ROD_TRACKING, tracked, Slip::Largest),
    ]
}

/// Draws with a slip.
type Draws = fn(Slip, &Setup<SpectralRod>, &Lookups, &mut Stream) -> Draw<Values>;

/// What goes wrong.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    None,
    Dropped,
    AlbedoTwice,
    Anew,
    ChanceKept,
    Largest,
}

/// The balance heuristic, see `estimators/spectral_rod/spectral_mis.rs`.
fn balanced(
    slip: Slip,
    setup: &Setup<SpectralRod>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    let (rod, heroes) = (&setup.problem, Heroes::Uniform);
    let count = rod.albedos.len();
    let hero = heroes.choose(count, rng.uniform());
    let left = walk(setup, medium, rng, rod.albedos[hero]);
    let mut weights = [1.0; MOST_CHANNELS];
    for _ in 0..left.order {
        for (weight, albedo) in weights.iter_mut().zip(&rod.albedos) {
            *weight *= albedo / rod.albedos[hero];
        }
    }
    let mut density = 0.0;
    for (channel, weight) in weights[..count].iter().enumerate() {
        if slip != Slip::Dropped || channel + 1 < count {
            density += heroes.probability(count, channel) * weight;
        }
    }
    if slip == Slip::Anew {
        let mean = rod.albedos.iter().sum::<f64>() / count as f64;
        density = (0..left.order).fold(1.0, |density, _| density * mean / rod.albedos[hero]);
    }
    let twice = if slip == Slip::AlbedoTwice { rod.albedos[hero] } else { 1.0 };
    for weight in &mut weights[..count] {
        *weight = *weight / density * twice;
    }
    Draw::free(rod.values(left.end, &weights), left.lookups)
}

/// Spectral tracking by the mean albedo, see `estimators/spectral_rod/spectral_tracking.rs`.
fn tracked(
    slip: Slip,
    setup: &Setup<SpectralRod>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    let rod = &setup.problem;
    let scatter = rod.albedos.iter().sum::<f64>() / rod.albedos.len() as f64;
    let left = walk(setup, medium, rng, scatter);
    let divisor = match slip {
        Slip::ChanceKept => 1.0,
        Slip::Largest => rod.albedos.iter().fold(0.0f64, |most, &a| most.max(a)),
        _ => scatter,
    };
    let mut weights = [1.0; MOST_CHANNELS];
    for _ in 0..left.order {
        for (weight, albedo) in weights.iter_mut().zip(&rod.albedos) {
            *weight *= albedo / divisor;
        }
    }
    Draw::free(rod.values(left.end, &weights), left.lookups)
}
