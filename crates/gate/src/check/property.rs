//! Properties of a check by name, for interfaces in other languages.

use super::builder::Check;
use super::outcome::{CheckError, CheckFault, MAX_VALUES};

/// Property of a check that is set by numbers, as the method of the same name does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Property {
    /// [`Check::truth`]: one number, or one for each value of a draw.
    Truth,
    /// [`Check::variance`]: one number, or one for each value of a draw.
    Variance,
    /// [`Check::kurtosis`]: one number, or one for each value of a draw.
    Kurtosis,
    /// [`Check::range`]: two numbers.
    Range,
    /// [`Check::lookups`]: mean and variance.
    Lookups,
    /// [`Check::rounding`].
    Rounding,
    /// [`Check::tolerance`].
    Tolerance,
    /// [`Check::variance_tolerance`].
    VarianceTolerance,
    /// [`Check::alpha`].
    Alpha,
    /// [`Check::draws`].
    Draws,
    /// [`Check::batch`].
    Batch,
    /// [`Check::values`].
    Values,
    /// [`Check::mean_only`]: 1, or 0 for all of theory.
    MeanOnly,
}

impl Property {
    /// All properties.
    pub const ALL: [Self; 13] = [
        Self::Truth,
        Self::Variance,
        Self::Kurtosis,
        Self::Range,
        Self::Lookups,
        Self::Rounding,
        Self::Tolerance,
        Self::VarianceTolerance,
        Self::Alpha,
        Self::Draws,
        Self::Batch,
        Self::Values,
        Self::MeanOnly,
    ];

    /// Returns the name of the method that sets the property.
    pub fn name(self) -> &'static str {
        match self {
            Self::Truth => "truth",
            Self::Variance => "variance",
            Self::Kurtosis => "kurtosis",
            Self::Range => "range",
            Self::Lookups => "lookups",
            Self::Rounding => "rounding",
            Self::Tolerance => "tolerance",
            Self::VarianceTolerance => "variance_tolerance",
            Self::Alpha => "alpha",
            Self::Draws => "draws",
            Self::Batch => "batch",
            Self::Values => "values",
            Self::MeanOnly => "mean_only",
        }
    }

    /// Returns the property of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|property| property.name() == name)
    }
}

/// Largest integer below which all integers are doubles: 2⁵³.
const MAX_WHOLE: u64 = 1 << 53;

impl<S> Check<S> {
    /// Sets a property by numbers, in place of an earlier value.
    ///
    /// # Errors
    ///
    /// The property takes another number of numbers, or a number is not an integer where it must be. The verdict
    /// validates the rest.
    ///
    /// ```
    /// use trueflight_gate::check::Property;
    ///
    /// let check = trueflight_gate::claim("uniform").set(Property::Truth, &[0.5])?.set(Property::Range, &[0.0, 1.0])?;
    /// assert!(check.set(Property::Draws, &[0.5]).is_err());
    /// # Ok::<(), trueflight_gate::check::CheckError>(())
    /// ```
    pub fn set(self, property: Property, numbers: &[f64]) -> Result<Self, CheckError> {
        let name = self.name.clone();
        self.with(property, numbers).map_err(|fault| fault.of(&name))
    }

    fn with(mut self, property: Property, numbers: &[f64]) -> Result<Self, CheckFault> {
        let given = Given { what: property.name(), numbers };
        let list = || numbers.to_vec();
        Ok(match property {
            Property::Truth => self.truth(list()),
            Property::Variance => self.variance(list()),
            Property::Kurtosis => self.kurtosis(list()),
            Property::Range => {
                let [low, high] = given.exactly("2 numbers, the lower and the upper end")?;
                self.range(low, high)
            }
            Property::Lookups => {
                let [mean, variance] = given.exactly("2 numbers, mean and variance")?;
                self.lookups(mean, variance)
            }
            Property::Rounding => self.rounding(given.one()?),
            Property::Tolerance => self.tolerance(given.one()?),
            Property::VarianceTolerance => self.variance_tolerance(given.one()?),
            Property::Alpha => self.alpha(given.one()?),
            Property::Draws => self.draws(given.whole(1, MAX_WHOLE)?),
            Property::Batch => self.batch(given.whole(1, MAX_WHOLE)?),
            Property::Values => {
                let values = given.whole(1, MAX_VALUES as u64)?;
                self.values(usize::try_from(values).unwrap_or(MAX_VALUES))
            }
            Property::MeanOnly => {
                self.said.mean_only = given.whole(0, 1)? == 1;
                self
            }
        })
    }
}

/// Numbers for a property.
struct Given<'a> {
    what: &'static str,
    numbers: &'a [f64],
}

impl Given<'_> {
    /// Returns exactly `N` numbers.
    fn exactly<const N: usize>(&self, expected: &'static str) -> Result<[f64; N], CheckFault> {
        let (what, actual) = (self.what, self.numbers.len());
        self.numbers.try_into().map_err(|_| CheckFault::Count { what, actual, expected })
    }

    fn one(&self) -> Result<f64, CheckFault> {
        self.exactly("1 number").map(|[number]| number)
    }

    /// Returns one integer within bounds.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // whole, and within bounds
    fn whole(&self, min: u64, max: u64) -> Result<u64, CheckFault> {
        let (what, value) = (self.what, self.one()?);
        let is_valid = value >= min as f64 && value <= max as f64 && value.fract() == 0.0;
        if is_valid { Ok(value as u64) } else { Err(CheckFault::Whole { what, value, min, max }) }
    }
}
