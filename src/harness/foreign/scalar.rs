//! One scalar of foreign draws on its way through the gate.
//!
//! ```text
//! E      the mean of the e-values of all grounds that hold (`grounds`);   fail at ln E ≥ ln(K/0.8α)
//! P±     likewise, of all grounds;                                        pass at both ln P ≥ ln(1/β)
//! E_c    the same for a change of the mean from any later block on        (`stats::capital`)
//! ```
//!
//! Looks come at block ends, growing by 1.15, and where the draws end. A pass is not the end: a
//! scalar that has passed may still fail on what comes later.

use super::grounds::{self, EFFECTIVE, OfRange, OfVariance, RELIABLE, Spread};
use super::judgement::ScalarFinding;
use crate::harness::plan::BLOCK;
use crate::harness::record::{GateFinding, Verdict};
use crate::numeric::sum::Sum;
use crate::stats::Powers;
use crate::stats::betting::Aim;
use crate::stats::gate::{self, Decision, Design, Evidence, ln_mean_exp};

/// How many draws a question without a promise takes where no number of draws is planned.
const UNPLANNED: f64 = 67_108_864.0;

/// What is asked of a scalar.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ask {
    /// `mean`, `variance` or `lookups`.
    pub check: &'static str,
    /// What it is called in a sentence.
    pub what: &'static str,
    /// What is known of V; `None` where only the range is to be relied on.
    pub spread: Option<Spread>,
    /// Whether it may fail by its spread, or only pass.
    pub is_hard: bool,
    /// Where y lies, if it is known.
    pub range: Option<[f64; 2]>,
    /// ε as the caller has it.
    pub tolerance: Option<f64>,
    /// ε where neither the caller nor a number of draws says.
    pub usual: f64,
    /// The widest ε that is chosen without being asked for.
    pub cap: f64,
    /// δ.
    pub floor: f64,
    /// Whether it was promised a pass even where the draws are too few.
    pub must_pass: bool,
}

/// The levels of the gate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Levels {
    /// ln(K/0.8α).
    pub ln_fail: f64,
    /// ln(1/β).
    pub ln_pass: f64,
}

/// A change of the mean.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change {
    /// ln `E_c`.
    pub ln_e: f64,
    /// The draw from which on the mean differs, and by how much.
    pub from: u64,
    pub off: f64,
}

/// A scalar on its way.
pub(super) struct Scalar {
    pub ask: Ask,
    levels: Levels,
    /// n: how many draws are planned, if anybody knows.
    planned: Option<f64>,
    past: Powers,
    of_variance: Option<OfVariance>,
    of_range: Option<OfRange>,
    /// What is asked, as soon as V is known or bounded; its ε never becomes wider.
    design: Option<Design>,
    /// Whether n draws suffice for a pass.
    is_promised: bool,
    /// The sum of y in each block, and how many draws a whole block has.
    sums: Vec<f64>,
    block: u64,
    look: u64,
    /// The decision, and the evidence it was made on.
    decision: Decision,
    evidence: Evidence,
    /// Whether what may not fail would have.
    is_doubted: bool,
    change: Change,
    /// Mean of y and number of draws at the last look before the decision.
    seen: (f64, u64),
}

impl Scalar {
    pub(super) fn new(ask: Ask, planned: Option<f64>, levels: Levels) -> Self {
        let mut scalar = Self {
            levels,
            planned,
            past: Powers::default(),
            of_variance: ask.spread.map(|spread| OfVariance::new(spread, ask.is_hard)),
            of_range: ask.range.map(OfRange::new),
            design: None,
            is_promised: ask.must_pass,
            sums: Vec::new(),
            block: 0,
            look: 1,
            decision: Decision::Open,
            evidence: Evidence::NONE,
            is_doubted: false,
            change: Change { ln_e: 0.0, from: 0, off: 0.0 },
            seen: (0.0, 0),
            ask,
        };
        if let Some(Spread::Known(variance)) = ask.spread {
            scalar.start(variance);
        }
        scalar
    }

