//! Draws on their way through all questions, block by block.

use super::asks::{asks, planned};
use super::judge::{BUFFER, Trial};
use super::judgement::{Judgement, Stop};
use super::scalar::{Levels, Scalar};
use super::{dependence, verdict};
use crate::harness::plan::MISS;
use crate::harness::record::Verdict;
use crate::numeric::sum::Sum;
use crate::stats::independence::Independence;
use crate::stats::replays::Replays;
use crate::stats::{Powers, ties};

/// The share of α that the drift has, a question of its own.
pub(super) const DRIFT: f64 = 0.2;
/// The fewest draws that are judged at a time.
const FEW: usize = 64;
/// So many different values among the first draws are no small set.
const VARIED: usize = 100;

/// What a draw is that refutes the claim by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Fault {
    /// Not a finite number, or so far from the truth that its square is none.
    Number,
    /// Out of the promised range.
    Range,
    /// Not the truth, where draws have no spread.
    Spread,
    /// Not one standard deviation from the truth, where the kurtosis is 1.
    TwoPoint,
    /// Another number of lookups than the one that all draws take.
    Lookups,
}

/// The first draw that refutes the claim by itself.
#[derive(Debug, Clone, Copy)]
pub(super) struct Refuted {
    pub fault: Fault,
    pub index: u64,
    pub value: f64,
}

/// Averages of so many consecutive numbers.
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

/// Draws on their way.
pub(super) struct Reading<'t> {
    pub trial: &'t Trial,
    powers: Powers,
    pub mean: Option<Scalar>,
    pub variance: Option<Scalar>,
    pub lookups: Option<Scalar>,
    pub refuted: Option<Refuted>,
    refuting: u64,
    read: u64,
    /// How many draws or averages were judged.
    judged: u64,
    averages: [Averages; 2],
    /// How many draws or averages are judged at a time.
    block: usize,
    pub independence: Independence,
    pub replays: Replays,
    lookup_sum: Sum,
    is_single: bool,
    is_varied: bool,
    resolution: Option<f64>,
    y: Vec<f64>,
    other: Vec<f64>,
}

impl<'t> Reading<'t> {
    pub(super) fn new(trial: &'t Trial) -> Self {
        let asks = asks(trial);
        let count = asks.len().max(1) as f64;
        let share = if trial.is_certain() { 1.0 } else { 1.0 - DRIFT };
        let ln_fail = (count / (share * trial.wanted.alpha)).ln();
        let levels = Levels { ln_fail, ln_pass: -MISS.ln() };
        let length = trial.length.map(|length| length / trial.wanted.batch);
        // Few draws make small blocks, so that later ones can be judged by earlier ones.
        let block = length.map_or(BUFFER, |n| usize::try_from(n / 16).unwrap_or(BUFFER));
        let block = block.next_power_of_two().clamp(FEW, BUFFER);
        // A known variance is judged in the blocks of a run.
        let is_known = trial.claim.variance.is_some() && trial.wanted.batch == 1;
        let block = if is_known { BUFFER } else { block };
        let planned = planned(&asks, &trial.wanted, length);
        let scalar = |check: &str| {
            let ask = asks.iter().find(|ask| ask.check == check);
            ask.map(|&ask| Scalar::new(ask, planned, levels))
        };
        Self {
            trial,
            powers: Powers::default(),
            mean: scalar("mean"),
            variance: scalar("variance"),
            lookups: scalar("lookups"),
            refuted: None,
            refuting: 0,
            read: 0,
            judged: 0,
            averages: [Averages::new(trial.wanted.batch), Averages::new(trial.wanted.batch)],
            block,
            independence: Independence::default(),
            replays: Replays::default(),
            lookup_sum: Sum::default(),
            is_single: true,
            is_varied: false,
            resolution: None,
            y: Vec::with_capacity(BUFFER),
            other: Vec::with_capacity(BUFFER),
        }
    }

    pub(super) fn draws(&self) -> u64 {
        self.read
    }

    fn scalars(&mut self) -> impl Iterator<Item = &mut Scalar> {
        self.mean.iter_mut().chain(&mut self.variance).chain(&mut self.lookups)
    }

    /// What is wrong with a draw by itself.
    fn fault(&self, x: f64) -> Option<Fault> {
        let claim = &self.trial.claim;
        let y = (x - claim.truth) / claim.unit;
        if zero_or_nan(y) != 0.0 {
            return Some(Fault::Number);
        }
        if let Some([low, high]) = claim.range {
            let slack = |end: f64| claim.rounding * if end.is_finite() { end.abs() } else { 0.0 };
            let slack = slack(low).max(slack(high)).max(claim.floor() * claim.unit);
            if !(low - slack <= x && x <= high + slack) {
                return Some(Fault::Range);
            }
        }
        None
    }

    /// What is wrong with a y that has no spread, or one value of it.
    fn fault_of_spread(&self, y: f64) -> Option<Fault> {
        let claim = &self.trial.claim;
        if self.mean.is_none() && y.abs() > self.trial.bound() {
            return Some(Fault::Spread);
        }
        let variance = claim.variance.filter(|_| self.trial.is_two_point())?;
        let square = y * y * claim.unit * claim.unit / variance - 1.0;
        (square.abs() > self.trial.two_point_bound(variance)).then_some(Fault::TwoPoint)
    }

