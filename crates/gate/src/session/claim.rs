//! Claims about the draws of one value, settings of the verdict, and the quantities that follow from both.

use std::error::Error;
use std::fmt;

use super::Until;
use super::flights::RayFlights;
use super::quantity::{
    MEAN_CAP, Quantity, USUAL, VARIANCE_CAP, VarianceBound, mean_floor, variance_floor,
    variance_of_squares,
};
use crate::deviation::DrawUnit;
use crate::stats::gate::Design;
use crate::stats::verdict::{BLOCK, FURTHEST};
use numeric::digits::number;

/// Default rounding error of each draw, relative to the truth: a product of a hundred factors.
pub const ROUNDING: f64 = 16.0 * f64::EPSILON * 100.0;

/// Claim on correct draws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Claim {
    /// The mean of a correct draw.
    pub truth: f64,
    /// A bound on the error of the truth.
    pub truth_error: f64,
    /// u: the unit of the mean's tolerance. For a truth of 0 it is 1.
    pub unit: f64,
    /// The variance of a correct draw, if it is known.
    pub variance: Option<f64>,
    /// A relative error bound of the variance.
    pub variance_error: f64,
    /// The kurtosis of a correct draw (3 for the normal distribution), if it is known. Without a variance it is an
    /// upper bound.
    pub kurtosis: Option<f64>,
    /// Range of correct draws, if it is known; either end may be infinite.
    pub range: Option<[f64; 2]>,
    /// The number of lookups of a correct draw, if it is judged.
    pub lookups: Option<Lookups>,
    /// Rounding error of each draw, relative to the truth; absolute for a truth of 0.
    pub rounding: f64,
    /// The ray of free flights, if draws are their lengths.
    pub flights: Option<RayFlights>,
}

/// Claim on the number of lookups of a draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lookups {
    /// The mean.
    pub mean: f64,
    /// The variance, if it is known.
    pub variance: Option<f64>,
    /// A relative error bound of both.
    pub error: f64,
}

impl Lookups {
    /// Returns whether every draw takes the same number.
    pub fn is_fixed(&self) -> bool {
        self.variance == Some(0.0)
    }
}

/// Reason why a claim is invalid.
#[derive(Debug)]
#[non_exhaustive]
pub enum ClaimError {
    /// A number is not finite, or out of bounds.
    Number {
        /// The property.
        what: &'static str,
        /// The number.
        value: f64,
        /// Valid numbers in words.
        expected: &'static str,
    },
    /// The range is empty, or the truth is outside.
    Range {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
        /// The truth.
        truth: f64,
    },
    /// No distribution in the range has that variance.
    TooSpread {
        /// The variance.
        variance: f64,
        /// The truth.
        truth: f64,
        /// Largest variance in the range.
        maximum: f64,
    },
    /// The truth is 0, and no tolerance is given.
    NoUnit,
    /// The tolerance is below 4 times the rounding error and the claim's own error.
    Unresolved {
        /// The quantity.
        what: &'static str,
        /// ε.
        tolerance: f64,
        /// δ.
        floor: f64,
    },
    /// A tolerance is given for a variance that is not tested, for the reason in words.
    NoVariance(&'static str),
}

impl Error for ClaimError {}

impl fmt::Display for ClaimError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Number { what, value, expected } => {
                write!(f, "{what} = {} is not {expected}; give another", number(*value))
            }
            Self::Range { low, high, truth } => {
                let why = if low < high {
                    format!("does not have the truth {} inside", number(*truth))
                } else {
                    "is empty".to_owned()
                };
                let (low, high) = (number(*low), number(*high));
                write!(f, "a range of {low} to {high} {why}; give a range around the truth")
            }
            Self::TooSpread { variance, truth, maximum } => write!(
                f,
                "a variance of {variance:e} is impossible in the range: with the mean {truth:e} it is {maximum:e} at most; \
                 mend one of them"
            ),
            Self::NoUnit => f.write_str(
                "a truth of 0 has no relative tolerance; give a tolerance, which is then absolute",
            ),
            Self::Unresolved { what, tolerance, floor } => write!(
                f,
                "a tolerance of {tolerance:e} for the {what} is below 4 times what rounding and the claim's own error may \
                 add, {floor:.1e}; give a wider tolerance or a smaller rounding"
            ),
            Self::NoVariance(why) => {
                write!(
                    f,
                    "a tolerance of the variance, but no variance is tested: {why}; leave it out"
                )
            }
        }
    }
}

