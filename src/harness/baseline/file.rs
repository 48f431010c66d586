//! A baseline's file: its form is asked before all else, and it is written whole or not at all.

use std::io::{self, Write};
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::BaselineError;

/// Reads a file of this version of its form.
pub fn read<T: DeserializeOwned>(path: &Path, expected: u32) -> Result<T, BaselineError> {
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
    // The form is asked first: what else is there depends on it.
    if let Some(found) = tree.get("schema").and_then(serde_json::Value::as_u64)
        && found != u64::from(expected)
    {
        return Err(BaselineError::Schema { path, found, expected });
    }
    serde_json::from_value(tree).map_err(|cause| BaselineError::Broken { path, cause })
}

/// Whether a file can be written.
pub fn writable(path: &Path) -> Result<(), BaselineError> {
    temporary(path).map(drop).map_err(|cause| unwritable(path, cause))
}

/// Writes a file under a temporary name, then renames it.
pub fn write<T: Serialize>(value: &T, path: &Path) -> Result<(), BaselineError> {
    let write = || -> io::Result<()> {
        let mut file = temporary(path)?;
        let text = serde_json::to_string_pretty(value).map_err(io::Error::other)?;
        file.write_all(text.as_bytes())?;
        file.write_all(b"\n")?;
        file.persist(path).map(drop).map_err(|error| error.error)
    };
    write().map_err(|cause| unwritable(path, cause))
}

fn unwritable(path: &Path, cause: io::Error) -> BaselineError {
    BaselineError::Unwritable { path: path.to_owned(), cause }
}

/// A temporary file beside the one that is meant; its folder is made.
fn temporary(path: &Path) -> io::Result<tempfile::NamedTempFile> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder)?;
    let mut builder = tempfile::Builder::new();
    // A temporary file is private to its owner unless told otherwise; baselines are for everyone.
    #[cfg(unix)]
    let builder = {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o644))
    };
    builder.prefix(".trueflight-").tempfile_in(folder)
}
