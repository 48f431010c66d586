//! The mean of the draws against the exact answer, by the gate.
//!
//! ```text
//! y = (X − T)/u,  V = Var[X]/u² in theory,  u = T, or the opacity 1 − T where τ < 0.1
//! ```
//!
//! The mean may pass only if the variance of the same experiment passes too; where the variance is underpowered, the
//! pass says so (`variance assumed`). Draws without spread must all equal the truth to rounding. Where the spread is
//! small but not 0, the gate allows for rounding.
//!
//! Where theory has only a bound on the variance, V is that bound, and no variance is tested: a pass is then promised
//! for draws that keep the bound. Where theory has no bound but knows that tails are light, as for the length of a
//! walk, V is twice the variance of pilot draws. A case that declares an experiment biased passes only if the bias is
//! shown; where theory has no variance for it, V is also twice that of pilot draws.

use super::always::Always;
use super::batch::Observe;
use super::check::{Check, Question, Subject, Untestable, rounding_of};
use super::scalar::{ScalarCheck, variance};
use crate::CheckKind;
use estimators::DrawBuffer;
use gate::CheckId;
use gate::session::Quantity;
use gate::session::quantity::{MEAN_CAP, mean_floor};
use gate::stats::verdict::FURTHEST;
use theory::Channel;

/// Returns whether rounding dominates the spread of the draws, if they have any.
pub fn is_faint(subject: &Subject, channel: &Channel) -> bool {
    deviation(channel).is_some_and(|deviation| deviation <= 1e3 * floor(subject, channel))
}

/// Returns √V in units of the channel.
fn deviation(channel: &Channel) -> Option<f64> {
    let moments = channel.moments?;
    Some(moments.relative[0].sqrt() * moments.scale / channel.unit)
}

/// Returns δ, a bound on the truth's own error and on rounding, in units of the channel.
fn floor(subject: &Subject, channel: &Channel) -> f64 {
    let truth = channel.truth;
    mean_floor(truth.error, truth.value.abs() * rounding_of(subject), channel.unit)
}

/// The check.
pub const CHECK: CheckKind = CheckKind::new(CheckId::Mean, questions).of_biased();

/// Returns the questions of this check.
fn questions(subject: &Subject) -> Vec<Question> {
    let channels = subject.prediction.channels.iter().enumerate();
    channels
        .map(|(index, channel)| {
            Question::channel(CheckId::Mean, index, "the mean", answer(subject, index, channel))
        })
        .collect()
}

/// Effective number of pilot draws below which their variance counts as unknown.
const SETTLED: f64 = 40.0;

fn answer(subject: &Subject, index: usize, channel: &Channel) -> Box<dyn Check> {
    let untestable = |why: String| Box::new(Untestable(why));
    let (truth, scale) = (channel.truth.value, 1.0 / channel.unit);
    let floor = floor(subject, channel);
    let blur = channel.truth.error / channel.unit;
    if blur.is_nan() || blur > subject.tolerance.mean.unwrap_or(MEAN_CAP) {
        // Every mean would be within the truth's own error.
        return untestable(format!("the exact answer is known to {blur:.1e} only"));
    }
    if let Some(furthest) = deviation(channel).map(|d| FURTHEST * d).filter(|&far| far <= floor) {
        let largest = move |draws: &DrawBuffer| {
            draws.values[index].iter().fold(0.0, |maximum: f64, x| {
                let y = ((x - truth) * scale).abs();
                if y.is_nan() { y } else { maximum.max(y) }
            })
        };
        return Box::new(Always::new(largest, floor + furthest));
    }
    let may_be_piloted = subject.expect_biased || channel.pilot_variance_allowed;
    let pilot = subject.pilots.map(|pilots| pilots[index]).filter(|_| may_be_piloted);
    if channel.pilot_variance_allowed && pilot.is_some_and(|pilot| pilot.size < SETTLED) {
        return untestable("a few of the pilot draws make all of their variance".into());
    }
    let doubled = pilot.map(|pilot| 2.0 * pilot.variance);
    // The bound holds for the correct estimator: a biased one has a spread of its own.
    let assumed = if subject.expect_biased {
        doubled.or(channel.variance_bound)
    } else {
        channel.variance_bound.or(doubled)
    };
    let (known, error) = match (channel.moments, assumed) {
        (Some(moments), _) => {
            let unit = moments.scale * scale;
            (moments.relative[0] * unit * unit, moments.error)
        }
        (None, Some(maximum)) => (maximum * scale * scale, 0.0),
        (None, None) => return untestable("theory has no variance for it".into()),
    };
    if !known.is_finite() {
        return untestable("the variance overflows".into());
    }
    if known <= 0.0 {
        return untestable("draws without a spread tell nothing here".into());
    }
    let observe = Observe::each_value(
        index,
        #[inline(always)]
        move |x| (x - truth) * scale,
    );
    let mean = Quantity::mean(variance(known, error), floor).within(subject.tolerance.mean);
    Box::new(ScalarCheck::new(subject, mean.of(truth, channel.unit), observe))
}
