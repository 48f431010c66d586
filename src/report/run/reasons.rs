//! Reasons of verdicts in words, for every report of a run.

use gate::session::Reason;

use crate::record::{Finding, Row};
use crate::report::run::failures::Failure;

impl Finding {
    /// Returns the reason of the verdict, with the numbers; empty for a plain pass.
    pub fn words(&self) -> String {
        self.reason.as_ref().map_or_else(String::new, Reason::to_string)
    }
}

impl Row<'_> {
    /// Returns the reason of the verdict, or of the one that a plan foresees; empty for a plain pass.
    pub fn reason(&self) -> String {
        let foreseen = self.values.foreseen.iter().flat_map(|foreseen| &foreseen.reasons);
        let reasons = self.deciding().filter_map(|finding| finding.reason.as_ref());
        let texts = foreseen.chain(reasons).map(Reason::to_string);
        let refusal = self.experiment.refusal.iter().map(ToString::to_string);
        let mut different: Vec<String> = Vec::new();
        for text in refusal.chain(texts) {
            if !different.contains(&text) {
                different.push(text);
            }
        }
        different.join("; ")
    }

    /// Returns the reason of the verdict; without one, the notes on the case.
    pub fn why(&self) -> String {
        let reason = self.reason();
        if reason.is_empty() { self.case.notes.join("; ") } else { reason }
    }
}

impl Failure<'_> {
    /// Returns the reason, with the most important numbers.
    pub fn reason(&self) -> String {
        let reason = self.finding.map_or_else(String::new, Finding::words);
        if reason.is_empty() { self.row.reason() } else { reason }
    }
}
