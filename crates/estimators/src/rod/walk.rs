//! The walk of a particle through a rod, `SimulateParticle` in one dimension.
//!
//! ```text
//! fly forward or backward through σ̂; at a tentative collision r = σ_t/σ̂ and the rule says whether
//! the particle goes straight on, is scattered or is absorbed, and what becomes of its weight w;
//! scattered, it turns round with probability 1 − p_f
//! ```
//!
//! A flight and what happens at its end take a random number each; a scattering takes a third, and so does
//! roulette where it is played. Eight at a time: [`super::packet`].

use crate::{Draw, Setup};
use media::{Extinction, Lookups};
use numeric::rng::Stream;
use theory::ParticleRule;
use theory::particle::{Event, Odds};
use theory::problems::Rod;
use theory::problems::rod::{MOST, MOST_PARTS, Quantity, Values};

/// The steps of a walk that a known bug may replace.
pub trait Steps {
    /// The odds at a collision with the given ratio `σ_t/σ̂` and albedo.
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds;

    /// The weight of a particle that goes on after a collision; `None` if it does not.
    #[inline(always)]
    fn keep(&self, rng: &mut Stream, weight: f64) -> Option<f64> {
        let _ = rng;
        Some(weight)
    }

    /// The number that decides the new direction: uniform, and independent of the one that decided
    /// the collision.
    #[inline(always)]
    fn direction(&self, rng: &mut Stream, decided: f64) -> f64 {
        let _ = decided;
        rng.uniform()
    }

    /// Whether a scattered particle turns round.
    #[inline(always)]
    fn turns(&self, number: f64, forward: f64) -> bool {
        number >= forward
    }
}

impl Steps for ParticleRule {
    #[inline(always)]
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        self.odds(ratio, albedo)
    }
}

/// What became of a particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fate {
    /// The end at which it left; `None` if it was absorbed.
    pub left: Option<Quantity>,
    /// Its weight.
    pub weight: f64,
    /// How often it was scattered.
    pub order: usize,
    /// `Σ w r (1 − a)`.
    pub absorbed: f64,
    /// `Σ w/(σ̂ width)` in each part of the rod.
    pub flux: [f64; MOST_PARTS],
}

impl Fate {
    /// What each channel of the rod sees of it.
    #[inline(always)]
    pub fn values(&self, channels: &[Quantity]) -> Values {
        let mut values = Values { at: [0.0; MOST], count: channels.len() };
        for (number, seen) in channels.iter().enumerate() {
            let by_order = match self.left {
                Some(Quantity::Reflected) => Some(Quantity::ReflectedBy(self.order)),
                Some(_) => Some(Quantity::TransmittedBy(self.order)),
                None => None,
            };
            values.at[number] = if *seen == Quantity::Absorbed {
                self.absorbed
            } else if let Quantity::Flux(part) = *seen {
                self.flux[part]
            } else if self.left == Some(*seen) || by_order == Some(*seen) {
                self.weight
            } else {
                0.0
            };
        }
        values
    }
}

/// Makes one draw.
#[inline(always)]
pub fn draw(
    steps: &impl Steps,
    setup: &Setup<Rod>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    let rod = &*setup.problem;
    let (sees_flux, parts_per_length) = (rod.parts > 0, 1.0 / rod.width());
    let mut cursor = setup.sampling.begin();
    let mut is_forward = true;
    let mut fate =
        Fate { left: None, weight: 1.0, order: 0, absorbed: 0.0, flux: [0.0; MOST_PARTS] };
    let mut lookups = 0;
    loop {
        let (depth, number) = (-rng.ln_uniform(), rng.uniform());
        let flown = if is_forward {
            setup.sampling.fly(&mut cursor, depth)
        } else {
            setup.sampling.fly_back(&mut cursor, depth)
        };
        let Some(sampling) = flown else {
            fate.left = Some(if is_forward { Quantity::Transmitted } else { Quantity::Reflected });
            break;
        };
        lookups += 1;
        let path = 1.0 / sampling;
        let ratio = medium.extinction(cursor.t) * path;
        let albedo = rod.albedo.value(cursor.t);
        fate.absorbed += fate.weight * ratio * (1.0 - albedo);
        if sees_flux {
            fate.flux[rod.part(cursor.t)] += fate.weight * (path * parts_per_length);
        }
        let odds = steps.odds_at(ratio, albedo);
        match odds.decide(number) {
            Event::Transmitted => fate.weight *= odds.transmit_weight,
            Event::Scattered => {
                fate.weight *= odds.scatter_weight;
                fate.order += 1;
                let direction = steps.direction(rng, number);
                is_forward ^= steps.turns(direction, rod.forward.value(cursor.t));
            }
            Event::Absorbed => break,
        }
        match steps.keep(rng, fate.weight) {
            Some(weight) => fate.weight = weight,
            None => break,
        }
    }
    Draw::free(fate.values(&rod.channels), lookups)
}
