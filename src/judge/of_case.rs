//! Choice of one experiment of a case, and the claims that theory makes about it.

use std::fmt::Write;
use std::sync::Arc;

use super::whole::KnownDistribution;
use super::{Claim, Lookups, RayFlights, Theory};
use crate::case::Case;
use crate::case::CaseError;
use crate::case::Ready;
use crate::case::catalogue::Catalogue;
use crate::case::id::EstimatorName;
use crate::case::sweep::{SweepAxis, SweptQuantity, Variation};
use ::theory::{CountDistribution, Distribution, Prediction};
use gate::Check;
use numeric::digits::{number, short};

/// Name of the problem with distances as draws.
const FLIGHTS: &str = "free-flight";
/// Largest relative deviation of a length that is constant.
const SURE: f64 = 1e-6;
/// Maximum number of values of a sweep that are tried as a suggestion in place of a refused one.
const TRIED: usize = 8;

/// Choice of an experiment of a case.
#[derive(Debug, Clone, Copy, Default)]
pub struct ExperimentChoice<'a> {
    /// Estimator: its label in tables, or its name in the catalogue.
    pub estimator: &'a str,
    /// Swept value, if the estimator is swept.
    pub swept: Option<f64>,
    /// True if the nearest value of the case's sweep replaces the swept value. Otherwise the value is taken as it is,
    /// in the sweep or not; without a sweep it is a constant σ̂.
    pub nearest: bool,
    /// Channel, if a draw has several.
    pub channel: Option<&'a str>,
    /// Seed of pilot rays, if σ̂ is learned from them.
    pub seed: u64,
}

/// Reason why no draws can be judged by a choice.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs)] // messages name the fields
pub enum ChoiceError {
    /// No estimator of that name.
    #[error("{case}: no estimator is called `{name}`; choose one of: {}", candidates.join(", "))]
    NoEstimator { case: String, name: String, candidates: Vec<String> },
    /// Several estimators of that name.
    #[error("{case}: several estimators are called `{name}`; choose one of: {}", candidates.join(", "))]
    Ambiguous { case: String, name: String, candidates: Vec<String> },
    /// The value of the sweep is missing.
    #[error(
        "{case}: `{estimator}` is swept over {what}: {}; say at which value your draws were made, by --swept (in Python \
         sampling=, elsewhere the last argument of `of`); any value will do that is {expected}",
        list(values)
    )]
    Swept {
        case: String,
        estimator: String,
        what: &'static str,
        values: Vec<f64>,
        expected: &'static str,
    },
    /// A value that the swept quantity cannot have.
    #[error(
        "{case}: `{estimator}`: {what} = {} is not {expected}{}",
        number(*value),
        near(*nearest)
    )]
    NoSuchValue {
        case: String,
        estimator: String,
        what: &'static str,
        value: f64,
        expected: &'static str,
        nearest: Option<f64>,
    },
    /// A swept value for an estimator that is not swept.
    #[error("{case}: `{estimator}` is not swept; leave the swept value and --nearest out")]
    NotSwept { case: String, estimator: String },
    /// A draw has several values.
    #[error("{case}: a draw has {} channels; choose one of: {}", channels.len(), channels.join(", "))]
    Channel { case: String, channels: Vec<String> },
    /// The unit is a transmittance that few doubles can represent.
    #[error(
        "{case}: `{estimator}` sees an optical depth of {depth:.0}, where theory is in units of T; multiply the \
         draws by e^τ and give the truth 1 and what else is known of them by numbers"
    )]
    Deep { case: String, estimator: String, depth: f64 },
    /// The experiment is refused.
    #[error(
        "{case}: `{estimator}` is refused: {why}{}",
        if nearest.is_some() { near(*nearest) } else { "; choose an estimator that is unbiased there".to_owned() }
    )]
    Refused { case: String, estimator: String, why: String, nearest: Option<f64> },
}

