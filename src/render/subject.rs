//! What a picture shows: a problem that every pixel's ray has its own of.

use std::sync::Arc;

use super::view::View;
use crate::catalogue::{Domain, Settings};
use crate::estimators::Estimated;
use crate::geometry::Ray;
use crate::media::{Medium, Volume};
use crate::numeric::{Known, Lane};
use crate::phase::Phase;
use crate::problems::scene::read_albedo;
use crate::problems::single_scattering::{Lamp, OnTheLine};
use crate::problems::{
    Albedo, MultipleScattering, Problem, Scene, SingleScattering, Sky, Transmittance,
};
use crate::theory::Mesh;
use crate::theory::single::quick;

/// A problem that pictures are made of.
pub trait Subject: Estimated + Problem<Value = [f64; 1]> {
    /// What all its rays share beside the volume.
    type Shared: Send + Sync;

    /// Whether draws weight the light of the sky behind the volume.
    const BEFORE_SKY: bool;
    /// Whether the sky is seen beside the volume; else it is black there.
    const SHOWS_SKY: bool;
    /// Whether its draws walk along the ray, which is then looked at first.
    const ALONG_RAY: bool = true;
    /// Whether theory is quick enough to be asked at every pixel.
    const IS_PREDICTED: bool;

    /// Reads what all rays share.
    fn read_shared(settings: &Settings, view: Option<&View>) -> Option<Self::Shared>;

    /// Whether a ray can be asked about.
    ///
    /// # Errors
    ///
    /// What is wrong and the cure.
    fn allows(shared: &Self::Shared, ray: &Ray) -> Result<(), [String; 2]> {
        let _ = (shared, ray);
        Ok(())
    }

    /// The problem of one ray; `None` where it is not allowed.
    fn at(shared: &Self::Shared, volume: &Arc<Volume>, ray: &Ray) -> Option<Self>;

    /// Whether [`Subject::exact`] knows all answers.
    fn has_exact(shared: &Self::Shared) -> bool {
        let _ = shared;
        false
    }

    /// The exact answer, from closed forms; `None` where there are none.
    fn exact(&self) -> Option<Known> {
        None
    }

    /// The answer by a quadrature of twice so many panels with 16 nodes, and what half of them differ
    /// by; `None` where there is no such thing.
    fn by_quadrature(&self, panels: usize) -> Option<Known> {
        let _ = panels;
        None
    }
}

impl Subject for Transmittance {
    type Shared = ();

    const BEFORE_SKY: bool = true;
    const SHOWS_SKY: bool = true;
    const IS_PREDICTED: bool = true;

    fn read_shared(_: &Settings, _: Option<&View>) -> Option<()> {
        Some(())
    }

    fn at((): &(), volume: &Arc<Volume>, ray: &Ray) -> Option<Self> {
        let support = volume.bounds().clip(ray);
        let profile = volume.along(ray, support);
        Some(Self::new(Medium::new(profile, ray.span(), support)))
    }

    fn has_exact((): &()) -> bool {
        true
    }

    fn exact(&self) -> Option<Known> {
        Some(self.medium().optical_depth(self.medium().support()).exp_neg())
    }

    fn by_quadrature(&self, panels: usize) -> Option<Known> {
        let transmittance = |panels: usize| {
            Lane::exp(-Mesh::even(self.medium().clone(), panels).optical_depth().value)
        };
        let fine = transmittance(2 * panels);
        Some(Known::new(fine, (fine - transmittance(panels)).abs()))
    }
}

/// A light and how the medium scatters it.
pub struct Lit {
    lamp: Lamp,
    albedo: f64,
    phase: Phase,
}

impl Subject for SingleScattering {
    type Shared = Lit;

    const BEFORE_SKY: bool = false;
    const SHOWS_SKY: bool = false;
    const IS_PREDICTED: bool = false;

    fn read_shared(settings: &Settings, _: Option<&View>) -> Option<Lit> {
        let lamp = Lamp::read(settings);
        let albedo = settings.number("albedo", Domain::Unit);
        let phase = Phase::read(settings);
        let (lamp, albedo, phase) = (lamp?, albedo?, phase?);
        if albedo <= 0.0 {
            settings.fault("albedo", "nothing is scattered", "the albedo is above 0");
            return None;
        }
        Some(Lit { lamp, albedo, phase })
    }

    fn allows(shared: &Lit, ray: &Ray) -> Result<(), [String; 2]> {
        shared.lamp.seen_from(ray).map(drop).map_err(|OnTheLine(distance)| {
            let found = format!("the light is {distance:e} away from the line of a pixel's ray");
            [found, "move it a little: on the ray the radiance is infinite".into()]
        })
    }

    fn at(shared: &Lit, volume: &Arc<Volume>, ray: &Ray) -> Option<Self> {
        Self::new(volume.clone(), *ray, shared.lamp, shared.albedo, shared.phase).ok()
    }

    fn by_quadrature(&self, panels: usize) -> Option<Known> {
        Some(quick::radiance(self, panels))
    }
}

impl Subject for MultipleScattering {
    type Shared = Sunlit;

    const BEFORE_SKY: bool = false;
    const SHOWS_SKY: bool = true;
    const ALONG_RAY: bool = false;
    const IS_PREDICTED: bool = false;

    fn read_shared(settings: &Settings, view: Option<&View>) -> Option<Sunlit> {
        let phase = Phase::read(settings);
        let albedo = read_albedo(settings, view.map(|view| &*view.volume));
        Some(Sunlit { albedo: albedo?, phase: phase?, sky: view?.sky })
    }

    fn at(shared: &Sunlit, volume: &Arc<Volume>, ray: &Ray) -> Option<Self> {
        let (albedo, phase) = (shared.albedo.clone(), shared.phase);
        Some(Self::new(Scene { volume: volume.clone(), albedo, phase }, shared.sky, *ray))
    }

    /// A white furnace: nothing is absorbed, and it is as bright as its walls.
    fn has_exact(shared: &Sunlit) -> bool {
        shared.albedo.even() == Some(1.0) && matches!(shared.sky, Sky::Constant { .. })
    }

    fn exact(&self) -> Option<Known> {
        Some(Known::exact(self.background()))
    }
}

/// A sky and how the medium scatters it.
pub struct Sunlit {
    albedo: Albedo,
    phase: Phase,
    sky: Sky,
}
