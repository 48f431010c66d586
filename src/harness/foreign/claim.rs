//! What is claimed of another program's draws: by numbers, or by theory for an experiment of a case.

use super::super::addresses;
use super::super::case::Case;
use super::super::checks;
use super::super::scenario::{Ready, Variation};

/// What rounding may add to each draw, relative to the truth, where the caller does not say: a
/// product of a hundred factors.
pub const ROUNDING: f64 = 16.0 * f64::EPSILON * 100.0;
/// Two values of a sweep this near to each other are the same: tables print few digits.
const SAME: f64 = 1e-3;

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
    /// The kurtosis of a correct draw (3 for the normal law), if it is known.
    pub kurtosis: Option<f64>,
    /// What rounding may add to each draw, relative to the truth; absolute for a truth of 0.
    pub rounding: f64,
}

/// A claim that makes no sense.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ClaimError {
    /// Not a finite number, or negative where it must not be.
    #[error("{what} = {} is not {wanted}; give {what} as {wanted}", crate::catalogue::number(*value))]
    Number {
        /// Which number.
        what: &'static str,
        /// What it is.
        value: f64,
        /// What it should be.
        wanted: &'static str,
    },
    /// A kurtosis of draws whose variance is not given.
    #[error("a kurtosis without a variance says nothing; give the variance too")]
    LoneKurtosis,
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
        "{case}: `{estimator}` is swept over {what}; choose one of its values: {}",
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
    },
    /// A value of a sweep where nothing is swept.
    #[error("{case}: `{estimator}` is not swept; leave the swept value out")]
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
    /// The experiment is refused.
    #[error("{case}: `{estimator}` is refused: {why}; choose an estimator that is unbiased there")]
    Refused {
        /// The case.
        case: String,
        /// The estimator.
        estimator: String,
        /// The refusal.
        why: String,
    },
}

fn list(values: &[f64]) -> String {
    values.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")
}

/// Which experiment of a case.
#[derive(Debug, Clone, Copy, Default)]
pub struct Choice<'a> {
    /// The estimator's label in tables, or its name in the catalogue.
    pub estimator: &'a str,
    /// The swept value, where it is swept.
    pub swept: Option<f64>,
    /// The channel, where a draw has several.
    pub channel: Option<&'a str>,
    /// The seed of pilot rays, where σ̂ is learned from them.
    pub seed: u64,
}

impl Claim {
    /// A claim by numbers.
    ///
    /// # Errors
    ///
    /// A number is not finite, or is negative where it must not be.
    pub fn new(
        truth: f64,
        variance: Option<f64>,
        kurtosis: Option<f64>,
        rounding: f64,
    ) -> Result<Self, ClaimError> {
        let check = |what, value: f64, least: f64, wanted| {
            let is_fine = value.is_finite() && value >= least;
            if is_fine { Ok(()) } else { Err(ClaimError::Number { what, value, wanted }) }
        };
        check("truth", truth, f64::NEG_INFINITY, "a finite number")?;
        check("rounding", rounding, 0.0, "a finite number, 0 or more")?;
        if let Some(variance) = variance {
            check("variance", variance, 0.0, "a finite number, 0 or more")?;
        }
        if let Some(kurtosis) = kurtosis {
            check("kurtosis", kurtosis, 1.0, "a finite number, 1 or more")?;
            if variance.is_none() {
                return Err(ClaimError::LoneKurtosis);
            }
        }
        let unit = if truth == 0.0 { 1.0 } else { truth.abs() };
        let (truth_error, variance_error) = (0.0, 0.0);
        Ok(Self { truth, truth_error, unit, variance, variance_error, kurtosis, rounding })
    }

