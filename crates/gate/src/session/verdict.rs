//! Verdicts on foreign draws, on images and on stacks of images, in order of precedence.
//!
//! ```text
//! a draw that refutes the claim by itself   fail, before all else
//! the draws depend on each other            inconclusive: what the gate says holds for independent draws
//! variance, mean, lookups, drift            fail; inconclusive; else pass
//! ```
//!
//! A variance that is refuted only because the mean deviates does not fail. One that is refuted as too small is
//! named before the mean. A mean that deviates only in units of that variance does not fail: its evidence relies on
//! a refuted variance.

use super::dependence::{an_index, off_without_change};
use super::flights::FlightFindings;
use super::judgement::{IndependenceFinding, InvalidDraw, Judgement, ScalarFinding, Stop};
use super::reading::{Reading, Refuted};
use super::reason::Reason;
use super::scalar::Scalar;
use crate::CheckId;
use crate::stats::gate;
use crate::stats::verdict::{GateFinding, Verdict};
use numeric::digits::short;

/// Findings in sentences, by the verdict that follows from them.
#[derive(Debug, Clone, Default)]
pub struct Reasons {
    /// A draw that refutes the claim by itself: fail.
    pub refuted: Option<String>,
    /// A dependence: inconclusive, and no other finding counts.
    pub dependent: Option<String>,
    /// Quantities that fail.
    pub failing: Vec<String>,
    /// Quantities that are not decided.
    pub open: Vec<String>,
    /// Remarks on a pass.
    pub passing: Vec<String>,
}

impl Reasons {
    /// The verdict and its reason; the reason of a plain pass is empty.
    pub fn verdict(self) -> (Verdict, String) {
        let Self { refuted, dependent, failing, open, passing } = self;
        let alone = |reason: Option<String>| reason.into_iter().collect::<Vec<_>>();
        let decisive = [
            (Verdict::Fail, alone(refuted)),
            (Verdict::Inconclusive, alone(dependent)),
            (Verdict::Fail, failing),
            (Verdict::Inconclusive, open),
        ];
        let result = decisive.into_iter().find(|(_, reasons)| !reasons.is_empty());
        let (verdict, reasons) = result.unwrap_or((Verdict::Pass, passing));
        (verdict, reasons.join("; "))
    }
}

/// Returns the verdict on a mean beside that on its variance, with the reason; `None` if the variance changes nothing.
///
/// ```text
/// the mean passes   pass if the variance is underpowered, on the assumption that it is right;
///                   inconclusive if the variance fails or is inconclusive
/// the mean fails    inconclusive if the variance is refuted as too small, and the mean is not off by itself
/// ```
///
/// `variance` is the verdict on the variance with the numbers of its gate. A mean is off by itself if it also fails with
/// the variance that the draws show. `what` is the name of the mean.
pub fn beside_variance(
    what: &'static str,
    mean: Verdict,
    variance: (Verdict, Option<GateFinding>),
    is_off_by_itself: impl FnOnce(&GateFinding) -> bool,
) -> Option<(Verdict, Reason)> {
    match (mean, variance) {
        (Verdict::Pass, (Verdict::Underpowered, _)) => {
            Some((Verdict::Pass, Reason::VarianceAssumed))
        }
        (Verdict::Pass, (Verdict::Fail | Verdict::Inconclusive, _)) => {
            Some((Verdict::Inconclusive, Reason::VarianceOpen))
        }
        (Verdict::Fail, (Verdict::Fail, Some(gate))) if gate.mean > 0.0 => {
            let rests = !is_off_by_itself(&gate);
            rests.then(|| (Verdict::Inconclusive, Reason::RestsOnVariance(what.into())))
        }
        _ => None,
    }
}

/// Returns whether a mean also fails with the variance that the draws show, by the numbers of the gate on both.
pub fn is_off_by_itself(mean: &GateFinding, variance: &GateFinding) -> bool {
    let spread = mean.variance * (1.0 + variance.mean) - mean.mean * mean.mean;
    gate::is_off_by_itself(mean.mean, spread, mean.draws as f64, mean.ln_e_limit)
}

