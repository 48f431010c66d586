//! Wrong walks through rods and slabs of coloured scatterers.

use super::target::{
    SPECTRAL_ROD_MIS, SPECTRAL_ROD_TRACKING, SPECTRAL_SLAB_MIS, SPECTRAL_SLAB_TRACKING,
};
use super::{About, Mutant, Target, with};
use estimators::setup::heroes::Heroes;
use estimators::spectral_rod::Coloured;
use estimators::{Draw, Setup};
use media::Lookups;
use media::body::MOST_CHANNELS;
use numeric::rng::Stream;
use theory::problems::spectral_rod::Values;
use theory::problems::{SpectralRod, SpectralSlab};

/// A bug in draws of a body.
fn of<P: Coloured>(
    name: &'static str,
    bug: &'static str,
    target: Target,
    draw: Draws<P>,
    slip: Slip,
) -> Mutant<P> {
    let by = |slip| {
        with((draw, slip), |&(draw, slip), setup, medium, rng| draw(slip, setup, medium, rng))
    };
    Mutant::new(About { name, bug, target, check: "mean" }, by(slip), by(Slip::None))
}

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<SpectralRod>> {
    vec![
        of("spectral-rod-dropped", "the last channel is missing from the denominator", SPECTRAL_ROD_MIS, balanced, Slip::Dropped),
        of("spectral-rod-albedo-twice", "the hero's albedo is a chance and stays in the weight", SPECTRAL_ROD_MIS, balanced, Slip::AlbedoTwice),
        of("spectral-rod-hero-anew", "every scattering has the density of a hero of its own: the mean albedo", SPECTRAL_ROD_MIS, balanced, Slip::Anew),
        of("spectral-rod-chance-kept", "the weight is not divided by the chance to be scattered", SPECTRAL_ROD_TRACKING, tracked, Slip::ChanceKept),
        of("spectral-rod-largest-albedo", "weights are divided by the largest albedo, not by the chance", SPECTRAL_ROD_TRACKING, tracked, Slip::Largest),
    ]
}

/// The same in slabs.
#[rustfmt::skip] // one mutant, one entry
pub fn in_slab() -> Vec<Mutant<SpectralSlab>> {
    vec![
        of("spectral-slab-dropped", "the last channel is missing from the denominator", SPECTRAL_SLAB_MIS, balanced, Slip::Dropped),
        of("spectral-slab-hero-anew", "every scattering has the density of a hero of its own: the mean albedo", SPECTRAL_SLAB_MIS, balanced, Slip::Anew),
        of("spectral-slab-chance-kept", "the weight is not divided by the chance to be scattered", SPECTRAL_SLAB_TRACKING, tracked, Slip::ChanceKept),
        of("spectral-slab-largest-albedo", "weights are divided by the largest albedo, not by the chance", SPECTRAL_SLAB_TRACKING, tracked, Slip::Largest),
    ]
}

/// Draws with a slip.
type Draws<P> = fn(Slip, &Setup<P>, &Lookups, &mut Stream) -> Draw<Values>;

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
fn balanced<P: Coloured>(
    slip: Slip,
    setup: &Setup<P>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    let (colours, heroes) = (setup.problem.colours(), Heroes::Uniform);
    let count = colours.albedos.len();
    let hero = heroes.choose(count, rng.uniform());
    let left = P::walk(setup, medium, rng, colours.albedos[hero]);
    let mut weights = [1.0; MOST_CHANNELS];
    for _ in 0..left.order {
        for (weight, albedo) in weights.iter_mut().zip(&colours.albedos) {
            *weight *= albedo / colours.albedos[hero];
        }
    }
    let mut density = 0.0;
    for (channel, weight) in weights[..count].iter().enumerate() {
        if slip != Slip::Dropped || channel + 1 < count {
            density += heroes.probability(count, channel) * weight;
        }
    }
    if slip == Slip::Anew {
        let mean = colours.albedos.iter().sum::<f64>() / count as f64;
        density = (0..left.order).fold(1.0, |density, _| density * mean / colours.albedos[hero]);
    }
    let twice = if slip == Slip::AlbedoTwice { colours.albedos[hero] } else { 1.0 };
    for weight in &mut weights[..count] {
        *weight = *weight / density * twice;
    }
    Draw::free(colours.values(left.end, &weights), left.lookups)
}

/// Spectral tracking by the mean albedo, see `estimators/spectral_rod/spectral_tracking.rs`.
fn tracked<P: Coloured>(
    slip: Slip,
    setup: &Setup<P>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    let colours = setup.problem.colours();
    let scatter = colours.albedos.iter().sum::<f64>() / colours.albedos.len() as f64;
    let left = P::walk(setup, medium, rng, scatter);
    let divisor = match slip {
        Slip::ChanceKept => 1.0,
        Slip::Largest => colours.albedos.iter().fold(0.0f64, |most, &a| most.max(a)),
        _ => scatter,
    };
    let mut weights = [1.0; MOST_CHANNELS];
    for _ in 0..left.order {
        for (weight, albedo) in weights.iter_mut().zip(&colours.albedos) {
            *weight *= albedo / divisor;
        }
    }
    Draw::free(colours.values(left.end, &weights), left.lookups)
}
