//! `checks.csv`: one line for every finding of every check, with its numbers.
//!
//! Findings about an experiment as a whole are listed once, with its first channel.

use crate::record::{Finding, GateFinding, Record, Row};
use crate::report::fields::{self, Field, fields};
use crate::report::{Artifact, ReportError};

/// Finding with its row.
pub struct Answer<'a> {
    of: Row<'a>,
    found: &'a Finding,
}

impl Answer<'_> {
    fn gate<T>(&self, number: fn(GateFinding) -> T) -> Option<T> {
        self.found.gate.map(number)
    }
}

/// Returns the fields of the file.
pub fn of_findings<'a>() -> Vec<Field<Answer<'a>>> {
    fields! {
        "case": "Case: the name of its file" = |answer| &answer.of.case.name;
        "estimator": "Estimator with its settings" = |answer| &answer.of.experiment.label;
        "sampling": "Sampling extinction σ̂, if it is a constant" = |answer| answer.of.experiment.sampling();
        "sampling_kind": "Kind of σ̂, as constant or local majorants" = |answer| &answer.of.experiment.id.sampling.kind;
        "control": "Control extinction" = |answer| &answer.of.experiment.id.control;
        "swept": "Value of the swept quantity" = |answer| answer.of.experiment.swept();
        "check": "Name of the check, as in `trueflight list checks`" = |answer| &answer.found.check;
        "what": "Quantity" = |answer| &answer.found.what;
        "channel": "Which value of a draw; empty for the experiment as a whole" = |answer| &answer.found.channel;
        "verdict": "Result of the check" = |answer| answer.found.verdict.word();
        "reason": "Reason of the verdict; empty for a plain pass" = |answer| &answer.found.reason;
        "tolerance": "Tolerance ε of the gate, relative" = |answer| answer.gate(|gate| gate.tolerance);
        "variance_of_y": "Variance V of the gate, relative" = |answer| answer.gate(|gate| gate.variance);
        "planned": "Number of planned draws, 27 V/ε²" = |answer| answer.gate(|gate| gate.planned);
        "draws": "Number of draws until the decision" = |answer| answer.gate(|gate| gate.draws);
        "needed": "Number of draws that it would take, if more than planned" = |answer| answer.gate(|gate| gate.needed).flatten();
        "mean_of_y": "Observed relative difference from theory" = |answer| answer.gate(|gate| gate.mean);
        "ln_e": "Evidence against a correct estimator: it fails at the limit" = |answer| answer.gate(|gate| gate.ln_e);
        "ln_e_limit": "Limit of ln E" = |answer| answer.gate(|gate| gate.ln_e_limit);
        "ln_p_above": "Evidence against a bias of +ε" = |answer| answer.gate(|gate| gate.ln_p[0]);
        "ln_p_below": "Evidence against a bias of −ε" = |answer| answer.gate(|gate| gate.ln_p[1]);
        "ln_p_limit": "Limit of both ln P, at which it passes" = |answer| answer.gate(|gate| gate.ln_p_limit);
        "z": "Difference from theory in standard errors, over the fixed draws" = |answer| answer.found.z;
        "p": "p-value of a test of a whole distribution" = |answer| answer.found.p;
        "block": "Block after which it was decided, or with the violation" = |answer| answer.found.block;
    }
}

/// Returns one row per finding.
///
/// # Errors
///
/// An encoder or the painter fails.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    let answers = record
        .results
        .rows()
        .flat_map(|of| of.own_findings().map(move |found| Answer { of, found }));
    Ok(vec![fields::artifact("checks.csv", &of_findings(), answers)?])
}
