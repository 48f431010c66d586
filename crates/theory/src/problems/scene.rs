//! A medium in space that scatters: what all problems in three dimensions are about.

use std::sync::Arc;

use super::{default_albedo, number};
use media::catalogue::{Settings, Value};
use media::phase::Phase;
use media::{Body, Volume, reader};
use numeric::geometry::{Bounds, Point};

/// The albedo a of a medium.
#[derive(Clone)]
pub enum Albedo {
    /// One number everywhere.
    Even(f64),
    /// A field of numbers from 0 to the given one, at most 1; 0 outside its bounds.
    Field(Arc<Volume>, f64),
}

impl Albedo {
    /// a at a place.
    #[inline(always)]
    pub fn at(&self, place: Point) -> f64 {
        match self {
            Self::Even(albedo) => *albedo,
            Self::Field(field, _) => field.extinction_at(place),
        }
    }

    /// The least and the largest value that it may have.
    pub fn range(&self) -> [f64; 2] {
        match self {
            Self::Even(albedo) => [*albedo; 2],
            Self::Field(_, maximum) => [0.0, *maximum],
        }
    }

    /// a, where it is the same everywhere.
    pub fn even(&self) -> Option<f64> {
        match self {
            Self::Even(albedo) => Some(*albedo),
            Self::Field(..) => None,
        }
    }
}

/// A volume with its albedo and its phase function.
#[derive(Clone)]
pub struct Scene {
    /// σ_t.
    pub volume: Arc<Volume>,
    /// a.
    pub albedo: Albedo,
    /// Phase function.
    pub phase: Phase,
}

impl Scene {
    /// Reads `albedo` and `phase` beside a volume, which must have bounds.
    pub fn bounded(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let scene = Self::read(body, settings)?;
        let help = "give it `bounds.sphere = { centre, radius }` or `bounds.box = { low, high }`";
        require_bounds(settings, scene.volume.bounds(), help)?;
        Some(scene)
    }

    /// Reads `albedo` and `phase` beside any volume.
    pub fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let phase = Phase::read(settings);
        let volume = body.and_then(|body| in_space(body, settings)).cloned();
        let albedo = read_albedo(settings, volume.as_deref());
        Some(Self { volume: volume?, albedo: albedo?, phase: phase? })
    }

    /// A copy with another albedo, everywhere.
    #[must_use]
    pub fn with_albedo(&self, albedo: f64) -> Self {
        Self { albedo: Albedo::Even(albedo), ..self.clone() }
    }
}

/// The field of a body in space; `None` after a mistake.
pub(super) fn in_space<'a>(body: &'a Body, settings: &Settings) -> Option<&'a Arc<Volume>> {
    if let Body::Volume { volume, .. } = body {
        return Some(volume);
    }
    let help = "write `volume` instead of `medium`";
    settings.fault("medium", "particles walk through a field in space", help);
    None
}

/// Requires a volume that particles can leave.
pub(super) fn require_bounds(
    settings: &Settings,
    bounds: Bounds,
    help: &'static str,
) -> Option<()> {
    if bounds.enclosing_box().is_none() {
        settings.fault("volume", "particles would never leave a volume without bounds", help);
        return None;
    }
    Some(())
}

/// Reads `albedo`, a number or a field in space.
pub fn read_albedo(settings: &Settings, volume: Option<&Volume>) -> Option<Albedo> {
    let value = settings.entry("albedo").map(|entry| &entry.node.value);
    if !matches!(value, Some(Value::Table(_))) {
        return number(settings, "albedo", default_albedo(settings)).map(Albedo::Even);
    }
    let (_, field) = reader::read_volume(settings, Some("albedo"))?;
    let maximum = volume?.bounds().enclosing_box().map(|within| field.majorant(&within));
    // A bound is raised a little over what the field reaches.
    let Some(maximum) = maximum.filter(|&maximum| maximum <= 1.0 + 1e-9) else {
        let help = "an albedo is at most 1; its bound is taken over the box about the volume";
        settings.fault("albedo", "the field may exceed 1 in the volume", help);
        return None;
    };
    Some(Albedo::Field(field, maximum.min(1.0)))
}