/// Returns whether squares about many truths at once, such as those of all pixels, are too large because of their
/// variance. The relative excess about the means of the draws is then at least half of that about the truths.
/// Biased means enlarge the latter alone.
pub fn is_by_spread(about_truth: f64, about_mean: f64) -> bool {
    about_mean - 1.0 >= 0.5 * (about_truth - 1.0)
}

/// The verdict of the whole, and its guarantees.
pub(super) fn decide(reading: &Reading, judgement: &mut Judgement) {
    let off = judgement.drift.as_ref().and_then(|drift| off_without_change(reading, drift));
    let mean = judgement.findings.iter_mut().find(|result| result.check == CheckId::Mean);
    if let (Some(reason), Some(mean)) = (off, mean.filter(|mean| mean.verdict != Verdict::Fail)) {
        (mean.verdict, mean.reason) = (Verdict::Fail, Some(reason));
    }
    put_variance_first(reading, judgement);
    let is_dependent = judgement.independence.is_refuted();
    if is_dependent {
        withhold(judgement);
    }
    let of = |verdict: Verdict| -> Vec<String> {
        let drift = judgement.drift.as_ref().map(|result| (result.verdict, &result.reason));
        let scalars = judgement.findings.iter().map(|result| (result.verdict, &result.reason));
        let tests = judgement.distribution.iter().map(|result| (result.verdict, &result.reason));
        let alike = scalars.chain(drift).chain(tests).filter(|(result, _)| *result == verdict);
        alike.filter_map(|(_, reason)| reason.as_ref().map(Reason::to_string)).collect()
    };
    let refuted = reading.refuted.as_ref();
    let refuted = refuted.map(|refuted| fault(reading, refuted, judgement.refuting));
    let reasons = Reasons {
        refuted: refuted.or_else(|| reading.ends.as_ref().and_then(FlightFindings::wrong)),
        dependent: is_dependent.then(|| dependent(&judgement.independence)),
        failing: of(Verdict::Fail),
        open: of(Verdict::Inconclusive),
        // A mean that deviates within the tolerance.
        passing: of(Verdict::Pass),
    };
    (judgement.verdict, judgement.reason) = reasons.verdict();
    judgement.guarantees = guarantees(reading, judgement);
}

/// Names a refuted variance before the mean, and lets a mean that deviates only in units of it not fail.
fn put_variance_first(reading: &Reading, judgement: &mut Judgement) {
    let place = |check: CheckId| judgement.findings.iter().position(|result| result.check == check);
    let (Some(at), Some(variance)) = (place(CheckId::Mean), place(CheckId::Variance)) else {
        return;
    };
    let result = &judgement.findings[variance];
    if result.verdict != Verdict::Fail {
        return;
    }
    let refuted = (result.verdict, result.gate);
    let is_off = reading.mean.as_ref().is_some_and(Scalar::is_off_by_itself);
    // Squares are taken about the truth: where that is not the mean, they are larger by the square of the bias.
    let about_mean = judgement.variance_ratio.map_or(f64::INFINITY, |ratio| ratio - 1.0);
    let is_by_mean = |gate: &GateFinding| gate.mean > 0.0 && about_mean <= gate.tolerance;
    let mean_fails = judgement.findings[at].verdict == Verdict::Fail;
    if let Some(gate) = result.gate.filter(|gate| is_off && mean_fails && is_by_mean(gate)) {
        let result = &mut judgement.findings[variance];
        result.verdict = Verdict::Inconclusive;
        result.reason = Some(Reason::SquaresByMean { about_truth: gate.mean, about_mean });
        return;
    }
    // A mean that passes keeps its verdict, since the variance fails the draws.
    let rests = |what, verdict: Verdict| match verdict {
        Verdict::Fail => beside_variance(what, verdict, refuted, |_| is_off),
        _ => None,
    };
    let mean = &mut judgement.findings[at];
    if let Some((verdict, reason)) = rests("the mean", mean.verdict) {
        (mean.verdict, mean.reason) = (verdict, Some(reason));
    }
    if let Some(drift) = &mut judgement.drift
        && let Some((verdict, reason)) = rests("whether the mean changes", drift.verdict)
    {
        (drift.verdict, drift.reason) = (verdict, Some(reason));
    }
    judgement.findings.swap(at, variance);
}

