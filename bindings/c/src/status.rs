//! Status codes, and the message of the last error.
#![allow(unsafe_code)] // exported functions

use std::cell::Cell;
use std::ffi::{CStr, CString, c_char};

use gate::check::{CheckError, CheckFault, MAX_VALUES};

/// Result of a call; `tf_last_error` returns the message of an error.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Success.
    Ok = 0,
    /// A pointer is null.
    NullPointer = 1,
    /// A text is not UTF-8.
    Text = 2,
    /// The claim is invalid or incomplete, or does not match the number of values of a draw.
    Claim = 3,
    /// A case or an estimator does not exist, or cannot be judged.
    Case = 4,
    /// Draws are missing, have no values or too many, are no whole number, or do not match their lookups.
    Draws = 5,
    /// A callback returned more draws than it was asked for.
    Callback = 6,
    /// The claim was set after the first draw, draws came after the verdict, or a callback used its own check.
    Order = 7,
    /// A draw has no value of that index.
    Index = 8,
    /// A defect of the library.
    Internal = 9,
    /// The library has no key of that number.
    Key = 10,
}

/// Error of a call, which changed nothing.
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

/// Messages that name a function have its name in C.
impl From<CheckError> for Error {
    fn from(error: CheckError) -> Self {
        let status = match &error.fault {
            CheckFault::Case(_) => Status::Case,
            CheckFault::NoTruth
            | CheckFault::Claim(_)
            | CheckFault::Values { .. }
            | CheckFault::Count { .. }
            | CheckFault::Whole { .. }
            | CheckFault::Channels { .. }
            | CheckFault::Twice(_) => Status::Claim,
            CheckFault::NoLookups
            | CheckFault::NoLookupsWanted
            | CheckFault::Lookups { .. }
            | CheckFault::Ragged { .. }
            | CheckFault::NoValues
            | CheckFault::TooManyValues(_)
            | CheckFault::NoDraws => Status::Draws,
            _ => Status::Internal,
        };
        let message = match &error.fault {
            CheckFault::NoTruth => {
                "the truth is not known; set TF_TRUTH, or call tf_check_of".to_owned()
            }
            CheckFault::NoLookups => {
                "the claim has lookups; add draws by tf_check_absorb_with_lookups, or leave TF_LOOKUPS out".to_owned()
            }
            CheckFault::NoLookupsWanted => {
                "nothing is known of the lookups; set TF_LOOKUPS, or add draws without lookups".to_owned()
            }
            CheckFault::Twice(what) => format!(
                "the {what} is given twice, by a number and by tf_check_of; leave one of them out, or set TF_MEAN_ONLY"
            ),
            CheckFault::NoValues => format!("a draw has no values; give 1 to {MAX_VALUES}"),
            other => other.to_string(),
        };
        let message = format!("check `{}`: {message}", error.check);
        Self { status, message }
    }
}

/// Size of the last error in bytes, with its final zero.
const ROOM: usize = 1 << 14;

thread_local! {
    /// Last error. It never moves, so that a pointer to it is valid until the thread ends.
    static LAST: Box<[Cell<u8>]> = vec![Cell::new(0); ROOM].into_boxed_slice();
}

/// Converts a text for C. A zero inside, which ends a text in C, becomes the replacement character.
pub(crate) fn c_text(text: &str) -> CString {
    CString::new(text.replace('\0', "\u{fffd}")).unwrap_or_default()
}

/// Keeps a message for `tf_last_error`.
pub(crate) fn remember(error: &Error) -> Status {
    let text = error.message.replace('\0', "\u{fffd}");
    let end = (0..ROOM.min(text.len() + 1)).rev().find(|&end| text.is_char_boundary(end));
    let text = &text[..end.unwrap_or(0)];
    // A thread that is ending has no last error.
    let _ = LAST.try_with(|last| {
        last.iter().zip(text.bytes().chain([0])).for_each(|(place, byte)| place.set(byte));
    });
    error.status
}

/// Returns the message of the last error on this thread; empty before any error. The pointer is the same until the thread
/// ends, and the next error overwrites the text. It is cut after 16383 bytes; `tf_check_text` has all of it.
#[unsafe(no_mangle)]
pub extern "C" fn tf_last_error() -> *const c_char {
    LAST.try_with(|last| last.as_ptr().cast()).unwrap_or(c"".as_ptr())
}

/// Returns the version of the library, as in "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn tf_version() -> *const c_char {
    const VERSION: &CStr =
        match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
            Ok(version) => version,
            Err(_) => c"",
        };
    VERSION.as_ptr()
}
