//! Functions that take draws, or make them by a callback.
#![allow(unsafe_code)] // functions with a name of their own in the library, that take pointers
#![allow(clippy::missing_safety_doc)] // the same for all of them: it is on the crate's front page

use std::ffi::c_void;

use crate::border::{ask, change, list};
use crate::check::Check;
use crate::random::Rng;
use crate::state::State;
use crate::status::{Error, Status};

/// A callback that makes one draw with the help of a random stream; the pointer is the one that was given to
/// `tf_check_run`. It must return: an exception that leaves it ends the process.
pub type DrawFunction =
    Option<unsafe extern "C-unwind" fn(rng: *mut Rng, user: *mut c_void) -> f64>;

/// A callback that makes up to so many draws, one after the other, each with all its values, and answers how many it
/// made: fewer if there are no more. There is room for as many numbers as draws times values.
pub type BatchFunction = Option<
    unsafe extern "C-unwind" fn(
        out: *mut f64,
        draws: usize,
        rng: *mut Rng,
        user: *mut c_void,
    ) -> usize,
>;

/// Adds draws; those of several values lie one draw after the other, and `count` is the number of numbers. How many come
/// in one call makes no difference.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_absorb(
    check: *mut Check,
    draws: *const f64,
    count: usize,
) -> Status {
    // SAFETY: C's promises of checks and of lists.
    unsafe {
        change(check, |check| {
            let draws = list("the list of draws", draws, count)?;
            Ok(check.open()?.absorb(draws)?)
        })
    }
}

/// The same with the number of lookups of each draw: `lookup_count` of them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_absorb_with_lookups(
    check: *mut Check,
    draws: *const f64,
    count: usize,
    lookups: *const f64,
    lookup_count: usize,
) -> Status {
    // SAFETY: C's promises of checks and of lists.
    unsafe {
        change(check, |check| {
            let draws = list("the list of draws", draws, count)?;
            let lookups = list("the list of lookups", lookups, lookup_count)?;
            Ok(check.open()?.absorb_with_lookups(draws, lookups)?)
        })
    }
}

/// Whether more draws may change what is said: 1 or 0; 0 after an error, too.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_is_open(check: *mut Check) -> i32 {
    // SAFETY: C's promise of checks.
    let is_open = unsafe { ask(check, State::is_open) };
    i32::from(is_open == Ok(true))
}

/// Makes draws of one value by a callback until all is decided, or as many as `tf_check_draws` says. Each block of 2^14
/// draws has a random stream of its own, which seed, name and block say. The callback must leave its check alone. Claims
/// of several values are an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_run(
    check: *mut Check,
    draw: DrawFunction,
    user: *mut c_void,
) -> Status {
    // SAFETY: C's promises of checks and of callbacks; the stream lives as long as the call.
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

/// The same by a callback that makes many draws in one call, each of so many `values`: it may write that many numbers for
/// each draw that it is asked for. One truth serves all values; a list of truths, or the channels of a case, must be as
/// many. If it makes fewer draws than it is asked for, these are the last.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_run_batches(
    check: *mut Check,
    values: usize,
    fill: BatchFunction,
    user: *mut c_void,
) -> Status {
    // SAFETY: the same, and there is room for so many draws.
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
