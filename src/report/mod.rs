//! Reports: pure functions from results to the text on the screen and the bytes of files.
//!
//! Reports are stored by input: each folder has the screen, the tables, the page and the plots of one kind of results.
//! [`run`] is about a [`Record`](crate::record::Record). Shared are [`fields`], [`layout`], [`lists`], [`page`],
//! [`mod@html`], [`junit`] and [`plots`].
//! A report does no arithmetic beyond formatting.

#![allow(clippy::missing_errors_doc)] // [`ReportError`] tells all of them

pub mod advise;
pub mod bench;
pub mod changes;
pub mod fields;
pub mod html;
pub mod judge;
pub mod junit;
pub mod layout;
pub mod lists;
pub mod manual;
pub mod page;
pub mod plots;
pub mod render;
pub mod run;

use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use media::files;

/// File of a report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Artifact {
    /// Path below the folder of results.
    pub path: PathBuf,
    /// Content.
    pub bytes: Vec<u8>,
}

impl Artifact {
    /// Makes a file of text.
    pub fn text(path: impl Into<PathBuf>, text: String) -> Self {
        Self { path: path.into(), bytes: text.into_bytes() }
    }
}

/// Reason why a report could not be rendered or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// The csv encoder failed.
    #[error("cannot encode {name} as csv")]
    Csv {
        /// The file.
        name: String,
        /// The encoder's reason.
        source: csv::Error,
    },
    /// The json encoder failed.
    #[error("cannot encode as json: {0}")]
    Json(#[from] serde_json::Error),
    /// A drawing could not be painted.
    #[error("cannot draw {figure}: {message}")]
    Draw {
        /// The figure.
        figure: String,
        /// The painter's reason.
        message: String,
    },
    /// An artifact would leave the folder of results.
    #[error("`{}` leads out of the results; name the case without `..` or a leading `/`", .0.display())]
    Outside(PathBuf),
    /// A folder could not be made.
    #[error("cannot make the folder {}; give another with --out", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A file could not be written.
    #[error("cannot write {}; free some space or give another with --out", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}

/// Writes the artifacts below `out_dir`, each under a temporary name that is then renamed. An error does not keep other
/// files from being written. Returns all errors.
pub fn write(artifacts: &[Artifact], out_dir: &Path) -> Vec<ReportError> {
    artifacts.iter().filter_map(|artifact| write_one(artifact, out_dir).err()).collect()
}

fn write_one(artifact: &Artifact, out_dir: &Path) -> Result<(), ReportError> {
    let inside = artifact.path.components().all(|part| matches!(part, Component::Normal(_)));
    if !inside {
        return Err(ReportError::Outside(artifact.path.clone()));
    }
    let path = out_dir.join(&artifact.path);
    let folder = path.parent().unwrap_or(out_dir);
    fs::create_dir_all(folder)
        .map_err(|source| ReportError::Folder { path: folder.to_owned(), source })?;
    files::replace(&path, &artifact.bytes)
        .map_err(|source| ReportError::Write { path: path.clone(), source })
}

/// Returns the path of a case's file: its name, which may have folders, with an ending.
pub fn case_path(case: &str, ending: &str) -> PathBuf {
    PathBuf::from(format!("{case}.{ending}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn artifact(path: &str) -> Artifact {
        Artifact { path: PathBuf::from(path), bytes: b"new".to_vec() }
    }

    #[test]
    fn a_file_is_replaced_whole_and_nothing_else_is_left() {
        let out = tempfile::tempdir().expect("a temporary folder");
        let old = out.path().join("a/b.csv");
        fs::create_dir_all(out.path().join("a")).expect("a folder");
        fs::write(&old, "old and longer").expect("a file");
        assert!(write(&[artifact("a/b.csv")], out.path()).is_empty());
        assert_eq!(fs::read(&old).expect("reads"), b"new");
        assert_eq!(fs::read_dir(out.path().join("a")).expect("lists").count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn results_are_readable_by_all() {
        use std::os::unix::fs::PermissionsExt;
        let out = tempfile::tempdir().expect("a temporary folder");
        assert!(write(&[artifact("b.csv")], out.path()).is_empty());
        let mode = fs::metadata(out.path().join("b.csv")).expect("exists").permissions().mode();
        assert_eq!(mode & 0o777, 0o644);
    }

    #[test]
    fn a_path_out_of_the_results_is_refused() {
        let out = tempfile::tempdir().expect("a temporary folder");
        for path in ["../b.csv", "/b.csv", "a/../../b.csv"] {
            let error = write(&[artifact(path)], out.path()).pop().expect("must refuse");
            assert!(matches!(error, ReportError::Outside(_)), "{error}");
        }
    }

    #[test]
    fn a_failure_names_the_path_and_the_cure() {
        let out = tempfile::tempdir().expect("a temporary folder");
        fs::write(out.path().join("a"), "a file where a folder must be").expect("a file");
        let error = write(&[artifact("a/b.csv")], out.path()).pop().expect("must fail").to_string();
        assert!(error.contains("--out") && error.contains('a'), "{error}");
    }
}
