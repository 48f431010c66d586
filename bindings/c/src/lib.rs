//! C interface of Trueflight. `include/trueflight.h` is generated from it, and `include/trueflight.hpp` wraps that.
//!
//! ```text
//! ffi       conversion of pointers to references and of panics to errors, in no other place
//! status    status codes, and the message of the last error
//! handle    the handle of a check, which one call at a time uses
//! session   state behind a handle: a claim, a check that takes draws, or a verdict
//! claim     functions that set the claims about a draw
//! draws     functions that take draws, or make them by a callback
//! verdict   functions that return the verdict
//! random    random stream of a callback
//! ```
//!
//! # Safety
//!
//! Rules for callers of all functions. A check is null, or comes from `tf_check_new` and was not freed. One thread at a
//! time uses a check; different checks are independent. A text is null or ends with a zero. An array is null or has as
//! many numbers as the call says. A callback returns, neither throws nor jumps, and writes no more numbers than it is
//! asked for. A null pointer and a callback's call with its own check are errors.

mod claim;
mod draws;
mod ffi;
mod handle;
mod random;
mod session;
mod status;
mod verdict;

pub use claim::{Key, tf_check_new, tf_check_of, tf_check_seed, tf_check_set};
pub use draws::{
    BatchFunction, DrawFunction, tf_check_absorb, tf_check_absorb_with_lookups, tf_check_is_open,
    tf_check_run, tf_check_run_batches,
};
pub use handle::Check;
pub use random::Rng;
pub use status::{Status, tf_last_error, tf_version};
pub use verdict::{
    Numbers, Verdict, tf_check_free, tf_check_numbers, tf_check_passed, tf_check_reason,
    tf_check_text, tf_check_values, tf_check_verdict,
};