/// Returns the theory of one experiment of a case, with a claim for each channel; the choice of a channel is ignored.
///
/// # Errors
///
/// No experiment or several fit the choice, or the experiment is refused.
pub fn theory(
    case: &Case,
    choice: &ExperimentChoice,
    rounding: f64,
) -> Result<Theory, ChoiceError> {
    let (index, label) = find(case, choice.estimator)?;
    let axis = case.sweep.as_ref();
    let axis = axis.filter(|axis| case.scenario.depends_on(index, axis.what));
    let at = SweptEstimator { case, index, label: &label, axis, seed: choice.seed };
    let variation = at.variation(choice)?;
    let prediction = at.prediction(variation)?;
    if let Some(deep) = prediction.channels.iter().find(|channel| channel.log_unit != 0.0) {
        let (case, depth) = (case.name.clone(), deep.log_unit);
        return Err(ChoiceError::Deep { case, estimator: label, depth });
    }
    let mut about = format!("`{label}` of {}", case.name);
    if let Some((what, value)) = variation {
        let _ = write!(about, ", {} = {}", what.key(), number(value));
        if let Some(requested) = choice.swept.filter(|_| choice.nearest) {
            let _ = write!(about, ", the value of the sweep nearest to {}", number(requested));
        }
    }
    let channels = claims(case, &prediction, rounding);
    let distribution = Arc::new(KnownDistribution(Arc::new(prediction)));
    Ok(Theory { channels, about, distribution })
}

/// Claims about draws from a case.
pub trait OfCase: Sized {
    /// Takes mean, variance, kurtosis and lookups from theory and, where theory knows it, the whole distribution.
    ///
    /// The estimator has its name in tables or in the catalogue. The value may be any value of the swept quantity, or
    /// of a constant σ̂ if the case sweeps nothing; `None` takes the case's own σ̂. The case is a built-in one or a
    /// file. Every channel of the case is a value of the draw; a luminance may be left out.
    ///
    /// A free flight that leaves the ray is written as the ray's length, as any larger number, as infinity or as −1.
    ///
    /// ```
    /// # use trueflight::rng::Stream;
    /// # fn sigma_t(t: f64) -> f64 {
    /// #     (0.75 * t).cos().powi(10) * ((t / 2.0).sin() + 2.0) / 3.0
    /// # }
    /// # fn my_estimator(rng: &mut Stream) -> f64 {
    /// #     let (mut weight, mut t) = (1.0, -rng.positive_uniform().ln());
    /// #     while t < 20.0 {
    /// #         weight *= 1.0 - sigma_t(t);
    /// #         t -= rng.positive_uniform().ln();
    /// #     }
    /// #     weight
    /// # }
    /// use trueflight::OfCase;
    ///
    /// trueflight::check("ratio tracking", |rng| my_estimator(rng))
    ///     .of("transmittance/eq21-overview", "ratio", 1.0)
    ///     .assert_pass();
    /// ```
    #[must_use]
    fn of(self, case: &str, estimator: &str, swept: impl Into<Option<f64>>) -> Self;

    /// Takes the claims from a case that was read before.
    #[must_use]
    fn of_case(self, case: &Case, choice: &ExperimentChoice) -> Self;
}

impl<S> OfCase for Check<S> {
    fn of(self, case: &str, estimator: &str, swept: impl Into<Option<f64>>) -> Self {
        let choice =
            ExperimentChoice { estimator, swept: swept.into(), ..ExperimentChoice::default() };
        match Catalogue::builtin().named(case) {
            Ok(read) => match &read[..] {
                [case] => self.of_case(case, &choice),
                cases => {
                    let names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
                    let names = names.join(", ");
                    self.theory(Err(format!("{case} is several cases; choose one of: {names}")))
                }
            },
            Err(errors) => {
                let messages: Vec<String> = errors.iter().map(CaseError::in_full).collect();
                self.theory(Err(messages.join("\n\n")))
            }
        }
    }

    fn of_case(self, case: &Case, choice: &ExperimentChoice) -> Self {
        let theory = theory(case, choice, 0.0);
        self.theory(theory.map_err(|error| error.to_string()))
    }
}