impl Claim {
    /// A claim about the mean alone, exact and without rounding. The unit of its tolerance is |T|, or 1 for T = 0.
    pub fn of_truth(truth: f64) -> Self {
        Self {
            truth,
            truth_error: 0.0,
            unit: if truth == 0.0 { 1.0 } else { truth.abs() },
            variance: None,
            variance_error: 0.0,
            kurtosis: None,
            range: None,
            lookups: None,
            rounding: 0.0,
            flights: None,
        }
    }

    /// Returns the claim after checking that its numbers are valid and consistent.
    ///
    /// # Errors
    ///
    /// A number is not finite, or is negative where it must not be; or a range is inconsistent with the truth or
    /// the variance.
    pub fn validated(self) -> Result<Self, ClaimError> {
        let check = |what, value: f64, minimum: f64, expected| {
            let is_fine = value.is_finite() && value >= minimum;
            if is_fine { Ok(()) } else { Err(ClaimError::Number { what, value, expected }) }
        };
        check("truth", self.truth, f64::NEG_INFINITY, "a finite number")?;
        check("rounding", self.rounding, 0.0, "a finite number, 0 or more")?;
        check("variance", self.variance.unwrap_or(0.0), 0.0, "a finite number, 0 or more")?;
        check("kurtosis", self.kurtosis.unwrap_or(1.0), 1.0, "a finite number, 1 or more")?;
        if let Some(Lookups { mean, variance, .. }) = self.lookups {
            check("expected lookups", mean, f64::MIN_POSITIVE, "a finite number above 0")?;
            let variance = variance.unwrap_or(0.0);
            check("lookups variance", variance, 0.0, "a finite number, 0 or more")?;
        }
        self.within(self.range)
    }

    /// Returns the claim with a range.
    ///
    /// # Errors
    ///
    /// The truth is outside, or the variance is larger than any in the range.
    pub fn within(self, range: Option<[f64; 2]>) -> Result<Self, ClaimError> {
        let Some([low, high]) = range else { return Ok(self) };
        let (truth, variance) = (self.truth, self.variance.unwrap_or(0.0));
        if !(low < truth && truth < high) {
            return Err(ClaimError::Range { low, high, truth });
        }
        // R. Bhatia, C. Davis, A better bound on the variance, American Mathematical Monthly 107 (2000).
        // By roots, since squares of small numbers underflow.
        let maximum = (high - truth).sqrt() * (truth - low).sqrt();
        if (variance * (1.0 - self.variance_error)).sqrt() > maximum * (1.0 + 1e-9) {
            let maximum = maximum * maximum;
            return Err(ClaimError::TooSpread { variance, truth, maximum });
        }
        Ok(Self { range, ..self })
    }

    /// Returns this claim's numbers with the mean of another one: only the mean is taken from theory.
    #[must_use]
    pub fn about(self, theory: Self) -> Self {
        let Self { variance, kurtosis, lookups, .. } = self;
        Self { variance, variance_error: 0.0, kurtosis, lookups, ..theory }
    }

    /// δ of the mean, in units of u.
    pub(super) fn floor(&self) -> f64 {
        mean_floor(self.truth_error, self.rounding_of_draw(), self.unit)
    }

    /// The range, widened by the rounding error at each end.
    pub(super) fn widened(&self) -> Option<[f64; 2]> {
        let slack = |end: f64| {
            let near = self.rounding * if end.is_finite() { end.abs() } else { 0.0 };
            near.max(self.floor() * self.unit)
        };
        self.range.map(|[low, high]| [low - slack(low), high + slack(high)])
    }

    /// Rounding error of a draw.
    fn rounding_of_draw(&self) -> f64 {
        self.rounding * if self.truth == 0.0 { 1.0 } else { self.truth.abs() }
    }

    /// δ of the variance, relative to it.
    pub(super) fn variance_floor(&self, variance: f64) -> f64 {
        variance_floor(variance, self.variance_error, self.rounding_of_draw())
    }
}

