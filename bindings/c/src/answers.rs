//! Functions that tell the verdict. The first of them judges, and no draw can follow.
#![allow(unsafe_code)] // functions with a name of their own in the library, that take pointers
#![allow(clippy::missing_safety_doc)] // the same for all of them: it is on the crate's front page

use std::ffi::c_char;

use trueflight::judge::judgement::Judgement;

use crate::border::{ask, free, write};
use crate::check::Check;
use crate::state::State;
use crate::status::{Error, Status, tf_last_error};

/// What is said of draws.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// They agree with what is claimed, and a difference of the size that matters would have been seen.
    Pass = 0,
    /// They differ by more than chance allows.
    Fail = 1,
    /// The draws do not decide it.
    Inconclusive = 2,
}

impl From<trueflight::stats::verdict::Verdict> for Verdict {
    fn from(verdict: trueflight::stats::verdict::Verdict) -> Self {
        use trueflight::stats::verdict::Verdict as V;
        match verdict {
            V::Pass => Self::Pass,
            V::Fail => Self::Fail,
            V::Inconclusive | V::Underpowered | V::Refused => Self::Inconclusive,
        }
    }
}

/// What was found of one value of the draws; NAN is unknown.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Numbers {
    /// What is said of this value.
    pub verdict: Verdict,
    /// How many draws there were.
    pub draws: u64,
    /// What the mean should be.
    pub truth: f64,
    /// What it is.
    pub mean: f64,
    /// The mean's standard error: from the variance claimed, else from that of the draws.
    pub standard_error: f64,
    /// (mean − truth) in standard errors.
    pub z: f64,
    /// The unbiased sample variance.
    pub variance: f64,
    /// The sample variance, relative to the one claimed.
    pub variance_ratio: f64,
    /// The sample kurtosis.
    pub kurtosis: f64,
}

impl From<&Judgement> for Numbers {
    fn from(found: &Judgement) -> Self {
        let number = |number: Option<f64>| number.unwrap_or(f64::NAN);
        Self {
            verdict: found.verdict.into(),
            draws: found.draws,
            truth: found.truth,
            mean: number(found.mean),
            standard_error: number(found.standard_error),
            z: number(found.z),
            variance: number(found.variance),
            variance_ratio: number(found.variance_ratio),
            kurtosis: number(found.kurtosis),
        }
    }
}

/// The verdict on all values together: fail if any of them fails, pass if all pass.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_verdict(check: *mut Check, verdict: *mut Verdict) -> Status {
    // SAFETY: C's promises of checks and of places.
    unsafe {
        told(ask(check, |check| {
            let found = check.judged()?.verdict().into();
            write("the place of the verdict", verdict, found)
        }))
    }
}

/// Whether the verdict is pass: 1 or 0; 0 after an error, too.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_passed(check: *mut Check) -> i32 {
    // SAFETY: C's promise of checks.
    let passed = unsafe { ask(check, |check| Ok(check.judged()?.passed())) };
    i32::from(passed == Ok(true))
}

/// How many values a draw has; 0 after an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_values(check: *mut Check) -> usize {
    // SAFETY: C's promise of checks.
    unsafe { ask(check, |check| Ok(check.judged()?.values.len())) }.unwrap_or(0)
}

/// What was found of one value of the draws, counted from 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_numbers(
    check: *mut Check,
    value: usize,
    numbers: *mut Numbers,
) -> Status {
    // SAFETY: C's promises of checks and of places.
    unsafe {
        told(ask(check, |check| {
            let outcome = check.judged()?;
            let found = outcome.values.get(value).ok_or_else(|| {
                let (name, values) = (&outcome.name, outcome.values.len());
                let message = format!(
                    "check `{name}`: a draw has {values} values, there is no number {value}"
                );
                Error::new(Status::Index, message)
            })?;
            write("the place of the numbers", numbers, found.into())
        }))
    }
}

/// The verdict in a few lines, as `trueflight judge` writes it; after an error its message. Never null, and valid until
/// the check is freed; of a check that is null, it is `tf_last_error`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_text(check: *mut Check) -> *const c_char {
    // SAFETY: C's promise of checks.
    unsafe { words(check, |check| check.text().as_ptr()) }
}

/// Why the verdict is not pass, in words; empty for a plain pass, after an error its message. As long valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_reason(check: *mut Check) -> *const c_char {
    // SAFETY: C's promise of checks.
    unsafe { words(check, |check| check.reason().as_ptr()) }
}

/// Frees a check; null is fine. A callback cannot free its own check, which is an error of the check.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_free(check: *mut Check) {
    // SAFETY: C's promise of checks.
    unsafe { free(check) }
}

fn told(answer: Result<(), Status>) -> Status {
    answer.err().unwrap_or(Status::Ok)
}

/// A text of a check that is judged; where there is no verdict, an error has left its message.
unsafe fn words(check: *mut Check, words: impl Fn(&State) -> *const c_char) -> *const c_char {
    // SAFETY: C's promise of checks.
    let found = unsafe {
        ask(check, |check| {
            let _ = check.judged();
            Ok(words(check))
        })
    };
    found.unwrap_or_else(|_| tf_last_error())
}