    /// Fixes ε.
    fn start(&mut self, variance: f64) {
        let skipped = self.past.draws() as f64;
        let left = self.planned.map(|all| (all - skipped).max(1.0));
        let chosen = left.map_or(self.ask.usual, |n| gate::tolerance_of(variance, n));
        let tolerance = self.ask.tolerance.unwrap_or(chosen.min(self.ask.cap));
        let design = Design::new(variance, tolerance, self.ask.floor);
        let suffices = |n| gate::draws_of(variance, design.tolerance) <= n * (1.0 + 1e-6);
        let can_promise = self.ask.is_hard && left.is_none_or(suffices);
        self.is_promised |= self.ask.tolerance.is_some() || can_promise;
        self.design = Some(design);
    }

    /// Fixes ε where only a range is known: by the variance of the first draws, at most that of the range.
    fn start_by_range(&mut self) {
        let Some(ground) = self.of_range.as_ref().filter(|_| self.design.is_none()) else { return };
        let is_reliable = self.past.effective_draws() >= RELIABLE;
        let shown = if is_reliable { self.past.upper_square() } else { f64::INFINITY };
        let variance = shown.min(ground.widest());
        // A range that leaves next to nothing narrows no tolerance.
        let asked = self.ask.tolerance.unwrap_or(self.ask.cap);
        let variance = if variance > 0.0 { variance } else { 16.0 * asked * asked };
        if self.past.draws() > 0 && variance.is_finite() {
            self.start(variance);
        }
    }

    /// Adds a block of y.
    pub(super) fn absorb(&mut self, y: &[f64]) {
        let block = self.sums.len() as u64;
        if self.decision != Decision::Failed {
            let bound =
                self.of_variance.as_mut().and_then(|g| g.variance(&self.past, self.levels.ln_fail));
            if let Some(variance) = bound
                && self.design.is_none()
            {
                self.start(variance);
            }
            self.start_by_range();
            if let (Some(ground), Some(variance), Some(first)) =
                (&mut self.of_variance, bound, self.design)
            {
                ground.absorb(y, Design::new(variance, first.tolerance, first.floor), block);
            }
            if let Some(ground) = &mut self.of_range {
                let variance = bound.or(ground.variance(&self.past));
                let aim = self.design.zip(variance);
                let aim =
                    aim.map(|(Design { tolerance, .. }, variance)| Aim { tolerance, variance });
                ground.absorb(y, aim, self.ask.floor);
            }
        }
        self.sums.push(y.iter().sum());
        self.block = self.block.max(y.len() as u64);
        self.past.absorb(y);
        if block + 1 == self.look {
            self.decide();
            self.look = (self.look + 1).max(self.look * 115 / 100);
        }
    }

