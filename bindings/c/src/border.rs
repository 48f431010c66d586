//! The border: pointers become references, and panics become errors. All of it rests on what C must keep to, which the
//! crate's front page says.
#![allow(unsafe_code)] // the one place that reads through pointers

use std::ffi::{CStr, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

use crate::check::Check;
use crate::state::State;
use crate::status::{Error, Status, remember};

fn null(what: &str) -> Error {
    Error::new(Status::NullPointer, format!("{what} is null"))
}

/// What C sees of a result; a panic is a defect of ours and becomes an error, since nothing may unwind into C.
fn settled<T>(act: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    catch_unwind(AssertUnwindSafe(act)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
        Err(Error::new(
            Status::Internal,
            format!("a defect of Trueflight, please report it: {text}"),
        ))
    })
}

/// Does something that belongs to no check yet.
pub(crate) fn answer<T>(act: impl FnOnce() -> Result<T, Error>) -> Result<T, Status> {
    settled(act).map_err(|error| remember(&error))
}

/// Changes a check. An error stays with it: all later calls answer the first one.
///
/// # Safety
///
/// The check is null, or valid and no other thread's for the time of the call.
pub(crate) unsafe fn change(
    check: *mut Check,
    act: impl FnOnce(&mut State) -> Result<(), Error>,
) -> Status {
    // SAFETY: `as_ref` answers null by `None`; all else is the caller's promise. Shared, since a callback may call again.
    let Some(check) = (unsafe { check.as_ref() }) else { return remember(&null("the check")) };
    let done = check.take().and_then(|mut state| match state.fault() {
        Some(error) => Err(error.clone()),
        None => settled(|| act(&mut state))
            .map_err(|error| state.placed(error))
            .inspect_err(|error| state.spoil(error)),
    });
    done.map_or_else(|error| remember(&error), |()| Status::Ok)
}

/// Looks at a check, which an error of the question does not spoil.
///
/// # Safety
///
/// The same.
pub(crate) unsafe fn ask<T>(
    check: *mut Check,
    act: impl FnOnce(&mut State) -> Result<T, Error>,
) -> Result<T, Status> {
    // SAFETY: as above.
    let Some(check) = (unsafe { check.as_ref() }) else {
        return Err(remember(&null("the check")));
    };
    let answer = check
        .look()
        .and_then(|mut state| settled(|| act(&mut state)).map_err(|error| state.placed(error)));
    answer.map_err(|error| remember(&error))
}

/// The text that C points to.
///
/// # Safety
///
/// It is null, or ends with a zero and lives as long as it is used.
pub(crate) unsafe fn text<'a>(what: &str, text: *const c_char) -> Result<&'a str, Error> {
    if text.is_null() {
        return Err(null(what));
    }
    // SAFETY: not null, and it ends with a zero.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str().map_err(|_| Error::new(Status::Text, format!("{what} is not UTF-8")))
}

/// The numbers that C points to; none may be at null.
///
/// # Safety
///
/// It is null, or holds so many numbers and lives as long as they are used.
pub(crate) unsafe fn list<'a>(
    what: &str,
    numbers: *const f64,
    count: usize,
) -> Result<&'a [f64], Error> {
    match (numbers.is_null(), count) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(null(what)),
        // SAFETY: not null, and so many numbers are there.
        (false, _) => Ok(unsafe { slice::from_raw_parts(numbers, count) }),
    }
}

/// Writes an answer where C wants it.
///
/// # Safety
///
/// The place is null or can be written to.
pub(crate) unsafe fn write<T>(what: &str, place: *mut T, value: T) -> Result<(), Error> {
    if place.is_null() {
        return Err(null(what));
    }
    // SAFETY: not null; it need not have been written before.
    unsafe { place.write(value) };
    Ok(())
}

/// Hands a check over to C.
pub(crate) fn give(check: Check) -> *mut Check {
    Box::into_raw(Box::new(check))
}

/// Takes a check back and drops it; one that is drawing stays, since its callback returns into it.
///
/// # Safety
///
/// It is null, or comes from [`give`] and is not used again.
pub(crate) unsafe fn free(check: *mut Check) {
    // SAFETY: as above.
    let Some(is_drawing) = (unsafe { check.as_ref() }).map(|check| check.take().err()) else {
        return;
    };
    if let Some(error) = is_drawing {
        remember(&error);
        return;
    }
    // SAFETY: it was a box's.
    let check = unsafe { Box::from_raw(check) };
    // A panic while dropping has nobody to be told to.
    let _ = catch_unwind(AssertUnwindSafe(|| drop(check)));
}
