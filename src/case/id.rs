//! Identity of an experiment, as data.

use std::cmp::Ordering;
use std::fmt::{self, Display, Formatter};
use std::hash::{Hash, Hasher};

use serde::{Deserialize, Serialize};

use crate::case::sweep::{SweptQuantity, Variation};
use numeric::rng::{Address, name_hash};

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

/// Name of an estimator in the catalogue, with its own settings.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct EstimatorName {
    /// Name in the catalogue.
    pub name: String,
    /// Its settings in words, as in `non-terminating, a=0.7`; empty without any.
    pub settings: String,
}

/// The label in tables, as in `single (non-terminating, a=0.7)`.
impl Display for EstimatorName {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        match self.settings.as_str() {
            "" => write!(f, "{}", self.name),
            settings => write!(f, "{} ({settings})", self.name),
        }
    }
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
    pub what: SweptQuantity,
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
    /// Returns the label of the estimator in tables: its name, its settings, and its number if an earlier estimator has
    /// the same.
    pub fn label(&self) -> String {
        match self.namesake {
            ..=1 => self.estimator.to_string(),
            number => format!("{} #{number}", self.estimator),
        }
    }

    /// Returns the point of the sweep; `None` outside the sweep.
    pub fn variation(&self) -> Variation {
        self.swept.map(|SweepPoint { what, value }| (what, value.0))
    }

    /// Returns the swept value; `None` outside the sweep.
    pub fn swept_value(&self) -> Option<f64> {
        self.variation().map(|(_, value)| value)
    }

    /// Returns the address of the experiment's random numbers. It is made of names, so that an experiment keeps its
    /// random numbers when other experiments join or leave the run. An experiment with an alias, that is, one that
    /// equals another estimator by definition, makes the draws of that estimator.
    pub fn address(&self, seed: u64, alias: Option<&EstimatorName>) -> Address {
        let Self { case, sampling: SamplingName { constant, kind }, control, .. } = self;
        let estimator = alias.unwrap_or(&self.estimator);
        let constant = constant.map_or(String::new(), |value| value.to_string());
        let swept =
            self.swept.map_or(String::new(), |at| format!("{}={}", at.what.key(), at.value));
        let mut name = format!("{case}|{estimator}|{constant}|{kind}|{control}|{swept}");
        if self.namesake > 1 {
            name = format!("{name}|{}", self.namesake - 1);
        }
        Address { seed, experiment: name_hash(&name), block: 0, lane: 0 }
    }
}

/// The stable text of an identity, as in `rod/albedos:analogue, σ̂ majorant (2), albedo 0.5`.
///
/// Different identities have different texts.
impl Display for ExperimentId {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        write!(f, "{}:{}", self.case, self.label())?;
        let is_swept = self.swept.is_some_and(|point| point.what == SweptQuantity::Sampling);
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

    fn id(settings: &str, swept: Option<(SweptQuantity, f64)>, namesake: usize) -> ExperimentId {
        ExperimentId {
            case: "rod/albedos".into(),
            problem: "rod".into(),
            estimator: EstimatorName { name: "single".into(), settings: settings.into() },
            sampling: SamplingName { constant: Some(Number(2.0)), kind: "majorant".into() },
            control: "mean".into(),
            swept: swept.map(|(what, value)| SweepPoint { what, value: Number(value) }),
            namesake,
        }
    }

    #[test]
    fn text_has_all_that_tells_experiments_apart() {
        let text = id("a=0.7", Some((SweptQuantity::AlbedoScale, 0.5)), 2).to_string();
        let expected =
            "rod/albedos:single (a=0.7) #2, σ̂ majorant (2), control mean, albedo-scale 0.5";
        assert_eq!(text, expected);
        assert_eq!(id("", None, 1).to_string(), "rod/albedos:single, σ̂ majorant (2), control mean");
    }

    #[test]
    fn json_gives_the_identity_back() {
        for id in [id("a=0.7", Some((SweptQuantity::Points, 3.0)), 2), id("", None, 1)] {
            let text = serde_json::to_string(&id).expect("an identity is JSON");
            assert_eq!(serde_json::from_str::<ExperimentId>(&text).expect("an identity"), id);
        }
    }
}
