//! Why a case was not exported.

use std::path::PathBuf;

use crate::case::CaseError;

/// Why a case was not exported.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The case file is wrong.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The case is right, and no renderer can show it.
    #[error("{case} cannot be exported to {target}: {why}; {cure}")]
    Unsuitable {
        /// The case.
        case: String,
        /// The renderer.
        target: &'static str,
        /// What is in the way.
        why: String,
        /// Which case would do.
        cure: String,
    },
    /// Theory has no answer for what would be exported.
    #[error("{case} cannot be exported: theory has no answer for the sampled field: {why}")]
    Unknown {
        /// The case.
        case: String,
        /// The reason.
        why: String,
    },
    /// `truth.json` could not be encoded.
    #[error("cannot encode truth.json: {0}")]
    Json(#[from] serde_json::Error),
    /// A file could not be written.
    #[error("cannot write {}; free some space or give another folder with --out", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
}
