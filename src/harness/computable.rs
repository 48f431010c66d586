//! What no computer with doubles can test in a lifetime.

use super::scenario::Ready;
use crate::estimators::Refusal;

/// Below this transmittance the ratio of a draw to the truth is no longer a double.
pub const FAINTEST: f64 = 1e-300;
/// More lookups than this in one draw are a mistake in the case, not an experiment.
const MOST_LOOKUPS: f64 = 1e6;

/// Refuses an experiment whose answer is no double, or whose draws would never end.
///
/// # Errors
///
/// The answer, or the expected lookups.
pub fn refuse_what_cannot_be_computed(ready: Ready) -> Result<Ready, Refusal> {
    for channel in &ready.prediction.channels {
        let truth = channel.truth.value;
        if !(truth.is_finite() && truth >= FAINTEST) {
            let needs = "an answer between 1e-300 and infinity";
            let channel = &channel.name;
            let found = if truth.is_nan() {
                format!("theory does not know {channel}")
            } else {
                format!("{channel} is {truth:e}")
            };
            return Err(Refusal::mismatch(needs, found));
        }
    }
    match &ready.prediction.lookups {
        Some(lookups) if lookups.mean.is_nan() || lookups.mean > MOST_LOOKUPS => {
            let needs = "at most a million lookups a draw";
            Err(Refusal::mismatch(needs, format!("theory expects {:e}", lookups.mean)))
        }
        _ => Ok(ready),
    }
}