    /// Adds draws with their lookups, if there are any.
    pub(super) fn absorb(&mut self, block: &[f64], lookups: &[f64]) {
        self.look_at_each(block, lookups);
        self.read += block.len() as u64;
        self.lookup_sum.add(lookups.iter().sum());
        self.replays.absorb(block);
        if self.trial.wanted.batch == 1 {
            for (at, part) in block.chunks(self.block).enumerate() {
                let first = (at * self.block).min(lookups.len());
                let last = (first + part.len()).min(lookups.len());
                self.judge(part, &lookups[first..last]);
            }
            return;
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

    /// Looks for draws that refute the claim by themselves.
    fn look_at_each(&mut self, block: &[f64], lookups: &[f64]) {
        if self.read == 0 {
            let mut values = block.to_vec();
            let ties = ties::ties(&mut values);
            self.is_varied = block.len() - ties > VARIED;
            self.resolution = ties::resolution(&mut values);
        }
        self.is_single &= ties::all_single_precision(block);
        let first = self.read;
        self.note(first, block, Self::fault);
        if let Some(claimed) = self.trial.claim.lookups {
            // A law's own number may be rounded; a draw that differs by one is far beyond that.
            let is_other = |m: f64| claimed.is_fixed() && (m - claimed.mean).abs() > 0.5;
            let fault = |m: f64| (!m.is_finite() || is_other(m)).then_some(Fault::Lookups);
            self.note(first, lookups, |_, m| fault(m));
        }
    }

    /// Notes what is wrong with numbers of which the first is draw number `first`.
    fn note(&mut self, first: u64, values: &[f64], fault: impl Fn(&Self, f64) -> Option<Fault>) {
        for (index, &value) in (first..).zip(values) {
            let Some(fault) = fault(self, value) else { continue };
            self.refuting += 1;
            if self.refuted.is_none_or(|earlier| index < earlier.index) {
                self.refuted = Some(Refuted { fault, index, value });
            }
        }
    }

    /// Puts all questions to a block.
    fn judge(&mut self, block: &[f64], lookups: &[f64]) {
        let claim = &self.trial.claim;
        let (truth, scale) = (claim.truth, 1.0 / claim.unit);
        self.y.clear();
        self.y.extend(block.iter().map(|x| (x - truth) * scale));
        if self.y.iter().map(|&y| zero_or_nan(y)).sum::<f64>() != 0.0 {
            return;
        }
        if self.mean.is_none() || self.trial.is_two_point() {
            let batch = self.trial.wanted.batch;
            for (at, (&y, &value)) in (self.judged..).zip(self.y.iter().zip(block)) {
                let Some(fault) = self.fault_of_spread(y) else { continue };
                self.refuting += 1;
                let index = at * batch;
                self.refuted = self.refuted.or(Some(Refuted { fault, index, value }));
            }
        }
        self.judged += block.len() as u64;
        self.independence.absorb(&self.y);
        self.powers.absorb(&self.y);
        if let Some(mean) = &mut self.mean {
            mean.absorb(&self.y);
        }
        if let (Some(scalar), Some(variance)) = (&mut self.variance, claim.variance) {
            let scale = claim.unit * claim.unit / variance;
            self.other.clear();
            self.other.extend(self.y.iter().map(|y| y * y * scale - 1.0));
            scalar.absorb(&self.other);
        }
        if let (Some(scalar), Some(claimed)) = (&mut self.lookups, claim.lookups) {
            let scale = 1.0 / claimed.mean;
            self.other.clear();
            self.other.extend(lookups.iter().map(|m| m * scale - 1.0));
            if self.other.iter().all(|y| y.is_finite()) {
                scalar.absorb(&self.other);
            }
        }
    }

    /// Whether more draws may change what is said, were all decisions final.
    pub(super) fn is_open(&mut self) -> bool {
        if self.refuted.is_some() {
            return false;
        }
        if self.mean.is_none() {
            return true;
        }
        !self.scalars().any(|scalar| scalar.has_failed())
            && self.scalars().any(|scalar| scalar.is_open())
    }

    /// What is said in the end.
    pub(super) fn close(mut self, stopped: Option<Stop>) -> Judgement {
        let rest = self.averages[0].ready.len();
        if rest > 0 {
            self.judge_averages(rest);
        }
        self.scalars().for_each(Scalar::decide);
        let Trial { claim, wanted, length } = self.trial;
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
            guarantees: Vec::new(),
            alpha: wanted.alpha,
            beta: MISS,
            draws: self.read,
            length: *length,
            stopped,
            batch: wanted.batch,
            unfilled: self.averages[0].count,
            truth: claim.truth,
            unit,
            mean: off.map(|off| claim.truth + off),
            standard_error: error,
            z: off.zip(error).map(|(off, error)| off / error),
            variance,
            predicted_variance: claim.variance,
            variance_ratio: variance.zip(known).map(|(found, claimed)| found / claimed),
            variance_band: tails.map(|kurtosis| ((kurtosis - 1.0).max(0.0) / n).sqrt()),
            kurtosis,
            lookups: claim.lookups.and_then(|_| finite(self.lookup_sum.value() / self.read as f64)),
            predicted_lookups: claim.lookups.map(|claimed| claimed.mean),
            refuted_by: self.refuted.as_ref().map(|refuted| refuted.index),
            refuting: self.refuting,
            single_precision: self.is_single && self.is_varied,
            resolution: self.resolution,
            findings: findings.map(Scalar::finding).collect(),
            drift: dependence::drift(&self),
            independence: dependence::independence(&self),
        };
        verdict::decide(&self, &mut judgement);
        judgement
    }
}

/// 0 for numbers whose square is finite, and not a number otherwise.
#[inline(always)]
pub(super) fn zero_or_nan(y: f64) -> f64 {
    y * y * 0.0
}
