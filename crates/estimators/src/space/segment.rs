//! Segments of null-scattering paths through σ̂ in space.
//!
//! ```text
//! by ratio tracking, to a given end:       T̂ = ∏ (1 − σ_t/σ̂) over the tentative collisions, all of them null
//! by delta tracking, to a real collision:  each collision is real with chance σ_t/σ̂, else null
//! ```
//!
//! The null collisions of a path have the same places by either; what their densities differ by are the chances to be
//! null, which only what decides has to win. A flight takes a random number, a decision another one.

use media::Majorants;
use numeric::geometry::{Point, Ray};
use numeric::pack::in_fused_code;
use numeric::rng::Stream;
use theory::ParticleRule;
use theory::problems::Scene;

/// A segment with a given end.
#[derive(Debug, Clone, Copy)]
pub struct Tracked {
    /// `T̂`.
    pub transmittance: f64,
    /// The chance that a particle, which walks by a rule, takes all its collisions for null.
    pub chance: f64,
    /// Its lookups.
    pub lookups: u32,
}

/// A segment that ends with a real collision, or leaves.
#[derive(Debug, Clone, Copy)]
pub struct Flown {
    /// Where the real collision is.
    pub collision: Option<Point>,
    /// The chance of its null collisions, `∏ (1 − σ_t/σ̂)`.
    pub chance: f64,
    /// Its lookups.
    pub lookups: u32,
}

/// A medium and σ̂ in it.
#[derive(Clone, Copy)]
pub struct Tracker<'a> {
    /// The medium.
    pub scene: &'a Scene,
    /// σ̂.
    pub majorants: &'a Majorants,
}

impl Tracker<'_> {
    /// Ratio tracking from the origin of a ray, in the bounds, over a distance; chances are those of a rule.
    #[inline(never)]
    pub fn ratio(self, ray: &Ray, distance: f64, rule: ParticleRule, rng: &mut Stream) -> Tracked {
        let field = self.scene.volume.points();
        in_fused_code(
            #[inline(always)]
            || {
                let mut found = Tracked { transmittance: 1.0, chance: 1.0, lookups: 0 };
                let mut flight = self.majorants.enter(ray.origin, ray.direction);
                loop {
                    let flown = self.majorants.fly(&mut flight, -rng.ln_uniform());
                    let Some(sampling) = flown.filter(|_| flight.t < distance) else {
                        return found;
                    };
                    found.lookups += 1;
                    let place = flight.place();
                    let ratio = field.extinction(place) / sampling;
                    found.transmittance *= 1.0 - ratio;
                    found.chance *= rule.odds(ratio, self.scene.albedo.at(place)).transmit;
                }
            },
        )
    }

    /// Delta tracking from the origin of a ray, in the bounds or on their boundary.
    #[inline(never)]
    pub fn delta(self, ray: &Ray, rng: &mut Stream) -> Flown {
        let field = self.scene.volume.points();
        in_fused_code(
            #[inline(always)]
            || {
                let mut found = Flown { collision: None, chance: 1.0, lookups: 0 };
                let mut flight = self.majorants.enter(ray.origin, ray.direction);
                while let Some(sampling) = self.majorants.fly(&mut flight, -rng.ln_uniform()) {
                    found.lookups += 1;
                    let place = flight.place();
                    let ratio = field.extinction(place) / sampling;
                    if rng.uniform() < ratio {
                        return Flown { collision: Some(place), ..found };
                    }
                    found.chance *= 1.0 - ratio;
                }
                found
            },
        )
    }
}
