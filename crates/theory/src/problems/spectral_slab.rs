//! What a slab of coloured scatterers sends back and lets through: one albedo for each channel (wavelength).
//!
//! ```text
//! as in `slab`, with the albedo a_λ of the channel λ = 1 … N, and one extinction for all of them
//! R_λ = Σ_r a_λ^r R_r,  T_λ = Σ_r a_λ^r T_r,  r the number of scatterings
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `medium` with `span = [from, to]` | σ_t as a function of the depth z, and the slab | one of the two |
//! | `volume` with `ray = { origin, direction, length }` | `σ_t(z)` as a ray through a 3-D field sees it | is required |
//! | `albedos` | 1 to 8 numbers in [0, 1], one for each channel | required |
//! | `phase.NAME = { … }` | a phase function: `trueflight list phases` | required |
//! | `incidence.collimated = { cosine = μ₀ }` | light from one direction, 0 < μ₀ ≤ 1; 1 is straight down | one of the two |
//! | `incidence.diffuse = {}` | light evenly from all sides, the Lambertian law 2μ₀ dμ₀ | is required |
//! | `sampling` | σ̂ ≥ σ_t of every estimator without its own | required unless swept |
//! | `sweep` | one of `sampling`, `sampling-scale`, `density`, `albedo-scale`, `contrast` | none |
//! | `estimators` | what is tested | required |
//!
//! The channels of a draw are the reflectances that are not 0 and the transmittances. All moments of all
//! estimators depend on the optical depth of the slab, the phase function and the incidence alone, whatever the fields
//! σ_t and σ̂ are.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), section 5.

use super::Problem;
use super::slab::{Incidence, read_light};
use super::spectral_rod::{Colours, Values};
use media::catalogue::Settings;
use media::phase::Phase;
use media::{Body, Medium};

/// A slab with one albedo for each channel.
#[derive(Clone)]
pub struct SpectralSlab {
    medium: Medium,
    /// The albedos.
    pub colours: Colours,
    /// Light and phase function.
    pub incidence: Incidence,
}

impl SpectralSlab {
    /// A slab whose depth is the distance along a medium, with albedos in `[0, 1]`.
    pub fn new(medium: Medium, albedos: Vec<f64>, incidence: Incidence) -> Self {
        Self { medium, colours: Colours::new(albedos, true), incidence }
    }
}

impl Problem for SpectralSlab {
    type Value = Values;

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let albedos = Colours::read_albedos(settings);
        let (phase, light) = (Phase::read(settings), read_light(settings));
        let incidence = Incidence { light: light?, phase: phase? };
        Some(Self::new(body?.medium(), albedos?, incidence))
    }

    fn medium(&self) -> &Medium {
        &self.medium
    }
}
