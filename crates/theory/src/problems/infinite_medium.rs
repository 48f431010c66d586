//! A point source in a homogeneous medium without end.
//!
//! ```text
//! collisions = Σ w r,                     mean 1/(1 − a)
//! squared distance = Σ w r (1 − a) x²,    mean 2/(σ_t² (1 − a)(1 − a g)),  x that from the source
//! collisions within R = Σ w r [x < R],    mean by the inversion of a Fourier integral, isotropic phase
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `volume.constant = { extinction }` | σ_t > 0, without `bounds`; a `ray` may be given, and is not walked | required |
//! | `albedo` | a in [0, 1) | required unless swept |
//! | `phase.NAME = { … }` | a phase function: `trueflight list phases` | required |
//! | `radii` | up to 8 distances R > 0 from the source, for isotropic scattering | none |
//! | `sampling` | σ̂ of every estimator without its own: `constant` | required unless swept |
//! | `sweep` | one of `sampling`, `sampling-scale`, `albedo`, `density`, `albedo-scale` | none |
//! | `estimators` | what is tested | required |
//!
//! Here a walk consists of flights, directions and its end only. The squared distance depends on the phase
//! function's mean cosine g: wrong frames of direction show there more clearly than anywhere else. A walk
//! that never ends is refused; it needs a rule that terminates, or roulette.
//!
//! Source: K. M. Case, P. F. Zweifel, *Linear Transport Theory* (Addison–Wesley, 1967), section 2.5.
//!
//! ```toml
//! title = "An example of infinite-medium"
//!
//! [problem.infinite-medium]
//! volume = 1
//! ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 1 }
//! albedo = 0.7
//! phase.henyey-greenstein.g = 0.6
//! sampling = 1.2
//! estimators = [{ particle.rule = "analog" }, { particle.rule = "terminating" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::{Albedo, Problem, Scene};
use media::body::RayNeed;
use media::catalogue::{Domain, Settings};
use media::phase::Phase;
use media::{Body, Medium};
use numeric::geometry::{Bounds, Point};

pub use super::rod::Values;

/// The most radii.
pub const MAX_RADII: usize = 8;

/// A point source in a homogeneous medium without end.
#[derive(Clone)]
pub struct InfiniteMedium {
    /// The medium in space.
    pub scene: Scene,
    medium: Medium,
    /// σ_t.
    pub extinction: f64,
    /// The distances within which collisions are counted.
    pub radii: Vec<f64>,
}

impl InfiniteMedium {
    /// a.
    pub fn albedo(&self) -> f64 {
        self.scene.albedo.even().unwrap_or(0.0)
    }
}

impl Problem for InfiniteMedium {
    /// Collisions within each radius, squared distance, collisions.
    type Value = Values;
    const RAY: RayNeed = RayNeed::Nothing;

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let scene = Scene::read(body, settings);
        let radii = settings.optional("radii", |key| settings.numbers(key, Domain::Positive, 1));
        let (scene, radii) = (scene?, radii.ok()?.unwrap_or_default());
        let is_homogeneous = scene.volume.facts().single_value.is_some()
            && scene.volume.bounds() == Bounds::Everywhere;
        let extinction = scene.volume.extinction_at(Point([0.0; 3]));
        if !is_homogeneous || extinction <= 0.0 {
            let help = "it takes `volume.constant = { extinction }` above 0, without bounds";
            settings.fault("volume", "the medium is homogeneous and has no end", help);
            return None;
        }
        if matches!(scene.albedo, Albedo::Field(..)) {
            settings.fault("albedo", "the medium is homogeneous", "give one number below 1");
            return None;
        }
        if radii.len() > MAX_RADII {
            let actual = format!("{} radii", radii.len());
            settings.fault("radii", actual, format!("give at most {MAX_RADII}"));
            return None;
        }
        if !radii.is_empty() && !matches!(scene.phase, Phase::Isotropic(_)) {
            let help = "leave `radii` out, or take `phase.isotropic = {}`";
            settings.fault(
                "radii",
                "collisions within a radius are known for isotropic scattering",
                help,
            );
            return None;
        }
        Some(Self { scene, medium: body?.medium(), extinction, radii })
    }

    super::in_space!();
}
