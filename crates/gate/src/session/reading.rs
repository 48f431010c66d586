//! Draws of one value on their way through all checks, block by block.

use super::claim::{BUFFER, CheckedClaim};
use super::dependence::{Contents, Steps};
use super::flights::FlightFindings;
use super::judgement::{InvalidDraw, Judgement, Stop};
use super::scalar::{Levels, Scalar, main_share};
use super::theory::{Background, Tested, Tests};
use super::{dependence, verdict};
use crate::CheckId;
use crate::stats::independence::Independence;
use crate::stats::replays::{Replays, Runs};
use crate::stats::sequences::Sequences;
use crate::stats::verdict::{MISS, Verdict};
use crate::stats::{Powers, ties};
use numeric::fused::{self, Loop};
use numeric::sum::Sum;

/// Minimum number of draws that are judged at a time.
const FEW: usize = 64;
/// Maximum number of different values among the first draws that count as a small set.
const VARIED: usize = 100;

/// The first draw that refutes the claim by itself.
#[derive(Debug, Clone, Copy)]
pub(super) struct Refuted {
    pub(super) fault: InvalidDraw,
    pub(super) index: u64,
    pub(super) value: f64,
}

/// Averages of `batch` consecutive numbers.
struct Averages {
    batch: u64,
    sum: Sum,
    count: u64,
    ready: Vec<f64>,
}

impl Averages {
    fn new(batch: u64) -> Self {
        Self { batch, sum: Sum::default(), count: 0, ready: Vec::new() }
    }

    fn add(&mut self, x: f64) {
        self.sum.add(x);
        self.count += 1;
        if self.count == self.batch {
            self.ready.push(self.sum.value() / self.batch as f64);
            (self.sum, self.count) = (Sum::default(), 0);
        }
    }
}

/// Draws of one value that are being judged, block by block.
pub(super) struct Reading {
    pub(super) trial: CheckedClaim,
    powers: Powers,
    pub(super) mean: Option<Scalar>,
    pub(super) variance: Option<Scalar>,
    pub(super) lookups: Option<Scalar>,
    pub(super) refuted: Option<Refuted>,
    refuting: u64,
    /// Range of draws, rounding included.
    range: Option<[f64; 2]>,
    read: u64,
    /// Number of draws or averages that were judged.
    judged: u64,
    averages: [Averages; 2],
    /// Number of draws or averages that are judged at a time.
    block: usize,
    pub(super) independence: Independence,
    pub(super) replays: Replays,
    pub(super) sequences: Sequences,
    pub(super) runs: Runs,
    /// Steps from draw to draw, before any averages.
    pub(super) steps: Steps,
    /// The draws behind averages.
    pub(super) contents: Option<Contents>,
    lookup_sum: Sum,
    is_single: bool,
    is_varied: bool,
    resolution: Option<f64>,
    pub(super) background: Background,
    pub(super) ends: Option<FlightFindings>,
    y: Vec<f64>,
    other: Vec<f64>,
}

