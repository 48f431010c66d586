//! `checks.csv`: every answer of every check on one line, with the numbers behind it.
//!
//! | column | meaning |
//! |---|---|
//! | `check`, `what`, `channel` | who asked, about what; the channel is empty for the experiment as a whole |
//! | `verdict`, `reason` | the answer |
//! | `tolerance`, `variance_of_y` | ε and V of the gate, relative |
//! | `planned`, `draws`, `needed` | 27 V/ε²; the draws that it took; those it would take, where more than planned |
//! | `mean_of_y` | the observed relative difference |
//! | `ln_e`, `ln_e_limit` | the evidence against a correct estimator, and where it fails |
//! | `ln_p_above`, `ln_p_below`, `ln_p_limit` | the evidence against a bias of +ε and of −ε, and where it passes |
//! | `z`, `p` | over the fixed draws |
//! | `block` | where it was decided or found |
//!
//! What concerns an experiment as a whole stands once, with its first channel.

use std::path::PathBuf;

use crate::harness::record::{Finding, Record, Row};
use crate::report::number::exact;
use crate::report::rows::{joined, table};
use crate::report::{Artifact, Report, ReportError};

/// One row per answer.
pub struct ChecksCsv;

const HEADER: [&str; 25] = [
    "case",
    "estimator",
    "sampling",
    "sampling_kind",
    "control",
    "swept",
    "check",
    "what",
    "channel",
    "verdict",
    "reason",
    "tolerance",
    "variance_of_y",
    "planned",
    "draws",
    "needed",
    "mean_of_y",
    "ln_e",
    "ln_e_limit",
    "ln_p_above",
    "ln_p_below",
    "ln_p_limit",
    "z",
    "p",
    "block",
];

impl Report for ChecksCsv {
    fn render(&self, record: &Record) -> Result<Vec<Artifact>, ReportError> {
        let rows = joined(record);
        let mut lines = Vec::new();
        for (i, joined) in rows.iter().enumerate() {
            let is_first = i == 0 || rows[i - 1].row.stream != joined.row.stream;
            let own = |found: &&Finding| is_first || !found.channel.is_empty();
            let found = joined.row.findings.iter().filter(own);
            lines.extend(found.map(|found| line(&joined.case.name, joined.row, found)));
        }
        let bytes = table("checks.csv", HEADER, lines)?.into_bytes();
        Ok(vec![Artifact { path: PathBuf::from("checks.csv"), bytes }])
    }
}

fn line(case: &str, row: &Row, found: &Finding) -> [String; 25] {
    let number = |x: Option<f64>| x.map(exact).unwrap_or_default();
    let count = |n: Option<u64>| n.map(|n| n.to_string()).unwrap_or_default();
    let gate = found.gate;
    [
        case.to_owned(),
        row.estimator.clone(),
        number(row.sampling),
        row.sampling_kind.clone(),
        row.control.clone(),
        number(row.swept),
        found.check.clone(),
        found.what.clone(),
        found.channel.clone(),
        found.verdict.word().to_owned(),
        found.reason.clone(),
        number(gate.map(|gate| gate.tolerance)),
        number(gate.map(|gate| gate.variance)),
        number(gate.map(|gate| gate.planned)),
        count(gate.map(|gate| gate.draws)),
        number(gate.and_then(|gate| gate.needed)),
        number(gate.map(|gate| gate.mean)),
        number(gate.map(|gate| gate.ln_e)),
        number(gate.map(|gate| gate.ln_e_limit)),
        number(gate.map(|gate| gate.ln_p[0])),
        number(gate.map(|gate| gate.ln_p[1])),
        number(gate.map(|gate| gate.ln_p_limit)),
        number(found.z),
        number(found.p),
        count(found.block),
    ]
}
