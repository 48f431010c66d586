//! Mistakes of next-event estimation in a ball.
//!
//! ```text
//! X = [light met before the first scattering] + Σ w Ω/4π T̂,   w with the albedo in it, T̂ up to the light
//! ```

use super::target::{SPHERE_LAMP, SPHERE_LAMP_EXACT, SPHERE_SKY, Target};
use super::{About, Mutant};
use crate::estimators::space::{Particle, Scattering};
use crate::estimators::sphere::{Connect, Honest, draw_by};
use crate::estimators::{Draw, Setup};
use crate::media::Lookups;
use crate::numeric::Span;
use crate::problems::Sphere;
use crate::rng::Stream;
use crate::theory::ParticleRule;
use crate::theory::single::Tracking;

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Sphere>> {
    let ratio = Tracking::Ratio { sampling: 2.0, control: 0.0 };
    vec![
        sphere("sphere-shadow-not-clipped", "the shadow ray goes on through the light to the far side", SPHERE_LAMP_EXACT, Tracking::Exact, Through),
        sphere("sphere-light-twice", "light that the walk meets counts beside the shadow rays", SPHERE_SKY, ratio, Twice),
        sphere("sphere-pdf-per-area", "the visible area of the light stands for its solid angle", SPHERE_LAMP, ratio, PerArea),
        sphere("sphere-albedo-missing", "a shadow ray has the weight from before the scattering", SPHERE_LAMP, ratio, WithoutAlbedo),
    ]
}

fn sphere(
    name: &'static str,
    bug: &'static str,
    target: Target,
    shadow: Tracking,
    connect: impl Connect + Copy + Send + 'static,
) -> Mutant<Sphere> {
    let about = About { name, bug, target, check: "mean" };
    Mutant::new(about, walk(connect, shadow), walk(Honest, shadow))
}

/// A weighted walk by its connections.
fn walk(
    connect: impl Connect + Send + 'static,
    shadow: Tracking,
) -> impl Fn(&Setup<Sphere>, &Lookups, &mut Stream) -> Draw<[f64; 1]> + Send + Sync + 'static {
    let particle = Particle::of(ParticleRule::Weighted);
    move |setup, _, rng| draw_by(&particle, Some((&connect, shadow)), setup, rng)
}

#[derive(Clone, Copy)]
struct Through;

impl Connect for Through {
    fn reach(&self, within: Span, _: f64) -> Span {
        within
    }
}

#[derive(Clone, Copy)]
struct Twice;

impl Connect for Twice {
    fn counts(&self, _: u32) -> bool {
        true
    }
}

#[derive(Clone, Copy)]
struct PerArea;

impl Connect for PerArea {
    /// `2πρ²(1 − ρ/r)/4π`, the visible area of the sphere.
    fn share(&self, core: f64, distance: f64) -> f64 {
        0.5 * core * core * (1.0 - core / distance)
    }
}

#[derive(Clone, Copy)]
struct WithoutAlbedo;

impl Connect for WithoutAlbedo {
    fn weight(&self, sphere: &Sphere, at: &Scattering) -> f64 {
        at.weight / sphere.scene.albedo.even().unwrap_or(1.0)
    }
}
