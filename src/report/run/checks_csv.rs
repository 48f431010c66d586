//! `checks.csv`: one line for every finding of every check, with its numbers.
//!
//! Findings about an experiment as a whole are listed once, with its first channel.

use crate::record::{Finding, GateFinding, Record, Row};
use crate::report::fields::{self, Table, table};
use crate::report::{Artifact, ReportError};

/// Finding with its row.
pub struct FindingRow<'a> {
    /// Row.
    pub of: Row<'a>,
    /// Finding.
    pub finding: &'a Finding,
}

impl FindingRow<'_> {
    fn gate<T>(&self, number: fn(GateFinding) -> T) -> Option<T> {
        self.finding.gate.map(number)
    }
}

table! {
    impl<'a> for FindingRow<'a> {
        "case" = |row| &row.of.case.name;
        "estimator" = |row| &row.of.experiment.label;
        "sampling" = |row| row.of.experiment.sampling();
        "sampling_kind" = |row| &row.of.experiment.id.sampling.kind;
        "control" = |row| &row.of.experiment.id.control;
        "swept" = |row| row.of.experiment.swept();
        "check": "Name of the check, as in `trueflight list checks`" = |row| row.finding.check.name();
        "what": "Quantity" = |row| &row.finding.what;
        "channel": "Which value of a draw; empty for the experiment as a whole" = |row| &row.finding.channel;
        "verdict": "Result of the check" = |row| row.finding.verdict.word();
        "reason": "Reason of the verdict; empty for a plain pass" = |row| row.finding.words();
        "tolerance" ["ε", "", Percent]: "Tolerance ε of the gate, relative" = |row| row.gate(|gate| gate.tolerance);
        "variance_of_y": "Variance V of the gate, relative" = |row| row.gate(|gate| gate.variance);
        "planned": "Number of planned draws, 27 V/ε²" = |row| row.gate(|gate| gate.planned);
        "draws": "Number of draws until the decision" = |row| row.gate(|gate| gate.draws);
        "needed" ["needed", "", Enough]: "Number of draws that it would take, if more than planned" = |row| row.gate(|gate| gate.needed).flatten();
        "mean_of_y" ["off by", "", Percent]: "Observed relative difference from theory" = |row| row.gate(|gate| gate.mean);
        "ln_e" ["ln E", "", Short(4)]: "Evidence against a correct estimator: it fails at the limit" = |row| row.gate(|gate| gate.ln_e);
        "ln_e_limit" ["limit", "", Short(4)]: "Limit of ln E" = |row| row.gate(|gate| gate.ln_e_limit);
        "ln_p_above" ["ln P of +ε", "", Short(4)]: "Evidence against a bias of +ε" = |row| row.gate(|gate| gate.ln_p[0]);
        "ln_p_below" ["ln P of −ε", "", Short(4)]: "Evidence against a bias of −ε" = |row| row.gate(|gate| gate.ln_p[1]);
        "ln_p_limit" ["limit", "", Short(4)]: "Limit of both ln P, at which it passes" = |row| row.gate(|gate| gate.ln_p_limit);
        "z" ["z", "", Signed]: "Difference from theory in standard errors, over the fixed draws" = |row| row.finding.z;
        "p" ["p", "", Short(3)]: "p-value of a test of a whole distribution" = |row| row.finding.p;
        "block": "Block after which it was decided, or with the violation" = |row| row.finding.block;
    }
}

/// Returns one row per finding.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    let findings = record
        .results
        .rows()
        .flat_map(|of| of.own_findings().map(move |finding| FindingRow { of, finding }));
    Ok(vec![fields::artifact("checks.csv", &FindingRow::fields(), findings)?])
}
