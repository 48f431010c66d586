//! Functions that take draws, or make them by a callback.
#![allow(unsafe_code)] // exported functions that take pointers
#![allow(clippy::missing_safety_doc)] // the crate's documentation has the rules for all of them

use std::ffi::c_void;

use crate::ffi::{array, change, query};
use crate::handle::Check;
use crate::random::Rng;
use crate::status::{Error, Status};

/// Callback that makes one draw from a random stream; `user` is the pointer that was passed to `tf_check_run`. It must
/// return: an exception that leaves it ends the process.
pub type DrawFunction =
    Option<unsafe extern "C-unwind" fn(rng: *mut Rng, user: *mut c_void) -> f64>;

/// Callback that makes up to `draws` draws, one after the other, each with all its values, and returns their number. If
/// it returns fewer, they are the last. `out` has room for draws × values numbers.
pub type BatchFunction = Option<
    unsafe extern "C-unwind" fn(
        out: *mut f64,
        draws: usize,
        rng: *mut Rng,
        user: *mut c_void,
    ) -> usize,
>;

/// Adds draws. Those of several values are stored one draw after the other, and `count` is the number of numbers. The
/// size of a call makes no difference to the verdict.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_absorb(
    check: *mut Check,
    draws: *const f64,
    count: usize,
) -> Status {
    // SAFETY: rules for checks and arrays.
    unsafe {
        change(check, |check| {
            let draws = array("the array of draws", draws, count)?;
            Ok(check.open()?.absorb(draws)?)
        })
    }
}

/// Adds draws with the number of lookups of each; `lookup_count` is the number of draws.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_absorb_with_lookups(
    check: *mut Check,
    draws: *const f64,
    count: usize,
    lookups: *const f64,
    lookup_count: usize,
) -> Status {
    // SAFETY: rules for checks and arrays.
    unsafe {
        change(check, |check| {
            let draws = array("the array of draws", draws, count)?;
            let lookups = array("the array of lookups", lookups, lookup_count)?;
            Ok(check.open()?.absorb_with_lookups(draws, lookups)?)
        })
    }
}

/// Returns 1 if more draws may change the verdict, else 0, also after an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_is_open(check: *mut Check) -> i32 {
    // SAFETY: rules for checks.
    let is_open = unsafe { query(check, |check| check.is_open()) };
    i32::from(is_open == Ok(true))
}

/// Makes draws of one value by a callback until the verdict is decided, or as many as `TF_DRAWS` says. Each block of 2^14
/// draws has its own random stream, which depends on seed, name and block. The callback must not use its check. A claim
/// of several values is an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_run(
    check: *mut Check,
    draw: DrawFunction,
    user: *mut c_void,
) -> Status {
    // SAFETY: rules for checks and callbacks; the stream lives as long as the call.
    unsafe {
        change(check, |check| {
            let draw = draw.ok_or_else(no_callback)?;
            check.run(1, |out, draws, rng| {
                for x in out {
                    *x = draw(rng, user);
                }
                draws
            })
        })
    }
}

/// Makes draws like `tf_check_run`, by a callback that makes many draws a call, each of `values` values. One number of a
/// claim serves all values; an array, or the channels of a case, must have `values` of them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_run_batches(
    check: *mut Check,
    values: usize,
    fill: BatchFunction,
    user: *mut c_void,
) -> Status {
    // SAFETY: as above, and there is room for as many draws as the callback is asked for.
    unsafe {
        change(check, |check| {
            let fill = fill.ok_or_else(no_callback)?;
            check.run(values, |out, draws, rng| fill(out.as_mut_ptr(), draws, rng, user))
        })
    }
}

fn no_callback() -> Error {
    Error::new(Status::NullPointer, "the callback is null")
}