    /// What theory says of one experiment of a case.
    ///
    /// # Errors
    ///
    /// The choice fits none or several, or the experiment is refused.
    pub fn of_case(case: &Case, choice: &Choice, rounding: f64) -> Result<Self, ClaimError> {
        let (index, label) = find(case, choice.estimator)?;
        let variation = variation(case, index, &label, choice.swept)?;
        let pilots = addresses::pilots(choice.seed, case, index);
        let prepared = case.scenario.prepare(index, variation, pilots);
        let Ready { prediction, .. } = prepared.outcome.map_err(|refusal| {
            let why = refusal.to_string();
            ClaimError::Refused { case: case.name.clone(), estimator: label, why }
        })?;
        let channels = &prediction.channels;
        let chosen = match choice.channel {
            None if channels.len() == 1 => channels.first(),
            None => None,
            Some(name) => channels.iter().find(|channel| channel.name == name),
        };
        let channel = chosen.ok_or_else(|| {
            let channels = channels.iter().map(|channel| channel.name.clone()).collect();
            ClaimError::Channel { case: case.name.clone(), channels }
        })?;
        let lookups = prediction.lookups.as_ref().map_or(0.0, |lookups| lookups.mean);
        Ok(Self {
            truth: channel.truth.value,
            truth_error: channel.truth.error,
            unit: channel.unit,
            variance: channel.moments.map(|m| m.variance()).filter(|v| v.is_finite()),
            variance_error: channel.moments.map_or(0.0, |moments| moments.error),
            kurtosis: channel.moments.and_then(|m| m.kurtosis()).filter(|k| k.is_finite()),
            rounding: checks::rounding(lookups).max(rounding),
        })
    }

    /// δ of the mean, in units of u.
    pub(super) fn floor(&self) -> f64 {
        (self.truth_error + self.rounding_of_draw()) / self.unit
    }

    /// What rounding may add to a draw.
    fn rounding_of_draw(&self) -> f64 {
        self.rounding * if self.truth == 0.0 { 1.0 } else { self.truth.abs() }
    }

    /// δ of the variance, relative to it.
    pub(super) fn variance_floor(&self, variance: f64) -> f64 {
        let noise = self.rounding_of_draw() / variance.sqrt();
        self.variance_error + noise * (2.0 + noise)
    }
}

/// The estimator of a name, with its label.
fn find(case: &Case, name: &str) -> Result<(usize, String), ClaimError> {
    let scenario = &case.scenario;
    let plain: Vec<String> =
        (0..scenario.estimators()).map(|e| scenario.names(e, None).estimator).collect();
    // Namesakes are numbered, as in tables.
    let label = |e: usize| {
        let twins = plain[..e].iter().filter(|&other| *other == plain[e]).count();
        if twins > 0 { format!("{} #{}", plain[e], twins + 1) } else { plain[e].clone() }
    };
    let labels: Vec<String> = (0..plain.len()).map(label).collect();
    let catalogue = |e: &usize| plain[*e].split([' ', '(']).next() == Some(name);
    let called = |e: &usize| plain[*e] == name;
    let numbered = |e: &usize| labels[*e] == name && plain[*e] != name;
    let matching = |is_it: &dyn Fn(&usize) -> bool| -> Vec<usize> {
        (0..plain.len()).filter(|e| is_it(e)).collect()
    };
    let found = [matching(&numbered), matching(&called), matching(&catalogue)];
    let found = found.into_iter().find(|found| !found.is_empty()).unwrap_or_default();
    let (case, name) = (case.name.clone(), name.to_owned());
    match found[..] {
        [one] => Ok((one, labels[one].clone())),
        [] => Err(ClaimError::NoEstimator { case, name, candidates: labels }),
        _ => {
            let candidates = found.iter().map(|&e| {
                let names = scenario.names(e, None);
                let about = [names.sampling.map(|s| format!("σ̂ {s}")), Some(names.control)];
                let about: Vec<String> =
                    about.into_iter().flatten().filter(|word| !word.is_empty()).collect();
                if about.is_empty() {
                    format!("`{}`", labels[e])
                } else {
                    format!("`{}` with {}", labels[e], about.join(", "))
                }
            });
            Err(ClaimError::Ambiguous { case, name, candidates: candidates.collect() })
        }
    }
}

fn variation(
    case: &Case,
    index: usize,
    label: &str,
    swept: Option<f64>,
) -> Result<Variation, ClaimError> {
    let (name, estimator) = (case.name.clone(), label.to_owned());
    let axis = case.sweep.as_ref().filter(|axis| case.scenario.depends_on(index, axis.what));
    let Some(axis) = axis else {
        return match swept {
            None => Ok(None),
            Some(_) => Err(ClaimError::NotSwept { case: name, estimator }),
        };
    };
    let near = |x: &&f64| swept.is_some_and(|s| (s - **x).abs() <= SAME * x.abs());
    let distance = |x: &f64| swept.map_or(0.0, |s| (s - x).abs());
    let nearest = axis.values.iter().filter(near);
    if let Some(&value) = nearest.min_by(|a, b| distance(a).total_cmp(&distance(b))) {
        return Ok(Some((axis.what, value)));
    }
    let (what, values) = (axis.what.key(), axis.values.clone());
    Err(ClaimError::Swept { case: name, estimator, what, values })
}
