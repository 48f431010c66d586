//! Results of a run, as a tree: run, cases, experiments, channels.
//!
//! ```text
//! Record       results, timing, comparison with a stored run
//! └ cases      a case with its sweep
//!   └ experiments   identity, theory, draws, findings of the checks, timing
//!     └ channels    one value of a draw each: theory, statistics, verdict
//! ```
//!
//! `results` is the same to the bit for any number of threads on any machine; times and the comparison are not.
//! Unknown is `None`, never zero.

pub mod baseline;
pub mod build;
pub mod curves;
pub mod evaluate;
mod experiment;
pub(crate) mod repeat;
pub mod scores;
mod theory;

use gate::CheckId;
use std::collections::BTreeMap;
use std::ops::Deref;

use serde::{Deserialize, Serialize};

pub use crate::case::Course;
use crate::case::sweep::SweptQuantity;
pub use crate::record::curves::{Anatomy, Best, CurvePoint, MeasuredPoint, PredictedCurve, Sweep};
pub use experiment::{ChannelRecord, ExperimentRecord, Finding, Score, Spent};
pub use gate::stats::verdict::{GateFinding, Verdict};

use crate::record::baseline::Comparison;
use numeric::digits::short;

/// Version of the record's format: it grows when a field changes its meaning or is removed.
pub const SCHEMA: u32 = 1;

/// A finished run, prediction or plan.
#[derive(Debug, Clone)]
pub struct Record {
    /// Draws, predictions and verdicts.
    pub results: Results,
    /// Time and place of the run.
    pub timing: Timing,
    /// Changes since a stored run, if the run was compared with one.
    pub comparison: Option<Comparison>,
}

/// Part of a record that depends only on the cases, the seed and the options.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Results {
    /// Version of the record's format, [`SCHEMA`].
    pub schema: u32,
    /// The version of the tool.
    pub version: String,
    /// The run's seed.
    pub seed: u64,
    /// Probability that a correct run shows any failure at all.
    pub alpha: f64,
    /// Addressing of random numbers, in words.
    pub streams: String,
    /// Shares of the error rate, and the evidence found.
    pub gate: Gate,
    /// True if a time limit or an interruption cut the draws short; such results depend on the machine.
    pub cut_by_time: bool,
    /// True if the budget of draws ran out before all was decided.
    pub cut_by_budget: bool,
    /// The cases, in the order they were given.
    pub cases: Vec<CaseRecord>,
}

/// The error control of a run: levels fixed before the first draw, and the evidence found.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Gate {
    /// K: number of scalars that go through the gate and share 4/5 of α.
    pub scalars: usize,
    /// Number of p-values that share 1/5 of α, by Holm.
    pub laws: usize,
    /// Number of declared biases, with an α of their own.
    pub biased: usize,
    /// β, the probability that a scalar passes although its bias equals its tolerance.
    pub beta: f64,
    /// A scalar fails at this ln E.
    pub ln_e_limit: f64,
    /// A scalar passes when both its ln P reach this.
    pub ln_p_limit: f64,
    /// ln of the mean e-value of all scalars: near or below 0 if all estimators are correct.
    pub ln_mean_e: Option<f64>,
    /// Distance of the strongest evidence from its limit; negative if something fails.
    pub smallest_margin: Option<f64>,
    /// The largest bias of a mean that a pass leaves possible, relative to its unit.
    pub worst_bias: Option<f64>,
    /// Number of means that passed although their variance could not be tested.
    pub variance_assumed: usize,
    /// e-BH list at α: the most suspect findings.
    pub triage: Vec<Suspect>,
}

/// An entry of the e-BH list.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Suspect {
    /// The case.
    pub case: String,
    /// Label of the experiment, with the swept value and the channel.
    pub experiment: String,
    /// The check.
    pub check: CheckId,
    /// ln of its e-value.
    #[serde(with = "gate::extended")]
    pub ln_e: f64,
}

/// Results of one case file.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct CaseRecord {
    /// The case's name: its path below the cases folder, without `.toml`.
    pub name: String,
    /// Its file, as it was given; for a built-in case, its name with `.toml`.
    pub path: String,
    /// Its title.
    pub title: String,
    /// The problem's name, as `trueflight list problems` has it.
    pub problem: String,
    /// The field's name in the catalogue.
    pub medium: String,
    /// Number of draws that share the setup lookups of a ray.
    pub draws_per_ray: u64,
    /// Smallest and largest bias of a mean, relative to its unit, that its experiments were planned to detect.
    pub visible_bias: Option<[f64; 2]>,
    /// Number of draws that its scalars took to pass, all together, in units of the typical number, `17 V/ε²` draws
    /// each.
    pub pace: Option<f64>,
    /// The experiments: estimators in the order of the case, each over the sweep.
    pub experiments: Vec<ExperimentRecord>,
    /// Swept quantity, with the predicted curves.
    pub sweep: Option<Sweep>,
    /// The ray seen from the side, for cases with a curve.
    pub anatomy: Option<Anatomy>,
    /// Contents of the files of the medium, a sentence each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub facts: Vec<String>,
    /// Notes on doubtful settings of the medium and its ray, such as a ray that misses the volume, a sentence each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
}