/// Returns a claim for each channel.
fn claims(case: &Case, prediction: &Prediction, rounding: f64) -> Vec<(String, Claim)> {
    let lookups = prediction.lookups.as_ref();
    let flights = match prediction.distribution {
        Some(Distribution::Distances { end, from, escape, .. }) => {
            Some(RayFlights { length: end, from, escape })
        }
        // Without a medium all flights leave the ray.
        None if case.problem == FLIGHTS => {
            let channel = prediction.channels.first();
            let length = channel.map(|channel| channel.truth.value);
            // All flights then have the length of the ray, to rounding.
            let is_sure = |length: &f64| {
                let moments = channel.and_then(|channel| channel.moments);
                moments.is_some_and(|m| m.variance().sqrt() <= SURE * length)
            };
            length.filter(is_sure).map(|length| RayFlights { length, from: 0.0, escape: 1.0 })
        }
        _ => None,
    };
    let claims = prediction.channels.iter().map(|channel| {
        let claim = Claim {
            truth: channel.truth.value,
            truth_error: channel.truth.error,
            unit: channel.unit,
            variance: channel.moments.map(|m| m.variance()).filter(|v| v.is_finite()),
            variance_error: channel.moments.map_or(0.0, |moments| moments.error),
            kurtosis: channel.moments.and_then(|m| m.kurtosis()).filter(|k| k.is_finite()),
            range: None,
            lookups: lookups.filter(|density| density.mean > 0.0).map(|density| Lookups {
                mean: density.mean,
                variance: Some(density.variance),
                error: CountDistribution::ERROR.max(density.error),
            }),
            rounding: checks::rounding(lookups.map_or(0.0, |density| density.mean)).max(rounding),
            flights,
        };
        (channel.name.clone(), claim)
    });
    claims.collect()
}

/// Returns the names of a case's estimators.
fn plain_names(case: &Case) -> Vec<EstimatorName> {
    (0..case.scenario.estimators()).map(|e| case.id(e, None).estimator).collect()
}

/// Returns the labels of a case's estimators, as in tables: namesakes are numbered.
pub fn estimators(case: &Case) -> Vec<String> {
    let plain = plain_names(case);
    let label = |e: usize| {
        let namesakes = plain[..e].iter().filter(|&other| *other == plain[e]).count();
        if namesakes > 0 {
            format!("{} #{}", plain[e], namesakes + 1)
        } else {
            plain[e].to_string()
        }
    };
    (0..plain.len()).map(label).collect()
}

/// Returns the index of the estimator of a name, with its label.
fn find(case: &Case, name: &str) -> Result<(usize, String), ChoiceError> {
    let (plain, labels) = (plain_names(case), estimators(case));
    let catalogue = |e: &usize| plain[*e].name == name;
    let called = |e: &usize| plain[*e].to_string() == name;
    let numbered = |e: &usize| labels[*e] == name && !called(e);
    let matching = |is_it: &dyn Fn(&usize) -> bool| -> Vec<usize> {
        (0..plain.len()).filter(|e| is_it(e)).collect()
    };
    let finding = [matching(&numbered), matching(&called), matching(&catalogue)];
    let finding = finding.into_iter().find(|finding| !finding.is_empty()).unwrap_or_default();
    let one = case;
    let (case, name) = (case.name.clone(), name.to_owned());
    match finding[..] {
        [one] => Ok((one, labels[one].clone())),
        [] => Err(ChoiceError::NoEstimator { case, name, candidates: labels }),
        _ => {
            let candidates = finding.iter().map(|&e| {
                let id = one.id(e, None);
                let about = [id.sampling.constant.map(|s| format!("σ̂ {s}")), Some(id.control)];
                let about: Vec<String> =
                    about.into_iter().flatten().filter(|word| !word.is_empty()).collect();
                if about.is_empty() {
                    format!("`{}`", labels[e])
                } else {
                    format!("`{}` with {}", labels[e], about.join(", "))
                }
            });
            Err(ChoiceError::Ambiguous { case, name, candidates: candidates.collect() })
        }
    }
}