    /// A look; the last one comes when the draws end.
    pub(super) fn decide(&mut self) {
        if self.decision == Decision::Failed || self.past.draws() == 0 {
            return;
        }
        let (mut ln_e, mut ln_change, mut change) = (Vec::new(), Vec::new(), (0.0, 0));
        let mut ln_pass: [Vec<f64>; 2] = Default::default();
        let mut soft = f64::NEG_INFINITY;
        // A bound on V takes its share of all evidence that it joins.
        let mut ln_share: f64 = 0.0;
        let tolerance = self.design.map_or(0.0, |design| design.tolerance);
        let of_variance = self.of_variance.as_ref();
        let of_variance =
            of_variance.map(|g| (&g.capital, g.capital.ln_pass(), g.begin, g.is_hard));
        let of_range = self.of_range.as_ref();
        let of_range = of_range.map(|g| (&g.capital, g.ln_pass(tolerance), 0, true));
        for (capital, sides, begin, is_hard) in of_variance.into_iter().chain(of_range) {
            for (all, side) in ln_pass.iter_mut().zip(sides) {
                all.push(side);
            }
            if !is_hard {
                soft = capital.ln_e();
                continue;
            }
            ln_e.push(capital.ln_e());
            ln_change.push(capital.ln_change());
            if capital.ln_change() > change.0 {
                change = (capital.ln_change(), begin + capital.change());
            }
        }
        if let Some(ground) = self.of_variance.as_ref() {
            ln_share = ground.ln_share();
        }
        soft += ln_share;
        let ln_share = if self.ask.is_hard { ln_share } else { 0.0 };
        let mean = |values: &[f64]| if values.is_empty() { 0.0 } else { ln_mean_exp(values) };
        let evidence = Evidence {
            ln_e: mean(&ln_e) + ln_share,
            ln_pass: ln_pass.map(|side| ln_mean_exp(&side)),
        };
        let Levels { ln_fail, ln_pass } = self.levels;
        self.is_doubted |= soft >= ln_fail;
        let ln_change = mean(&ln_change) + ln_share;
        if ln_change > self.change.ln_e {
            let first = usize::try_from(change.1).unwrap_or(usize::MAX).min(self.sums.len());
            let later: Sum = self.sums[first..].iter().copied().collect();
            let draws = self.past.draws().saturating_sub(change.1 * self.block).max(1);
            let off = later.value() / draws as f64;
            self.change = Change { ln_e: ln_change, from: change.1 * self.block, off };
        }
        let decision = evidence.decision(ln_fail, ln_pass);
        if self.decision == Decision::Open || decision == Decision::Failed {
            (self.decision, self.evidence) = (decision, evidence);
            self.seen = (self.past.mean(), self.past.draws());
        }
    }

    /// Whether more draws may change what is said, were it decided once and for all.
    pub(super) fn is_open(&self) -> bool {
        let most = self.planned.unwrap_or(UNPLANNED);
        let limit = match &self.design {
            Some(design) if self.is_promised => {
                gate::draws_of(design.variance, design.tolerance) * gate::HORIZON / gate::PLANNED
            }
            _ => most,
        };
        self.decision == Decision::Open && (self.past.draws() as f64) < limit
    }

    pub(super) fn has_failed(&self) -> bool {
        self.decision == Decision::Failed
    }

    /// The strongest sign of a change of the mean.
    pub(super) fn change(&self) -> Change {
        self.change
    }

    /// ln E at the last look.
    pub(super) fn ln_e(&self) -> f64 {
        self.evidence.ln_e
    }

    /// Whether the draws do not contradict what was assumed of them.
    pub(super) fn is_founded(&self) -> bool {
        let ground = self.of_variance.as_ref();
        !ground.is_some_and(|ground| ground.is_contradicted(&self.past)) || self.of_range.is_some()
    }

    /// Whether the mean differs by itself: were the spread what the draws show, it would fail, too.
    pub(super) fn is_off_by_itself(&self) -> bool {
        let (off, n) = self.seen;
        let by_range = self.of_range.as_ref().map_or(0.0, |ground| ground.capital.ln_e());
        let squares = self.past.mean_square() - off * off;
        0.5 * off * off * n as f64 >= self.levels.ln_fail * squares
            || by_range >= self.levels.ln_fail
    }

    /// The kurtosis that a judgement assumes without a promise of the caller's.
    pub(super) fn assumed(&self) -> Option<f64> {
        if self.ask.spread != Some(Spread::Shown) {
            return None;
        }
        self.of_variance.as_ref().and_then(|ground| ground.kurtosis)
    }

    /// What was found.
    pub(super) fn finding(&self) -> ScalarFinding {
        let (verdict, reason) = self.verdict();
        // Bold bets may decide before ε is chosen.
        let decided = (self.decision != Decision::Open)
            .then(|| Design::new(self.past.mean_square(), self.ask.cap, self.ask.floor));
        let gate = self.design.or(decided).map(|design| GateFinding {
            tolerance: design.tolerance,
            variance: design.variance,
            mean: self.seen.0,
            planned: gate::draws_of(design.variance, design.tolerance),
            draws: self.seen.1,
            ln_e: self.evidence.ln_e,
            ln_e_limit: self.levels.ln_fail,
            ln_p: self.evidence.ln_pass,
            ln_p_limit: self.levels.ln_pass,
            needed: None,
            is_decided: self.decision != Decision::Open,
        });
        ScalarFinding {
            check: self.ask.check.to_owned(),
            verdict,
            reason,
            is_estimated: self.ask.spread == Some(Spread::Shown),
            assumed_kurtosis: self.assumed(),
            is_promised: self.is_promised,
            gate,
        }
    }

