//! The radiance along a ray through a medium that scatters the light of a sky, any number of times.
//!
//! ```text
//! L(o, d) = T L_sky(d) + ∫ T(s) σ_t a ∫ p(cos θ) L(p(s), d') dω' ds
//! L = E[Σ w L_sky(d')]  over all particles that leave in a direction d'
//! ```
//!
//! There is no closed form but in a furnace (a = 1 under a constant sky of radiance 1: L = 1), so that it
//! is a problem of pictures, whose references are drawn, and not of cases.
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! Eq. 1, section 4.1.

use super::{Problem, Scene, Sky};
use media::catalogue::Settings;
use media::{Body, Medium, Volume};
use numeric::geometry::{Point, Ray};

/// Multiple scattering of a sky along a ray.
pub struct MultipleScattering {
    /// The medium in space.
    pub scene: Scene,
    /// The light from around it.
    pub sky: Sky,
    ray: Ray,
    medium: Medium,
}

impl MultipleScattering {
    /// Along a ray.
    pub fn new(scene: Scene, sky: Sky, ray: Ray) -> Self {
        let support = scene.volume.bounds().clip(&ray);
        let profile = scene.volume.along(&ray, support);
        let medium = Medium::new(profile, ray.span(), support);
        Self { scene, sky, ray, medium }
    }

    /// Where the ray enters the bounds, and its direction; `None` where it misses them.
    pub fn entry(&self) -> Option<[Point; 2]> {
        let inside = self.medium.support();
        (!inside.is_empty()).then(|| [self.ray.at(inside.from), self.ray.direction])
    }

    /// The radiance of the sky behind the volume.
    pub fn background(&self) -> f64 {
        self.sky.radiance(self.ray.direction)
    }
}

impl Problem for MultipleScattering {
    type Value = [f64; 1];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let (scene, sky) = (Scene::bounded(body, settings), Sky::read(settings));
        let Body::Volume { ray, .. } = body? else { return None };
        Some(Self::new(scene?, sky?, *ray))
    }

    fn medium(&self) -> &Medium {
        &self.medium
    }

    fn volume(&self) -> Option<&Volume> {
        Some(&*self.scene.volume)
    }
}
