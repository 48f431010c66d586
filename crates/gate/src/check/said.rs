//! What is said of a draw by the caller of a check, and the claims that it makes.

use super::builder::Values;
use super::error::CheckError;
use crate::session::{Claim, Lookups, ROUNDING, Taken, Theory, Wanted};

/// What is known of a draw, and what is wanted of the verdict.
#[derive(Debug, Clone)]
pub(super) struct Said {
    pub(super) truth: Option<Values>,
    pub(super) variance: Option<Values>,
    pub(super) kurtosis: Option<Values>,
    pub(super) range: Option<[f64; 2]>,
    pub(super) lookups: Option<Lookups>,
    pub(super) rounding: f64,
    /// Theory of the draw, or the reason why it is missing.
    pub(super) theory: Option<Result<Theory, String>>,
    /// Number of values of a draw, where the caller gave it.
    pub(super) values: Option<usize>,
    pub(super) mean_only: bool,
    /// Error rate, tolerances and number of draws.
    pub(super) wanted: Wanted,
    pub(super) seed: u64,
}

impl Default for Said {
    fn default() -> Self {
        Self {
            truth: None,
            variance: None,
            kurtosis: None,
            range: None,
            lookups: None,
            rounding: ROUNDING,
            theory: None,
            values: None,
            mean_only: false,
            wanted: Wanted::default(),
            seed: 1,
        }
    }
}

impl Said {
    /// Number of values of a pushed draw.
    pub(super) fn values(&self) -> usize {
        let truths = self.truth.as_ref().map_or(1, |Values(list)| list.len());
        let known = self.known().map_or(truths, |theory| theory.channels.len());
        self.values.unwrap_or(known.max(1))
    }

    /// The theory of the draw.
    fn known(&self) -> Option<&Theory> {
        self.theory.as_ref().and_then(|theory| theory.as_ref().ok())
    }

    /// Whether only the mean comes from theory: averages of draws have another variance and distribution.
    fn is_mean_only(&self) -> bool {
        self.mean_only || self.wanted.batch > 1
    }

    /// Whether theory says what lookups should be.
    pub(super) fn knows_lookups(&self) -> bool {
        let first = self.known().and_then(|theory| theory.channels.first());
        !self.is_mean_only() && first.is_some_and(|(_, claim)| claim.lookups.is_some())
    }

    /// The names of the values, where theory has any.
    pub(super) fn names(&self, values: usize) -> Vec<String> {
        let channels = self.known().and_then(|theory| theory.channels_of(values));
        let names = channels.unwrap_or_default().iter().map(|(name, _)| name.clone());
        if values > 1 { names.collect() } else { Vec::new() }
    }

    /// What a session takes from theory.
    pub(super) fn taken(&self, has_lookups: bool) -> Option<Taken<'_>> {
        // Numbers of the caller's are not those that theory has the distribution of.
        let has_lookups = has_lookups && self.lookups.is_none() && self.knows_lookups();
        let theory = self.known()?;
        Some(Taken { theory, has_lookups, is_mean_only: self.mean_only })
    }

    /// Whether a pushed draw tells its lookups.
    pub(super) fn has_lookups(&self) -> bool {
        self.lookups.is_some()
    }

    /// What is claimed of each value of a draw.
    pub(super) fn claims(
        &self,
        name: &str,
        values: usize,
        lookups: bool,
    ) -> Result<Vec<Claim>, CheckError> {
        let name = || name.to_owned();
        if self.lookups.is_some() && !lookups {
            return Err(CheckError::NoLookups { name: name() });
        }
        let number = |what, given: &Option<Values>, index: usize| match given {
            None => Ok(None),
            Some(Values(list)) if list.len() == 1 => Ok(Some(list[0])),
            Some(Values(list)) if list.len() == values => Ok(Some(list[index])),
            Some(Values(list)) => {
                Err(CheckError::Values { name: name(), what, found: list.len(), wanted: values })
            }
        };
        let theory = match &self.theory {
            None => None,
            Some(Err(message)) => {
                return Err(CheckError::Case { name: name(), message: message.clone() });
            }
            Some(Ok(known)) => {
                let channels = known.channels_of(values).ok_or_else(|| CheckError::Channels {
                    name: name(),
                    found: values,
                    channels: known.names(),
                    wanted: known.widths(),
                })?;
                Some(channels)
            }
        };
        if self.truth.is_none() && theory.is_none() {
            return Err(CheckError::NoTruth { name: name() });
        }
        let mean_only = self.is_mean_only();
        let twice = [
            ("truth", self.truth.is_some()),
            ("variance", self.variance.is_some() && !mean_only),
            ("kurtosis", self.kurtosis.is_some() && !mean_only),
        ];
        if let (Some(_), Some((what, _))) = (theory, twice.into_iter().find(|(_, is)| *is)) {
            return Err(CheckError::Twice { name: name(), what });
        }
        let claim = |index: usize| {
            let numbers = Claim {
                variance: number("variance", &self.variance, index)?,
                kurtosis: number("kurtosis", &self.kurtosis, index)?,
                lookups: self.lookups,
                rounding: self.rounding,
                ..Claim::of_truth(match theory {
                    Some(channels) => channels[index].1.truth,
                    None => number("truth", &self.truth, index)?.unwrap_or(f64::NAN),
                })
            };
            let known = theory.map(|channels| {
                let claim = channels[index].1;
                Claim { rounding: claim.rounding.max(self.rounding), ..claim }
            });
            let claim = |numbers: Claim| match known {
                None => numbers,
                Some(known) if mean_only => numbers.about(known),
                Some(known) => {
                    Claim { lookups: self.lookups.or(known.lookups.filter(|_| lookups)), ..known }
                }
            };
            let claim = numbers.validated().and_then(|numbers| claim(numbers).within(self.range));
            claim.map_err(|source| CheckError::Claim { name: name(), source: source.into() })
        };
        (0..values).map(claim).collect()
    }
}
