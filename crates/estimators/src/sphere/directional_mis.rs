//! Hits and shadow rays, weighted by the densities of directions: what most renderers do.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! ρ = p_uni/p_nee = q,   q = Ω/4π the light's share of all directions; null collisions are left out of both
//! X = [light met before the first scattering] + Σ w q T̂ w_nee(ρ) + [hit] w w_uni(ρ)
//! balance: w_uni = ρ/(1 + ρ);  power: w_uni = ρ²/(1 + ρ²);  w_nee = 1 − w_uni
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `rule`, `roulette` | how the particle walks, see the page `particle` | `rule` required |
//! | `shadow` | `"exact"`, `ratio = { sampling, control }` or `delta = { sampling }`, each one number | `"exact"` |
//! | `heuristic` | `"balance"` or `"power"` | `"balance"` |
//!
//! An environment fills all directions, q = 1: both samples have the weight ½. A distant light is never hit and
//! `w_nee = 1`: it is next-event estimation.
//!
//! Unbiased wherever `next-event` is. Theory bounds the variance, sharply for the rule `analog` with delta-tracked shadow
//! rays. The number of lookups is not known.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering Heterogeneous
//! Volumes*, ACM Transactions on Graphics 36 (2017); B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral
//! formulation of light transport*, ACM Transactions on Graphics 38 (2019), section 6; the heuristics: E. Veach, *Robust
//! Monte Carlo Methods for Light Transport Simulation*, doctoral thesis, Stanford (1997). The bound is derived in
//! `theory/sphere/spread.rs`.
//!
//! ```toml
//! title = "An example of directional-mis"
//!
//! [problem.ball]
//! volume.constant = { extinction = 1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }
//! ray = { origin = [0.2, 0, -2], direction = [0, 0, 1] }
//! albedo = 0.8
//! phase = "isotropic"
//! light.black-sphere.radius = 0.5
//! sampling = 1.6
//! estimators = [{ directional-mis.rule = "analog" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::{Connected, Connecting, Method};
use super::sharing::SharedTechniques;
use crate::setup::heuristic;
use crate::space::ParticleSettings;
use crate::space::connection;
use media::catalogue::Settings;
use theory::light::Densities;
use theory::space::sphere::Techniques;

/// Multiple importance sampling over directions.
pub type DirectionalMis = Connected<OfDirections>;

/// The settings of the page.
#[derive(Debug, Clone)]
pub struct OfDirections;

impl Connecting for OfDirections {
    fn read(settings: &Settings) -> Option<Method> {
        let particle = ParticleSettings::read(settings);
        let shadow = connection::read_shadow(settings);
        let heuristic = heuristic::read(settings);
        let techniques = Techniques::Mis(Densities::Directional, heuristic?);
        let sharing = SharedTechniques { techniques, shadow: Some(shadow?), subpaths: None };
        Some(Method { particle: particle?, sharing })
    }
}