/// Estimator of a case, with its swept quantity.
struct SweptEstimator<'a> {
    case: &'a Case,
    index: usize,
    label: &'a str,
    axis: Option<&'a SweepAxis>,
    seed: u64,
}

impl SweptEstimator<'_> {
    /// Returns the point of the sweep that is chosen.
    fn variation(&self, choice: &ExperimentChoice) -> Result<Variation, ChoiceError> {
        let scenario = &self.case.scenario;
        let (case, estimator) = (self.case.name.clone(), self.label.to_owned());
        match (self.axis, choice.swept) {
            (None, None) => Ok(None),
            (None, Some(value)) => {
                let takes_any = self.case.sweep.is_none()
                    && !choice.nearest
                    && scenario.depends_on(self.index, SweptQuantity::SamplingScale);
                if !takes_any {
                    return Err(ChoiceError::NotSwept { case, estimator });
                }
                self.allowed(SweptQuantity::Sampling, value)?;
                Ok(Some((SweptQuantity::Sampling, value)))
            }
            (Some(axis), None) => {
                let (what, values) = (axis.what.key(), axis.values.clone());
                let expected = axis.what.domain();
                Err(ChoiceError::Swept { case, estimator, what, values, expected })
            }
            (Some(axis), Some(value)) if choice.nearest => {
                let nearest = self.by_distance(value).first().copied();
                Ok(nearest.map(|value| (axis.what, value)))
            }
            (Some(axis), Some(value)) => {
                self.allowed(axis.what, value)?;
                Ok(Some((axis.what, value)))
            }
        }
    }

    /// Validates a value of the swept quantity.
    fn allowed(&self, what: SweptQuantity, value: f64) -> Result<(), ChoiceError> {
        if what.allows(value) {
            return Ok(());
        }
        let (case, estimator) = (self.case.name.clone(), self.label.to_owned());
        let nearest = self.accepted(what, value);
        let (what, expected) = (what.key(), what.domain());
        Err(ChoiceError::NoSuchValue { case, estimator, what, value, expected, nearest })
    }

    /// Returns the values of the sweep, the nearest first.
    fn by_distance(&self, value: f64) -> Vec<f64> {
        let mut values = self.axis.map_or(Vec::new(), |axis| axis.values.clone());
        values.sort_by(|a, b| (a - value).abs().total_cmp(&(b - value).abs()));
        values
    }

    /// Returns the nearest value of the sweep that is not refused.
    fn accepted(&self, what: SweptQuantity, value: f64) -> Option<f64> {
        let mut values = self.by_distance(value).into_iter().take(TRIED);
        values.find(|&value| self.prepared(Some((what, value))).is_ok())
    }

    fn prepared(&self, variation: Variation) -> Result<Prediction, String> {
        let pilots = self.case.pilots(self.seed, self.index);
        let prepared = self.case.at(variation).and_then(|at| at.prepare(self.index, pilots));
        prepared.map(|Ready { prediction, .. }| prediction).map_err(|refusal| refusal.to_string())
    }

    fn prediction(&self, variation: Variation) -> Result<Prediction, ChoiceError> {
        self.prepared(variation).map_err(|why| {
            let (case, estimator) = (self.case.name.clone(), self.label.to_owned());
            // A value outside the sweep may be refused where those of the sweep are not.
            let beside = variation
                .filter(|(_, value)| self.axis.is_some_and(|axis| !axis.values.contains(value)));
            let nearest = beside.and_then(|(what, value)| self.accepted(what, value));
            ChoiceError::Refused { case, estimator, why, nearest }
        })
    }
}

/// Largest number of values that are listed; longer lists are cut in the middle.
const LISTED: usize = 8;

/// Lists values as tables print them, of many only the first and the last.
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

/// Suggests the nearest value of the sweep that is not refused.
fn near(nearest: Option<f64>) -> String {
    let named = |value: f64| {
        format!(
            "; the nearest value of the sweep is {}: give it, or add --nearest, only if your draws were made there, for \
             mean or variance depend on the value; else draw at another one",
            number(value)
        )
    };
    nearest.map_or(String::new(), named)
}
