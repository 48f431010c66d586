//! One scalar of foreign draws on its way through the gate.
//!
//! ```text
//! known      V_b = V
//! estimated  V_b = ȳ² + 3 standard errors of it, over the draws before block b
//!            judged from the first block on before which that error is 10 % or less
//! ```
//!
//! Each block is judged with a `V_b` that was fixed before its first draw, so that the gains of the
//! blocks add up to evidence as if V were known, *if* every `V_b` is at least the true variance. No
//! draws can show that it is: events that are so rare that none was drawn yet, and that carry the
//! variance, make `V_b` too small, a false alarm likely and a pass worthless. What is estimated has
//! its error rates only asymptotically, and the verdict says so.

use super::judgement::ScalarFinding;
use crate::harness::plan::BLOCK;
use crate::harness::record::{GateFinding, Verdict};
use crate::numeric::sum::Sum;
use crate::stats::Powers;
use crate::stats::gate::{self, Decision, Design, Evidence, Gains, GateSums};

/// The largest relative standard error of an estimated variance with which draws are judged.
const RELIABLE: f64 = 0.1;

/// How many draws a question without a promise takes where no number of draws is planned.
const UNPLANNED: f64 = 67_108_864.0;

/// What is asked of a scalar.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ask {
    /// `mean` or `variance`.
    pub check: &'static str,
    /// V, where it is known.
    pub variance: Option<f64>,
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
    /// ln(K/α).
    pub ln_fail: f64,
    /// ln(1/β).
    pub ln_pass: f64,
}

/// A scalar on its way.
pub(super) struct Scalar {
    ask: Ask,
    levels: Levels,
    /// n: how many draws are planned, if anybody knows.
    planned: Option<f64>,
    /// What came so far, where V is estimated.
    past: Option<Powers>,
    /// What is asked, as soon as V is known.
    design: Option<Design>,
    /// Whether n draws suffice for a pass.
    is_promised: bool,
    gains: Gains,
    sum: Sum,
    judged: u64,
    blocks: u64,
    look: u64,
    evidence: Evidence,
    decision: Decision,
    /// Mean of y and number of judged draws at the last look.
    seen: (f64, u64),
}

impl Scalar {
    pub(super) fn new(ask: Ask, planned: Option<f64>, levels: Levels) -> Self {
        let mut scalar = Self {
            ask,
            levels,
            planned,
            past: ask.variance.is_none().then(Powers::default),
            design: None,
            is_promised: ask.must_pass,
            gains: Gains::default(),
            sum: Sum::default(),
            judged: 0,
            blocks: 0,
            look: 1,
            evidence: Evidence::NONE,
            decision: Decision::Open,
            seen: (0.0, 0),
        };
        if let Some(variance) = ask.variance {
            scalar.start(variance);
        }
        scalar
    }

    /// Fixes ε.
    fn start(&mut self, variance: f64) {
        let skipped = self.past.map_or(0, |past| past.draws()) as f64;
        let left = self.planned.map(|all| (all - skipped).max(1.0));
        let chosen = left.map_or(self.ask.usual, |n| gate::tolerance_of(variance, n));
        let tolerance = self.ask.tolerance.unwrap_or(chosen.min(self.ask.cap));
        let design = Design::new(variance, tolerance, self.ask.floor);
        let suffices = |n| gate::draws_of(variance, design.tolerance) <= n * (1.0 + 1e-6);
        self.is_promised |= self.ask.tolerance.is_some() || left.is_none_or(suffices);
        self.design = Some(design);
    }

    /// Whether the next block can be judged; fixes V for it where that is estimated.
    fn prepare(&mut self) -> Option<Design> {
        if let Some(past) = &self.past {
            let error = past.square_error();
            let variance = past.upper_square();
            if self.design.is_none() {
                if past.draws() < BLOCK || !(error <= RELIABLE && variance.is_finite()) {
                    return None;
                }
                self.start(variance);
            }
            let first = self.design?;
            // ε may become narrower than promised, never wider.
            return Some(Design::new(variance, first.tolerance, first.floor));
        }
        self.design
    }

