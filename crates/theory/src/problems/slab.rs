//! Reflectance and transmittance of a plane-parallel slab, or a light seen through it: light that scatters in all
//! directions of space, in a medium that varies with the depth only.
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
//! | `sweep` | one of `sampling`, `sampling-scale`, `albedo`, `density`, `albedo-scale`; of several channels `contrast` in place of `albedo` | none |
//! | `estimators` | what is tested | required |
//!
//! Options choose another form of the problem:
//!
//! | option | what is sought | settings |
//! |---|---|---|
//! | `albedos` | R where it is not 0, and T, for each of 1 to 8 channels (wavelengths) by one draw | σ̂ ≥ σ_t |
//! | `albedos` and a list as `medium` or `volume` | the same where each channel has its own σ_t, within the same bounds; one lookup answers all of them | `phases = [{ NAME = { … } }, …]`, one for each channel, in place of `phase`; `sampling`: a constant σ̂ for all channels or a list |
//! | `light.cap = { cosine = c₀ }` | L through the slab: of all directions within arccos c₀ of the normal, 0 < c₀ < 1; Ω = 2π(1 − c₀) | as above, `albedo` above 0, no `incidence`; σ̂ ≥ σ_t |
//! | `light.disc = { distance, radius }` | L of a disc that faces the slab, so far behind it, about the ray | likewise |
//! | `light.distant = { cosine = μ₀ }` | L of a beam of irradiance 1, 0 < μ₀ ≤ 1: no direction is ever met by chance | likewise |
//! | `light.point = { distance }` | L of a point of intensity 1 on the ray, so far behind the slab | likewise |
//!
//! The answer depends on the optical depth of the slab, a, the phase function and the incidence only,
//! and is worked out by adding and doubling with a stated error: better than 1e-10 for isotropic and
//! Rayleigh scattering, than 1e-8 for Henyey–Greenstein's up to g = 0.9. Beyond 0.93 the forward peak is cut off (δ-M),
//! with a stated error, too; g below −0.93 is refused. Of `albedos` in one medium all moments
//! depend on that alone, too, whatever the fields σ_t and σ̂ are: `R_λ = Σ_r a_λ^r R_r` and `T_λ = Σ_r a_λ^r T_r`, r the number
//! of scatterings.
//!
//! **Light.** A camera looks along the normal; its ray enters at the beginning of the slab and is scattered once:
//!
//! ```text
//! L = ∫ a σ_t e^{−τ(z)} ∫ p(μ) e^{−(τ(end) − τ(z))/μ} L_e dω dz,   L_e = 1 from the light, 0 from elsewhere
//! p_nee = 1/Ω (cap),   p_nee = D²/(A μ³) (disc),   q = p/p_nee
//! ```
//!
//! Unscattered light is left out, and light that is scattered twice. Shadow rays choose the directions of a cap evenly,
//! and the points of a disc of area A, here seen from a point D before it: q, the pdf of a direction by the phase function
//! over that of the choice, may exceed 1. A light in no direction's neighbourhood, `distant` or `point`, has q = p, or p/D²; only
//! shadow rays find it.
//!
//! Sources: S. Chandrasekhar, *Radiative Transfer* (Oxford University Press, 1950), chapter 1; H. C. van
//! de Hulst, *Multiple Light Scattering* (Academic Press, 1980); light and several media: B. Miller, I. Georgiev, W.
//! Jarosz, *A Null-Scattering Path Integral Formulation of Light Transport*, ACM Transactions on Graphics 38 (2019),
//! section 5; albedos: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), section 5.
//!
//! ```toml
//! title = "An example of slab"
//!
//! [problem.slab]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.8
//! phase = "isotropic"
//! incidence.collimated.cosine = 0.6
//! sampling = 1.6
//! estimators = ["analog", "terminating", "weighted"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use std::slice;

use super::channels::{ColourValues, Colours, media, read_albedos, read_scatterers};
use super::{Problem, ProblemOption, default_albedo};
use media::catalogue::{Domain, Settings};
use media::phase::Phase;
use media::{Body, Medium};
use numeric::digits::number;

/// Direction of the light that enters the slab.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum IncidentLight {
    /// Light from one direction, by its cosine `μ₀` with the normal of the slab, in `(0, 1]`.
    Collimated(f64),
    /// Evenly from all sides, the Lambertian law `2μ₀ dμ₀`.
    Diffuse,
}

