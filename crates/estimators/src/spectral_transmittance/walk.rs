//! The walk of a hero channel through a chromatic medium, and what it says of all channels.
//!
//! ```text
//! tᵢ a Poisson process of rate μ̄_h;  ρ_λ = Π n_λ(tᵢ)/μ̄_λ,  n_λ = μ̄_λ − σ_λ
//! f_λ = q_λ ρ_λ,  p_h = q_h (ratio tracking) or q_h ρ_h (delta tracking),  q_λ = e^{−μ̄_λ ℓ} μ̄_λⁿ
//! ```
//!
//! `f_λ` is what the null-collision path contributes to channel λ and `p_h` its density by the hero h. Delta
//! tracking ends at a real collision of the hero. A step takes one random number for the flight and, in delta
//! tracking, one for the collision.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1.

use std::ops::Range;

use crate::Setup;
use crate::setup::heroes::Heroes;
use media::body::MOST_CHANNELS;
use media::catalogue::Settings;
use media::{Extinction, Lookups};
use numeric::Lane;
use numeric::rng::Stream;
use theory::problems::SpectralTransmittance;
use theory::spectral::{Spectrum, Tracker};

/// Reads `collisions`: whether real collisions end the walk.
pub fn read_delta(settings: &Settings) -> Option<bool> {
    settings.word_or("collisions", &["ratio", "delta"], "ratio").map(|word| word == "delta")
}

/// An estimator's settings in words.
pub fn label(delta: bool, further: &str) -> String {
    let word = if delta { "delta" } else { "ratio" };
    if further.is_empty() { word.into() } else { format!("{word}, {further}") }
}

/// What a walk has passed.
pub struct Passed {
    /// The tentative collisions.
    pub lookups: u32,
    /// `ρ_λ` of the channels that were asked for; 1 for others.
    pub ratios: [f64; MOST_CHANNELS],
    /// Whether it came to the end.
    pub is_alive: bool,
}

/// Walks with the hero's σ̂ and keeps the ratios of some channels.
#[inline(always)]
pub fn walk(
    setup: &Setup<SpectralTransmittance>,
    medium: &Lookups,
    rng: &mut Stream,
    (hero, delta): (usize, bool),
    channels: Range<usize>,
) -> Passed {
    let sampling = &setup.channels[hero].sampling;
    let mut cursor = sampling.begin();
    let mut passed = Passed { lookups: 0, ratios: [1.0; MOST_CHANNELS], is_alive: true };
    loop {
        let depth = -rng.ln_uniform();
        let number = if delta { rng.uniform() } else { 0.0 };
        if sampling.fly(&mut cursor, depth).is_none() {
            return passed;
        }
        passed.lookups += 1;
        let mut survival = 1.0;
        for channel in channels.clone() {
            let own = &setup.channels[channel];
            let null = 1.0 - medium.channel(channel).extinction(cursor.t) / own.majorant;
            passed.ratios[channel] *= null;
            if channel == hero {
                survival = null;
            }
        }
        if delta && number >= survival {
            passed.is_alive = false;
            return passed;
        }
    }
}

/// `q_λ/q_h`.
#[inline(always)]
pub fn relative_density(
    setup: &Setup<SpectralTransmittance>,
    channel: usize,
    hero: usize,
    collisions: u32,
) -> f64 {
    let (own, hero) = (&setup.channels[channel], &setup.channels[hero]);
    let log = f64::from(collisions) * (own.ln_majorant - hero.ln_majorant);
    Lane::exp(log - (own.collisions - hero.collisions))
}

/// For theory.
pub fn spectrum(
    setup: &Setup<SpectralTransmittance>,
    heroes: &Heroes,
    tracker: Tracker,
) -> Spectrum {
    let meshes: Vec<_> = setup.channels.iter().map(|channel| &*channel.mesh).collect();
    let majorants = setup.channels.iter().map(|channel| channel.majorant).collect();
    Spectrum::new(&meshes, majorants, heroes.of(setup.channels.len()), tracker)
}
