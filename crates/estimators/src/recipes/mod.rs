//! Recipes for the sampling extinction σ̂ and for the control σ_c: how a case's words become fields.

pub mod controls;
pub mod sampling;

use std::borrow::Cow;

use media::Body;
use media::catalogue::Settings;
use numeric::digits::rounded;
use numeric::rng::Address;
use theory::Mesh;
use theory::collisions::particle::RatioRange;

/// Input of a recipe for a sampling extinction or a control.
#[derive(Clone, Copy)]
pub struct Site<'a> {
    /// The field as the case gives it.
    pub body: &'a Body,
    /// The medium, cut into panels.
    pub mesh: &'a Mesh,
    /// Address of the random numbers of pilot rays.
    pub address: Address,
}

/// Reason why an estimator is not run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Refusal {
    /// An inequality that the estimator needs does not hold.
    #[error("needs {needs}, but {actual} at t = {}", rounded(*at))]
    Inequality {
        /// Inequality that must hold everywhere, in words.
        needs: Cow<'static, str>,
        /// Values that violate it, in words.
        actual: String,
        /// Distance along the ray at which they were found.
        at: f64,
    },
    /// The estimator does not fit what it was given.
    #[error("needs {needs}, but {actual}")]
    Mismatch {
        /// Input that the estimator takes, in words.
        needs: Cow<'static, str>,
        /// Input that it was given, in words.
        actual: String,
    },
}

impl Refusal {
    /// A mismatch in words.
    pub fn mismatch(needs: &'static str, actual: impl Into<String>) -> Self {
        Self::Mismatch { needs: needs.into(), actual: actual.into() }
    }
}

/// Inequality of the ratios for which a rule of collisions has probabilities, in words.
pub fn inequality(range: RatioRange) -> &'static str {
    match range {
        RatioRange::Terminating => "0 ≤ r ≤ 2/(a + 1)",
        RatioRange::Majorant => "0 ≤ σ_t ≤ σ̂",
        RatioRange::Every => "any σ̂",
    }
}

/// Recipe with settings in case files.
pub trait FromSettings: Sized {
    /// Settings to which its field is proportional, all together.
    const EXTINCTIONS: &'static [&'static str] = &[];

    /// Reads its own settings from `NAME = { … }`. The body is `None` after a mistake in it: checks that depend on it are
    /// skipped.
    fn read(settings: &Settings, body: Option<&Body>) -> Option<Self>;
}

/// Reader of a recipe `R`, for σ̂ or for σ_c.
pub struct RecipeReader<R: ?Sized> {
    extinctions: &'static [&'static str],
    read: fn(&Settings, Option<&Body>) -> Option<Box<R>>,
}
