//! Next-event estimation: a shadow ray to the light from every scattering of a walk.
//!
//! Unbiased for: σ̂ ≥ σ_t, and σ̂ and σ_c of shadow rays that are near σ_t; refused elsewhere.
//!
//! ```text
//! X = [light met before the first scattering] + Σ w Ω/4π T̂ over the scatterings
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `rule`, `roulette` | how the particle walks, see the page `particle` | `rule` required |
//! | `shadow` | `"exact"`, `ratio = { sampling, control }` or `delta = { sampling }`, each one number | `"exact"` |
//!
//! Shadow rays are delta tracked, ratio tracked, residual-ratio tracked (`control`), or taken from exact
//! optical depths. They are clipped to the ball and to the light.
//!
//! Unbiased for every σ̂ of walk and shadow rays, except that a delta-tracked shadow needs a majorant. Required are
//! `σ̂ ≥ σ_t` of the walk, and a σ̂ and σ_c of shadow rays that are not far from σ_t: then theory bounds the
//! variance, sharply where weights and tracked transmittances are 0 or 1. The number of lookups is not known. The
//! exact shadow uses the platform's library: the last bits of draws with one may differ between machines.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light
//! transport*, ACM Transactions on Graphics 38 (2019), section 5.3; J. Novák, A. Selle, W. Jarosz,
//! *Residual ratio tracking for estimating attenuation in participating media*, ACM Transactions on
//! Graphics 33 (2014). The bound is derived in `theory/sphere/spread.rs`.
//!
//! ```toml
//! title = "An example of next-event"
//!
//! [problem.ball]
//! volume.constant = { extinction = 1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }
//! ray = { origin = [0.2, 0, -2], direction = [0, 0, 1] }
//! albedo = 0.8
//! phase = "isotropic"
//! light.black-sphere.radius = 0.5
//! sampling = 1.6
//! estimators = [{ next-event.rule = "weighted" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::{Connected, Connecting, Method};
use super::sharing::SharedTechniques;
use crate::space::ParticleSettings;
use crate::space::connection;
use media::catalogue::Settings;
use theory::space::sphere::Techniques;

/// A walk with shadow rays.
pub type NextEvent = Connected<OfNextEvent>;

/// The settings of the page.
#[derive(Debug, Clone)]
pub struct OfNextEvent;

impl Connecting for OfNextEvent {
    fn read(settings: &Settings) -> Option<Method> {
        let particle = ParticleSettings::read(settings);
        let shadow = Some(connection::read_shadow(settings)?);
        let sharing =
            SharedTechniques { techniques: Techniques::NextEvent, shadow, subpaths: None };
        Some(Method { particle: particle?, sharing })
    }
}
