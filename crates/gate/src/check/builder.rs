//! A check while it is built: the source of the draws, and the properties that correct draws have.

use super::outcome::{CheckError, CheckFault, MAX_VALUES};
use super::sample::{Closure, Factory, Sample};
use crate::session::{Claim, Lookups, Options, ROUNDING, Session, Theory, TheoryClaims};
use numeric::rng::Stream;

/// Maximum number of draws, unless [`Check::draws`] sets it.
pub const MAX_DRAWS: u64 = 1 << 24;

/// A number for each value of a draw, or a single number for all: from `f64`, `[f64; K]` or `Vec<f64>`.
#[derive(Debug, Clone, PartialEq)]
pub struct PerValue(pub(super) Vec<f64>);

impl From<f64> for PerValue {
    fn from(value: f64) -> Self {
        Self(vec![value])
    }
}

impl<const K: usize> From<[f64; K]> for PerValue {
    fn from(values: [f64; K]) -> Self {
        Self(values.to_vec())
    }
}

impl From<Vec<f64>> for PerValue {
    fn from(values: Vec<f64>) -> Self {
        Self(values)
    }
}

/// A check that is being built: a name, a source of draws, and properties of correct draws.
///
/// Invalid properties give a [`CheckError`] in place of the verdict.
#[derive(Debug, Clone)]
#[must_use = "a check draws nothing before .verdict() or .assert_pass()"]
pub struct Check<S> {
    pub(super) name: String,
    pub(super) source: S,
    pub(super) said: Said,
}

/// A check of draws that a closure makes, one a call: `f64`, `f32`, `[f64; K]`, or one of them with a number of
/// lookups, `(value, u64)`.
///
/// ```
/// // Two channels of one ray, with the number of lookups: ratio tracking at σ̂ = 2 in σ_t = 0.5 and 1 on [0, 1].
/// trueflight_gate::check("two channels", |rng| {
///     let (mut weights, mut lookups, mut t) = ([1.0, 1.0], 0, 0.0);
///     loop {
///         t -= rng.positive_uniform().ln() / 2.0;
///         if t > 1.0 {
///             return (weights, lookups);
///         }
///         weights = [weights[0] * 0.75, weights[1] * 0.5];
///         lookups += 1;
///     }
/// })
/// .truth([(-0.5f64).exp(), (-1.0f64).exp()])
/// .range(0.0, 1.0)
/// .lookups(2.0, 2.0)
/// .assert_pass();
/// ```
pub fn check<T: Sample, F: FnMut(&mut Stream) -> T>(
    name: impl Into<String>,
    draw: F,
) -> Check<Closure<F>> {
    Check { name: name.into(), source: Closure { draw }, said: Said::default() }
}

/// A check of draws that several threads make, each by a closure of its own from the factory. There is one thread
/// for each processor, or as many as [`Check::threads`] says.
///
/// ```
/// let factory = || {
///     let mut scratch = Vec::new(); // what is costly to make, or cannot be shared
///     move |rng: &mut trueflight_gate::rng::Stream| {
///         scratch.clear();
///         scratch.push(rng.uniform());
///         scratch[0]
///     }
/// };
/// trueflight_gate::check_with("uniform", factory).truth(0.5).variance(1.0 / 12.0).threads(2).assert_pass();
/// ```
pub fn check_with<T: Sample, F: FnMut(&mut Stream) -> T, M: Fn() -> F + Sync>(
    name: impl Into<String>,
    make: M,
) -> Check<Factory<M>> {
    Check { name: name.into(), source: Factory { make, threads: None }, said: Said::default() }
}

/// A check of draws that come later: [`Check::judge`] takes all of them, [`Check::open`] some at a time.
pub fn claim(name: impl Into<String>) -> Check<()> {
    Check { name: name.into(), source: (), said: Said::default() }
}

impl<S> Check<S> {
    /// Sets the theory of a draw, or the reason why theory is missing, which is then the error of the verdict.
    pub fn theory(mut self, theory: Result<Theory, String>) -> Self {
        self.said.theory = Some(theory);
        self
    }

