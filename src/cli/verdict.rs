//! From verdicts to an exit code.

use clap::ValueEnum;

use super::USAGE;
use super::output::{self, Errors};
use crate::record::baseline::Comparison;
use crate::record::{Record, Verdict};
use crate::report::run::junit;

/// Nothing fails, but something is not decided.
pub const UNDECIDED: u8 = 3;

/// What an inconclusive experiment does to the exit code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Inconclusive {
    /// It counts as failing: exit code 1
    Fail,
    /// It counts as passing: exit code 0
    Pass,
}

impl Inconclusive {
    /// What it is in a JUnit report.
    pub fn in_junit(wish: Option<Self>) -> junit::Inconclusive {
        match wish {
            None => junit::Inconclusive::Error,
            Some(Self::Fail) => junit::Inconclusive::Failure,
            Some(Self::Pass) => junit::Inconclusive::Skipped,
        }
    }
}

/// The exit code at the end of a command, with what went wrong beside the verdicts.
pub fn close(record: &Record, inconclusive: Option<Inconclusive>, errors: &Errors) -> u8 {
    let errors_first = errors.close(0);
    let code = exit_code(record, inconclusive);
    if errors_first == 0 { code } else { errors_first }
}

/// Fail, or worse than a stored run, before refused cases before inconclusive before pass.
fn exit_code(record: &Record, inconclusive: Option<Inconclusive>) -> u8 {
    let any = |verdict| record.results.rows().any(|row| row.verdict == Some(verdict));
    let is_worse = record.comparison.as_ref().is_some_and(Comparison::fails);
    if is_worse || any(Verdict::Fail) {
        return 1;
    }
    let refused = record
        .results
        .cases
        .iter()
        .find(|case| case.rows().all(|row| row.verdict == Some(Verdict::Refused)));
    if let Some(case) = refused {
        output::complain(&anyhow::anyhow!(
            "every experiment of {} is refused, so nothing was tested; \
             `trueflight plan` says why",
            case.name
        ));
        return USAGE;
    }
    match inconclusive {
        _ if !any(Verdict::Inconclusive) => 0,
        None => UNDECIDED,
        Some(Inconclusive::Fail) => 1,
        Some(Inconclusive::Pass) => 0,
    }
}