/// Withdraws the findings of the gate: they hold for independent draws only.
fn withhold(judgement: &mut Judgement) {
    let not_judged = |what: &'static str| Some(Reason::NotJudged(what.into()));
    for result in &mut judgement.findings {
        result.verdict = Verdict::Inconclusive;
        result.reason = not_judged(match result.check {
            CheckId::Mean => "the mean",
            CheckId::Variance => "the variance",
            _ => "the number of lookups",
        });
    }
    if let Some(drift) = &mut judgement.drift {
        (drift.verdict, drift.reason) = (Verdict::Inconclusive, not_judged("the drift"));
    }
    for result in &mut judgement.distribution {
        (result.verdict, result.reason) = (Verdict::Inconclusive, not_judged("the distribution"));
    }
}

fn dependent(result: &IndependenceFinding) -> String {
    let cure = match (result.replay, result.batch) {
        (Some(_), _) => {
            "give each draw once, and give each pass and thread a seed of its own".into()
        }
        (None, Some(batch)) => format!(
            "judge averages of {batch} draws (batch), from where on no dependence shows, and give the \
             variance of averages or a range"
        ),
        (None, None) => "give one average a pass, or judge averages (batch)".to_owned(),
    };
    let reason = result.reason.as_ref().map_or(String::new(), Reason::to_string);
    format!("{reason}; the mean is not judged: {cure}")
}

/// Describes the error of a draw.
fn fault(reading: &Reading, refuted: &Refuted, count: u64) -> String {
    let claim = &reading.trial.claim;
    let &Refuted { fault, index, value } = refuted;
    let truth = claim.truth;
    let said = match fault {
        InvalidDraw::Number if value.is_finite() => {
            format!("numeric: draw {index} is {value:e}, beyond measure for a truth of {truth:e}")
        }
        InvalidDraw::Number => format!("numeric: draw {index} is {value}, counted from 0"),
        InvalidDraw::Range => {
            let [low, high] = claim.range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
            format!("range: draw {index} is {value:e}, outside of {low} to {high}")
        }
        InvalidDraw::Spread => {
            let bound = reading.trial.bound() * claim.unit;
            let unused =
                unused_tolerance(reading).map_or(String::new(), |said| format!("; {said}"));
            format!("draw {index} is {value:e}, not {truth:e}; {bound:.1e} is rounding{unused}")
        }
        InvalidDraw::Lookups => {
            let expected = claim.lookups.map_or(0.0, |lookups| lookups.mean);
            format!("lookups: draw {index} takes {value} lookups, not {expected}")
        }
        InvalidDraw::Distance => format!("distance: draw {index} is {value}, which is no distance"),
    };
    let is_distance = matches!(fault, InvalidDraw::Number | InvalidDraw::Distance);
    let cure = reading.ends.as_ref().filter(|_| is_distance).map(FlightFindings::cure);
    let said = cure.map_or(said.clone(), |cure| format!("{said}; {cure}"));
    let index = reading.steps.found().map(|step| format!("; {}", an_index(step)));
    let said = said + &index.unwrap_or_default();
    if count > 1 { format!("{said}; {count} draws are like that") } else { said }
}

/// Reason why a tolerance of the mean is not used.
fn unused_tolerance(reading: &Reading) -> Option<String> {
    let requested = reading.trial.options.tolerance.filter(|_| reading.mean.is_none())?;
    Some(format!(
        "the tolerance of {requested:.1e} is not used: the variance given allows rounding alone; leave the variance \
         out, or give a larger one"
    ))
}

