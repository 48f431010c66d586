//! An experiment that can be drawn, or why it cannot: what no computer with doubles can test in a
//! lifetime is refused.

use estimators::{Experiment, Refusal};
use theory::Prediction;

/// An experiment that can be drawn.
pub struct Ready {
    /// What draws.
    pub experiment: Box<dyn Experiment>,
    /// What theory says. For a forced experiment the moments are void and removed.
    pub prediction: Prediction,
}

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
        let is_known = channel.truth.error.is_finite();
        if !(truth.is_finite() && truth >= FAINTEST && is_known) {
            let needs = "an answer between 1e-300 and infinity";
            let channel = &channel.name;
            let found = if truth.is_nan() || !is_known {
                format!("theory does not know {channel}")
            } else {
                format!("{channel} is {truth:e}")
            };
            return Err(Refusal::mismatch(needs, found));
        }
        // What is biased may have another mean than the truth, in units of which all is counted.
        let mean = channel.mean.value;
        if !mean.is_finite() {
            let needs = "draws whose mean is below 1e300 truths";
            return Err(Refusal::mismatch(needs, format!("theory expects {mean:e}")));
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
