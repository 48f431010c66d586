//! Rayleigh scattering of unpolarised light: by particles much smaller than the wavelength.
//!
//! ```text
//! p(cos θ) = 3/(16π) (1 + cos² θ),   χ_1 = 0, χ_2 = 1/10, all others 0
//! ```
//!
//! A uniform number u gives the real root of `cos³ θ + 3 cos θ = 2q`, `q = 4u − 2`, by Cardano:
//! `cos θ = c − 1/c` with `c = (q + √(q² + 1))^{1/3}`. It has no settings.
//!
//! Source: S. Chandrasekhar, *Radiative Transfer* (Oxford University Press, 1950), section 1.4; J. R.
//! Frisvad, *Importance sampling the Rayleigh phase function*, Journal of the Optical Society of
//! America A 28(12), 2436–2441 (2011).
//!
//! ```toml
//! title = "An example of rayleigh"
//!
//! [problem.slab]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.8
//! phase.rayleigh = {}
//! incidence.collimated.cosine = 0.6
//! sampling = 1.2
//! estimators = ["weighted"]
//! ```
#![cfg_attr(not(doctest), doc = crate::draw_in_rust!())]

use std::f64::consts::PI;

use super::{PhaseFunction, unit};
use crate::catalogue::Settings;
use numeric::Lane;

/// The Rayleigh phase function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rayleigh;

impl PhaseFunction for Rayleigh {
    fn read(_: &Settings) -> Option<Self> {
        Some(Self)
    }

    #[inline(always)]
    fn value<L: Lane>(&self, cosine: L) -> L {
        (cosine * cosine + 1.0) * (3.0 / (16.0 * PI))
    }

    fn moment(&self, order: usize) -> f64 {
        match order {
            0 => 1.0,
            2 => 0.1,
            _ => 0.0,
        }
    }

    #[inline(always)]
    fn cosine<L: Lane>(&self, u: L) -> L {
        let q = u * 4.0 - 2.0;
        // The cube root of a number from 1 on; the sign comes last, so that nothing cancels in it.
        let c = Lane::exp(Lane::ln(q.size() + (q * q + 1.0).root()) * (1.0 / 3.0));
        let root = c - c.each(1.0) / c;
        let root = L::select(q.below(q.each(0.0)), -root, root);
        // One step of Newton's: c − 1/c cancels near 0.
        unit(root - (root * root * root + root * 3.0 - q * 2.0) / (root * root * 3.0 + 3.0))
    }
}