impl Reading {
    /// The state before the first draw.
    pub(super) fn new(trial: CheckedClaim, background: Background) -> Self {
        let quantities = trial.quantities();
        let others = u32::from(!trial.is_certain()) + u32::from(background.tests.is_some());
        let levels = Levels::new(main_share(others) * trial.options.alpha, quantities.len());
        let maximum = trial.options.maximum.unwrap_or(u64::MAX);
        let length = trial.length.map(|length| length.min(maximum) / trial.options.batch);
        // Few draws make small blocks, so that later ones can be judged from earlier ones.
        let block = length.map_or(BUFFER, |n| usize::try_from(n / 16).unwrap_or(BUFFER));
        let block = block.next_power_of_two().clamp(FEW, BUFFER);
        // A known variance is judged in the blocks of a run.
        let is_known = trial.claim.variance.is_some() && trial.options.batch == 1;
        let block = if is_known { BUFFER } else { block };
        let planned = CheckedClaim::planned(&quantities, length);
        let scalar = |check: CheckId| {
            let quantity = quantities.iter().find(|quantity| quantity.check == check)?;
            Some(Scalar::new(quantity.clone(), planned, levels))
        };
        Self {
            trial,
            powers: Powers::default(),
            mean: scalar(CheckId::Mean),
            variance: scalar(CheckId::Variance),
            lookups: scalar(CheckId::Lookups),
            refuted: None,
            refuting: 0,
            range: trial.claim.widened(),
            read: 0,
            judged: 0,
            averages: [Averages::new(trial.options.batch), Averages::new(trial.options.batch)],
            block,
            independence: Independence::default(),
            replays: Replays::default(),
            sequences: Sequences::default(),
            runs: Runs::default(),
            steps: Steps::default(),
            contents: (trial.options.batch > 1).then(|| Contents::new(trial.options.batch)),
            lookup_sum: Sum::default(),
            is_single: true,
            is_varied: false,
            resolution: None,
            background,
            ends: trial
                .claim
                .flights
                .map(|flights| FlightFindings::new(flights, trial.claim.rounding)),
            y: Vec::with_capacity(BUFFER),
            other: Vec::with_capacity(BUFFER),
        }
    }

    /// Number of draws so far.
    pub(super) fn draws(&self) -> u64 {
        self.read
    }

    fn scalars(&mut self) -> impl Iterator<Item = &mut Scalar> {
        self.mean.iter_mut().chain(&mut self.variance).chain(&mut self.lookups)
    }

    /// Kind of the error of a draw that is not sound by itself.
    fn fault(&self, x: f64) -> InvalidDraw {
        let claim = &self.trial.claim;
        if zero_or_nan((x - claim.truth) / claim.unit) != 0.0 {
            InvalidDraw::Number
        } else if claim.flights.is_some() && x < 0.0 {
            InvalidDraw::Distance
        } else {
            InvalidDraw::Range
        }
    }

    /// Searches for draws that are no numbers, or outside the range.
    #[allow(clippy::needless_bitwise_bool)] // without branches, see `are_all`
    fn look_at_values(&mut self, block: &[f64]) {
        let claim = &self.trial.claim;
        let (truth, unit) = (claim.truth, claim.unit);
        let [low, high] = self.range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let low = if claim.flights.is_some() { low.max(0.0) } else { low };
        let is_sound = |x: f64| (zero_or_nan((x - truth) / unit) == 0.0) & (low <= x) & (x <= high);
        self.note(self.read, block, is_sound, Self::fault);
    }

    /// Adds draws with their lookups, if there are any.
    pub(super) fn absorb(&mut self, block: &[f64], lookups: &[f64]) {
        self.look_at_each(block, lookups);
        self.read += block.len() as u64;
        self.lookup_sum.add(lookups.iter().sum());
        if self.trial.options.batch == 1 {
            for (at, part) in block.chunks(self.block).enumerate() {
                let first = (at * self.block).min(lookups.len());
                let last = (first + part.len()).min(lookups.len());
                self.judge(part, &lookups[first..last]);
            }
            return;
        }
        if let Some(contents) = &mut self.contents {
            contents.absorb(block);
        }
        let [values, counts] = &mut self.averages;
        for &x in block {
            values.add(x);
        }
        for &m in lookups {
            counts.add(m);
        }
        while self.averages[0].ready.len() >= self.block {
            self.judge_averages(self.block);
        }
    }

    fn judge_averages(&mut self, count: usize) {
        let [values, counts] = &mut self.averages;
        let values: Vec<f64> = values.ready.drain(..count).collect();
        let counts: Vec<f64> = counts.ready.drain(..count.min(counts.ready.len())).collect();
        self.judge(&values, &counts);
    }