    /// What would be a ground.
    fn cure(&self) -> &'static str {
        if self.ask.check == "variance" {
            "--kurtosis or --range LOW,HIGH"
        } else {
            "--variance, --range LOW,HIGH or --kurtosis"
        }
    }

    /// What is missing where the draws do not show their own spread.
    fn unknown(&self) -> String {
        let (n, what) = (self.past.draws(), self.ask.what);
        let cure = self.cure();
        let carry = self.past.effective_draws().floor().max(0.0);
        match self.ask.spread {
            Some(Spread::Kurtosis(kurtosis)) => format!(
                "the spread of the {what} is not known: with a kurtosis of {kurtosis} it needs a first \
                 block of draws, {:.0} of them or more, and others after it; there are {n}",
                grounds::draws_of_bound(kurtosis, self.levels.ln_fail)
            ),
            Some(Spread::Shown) if carry >= EFFECTIVE && self.assumed().is_some() => format!(
                "the spread of the {what} is not known: the draws show a kurtosis of {:.0}, more than the \
                 {:.0} that was assumed; give {cure}",
                self.past.kurtosis(),
                self.assumed().unwrap_or_default()
            ),
            None => {
                format!("the {what} is undecided after {n} draws, too few to choose a tolerance by")
            }
            _ => format!(
                "the spread of the {what} is not known: {carry} of {n} draws carry it, and {EFFECTIVE} \
                 of more than {BLOCK} are needed; give {cure}"
            ),
        }
    }

    fn verdict(&self) -> (Verdict, String) {
        let what = self.ask.what;
        let weak = if self.is_promised { Verdict::Inconclusive } else { Verdict::Underpowered };
        let ground = self.of_variance.as_ref();
        let relies_on_shown = ground.is_some_and(|ground| ground.is_contradicted(&self.past));
        let is_founded = self.is_founded();
        let (off, n) = self.seen;
        if self.decision == Decision::Failed && is_founded {
            // Where V is only bounded, the draws' own spread says more.
            let known = match self.ask.spread {
                Some(Spread::Known(variance)) => variance,
                _ => self.past.variance(),
            };
            let z = off / (known / n as f64).sqrt();
            let (found, limit) = (self.evidence.ln_e, self.levels.ln_fail);
            let z = if z.is_finite() && self.past.kurtosis().is_finite() {
                format!(", {z:+.1} standard errors")
            } else {
                String::new()
            };
            let reason = format!(
                "the {what} is off by {off:+.2e}{z} (ln E = {found:.1} ≥ {limit:.1} after {n} draws)"
            );
            return (Verdict::Fail, reason);
        }
        let Some(design) = self.design.filter(|_| is_founded) else {
            let weak = if self.ask.must_pass { Verdict::Inconclusive } else { weak };
            return (weak, self.unknown());
        };
        match self.decision {
            _ if self.is_doubted && !relies_on_shown => {
                let reason = format!(
                    "the {what} looks off by {:+.2e}, but no number of draws can show that without {}",
                    self.past.mean(),
                    self.cure()
                );
                (Verdict::Inconclusive, reason)
            }
            Decision::Passed if relies_on_shown && !self.ask.is_hard => (weak, self.unknown()),
            Decision::Passed => (Verdict::Pass, String::new()),
            Decision::Open | Decision::Failed => {
                let planned = gate::draws_of(design.variance, design.tolerance);
                let longest = planned * gate::HORIZON / gate::PLANNED;
                let needed = if planned > n as f64 { planned } else { longest };
                let reason = format!(
                    "the {what} is undecided after {n} draws; a tolerance of {:.2e} needs {needed:.1e}",
                    design.tolerance
                );
                (weak, reason)
            }
        }
    }
}