/// Number of draws that are read at a time: a block.
#[allow(clippy::cast_possible_truncation)] // 2¹⁴
pub const BUFFER: usize = BLOCK as usize;

/// Settings of the verdict.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// ε of the mean, in units of u.
    pub tolerance: Option<f64>,
    /// ε of the variance, relative to it.
    pub variance_tolerance: Option<f64>,
    /// Probability that correct draws fail.
    pub alpha: f64,
    /// Number of consecutive draws that are averaged before they are judged; the claim is then about averages.
    pub batch: u64,
    /// True to stop reading as soon as all is decided.
    pub stop_early: bool,
    /// Largest number of draws that are read.
    pub maximum: Option<u64>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: None,
            variance_tolerance: None,
            alpha: 1e-3,
            batch: 1,
            stop_early: false,
            maximum: None,
        }
    }
}

impl Options {
    /// End of the draws that are taken from a source.
    pub fn until(&self) -> Until {
        Until { maximum: self.maximum, is_decided: self.stop_early }
    }
}

/// Checks that α is a probability between 0 and 1.
pub(super) fn check_alpha(value: f64) -> Result<(), ClaimError> {
    let (what, expected) = ("alpha", "a probability above 0 and below 1");
    let is_fine = value > 0.0 && value < 1.0;
    if is_fine { Ok(()) } else { Err(ClaimError::Number { what, value, expected }) }
}

/// A claim with the settings of the verdict, ready for draws.
#[derive(Debug, Clone, Copy)]
pub struct CheckedClaim {
    /// Claim on a draw.
    pub claim: Claim,
    /// Error rate, tolerances and number of draws.
    pub options: Options,
    /// Number of draws, if known.
    pub length: Option<u64>,
}

impl CheckedClaim {
    /// Checks the settings before anything is read; `length` is the number of draws, if known.
    ///
    /// # Errors
    ///
    /// A tolerance, a number of draws or α is invalid for this claim.
    pub fn new(claim: Claim, options: Options, length: Option<u64>) -> Result<Self, ClaimError> {
        let positive = |what, value: Option<f64>| match value {
            Some(value) if !(value > 0.0 && value.is_finite()) => {
                Err(ClaimError::Number { what, value, expected: "a finite number above 0" })
            }
            _ => Ok(()),
        };
        positive("tolerance", options.tolerance)?;
        positive("variance tolerance", options.variance_tolerance)?;
        positive("batch", Some(options.batch as f64))?;
        positive("number of draws", options.maximum.map(|maximum| maximum as f64))?;
        check_alpha(options.alpha)?;
        let trial = Self { claim, options, length };
        if options.variance_tolerance.is_some() {
            let why = match claim.variance {
                None => Some("none is claimed"),
                Some(_) if trial.is_certain() || trial.is_faint() => Some("rounding hides it"),
                Some(_) => None,
            };
            why.map_or(Ok(()), |why| Err(ClaimError::NoVariance(why)))?;
        }
        if claim.truth == 0.0 && options.tolerance.is_none() && !trial.is_certain() {
            return Err(ClaimError::NoUnit);
        }
        let blurred = |what, tolerance: Option<f64>, floor: f64| match tolerance {
            Some(tolerance) if tolerance < 4.0 * floor && !trial.is_certain() => {
                Err(ClaimError::Unresolved { what, tolerance, floor })
            }
            _ => Ok(()),
        };
        blurred("mean", options.tolerance, claim.floor())?;
        // Without a tolerance from the caller, one above the cap would be chosen.
        if options.tolerance.is_none() && claim.truth != 0.0 {
            blurred("mean", Some(MEAN_CAP), claim.floor())?;
        }
        if let Some(variance) = claim.variance.filter(|&variance| variance > 0.0) {
            blurred("variance", options.variance_tolerance, claim.variance_floor(variance))?;
        }
        Ok(trial)
    }

    /// √V in units of u, by the claim.
    pub(super) fn deviation(&self) -> Option<f64> {
        self.claim.variance.map(|variance| variance.sqrt() / self.claim.unit)
    }

    /// Returns whether the claimed variance of the draws is 0, to rounding.
    pub(super) fn is_certain(&self) -> bool {
        self.deviation().is_some_and(|deviation| FURTHEST * deviation <= self.claim.floor())
    }

