//! Wrong walks through rods and slabs of coloured scatterers.

use super::{Mutant, MutantRow, On, family, on, one_by_one};
use estimators::setup::heroes::Heroes;
use estimators::spectral_rod::Coloured;
use estimators::spectral_rod::walk::{HeroWeights, draw, relative_to};
use gate::CheckId;
use media::body::MAX_CHANNELS;
use theory::problems::{SpectralRod, SpectralSlab};

/// The balance heuristic, or spectral tracking by the mean albedo.
#[derive(Clone, Copy, PartialEq)]
enum MutantWalker {
    Mis,
    Tracking,
}

/// Albedos .99, .5 and .1, `p_f = .75`, an optical length of 2.
const ROD_MIS: On<MutantWalker> = on("rod/spectral-three-albedos", 1, MutantWalker::Mis);
/// A thin rod of albedos .6, .5 and .4, spectral tracking by the mean albedo.
const ROD_TRACKING: On<MutantWalker> = on("rod/spectral-near-albedos", 1, MutantWalker::Tracking);
/// A slab of albedos .9, .5 and .2, σ̂ above σ_t.
const SLAB_MIS: On<MutantWalker> = on("slab/spectral-known-bugs", 3, MutantWalker::Mis);
/// Spectral tracking by the mean albedo.
const SLAB_TRACKING: On<MutantWalker> = on("slab/spectral-known-bugs", 1, MutantWalker::Tracking);

#[derive(Clone, Copy, PartialEq)]
enum Bug {
    None,
    Dropped,
    AlbedoTwice,
    Anew,
    ChanceKept,
    Largest,
}

#[rustfmt::skip] // one mutant, one entry
const IN_ROD: &[MutantRow<MutantWalker, Bug>] = &[
    ("spectral-rod-dropped", "the last channel is missing from the denominator", ROD_MIS, CheckId::Mean, Bug::Dropped),
    ("spectral-rod-albedo-twice", "the hero's albedo is a chance and stays in the weight", ROD_MIS, CheckId::Mean, Bug::AlbedoTwice),
    ("spectral-rod-hero-anew", "every scattering has the density of a hero of its own: the mean albedo", ROD_MIS, CheckId::Mean, Bug::Anew),
    ("spectral-rod-chance-kept", "the weight is not divided by the chance to be scattered", ROD_TRACKING, CheckId::Mean, Bug::ChanceKept),
    ("spectral-rod-largest-albedo", "weights are divided by the largest albedo, not by the chance", ROD_TRACKING, CheckId::Mean, Bug::Largest),
];

#[rustfmt::skip] // one mutant, one entry
const IN_SLAB: &[MutantRow<MutantWalker, Bug>] = &[
    ("spectral-slab-dropped", "the last channel is missing from the denominator", SLAB_MIS, CheckId::Mean, Bug::Dropped),
    ("spectral-slab-hero-anew", "every scattering has the density of a hero of its own: the mean albedo", SLAB_MIS, CheckId::Mean, Bug::Anew),
    ("spectral-slab-chance-kept", "the weight is not divided by the chance to be scattered", SLAB_TRACKING, CheckId::Mean, Bug::ChanceKept),
    ("spectral-slab-largest-albedo", "weights are divided by the largest albedo, not by the chance", SLAB_TRACKING, CheckId::Mean, Bug::Largest),
];

/// Mutants in a rod.
pub fn in_rod() -> Vec<Mutant<SpectralRod>> {
    mutants(IN_ROD)
}

/// Mutants in a slab.
pub fn in_slab() -> Vec<Mutant<SpectralSlab>> {
    mutants(IN_SLAB)
}

fn mutants<P: Coloured>(lines: &[MutantRow<MutantWalker, Bug>]) -> Vec<Mutant<P>> {
    family(lines, &Bug::None, |&walker, &bug| {
        let wrong = Wrong { bug, tracks: walker == MutantWalker::Tracking };
        one_by_one(move |setup, medium, random| draw(&wrong, setup, medium, random))
    })
}

/// Spectral tracking by the mean albedo, or the balance heuristic, with a bug.
struct Wrong {
    bug: Bug,
    tracks: bool,
}

impl HeroWeights for Wrong {
    fn heroes(&self) -> Option<&Heroes> {
        (!self.tracks).then_some(&Heroes::Uniform)
    }

    fn probability(&self, albedos: &[f64], hero: usize) -> f64 {
        if self.tracks { mean(albedos) } else { albedos[hero] }
    }

    fn weights(&self, albedos: &[f64], hero: usize, order: u32) -> [f64; MAX_CHANNELS] {
        if !self.tracks {
            return self.balanced(albedos, hero, order);
        }
        let divisor = match self.bug {
            Bug::ChanceKept => 1.0,
            Bug::Largest => albedos.iter().fold(0.0f64, |maximum, &a| maximum.max(a)),
            _ => mean(albedos),
        };
        relative_to(albedos, divisor, order)
    }
}

impl Wrong {
    fn balanced(&self, albedos: &[f64], hero: usize, order: u32) -> [f64; MAX_CHANNELS] {
        let count = albedos.len();
        let mut weights = relative_to(albedos, albedos[hero], order);
        let mut density = 0.0;
        for (channel, weight) in weights[..count].iter().enumerate() {
            if self.bug != Bug::Dropped || channel + 1 < count {
                density += Heroes::Uniform.probability(count, channel) * weight;
            }
        }
        if self.bug == Bug::Anew {
            let mean = mean(albedos);
            density = (0..order).fold(1.0, |density, _| density * mean / albedos[hero]);
        }
        let twice = if self.bug == Bug::AlbedoTwice { albedos[hero] } else { 1.0 };
        for weight in &mut weights[..count] {
            *weight = *weight / density * twice;
        }
        weights
    }
}

fn mean(albedos: &[f64]) -> f64 {
    albedos.iter().sum::<f64>() / albedos.len() as f64
}
