//! The identity of an experiment, as data.

use std::cmp::Ordering;
use std::fmt::{self, Display, Formatter};
use std::hash::{Hash, Hasher};

use serde::{Deserialize, Serialize};

use crate::case::names::{EstimatorName, Names};
use crate::case::sweep::{Variation, What};

/// Identity of an experiment: one estimator of a case at one point of the sweep.
///
/// Two experiments of a run never have the same identity. It depends neither on the place in the list of
/// estimators nor on the options of the run.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ExperimentId {
    /// Name of the case.
    pub case: String,
    /// Name of the problem.
    pub problem: String,
    /// The estimator with its own settings.
    pub estimator: EstimatorName,
    /// The sampling extinction.
    pub sampling: SamplingName,
    /// The control in words, as in `constant 0.3`; empty for none.
    pub control: String,
    /// The point of the sweep; `None` for experiments outside the sweep.
    pub swept: Option<SweepPoint>,
    /// Number among the experiments of the case that agree in all else, from 1.
    pub namesake: usize,
}

/// The sampling extinction σ̂ of an experiment.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SamplingName {
    /// The constant σ̂, 1/length; `None` where σ̂ varies or is not used.
    pub constant: Option<Number>,
    /// σ̂ in words, as in `piecewise-linear`; empty where none is used.
    pub kind: String,
}

/// One value of the swept quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SweepPoint {
    /// The swept quantity.
    pub what: What,
    /// Its value.
    pub value: Number,
}

/// A finite number in an identity: equality, order and hash are those of its bits.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Number(pub f64);

impl PartialEq for Number {
    fn eq(&self, other: &Self) -> bool {
        self.0.to_bits() == other.0.to_bits()
    }
}

impl Eq for Number {}

impl PartialOrd for Number {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Number {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl Hash for Number {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.to_bits().hash(state);
    }
}

impl Display for Number {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl ExperimentId {
    /// Identity of an experiment of a case, which has so many namesakes before it.
    pub fn new(
        [case, problem]: [&str; 2],
        names: &Names,
        variation: Variation,
        namesakes: usize,
    ) -> Self {
        Self {
            case: case.to_owned(),
            problem: problem.to_owned(),
            estimator: names.estimator.clone(),
            sampling: SamplingName {
                constant: names.sampling.map(Number),
                kind: names.sampling_kind.clone(),
            },
            control: names.control.clone(),
            swept: variation.map(|(what, value)| SweepPoint { what, value: Number(value) }),
            namesake: namesakes + 1,
        }
    }

    /// Label of the estimator in tables: its name, its settings, and its number if an earlier estimator has the same.
    pub fn label(&self) -> String {
        match self.namesake {
            ..=1 => self.estimator.to_string(),
            number => format!("{} #{number}", self.estimator),
        }
    }

    /// The swept value; `None` outside the sweep.
    pub fn swept_value(&self) -> Option<f64> {
        self.swept.map(|point| point.value.0)
    }
}

/// The stable text of an identity, as in `rod/albedos:analogue, σ̂ majorant (2), albedo 0.5`.
///
/// Different identities have different texts.
impl Display for ExperimentId {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        write!(f, "{}:{}", self.case, self.label())?;
        let is_swept = self.swept.is_some_and(|point| point.what == What::Sampling);
        if !is_swept || self.sampling.kind != "constant" {
            write!(f, "{}", self.sampling)?;
        }
        if !self.control.is_empty() {
            write!(f, ", control {}", self.control)?;
        }
        self.swept
            .map_or(Ok(()), |SweepPoint { what, value }| write!(f, ", {} {value}", what.key()))
    }
}

/// The words `, σ̂ majorant (2)`; empty for an estimator without σ̂.
impl Display for SamplingName {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        match (self.constant, self.kind.as_str()) {
            (Some(value), "" | "constant") => write!(f, ", σ̂ {value}"),
            (Some(value), kind) => write!(f, ", σ̂ {kind} ({value})"),
            (None, "") => Ok(()),
            (None, kind) => write!(f, ", σ̂ {kind}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn id(settings: &str, swept: Option<(What, f64)>, namesakes: usize) -> ExperimentId {
        let names = Names {
            estimator: EstimatorName { name: "single".into(), settings: settings.into() },
            sampling: Some(2.0),
            sampling_kind: "majorant".into(),
            control: "mean".into(),
            alias: None,
        };
        ExperimentId::new(["rod/albedos", "rod"], &names, swept, namesakes)
    }

    #[test]
    fn text_has_all_that_tells_experiments_apart() {
        let text = id("a=0.7", Some((What::AlbedoScale, 0.5)), 1).to_string();
        let expected =
            "rod/albedos:single (a=0.7) #2, σ̂ majorant (2), control mean, albedo-scale 0.5";
        assert_eq!(text, expected);
        assert_eq!(id("", None, 0).to_string(), "rod/albedos:single, σ̂ majorant (2), control mean");
    }

    #[test]
    fn json_gives_the_identity_back() {
        for id in [id("a=0.7", Some((What::Points, 3.0)), 1), id("", None, 0)] {
            let text = serde_json::to_string(&id).expect("an identity is JSON");
            assert_eq!(serde_json::from_str::<ExperimentId>(&text).expect("an identity"), id);
        }
    }
}
