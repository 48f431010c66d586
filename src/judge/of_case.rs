//! What theory claims of one experiment of a case.

use super::claim::{Claim, ClaimError, Lookups};
use crate::harness::case::Case;
use crate::harness::checks;
use crate::harness::ready::Ready;
use crate::harness::sweep::{Variation, What};

/// Two values of a sweep this near to each other are the same: tables print few digits.
const SAME: f64 = 1e-3;

/// Which experiment of a case.
#[derive(Debug, Clone, Copy, Default)]
pub struct Choice<'a> {
    /// The estimator's label in tables, or its name in the catalogue.
    pub estimator: &'a str,
    /// The swept value, where it is swept.
    pub swept: Option<f64>,
    /// Whether the swept value is taken as it is, be it in the case's sweep or not; without a sweep it is then a
    /// constant σ̂. Otherwise it must be one of the values of the sweep, as tables print them.
    pub is_exact: bool,
    /// The channel, where a draw has several.
    pub channel: Option<&'a str>,
    /// The seed of pilot rays, where σ̂ is learned from them.
    pub seed: u64,
}

impl Claim {
    /// What theory says of one experiment of a case.
    ///
    /// # Errors
    ///
    /// The choice fits none or several, or the experiment is refused.
    pub fn of_case(case: &Case, choice: &Choice, rounding: f64) -> Result<Self, ClaimError> {
        let mut claims = Self::of_channels(case, choice, rounding)?;
        let chosen = match choice.channel {
            None if claims.len() == 1 => Some(0),
            None => None,
            Some(name) => claims.iter().position(|(channel, _)| channel == name),
        };
        chosen.map(|index| claims.swap_remove(index).1).ok_or_else(|| {
            let channels = claims.into_iter().map(|(channel, _)| channel).collect();
            ClaimError::Channel { case: case.name.clone(), channels }
        })
    }

    /// What theory says of each channel of one experiment of a case, with the channels' names.
    ///
    /// # Errors
    ///
    /// The choice fits none or several, or the experiment is refused.
    pub fn of_channels(
        case: &Case,
        choice: &Choice,
        rounding: f64,
    ) -> Result<Vec<(String, Self)>, ClaimError> {
        let (index, label) = find(case, choice.estimator)?;
        let variation = variation(case, index, &label, choice)?;
        let pilots = case.pilots(choice.seed, index);
        let prepared = case.scenario.prepare(index, variation, pilots);
        let Ready { prediction, .. } = prepared.map_err(|refusal| {
            let why = refusal.to_string();
            ClaimError::Refused { case: case.name.clone(), estimator: label.clone(), why }
        })?;
        if let Some(deep) = prediction.channels.iter().find(|channel| channel.log_unit != 0.0) {
            let (case, depth) = (case.name.clone(), deep.log_unit);
            return Err(ClaimError::Deep { case, estimator: label, depth });
        }
        let lookups = prediction.lookups.as_ref();
        let claims = prediction.channels.iter().map(|channel| {
            let claim = Self {
                truth: channel.truth.value,
                truth_error: channel.truth.error,
                unit: channel.unit,
                variance: channel.moments.map(|m| m.variance()).filter(|v| v.is_finite()),
                variance_error: channel.moments.map_or(0.0, |moments| moments.error),
                kurtosis: channel.moments.and_then(|m| m.kurtosis()).filter(|k| k.is_finite()),
                range: None,
                lookups: lookups.filter(|law| law.mean > 0.0).map(|law| Lookups {
                    mean: law.mean,
                    variance: Some(law.variance),
                    error: checks::lookups::ERROR.max(law.error),
                }),
                rounding: checks::rounding(lookups.map_or(0.0, |law| law.mean)).max(rounding),
            };
            (channel.name.clone(), claim)
        });
        Ok(claims.collect())
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
    choice: &Choice,
) -> Result<Variation, ClaimError> {
    let swept = choice.swept;
    let (name, estimator) = (case.name.clone(), label.to_owned());
    let axis = case.sweep.as_ref().filter(|axis| case.scenario.depends_on(index, axis.what));
    if let (true, Some(value)) = (choice.is_exact, swept) {
        let what = axis.map_or(What::Sampling, |axis| axis.what);
        if !(value > 0.0 && value.is_finite()) {
            let (what, wanted) = ("swept value", "a finite number above 0");
            return Err(ClaimError::Number { what, value, wanted });
        }
        if axis.is_some() || case.scenario.depends_on(index, What::SamplingScale) {
            return Ok(Some((what, value)));
        }
    }
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