    /// The mean of a correct draw.
    pub fn truth(mut self, truth: impl Into<PerValue>) -> Self {
        self.said.truth = Some(truth.into());
        self
    }

    /// The variance of a correct draw; it is tested, too.
    pub fn variance(mut self, variance: impl Into<PerValue>) -> Self {
        self.said.variance = Some(variance.into());
        self
    }

    /// The kurtosis of a correct draw, 3 for the normal distribution; without a variance an upper bound of it.
    pub fn kurtosis(mut self, kurtosis: impl Into<PerValue>) -> Self {
        self.said.kurtosis = Some(kurtosis.into());
        self
    }

    /// Range of correct draws; either end may be infinite. A draw outside fails.
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.said.range = Some([low, high]);
        self
    }

    /// Mean and variance of the number of lookups that correct draws come with.
    pub fn lookups(mut self, mean: f64, variance: f64) -> Self {
        self.said.lookups = Some(Lookups { mean, variance: Some(variance), error: 0.0 });
        self
    }

    /// Rounding error of a draw, relative to the truth; absolute for a truth of 0. The default is 3.6e-13; draws in
    /// single precision need some 1e-6.
    pub fn rounding(mut self, rounding: f64) -> Self {
        self.said.rounding = rounding;
        self
    }

    /// Takes only the mean from theory: for an own estimator that the case does not have.
    pub fn mean_only(mut self) -> Self {
        self.said.mean_only = true;
        self
    }

    /// The number of values of a pushed draw, where not every channel of the case is one: the luminance of a
    /// chromatic medium, which follows from the other channels, may be left out.
    pub fn values(mut self, values: usize) -> Self {
        self.said.values = Some(values);
        self
    }

    /// ε: the bias that a pass excludes, relative to the truth (absolute for a truth of 0). The default is 1 %, or
    /// with [`Check::draws`] the bias that this number of draws can detect, at most 5 %.
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.said.options.tolerance = Some(tolerance);
        self
    }

    /// ε of the variance, relative to it.
    pub fn variance_tolerance(mut self, tolerance: f64) -> Self {
        self.said.options.variance_tolerance = Some(tolerance);
        self
    }

    /// Judges averages of `batch` consecutive draws: for draws that are correlated with the ones before. Variance
    /// and kurtosis are then those of an average, and only the mean is taken from theory.
    pub fn batch(mut self, batch: u64) -> Self {
        self.said.options.batch = batch;
        self
    }

    /// α: the probability that a correct estimator fails; the default is 1e-3.
    pub fn alpha(mut self, alpha: f64) -> Self {
        self.said.options.alpha = alpha;
        self
    }

    /// Makes exactly this number of draws, instead of stopping at a decision.
    pub fn draws(mut self, draws: u64) -> Self {
        self.said.options.maximum = Some(draws);
        self
    }

    /// Seed of the random streams; the default is 1.
    pub fn seed(mut self, seed: u64) -> Self {
        self.said.seed = seed;
        self
    }

    /// The session before the first draw; `length` is the number of draws, if known.
    pub(super) fn session(
        &self,
        values: usize,
        has_lookups: bool,
        length: Option<u64>,
    ) -> Result<Session, CheckError> {
        let said = &self.said;
        let session = || match values {
            0 => Err(CheckFault::NoValues),
            1..=MAX_VALUES => {
                let claims = said.claims(values, has_lookups)?;
                Session::new(&claims, said.options, length, said.taken(has_lookups))
                    .map_err(CheckFault::Claim)
            }
            _ => Err(CheckFault::TooManyValues(values)),
        };
        session().map_err(|fault| fault.of(&self.name))
    }
}

