//! Bidirectional path tracing: hits, shadow rays, and connections with a vertex of the light.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! a path … x – y – light, y its last scattering seen from the eye, x the one before, is made
//!   by a hit          with the density 1                    the walk comes to y and on to the light
//!   by a shadow ray   1/(q Π ν_y)                           the walk comes to y, which chooses the light
//!   by a connection   4 d²/(a ρ² Π ν_x)                     a particle from the light comes to y, which is joined to x
//! X = [light met before the first scattering] + Σ f/p w,   f/p the inverse densities,  w = p^β/Σ p^β
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `heuristic` | `"balance"`: β = 1, `"power"`: β = 2 | `"balance"` |
//! | `subpaths` | `"independent"`: every scattering of the walk is joined to a vertex of the light of its own; `"shared"`: all of them to the same | `"independent"` |
//!
//! `ν = 1 − σ_t/σ̂` over the null collisions between y and the light, and between x and y; d is the distance of x
//! and y, ρ the radius of the surface from or through which light comes, `q = Ω/4π`. All segments go through the
//! same σ̂. Walks use delta tracking (they are scattered with probability a), shadow rays and connections use ratio
//! tracking, so that majorant transmittances cancel. Paths of one scattering have no x. The exception is a mean
//! intensity: its place is x. A distant light is never hit: the density of a hit is 0.
//!
//! A connection by itself is not offered: its value is `a ρ²/(4 d²)`, and the mean square `∫ d² dd/d⁴` is infinite
//! wherever both of its ends may be anywhere. Densities of directions alone would not help. A walk has the density
//! 1 for near vertices as for far ones. Combined with it a connection scores less than ½. It therefore exists only
//! in a combination over whole paths.
//!
//! Theory bounds the variance of independent subpaths. Connections that share a vertex are correlated, and for a
//! distant light even independent ones are: there pilot draws stand in for the variance. The number of lookups is
//! not known.
//!
//! Source: E. Veach, L. Guibas, *Bidirectional Estimators for Light Transport*, Eurographics Workshop on Rendering
//! (1994); B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*, ACM
//! Transactions on Graphics 38 (2019), section 5.5, Eqs. 43 and 44. Densities are derived in
//! `estimators/sphere/combined.rs`, the bound in `theory/sphere/spread.rs`.
//!
//! ```toml
//! title = "An example of bidirectional"
//!
//! [problem.ball]
//! volume.constant = { extinction = 1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }
//! ray = { origin = [0.2, 0, -2], direction = [0, 0, 1] }
//! albedo = 0.8
//! phase = "isotropic"
//! light.black-sphere.radius = 0.5
//! sampling = 1.6
//! estimators = ["bidirectional"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::{Connected, Connecting, Method};
use super::sharing::{SharedTechniques, Subpaths};
use crate::setup::heuristic;
use crate::space::ParticleSettings;
use media::catalogue::Settings;
use theory::ParticleRule;
use theory::space::sphere::Techniques;

/// Three techniques.
pub type Bidirectional = Connected<OfSubpaths>;

/// The settings of the page.
#[derive(Debug, Clone)]
pub struct OfSubpaths;

impl Connecting for OfSubpaths {
    fn read(settings: &Settings) -> Option<Method> {
        let heuristic = heuristic::read(settings);
        let words = ["independent", "shared"];
        let subpaths = settings
            .word_or("subpaths", &words, words[0])
            .map(|word| if word == words[0] { Subpaths::Independent } else { Subpaths::Shared });
        let techniques = Techniques::Bidirectional(heuristic?);
        let sharing = SharedTechniques { techniques, shadow: None, subpaths };
        subpaths.map(|_| Method { particle: ParticleSettings::of(ParticleRule::Analog), sharing })
    }
}
