//! What is claimed of another program's draws: by numbers, or by theory for an experiment of a case.

use super::flights::Flights;
use numeric::digits::number;
use numeric::digits::short;

/// What rounding may add to each draw, relative to the truth, where the caller does not say: a
/// product of a hundred factors.
pub const ROUNDING: f64 = 16.0 * f64::EPSILON * 100.0;

/// What correct draws are like.
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

/// A claim as it is given by numbers.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Given {
    /// See [`Claim::truth`].
    pub truth: f64,
    /// See [`Claim::variance`].
    pub variance: Option<f64>,
    /// See [`Claim::kurtosis`].
    pub kurtosis: Option<f64>,
    /// See [`Claim::range`].
    pub range: Option<[f64; 2]>,
    /// See [`Claim::lookups`].
    pub lookups: Option<Lookups>,
    /// See [`Claim::rounding`].
    pub rounding: f64,
}

/// A claim that makes no sense.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ClaimError {
    /// Not a finite number, or negative where it must not be.
    #[error("{what} = {} is not {wanted}; give another", number(*value))]
    Number {
        /// Which number.
        what: &'static str,
        /// What it is.
        value: f64,
        /// What it should be.
        wanted: &'static str,
    },
    /// A range that does not hold the truth inside.
    #[error(
        "a range of {} to {} {}; give a range around the truth",
        number(*low),
        number(*high),
        if low < high { format!("does not have the truth {} inside", number(*truth)) } else { "is empty".to_owned() }
    )]
    Range {
        /// Its lower end.
        low: f64,
        /// Its upper end.
        high: f64,
        /// The truth.
        truth: f64,
    },
    /// A variance that no draws in the range have.
    #[error(
        "a variance of {variance:e} is impossible in the range: with the mean {truth:e} it is \
         {most:e} at most; mend one of them"
    )]
    TooSpread {
        /// The variance.
        variance: f64,
        /// The truth.
        truth: f64,
        /// The largest variance, (high − T)(T − low).
        most: f64,
    },
    /// A truth of 0 without a tolerance.
    #[error("a truth of 0 has no relative tolerance; give a tolerance, which is then absolute")]
    NoUnit,
    /// A tolerance that rounding would eat.
    #[error(
        "a tolerance of {tolerance:e} for the {what} is below 4 times what rounding and the claim's \
         own error may add, {floor:.1e}; give a wider tolerance or a smaller rounding"
    )]
    Blurred {
        /// Which check.
        what: &'static str,
        /// What was asked.
        tolerance: f64,
        /// δ.
        floor: f64,
    },
    /// A tolerance of a variance that is not tested.
    #[error("a tolerance of the variance, but no variance is tested: {why}; leave it out")]
    NoVariance {
        /// Why it is not.
        why: &'static str,
    },
    /// No estimator of that name.
    #[error("{case}: no estimator is called `{name}`; choose one of: {}", candidates.join(", "))]
    NoEstimator {
        /// The case.
        case: String,
        /// The name asked for.
        name: String,
        /// The names that are there.
        candidates: Vec<String>,
    },
    /// Several estimators of that name.
    #[error("{case}: several estimators are called `{name}`; choose one of: {}", candidates.join(", "))]
    Ambiguous {
        /// The case.
        case: String,
        /// The name asked for.
        name: String,
        /// What the name may mean.
        candidates: Vec<String>,
    },
    /// A value of the sweep is missing, or is none.
    #[error(
        "{case}: `{estimator}` is swept over {what}: {}; say at which value your draws were made, by --swept (in Python \
         sampling=, elsewhere the last argument of `of`); any value will do that is {wanted}",
        list(values)
    )]
    Swept {
        /// The case.
        case: String,
        /// The estimator.
        estimator: String,
        /// What is swept.
        what: &'static str,
        /// The values.
        values: Vec<f64>,
        /// The values that it could have, in words.
        wanted: &'static str,
    },
    /// A value that the swept thing cannot have.
    #[error(
        "{case}: `{estimator}`: {what} = {} is not {wanted}{}",
        number(*value),
        near(*nearest)
    )]
    NoSuchValue {
        /// The case.
        case: String,
        /// The estimator.
        estimator: String,
        /// What is swept.
        what: &'static str,
        /// The value.
        value: f64,
        /// The values that it could have, in words.
        wanted: &'static str,
        /// The nearest value of the sweep.
        nearest: Option<f64>,
    },
    /// A value of a sweep where nothing is swept.
    #[error("{case}: `{estimator}` is not swept; leave the swept value and --nearest out")]
    NotSwept {
        /// The case.
        case: String,
        /// The estimator.
        estimator: String,
    },
    /// A draw has several values.
    #[error("{case}: a draw has {} channels; choose one of: {}", channels.len(), channels.join(", "))]
    Channel {
        /// The case.
        case: String,
        /// Their names.
        channels: Vec<String>,
    },
    /// Theory works in units of a transmittance that few doubles hold.
    #[error(
        "{case}: `{estimator}` sees an optical depth of {depth:.0}, where theory is in units of T; multiply the \
         draws by e^τ and give the truth 1 and what else is known of them by numbers"
    )]
    Deep {
        /// The case.
        case: String,
        /// The estimator.
        estimator: String,
        /// τ.
        depth: f64,
    },
    /// The experiment is refused.
    #[error(
        "{case}: `{estimator}` is refused: {why}{}",
        if nearest.is_some() { near(*nearest) } else { "; choose an estimator that is unbiased there".to_owned() }
    )]
    Refused {
        /// The case.
        case: String,
        /// The estimator.
        estimator: String,
        /// The refusal.
        why: String,
        /// The nearest value of the sweep at which it is not refused.
        nearest: Option<f64>,
    },
}

