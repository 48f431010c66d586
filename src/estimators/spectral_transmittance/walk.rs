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

use crate::catalogue::{Domain, Settings, Value, rounded};
use crate::estimators::{Refusal, Setup};
use crate::media::body::MOST_CHANNELS;
use crate::media::{Extinction, Lookups};
use crate::numeric::Lane;
use crate::problems::SpectralTransmittance;
use crate::rng::Stream;
use crate::theory::spectral::{Spectrum, Tracker};

/// How far the sum of probabilities may be from 1.
const SUM: f64 = 1e-9;

/// The law of the hero channel.
#[derive(Debug, Clone, PartialEq)]
pub enum Heroes {
    /// Every channel with the same probability.
    Uniform,
    /// By the weights of the luminance.
    Luminance,
    /// As given.
    Given(Vec<f64>),
}

impl Heroes {
    /// Reads `hero`: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1.
    pub fn read(settings: &Settings) -> Option<Self> {
        let entry = settings.entry("hero");
        if !entry.is_some_and(|entry| matches!(entry.node.value, Value::Array(_))) {
            let word = settings.word_or("hero", &["uniform", "luminance"], "uniform")?;
            return Some(if word == "uniform" { Self::Uniform } else { Self::Luminance });
        }
        let given = settings.numbers("hero", Domain::Positive, 1)?;
        let sum: f64 = given.iter().sum();
        if (sum - 1.0).abs() > SUM {
            let message = format!("the probabilities sum to {}", rounded(sum));
            settings.fault("hero", message, "give each channel its share of 1");
            return None;
        }
        Some(Self::Given(given))
    }

    /// In words, as in `hero .2, .8`; empty where every channel has the same probability.
    pub fn label(&self) -> String {
        match self {
            Self::Uniform => String::new(),
            Self::Luminance => "hero by luminance".into(),
            Self::Given(given) => {
                let given: Vec<String> = given.iter().map(f64::to_string).collect();
                format!("hero {}", given.join(" "))
            }
        }
    }

    /// The probability of a channel.
    #[inline(always)]
    pub fn probability(&self, setup: &Setup<SpectralTransmittance>, channel: usize) -> f64 {
        match self {
            Self::Luminance if setup.channels.len() > 1 => setup.problem.luminance[channel],
            Self::Given(given) => given[channel],
            _ => 1.0 / setup.channels.len() as f64,
        }
    }

    /// All of them.
    pub fn probabilities(&self, setup: &Setup<SpectralTransmittance>) -> Vec<f64> {
        (0..setup.channels.len()).map(|channel| self.probability(setup, channel)).collect()
    }

    /// The hero that a uniform number chooses.
    #[inline(always)]
    pub fn choose(&self, setup: &Setup<SpectralTransmittance>, number: f64) -> usize {
        let (mut hero, mut sum) = (0, self.probability(setup, 0));
        while number >= sum && hero + 1 < setup.channels.len() {
            hero += 1;
            sum += self.probability(setup, hero);
        }
        hero
    }

    /// One probability for each channel.
    ///
    /// # Errors
    ///
    /// How many there are.
    pub fn require(&self, setup: &Setup<SpectralTransmittance>) -> Result<(), Refusal> {
        match self {
            Self::Given(given) if given.len() != setup.channels.len() => {
                let needs = "one hero probability for each channel";
                let channels = setup.channels.len();
                let found = format!("there are {} for {channels} channels", given.len());
                Err(Refusal::mismatch(needs, found))
            }
            _ => Ok(()),
        }
    }
}

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
    Spectrum::new(&meshes, majorants, heroes.probabilities(setup), tracker)
}

/// A constant σ̂ > 0 in each channel, and so few collisions that walks end.
///
/// # Errors
///
/// What σ̂ is instead, and of which channel.
pub fn require_constants(setup: &Setup<SpectralTransmittance>) -> Result<(), Refusal> {
    for (number, channel) in (1..).zip(&setup.channels) {
        if channel.majorant <= 0.0 {
            let found = format!("that of channel {number} varies along the ray");
            return Err(Refusal::mismatch("a constant σ̂ > 0 in each channel", found));
        }
        if channel.collisions.is_nan() || channel.collisions > 1e6 {
            let found = format!("∫σ̂ = {:e} in channel {number}", channel.collisions);
            return Err(Refusal::mismatch("∫σ̂ ≤ 1e6 in each channel", found));
        }
    }
    Ok(())
}

/// The same σ̂ in all channels.
///
/// # Errors
///
/// Two that differ.
pub fn require_common(setup: &Setup<SpectralTransmittance>) -> Result<(), Refusal> {
    let first = setup.channels[0].majorant;
    let other = setup.channels.iter().find(|channel| channel.majorant != first);
    other.map_or(Ok(()), |other| {
        let found = format!("σ̂ = {} and {}", rounded(first), rounded(other.majorant));
        Err(Refusal::mismatch("one σ̂ for all channels", found))
    })
}

/// `σ̂ ≥ σ_t` in each channel.
///
/// # Errors
///
/// The channel, and where it is violated most.
pub fn require_majorants(setup: &Setup<SpectralTransmittance>) -> Result<(), Refusal> {
    for (number, channel) in (1..).zip(&setup.channels) {
        let worst = channel.mesh.largest(|_, sigma| sigma);
        if let Some((at, sigma)) = worst.filter(|&(_, s)| s > channel.majorant * (1.0 + 1e-12)) {
            let [majorant, sigma] = [channel.majorant, sigma].map(rounded);
            return Err(Refusal::Inequality {
                needs: "σ̂ ≥ σ_t in each channel",
                found: format!("σ̂ = {majorant} and σ_t = {sigma} in channel {number}"),
                at,
            });
        }
    }
    Ok(())
}
