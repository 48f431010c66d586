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
use super::fault::{Fault, RIGHT};
use super::target::{BELOW, DENSE, TERMINATING, WOODCOCK};
use super::walk::product;
use media::Extinction;
use theory::problems::Transmittance;
use theory::rules::{Null, Single, Weight};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    vec![
        product("lookup-at-previous", "σ_t is looked up where the flight began", BELOW, "mean", Weight, AT_PREVIOUS),
        product("lookup-at-midpoint", "σ_t is looked up at the flight's midpoint", WOODCOCK, "mean", Null, AT_MIDPOINT),
        product("lookup-reversed", "σ_t(S − t) is looked up for σ_t(t)", TERMINATING, "lookups", Single::Terminating, REVERSED),
        product("lookup-on-raster", "positions are rounded down to sixteenths of the ray before the lookup", DENSE, "mean", Weight, ON_RASTER),
        product("lookup-of-another-channel", "the chance of a real collision is that of another colour channel, 0.8 σ_t", WOODCOCK, "mean", Null, OF_ANOTHER_CHANNEL),
    ]
}

/// `σ_t(tᵢ₋₁)`.
pub const AT_PREVIOUS: Fault =
    Fault { look: |memory, medium, _| medium.extinction(memory.from), ..RIGHT };

/// `σ_t((tᵢ₋₁ + tᵢ)/2)`.
pub const AT_MIDPOINT: Fault =
    Fault { look: |memory, medium, t| medium.extinction(0.5 * (memory.from + t)), ..RIGHT };

/// `σ_t(S − t)`.
const REVERSED: Fault = Fault {
    look: |memory, medium, t| medium.extinction(memory.support.from + (memory.support.to - t)),
    ..RIGHT
};

/// `σ_t(h⌊t/h⌋)`.
const ON_RASTER: Fault = Fault {
    look: |memory, medium, t| {
        let cell = memory.support.length() / 16.0;
        let from = memory.support.from;
        medium.extinction(from + ((t - from) / cell).floor() * cell)
    },
    ..RIGHT
};

/// `0.8 σ_t(t)`.
pub const OF_ANOTHER_CHANNEL: Fault =
    Fault { look: |_, medium, t| 0.8 * medium.extinction(t), ..RIGHT };