/// Time and place of a run; the times of experiments are in [`ExperimentRecord::spent`].
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Timing {
    /// Number of threads.
    pub threads: usize,
    /// The vector hardware, as in `avx512`.
    pub level: String,
    /// Wall-clock seconds of the whole run.
    pub seconds: f64,
    /// Date and time of its end, as in `2026-11-27 11:27 UTC`; empty unless a command drew.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub date: String,
    /// Command line of the run; empty unless a command drew.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub command: String,
}

/// Lists the rows of cases. Tables and plots have dozens of uses for rows: an iterator over a list is less to compile for
/// each of them than one over cases, experiments and channels.
fn listed(cases: &[CaseRecord]) -> std::vec::IntoIter<Row<'_>> {
    let mut rows = Vec::new();
    for case in cases {
        for experiment in &case.experiments {
            for (number, values) in experiment.channels.iter().enumerate() {
                rows.push(Row { case, experiment, number, values });
            }
        }
    }
    rows.into_iter()
}

impl Results {
    /// Returns all rows, in the order of the cases.
    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        listed(&self.cases)
    }
}

impl CaseRecord {
    /// Returns the channels of all experiments.
    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> + Clone {
        listed(std::slice::from_ref(self))
    }

    /// Returns the channels of all experiments, to change them.
    pub fn channels_mut(&mut self) -> impl Iterator<Item = &mut ChannelRecord> {
        self.experiments.iter_mut().flat_map(|experiment| &mut experiment.channels)
    }

    /// Names the experiments: σ̂ and swept values in the fewest digits that distinguish them, namesakes by number.
    pub fn name_experiments(&mut self) {
        let digits = Digits::of(self);
        let what = self.sweep.as_ref().map(|sweep| sweep.what);
        let mut namesakes: BTreeMap<String, usize> = BTreeMap::new();
        for experiment in &mut self.experiments {
            let id = &experiment.id;
            let mut parts = vec![experiment.label.clone()];
            match id.sampling.constant {
                Some(value) => parts.push(format!("σ\u{302} {}", digits.text(value.0))),
                None if id.sampling.kind.is_empty() => {}
                None => parts.push(format!("σ\u{302} {}", id.sampling.kind)),
            }
            if !id.control.is_empty() {
                parts.push(format!("control {}", id.control));
            }
            let is_named = what != Some(SweptQuantity::Sampling);
            if let Some(swept) = id.swept_value().filter(|_| is_named) {
                let what = what.map_or("at", SweptQuantity::key);
                parts.push(format!("{what} {}", digits.text(swept)));
            }
            let name = parts.join(", ");
            let number =
                namesakes.entry(name.clone()).and_modify(|number| *number += 1).or_insert(1);
            experiment.name = if *number > 1 { format!("{name} #{number}") } else { name };
        }
    }
}

/// Channel of an experiment with everything that it belongs to: a row of tables.
#[derive(Debug, Clone, Copy)]
pub struct Row<'a> {
    /// The case.
    pub case: &'a CaseRecord,
    /// The experiment.
    pub experiment: &'a ExperimentRecord,
    /// The number of the channel, from 0.
    pub number: usize,
    /// The channel; a row dereferences to it.
    pub values: &'a ChannelRecord,
}

impl Deref for Row<'_> {
    type Target = ChannelRecord;

    fn deref(&self) -> &ChannelRecord {
        self.values
    }
}

/// Quantity as measured and in theory.
#[derive(Debug, Clone, Copy)]
pub struct Compared {
    /// Measured value.
    pub measured: Option<f64>,
    /// Standard error of the measured value.
    pub deviation: Option<f64>,
    /// Value in theory.
    pub theory: Option<f64>,
    /// Difference in predicted standard errors.
    pub z: Option<f64>,
}

impl<'a> Row<'a> {
    /// Returns whether it is the first of its experiment.
    pub fn is_first(&self) -> bool {
        self.number == 0
    }

    /// Returns the findings about the channel, and about the experiment as a whole.
    pub fn findings(&self) -> impl Iterator<Item = &'a Finding> + use<'a> {
        self.experiment.findings_about(&self.values.channel)
    }

