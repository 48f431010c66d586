//! Functions that say what is known of a draw.
#![allow(unsafe_code)] // functions with a name of their own in the library, that take pointers
#![allow(clippy::missing_safety_doc)] // the same for all of them: it is on the crate's front page

use std::ffi::c_char;
use std::ptr;

use trueflight::judge::claim::{Given, Lookups};
use trueflight::judge::trial::Wanted;

use crate::border::{answer, change, give, list, text};
use crate::check::Check;
use crate::sense::{self, all, given, wanted};
use crate::status::Status;

fn truth_is(truth: f64) -> Given {
    Given { truth, ..Given::default() }
}

fn variance_is(variance: f64) -> Given {
    Given { variance: Some(variance), ..Given::default() }
}

fn kurtosis_is(kurtosis: f64) -> Given {
    Given { kurtosis: Some(kurtosis), ..Given::default() }
}

/// A check of that name, which says nothing of its draws yet; null if the name is null or not UTF-8. Free it by
/// `tf_check_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_new(name: *const c_char) -> *mut Check {
    // SAFETY: C's promise of texts.
    let check = answer(|| Ok(give(Check::new(unsafe { text("the check's name", name) }?))));
    check.unwrap_or(ptr::null_mut())
}

/// The mean of a correct draw; of each of its values, if it has several.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_truth(check: *mut Check, truth: f64) -> Status {
    // SAFETY: C's promise of checks.
    unsafe { change(check, |check| check.say_truths(all(&[truth], truth_is), vec![truth])) }
}

/// The same for draws of several values: one number for each value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_truths(
    check: *mut Check,
    truths: *const f64,
    count: usize,
) -> Status {
    // SAFETY: C's promises of checks and of lists.
    unsafe {
        change(check, |check| {
            let numbers = list("the list of truths", truths, count)?;
            check.say_truths(all(numbers, truth_is), numbers.to_vec())
        })
    }
}

/// The variance of a correct draw; it is tested, too.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_variance(check: *mut Check, variance: f64) -> Status {
    // SAFETY: C's promise of checks.
    unsafe {
        change(check, |check| {
            check.say(all(&[variance], variance_is), |said| said.variance(variance))
        })
    }
}

/// The same, one number for each value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_variances(
    check: *mut Check,
    variances: *const f64,
    count: usize,
) -> Status {
    // SAFETY: C's promises of checks and of lists.
    unsafe {
        change(check, |check| {
            let numbers = list("the list of variances", variances, count)?;
            check.say(all(numbers, variance_is), |said| said.variance(numbers.to_vec()))
        })
    }
}

/// The kurtosis of a correct draw, 3 for the normal law; without a variance an upper bound of it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_kurtosis(check: *mut Check, kurtosis: f64) -> Status {
    // SAFETY: C's promise of checks.
    unsafe {
        change(check, |check| {
            check.say(all(&[kurtosis], kurtosis_is), |said| said.kurtosis(kurtosis))
        })
    }
}

/// The same, one number for each value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_kurtoses(
    check: *mut Check,
    kurtoses: *const f64,
    count: usize,
) -> Status {
    // SAFETY: C's promises of checks and of lists.
    unsafe {
        change(check, |check| {
            let numbers = list("the list of kurtoses", kurtoses, count)?;
            check.say(all(numbers, kurtosis_is), |said| said.kurtosis(numbers.to_vec()))
        })
    }
}

/// Where correct draws lie; either end may be infinite. A draw outside fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_range(check: *mut Check, low: f64, high: f64) -> Status {
    // SAFETY: C's promise of checks.
    unsafe {
        change(check, |check| check.say(sense::range(low, high), |said| said.range(low, high)))
    }
}

/// Mean and variance of the number of lookups of a correct draw, which `tf_check_absorb_with_lookups` tells.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_lookups(check: *mut Check, mean: f64, variance: f64) -> Status {
    // SAFETY: C's promise of checks.
    unsafe {
        change(check, |check| {
            let lookups = Some(Lookups { mean, variance: Some(variance), error: 0.0 });
            let sense = given(Given { lookups, ..Given::default() });
            check.say(sense, |said| said.lookups(mean, variance))
        })
    }
}

