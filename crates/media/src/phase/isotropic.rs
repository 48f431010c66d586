//! Isotropic scattering: all directions alike.
//!
//! ```text
//! p(cos θ) = 1/(4π),   χ_l = 0 for l ≥ 1
//! ```
//!
//! `cos θ = 2u − 1` for a uniform number u. It has no settings.
//!
//! ```toml
//! title = "An example of isotropic"
//!
//! [problem.slab]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.8
//! phase.isotropic = {}
//! incidence.collimated.cosine = 0.6
//! sampling = 1.2
//! estimators = ["weighted"]
//! ```
#![cfg_attr(not(doctest), doc = crate::draw_in_rust!())]

use std::f64::consts::PI;

use super::PhaseFunction;
use crate::catalogue::Settings;
use numeric::Lane;

/// The isotropic phase function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isotropic;

impl PhaseFunction for Isotropic {
    fn read(_: &Settings) -> Option<Self> {
        Some(Self)
    }

    #[inline(always)]
    fn value<L: Lane>(&self, cosine: L) -> L {
        cosine.each(0.25 / PI)
    }

    fn moment(&self, order: usize) -> f64 {
        if order == 0 { 1.0 } else { 0.0 }
    }

    #[inline(always)]
    fn cosine<L: Lane>(&self, u: L) -> L {
        u * 2.0 - 1.0
    }
}
