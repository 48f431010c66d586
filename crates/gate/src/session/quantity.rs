//! Quantities that the gate judges: formula, grounds and tolerance of each.
//!
//! ```text
//! mean      y = (X − T)/u,       V = Var[X]/u²       δ = (error of T + rounding)/u              ε ≤ 5 %
//! variance  y = (X − T)²/V − 1,  V = κ − 1           δ = error of V + n(2 + n), n rounding/√V   ε ≤ 20 %
//! lookups   y = M/E[M] − 1,      V = Var[M]/E[M]²    δ = error of E[M]                          ε ≤ 2 %
//! ```
//!
//! y has mean 0 for correct draws. Other quantities of the same kind (a covariance, a step of a curve) differ by
//! their name and their largest tolerance.

use crate::CheckId;
use crate::deviation::DrawUnit;
use std::borrow::Cow;

use super::reason::Reason;
use crate::deviation::Deviation;
use crate::stats::gate::{HORIZON, PLANNED};

/// Largest tolerance of a mean that is chosen without a request.
pub const MEAN_CAP: f64 = 0.05;
/// Largest tolerance of a variance that is chosen without a request.
pub const VARIANCE_CAP: f64 = 0.2;
/// Largest tolerance of a number of lookups that is chosen without a request.
pub const LOOKUPS_CAP: f64 = 0.02;
/// Tolerance of a mean where neither the caller nor a number of draws sets it.
pub const USUAL: f64 = 0.01;

/// Known bound on the variance of a quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum VarianceBound {
    /// The variance, or an upper bound.
    Variance(#[cfg_attr(feature = "serde", serde(with = "crate::extended"))] f64),
    /// An upper bound of the kurtosis.
    Kurtosis(#[cfg_attr(feature = "serde", serde(with = "crate::extended"))] f64),
    /// The variance that the draws show. It is no ground to fail.
    Shown,
}

/// A quantity y of each draw with mean 0 for correct draws.
#[derive(Debug, Clone)]
pub struct Quantity {
    /// The check.
    pub check: CheckId,
    /// Name in a sentence: `the mean`.
    pub what: Cow<'static, str>,
    /// Known bound on its variance; `None` where only the range is used.
    pub ground: Option<VarianceBound>,
    /// Range of y, if it is known.
    pub range: Option<[f64; 2]>,
    /// ε, if the caller gives one.
    pub tolerance: Option<f64>,
    /// ε where neither the caller nor a number of draws sets it.
    pub usual: f64,
    /// Largest ε that is chosen without a request.
    pub cap: f64,
    /// δ: bound on the part of y's mean from rounding and the claim's own error.
    pub floor: f64,
    /// True if too few draws make it inconclusive, not underpowered.
    pub must_pass: bool,
    /// Value that y = 0 stands for, in units of the quantity.
    pub expected: f64,
    /// Size of y = 1 in units of the quantity.
    pub scale: f64,
    /// What is counted, in the plural.
    pub unit: DrawUnit,
}

impl Quantity {
    /// A quantity of a check, with a name in sentences, a bound on its variance, δ and the largest ε.
    pub fn new(
        check: CheckId,
        what: impl Into<Cow<'static, str>>,
        ground: Option<VarianceBound>,
        floor: f64,
        cap: f64,
    ) -> Self {
        Self {
            check,
            what: what.into(),
            ground,
            range: None,
            tolerance: None,
            usual: cap,
            cap,
            floor,
            must_pass: false,
            expected: 0.0,
            scale: 1.0,
            unit: DrawUnit::Draws,
        }
    }

    /// The mean of a draw about its expected value.
    pub fn mean(ground: Option<VarianceBound>, floor: f64) -> Self {
        let quantity = Self::new(CheckId::Mean, "the mean", ground, floor, MEAN_CAP);
        Self { usual: USUAL, must_pass: true, ..quantity }
    }

    /// The variance of a draw about its expected mean.
    pub fn variance(ground: Option<VarianceBound>, floor: f64) -> Self {
        Self::new(CheckId::Variance, "the variance", ground, floor, VARIANCE_CAP)
    }

    /// The number of lookups of a draw.
    pub fn lookups(ground: Option<VarianceBound>, floor: f64) -> Self {
        Self::new(CheckId::Lookups, "the number of lookups", ground, floor, LOOKUPS_CAP)
    }

    /// The quantity with a tolerance of the caller.
    #[must_use]
    pub fn within(self, tolerance: Option<f64>) -> Self {
        Self { tolerance, ..self }
    }

    /// The quantity in its own units: `expected + scale y` where y is measured.
    #[must_use]
    pub fn of(self, expected: f64, scale: f64) -> Self {
        Self { expected, scale, ..self }
    }

    /// Returns whether its ground lets it fail, and not only pass.
    pub fn is_hard(&self) -> bool {
        self.ground != Some(VarianceBound::Shown)
    }

    /// Deviation from the expected value, where y is `off` on average.
    pub(super) fn deviation(&self, off: f64, draws: u64) -> Deviation {
        let Self { expected, scale, unit, .. } = *self;
        Deviation { unit, ..Deviation::new(expected + scale * off, expected, draws) }
    }

    /// Reason where `draws` draws decide nothing about a tolerance that is planned for `planned` of them.
    pub(super) fn undecided(&self, draws: u64, tolerance: f64, planned: f64) -> Reason {
        let is_short = planned > draws as f64;
        let needed = if is_short { planned } else { planned * HORIZON / PLANNED };
        Reason::Undecided { what: self.what.clone(), draws, tolerance, needed }
    }

    /// V, if it is known.
    pub fn known_variance(&self) -> Option<f64> {
        match self.ground {
            Some(VarianceBound::Variance(variance)) => Some(variance),
            _ => None,
        }
    }
}

/// δ of a mean, relative to `unit`: the error of the truth and the rounding of a draw.
pub fn mean_floor(error: f64, rounding: f64, unit: f64) -> f64 {
    (error + rounding) / unit
}

/// δ of a variance, relative to it: its own error and the rounding of a draw.
pub fn variance_floor(variance: f64, error: f64, rounding: f64) -> f64 {
    let noise = rounding / variance.sqrt();
    error + noise * (2.0 + noise)
}

/// Upper bound of the variance of `(X − T)²/V − 1` for draws of kurtosis κ with moments known to a relative error.
///
/// The relative error of `κ = m₄/m₂²` is three times that of the moments, and that of κ − 1 is larger still. A
/// kurtosis of 1 is known to rounding only.
pub fn variance_of_squares(kurtosis: f64, error: f64) -> f64 {
    let excess = (kurtosis - 1.0).max(4.0 * f64::EPSILON);
    excess * (1.0 + error * (1.0 + 3.0 * kurtosis / excess))
}
