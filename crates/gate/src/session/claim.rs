//! Claims about the draws of one value: by numbers, or by theory for an experiment of a case.

use super::flights::Flights;
use super::quantity::{mean_floor, variance_floor};
use numeric::digits::number;

/// What rounding may add to each draw, relative to the truth, where the caller does not say: a
/// product of a hundred factors.
pub const ROUNDING: f64 = 16.0 * f64::EPSILON * 100.0;

/// Claim on correct draws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Claim {
    /// The mean of a correct draw.
    pub truth: f64,
    /// A bound on the truth's own error.
    pub truth_error: f64,
    /// u: what the tolerance of the mean is relative to. For a truth of 0 it is 1.
    pub unit: f64,
    /// The variance of a correct draw, if it is known.
    pub variance: Option<f64>,
    /// A relative error bound of that.
    pub variance_error: f64,
    /// The kurtosis of a correct draw (3 for the normal law), if it is known; where the variance is
    /// not, an upper bound of it.
    pub kurtosis: Option<f64>,
    /// Where correct draws lie, if it is known; either end may be infinite.
    pub range: Option<[f64; 2]>,
    /// The number of lookups of a correct draw, if it is to be judged.
    pub lookups: Option<Lookups>,
    /// What rounding may add to each draw, relative to the truth; absolute for a truth of 0.
    pub rounding: f64,
    /// The ray of free flights, where draws are their lengths.
    pub flights: Option<Flights>,
}

/// What is claimed of the number of lookups of a draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lookups {
    /// Its mean.
    pub mean: f64,
    /// Its variance, if it is known.
    pub variance: Option<f64>,
    /// A relative error bound of both.
    pub error: f64,
}

impl Lookups {
    /// Whether every draw takes the same number.
    pub fn is_fixed(&self) -> bool {
        self.variance == Some(0.0)
    }
}

/// A claim that makes no sense.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs)] // messages name the fields
pub enum ClaimError {
    /// Not a finite number, or negative where it must not be.
    #[error("{what} = {} is not {wanted}; give another", number(*value))]
    Number { what: &'static str, value: f64, wanted: &'static str },
    /// A range that does not hold the truth inside.
    #[error(
        "a range of {} to {} {}; give a range around the truth",
        number(*low),
        number(*high),
        if low < high { format!("does not have the truth {} inside", number(*truth)) } else { "is empty".to_owned() }
    )]
    Range { low: f64, high: f64, truth: f64 },
    /// A variance that no draws in the range have.
    #[error(
        "a variance of {variance:e} is impossible in the range: with the mean {truth:e} it is \
         {most:e} at most; mend one of them"
    )]
    TooSpread { variance: f64, truth: f64, most: f64 },
    /// A truth of 0 without a tolerance.
    #[error("a truth of 0 has no relative tolerance; give a tolerance, which is then absolute")]
    NoUnit,
    /// A tolerance that rounding would eat.
    #[error(
        "a tolerance of {tolerance:e} for the {what} is below 4 times what rounding and the claim's \
         own error may add, {floor:.1e}; give a wider tolerance or a smaller rounding"
    )]
    Blurred { what: &'static str, tolerance: f64, floor: f64 },
    /// A tolerance of a variance that is not tested.
    #[error("a tolerance of the variance, but no variance is tested: {why}; leave it out")]
    NoVariance { why: &'static str },
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

    /// The claim, once all its numbers make sense and go with each other.
    ///
    /// # Errors
    ///
    /// A number is not finite, or is negative where it must not be; or a range does not go with the truth or the
    /// variance.
    pub fn validated(self) -> Result<Self, ClaimError> {
        let check = |what, value: f64, least: f64, wanted| {
            let is_fine = value.is_finite() && value >= least;
            if is_fine { Ok(()) } else { Err(ClaimError::Number { what, value, wanted }) }
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
    /// The truth is not inside, or the variance is larger than any in the range.
    pub fn within(self, range: Option<[f64; 2]>) -> Result<Self, ClaimError> {
        let Some([low, high]) = range else { return Ok(self) };
        let (truth, variance) = (self.truth, self.variance.unwrap_or(0.0));
        if !(low < truth && truth < high) {
            return Err(ClaimError::Range { low, high, truth });
        }
        // R. Bhatia, C. Davis, A better bound on the variance, American Mathematical Monthly 107 (2000).
        // By roots, since squares of small numbers underflow.
        let most = (high - truth).sqrt() * (truth - low).sqrt();
        if (variance * (1.0 - self.variance_error)).sqrt() > most * (1.0 + 1e-9) {
            let most = most * most;
            return Err(ClaimError::TooSpread { variance, truth, most });
        }
        Ok(Self { range, ..self })
    }

    /// The numbers of this claim about the mean of another: of theory only the mean is taken.
    #[must_use]
    pub fn about(self, theory: Self) -> Self {
        let Self { variance, kurtosis, lookups, .. } = self;
        Self { variance, variance_error: 0.0, kurtosis, lookups, ..theory }
    }

    /// δ of the mean, in units of u.
    pub(super) fn floor(&self) -> f64 {
        mean_floor(self.truth_error, self.rounding_of_draw(), self.unit)
    }

    /// The range with what rounding may add at each end.
    pub(super) fn widened(&self) -> Option<[f64; 2]> {
        let slack = |end: f64| {
            let near = self.rounding * if end.is_finite() { end.abs() } else { 0.0 };
            near.max(self.floor() * self.unit)
        };
        self.range.map(|[low, high]| [low - slack(low), high + slack(high)])
    }

    /// What rounding may add to a draw.
    fn rounding_of_draw(&self) -> f64 {
        self.rounding * if self.truth == 0.0 { 1.0 } else { self.truth.abs() }
    }

    /// δ of the variance, relative to it.
    pub(super) fn variance_floor(&self, variance: f64) -> f64 {
        variance_floor(variance, self.variance_error, self.rounding_of_draw())
    }
}