    /// Searches for draws that refute the claim by themselves.
    #[allow(clippy::needless_bitwise_bool)] // without branches, see `are_all`
    fn look_at_each(&mut self, block: &[f64], lookups: &[f64]) {
        if self.read == 0 {
            let mut values = block.to_vec();
            let ties = ties::ties(&mut values);
            self.is_varied = block.len() - ties > VARIED;
            self.resolution = ties::resolution(&mut values);
        }
        self.steps.absorb(block);
        self.is_single &= ties::all_single_precision(block);
        self.look_at_values(block);
        if let Some(claimed) = self.trial.claim.lookups {
            // A predicted number may be rounded; a draw that differs by one is far beyond that.
            let reach = if claimed.is_fixed() { 0.5 } else { f64::INFINITY };
            let is_sound = |m: f64| m.is_finite() & ((m - claimed.mean).abs() <= reach);
            self.note(self.read, lookups, is_sound, |_, _| InvalidDraw::Lookups);
        }
    }

    /// Notes the errors of numbers; the first of them is draw number `first`.
    fn note(
        &mut self,
        first: u64,
        values: &[f64],
        is_sound: impl Fn(f64) -> bool,
        fault: impl Fn(&Self, f64) -> InvalidDraw,
    ) {
        if are_all(values, &is_sound) {
            return;
        }
        for (index, &value) in (first..).zip(values).filter(|(_, value)| !is_sound(**value)) {
            let fault = fault(self, value);
            self.refuting += 1;
            if self.refuted.is_none_or(|earlier| index < earlier.index) {
                self.refuted = Some(Refuted { fault, index, value });
            }
        }
    }

    /// Passes a block of draws or averages to all checks.
    #[allow(clippy::needless_bitwise_bool)] // without branches, see `are_all`
    fn judge(&mut self, block: &[f64], lookups: &[f64]) {
        let claim = &self.trial.claim;
        let batch = self.trial.options.batch;
        let (truth, unit) = (claim.truth, claim.unit);
        self.y.clear();
        self.y.extend(block.iter().map(|x| (x - truth) / unit));
        let bound = if self.mean.is_none() { self.trial.bound() } else { f64::INFINITY };
        let is_number = |y: f64| zero_or_nan(y) == 0.0;
        let is_sound = |y: f64| is_number(y) & (y.abs() <= bound);
        let mut is_finite = true;
        if !are_all(&self.y, is_sound) {
            for (at, (&y, &value)) in (self.judged..).zip(self.y.iter().zip(block)) {
                if is_sound(y) {
                    continue;
                }
                is_finite &= is_number(y);
                // The first look reports draws that are not numbers.
                if is_number(y) || batch > 1 {
                    let fault =
                        if is_number(y) { InvalidDraw::Spread } else { InvalidDraw::Number };
                    self.refuting += 1;
                    let index = at * batch;
                    self.refuted = self.refuted.or(Some(Refuted { fault, index, value }));
                }
            }
        }
        self.judged += block.len() as u64;
        if !is_finite {
            return;
        }
        self.independence.absorb(&self.y);
        self.replays.absorb(block);
        self.sequences.absorb(block);
        self.runs.absorb(block);
        self.powers.absorb(&self.y);
        if let Some(mean) = &mut self.mean {
            mean.absorb(&self.y);
        }
        if let (Some(scalar), Some(variance)) = (&mut self.variance, claim.variance) {
            let scale = unit / variance.sqrt();
            self.other.clear();
            self.other.extend(self.y.iter().map(|y| (y * scale) * (y * scale) - 1.0));
            scalar.absorb(&self.other);
        }
        if let (Some(scalar), Some(claimed)) = (&mut self.lookups, claim.lookups) {
            self.other.clear();
            self.other.extend(lookups.iter().map(|m| m / claimed.mean - 1.0));
            if self.other.iter().all(|y| y.is_finite()) {
                scalar.absorb(&self.other);
            }
        }
    }

    /// Returns whether more draws may change the verdict.
    pub(super) fn is_open(&self) -> bool {
        if self.refuted.is_some() {
            return false;
        }
        if self.mean.is_none() {
            return true;
        }
        let scalars = [&self.mean, &self.variance, &self.lookups].into_iter().flatten();
        let mut scalars = scalars.map(|scalar| (scalar.has_failed(), scalar.is_open()));
        // A failed check decides; otherwise draws continue while any check is open.
        let [failed, open] =
            scalars.by_ref().fold([false; 2], |[failed, open], (f, o)| [failed | f, open | o]);
        !failed && open
    }

