//! Claims with what is wanted of the verdict, and the quantities that follow from them.

use super::claim::{Claim, ClaimError};
use super::drive::Until;
use super::quantity::{Ground, MEAN_CAP, Quantity, USUAL, VARIANCE_CAP, variance_of_squares};
use crate::stats::gate::Design;
use crate::stats::verdict::{BLOCK, FURTHEST};

/// Number of draws that are read at a time: a block.
#[allow(clippy::cast_possible_truncation)] // 2¹⁴
pub const BUFFER: usize = BLOCK as usize;

/// What is wanted of the verdict.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// ε of the mean, in units of u.
    pub tolerance: Option<f64>,
    /// ε of the variance, relative to it.
    pub variance_tolerance: Option<f64>,
    /// Probability that correct draws fail.
    pub alpha: f64,
    /// Number of consecutive draws that are averaged before they are judged; the claim is then of averages.
    pub batch: u64,
    /// Whether to stop reading as soon as all is decided.
    pub stop_early: bool,
    /// Largest number of draws that are read.
    pub most: Option<u64>,
}

impl Default for Wanted {
    fn default() -> Self {
        Self {
            tolerance: None,
            variance_tolerance: None,
            alpha: 1e-3,
            batch: 1,
            stop_early: false,
            most: None,
        }
    }
}

impl Wanted {
    /// End of the draws that are taken from a source.
    pub fn until(&self) -> Until {
        Until { most: self.most, is_decided: self.stop_early }
    }
}

/// Whether α is a probability between 0 and 1.
pub(super) fn check_alpha(value: f64) -> Result<(), ClaimError> {
    let (what, wanted) = ("alpha", "a probability above 0 and below 1");
    let is_fine = value > 0.0 && value < 1.0;
    if is_fine { Ok(()) } else { Err(ClaimError::Number { what, value, wanted }) }
}

/// A claim with what is wanted, ready for draws.
#[derive(Debug, Clone, Copy)]
pub struct Trial {
    /// What is claimed of a draw.
    pub claim: Claim,
    /// Error rate, tolerances and number of draws.
    pub wanted: Wanted,
    /// Number of draws, if known.
    pub length: Option<u64>,
}

impl Trial {
    /// Checks what is wanted before anything is read; `length` is the number of draws, if known.
    ///
    /// # Errors
    ///
    /// A tolerance, a number of draws or α makes no sense for this claim.
    pub fn new(claim: Claim, wanted: Wanted, length: Option<u64>) -> Result<Self, ClaimError> {
        let positive = |what, value: Option<f64>| match value {
            Some(value) if !(value > 0.0 && value.is_finite()) => {
                Err(ClaimError::Number { what, value, wanted: "a finite number above 0" })
            }
            _ => Ok(()),
        };
        positive("tolerance", wanted.tolerance)?;
        positive("variance tolerance", wanted.variance_tolerance)?;
        positive("batch", Some(wanted.batch as f64))?;
        positive("number of draws", wanted.most.map(|most| most as f64))?;
        check_alpha(wanted.alpha)?;
        let trial = Self { claim, wanted, length };
        if wanted.variance_tolerance.is_some() {
            let why = match claim.variance {
                None => Some("none is claimed"),
                Some(_) if trial.is_certain() || trial.is_faint() => Some("rounding hides it"),
                Some(_) => None,
            };
            why.map_or(Ok(()), |why| Err(ClaimError::NoVariance { why }))?;
        }
        if claim.truth == 0.0 && wanted.tolerance.is_none() && !trial.is_certain() {
            return Err(ClaimError::NoUnit);
        }
        let blurred = |what, tolerance: Option<f64>, floor: f64| match tolerance {
            Some(tolerance) if tolerance < 4.0 * floor && !trial.is_certain() => {
                Err(ClaimError::Blurred { what, tolerance, floor })
            }
            _ => Ok(()),
        };
        blurred("mean", wanted.tolerance, claim.floor())?;
        // Without a tolerance of the caller's, one above the cap would be chosen.
        if wanted.tolerance.is_none() && claim.truth != 0.0 {
            blurred("mean", Some(MEAN_CAP), claim.floor())?;
        }
        if let Some(variance) = claim.variance.filter(|&variance| variance > 0.0) {
            blurred("variance", wanted.variance_tolerance, claim.variance_floor(variance))?;
        }
        Ok(trial)
    }

