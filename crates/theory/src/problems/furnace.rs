//! The radiance along a ray into a furnace: whatever is inside, it is 1.
//!
//! ```text
//! light of radiance 1 comes from all sides; where the medium absorbs it also emits, as hot as its walls
//! L = Σ w r (1 − a) over the collisions of a walk + w where it leaves,   E[L] = 1
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `volume` with `ray = { origin, direction }` | σ_t in space, with bounds, and the ray; what counts of the ray is where it enters the bounds, a `length` does not | required |
//! | `albedo` | a in [0, 1]: a number, or a field in space such as `sines = { … }` | required unless swept |
//! | `phase.NAME = { … }` | a phase function: `trueflight list phases` | required |
//! | `sampling` | σ̂ in space of every estimator without its own: `constant`, or `local-majorants` with a `grid` | required unless swept |
//! | `sweep` | one of `sampling`, `sampling-scale`, `albedo`, `density`, `albedo-scale` | none |
//! | `estimators` | what is tested | required |
//!
//! With a = 1 it is the white furnace; with any other a, constant or not, Kirchhoff's law makes it one: what
//! leaves and what is absorbed are together all the light that there was. It holds for every medium, phase
//! function, σ̂ and rule, so that every medium has a test of its walks, and a renderer's bug in weights
//! cannot hide in a medium whose picture nobody knows. How much leaves and how much is absorbed is not
//! known; their sum is.
//!
//! Directions do not matter for L, see `trueflight explain lambertian` for those.
//!
//! Source: G. Kirchhoff, *Ueber das Verhältniss zwischen dem Emissionsvermögen und dem Absorptionsvermögen
//! der Körper für Wärme und Licht*, Annalen der Physik 185 (1860).

use super::{Problem, Scene};
use media::body::RayNeed;
use media::catalogue::Settings;
use media::{Body, Medium, misses};
use numeric::geometry::{Point, Ray};

/// The radiance along a ray into a furnace.
#[derive(Clone)]
pub struct Furnace {
    /// The medium in space.
    pub scene: Scene,
    /// Where the ray enters the bounds, or begins within them.
    pub entry: Point,
    /// The direction of the ray.
    pub direction: Point,
    medium: Medium,
}

impl Problem for Furnace {
    type Value = [f64; 1];
    const RAY: RayNeed = RayNeed::Line;

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let scene = Scene::bounded(body, settings)?;
        let Body::Volume { ray, .. } = body? else { return None };
        let onward = Ray { length: f64::INFINITY, ..*ray };
        let inside = scene.volume.bounds().clip(&onward);
        if inside.is_empty() {
            let help = "turn it, or move its origin: what misses the volume tests nothing";
            let found = format!(
                "the ray misses the volume, whose {}",
                misses::place(scene.volume.bounds())
            );
            settings.fault("ray", found, help);
            return None;
        }
        let entry = ray.at(inside.from);
        Some(Self { scene, entry, direction: ray.direction, medium: body?.medium() })
    }

    super::in_space!();
}