    /// The final judgement; `stopped` is the reason if draws are left.
    pub(super) fn close(mut self, stopped: Option<Stop>) -> Judgement {
        let rest = self.averages[0].ready.len();
        if rest > 0 {
            self.judge_averages(rest);
        }
        self.scalars().for_each(Scalar::decide);
        let tested = self.background.tests.take().map_or(Tested::default(), Tests::close);
        let mut notes = std::mem::take(&mut self.background.notes);
        notes.extend(tested.untested);
        let is_single = self.ends.as_ref().map_or(self.is_single, |ends| ends.is_single);
        let CheckedClaim { claim, options, length } = &self.trial;
        let unit = claim.unit;
        let n = self.powers.draws() as f64;
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        let variance = finite(self.powers.variance() * unit * unit).filter(|_| n > 1.0);
        let spread = claim.variance.or(variance).filter(|&variance| variance > 0.0);
        let error = spread.map(|variance| (variance / n).sqrt());
        let off = finite(self.powers.mean() * unit);
        let kurtosis = finite(self.powers.kurtosis());
        let known = claim.variance.filter(|&variance| variance > 0.0);
        let tails = claim.kurtosis.or(kurtosis).filter(|_| known.is_some());
        let findings = [&self.mean, &self.variance, &self.lookups].into_iter().flatten();
        let mut judgement = Judgement {
            verdict: Verdict::Pass,
            reason: String::new(),
            fault: self.refuted.as_ref().map(|refuted| refuted.fault),
            guarantees: Vec::new(),
            alpha: options.alpha,
            beta: MISS,
            draws: self.read,
            length: *length,
            stopped,
            batch: options.batch,
            unfilled: self.averages[0].count,
            truth: claim.truth,
            unit,
            mean: off.map(|off| claim.truth + off),
            standard_error: error,
            z: off.zip(error).map(|(off, error)| off / error),
            variance,
            predicted_variance: claim.variance,
            variance_ratio: variance.zip(known).map(|(result, claimed)| result / claimed),
            variance_band: tails.map(|kurtosis| ((kurtosis - 1.0).max(0.0) / n).sqrt()),
            kurtosis,
            lookups: claim.lookups.and_then(|_| finite(self.lookup_sum.value() / self.read as f64)),
            predicted_lookups: claim.lookups.map(|claimed| claimed.mean),
            refuted_by: self.refuted.as_ref().map(|refuted| refuted.index),
            refuting: self.refuting,
            single_precision: is_single && self.is_varied,
            resolution: self.resolution,
            findings: findings.map(Scalar::finding).collect(),
            drift: dependence::drift(&self),
            independence: dependence::independence(&self),
            theory: self.background.theory.take(),
            distribution: tested.findings,
        };
        verdict::decide(&self, &mut judgement);
        judgement.guarantees.extend(notes);
        judgement
    }
}

/// Returns whether a condition holds for all numbers. The loop has no branches, so that it is compiled for wide registers.
fn are_all(values: &[f64], is_sound: impl Fn(f64) -> bool) -> bool {
    struct Unsound<'a, F> {
        values: &'a [f64],
        is_sound: F,
        count: &'a mut u64,
    }
    impl<F: Fn(f64) -> bool> Loop for Unsound<'_, F> {
        #[inline(always)]
        fn run(self) {
            *self.count = self.values.iter().map(|&x| u64::from(!(self.is_sound)(x))).sum();
        }
    }
    let mut count = 0;
    fused::run(Unsound { values, is_sound, count: &mut count });
    count == 0
}

/// Returns 0 for numbers with a finite square, and NaN otherwise.
#[inline(always)]
pub(super) fn zero_or_nan(y: f64) -> f64 {
    y * y * 0.0
}