    /// √V in units of u, by the claim.
    pub(super) fn deviation(&self) -> Option<f64> {
        self.claim.variance.map(|variance| variance.sqrt() / self.claim.unit)
    }

    /// Whether the draws have no spread, by the claim.
    pub(super) fn is_certain(&self) -> bool {
        self.deviation().is_some_and(|deviation| FURTHEST * deviation <= self.claim.floor())
    }

    /// Whether rounding hides what the spread says: the variance cannot be tested to its widest tolerance.
    pub(super) fn is_faint(&self) -> bool {
        let variance = self.claim.variance.filter(|&variance| variance > 0.0);
        variance.is_some_and(|v| self.claim.variance_floor(v) > 0.25 * VARIANCE_CAP)
    }

    /// Largest deviation of a draw of a claim without spread, in units of u.
    pub(super) fn bound(&self) -> f64 {
        self.claim.floor() + FURTHEST * self.deviation().unwrap_or(0.0)
    }

    /// Quantities that the claim allows to judge.
    pub(super) fn quantities(&self) -> Vec<Quantity> {
        let Self { claim, wanted, .. } = self;
        let unit = if wanted.batch > 1 { "averages" } else { "draws" };
        let is_bounded = claim.range.is_some_and(|[low, high]| (high - low).is_finite());
        let mut quantities = Vec::new();
        if !self.is_certain() {
            let known = claim.variance.map(|v| v / claim.unit / claim.unit);
            let known = known.map(|v| Ground::Variance(v * (1.0 + claim.variance_error)));
            let promised = claim.kurtosis.map(Ground::Kurtosis);
            // The spread that draws show is no ground to fail.
            let ground = known.or(promised).or((!is_bounded).then_some(Ground::Shown));
            let in_units = |end: f64| (end - claim.truth) / claim.unit;
            let mean = Quantity::mean(ground, claim.floor()).within(wanted.tolerance);
            let range = claim.widened().map(|range| range.map(in_units));
            quantities.push(Quantity { range, unit, ..mean.of(claim.truth, claim.unit) });
        }
        let is_tested = |&v: &f64| v > 0.0 && !self.is_faint() && !self.is_certain();
        if let Some(variance) = claim.variance.filter(is_tested) {
            let known = claim.kurtosis.map(|kurtosis| {
                Ground::Variance(variance_of_squares(kurtosis, claim.variance_error))
            });
            let furthest = claim.widened().map_or(f64::INFINITY, |range| {
                range
                    .map(|end| (end - claim.truth) / variance.sqrt())
                    .into_iter()
                    .fold(0.0, |most: f64, end| most.max(end * end))
            });
            let ground = known.or((!is_bounded).then_some(Ground::Shown));
            let quantity = Quantity::variance(ground, claim.variance_floor(variance));
            quantities.push(Quantity {
                // A square is never negative: it may be refuted as too large without any promise.
                range: (is_bounded || known.is_none()).then_some([-1.0, furthest - 1.0]),
                unit,
                ..quantity.within(wanted.variance_tolerance).of(variance, variance)
            });
        }
        if let Some(claimed) = claim.lookups.filter(|claimed| !claimed.is_fixed()) {
            let relative = |v: f64| v / (claimed.mean * claimed.mean) * (1.0 + claimed.error);
            let ground = claimed.variance.map_or(Ground::Shown, |v| Ground::Variance(relative(v)));
            quantities.push(Quantity {
                range: (ground == Ground::Shown).then_some([-1.0, f64::INFINITY]),
                unit,
                ..Quantity::lookups(Some(ground), claimed.error).of(claimed.mean, claimed.mean)
            });
        }
        quantities
    }

    /// n: the draws that the tolerances asked for need, at most those that there are.
    pub(super) fn planned(quantities: &[Quantity], length: Option<u64>) -> Option<f64> {
        let needs = |quantity: &Quantity, design: fn(f64, f64, f64) -> Design, tolerance: f64| {
            let variance = quantity.known_variance().filter(|&variance| variance > 0.0)?;
            Some(design(variance, tolerance, 0.0).draws())
        };
        let length = length.map(|length| length as f64);
        let asked = quantities.iter().filter_map(|q| needs(q, Design::asked, q.tolerance?));
        match asked.reduce(f64::max) {
            Some(needed) => Some(length.map_or(needed, |length| needed.min(length))),
            None => length.or_else(|| needs(quantities.first()?, Design::new, USUAL)),
        }
    }
}
