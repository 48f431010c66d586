//! Errors as exceptions of Python.

use pyo3::import_exception;
use pyo3::prelude::*;
use trueflight::case::CaseError;
use trueflight::check::{CheckError, CheckFault};

import_exception!(trueflight._errors, Error);
import_exception!(trueflight._errors, CaseNotFound);

/// Error that becomes an exception of Python.
#[derive(Debug)]
pub enum Failure {
    /// A case does not exist.
    NotFound(String),
    /// An argument is invalid.
    Wrong(String),
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::NotFound(text) => CaseNotFound::new_err(text),
            Failure::Wrong(text) => Error::new_err(text),
        }
    }
}

impl From<Vec<CaseError>> for Failure {
    fn from(errors: Vec<CaseError>) -> Self {
        let text = errors.iter().map(CaseError::in_full).collect::<Vec<_>>().join("\n\n");
        let is_missing = |error: &CaseError| match error {
            CaseError::Unknown { .. } => true,
            CaseError::Unreadable { cause, .. } => cause.kind() == std::io::ErrorKind::NotFound,
            _ => false,
        };
        if errors.iter().any(is_missing) { Self::NotFound(text) } else { Self::Wrong(text) }
    }
}

impl From<CaseError> for Failure {
    fn from(error: CaseError) -> Self {
        vec![error].into()
    }
}

/// Messages of the library, with its methods as arguments of Python.
impl From<CheckError> for Failure {
    fn from(error: CheckError) -> Self {
        let message = match &error.fault {
            CheckFault::NoTruth => {
                "the truth is not known; give it by truth=…, or by case=… and estimator=…".to_owned()
            }
            CheckFault::Twice(what) => format!(
                "the {what} is given twice, by a number and by case=…; leave one of them out, or add mean_only=True"
            ),
            CheckFault::NoLookups => {
                "a draw does not tell its lookups; give the pair (draws, lookups), or leave lookups=… out".to_owned()
            }
            CheckFault::NoLookupsWanted => {
                "nothing is known of the lookups; give lookups=(mean, variance), or draws alone".to_owned()
            }
            other => other.to_string(),
        };
        Self::Wrong(format!("check `{}`: {message}", error.check))
    }
}
