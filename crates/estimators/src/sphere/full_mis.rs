//! Hits and shadow rays, weighted by the densities of the whole null-scattering path.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! ρ = p_uni/p_nee = q ν,   q = Ω/4π the light's share of all directions, ν the probability that the last
//!     segment has only null collisions: Π (1 − σ_t/σ̂) by the rules analog, terminating and weighted
//! X = [light met before the first scattering] + Σ w q T̂ w_nee(ρ) + [hit] w w_uni(ρ),   T̂ = Π (1 − σ_t/σ̂)
//! balance: w_uni = ρ/(1 + ρ);  power: w_uni = ρ²/(1 + ρ²);  w_nee = 1 − w_uni
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `rule`, `roulette` | how the particle walks, see the page `particle` | `rule` required |
//! | `shadow` | `"ratio"` tracking through the σ̂ of the walk; `"exact"`: transmittances instead of null collisions in both densities, `ρ = q T` | `"ratio"` |
//! | `heuristic` | `"balance"` or `"power"` | `"balance"` |
//!
//! Majorant transmittances cancel in ρ, as walk and shadow ray have the same σ̂, a constant or local majorants. ρ
//! is reset to q at every real scattering. Roulette is left out of both densities. A distant light is never hit,
//! `p_uni = 0`: it is next-event estimation.
//!
//! For `σ̂ ≥ σ_t` theory bounds the variance: a shadow ray and a hit each score `q/(1 + q)` at most. The number of
//! lookups is not known.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*, ACM
//! Transactions on Graphics 38 (2019), section 5.3, Algorithms 1 and 2, Eq. 42. The bound is derived in
//! `theory/sphere/spread.rs`.
//!
//! ```toml
//! title = "An example of full-mis"
//!
//! [problem.ball]
//! volume.constant = { extinction = 1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }
//! ray = { origin = [0.2, 0, -2], direction = [0, 0, 1] }
//! albedo = 0.8
//! phase = "isotropic"
//! light.black-sphere.radius = 0.5
//! sampling = 1.6
//! estimators = [{ full-mis.rule = "analog" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::{Connected, Connecting, Method};
use super::sharing::SharedTechniques;
use crate::setup::heuristic;
use crate::space::ParticleSettings;
use media::catalogue::Settings;
use theory::light::Densities;
use theory::single::Tracking;
use theory::space::sphere::Techniques;

/// Multiple importance sampling over null-scattering paths.
pub type FullMis = Connected<OfPaths>;

/// The settings of the page.
#[derive(Debug, Clone)]
pub struct OfPaths;

impl Connecting for OfPaths {
    fn read(settings: &Settings) -> Option<Method> {
        let particle = ParticleSettings::read(settings);
        let shadow = settings.word_or("shadow", &["ratio", "exact"], "ratio");
        let heuristic = heuristic::read(settings);
        let shadow = (shadow? == "exact").then_some(Tracking::Exact);
        let techniques = Techniques::Mis(Densities::Full, heuristic?);
        let sharing = SharedTechniques { techniques, shadow, subpaths: None };
        Some(Method { particle: particle?, sharing })
    }
}
