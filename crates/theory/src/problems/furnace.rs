//! The radiance along a ray into a furnace: whatever is inside, it is 1, in every channel (wavelength).
//!
//! ```text
//! light of radiance 1 comes from all sides; where the medium absorbs it also emits, as hot as its walls
//! L = Σ w r (1 − a) over the collisions of a walk + w where it leaves,   E[L] = 1
//! L_λ = the probability of a walk of the channel λ = 1 … N to be absorbed, or to leave: 1
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `volume` with `ray = { origin, direction }` | σ_t in space, with bounds, and the ray; what counts of the ray is where it enters the bounds, a `length` does not | required |
//! | `albedo` | a in [0, 1]: a number, or a field in space such as `sines = { … }` | required unless swept |
//! | `phase.NAME = { … }` | a phase function: `trueflight list phases` | required |
//! | `sampling` | σ̂ in space of every estimator without its own: `constant`, or `local-majorants` with a `grid` | required unless swept |
//! | `sweep` | one of `sampling`, `sampling-scale`, `albedo`, `density`, `albedo-scale`; of several channels `sampling`, `sampling-scale` | none |
//! | `estimators` | what is tested | required |
//!
//! **Several channels**: `volume` is a list of 1 to 8 fields within the same bounds and `ray` has a `length`; `albedos` (numbers)
//! and `phases = [{ NAME = { … } }, …]` list one for each channel in place of `albedo` and `phase`; `sampling` is a constant σ̂
//! for all channels, or a list with one for each. One lookup answers σ_t of all channels.
//!
//! With a = 1 it is the white furnace. With any other a, constant or not, Kirchhoff's law makes it one: the light
//! that leaves and the light that is absorbed are together all the light that there was. Each part is unknown; their
//! sum is known. It holds for every medium, phase function, σ̂ and rule. So every medium has a test of its walks, and
//! a renderer's bug in weights cannot hide in a medium without a known picture. Walks that score all channels at once
//! have an exact answer in every medium, too.
//!
//! Directions do not matter for L, see `trueflight explain lambertian` for those.
//!
//! Sources: G. Kirchhoff, *Ueber das Verhältniss zwischen dem Emissionsvermögen und dem Absorptionsvermögen
//! der Körper für Wärme und Licht*, Annalen der Physik 185 (1860); channels: B. Miller, I. Georgiev, W. Jarosz, *A
//! Null-Scattering Path Integral Formulation of Light Transport*, ACM Transactions on Graphics 38 (2019), section 5.1.
//!
//! ```toml
//! title = "An example of furnace"
//!
//! [problem.furnace]
//! volume.constant = { extinction = 1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }
//! ray = { origin = [0, 0, -2], direction = [0, 0, 1], length = 4 }
//! albedo = 0.8
//! phase = "isotropic"
//! sampling = 1.2
//! estimators = [{ particle.rule = "analog" }, { particle.rule = "weighted" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::channels::{Channel, media, read_channels};
use super::scene::require_bounds;
use super::{ChannelValues, Problem, ProblemOption, Scene};
use media::body::RayNeed;
use media::catalogue::Settings;
use media::{Body, Medium, misses};
use numeric::geometry::{Bounds, Point, Ray};

/// The radiance along a ray into a furnace.
#[derive(Clone)]
pub struct Furnace {
    /// The medium in space.
    pub scene: Scene,
    /// Point where the ray enters the bounds, or begins within them.
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
        let entry = read_entry(settings, scene.volume.bounds(), &onward)?;
        Some(Self { scene, entry, direction: ray.direction, medium: body?.medium() })
    }

    super::in_space!();
}

/// Reads the point where a ray enters the bounds.
fn read_entry(settings: &Settings, bounds: Bounds, ray: &Ray) -> Option<Point> {
    let inside = bounds.clip(ray);
    if inside.is_empty() {
        let help = "turn it, or move its origin: what misses the volume tests nothing";
        let actual = format!("the ray misses the volume, whose {}", misses::place(bounds));
        settings.fault("ray", actual, help);
        return None;
    }
    Some(ray.at(inside.from))
}

/// The radiance along a ray into a furnace in several channels.
pub struct SpectralFurnace {
    /// The medium of each channel.
    pub channels: Vec<Channel>,
    /// Albedos of the channels.
    pub albedos: Vec<f64>,
    /// Bounds of all channels.
    pub bounds: Bounds,
    /// Point where the ray enters the bounds, or begins within them.
    pub entry: Point,
    /// The direction of the ray.
    pub direction: Point,
    media: Vec<Medium>,
}

impl Problem for SpectralFurnace {
    type Value = ChannelValues;

    const OPTIONS: &'static [ProblemOption] = &[ProblemOption::Albedos, ProblemOption::Media];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let channels = read_channels(body, settings)?;
        let Body::Volume { ray, .. } = &body?.channels()[0] else { return None };
        let bounds = channels[0].volume.bounds();
        let help = "give each channel the same `bounds.sphere` or `bounds.box`";
        require_bounds(settings, bounds, help)?;
        let entry = read_entry(settings, bounds, ray)?;
        let (direction, media) = (ray.direction, media(body?));
        let albedos = channels.iter().map(|channel| channel.albedo).collect();
        Some(Self { channels, albedos, bounds, entry, direction, media })
    }

    fn media(&self) -> &[Medium] {
        &self.media
    }
}
