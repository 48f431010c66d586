//! Rows of tables: one channel of an experiment with all that it belongs to.

use std::ops::Deref;

use crate::record::{CaseRecord, ChannelRecord, ExperimentRecord, Finding, Verdict};
use numeric::digits::short;

/// One channel of an experiment with all that it belongs to: a row of tables.
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

impl<'a> Row<'a> {
    /// Whether it is the first of its experiment.
    pub fn is_first(&self) -> bool {
        self.number == 0
    }

    /// The findings about the channel, and about the experiment as a whole.
    pub fn findings(&self) -> impl Iterator<Item = &'a Finding> + use<'a> {
        self.experiment.findings_about(&self.values.channel)
    }

    /// The findings that stand in the row if each stands once: those about the experiment as a whole are in the first row.
    pub fn own_findings(&self) -> impl Iterator<Item = &'a Finding> + use<'a> {
        let is_first = self.is_first();
        self.findings().filter(move |finding| is_first || !finding.channel.is_empty())
    }

    /// Name of the row within its case, as in `ratio, σ̂ 0.5, control mean, T(5)`.
    pub fn name(&self) -> String {
        self.name_with(&self.values.channel)
    }

    /// Name of the experiment with a channel.
    pub fn name_with(&self, channel: &str) -> String {
        let comma = if channel.is_empty() { "" } else { ", " };
        format!("{}{comma}{channel}", self.experiment.name)
    }

    /// The reason of the verdict; without one, the doubts about the case.
    pub fn why(&self) -> String {
        let reason = &self.values.reason;
        if reason.is_empty() { self.case.notes.join("; ") } else { reason.clone() }
    }

    /// Nanoseconds of processor time for one lookup of `σ_t`; `None` without lookups.
    pub fn ns_per_lookup(&self) -> Option<f64> {
        let lookups = self.experiment.drawn? as f64 * self.experiment.lookups_per_draw?;
        (lookups > 0.0).then_some(self.experiment.spent.seconds? * 1e9 / lookups)
    }

    /// The command to run next, with the word before it: to decide an inconclusive row, else to repeat the experiment.
    pub fn next_command(&self) -> Option<(&'static str, &'a str)> {
        let next = match self.values.verdict {
            Some(Verdict::Inconclusive) => ("decide", self.values.decide.as_str()),
            _ => ("repeat", self.experiment.command.as_str()),
        };
        Some(next).filter(|next| !next.1.is_empty())
    }
}

/// Number of digits in which the σ̂ and the swept values of a case are printed: no two different values print alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Digits(usize);

impl Digits {
    /// Enough digits for most cases.
    const FEW: usize = 4;
    /// Digits that tell any two numbers apart.
    const ALL: usize = 17;

    /// The digits of a case.
    pub fn of(case: &CaseRecord) -> Self {
        Self::new(case.experiments.iter().flat_map(|one| [one.sampling(), one.swept()]))
    }

    /// The digits of some values.
    pub fn new(values: impl Iterator<Item = Option<f64>>) -> Self {
        let mut values: Vec<f64> = values.flatten().collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        let is_enough = |digits: &usize| {
            let texts: Vec<String> = values.iter().map(|&value| short(value, *digits)).collect();
            texts.windows(2).all(|pair| pair[0] != pair[1])
        };
        Self((Self::FEW..Self::ALL).find(is_enough).unwrap_or(Self::ALL))
    }

    /// The text of a value.
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