impl IncidentLight {
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
    /// Direction of the light.
    pub light: IncidentLight,
    /// Phase function.
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
    /// A slab with an albedo in `[0, 1]`; the distance along a medium is its depth.
    pub fn new(medium: Medium, albedo: f64, incidence: Incidence) -> Self {
        Self { medium, albedo, incidence }
    }
}

impl Problem for Slab {
    /// Weights that leave at the top and at the bottom.
    type Value = [f64; 2];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let albedo = super::number(settings, "albedo", default_albedo(settings));
        let incidence = read_incidence(settings);
        Some(Self::new(body?.medium(), albedo?, incidence?))
    }

    fn media(&self) -> &[Medium] {
        slice::from_ref(&self.medium)
    }

    fn with_albedo(&self, albedo: f64) -> Option<Self> {
        Some(Self::new(self.medium.clone(), albedo, self.incidence))
    }
}

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
    /// A slab with albedos in `[0, 1]`; the distance along a medium is its depth.
    pub fn new(medium: Medium, albedos: Vec<f64>, incidence: Incidence) -> Self {
        Self { medium, colours: Colours::new(albedos, true), incidence }
    }
}

impl Problem for SpectralSlab {
    type Value = ColourValues;

    const OPTIONS: &'static [ProblemOption] = &[ProblemOption::Albedos];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let (albedos, incidence) = (read_albedos(settings), read_incidence(settings));
        Some(Self::new(body?.medium(), albedos?, incidence?))
    }

    fn media(&self) -> &[Medium] {
        slice::from_ref(&self.medium)
    }
}

/// A slab in which every channel has a medium of its own.
pub struct ChromaticSlab {
    media: Vec<Medium>,
    /// The albedos, and what is seen.
    pub colours: Colours,
    /// Light, the same in all channels, and the phase function of each.
    pub incidences: Vec<Incidence>,
}

impl ChromaticSlab {
    /// A slab with a medium, an albedo in `[0, 1]` and an incidence for each channel.
    pub fn new(media: Vec<Medium>, albedos: Vec<f64>, incidences: Vec<Incidence>) -> Self {
        Self { media, colours: Colours::new(albedos, true), incidences }
    }

    /// The phase functions of all channels.
    pub fn phases(&self) -> Vec<Phase> {
        self.incidences.iter().map(|incidence| incidence.phase).collect()
    }
}

impl Problem for ChromaticSlab {
    type Value = ColourValues;

    const OPTIONS: &'static [ProblemOption] = &[ProblemOption::Albedos, ProblemOption::Media];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let (light, scatterers) = (read_light(settings), read_scatterers(body, settings));
        let (light, (albedos, phases)) = (light?, scatterers?);
        let incidences = phases.into_iter().map(|phase| Incidence { light, phase }).collect();
        Some(Self::new(media(body?), albedos, incidences))
    }

    fn media(&self) -> &[Medium] {
        &self.media
    }
}

/// Reads `phase` and `incidence`.
pub(super) fn read_incidence(settings: &Settings) -> Option<Incidence> {
    let (phase, light) = (Phase::read(settings), read_light(settings));
    Some(Incidence { light: light?, phase: phase? })
}

/// Reads `incidence`.
pub(super) fn read_light(settings: &Settings) -> Option<IncidentLight> {
    let (index, light) = settings.chosen("incidence", &["collimated".into(), "diffuse".into()])?;
    let read = if index == 0 {
        let help = "it is the cosine of the angle with the normal of the slab: 0 < cosine ≤ 1";
        read_cosine(&light, |cosine| cosine <= 1.0, help).map(IncidentLight::Collimated)
    } else {
        Some(IncidentLight::Diffuse)
    };
    light.close();
    read
}

/// Reads `cosine`, above 0 and allowed.
pub(super) fn read_cosine(
    light: &Settings,
    is_allowed: fn(f64) -> bool,
    help: &'static str,
) -> Option<f64> {
    let cosine = light.number("cosine", Domain::Finite)?;
    if cosine > 0.0 && is_allowed(cosine) {
        return Some(cosine);
    }
    light.fault("cosine", format!("`cosine` is {}", number(cosine)), help);
    None
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
        assert_eq!(collimated(0.25), (Some(IncidentLight::Collimated(0.25)), vec![]));
        assert_eq!(light("diffuse", table([])).0, Some(IncidentLight::Diffuse));
        for cosine in [1.5, 0.0, -0.3] {
            assert_eq!(collimated(cosine), (None, vec![format!("`cosine` is {cosine}")]));
        }
    }
}
