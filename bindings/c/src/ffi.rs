//! Foreign function interface: pointers become references here, and panics become errors. All of it relies on the rules
//! for callers in the crate's documentation.
#![allow(unsafe_code)] // the one module that reads through pointers

use std::ffi::{CStr, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

use crate::handle::Check;
use crate::session::Session;
use crate::status::{Error, Status, remember};

fn null(what: &str) -> Error {
    Error::new(Status::NullPointer, format!("{what} is null"))
}

/// Turns a panic, which is a defect of this library, into an error: nothing may unwind into C.
fn caught<T>(act: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    catch_unwind(AssertUnwindSafe(act)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
        let message = format!("a defect of Trueflight, please report it: {text}");
        Err(Error::new(Status::Internal, message))
    })
}

/// Makes a check and hands it over to C.
pub(crate) fn give(make: impl FnOnce() -> Result<Check, Error>) -> Result<*mut Check, Status> {
    caught(|| Ok(Box::into_raw(Box::new(make()?)))).map_err(|error| remember(&error))
}

/// Changes a check. An error stays with the check: all later calls return the first one.
///
/// # Safety
///
/// The check is null, or valid and used by no other thread during the call.
pub(crate) unsafe fn change(
    check: *mut Check,
    act: impl FnOnce(&mut Session) -> Result<(), Error>,
) -> Status {
    // SAFETY: `as_ref` turns null into `None`; the caller vouches for the rest. Shared, since a callback may call again.
    let Some(check) = (unsafe { check.as_ref() }) else { return remember(&null("the check")) };
    let done = check.change().and_then(|mut session| match session.error() {
        Some(error) => Err(error.clone()),
        None => caught(|| act(&mut session))
            .map_err(|error| session.named(error))
            .inspect_err(|error| session.fail(error)),
    });
    done.map_or_else(|error| remember(&error), |()| Status::Ok)
}

/// Queries a check. An error of the query does not stay with the check.
///
/// # Safety
///
/// As for [`change`].
pub(crate) unsafe fn query<T>(
    check: *mut Check,
    act: impl FnOnce(&mut Session) -> Result<T, Error>,
) -> Result<T, Status> {
    // SAFETY: as in `change`.
    let Some(check) = (unsafe { check.as_ref() }) else {
        return Err(remember(&null("the check")));
    };
    let result = check
        .query()
        .and_then(|mut session| caught(|| act(&mut session)).map_err(|error| session.named(error)));
    result.map_err(|error| remember(&error))
}

/// Borrows a text of the caller's.
///
/// # Safety
///
/// The pointer is null, or the text ends with a zero and outlives its use.
pub(crate) unsafe fn text<'a>(what: &str, text: *const c_char) -> Result<&'a str, Error> {
    if text.is_null() {
        return Err(null(what));
    }
    // SAFETY: not null, and it ends with a zero.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str().map_err(|_| Error::new(Status::Text, format!("{what} is not UTF-8")))
}

/// Borrows an array of the caller's; null has no numbers.
///
/// # Safety
///
/// The pointer is null, or the array has `count` numbers and outlives its use.
pub(crate) unsafe fn array<'a>(
    what: &str,
    numbers: *const f64,
    count: usize,
) -> Result<&'a [f64], Error> {
    match (numbers.is_null(), count) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(null(what)),
        // SAFETY: not null, and it has `count` numbers.
        (false, _) => Ok(unsafe { slice::from_raw_parts(numbers, count) }),
    }
}

/// Writes a result to the caller's memory.
///
/// # Safety
///
/// The pointer is null or can be written to.
pub(crate) unsafe fn write<T>(what: &str, place: *mut T, value: T) -> Result<(), Error> {
    if place.is_null() {
        return Err(null(what));
    }
    // SAFETY: not null; it need not be initialised.
    unsafe { place.write(value) };
    Ok(())
}

/// Takes a check back and drops it. A check that is drawing stays, since its callback returns into it.
///
/// # Safety
///
/// The check is null, or comes from [`give`] and is not used again.
pub(crate) unsafe fn free(check: *mut Check) {
    // SAFETY: as above.
    let Some(is_drawing) = (unsafe { check.as_ref() }).map(|check| check.change().err()) else {
        return;
    };
    if let Some(error) = is_drawing {
        remember(&error);
        return;
    }
    // SAFETY: `give` made it of a box.
    let check = unsafe { Box::from_raw(check) };
    // No caller can use an error of a drop.
    let _ = catch_unwind(AssertUnwindSafe(|| drop(check)));
}
