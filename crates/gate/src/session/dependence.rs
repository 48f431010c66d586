//! Conditions of the gate: draws that are independent, and that have one mean from beginning to end.

use super::judgement::{DriftFinding, IndependenceFinding};
use super::reading::Reading;
use super::reason::Reason;
use super::scalar::SIDE_SHARE;
use crate::stats::replays::{Replay, Replays, hash};
use crate::stats::sequences::Sequences;
use crate::stats::verdict::Verdict;
use numeric::digits::short;

/// Finds a change of the mean: only where later draws plainly differ from earlier ones, and from the truth.
pub(super) fn drift(reading: &Reading) -> Option<DriftFinding> {
    // Without a ground to fail the mean, a change has no ground either.
    let mean = reading.mean.as_ref().filter(|mean| mean.has_ground())?;
    let (ln_e, batch) = (mean.ln_change, reading.trial.options.batch);
    let ln_e_limit = -(SIDE_SHARE * reading.trial.options.alpha).ln();
    let is_refuted = (ln_e >= ln_e_limit || mean.has_failed()) && mean.is_founded();
    let change = mean.obvious_change().filter(|_| is_refuted);
    let Some(change) = change else {
        let (verdict, reason) = (Verdict::Pass, None);
        return Some(DriftFinding { verdict, reason, ln_e, ln_e_limit, from: None, off: 0.0 });
    };
    let (from, off) = (change.from * batch, change.off);
    let inside = change.to.unwrap_or(mean.past.draws()) - change.from;
    let reason = Reason::Changes {
        from,
        to: change.to.map(|to| to * batch),
        off: mean.quantity.deviation(off, inside),
        z: change.z,
    };
    let (verdict, reason, from) = (Verdict::Fail, Some(reason), Some(from));
    Some(DriftFinding { verdict, reason, ln_e, ln_e_limit, from, off })
}

/// Reason why the mean fails where evidence from some draw on refutes it, but no change is found.
pub(super) fn off_without_change(reading: &Reading, drift: &DriftFinding) -> Option<Reason> {
    let mean = reading.mean.as_ref()?;
    let (ln_e, limit) = (drift.ln_e, drift.ln_e_limit);
    let is_off = drift.verdict == Verdict::Pass && ln_e >= limit && mean.is_founded();
    is_off.then(|| Reason::Off {
        what: mean.quantity.what.clone(),
        off: mean.quantity.deviation(mean.past.mean(), mean.past.draws()),
        remark: String::new(),
        ln_e,
        limit,
        tolerance: None,
    })
}

/// Finds dependence of draws: half of the level is for adjacent draws, half for replays.
pub(super) fn independence(reading: &Reading) -> IndependenceFinding {
    let ln_e_limit = (2.0 / reading.trial.options.alpha).ln();
    let mut finding = IndependenceFinding {
        ln_e: reading.independence.ln_e(),
        ln_e_limit,
        ..IndependenceFinding::default()
    };
    // Draws with a claimed variance of 0 are all equal.
    if reading.mean.is_none() {
        return finding;
    }
    if finding.ln_e >= ln_e_limit
        && let Some(strongest) = reading.independence.strongest(ln_e_limit)
    {
        let (scale, lag, r) = (strongest.scale, strongest.lag, strongest.correlation);
        (finding.scale, finding.lag, finding.correlation) = (Some(scale), Some(lag), Some(r));
        finding.batch = reading.independence.free_batch(ln_e_limit);
        finding.reason = Some(Reason::Dependent(match scale {
            1 => format!("correlation at lag {lag} is {r:.2}"),
            _ => format!("correlation between sums of {scale} consecutive draws is {r:.2}"),
        }));
    }
    if let Some(step) = reading.steps.found() {
        finding.reason = Some(Reason::Dependent(an_index(step)));
        return finding;
    }
    if let Some(Again { distance, times, ln_p, what }) = again(reading, ln_e_limit) {
        (finding.replay, finding.repeats, finding.replay_ln_p) =
            (Some(distance), Some(times), ln_p);
        finding.reason = Some(Reason::Dependent(what));
    }
    finding
}

/// Describes draws that differ by one step from draw to draw.
pub(super) fn an_index(step: f64) -> String {
    let (verb, size) = (if step > 0.0 { "rise" } else { "fall" }, short(step.abs(), 6));
    format!("values {verb} by {size} from draw to draw: an index? choose the column of the values")
}

/// Minimum number of equal steps of an index.
const MIN_STEPS: u64 = 16;

/// Steps from draw to draw, as long as all are equal.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Steps {
    last: Option<f64>,
    step: Option<f64>,
    count: u64,
    differ: bool,
}

impl Steps {
    pub(super) fn absorb(&mut self, draws: &[f64]) {
        for &x in draws {
            if self.differ {
                return;
            }
            if let Some(last) = self.last.replace(x) {
                let step = x - last;
                let first = *self.step.get_or_insert(step);
                // Multiples of a step are rounded; steps near rounding are noise, and NaN is no step.
                let rounding = 4.0 * f64::EPSILON * x.abs();
                let is_equal = (step - first).abs() <= 1e-9 * first.abs() + rounding;
                self.differ = !(is_equal && rounding < 1e-3 * first.abs());
                self.count += 1;
            }
        }
    }

