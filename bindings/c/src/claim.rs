//! Functions that set the claims about a draw. They record; the check validates the claim before its first draw.
#![allow(unsafe_code)] // exported functions that take pointers
#![allow(clippy::missing_safety_doc)] // the crate's documentation has the rules for all of them

use std::ffi::c_char;
use std::ptr;

use gate::check::Property;

use crate::ffi::{array, change, give, text};
use crate::handle::Check;
use crate::session::Session;
use crate::status::{Error, Status};

/// Property of a claim, which `tf_check_set` sets to one or several numbers. A whole number may be written as any other.
///
/// cbindgen:rename-all=ScreamingSnakeCase
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(clippy::enum_variant_names)] // their names in C
pub enum Key {
    /// Mean of a correct draw: one number for all values of a draw, or one for each. Finite. Required, unless
    /// `tf_check_of` gives it.
    TfTruth = 1,
    /// Variance of a correct draw, 0 or more: one number for all values, or one for each. It is tested, too. Default:
    /// unknown.
    TfVariance = 2,
    /// Kurtosis of a correct draw, 1 or more, 3 for a normal distribution: one number for all values, or one for each.
    /// Without a variance it is an upper bound. Default: unknown.
    TfKurtosis = 3,
    /// Range of correct draws: two numbers, low < truth < high; either may be infinite. A draw outside fails. Default:
    /// unlimited.
    TfRange = 4,
    /// Number of lookups of a correct draw: its mean, above 0, and its variance, 0 or more. `tf_check_absorb_with_lookups`
    /// takes the lookups. Default: not tested.
    TfLookups = 5,
    /// Rounding error of a draw, 0 or more, relative to |truth|; absolute for a truth of 0. Default: 3.6e-13. Some 1e-6
    /// suits draws in single precision.
    TfRounding = 6,
    /// ε, above 0: the bias that a pass excludes, relative to |truth|; absolute for a truth of 0, which needs it. Default:
    /// 1 %, or with `TF_DRAWS` the smallest that the draws can show, at most 5 %.
    TfTolerance = 7,
    /// ε of the variance, above 0, relative to the variance. Default: the smallest that the draws can show, at most 20 %.
    TfVarianceTolerance = 8,
    /// α, above 0 and below 1: the probability that a correct estimator fails. Default: 1e-3. For n checks together, give
    /// each α/n.
    TfAlpha = 9,
    /// Number of draws, 1 or more. Default: as many as the verdict takes, at most 2^24.
    TfDraws = 10,
    /// Number of consecutive draws that are averaged before they are judged, 1 or more: for draws that depend on each
    /// other. Variance and kurtosis are then those of an average. Default: 1.
    TfBatch = 11,
    /// Number of values of a pushed draw, from 1 to 65536. Default: as many as there are truths, or channels in the case.
    /// The luminance of a chromatic medium, which follows from the other channels, may be left out.
    TfValues = 12,
    /// 1 takes only the mean from theory, for an estimator that the case does not have. Default: 0, all that is known.
    TfMeanOnly = 13,
}

/// Key as C passes it: any integer.
pub type KeyCode = i32;

/// Returns the property of a key.
fn property(key: KeyCode) -> Option<Property> {
    [
        (Key::TfTruth, Property::Truth),
        (Key::TfVariance, Property::Variance),
        (Key::TfKurtosis, Property::Kurtosis),
        (Key::TfRange, Property::Range),
        (Key::TfLookups, Property::Lookups),
        (Key::TfRounding, Property::Rounding),
        (Key::TfTolerance, Property::Tolerance),
        (Key::TfVarianceTolerance, Property::VarianceTolerance),
        (Key::TfAlpha, Property::Alpha),
        (Key::TfDraws, Property::Draws),
        (Key::TfBatch, Property::Batch),
        (Key::TfValues, Property::Values),
        (Key::TfMeanOnly, Property::MeanOnly),
    ]
    .into_iter()
    .find_map(|(known, property)| (known as KeyCode == key).then_some(property))
}

/// Makes a check with an empty claim; null if the name is null or not UTF-8. Free it by `tf_check_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_new(name: *const c_char) -> *mut Check {
    // SAFETY: rules for texts.
    let check = give(|| Ok(Check::new(unsafe { text("the check's name", name) }?)));
    check.unwrap_or(ptr::null_mut())
}

/// Sets one property of the claim to `count` numbers: one, or as many as the key says. In C, `TF_SET` takes the numbers
/// themselves. The last call for a key counts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_set(
    check: *mut Check,
    key: KeyCode,
    numbers: *const f64,
    count: usize,
) -> Status {
    // SAFETY: rules for checks and arrays.
    unsafe {
        change(check, |check| {
            let property =
                property(key).ok_or_else(|| check.error_of(Status::Key, &unknown(key)))?;
            let numbers = array("the array of numbers", numbers, count)?;
            check.set(|claim| claim.set(property, numbers))
        })
    }
}

fn unknown(key: KeyCode) -> String {
    let version = env!("CARGO_PKG_VERSION");
    format!("library {version} has no key {key}; compile with the header of the library")
}

/// Sets the seed of the random streams of callbacks. Default: 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_seed(check: *mut Check, seed: u64) -> Status {
    // SAFETY: rules for checks.
    unsafe { change(check, |check| check.set(|claim| Ok(claim.seed(seed)))) }
}

/// Takes mean, variance, kurtosis and lookups from theory, and the whole distribution where theory knows it.
///
/// The case is a built-in one or a file; the estimator has its name in tables or in the catalogue. `swept` is a value of
/// the swept quantity, or a constant σ̂ if the case sweeps nothing; NAN takes the case's own. Every channel of the case
/// is a value of the draw. A free flight that leaves the ray is its length, any larger number, INFINITY or −1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_of(
    check: *mut Check,
    case: *const c_char,
    estimator: *const c_char,
    swept: f64,
) -> Status {
    // SAFETY: rules for checks and texts.
    unsafe {
        change(check, |check| {
            of(check, text("the case", case)?, text("the estimator", estimator)?, swept)
        })
    }
}

#[cfg(feature = "theory")]
fn of(check: &mut Session, case: &str, estimator: &str, swept: f64) -> Result<(), Error> {
    let swept = (!swept.is_nan()).then_some(swept);
    check.set(|claim| Ok(trueflight::OfCase::of(claim, case, estimator, swept)))
}

#[cfg(not(feature = "theory"))]
fn of(check: &mut Session, case: &str, estimator: &str, _: f64) -> Result<(), Error> {
    let what = format!(
        "nothing is known of `{estimator}` of {case}: this library was built without theory; build it with the feature \
         `theory`, or give numbers"
    );
    Err(check.error_of(Status::Case, &what))
}
