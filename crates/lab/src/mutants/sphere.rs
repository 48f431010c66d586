//! Mistakes of next-event estimation in a ball.
//!
//! ```text
//! X = [light met before the first scattering] + Σ w Ω/4π T̂,   w with the albedo in it, T̂ up to the light
//! ```

use super::target::{SPHERE_LAMP, SPHERE_LAMP_EXACT, SPHERE_SKY};
use super::{About, Mutant, with};
use estimators::space::{Particle, Scattering};
use estimators::sphere::{Connect, Honest, draw_by};
use numeric::Span;
use theory::ParticleRule;
use theory::problems::Sphere;
use theory::single::Tracking;

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Sphere>> {
    let ratio = Tracking::Ratio { sampling: 2.0, control: 0.0 };
    let by = |bug, shadow| with((bug, shadow), |(bug, shadow), setup, _, rng| {
        draw_by(&Particle::of(ParticleRule::Weighted), Some((bug, *shadow)), setup, rng)
    });
    let of = |name, text, target, shadow, bug: Bug| {
        Mutant::new(About { name, bug: text, target, check: "mean" }, by(bug, shadow), by(Bug::None, shadow))
    };
    vec![
        of("sphere-shadow-not-clipped", "the shadow ray goes on through the light to the far side", SPHERE_LAMP_EXACT, Tracking::Exact, Bug::Through),
        of("sphere-light-twice", "light that the walk meets counts beside the shadow rays", SPHERE_SKY, ratio, Bug::Twice),
        of("sphere-pdf-per-area", "the visible area of the light stands for its solid angle", SPHERE_LAMP, ratio, Bug::PerArea),
        of("sphere-albedo-missing", "a shadow ray has the weight from before the scattering", SPHERE_LAMP, ratio, Bug::WithoutAlbedo),
    ]
}

/// What goes wrong in the connections of a weighted walk.
#[derive(Clone, Copy, PartialEq)]
enum Bug {
    None,
    Through,
    Twice,
    PerArea,
    WithoutAlbedo,
}

impl Connect for Bug {
    fn weight(&self, sphere: &Sphere, at: &Scattering) -> f64 {
        let albedo = sphere.scene.albedo.even().unwrap_or(1.0);
        if *self == Self::WithoutAlbedo { at.weight / albedo } else { at.weight }
    }

    fn share(&self, core: f64, distance: f64) -> f64 {
        if *self == Self::PerArea {
            // 2πρ²(1 − ρ/r)/4π, the visible area of the sphere.
            0.5 * core * core * (1.0 - core / distance)
        } else {
            Honest.share(core, distance)
        }
    }

    fn reach(&self, within: Span, light: f64) -> Span {
        if *self == Self::Through { within } else { Honest.reach(within, light) }
    }

    fn counts(&self, order: u32) -> bool {
        *self == Self::Twice || Honest.counts(order)
    }
}
