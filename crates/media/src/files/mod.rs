//! Files that are written completely or not at all.
//!
//! A file is written under a temporary name beside its place and then renamed. A killed run therefore leaves no
//! incomplete file and loses nothing that was written before.

mod bytes;
pub mod exr;
pub mod npy;
pub mod number;
pub mod nvdb;
pub mod pbrt;
pub mod pfm;
pub mod vdb;
pub mod vol;

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Cause and cure of a file that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unreadable {
    /// Cause.
    pub message: String,
    /// Cure.
    pub help: String,
}

/// Returns a fault.
///
/// # Errors
///
/// Always: the fault itself.
pub fn wrong<T>(message: impl Into<String>, help: impl Into<String>) -> Result<T, Unreadable> {
    Err(Unreadable { message: message.into(), help: help.into() })
}

/// The grid of a name; without a name, the only grid of a file that is read. `about` returns a grid's name, whether it is
/// read, and its name in lists.
fn chosen<'a, T>(
    grids: &'a [T],
    name: Option<&str>,
    about: impl Fn(&T) -> (String, bool, String),
    convert: &str,
) -> Result<&'a T, Unreadable> {
    let all = || grids.iter().map(|grid| about(grid).2).take(20).collect::<Vec<_>>().join(", ");
    if let Some(name) = name {
        let result = grids.iter().find(|grid| about(grid).0 == name);
        let message = || format!("it has no grid {}, but {}", shown(name), all());
        let missing = || wrong(message(), "choose one of its grids of floats");
        return result.map_or_else(missing, Ok);
    }
    match grids.iter().filter(|grid| about(grid).1).collect::<Vec<_>>()[..] {
        [] => wrong(format!("it has no grid of floats, but {}", all()), convert),
        [only] => Ok(only),
        _ => wrong(format!("it has several grids: {}", all()), "choose one: `grid = \"…\"`"),
    }
}

/// A fault of a damaged file.
fn damaged<T>(message: impl Into<String>) -> Result<T, Unreadable> {
    wrong(message, "the file is damaged: write it anew")
}

/// A text of a file in the form of messages.
fn shown(text: &str) -> String {
    let short: String = text.chars().take(48).collect();
    let rest = if short.len() < text.len() { "…" } else { "" };
    format!("\"{}{rest}\"", short.escape_debug())
}

/// The pixels of a picture file.
#[derive(Debug, Clone, PartialEq)]
pub struct Pixels {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Values of a pixel.
    pub channels: usize,
    /// Row after row from the top, each pixel with its channels.
    pub values: Vec<f64>,
    /// True if some of them were stored as halves, with 11 bits.
    pub has_halves: bool,
}

/// Writes a whole file. A link stays a link. A path that is no plain file (a device, a pipe) is written directly.
///
/// # Errors
///
/// The system refuses, or the path is a folder.
pub fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let Some(place) = place(path)? else {
        return OpenOptions::new().write(true).open(path)?.write_all(bytes);
    };
    let mut file = temporary(&place)?;
    file.write_all(bytes)?;
    file.persist(&place).map(drop).map_err(|error| error.error)
}

/// Checks that [`replace`] can be expected to work, before there is anything to write.
///
/// # Errors
///
/// It cannot work.
pub fn writable(path: &Path) -> io::Result<()> {
    match place(path)? {
        Some(place) => temporary(&place).map(drop),
        None => OpenOptions::new().write(true).open(path).map(drop),
    }
}

/// Path of the file behind links; `None` if it is no plain file.
fn place(path: &Path) -> io::Result<Option<PathBuf>> {
    match fs::metadata(path) {
        Ok(result) if result.is_dir() => Err(io::Error::from(io::ErrorKind::IsADirectory)),
        Ok(result) if result.is_file() => fs::canonicalize(path).map(Some),
        Ok(_) => Ok(None),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Some(path.to_owned())),
        Err(error) => Err(error),
    }
}

/// Blocks until a file and its name are on the disk. Systems without that function do not block.
pub fn synchronise(path: &Path) {
    let _ = fs::File::open(path).and_then(|file| file.sync_all());
    synchronise_folder(path);
}

/// Blocks until the name of a file is on the disk.
pub fn synchronise_folder(path: &Path) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let _ = fs::File::open(folder.unwrap_or(Path::new("."))).and_then(|folder| folder.sync_all());
}

/// A temporary file in the same folder.
fn temporary(path: &Path) -> io::Result<tempfile::NamedTempFile> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let mut builder = tempfile::Builder::new();
    // A temporary file is private to its owner by default; results are for everyone.
    #[cfg(unix)]
    let builder = {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o644))
    };
    builder.prefix(".trueflight-").tempfile_in(folder.unwrap_or(Path::new(".")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_and_a_folder_is_not() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let path = folder.path().join("file");
        replace(&path, b"one").expect("written");
        replace(&path, b"two").expect("replaced");
        assert_eq!(fs::read(&path).expect("a file"), b"two");
        assert!(writable(&path).is_ok() && writable(folder.path()).is_err());
        assert!(replace(&folder.path().join("no/file"), b"").is_err());
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1, "nothing is left");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_a_device_a_device() {
        let folder = tempfile::TempDir::new().expect("a folder");
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        replace(&file, b"one").expect("written");
        std::os::unix::fs::symlink(&file, &link).expect("a link");
        replace(&link, b"two").expect("written");
        assert_eq!(fs::read(&file).expect("a file"), b"two");
        assert!(fs::symlink_metadata(&link).expect("a link").is_symlink());
        replace(Path::new("/dev/null"), b"gone").expect("written into");
        assert!(!fs::metadata("/dev/null").expect("a device").is_file());
    }
}
