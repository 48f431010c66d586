//! Wrong walks through rods and slabs of coloured scatterers.

use super::target::{
    SPECTRAL_ROD_MIS, SPECTRAL_ROD_TRACKING, SPECTRAL_SLAB_MIS, SPECTRAL_SLAB_TRACKING,
};
use super::{About, Mutant, Target, with};
use estimators::setup::heroes::Heroes;
use estimators::spectral_rod::Coloured;
use estimators::spectral_rod::spectral_mis::SpectralMis;
use estimators::spectral_rod::spectral_tracking::SpectralTracking;
use estimators::spectral_rod::walk::{Page, draw, relative};
use media::body::MOST_CHANNELS;
use theory::problems::{SpectralRod, SpectralSlab};

/// A bug in draws of a body.
fn of<P: Coloured>(name: &'static str, bug: &'static str, target: Target, slip: Slip) -> Mutant<P> {
    let about = About { name, bug, target, check: "mean" };
    let wrong = with(slip, draw);
    if slip.is_of_tracking() {
        Mutant::new(about, wrong, with(SpectralTracking { maximum: false }, draw))
    } else {
        Mutant::new(about, wrong, with(SpectralMis { heroes: Heroes::Uniform }, draw))
    }
}

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<SpectralRod>> {
    vec![
        of("spectral-rod-dropped", "the last channel is missing from the denominator", SPECTRAL_ROD_MIS, Slip::Dropped),
        of("spectral-rod-albedo-twice", "the hero's albedo is a chance and stays in the weight", SPECTRAL_ROD_MIS, Slip::AlbedoTwice),
        of("spectral-rod-hero-anew", "every scattering has the density of a hero of its own: the mean albedo", SPECTRAL_ROD_MIS, Slip::Anew),
        of("spectral-rod-chance-kept", "the weight is not divided by the chance to be scattered", SPECTRAL_ROD_TRACKING, Slip::ChanceKept),
        of("spectral-rod-largest-albedo", "weights are divided by the largest albedo, not by the chance", SPECTRAL_ROD_TRACKING, Slip::Largest),
    ]
}

/// The same in slabs.
#[rustfmt::skip] // one mutant, one entry
pub fn in_slab() -> Vec<Mutant<SpectralSlab>> {
    vec![
        of("spectral-slab-dropped", "the last channel is missing from the denominator", SPECTRAL_SLAB_MIS, Slip::Dropped),
        of("spectral-slab-hero-anew", "every scattering has the density of a hero of its own: the mean albedo", SPECTRAL_SLAB_MIS, Slip::Anew),
        of("spectral-slab-chance-kept", "the weight is not divided by the chance to be scattered", SPECTRAL_SLAB_TRACKING, Slip::ChanceKept),
        of("spectral-slab-largest-albedo", "weights are divided by the largest albedo, not by the chance", SPECTRAL_SLAB_TRACKING, Slip::Largest),
    ]
}

/// What goes wrong.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
    Dropped,
    AlbedoTwice,
    Anew,
    ChanceKept,
    Largest,
}

impl Slip {
    /// Whether it is one of spectral tracking by the mean albedo, not of the balance heuristic.
    fn is_of_tracking(self) -> bool {
        matches!(self, Self::ChanceKept | Self::Largest)
    }
}

impl Page for Slip {
    fn heroes(&self) -> Option<&Heroes> {
        (!self.is_of_tracking()).then_some(&Heroes::Uniform)
    }

    fn chance(&self, albedos: &[f64], hero: usize) -> f64 {
        if self.is_of_tracking() { mean(albedos) } else { albedos[hero] }
    }

    fn weights(&self, albedos: &[f64], hero: usize, order: u32) -> [f64; MOST_CHANNELS] {
        let largest = || albedos.iter().fold(0.0f64, |most, &a| most.max(a));
        match self {
            Self::ChanceKept => divided(albedos, 1.0, order),
            Self::Largest => divided(albedos, largest(), order),
            _ => self.balanced(albedos, hero, order),
        }
    }
}

impl Slip {
    fn balanced(self, albedos: &[f64], hero: usize, order: u32) -> [f64; MOST_CHANNELS] {
        let count = albedos.len();
        let mut weights = relative(albedos, hero, order);
        let mut density = 0.0;
        for (channel, weight) in weights[..count].iter().enumerate() {
            if self != Self::Dropped || channel + 1 < count {
                density += Heroes::Uniform.probability(count, channel) * weight;
            }
        }
        if self == Self::Anew {
            let mean = mean(albedos);
            density = (0..order).fold(1.0, |density, _| density * mean / albedos[hero]);
        }
        let twice = if self == Self::AlbedoTwice { albedos[hero] } else { 1.0 };
        for weight in &mut weights[..count] {
            *weight = *weight / density * twice;
        }
        weights
    }
}

fn mean(albedos: &[f64]) -> f64 {
    albedos.iter().sum::<f64>() / albedos.len() as f64
}

/// `(a_λ/d)^r`.
fn divided(albedos: &[f64], divisor: f64, order: u32) -> [f64; MOST_CHANNELS] {
    let mut weights = [1.0; MOST_CHANNELS];
    for _ in 0..order {
        for (weight, albedo) in weights.iter_mut().zip(albedos) {
            *weight *= albedo / divisor;
        }
    }
    weights
}
