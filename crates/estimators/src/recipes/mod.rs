//! Recipes for the sampling extinction σ̂ and for the control σ_c: how a case's words become fields.

pub mod controls;
pub mod sampling;

use std::borrow::Cow;

use media::Body;
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
    #[error("needs {needs}, but {found} at t = {}", rounded(*at))]
    Inequality {
        /// Inequality that must hold everywhere, in words.
        needs: Cow<'static, str>,
        /// Values that violate it, in words.
        found: String,
        /// Distance along the ray at which they were found.
        at: f64,
    },
    /// The estimator does not fit what it was given.
    #[error("needs {needs}, but {found}")]
    Mismatch {
        /// Input that the estimator takes, in words.
        needs: Cow<'static, str>,
        /// Input that it was given, in words.
        found: String,
    },
}

impl Refusal {
    /// A mismatch in words.
    pub fn mismatch(needs: &'static str, found: impl Into<String>) -> Self {
        Self::Mismatch { needs: needs.into(), found: found.into() }
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

/// Lists recipes that prepare a sampling extinction or a control from its settings.
macro_rules! recipes {
    ($name:literal, $Trait:ident: $($module:ident :: $Page:ident,)*) => {
        /// Every recipe, in the order of registration.
        pub const CATALOGUE: media::catalogue::PageList = media::catalogue::PageList {
            name: $name,
            pages: &[$(media::page!($module)),*],
        };

        /// Settings of a named recipe that its field is proportional to; empty for an unknown recipe.
        pub fn extinctions(name: &str) -> &'static [&'static str] {
            let all: &[&'static [&'static str]] = &[$($module::$Page::EXTINCTIONS),*];
            let place = CATALOGUE.pages.iter().position(|page| page.name() == name);
            place.map_or(&[], |place| all[place])
        }

        /// Reads `NAME = { … }`. The body is `None` after a mistake in it: checks that depend on it are skipped.
        pub fn read(
            settings: &media::catalogue::Settings,
            body: Option<&media::Body>,
        ) -> Option<Box<dyn $Trait>> {
            let names: Vec<String> =
                CATALOGUE.pages.iter().map(media::catalogue::Page::name).collect();
            let (index, recipe) = settings.choice(&names)?;
            let readers = [$(
                |s: &media::catalogue::Settings, b: Option<&media::Body>| {
                    $module::$Page::read(s, b).map(|page| Box::new(page) as Box<dyn $Trait>)
                }
            ),*];
            let read = readers[index](&recipe, body);
            recipe.close();
            read
        }
    };
}
use recipes;
