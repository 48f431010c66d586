//! What a plane-parallel slab sends back and lets through: light that scatters in all directions of
//! space, in a medium that varies with the depth only.
//!
//! ```text
//! a particle enters at the top; it flies through σ_t(z), a length s for a depth of s|μ|; where it
//! collides it is scattered with probability a, by the phase function
//! reflectance R: it leaves at the top;  transmittance T: it leaves at the bottom
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `medium` with `span = [from, to]` | σ_t as a function of the depth z, and the slab | one of the two |
//! | `volume` with `ray = { origin, direction, length }` | `σ_t(z)` as a ray through a 3-D field sees it | is required |
//! | `albedo` | a in [0, 1], the same everywhere | required unless swept |
//! | `phase.NAME = { … }` | a phase function: `trueflight list phases` | required |
//! | `incidence.collimated = { cosine = μ₀ }` | light from one direction, 0 < μ₀ ≤ 1; 1 is straight down | one of the two |
//! | `incidence.diffuse = {}` | light evenly from all sides, the Lambertian law 2μ₀ dμ₀ | is required |
//! | `sampling` | σ̂ of every estimator without its own, as a function of the depth | required unless swept |
//! | `sweep` | one of `sampling`, `sampling-scale`, `albedo`, `density`, `albedo-scale` | none |
//! | `estimators` | what is tested | required |
//!
//! The answer depends on the optical depth of the slab, a, the phase function and the incidence only,
//! and is worked out by adding and doubling with a stated error: better than 1e-10 for isotropic and
//! Rayleigh scattering, than 1e-8 for Henyey–Greenstein's up to g = 0.9.
//!
//! Source: S. Chandrasekhar, *Radiative Transfer* (Oxford University Press, 1950), chapter 1; H. C. van
//! de Hulst, *Multiple Light Scattering* (Academic Press, 1980).

use super::{Problem, default_albedo, number};
use media::catalogue::{Domain, Settings};
use media::phase::Phase;
use media::{Body, Medium};

/// Where light comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Light {
    /// From one direction, by its cosine `μ₀` with the normal of the slab, in `(0, 1]`.
    Collimated(f64),
    /// Evenly from all sides, the Lambertian law `2μ₀ dμ₀`.
    Diffuse,
}

impl Light {
    /// `μ₀`, where all of it has the same.
    pub fn cosine(self) -> Option<f64> {
        match self {
            Self::Collimated(cosine) => Some(cosine),
            Self::Diffuse => None,
        }
    }
}

/// Light and how it is scattered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Incidence {
    /// Where light comes from.
    pub light: Light,
    /// How it is scattered.
    pub phase: Phase,
}

/// A slab.
pub struct Slab {
    medium: Medium,
    /// a.
    pub albedo: f64,
    /// Light and phase function.
    pub incidence: Incidence,
}

impl Slab {
    /// A slab whose depth is the distance along a medium, with an albedo in `[0, 1]`.
    pub fn new(medium: Medium, albedo: f64, incidence: Incidence) -> Self {
        Self { medium, albedo, incidence }
    }
}

impl Problem for Slab {
    /// What leaves at the top, and at the bottom.
    type Value = [f64; 2];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let albedo = number(settings, "albedo", default_albedo(settings));
        let phase = Phase::read(settings);
        let light = read_light(settings);
        let incidence = Incidence { light: light?, phase: phase? };
        Some(Self::new(body?.medium(), albedo?, incidence))
    }

    fn medium(&self) -> &Medium {
        &self.medium
    }

    fn with_albedo(&self, albedo: f64) -> Option<Self> {
        Some(Self::new(self.medium.clone(), albedo, self.incidence))
    }
}

/// Reads `incidence`.
pub(super) fn read_light(settings: &Settings) -> Option<Light> {
    let (index, light) = settings.chosen("incidence", &["collimated".into(), "diffuse".into()])?;
    let read = if index == 0 {
        light.number("cosine", Domain::Positive).and_then(|cosine| {
            if cosine > 1.0 {
                let help = "it is the cosine of the angle with the normal of the slab, at most 1";
                light.fault("cosine", format!("`cosine` is {cosine}"), help);
                return None;
            }
            Some(Light::Collimated(cosine))
        })
    } else {
        Some(Light::Diffuse)
    };
    light.close();
    read
}

#[cfg(test)]
mod tests {
    use super::*;
    use media::catalogue::Value;
    use media::catalogue::fixture::{read, table};

    #[test]
    fn light_comes_from_one_direction_or_from_all_sides() {
        let light = |name, settings| read([("incidence", table([(name, settings)]))], read_light);
        let collimated =
            |cosine: f64| light("collimated", table([("cosine", Value::Number(cosine))]));
        assert_eq!(collimated(0.25), (Some(Light::Collimated(0.25)), vec![]));
        assert_eq!(light("diffuse", table([])).0, Some(Light::Diffuse));
        for cosine in [1.5, 0.0, -0.3] {
            assert_eq!(collimated(cosine), (None, vec![format!("`cosine` is {cosine}")]));
        }
    }
}
