//! Result of a comparison of two runs.

use serde::{Deserialize, Serialize};

use crate::record::baseline::ChannelId;

/// What the comparison is to say at which level.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rules {
    /// The chance that equal code shows any regression of a variance or of lookups.
    pub alpha: f64,
    /// Relative increase of the time per draw that is no regression; `None` if times are not compared.
    pub time_tolerance: Option<f64>,
}

/// What changed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// What the stored run is called.
    pub name: String,
    /// The levels.
    pub rules: Rules,
    /// Whether e-values were multiplied, and why not.
    pub sequel: Sequel,
    /// How many variances and lookups were compared: α is shared among them.
    pub compared: usize,
    /// How many times per draw were compared.
    pub times: usize,
    /// How many e-values were multiplied with stored ones.
    pub multiplied: usize,
    /// How many variances were too uncertain to compare.
    pub blunt: usize,
    /// What of the experiments that both have was not compared.
    pub left_out: LeftOut,
    /// What grew or shrank.
    pub changes: Vec<Change>,
    /// Checks that fail over all runs together.
    pub drifts: Vec<Drift>,
    /// Experiments of this run that the baseline has not.
    pub added: Vec<ChannelId>,
    /// Experiments of the baseline that this run has not.
    pub missing: Vec<ChannelId>,
    /// Experiments whose case has another text than in the baseline.
    pub rewritten: Vec<ChannelId>,
}

/// Whether the e-values of both runs multiply.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sequel {
    /// They do: so many runs together.
    Run(usize),
    /// The seed is among those stored: its draws say nothing new.
    SameSeed,
    /// Another program drew.
    OtherProgram,
}

/// What is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// The sample variance of one draw.
    Variance,
    /// Lookups per draw.
    Lookups,
    /// Processor nanoseconds per draw.
    Time,
}

/// A value with its standard error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// The value.
    #[serde(with = "gate::extended")]
    pub value: f64,
    /// Its standard error; `None` for times, for one figure has none.
    #[serde(default, with = "gate::extended")]
    pub error: Option<f64>,
}

/// A quantity that differs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// The experiment.
    pub id: ChannelId,
    /// The quantity.
    pub quantity: Quantity,
    /// Its stored value.
    pub before: Measured,
    /// Its value now.
    pub now: Measured,
    /// now/before.
    #[serde(with = "gate::extended")]
    pub ratio: f64,
    /// Where the true ratio is; `None` for times.
    #[serde(default, with = "gate::extended")]
    pub interval: Option<[f64; 2]>,
    /// Whether it became worse.
    pub is_regression: bool,
    /// The command that repeats the experiment.
    pub command: String,
}

/// A check that fails over several runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Drift {
    /// The experiment.
    pub id: ChannelId,
    /// The check.
    pub check: String,
    /// ln E of all runs together.
    pub ln_e: f64,
    /// The limit.
    pub limit: f64,
    /// The command that repeats the experiment.
    pub command: String,
}

impl Comparison {
    /// Of nothing yet.
    pub fn new(name: &str, rules: &Rules, sequel: Sequel) -> Self {
        Self {
            name: name.to_owned(),
            rules: *rules,
            sequel,
            compared: 0,
            times: 0,
            multiplied: 0,
            blunt: 0,
            left_out: LeftOut::default(),
            changes: Vec::new(),
            drifts: Vec::new(),
            added: Vec::new(),
            missing: Vec::new(),
            rewritten: Vec::new(),
        }
    }

    /// Whether anything became worse.
    pub fn fails(&self) -> bool {
        !self.drifts.is_empty() || self.changes.iter().any(|change| change.is_regression)
    }

    /// Whether nothing of the run was compared with anything: such a comparison says nothing.
    pub fn is_empty(&self) -> bool {
        self.compared == 0 && self.times == 0 && self.multiplied == 0
    }
}

/// The experiments that both runs have of which something was not compared, by the reason.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    /// σ̂ was learned from other pilot rays: neither variance nor lookups are of the same estimator.
    pub relearned: Vec<ChannelId>,
    /// The variance is too uncertain.
    pub blunt: Vec<ChannelId>,
    /// Theory has no kurtosis, so that nobody knows how uncertain the variance is.
    pub unpredicted: Vec<ChannelId>,
    /// Theory has no variance of the number of lookups.
    pub uncounted: Vec<ChannelId>,
    /// The draws took less than 0.1 s, then or now.
    pub brief: Vec<ChannelId>,
    /// The lookups were shared with other experiments, then or now: the time is of their company.
    pub shared: Vec<ChannelId>,
}