/// Properties of correct draws, and what is wanted of the verdict.
#[derive(Debug, Clone)]
pub(super) struct Said {
    pub(super) truth: Option<PerValue>,
    pub(super) variance: Option<PerValue>,
    pub(super) kurtosis: Option<PerValue>,
    pub(super) range: Option<[f64; 2]>,
    pub(super) lookups: Option<Lookups>,
    pub(super) rounding: f64,
    /// Theory of the draw, or the reason why it is missing.
    pub(super) theory: Option<Result<Theory, String>>,
    /// Number of values of a draw, where the caller gave it.
    pub(super) values: Option<usize>,
    pub(super) mean_only: bool,
    /// Error rate, tolerances and number of draws.
    pub(super) options: Options,
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
            options: Options::default(),
            seed: 1,
        }
    }
}

impl Said {
    /// Number of values of a pushed draw.
    pub(super) fn values(&self) -> usize {
        let truths = self.truth.as_ref().map_or(1, |PerValue(list)| list.len());
        let known = self.known().map_or(truths, |theory| theory.channels.len());
        self.values.unwrap_or(known.max(1))
    }

    /// Theory of the draw, if it is given and valid.
    fn known(&self) -> Option<&Theory> {
        self.theory.as_ref().and_then(|theory| theory.as_ref().ok())
    }

    /// True if only the mean comes from theory: averages of draws have another variance and distribution.
    fn is_mean_only(&self) -> bool {
        self.mean_only || self.options.batch > 1
    }

    /// Returns whether theory has a claim on lookups.
    pub(super) fn knows_lookups(&self) -> bool {
        let first = self.known().and_then(|theory| theory.channels.first());
        !self.is_mean_only() && first.is_some_and(|(_, claim)| claim.lookups.is_some())
    }

    /// The names of the values, where theory has names.
    pub(super) fn names(&self, values: usize) -> Vec<String> {
        let channels = self.known().and_then(|theory| theory.channels_of(values));
        let names = channels.unwrap_or_default().iter().map(|(name, _)| name.clone());
        if values > 1 { names.collect() } else { Vec::new() }
    }

    /// The numbers that a session takes from theory.
    pub(super) fn taken(&self, has_lookups: bool) -> Option<TheoryClaims<'_>> {
        // Theory has no distribution of a number of lookups that the caller claims.
        let has_lookups = has_lookups && self.lookups.is_none() && self.knows_lookups();
        let theory = self.known()?;
        Some(TheoryClaims { theory, has_lookups, is_mean_only: self.mean_only })
    }

    /// Returns whether a pushed draw comes with its lookups.
    pub(super) fn has_lookups(&self) -> bool {
        self.lookups.is_some()
    }

    /// Claims on each value of a draw.
    pub(super) fn claims(&self, values: usize, lookups: bool) -> Result<Vec<Claim>, CheckFault> {
        if self.lookups.is_some() && !lookups {
            return Err(CheckFault::NoLookups);
        }
        let number = |what, given: &Option<PerValue>, index: usize| match given {
            None => Ok(None),
            Some(PerValue(list)) if list.len() == 1 => Ok(Some(list[0])),
            Some(PerValue(list)) if list.len() == values => Ok(Some(list[index])),
            Some(PerValue(list)) => {
                Err(CheckFault::Values { what, actual: list.len(), expected: values })
            }
        };
        let theory = match &self.theory {
            None => None,
            Some(Err(message)) => return Err(CheckFault::Case(message.clone())),
            Some(Ok(known)) => {
                let channels = known.channels_of(values).ok_or_else(|| CheckFault::Channels {
                    actual: values,
                    channels: known.names(),
                    expected: known.widths(),
                })?;
                Some(channels)
            }
        };
        if self.truth.is_none() && theory.is_none() {
            return Err(CheckFault::NoTruth);
        }
        let mean_only = self.is_mean_only();
        let twice = [
            ("truth", self.truth.is_some()),
            ("variance", self.variance.is_some() && !mean_only),
            ("kurtosis", self.kurtosis.is_some() && !mean_only),
        ];
        if let (Some(_), Some((what, _))) = (theory, twice.into_iter().find(|(_, is)| *is)) {
            return Err(CheckFault::Twice(what));
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
            claim.map_err(CheckFault::Claim)
        };
        (0..values).map(claim).collect()
    }
}
