//! The analog walk through a rod, and what its number of scatterings says of all channels.
//!
//! ```text
//! fly forward or backward through σ̂; at a tentative collision the particle goes straight on with probability
//! 1 − r, r = σ_t/σ̂, is scattered with a r, and absorbed otherwise; scattered, it turns round with 1 − p_f
//! ```
//!
//! A flight and what happens at its end take a random number each; a scattering takes a third, the choice of a hero
//! the first of all. Eight at a time: [`super::packet`].

use super::Coloured;
use crate::setup::heroes::Heroes;
use crate::{Draw, Refusal, Setup};
use media::body::MOST_CHANNELS;
use media::{Extinction, Lookups};
use numeric::rng::Stream;
use theory::problems::SpectralRod;
use theory::problems::spectral_rod::{End, Values};

/// What became of a particle.
pub struct Left {
    /// The end at which it left; `None` if it was absorbed.
    pub end: Option<End>,
    /// How often it was scattered.
    pub order: u32,
    /// The tentative collisions.
    pub lookups: u32,
}

/// Walks with a chance to be scattered at a real collision.
#[inline(always)]
pub fn walk(setup: &Setup<SpectralRod>, medium: &Lookups, rng: &mut Stream, scatter: f64) -> Left {
    let mut cursor = setup.sampling.begin();
    let mut is_forward = true;
    let (mut order, mut lookups) = (0, 0);
    loop {
        let (depth, number) = (-rng.ln_uniform(), rng.uniform());
        let flown = if is_forward {
            setup.sampling.fly(&mut cursor, depth)
        } else {
            setup.sampling.fly_back(&mut cursor, depth)
        };
        let Some(sampling) = flown else {
            let end = Some(if is_forward { End::Transmitted } else { End::Reflected });
            return Left { end, order, lookups };
        };
        lookups += 1;
        let ratio = medium.extinction(cursor.t) / sampling;
        if number < 1.0 - ratio {
            continue;
        }
        if number >= 1.0 - ratio + scatter * ratio {
            return Left { end: None, order, lookups };
        }
        order += 1;
        is_forward ^= rng.uniform() >= setup.problem.forward;
    }
}

/// Whose walk it is, and what it is worth in every channel.
pub trait Scores {
    /// The law of the hero; `None` where one walk is that of all channels, number 0.
    fn heroes(&self) -> Option<&Heroes>;

    /// A hero's chance to be scattered at a real collision.
    #[inline(always)]
    fn chance(&self, albedos: &[f64], hero: usize) -> f64 {
        albedos[hero]
    }

    /// What its walk is worth in every channel where it leaves after so many scatterings.
    fn weights(&self, albedos: &[f64], hero: usize, order: u32) -> [f64; MOST_CHANNELS];
}

/// `(a_λ/a_h)^r`: the density of each channel's walk after r scatterings, relative to the hero's.
#[inline(always)]
pub fn relative(albedos: &[f64], hero: usize, order: u32) -> [f64; MOST_CHANNELS] {
    let mut weights = [1.0; MOST_CHANNELS];
    for _ in 0..order {
        for (weight, albedo) in weights.iter_mut().zip(albedos) {
            *weight *= albedo / albedos[hero];
        }
    }
    weights
}

/// Makes one draw.
#[inline(always)]
pub fn draw<P: Coloured>(
    page: &impl Scores,
    setup: &Setup<P>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    let colours = setup.problem.colours();
    let albedos = &colours.albedos;
    let heroes = page.heroes();
    let hero = heroes.map_or(0, |heroes| heroes.choose(albedos.len(), rng.uniform()));
    let left = P::walk(setup, medium, rng, page.chance(albedos, hero));
    let weights = page.weights(albedos, hero, left.order);
    Draw::free(colours.values(left.end, &weights), left.lookups)
}

/// σ̂ ≥ σ_t, few collisions, one hero probability for each channel, and an answer.
///
/// # Errors
///
/// What is violated.
pub fn require<P: Coloured>(setup: &Setup<P>, heroes: &Heroes) -> Result<(), Refusal> {
    heroes.require(setup.problem.colours().albedos.len())?;
    setup.require_ratio_at_most(1.0, "σ̂ ≥ σ_t everywhere")?;
    setup.require_few_collisions("∫σ̂ ≤ 1e6")?;
    P::require_answer(setup)
}

/// A variance of each channel.
///
/// # Errors
///
/// The channel, and what its body would have to be.
pub fn require_variance(diverges: Option<(usize, String)>) -> Result<(), Refusal> {
    diverges.map_or(Ok(()), |(channel, why)| {
        let found = format!("E[X²] of channel {} is infinite {why}", channel + 1);
        Err(Refusal::mismatch("a finite variance", found))
    })
}
