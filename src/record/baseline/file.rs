//! A baseline's file: its form is asked before all else, and it is written whole or not at all.

use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

use media::files;

/// Why a baseline could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BaselineError {
    /// Not a plain word.
    #[error("`{0}` is no name for a baseline; use letters, digits, `.`, `-` and `_`")]
    Name(String),
    /// There is no such file.
    #[error("{}: no such baseline; make it with --save-baseline, or name its folder with --baselines", .0.display())]
    Missing(PathBuf),
    /// The system refused to read it.
    #[error("{}: {cause}; make the file readable", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        cause: io::Error,
    },
    /// The file is not a baseline.
    #[error("{}: not a baseline, or a broken one ({cause}); make it anew with --save-baseline", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// What the decoder said.
        cause: serde_json::Error,
    },
    /// The file is another of this program's.
    #[error("{}: {found}, not a baseline of this command; make one with --save-baseline", path.display())]
    OtherKind {
        /// The file.
        path: PathBuf,
        /// What it is.
        found: &'static str,
    },
    /// A number that no run has.
    #[error("{}: the numbers of {id} are those of no run; make it anew with --save-baseline", path.display())]
    Nonsense {
        /// The file.
        path: PathBuf,
        /// The entry.
        id: String,
    },
    /// Another version of the form.
    #[error(
        "{}: a baseline of form {found}, this program reads {expected}; \
         make it anew with --save-baseline", path.display()
    )]
    Schema {
        /// The file.
        path: PathBuf,
        /// Its form.
        found: u64,
        /// The form that the program reads.
        expected: u32,
    },
    /// The file cannot be written.
    #[error("{}: cannot be written: {cause}; give another folder with --baselines", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        cause: io::Error,
    },
    /// The program cannot read itself.
    #[error("the program cannot read its own file: {0}; make it readable")]
    Executable(io::Error),
}

/// Reads a file of this version of its form, whose content is in the given list.
///
/// # Errors
///
/// There is none, or it is not what this program writes.
pub fn read<T: DeserializeOwned>(
    path: &Path,
    expected: u32,
    list: &str,
) -> Result<T, BaselineError> {
    let path = path.to_owned();
    let text = match std::fs::read(&path) {
        Ok(text) => text,
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => {
            return Err(BaselineError::Missing(path));
        }
        Err(cause) => return Err(BaselineError::Unreadable { path, cause }),
    };
    let tree: serde_json::Value = match serde_json::from_slice(&text) {
        Ok(tree) => tree,
        Err(cause) => return Err(BaselineError::Broken { path, cause }),
    };
    if let Some(found) = other_kind(&tree, list) {
        return Err(BaselineError::OtherKind { path, found });
    }
    // The form is asked first: what else is there depends on it.
    if let Some(found) = tree.get("schema").and_then(serde_json::Value::as_u64)
        && found != u64::from(expected)
    {
        return Err(BaselineError::Schema { path, found, expected });
    }
    serde_json::from_value(tree).map_err(|cause| BaselineError::Broken { path, cause })
}

/// What else of this program a file is, that has not the list of what is sought.
fn other_kind(tree: &serde_json::Value, list: &str) -> Option<&'static str> {
    let kinds = [
        ("entries", "a stored run"),
        ("timed", "a stored bench"),
        ("results", "the record of a run"),
        ("cases", "the record of a bench"),
    ];
    let has = |key: &str| tree.get(key).is_some();
    let found = kinds.into_iter().find(|(key, _)| has(key)).filter(|_| !has(list));
    found.map(|(_, kind)| kind)
}

/// Whether a file can be written; its folder is made.
///
/// # Errors
///
/// The system refuses.
pub fn writable(path: &Path) -> Result<(), BaselineError> {
    folder_of(path).and_then(|()| files::writable(path)).map_err(|cause| unwritable(path, cause))
}

/// Writes a file whole or not at all.
///
/// # Errors
///
/// The system refuses.
pub fn write<T: Serialize>(value: &T, path: &Path) -> Result<(), BaselineError> {
    let write = || -> io::Result<()> {
        let text = serde_json::to_string_pretty(value).map_err(io::Error::other)?;
        folder_of(path)?;
        files::replace(path, (text + "\n").as_bytes())
    };
    write().map_err(|cause| unwritable(path, cause))
}

/// Makes the folder of a file.
fn folder_of(path: &Path) -> io::Result<()> {
    std::fs::create_dir_all(path.parent().unwrap_or(Path::new(".")))
}

fn unwritable(path: &Path, cause: io::Error) -> BaselineError {
    BaselineError::Unwritable { path: path.to_owned(), cause }
}
