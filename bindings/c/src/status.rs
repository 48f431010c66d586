//! Codes, and the message of the last error.
#![allow(unsafe_code)] // functions with a name of their own in the library

use std::cell::Cell;
use std::ffi::{CStr, CString, c_char};

use trueflight::check::CheckError;

/// Whether a call did what it was asked for; `tf_last_error` says why not.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// It did.
    Ok = 0,
    /// A pointer is null.
    NullPointer = 1,
    /// A text is not UTF-8.
    Text = 2,
    /// What was said of the draws makes no sense, does not go with their number of values, or is too little.
    Claim = 3,
    /// A case or an estimator does not exist, or cannot be judged.
    Case = 4,
    /// Draws are missing, have no values or too many, are no whole number, or do not go with their lookups.
    Draws = 5,
    /// A callback says that it made more draws than it was asked for.
    Callback = 6,
    /// Something was said of the draws after the first of them, draws came after the verdict, or a callback used the
    /// check that it draws for.
    Order = 7,
    /// A value that a draw does not have.
    Index = 8,
    /// A defect of the library.
    Internal = 9,
}

/// Why a call did nothing.
#[derive(Debug, Clone)]
pub struct Error {
    pub status: Status,
    pub message: String,
}

impl Error {
    pub fn new(status: Status, message: impl Into<String>) -> Self {
        Self { status, message: message.into() }
    }
}

/// With the names of C where a message tells what to call.
impl From<CheckError> for Error {
    fn from(error: CheckError) -> Self {
        let status = match &error {
            CheckError::Case { .. } => Status::Case,
            CheckError::NoTruth { .. }
            | CheckError::Claim { .. }
            | CheckError::Values { .. }
            | CheckError::Channels { .. }
            | CheckError::Twice { .. } => Status::Claim,
            CheckError::NoLookups { .. }
            | CheckError::NoLookupsWanted { .. }
            | CheckError::Lookups { .. }
            | CheckError::Ragged { .. }
            | CheckError::NoValues { .. }
            | CheckError::TooManyValues { .. }
            | CheckError::NoDraws { .. } => Status::Draws,
            _ => Status::Internal,
        };
        let message = match &error {
            CheckError::NoTruth { name } => format!(
                "check `{name}`: the truth is not known; give it by tf_check_truth, or by tf_check_of"
            ),
            CheckError::NoLookups { name } => format!(
                "check `{name}`: lookups are claimed; push them by tf_check_absorb_with_lookups, or leave \
                 tf_check_lookups out"
            ),
            CheckError::NoLookupsWanted { name } => format!(
                "check `{name}`: nothing is known of the lookups; call tf_check_lookups, or push draws alone"
            ),
            CheckError::Twice { name, what } => format!(
                "check `{name}`: the {what} is given twice, by a number and by tf_check_of; leave one of them out, \
                 or call tf_check_mean_only"
            ),
            other => other.to_string(),
        };
        Self { status, message }
    }
}

/// How many bytes the last error has room for, with its end.
const ROOM: usize = 1 << 14;

thread_local! {
    /// The last error. It stays at its place, so that a pointer to it is good for as long as the thread.
    static LAST: Box<[Cell<u8>]> = vec![Cell::new(0); ROOM].into_boxed_slice();
}

/// A text for C; a zero in it, which C could not read past, becomes the sign for unreadable characters.
pub(crate) fn c_text(text: &str) -> CString {
    CString::new(text.replace('\0', "\u{fffd}")).unwrap_or_default()
}

/// Keeps the message for `tf_last_error`.
pub(crate) fn remember(error: &Error) -> Status {
    let text = error.message.replace('\0', "\u{fffd}");
    let end = (0..ROOM.min(text.len() + 1)).rev().find(|&end| text.is_char_boundary(end));
    let text = &text[..end.unwrap_or(0)];
    // A thread that is at its end has no last error.
    let _ = LAST.try_with(|last| {
        last.iter().zip(text.bytes().chain([0])).for_each(|(place, byte)| place.set(byte));
    });
    error.status
}

/// What went wrong in the last call that did, on this thread; empty if none did. The text has the same place all the
/// thread's life: another call that goes wrong writes over it. It is cut after 16383 bytes; `tf_check_text` has all.
#[unsafe(no_mangle)]
pub extern "C" fn tf_last_error() -> *const c_char {
    LAST.try_with(|last| last.as_ptr().cast()).unwrap_or(c"".as_ptr())
}

/// The library's version, as in "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn tf_version() -> *const c_char {
    const VERSION: &CStr =
        match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
            Ok(version) => version,
            Err(_) => c"",
        };
    VERSION.as_ptr()
}
