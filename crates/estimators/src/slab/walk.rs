//! The walk of a particle through a slab, `SimulateParticle` in three dimensions.
//!
//! ```text
//! a flight of optical depth u along a direction of cosine μ goes u|μ| deep through σ̂(z), down for μ > 0;
//! at a tentative collision r = σ_t/σ̂ and the rule says whether the particle goes straight on, is
//! scattered or is absorbed, and what becomes of its weight;
//! scattered by an angle θ at an azimuth φ, μ' = μ cos θ + √(1 − μ²) sin θ cos φ
//! ```
//!
//! A flight and what happens at its end take a random number each; a scattering takes one for θ and one
//! for φ, of which an isotropic one needs the first only. Diffuse light takes one for `μ₀ = √u`. Eight at a
//! time: [`super::packet`].

use crate::{Draw, Setup};
use media::phase::Phase;
use media::phase::isotropic::Isotropic;
use media::{Extinction, Lookups};
use numeric::Lane;
use numeric::rng::Stream;
use theory::particle::{Event, Odds, ParticleRule};
use theory::problems::slab::{Incidence, Light};
use theory::problems::{Problem, Slab};

/// The steps of a walk that a known bug may replace.
pub trait Steps {
    /// The odds at a collision with the given ratio `σ_t/σ̂` and albedo.
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds;

    /// The depth of a flight, in optical depth, of the given length along a direction.
    #[inline(always)]
    fn descent(&self, length: f64, cosine: f64) -> f64 {
        length * cosine.abs()
    }

    /// The cosine of the scattering angle.
    #[inline(always)]
    fn deflection(&self, phase: &Phase, rng: &mut Stream) -> f64 {
        phase.cosine(rng.uniform())
    }

    /// The cosine of diffuse light, in `(0, 1]`.
    #[inline(always)]
    fn diffuse(&self, rng: &mut Stream) -> f64 {
        (1.0 - rng.uniform()).sqrt()
    }
}

impl Steps for ParticleRule {
    #[inline(always)]
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        self.odds(ratio, albedo)
    }
}

/// The cosine with the normal after a deflection about the direction of travel.
#[inline(always)]
pub fn turned<L: Lane>(cosine: L, deflection: L, azimuth: L) -> L {
    let (zero, one) = (cosine.each(0.0), cosine.each(1.0));
    let across = (one - cosine * cosine) * (one - deflection * deflection);
    // Rounding may carry a sum past 1, and a product below 0.
    let turned = cosine * deflection + across.or_more(zero).root() * azimuth;
    turned.or_less(one).or_more(-one)
}

/// What became of a particle.
pub struct Left {
    /// Whether it left at the bottom, or at the top; `None` if it was absorbed.
    pub below: Option<bool>,
    /// Its weight.
    pub weight: f64,
    /// How often it was scattered.
    pub order: u32,
    /// The tentative collisions.
    pub lookups: u32,
}

/// Walks through a slab of an albedo.
#[inline(always)]
pub fn walk<P: Problem>(
    steps: &impl Steps,
    (incidence, albedo): (&Incidence, f64),
    setup: &Setup<P>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Left {
    let mut cosine = match incidence.light {
        Light::Collimated(cosine) => cosine,
        Light::Diffuse => steps.diffuse(rng),
    };
    let mut cursor = setup.sampling.begin();
    let mut weight = 1.0;
    let (mut order, mut lookups) = (0, 0);
    loop {
        let (length, number) = (-rng.ln_uniform(), rng.uniform());
        let depth = steps.descent(length, cosine);
        let is_down = cosine > 0.0;
        let flown = if is_down {
            setup.sampling.fly(&mut cursor, depth)
        } else {
            setup.sampling.fly_back(&mut cursor, depth)
        };
        let Some(sampling) = flown else {
            return Left { below: Some(is_down), weight, order, lookups };
        };
        lookups += 1;
        let odds = steps.odds_at(medium.extinction(cursor.t) * (1.0 / sampling), albedo);
        match odds.decide(number) {
            Event::Transmitted => weight *= odds.transmit_weight,
            Event::Scattered => {
                weight *= odds.scatter_weight;
                order += 1;
                let deflection = steps.deflection(&incidence.phase, rng);
                cosine = if incidence.phase == Phase::Isotropic(Isotropic) {
                    deflection
                } else {
                    let azimuth = Lane::cos(std::f64::consts::TAU * rng.uniform());
                    turned(cosine, deflection, azimuth)
                };
            }
            Event::Absorbed => return Left { below: None, weight, order, lookups },
        }
    }
}

/// Makes one draw: reflectance and transmittance.
#[inline(always)]
pub fn draw(
    steps: &impl Steps,
    setup: &Setup<Slab>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<[f64; 2]> {
    let slab = &*setup.problem;
    let left = walk(steps, (&slab.incidence, slab.albedo), setup, medium, rng);
    let value = match left.below {
        Some(true) => [0.0, left.weight],
        Some(false) => [left.weight, 0.0],
        None => [0.0; 2],
    };
    Draw::free(value, left.lookups)
}
