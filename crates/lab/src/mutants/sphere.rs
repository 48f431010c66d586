//! Mistakes of next-event estimation in a ball.
//!
//! ```text
//! X = [light met before the first scattering] + Σ w Ω/4π T̂,   w with the albedo in it, T̂ up to the light
//! ```

use super::target::{SPHERE_LAMP, SPHERE_LAMP_EXACT, SPHERE_SKY};
use super::{About, Mutant, with};
use estimators::space::Particle;
use estimators::space::shadow::Light;
use estimators::sphere::Page;
use estimators::sphere::sharing::{Sharing, Steps};
use numeric::{Lane, Mask};
use theory::ParticleRule;
use theory::problems::{Sphere, ball};
use theory::single::Tracking;
use theory::sphere::Techniques;

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Sphere>> {
    let ratio = Tracking::Ratio { sampling: 2.0, control: 0.0 };
    let by = |bug, shadow| {
        let sharing = Sharing { techniques: Techniques::NextEvent, shadow: Some(shadow), subpaths: None };
        let page = Page { particle: Particle::of(ParticleRule::Weighted), sharing };
        with((bug, page), |(bug, page), setup, _, rng| page.draw_for(*bug, setup, rng))
    };
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

impl Steps for Bug {
    #[inline(always)]
    fn light<L: Lane>(&self, sphere: &Sphere, place: [L; 3], right: Light<L>) -> Light<L> {
        let one = right.share.each(1.0);
        match (self, sphere.light) {
            (Self::Through, _) => Light { distance: one.each(f64::INFINITY), ..right },
            (Self::PerArea, ball::Light::BlackSphere(core)) => {
                // 2πρ²(1 − ρ/r)/4π, the visible area of the sphere.
                let distance = sphere.centre.square_to(place, 1.0).root();
                let share = (one - one.each(core) / distance) * (0.5 * core * core);
                Light { share, ..right }
            }
            (Self::WithoutAlbedo, _) => {
                let albedo = sphere.scene.albedo.even().unwrap_or(1.0);
                Light { share: right.share / one.each(albedo), ..right }
            }
            _ => right,
        }
    }

    #[inline(always)]
    fn counts<M: Mask>(&self, right: M) -> M {
        if *self == Self::Twice { right | !right } else { right }
    }
}
