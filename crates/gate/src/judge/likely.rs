//! Likely causes of a failure of foreign draws.

use super::judgement::Judgement;
use crate::causes::{Pattern, Side};
use crate::stats::verdict::Verdict;

impl Judgement {
    /// Which checks fail, and on which side; draws that depend on each other have no other side.
    pub fn pattern(&self) -> Pattern {
        let mut pattern = Pattern::default();
        if self.independence.is_refuted() {
            pattern.dependence = true;
            return pattern;
        }
        for finding in self.findings.iter().filter(|found| found.verdict == Verdict::Fail) {
            pattern.note(&finding.check, finding.gate.map(|gate| gate.mean));
        }
        // The first word of the reason is the check that a draw refutes by itself.
        match self.reason.split(':').next() {
            _ if self.refuting == 0 => {}
            Some("numeric" | "range") => pattern.number = true,
            Some("lookups") => pattern.lookups = Side::Both,
            _ => pattern.mean = Side::Both,
        }
        pattern
    }
}
