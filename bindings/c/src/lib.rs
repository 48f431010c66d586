//! The C interface of Trueflight; `include/trueflight.h` is generated from it, `include/trueflight.hpp` wraps it.
//!
//! ```text
//! border    pointers from C become references here, and nowhere else; panics end here
//! status    codes, and the message of the last error
//! check     a handle, which one call at a time may use
//! state     what a handle holds: a check that is set up, that waits for draws, or that is judged
//! sense     whether what is said makes sense by itself
//! setup     functions that say what is known of a draw
//! draws     functions that take draws or make them by a callback
//! answers   functions that tell the verdict
//! random    the random stream of a callback
//! ```
//!
//! # Safety
//!
//! What C must keep to holds for all functions alike. A check is null or comes from `tf_check_new`, was not freed, and
//! is used by one thread at a time; different checks are independent. A text is null or ends with a zero. A list is
//! null or has as many numbers as are told beside it. A callback returns: it neither throws nor jumps, and writes no
//! more numbers than it is asked for. Null is answered by an error, and so is a callback's call with its own check.

mod answers;
mod border;
mod check;
mod draws;
mod random;
mod sense;
mod setup;
mod state;
mod status;

pub use answers::{
    Numbers, Verdict, tf_check_free, tf_check_numbers, tf_check_passed, tf_check_reason,
    tf_check_text, tf_check_values, tf_check_verdict,
};
pub use check::Check;
pub use draws::{
    BatchFunction, DrawFunction, tf_check_absorb, tf_check_absorb_with_lookups, tf_check_is_open,
    tf_check_run, tf_check_run_batches,
};
pub use random::Rng;
pub use setup::{
    tf_check_alpha, tf_check_batch, tf_check_draws, tf_check_kurtoses, tf_check_kurtosis,
    tf_check_lookups, tf_check_mean_only, tf_check_new, tf_check_of, tf_check_range,
    tf_check_rounding, tf_check_seed, tf_check_tolerance, tf_check_truth, tf_check_truths,
    tf_check_variance, tf_check_variance_tolerance, tf_check_variances,
};
pub use status::{Status, tf_last_error, tf_version};
