//! What a check found.

use std::fmt;

use crate::session::Judgement;
use crate::stats::verdict::Verdict;

/// So many values are told of.
const TOLD: usize = 8;

/// The verdict of a check, with everything that `trueflight judge` tells.
///
/// ```
/// let outcome = trueflight_gate::check("u", |rng| rng.uniform()).truth(0.6).range(0.0, 1.0).verdict()?;
/// assert!(!outcome.passed());
/// assert!(outcome.reason().contains("the mean is off by -"));
/// # Ok::<(), trueflight_gate::check::CheckError>(())
/// ```
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Outcome {
    /// The check's name.
    pub name: String,
    /// The chance that a correct estimator fails, all values together.
    pub alpha: f64,
    /// The names of the values, where they are channels of a case; empty otherwise.
    pub channels: Vec<String>,
    /// What was found of each value of a draw.
    pub values: Vec<Judgement>,
}

impl Outcome {
    /// Fail if any value fails, pass if all pass.
    pub fn verdict(&self) -> Verdict {
        Verdict::worst(self.values.iter().map(|value| value.verdict))
    }

    /// Whether all values pass.
    pub fn passed(&self) -> bool {
        self.verdict() == Verdict::Pass
    }

    /// The name of a value.
    fn value(&self, index: usize) -> String {
        self.channels.get(index).cloned().unwrap_or_else(|| format!("value {index}"))
    }

    /// Why it does not pass, in words; empty for a plain pass.
    pub fn reason(&self) -> String {
        let verdict = self.verdict();
        let alike = self.values.iter().enumerate().filter(|(_, value)| value.verdict == verdict);
        let reasons = alike.filter(|(_, value)| !value.reason.is_empty());
        let many = self.values.len() > 1;
        let said = reasons.map(|(index, value)| {
            if many {
                format!("{}: {}", self.value(index), value.reason)
            } else {
                value.reason.clone()
            }
        });
        let mut said: Vec<String> = said.collect();
        let count = said.len();
        if count > TOLD {
            said.truncate(TOLD);
            said.push(format!("and {} others", count - TOLD));
        }
        said.join("; ")
    }

    /// Panics unless all values pass, with the words of [`Outcome`]'s display.
    ///
    /// # Panics
    ///
    /// The verdict is fail or inconclusive.
    #[track_caller]
    pub fn assert_pass(&self) {
        assert!(self.passed(), "check {self}");
    }
}

/// The lines of `trueflight judge`, under a line with the verdict.
impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let reason = self.reason();
        write!(f, "`{}`: {}", self.name, self.verdict().word())?;
        if !reason.is_empty() {
            write!(f, ": {reason}")?;
        }
        // Those that decide come first where there are too many to tell.
        let verdict = self.verdict();
        let mut told: Vec<(usize, &Judgement)> = self.values.iter().enumerate().collect();
        if told.len() > TOLD {
            told.sort_by_key(|(_, value)| value.verdict != verdict);
        }
        for (index, value) in told.iter().take(TOLD) {
            let name = if self.values.len() > 1 { self.value(*index) } else { self.name.clone() };
            for (word, text) in value.lines(&name) {
                write!(f, "\n  {word:10}{text}")?;
            }
        }
        match told.len().saturating_sub(TOLD) {
            0 => Ok(()),
            rest => write!(f, "\n  and {rest} other values"),
        }
    }
}
