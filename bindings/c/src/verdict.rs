//! Functions that return the verdict. The first call judges, and no draw can follow.
#![allow(unsafe_code)] // exported functions that take pointers
#![allow(clippy::missing_safety_doc)] // the crate's documentation has the rules for all of them

use std::ffi::c_char;

use gate::session::Judgement;

use crate::ffi::{free, query, write};
use crate::handle::Check;
use crate::session::Session;
use crate::status::{Error, Status, tf_last_error};

/// Verdict on draws.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The draws agree with the claim, and the gate would have detected a difference of the size of the tolerance.
    Pass = 0,
    /// The draws differ from the claim by more than random errors allow.
    Fail = 1,
    /// The draws do not decide.
    Inconclusive = 2,
}

impl From<gate::stats::verdict::Verdict> for Verdict {
    fn from(verdict: gate::stats::verdict::Verdict) -> Self {
        use gate::stats::verdict::Verdict as V;
        match verdict {
            V::Pass => Self::Pass,
            V::Fail => Self::Fail,
            V::Inconclusive | V::Underpowered | V::Refused => Self::Inconclusive,
        }
    }
}

/// Measurements of one value of the draws. NAN means unknown.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Numbers {
    /// Verdict on this value.
    pub verdict: Verdict,
    /// Number of draws.
    pub draws: u64,
    /// Expected mean.
    pub truth: f64,
    /// Measured mean.
    pub mean: f64,
    /// Standard error of the mean, from the variance of the claim, else from that of the draws.
    pub standard_error: f64,
    /// (mean − truth) in standard errors.
    pub z: f64,
    /// Unbiased sample variance.
    pub variance: f64,
    /// Sample variance, relative to the variance of the claim.
    pub variance_ratio: f64,
    /// Sample kurtosis.
    pub kurtosis: f64,
}

impl From<&Judgement> for Numbers {
    fn from(judgement: &Judgement) -> Self {
        let number = |number: Option<f64>| number.unwrap_or(f64::NAN);
        Self {
            verdict: judgement.verdict.into(),
            draws: judgement.draws,
            truth: judgement.truth,
            mean: number(judgement.mean),
            standard_error: number(judgement.standard_error),
            z: number(judgement.z),
            variance: number(judgement.variance),
            variance_ratio: number(judgement.variance_ratio),
            kurtosis: number(judgement.kurtosis),
        }
    }
}

/// Returns the verdict on all values together: fail if any value fails, pass if all pass.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_verdict(check: *mut Check, verdict: *mut Verdict) -> Status {
    // SAFETY: rules for checks and results.
    unsafe {
        status(query(check, |check| {
            write("the place of the verdict", verdict, check.judged()?.verdict().into())
        }))
    }
}

/// Returns 1 if the verdict is pass, else 0, also after an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_passed(check: *mut Check) -> i32 {
    // SAFETY: rules for checks.
    let passed = unsafe { query(check, |check| Ok(check.judged()?.passed())) };
    i32::from(passed == Ok(true))
}

/// Returns the number of values of a draw; 0 after an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_values(check: *mut Check) -> usize {
    // SAFETY: rules for checks.
    unsafe { query(check, |check| Ok(check.judged()?.values.len())) }.unwrap_or(0)
}

/// Returns the measurements of one value of the draws, counted from 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_numbers(
    check: *mut Check,
    value: usize,
    numbers: *mut Numbers,
) -> Status {
    // SAFETY: rules for checks and results.
    unsafe {
        status(query(check, |check| {
            let outcome = check.judged()?;
            let verdict = outcome.values.get(value).ok_or_else(|| {
                let (name, values) = (&outcome.name, outcome.values.len());
                let message = format!(
                    "check `{name}`: there is no value {value}; the last one is value {}",
                    values - 1
                );
                Error::new(Status::Index, message)
            })?;
            write("the place of the numbers", numbers, verdict.into())
        }))
    }
}

/// Returns the verdict in a few lines, as `trueflight judge` prints it; after an error its message. Never null, and valid
/// until the check is freed. For a null check it returns `tf_last_error()`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_text(check: *mut Check) -> *const c_char {
    // SAFETY: rules for checks.
    unsafe { words(check, |check| check.text().as_ptr()) }
}

/// Returns the reason of a verdict other than pass in words; empty for a plain pass, after an error its message. Valid as
/// long as `tf_check_text`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_reason(check: *mut Check) -> *const c_char {
    // SAFETY: rules for checks.
    unsafe { words(check, |check| check.reason().as_ptr()) }
}

/// Frees a check; null is fine. A callback cannot free its own check: that is an error of the check.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_free(check: *mut Check) {
    // SAFETY: rules for checks.
    unsafe { free(check) }
}

fn status(result: Result<(), Status>) -> Status {
    result.err().unwrap_or(Status::Ok)
}

/// Returns a text of a check after judging it; without a verdict the text is the error's message.
unsafe fn words(check: *mut Check, words: impl Fn(&Session) -> *const c_char) -> *const c_char {
    // SAFETY: rules for checks.
    let text = unsafe {
        query(check, |check| {
            let _ = check.judged();
            Ok(words(check))
        })
    };
    text.unwrap_or_else(|_| tf_last_error())
}
