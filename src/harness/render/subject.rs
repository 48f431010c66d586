//! What a picture shows: a problem that every pixel's ray has its own of.

use std::sync::Arc;

use crate::catalogue::{Domain, Settings};
use crate::estimators::Estimated;
use crate::geometry::Ray;
use crate::media::{Medium, Volume};
use crate::numeric::{Known, Lane};
use crate::phase::Phase;
use crate::problems::single_scattering::{Lamp, OnTheLine};
use crate::problems::{Problem, SingleScattering, Transmittance};
use crate::theory::Mesh;
use crate::theory::single::glance;

/// A problem that pictures are made of.
pub trait Subject: Estimated + Problem<Value = [f64; 1]> {
    /// What all its rays share beside the volume.
    type Shared: Send + Sync;

    /// Whether draws weight the light of the sky behind the volume; else what the ray gathers is
    /// shown on black.
    const BEFORE_SKY: bool;
    /// Whether theory is quick enough to be asked at every pixel.
    const IS_PREDICTED: bool;

    /// Reads what all rays share.
    fn read_shared(settings: &Settings) -> Option<Self::Shared>;

    /// Whether a ray can be asked about.
    ///
    /// # Errors
    ///
    /// What is wrong and the cure.
    fn allows(shared: &Self::Shared, ray: &Ray) -> Result<(), [String; 2]>;

    /// The problem of one ray; `None` where it is not allowed.
    fn at(shared: &Self::Shared, volume: &Arc<Volume>, ray: &Ray) -> Option<Self>;

    /// The exact answer, from closed forms; `None` where there are none.
    fn exact(&self) -> Option<Known>;

    /// The answer by a quadrature of so many panels with 16 nodes, and what half as many differ by.
    fn by_quadrature(&self, panels: usize) -> Known;
}

impl Subject for Transmittance {
    type Shared = ();

    const BEFORE_SKY: bool = true;
    const IS_PREDICTED: bool = true;

    fn read_shared(_: &Settings) -> Option<()> {
        Some(())
    }

    fn allows((): &(), _: &Ray) -> Result<(), [String; 2]> {
        Ok(())
    }

    fn at((): &(), volume: &Arc<Volume>, ray: &Ray) -> Option<Self> {
        let support = volume.bounds().clip(ray);
        let profile = Arc::new(volume.along(ray, support));
        Some(Self::new(Medium::new(profile, ray.span(), support)))
    }

    fn exact(&self) -> Option<Known> {
        Some(self.medium().optical_depth(self.medium().support()).exp_neg())
    }

    fn by_quadrature(&self, panels: usize) -> Known {
        let transmittance = |panels: usize| {
            Lane::exp(-Mesh::even(self.medium().clone(), panels).optical_depth().value)
        };
        let fine = transmittance(2 * panels);
        Known::new(fine, (fine - transmittance(panels)).abs())
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
    const IS_PREDICTED: bool = false;

    fn read_shared(settings: &Settings) -> Option<Lit> {
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

    fn exact(&self) -> Option<Known> {
        None
    }

    fn by_quadrature(&self, panels: usize) -> Known {
        glance::radiance(self, panels)
    }
}
