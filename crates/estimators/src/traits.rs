//! Properties of an estimator that depend neither on its problem nor on what it works on.

use crate::recipes::controls;
use theory::collisions::Collisions;

/// Inputs of an estimator beside the medium.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Inputs {
    /// A sampling extinction σ̂.
    pub sampling: bool,
    /// A control σ_c, if one is given.
    pub control: bool,
}

impl Inputs {
    /// No input.
    pub const NONE: Self = Self { sampling: false, control: false };
    /// σ̂ only.
    pub const SAMPLING: Self = Self { sampling: true, control: false };
    /// σ̂ and a control.
    pub const BOTH: Self = Self { sampling: true, control: true };
}

/// Knowledge of a medium beside lookups, which an estimator, σ̂ or a control needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Knowledge {
    /// The optical depth τ.
    OpticalDepth,
    /// The distance at which the optical depth has a given value.
    InverseDepth,
    /// The minimum of σ_t.
    Minimum,
    /// The maximum of |σ_t − σ_c| on parts of a ray.
    LocalMaxima,
    /// Bounds of σ_t in the cells of a grid.
    Bounds,
}

impl Knowledge {
    /// Returns whether the answer follows from it.
    pub fn has_the_answer(self) -> bool {
        matches!(self, Self::OpticalDepth | Self::InverseDepth)
    }

    /// Returns several in words, as in `τ, max |σ_t − σ_c|`.
    pub fn list(all: &[Self]) -> String {
        all.iter().map(|one| one.words()).collect::<Vec<_>>().join(", ")
    }

    /// Returns the quantity as tables name it.
    pub fn words(self) -> &'static str {
        match self {
            Self::OpticalDepth => "τ",
            Self::InverseDepth => "inverse of τ",
            Self::Minimum => "min σ_t",
            Self::LocalMaxima => "max |σ_t − σ_c|",
            Self::Bounds => "bounds of σ_t",
        }
    }
}

/// Properties of an estimator with its own settings.
pub struct Traits {
    /// Inputs that it takes.
    pub inputs: Inputs,
    /// Inputs that it takes with some settings; with others they are read and not used.
    pub may_take: Inputs,
    /// Its own settings in words, such as `non-terminating`, without the albedo; empty if it has none.
    pub settings: String,
    /// Its albedo, if it has one: a sweep may change it.
    pub albedo: Option<f64>,
    /// Name of the estimator that it equals by definition where it has no control.
    pub without_control: Option<&'static str>,
    /// The control that it uses where the case gives none.
    pub default_control: Option<Box<dyn controls::Recipe>>,
    /// Rule at a collision, if a draw is a product of its factors.
    pub collisions: Option<Collisions>,
    /// Knowledge of the medium that it needs beside lookups, σ̂ and control.
    pub needs: Option<Knowledge>,
    /// True if draws have a [`Draw::defect`](crate::Draw::defect).
    pub has_invariant: bool,
    /// True if σ̂ may be 0 wherever the residual is: collisions there affect only the cost.
    pub skips: bool,
}

impl Traits {
    /// Properties of an estimator of some inputs that has no others.
    pub fn of(inputs: Inputs) -> Self {
        Self {
            inputs,
            may_take: inputs,
            settings: String::new(),
            albedo: None,
            without_control: None,
            default_control: None,
            collisions: None,
            needs: None,
            has_invariant: false,
            skips: false,
        }
    }

    /// Properties of a product over collisions of a factor that depends on the residual.
    pub fn product(inputs: Inputs) -> Self {
        Self { has_invariant: true, skips: true, ..Self::of(inputs) }
    }

    /// Returns the settings in words, with the albedo or without it, as in `non-terminating, a=0.7`.
    pub fn label(&self, with_albedo: bool) -> String {
        match self.albedo.filter(|_| with_albedo) {
            Some(albedo) => format!("{}, a={albedo}", self.settings),
            None => self.settings.clone(),
        }
    }
}