/// What rounding may add to a draw, relative to the truth; absolute for a truth of 0. Without it 3.6e-13; for draws in
/// single precision some 1e-6. Call it before `tf_check_of`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_rounding(check: *mut Check, rounding: f64) -> Status {
    // SAFETY: C's promise of checks.
    unsafe {
        change(check, |check| {
            let sense = given(Given { rounding, ..Given::default() });
            check.say(sense, |said| said.rounding(rounding))
        })
    }
}

/// Number of values of a pushed draw, where it differs from the number of truths or of channels in the case: the luminance
/// of a chromatic medium, which follows from the other channels, may be left out.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_set_values(check: *mut Check, values: usize) -> Status {
    // SAFETY: C's promise of checks.
    unsafe { change(check, |check| check.say(sense::values(values), |said| said.values(values))) }
}

/// Of what theory says, only the mean: for an estimator of one's own that the case does not have.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_mean_only(check: *mut Check) -> Status {
    // SAFETY: C's promise of checks.
    unsafe { change(check, |check| check.say(Ok(()), trueflight::Check::mean_only)) }
}

/// ε: the bias that a pass excludes, relative to the truth (absolute for a truth of 0). Without it 1 %, or with
/// `tf_check_draws` what so many draws can see, at most 5 %.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_tolerance(check: *mut Check, tolerance: f64) -> Status {
    // SAFETY: C's promise of checks.
    unsafe {
        change(check, |check| {
            let sense = wanted(Wanted { tolerance: Some(tolerance), ..Wanted::default() });
            check.say(sense, |said| said.tolerance(tolerance))
        })
    }
}

/// The same for the variance, relative to it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_variance_tolerance(check: *mut Check, tolerance: f64) -> Status {
    // SAFETY: C's promise of checks.
    unsafe {
        change(check, |check| {
            let sense = wanted(Wanted { variance_tolerance: Some(tolerance), ..Wanted::default() });
            check.say(sense, |said| said.variance_tolerance(tolerance))
        })
    }
}

/// Judges averages of so many consecutive draws, which is for draws that depend on their neighbours; variance and
/// kurtosis are then those of an average.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_batch(check: *mut Check, batch: u64) -> Status {
    // SAFETY: C's promise of checks.
    unsafe {
        change(check, |check| {
            let sense = wanted(Wanted { batch, ..Wanted::default() });
            check.say(sense, |said| said.batch(batch))
        })
    }
}

/// α: the chance that a correct estimator fails, 1e-3 without it. Of n checks together any fails with chance α at most
/// if each has α/n.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_alpha(check: *mut Check, alpha: f64) -> Status {
    // SAFETY: C's promise of checks.
    unsafe {
        change(check, |check| {
            let sense = wanted(Wanted { alpha, ..Wanted::default() });
            check.say(sense, |said| said.alpha(alpha))
        })
    }
}

/// So many draws, all of them, in place of as many as the decision takes (2^24 at most).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_draws(check: *mut Check, draws: u64) -> Status {
    // SAFETY: C's promise of checks.
    unsafe {
        change(check, |check| {
            check.draws = Some(draws);
            let sense = wanted(Wanted { most: Some(draws), ..Wanted::default() });
            check.say(sense, |said| said.draws(draws))
        })
    }
}

/// Where the random streams of callbacks begin; 1 without it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_seed(check: *mut Check, seed: u64) -> Status {
    // SAFETY: C's promise of checks.
    unsafe {
        change(check, |check| {
            check.seed = seed;
            check.say(Ok(()), |said| said.seed(seed))
        })
    }
}

/// Takes mean, variance, kurtosis, lookups and, where it is known, the whole distribution from theory: for an estimator of
/// a case, by its name in tables or in the catalogue, at any value of what the case sweeps, or a constant σ̂ where it
/// sweeps nothing; NAN takes the case's own. The case is a built-in one or a file. Every channel of the case is a value of
/// the draw. A free flight that leaves the ray is its length, any larger number, INFINITY or −1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tf_check_of(
    check: *mut Check,
    case: *const c_char,
    estimator: *const c_char,
    swept: f64,
) -> Status {
    // SAFETY: C's promises of checks and of texts.
    unsafe {
        change(check, |check| {
            check.of(text("the case", case)?, text("the estimator", estimator)?, swept)
        })
    }
}