/// Guarantees of the verdict, and their limits.
fn guarantees(reading: &Reading, judgement: &Judgement) -> Vec<String> {
    let mut said = Vec::new();
    match judgement.finding(CheckId::Mean) {
        None => {
            let what =
                "no spread: every draw read is the truth to rounding, or the verdict is fail";
            said.push(what.into());
            said.extend(unused_tolerance(reading));
        }
        Some(mean) => {
            said.push(failing(reading, judgement, mean));
            said.extend(missing(judgement, mean));
        }
    }
    let variance = judgement.finding(CheckId::Variance);
    if reading.trial.is_faint() && !reading.trial.is_certain() {
        said.push("the variance is not tested: rounding hides it".into());
    }
    if variance.is_some_and(|result| result.is_estimated) {
        said.push(
            "kurtosis estimated: the variance fails only where it is too large, which needs no \
             kurtosis; it passes by the squares that were drawn, and rare ones that were not may \
             carry it"
                .into(),
        );
    }
    if judgement.single_precision {
        let what = "single precision: draws have 24 bits; a bias below 6e-8 of a draw cannot show";
        said.push(what.into());
    }
    if judgement.unfilled > 0 {
        said.push(format!(
            "the last {} draws fill no average and were not judged",
            judgement.unfilled
        ));
    }
    if let Some(bits) = judgement.resolution {
        said.push(format!("resolution: the first draws repeat as if they took 2^{bits:.1} values"));
    }
    let draws = judgement.draws;
    match judgement.stopped {
        Some(Stop::Decided) => {
            said.push(format!("stopped early: what comes after {draws} draws was not seen"));
        }
        Some(Stop::Limit) => {
            said.push(format!("stopped at the limit: what comes after {draws} draws was not seen"));
        }
        None => {}
    }
    said
}

/// Guarantee on failures: the draws that fail at most with probability α.
fn failing(reading: &Reading, judgement: &Judgement, mean: &ScalarFinding) -> String {
    let claim = &reading.trial.claim;
    let alpha = judgement.alpha;
    let draws = if judgement.batch > 1 { "averages" } else { "draws" };
    let correct = if judgement.finding(CheckId::Variance).is_some() || claim.range.is_some() {
        format!("correct {draws}")
    } else if claim.variance.is_some() {
        format!("{draws} of the right mean and variance")
    } else {
        format!("{draws} of the right mean")
    };
    let who = match (claim.variance, claim.kurtosis, mean.is_estimated) {
        (None, Some(maximum), _) => format!("{correct} with a kurtosis of {maximum} at most"),
        (None, None, true) => {
            let shown = judgement.kurtosis.map_or("no spread".to_owned(), |k| format!("{k:.3}"));
            let cure = "give the variance, the range or the largest kurtosis for a promise";
            let seems = if claim.range.is_some() { "too small" } else { "off" };
            let nothing = format!(
                "variance estimated: {draws} whose mean seems {seems} do not fail, since rare events \
                 that were not drawn may carry it; {cure}"
            );
            return match mean.assumed_kurtosis {
                Some(maximum) if mean.verdict == Verdict::Pass => format!(
                    "{nothing}; a mean off by the tolerance passes with probability {} at most if the \
                     kurtosis is {maximum:.0} at most (they show {shown}); the variance is not tested",
                    judgement.beta
                ),
                _ => nothing,
            };
        }
        _ => correct,
    };
    format!("independent {who} fail with probability {} at most", short(alpha, 3))
}

/// Guarantee of a pass of the mean.
fn missing(judgement: &Judgement, mean: &ScalarFinding) -> Option<String> {
    let beta = judgement.beta;
    let miss = format!("a mean off by the tolerance passes with probability {beta} at most");
    match judgement.finding(CheckId::Variance) {
        None if mean.is_estimated => None,
        None if judgement.predicted_variance.is_some() => {
            Some(format!("variance assumed: {miss}, if the variance is right"))
        }
        None => Some(miss),
        Some(result) if result.verdict == Verdict::Pass => {
            Some(format!("{miss}; the variance it relies on passes"))
        }
        Some(_) if mean.verdict == Verdict::Pass => {
            Some(format!("variance assumed: {miss}, if the variance is right"))
        }
        Some(_) => None,
    }
}