    /// Returns whether rounding hides the variance: it cannot be tested even to its largest tolerance.
    pub(super) fn is_faint(&self) -> bool {
        let variance = self.claim.variance.filter(|&variance| variance > 0.0);
        variance.is_some_and(|v| self.claim.variance_floor(v) > 0.25 * VARIANCE_CAP)
    }

    /// Maximum deviation of a draw where the claimed variance is 0, in units of u.
    pub(super) fn bound(&self) -> f64 {
        self.claim.floor() + FURTHEST * self.deviation().unwrap_or(0.0)
    }

    /// Quantities that can be judged with this claim.
    pub(super) fn quantities(&self) -> Vec<Quantity> {
        let Self { claim, options, .. } = self;
        let unit = if options.batch > 1 { DrawUnit::Averages } else { DrawUnit::Draws };
        let is_bounded = claim.range.is_some_and(|[low, high]| (high - low).is_finite());
        let mut quantities = Vec::new();
        if !self.is_certain() {
            let known = claim.variance.map(|v| v / claim.unit / claim.unit);
            let known = known.map(|v| VarianceBound::Variance(v * (1.0 + claim.variance_error)));
            let promised = claim.kurtosis.map(VarianceBound::Kurtosis);
            // The variance of the draws themselves is no ground to fail.
            let ground = known.or(promised).or((!is_bounded).then_some(VarianceBound::Shown));
            let in_units = |end: f64| (end - claim.truth) / claim.unit;
            let mean = Quantity::mean(ground, claim.floor()).within(options.tolerance);
            let range = claim.widened().map(|range| range.map(in_units));
            quantities.push(Quantity { range, unit, ..mean.of(claim.truth, claim.unit) });
        }
        let is_tested = |&v: &f64| v > 0.0 && !self.is_faint() && !self.is_certain();
        if let Some(variance) = claim.variance.filter(is_tested) {
            let known = claim.kurtosis.map(|kurtosis| {
                VarianceBound::Variance(variance_of_squares(kurtosis, claim.variance_error))
            });
            let furthest = claim.widened().map_or(f64::INFINITY, |range| {
                range
                    .map(|end| (end - claim.truth) / variance.sqrt())
                    .into_iter()
                    .fold(0.0, |maximum: f64, end| maximum.max(end * end))
            });
            let ground = known.or((!is_bounded).then_some(VarianceBound::Shown));
            let quantity = Quantity::variance(ground, claim.variance_floor(variance));
            quantities.push(Quantity {
                // A square is never negative: the variance may be refuted as too large without any other claim.
                range: (is_bounded || known.is_none()).then_some([-1.0, furthest - 1.0]),
                unit,
                ..quantity.within(options.variance_tolerance).of(variance, variance)
            });
        }
        if let Some(claimed) = claim.lookups.filter(|claimed| !claimed.is_fixed()) {
            let relative = |v: f64| v / (claimed.mean * claimed.mean) * (1.0 + claimed.error);
            let ground = claimed
                .variance
                .map_or(VarianceBound::Shown, |v| VarianceBound::Variance(relative(v)));
            quantities.push(Quantity {
                range: (ground == VarianceBound::Shown).then_some([-1.0, f64::INFINITY]),
                unit,
                ..Quantity::lookups(Some(ground), claimed.error).of(claimed.mean, claimed.mean)
            });
        }
        quantities
    }

    /// n: the number of draws that the given tolerances need, at most those that exist.
    pub(super) fn planned(quantities: &[Quantity], length: Option<u64>) -> Option<f64> {
        let needs = |quantity: &Quantity, design: fn(f64, f64, f64) -> Design, tolerance: f64| {
            let variance = quantity.known_variance().filter(|&variance| variance > 0.0)?;
            Some(design(variance, tolerance, 0.0).draws())
        };
        let length = length.map(|length| length as f64);
        let requested = quantities.iter().filter_map(|q| needs(q, Design::asked, q.tolerance?));
        match requested.reduce(f64::max) {
            Some(needed) => Some(length.map_or(needed, |length| needed.min(length))),
            None => length.or_else(|| needs(quantities.first()?, Design::new, USUAL)),
        }
    }
}