    /// Returns the findings of the row if each finding is listed once: the first row has those of the whole experiment.
    pub fn own_findings(&self) -> impl Iterator<Item = &'a Finding> + use<'a> {
        let mut own: Vec<&Finding> = self.findings().collect();
        own.retain(|finding| self.is_first() || !finding.channel.is_empty());
        own.into_iter()
    }

    /// Returns the name of the row within its case, as in `ratio, σ̂ 0.5, control mean, T(5)`.
    pub fn name(&self) -> String {
        self.name_with(&self.values.channel)
    }

    /// Returns the name of the experiment with a channel.
    pub fn name_with(&self, channel: &str) -> String {
        let comma = if channel.is_empty() { "" } else { ", " };
        format!("{}{comma}{channel}", self.experiment.name)
    }

    /// Returns the findings that gave the row its verdict.
    pub fn deciding(&self) -> impl Iterator<Item = &'a Finding> + use<'a> {
        let verdict = self.values.verdict;
        self.findings().filter(move |finding| Some(finding.verdict) == verdict)
    }

    /// Returns the values of a quantity.
    pub fn compared(&self, score: Score) -> Compared {
        let (row, experiment) = (self.values, self.experiment);
        let [measured, deviation, theory, z] = match score {
            Score::Mean => [row.mean, row.standard_error, row.truth, row.z_mean],
            Score::Variance => {
                [row.variance, row.variance_deviation, row.predicted_variance, row.z_variance]
            }
            Score::Lookups => [
                experiment.lookups_per_draw,
                experiment.lookups_deviation,
                experiment.predicted_lookups,
                experiment.z_lookups,
            ],
        };
        Compared { measured, deviation, theory, z }
    }

    /// Returns whether a z-score is to be read as normal.
    pub fn is_normal(&self, score: Score) -> bool {
        !self.values.not_normal.contains(&score)
    }

    /// Returns the measured variance over the predicted one.
    pub fn variance_ratio(&self) -> Option<f64> {
        let predicted = self.values.predicted_variance.filter(|&predicted| predicted > 0.0)?;
        Some(self.values.variance? / predicted)
    }

    /// Returns the largest ln E of its checks.
    pub fn largest_ln_e(&self) -> Option<f64> {
        self.findings().filter_map(Finding::evidence).reduce(f64::max)
    }

    /// Returns the nanoseconds of processor time for one lookup of `σ_t`; `None` without lookups.
    pub fn ns_per_lookup(&self) -> Option<f64> {
        let lookups = self.experiment.drawn? as f64 * self.experiment.lookups_per_draw?;
        (lookups > 0.0).then_some(self.experiment.spent.seconds? * 1e9 / lookups)
    }

    /// Returns the command to run next, with the word before it: to decide an inconclusive row, else to repeat the
    /// experiment.
    pub fn next_command(&self) -> Option<(&'static str, &'a str)> {
        let next = match self.values.verdict {
            Some(Verdict::Inconclusive) => ("decide", self.values.decide.as_str()),
            _ => ("repeat", self.experiment.command.as_str()),
        };
        Some(next).filter(|next| !next.1.is_empty())
    }
}

/// Number of digits in which the σ̂ and the swept values of a case are printed: different values print differently.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Digits(usize);

impl Digits {
    /// Number of digits that is enough for most cases.
    const USUAL: usize = 4;
    /// Number of digits that distinguishes any two numbers.
    const ALL: usize = 17;

    /// Returns the digits of a case.
    pub fn of(case: &CaseRecord) -> Self {
        Self::new(case.experiments.iter().flat_map(|one| [one.sampling(), one.swept()]))
    }

    /// Returns the digits of some values.
    pub fn new(values: impl Iterator<Item = Option<f64>>) -> Self {
        let mut values: Vec<f64> = values.flatten().collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        let is_enough = |digits: &usize| {
            let texts: Vec<String> = values.iter().map(|&value| short(value, *digits)).collect();
            texts.windows(2).all(|pair| pair[0] != pair[1])
        };
        Self((Self::USUAL..Self::ALL).find(is_enough).unwrap_or(Self::ALL))
    }

    /// Returns the text of a value.
    pub fn text(self, value: f64) -> String {
        short(value, self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_values_print_alike() {
        let texts = |values: &[f64]| {
            let digits = Digits::new(values.iter().copied().map(Some));
            values.iter().map(|&value| digits.text(value)).collect::<Vec<_>>()
        };
        assert_eq!(texts(&[0.486_39, 0.486_4, 0.6]), ["0.48639", "0.4864", "0.6"]);
        assert_eq!(texts(&[0.123_456, 2.0, 2.0]), ["0.1235", "2", "2"]);
        let near = [1.0, 1.0 + f64::EPSILON];
        assert_eq!(texts(&near), ["1", "1.0000000000000002"]);
        assert!(texts(&[]).is_empty());
    }
}
