//! A baseline's file: its form is asked before all else, and it is written whole or not at all.

use std::io;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::BaselineError;
use crate::files;

/// Reads a file of this version of its form, whose content is in the given list.
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
pub fn writable(path: &Path) -> Result<(), BaselineError> {
    folder_of(path).and_then(|()| files::writable(path)).map_err(|cause| unwritable(path, cause))
}

/// Writes a file whole or not at all.
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