    /// The step, if all are equal and not 0.
    pub(super) fn found(&self) -> Option<f64> {
        self.step.filter(|step| !self.differ && *step != 0.0 && self.count >= MIN_STEPS)
    }
}

/// A repetition of draws.
struct Again {
    distance: u64,
    times: u64,
    /// ln of a bound on the probability of that repetition for independent draws.
    ln_p: Option<f64>,
    what: String,
}

/// Finds a repetition of draws. Three searches share their half of the level; with averages, five do.
fn again(reading: &Reading, ln_e_limit: f64) -> Option<Again> {
    let batch = reading.trial.options.batch;
    let searches: f64 = if batch == 1 { 3.0 } else { 5.0 };
    let limit = ln_e_limit + searches.ln();
    let unit = if batch == 1 { "draws" } else { "averages" };
    if let Some(times) = reading.contents.as_ref().and_then(Contents::alike) {
        let what = format!("all {times} averages hold the same draws");
        return Some(Again { distance: batch, times, ln_p: None, what });
    }
    let written = reading.runs.found().filter(|&(_, ln_p)| ln_p <= -limit);
    if let Some((times, ln_p)) = written {
        let what = format!("{unit} are written more than once: each {times} times");
        return Some(Again { distance: batch, times, ln_p: Some(ln_p), what });
    }
    let said = |replay: Replay, batch: u64, unit: &str| {
        let (distance, times, ln_p) = (replay.distance * batch, replay.times, Some(replay.ln_p));
        let what = match replay.distance {
            1 => format!("{unit} are written more than once"),
            _ => format!("the same {unit} come again {distance} draws later, {times} times in all"),
        };
        Again { distance, times, ln_p, what }
    };
    let replays = [reading.replays.found(), reading.sequences.found()].into_iter().flatten();
    let replays = replays.filter(|replay| replay.ln_p <= -limit);
    let replay = replays.min_by(|a, b| a.ln_p.total_cmp(&b.ln_p));
    let behind = reading.contents.as_ref().and_then(Contents::replay);
    let behind = behind.filter(|replay| replay.ln_p <= -limit);
    replay
        .map(|finding| said(finding, batch, unit))
        .or(behind.map(|finding| said(finding, 1, "draws")))
}

/// Minimum number of averages that may be reported as alike.
const FEWEST: u64 = 3;

/// Draws behind averages of `batch` draws each, to find averages that all hold the same draws, and draws that
/// repeat across them.
///
/// Draws within an average may depend on each other in any way. Each place of an average may have a distribution of
/// its own, such as a pixel that is black in every pass. A distance that is shorter than an average, or a multiple
/// of its length, is therefore no evidence; equal averages already show the latter. Two findings remain. One is a
/// distance across averages, which independent averages have only if values come in a fixed order of their own. The
/// other one is averages that all hold the same draws. Independent averages never do, unless their draws are not
/// random.
pub(super) struct Contents {
    batch: u64,
    replays: Replays,
    sequences: Sequences,
    /// Number and hash of the draws in the incomplete average.
    count: u64,
    hash: u64,
    first: Option<u64>,
    averages: u64,
    are_alike: bool,
    last: f64,
    is_varied: bool,
}

impl Contents {
    pub(super) fn new(batch: u64) -> Self {
        Self {
            batch,
            replays: Replays::default(),
            sequences: Sequences::default(),
            count: 0,
            hash: 0,
            first: None,
            averages: 0,
            are_alike: true,
            last: f64::NAN,
            is_varied: false,
        }
    }

    pub(super) fn absorb(&mut self, draws: &[f64]) {
        self.replays.absorb(draws);
        self.sequences.absorb(draws);
        if !self.are_alike {
            return;
        }
        for &x in draws {
            self.is_varied |= x != self.last && self.last.is_finite();
            self.last = x;
            self.hash = hash(self.hash.rotate_left(1) ^ x.to_bits());
            self.count += 1;
            if self.count == self.batch {
                self.averages += 1;
                self.are_alike &= *self.first.get_or_insert(self.hash) == self.hash;
                (self.count, self.hash) = (0, 0);
            }
        }
    }

    /// Number of averages, if all hold the same draws, and these are not all equal.
    pub(super) fn alike(&self) -> Option<u64> {
        let is_shown = self.are_alike && self.is_varied && self.averages >= FEWEST;
        is_shown.then_some(self.averages)
    }

    /// Draws that repeat in other averages, at another place.
    pub(super) fn replay(&self) -> Option<Replay> {
        let finding = [self.replays.found(), self.sequences.found()].into_iter().flatten();
        let across = |finding: &Replay| {
            finding.distance > self.batch && !finding.distance.is_multiple_of(self.batch)
        };
        finding.filter(across).min_by(|a, b| a.ln_p.total_cmp(&b.ln_p))
    }
}
