//! σ_t looked up at the wrong place.
//!
//! ```text
//! r(tᵢ) = σ_t(tᵢ)/σ̂(tᵢ),  at the collision itself
//! ```
//!
//! At another place of the flight the residual is no longer weighted by its own length of the ray.
//! A reversed medium has the same optical depth, and so the same transmittance; what ends early
//! ends at other places.

use super::Mutant;
use super::fault::{Fault, Memory};
use super::target::{BELOW, DENSE, TERMINATING, WOODCOCK};
use super::walk::product;
use crate::estimators::rules::{Null, Single, Weight};
use crate::media::{Extinction, Lookups};
use crate::problems::Transmittance;

/// The family.
#[must_use]
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    vec![
        product(
            "lookup-at-previous",
            "σ_t is looked up where the flight began",
            BELOW,
            "mean",
            Weight,
            AtPrevious,
        ),
        product(
            "lookup-at-midpoint",
            "σ_t is looked up at the flight's midpoint",
            WOODCOCK,
            "mean",
            Null,
            AtMidpoint,
        ),
        product(
            "lookup-reversed",
            "σ_t(S − t) is looked up for σ_t(t)",
            TERMINATING,
            "lookups",
            Single::Terminating,
            Reversed,
        ),
        product(
            "lookup-on-raster",
            "positions are rounded down to sixteenths of the ray before the lookup",
            DENSE,
            "mean",
            Weight,
            OnRaster,
        ),
        product(
            "lookup-of-another-channel",
            "the chance of a real collision is that of another colour channel, 0.8 σ_t",
            WOODCOCK,
            "mean",
            Null,
            OfAnotherChannel,
        ),
    ]
}

/// `σ_t(tᵢ₋₁)`.
#[derive(Clone, Copy)]
pub struct AtPrevious;

impl Fault for AtPrevious {
    #[inline(always)]
    fn look(&self, memory: &Memory, medium: &Lookups, _: f64) -> f64 {
        medium.extinction(memory.from)
    }
}

/// `σ_t((tᵢ₋₁ + tᵢ)/2)`.
#[derive(Clone, Copy)]
pub struct AtMidpoint;

impl Fault for AtMidpoint {
    #[inline(always)]
    fn look(&self, memory: &Memory, medium: &Lookups, t: f64) -> f64 {
        medium.extinction(0.5 * (memory.from + t))
    }
}

/// `σ_t(S − t)`.
#[derive(Clone, Copy)]
struct Reversed;

impl Fault for Reversed {
    #[inline(always)]
    fn look(&self, memory: &Memory, medium: &Lookups, t: f64) -> f64 {
        medium.extinction(memory.support.from + (memory.support.to - t))
    }
}

/// `σ_t(h⌊t/h⌋)`.
#[derive(Clone, Copy)]
struct OnRaster;

impl Fault for OnRaster {
    #[inline(always)]
    fn look(&self, memory: &Memory, medium: &Lookups, t: f64) -> f64 {
        let cell = memory.support.length() / 16.0;
        let from = memory.support.from;
        medium.extinction(from + ((t - from) / cell).floor() * cell)
    }
}

/// `0.8 σ_t(t)`.
#[derive(Clone, Copy)]
pub struct OfAnotherChannel;

impl Fault for OfAnotherChannel {
    #[inline(always)]
    fn look(&self, _: &Memory, medium: &Lookups, t: f64) -> f64 {
        0.8 * medium.extinction(t)
    }
}