/// Largest number of values that are listed; longer lists are cut in the middle.
const LISTED: usize = 8;

/// Values as tables print them; of many the first and the last.
fn list(values: &[f64]) -> String {
    let words = |values: &[f64]| {
        let words: Vec<String> = values.iter().map(|&value| short(value, 4)).collect();
        words.join(", ")
    };
    match values {
        [first @ .., last] if values.len() > LISTED => {
            format!("{}, …, {} ({} values)", words(&first[..3]), short(*last, 4), values.len())
        }
        _ => words(values),
    }
}

/// The value of a sweep that could be meant.
fn near(nearest: Option<f64>) -> String {
    let named = |value: f64| {
        format!("; the nearest value of the sweep is {}: give it, or add --nearest", number(value))
    };
    nearest.map_or(String::new(), named)
}

impl Claim {
    /// A claim by numbers.
    ///
    /// # Errors
    ///
    /// A number is not finite, or is negative where it must not be; or a range does not go with the
    /// truth or the variance.
    pub fn new(given: &Given) -> Result<Self, ClaimError> {
        let check = |what, value: f64, least: f64, wanted| {
            let is_fine = value.is_finite() && value >= least;
            if is_fine { Ok(()) } else { Err(ClaimError::Number { what, value, wanted }) }
        };
        let &Given { truth, variance, kurtosis, range, lookups, rounding } = given;
        check("truth", truth, f64::NEG_INFINITY, "a finite number")?;
        check("rounding", rounding, 0.0, "a finite number, 0 or more")?;
        if let Some(variance) = variance {
            check("variance", variance, 0.0, "a finite number, 0 or more")?;
        }
        if let Some(kurtosis) = kurtosis {
            check("kurtosis", kurtosis, 1.0, "a finite number, 1 or more")?;
        }
        if let Some(Lookups { mean, variance, .. }) = lookups {
            let (what, wanted) = ("expected lookups", "a finite number above 0");
            check(what, mean, f64::MIN_POSITIVE, wanted)?;
            let (what, wanted) = ("lookups variance", "a finite number, 0 or more");
            check(what, variance.unwrap_or(0.0), 0.0, wanted)?;
        }
        let unit = if truth == 0.0 { 1.0 } else { truth.abs() };
        let (truth_error, variance_error) = (0.0, 0.0);
        let claim = Self {
            truth,
            truth_error,
            unit,
            variance,
            variance_error,
            kurtosis,
            range: None,
            lookups,
            rounding,
            flights: None,
        };
        claim.within(range)
    }

    /// The same claim with a range.
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

    /// The same claim of the mean alone: what averages of dependent draws keep.
    #[must_use]
    pub fn of_mean_alone(self) -> Self {
        Self { variance: None, kurtosis: None, lookups: None, ..self }
    }

    /// δ of the mean, in units of u.
    pub fn floor(&self) -> f64 {
        (self.truth_error + self.rounding_of_draw()) / self.unit
    }

    /// The range with what rounding may add at each end.
    pub fn widened(&self) -> Option<[f64; 2]> {
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
    pub fn variance_floor(&self, variance: f64) -> f64 {
        let noise = self.rounding_of_draw() / variance.sqrt();
        self.variance_error + noise * (2.0 + noise)
    }
}