    /// Adds a block of y.
    pub(super) fn absorb(&mut self, y: &[f64]) {
        if self.decision != Decision::Open {
            return;
        }
        if let Some(design) = self.prepare() {
            let mut sums = GateSums::default();
            sums.absorb(y, &design.arguments());
            self.gains.add(&design.gains(sums.totals(), y.len() as f64));
            self.sum.add(y.iter().sum());
            self.judged += y.len() as u64;
            self.blocks += 1;
            if self.blocks == self.look {
                self.decide();
            }
        }
        if let Some(past) = &mut self.past {
            past.absorb(y);
        }
    }

    /// A look; the last one comes when the draws end.
    pub(super) fn decide(&mut self) {
        if self.decision == Decision::Open && self.judged > self.seen.1 {
            self.evidence = self.gains.evidence();
            self.decision = self.evidence.decision(self.levels.ln_fail, self.levels.ln_pass);
            self.seen = (self.sum.value() / self.judged as f64, self.judged);
            self.look = (self.look + 1).max(self.look * 115 / 100);
        }
    }

    /// Whether more draws may change what is said.
    pub(super) fn is_open(&self) -> bool {
        let most = self.planned.unwrap_or(UNPLANNED);
        let (taken, limit) = match (&self.design, &self.past) {
            (Some(design), _) if self.is_promised => {
                let planned = gate::draws_of(design.variance, design.tolerance);
                (self.judged, planned * gate::HORIZON / gate::PLANNED)
            }
            (None, Some(past)) => (past.draws(), most),
            _ => (self.judged, most),
        };
        self.decision == Decision::Open && (taken as f64) < limit
    }

    pub(super) fn has_failed(&self) -> bool {
        self.decision == Decision::Failed
    }

    /// What was found.
    pub(super) fn finding(&self, read: u64) -> ScalarFinding {
        let (verdict, reason) = self.verdict(read);
        let gate = self.design.map(|design| GateFinding {
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
        let is_estimated = self.ask.variance.is_none();
        let check = self.ask.check.to_owned();
        ScalarFinding { check, verdict, reason, is_estimated, is_promised: self.is_promised, gate }
    }

    fn verdict(&self, read: u64) -> (Verdict, String) {
        let what = self.ask.check;
        let Some(design) = self.design else {
            let verdict =
                if self.ask.must_pass { Verdict::Inconclusive } else { Verdict::Underpowered };
            let reason = format!(
                "the spread of the {what} cannot be estimated from {read} draws: it needs more than \
                 {BLOCK}, and a relative standard error of the spread below {RELIABLE}"
            );
            return (verdict, reason);
        };
        let (off, n) = self.seen;
        match self.decision {
            Decision::Passed => (Verdict::Pass, String::new()),
            Decision::Failed => {
                let z = off / (design.variance / n as f64).sqrt();
                let (found, limit) = (self.evidence.ln_e, self.levels.ln_fail);
                let reason = format!(
                    "the {what} is off by {off:+.2e}, {z:+.1} standard errors \
                     (ln E = {found:.1} ≥ {limit:.1} after {n} draws)"
                );
                (Verdict::Fail, reason)
            }
            Decision::Open => {
                let planned = gate::draws_of(design.variance, design.tolerance);
                let longest = planned * gate::HORIZON / gate::PLANNED;
                let needed = if planned > read as f64 { planned } else { longest };
                let verdict =
                    if self.is_promised { Verdict::Inconclusive } else { Verdict::Underpowered };
                let reason = format!(
                    "the {what} is undecided after {n} draws; a tolerance of {:.2e} needs {needed:.1e}",
                    design.tolerance
                );
                (verdict, reason)
            }
        }
    }
}
