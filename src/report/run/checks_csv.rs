//! `checks.csv`: one line for every finding of every check, with its numbers.
//!
//! | column | meaning |
//! |---|---|
//! | `check`, `what`, `channel` | check and quantity; the channel is empty for the experiment as a whole |
//! | `verdict`, `reason` | the result |
//! | `tolerance`, `variance_of_y` | ε and V of the gate, relative |
//! | `planned`, `draws`, `needed` | 27 V/ε²; the draws that it took; the draws that it would take, if more than planned
//! |
//! | `mean_of_y` | the observed relative difference |
//! | `ln_e`, `ln_e_limit` | the evidence against a correct estimator, and its limit, at which it fails |
//! | `ln_p_above`, `ln_p_below`, `ln_p_limit` | the evidence against a bias of +ε and of −ε, and its limit, at which it
//! passes |
//! | `z`, `p` | over the fixed draws |
//! | `block` | block after which it was decided, or with the violation |
//!
//! Findings about an experiment as a whole are listed once, with its first channel.

use crate::record::{Finding, GateFinding, Record, Row};
use crate::report::columns::{self, Column, columns};
use crate::report::{Artifact, ReportError};

/// Finding with its row.
struct Answer<'a> {
    of: Row<'a>,
    found: &'a Finding,
}

impl Answer<'_> {
    fn gate<T>(&self, number: fn(GateFinding) -> T) -> Option<T> {
        self.found.gate.map(number)
    }
}

/// Returns the columns of the file.
fn columns<'a>() -> Vec<Column<Answer<'a>>> {
    columns! {
        "case" = |answer| &answer.of.case.name;
        "estimator" = |answer| &answer.of.experiment.label;
        "sampling" = |answer| answer.of.experiment.sampling();
        "sampling_kind" = |answer| &answer.of.experiment.id.sampling.kind;
        "control" = |answer| &answer.of.experiment.id.control;
        "swept" = |answer| answer.of.experiment.swept();
        "check" = |answer| &answer.found.check;
        "what" = |answer| &answer.found.what;
        "channel" = |answer| &answer.found.channel;
        "verdict" = |answer| answer.found.verdict.word();
        "reason" = |answer| &answer.found.reason;
        "tolerance" = |answer| answer.gate(|gate| gate.tolerance);
        "variance_of_y" = |answer| answer.gate(|gate| gate.variance);
        "planned" = |answer| answer.gate(|gate| gate.planned);
        "draws" = |answer| answer.gate(|gate| gate.draws);
        "needed" = |answer| answer.gate(|gate| gate.needed).flatten();
        "mean_of_y" = |answer| answer.gate(|gate| gate.mean);
        "ln_e" = |answer| answer.gate(|gate| gate.ln_e);
        "ln_e_limit" = |answer| answer.gate(|gate| gate.ln_e_limit);
        "ln_p_above" = |answer| answer.gate(|gate| gate.ln_p[0]);
        "ln_p_below" = |answer| answer.gate(|gate| gate.ln_p[1]);
        "ln_p_limit" = |answer| answer.gate(|gate| gate.ln_p_limit);
        "z" = |answer| answer.found.z;
        "p" = |answer| answer.found.p;
        "block" = |answer| answer.found.block;
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
    Ok(vec![columns::artifact("checks.csv", &columns(), answers)?])
}
