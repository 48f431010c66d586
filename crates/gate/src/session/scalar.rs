//! State of one quantity in the gate; its variance or its tolerance may follow from earlier draws.
//!
//! ```text
//! E      the mean of the e-values of all grounds that hold (`ground`);   fail at ln E ≥ ln(K/0.8α)
//! P±     likewise, of all grounds;                                        pass at both ln P ≥ ln(1/β)
//! E_c    the same for a change of the mean from any later block on        (`stats::capital`)
//! ```
//!
//! Looks come at block ends, growing by 1.15, and where the draws end. A pass is not final: a scalar that has
//! passed may still fail on later draws.

use super::ground::{FAIRLY_RELIABLE, OfRange, OfVariance, RELIABLE};
use super::quantity::{Quantity, VarianceBound};
use crate::stats::Powers;
use crate::stats::betting::Aim;
use crate::stats::capital::ln_mean_exp;
use crate::stats::gate::{self, Decision, Design, Evidence};
use crate::stats::verdict::{GateFinding, MISS};

/// Number of draws that a check without a planned number of draws takes, if its success is not promised.
const UNPLANNED: f64 = 67_108_864.0;
/// Stand-in for an unknown planned number of draws in the choice of ε, which is fixed after half of it at the
/// latest.
const UNPLANNED_PILOT: f64 = 131_072.0;

/// Share of α of a check beside the main quantities. With its number of draws known, a session checks the drift and
/// the distribution; images have the whole image and the variance beside the tiles; a run has distributions.
pub const SIDE_SHARE: f64 = 0.2;

/// Share of α that the main quantities have beside `others` other checks.
pub fn main_share(others: u32) -> f64 {
    1.0 - SIDE_SHARE * f64::from(others)
}

/// The levels of the gate.
#[derive(Debug, Clone, Copy)]
pub struct Levels {
    /// ln(K/0.8α).
    pub ln_fail: f64,
    /// ln(1/β).
    pub ln_pass: f64,
}

impl Levels {
    /// Levels of one of `count` quantities that share `alpha`.
    pub fn new(alpha: f64, count: usize) -> Self {
        Self { ln_fail: gate::ln_fail(alpha, count), ln_pass: -MISS.ln() }
    }

    /// The numbers of the gate at its last look, after `draws` draws of mean y `mean`.
    pub(super) fn finding(
        self,
        design: &Design,
        evidence: Evidence,
        (mean, draws): (f64, u64),
        decision: Decision,
    ) -> GateFinding {
        GateFinding {
            tolerance: design.tolerance,
            variance: design.variance,
            mean,
            planned: design.draws(),
            draws,
            ln_e: evidence.ln_e,
            ln_e_limit: self.ln_fail,
            ln_p: evidence.ln_pass,
            ln_p_limit: self.ln_pass,
            needed: None,
            is_decided: decision != Decision::Open,
        }
    }
}

/// State of a scalar.
pub struct Scalar {
    pub(super) quantity: Quantity,
    pub(super) levels: Levels,
    /// n: the number of planned draws, if it is known.
    pub(super) planned: Option<f64>,
    pub(super) past: Powers,
    pub(super) of_variance: Option<OfVariance>,
    pub(super) of_range: Option<OfRange>,
    /// Parameters of the test, as soon as V is known or bounded; its ε never grows.
    pub design: Option<Design>,
    /// True if n draws suffice for a pass.
    pub(super) is_promised: bool,
    /// The sum of y in each block, and the number of draws at its end.
    pub(super) sums: Vec<(f64, u64)>,
    pub(super) look: u64,
    /// The decision.
    pub(super) decision: Decision,
    /// Evidence at the look of the decision, or at the last.
    pub evidence: Evidence,
    /// True if the evidence reached the failure level, but the variance was only estimated.
    pub(super) is_doubted: bool,
    /// ln `E_c`.
    pub(super) ln_change: f64,
    /// Mean of y and number of draws at the last look before the decision.
    pub(super) seen: (f64, u64),
}

impl Scalar {
    /// Creates the state of a quantity before its first draw.
    pub fn new(quantity: Quantity, planned: Option<f64>, levels: Levels) -> Self {
        let mut scalar = Self {
            levels,
            planned,
            past: Powers::default(),
            of_variance: quantity.ground.map(OfVariance::new),
            of_range: quantity.range.map(OfRange::new),
            design: None,
            is_promised: quantity.must_pass,
            sums: Vec::new(),
            look: 1,
            decision: Decision::Open,
            evidence: Evidence::NONE,
            is_doubted: false,
            ln_change: 0.0,
            seen: (0.0, 0),
            quantity,
        };
        if let Some(variance) = scalar.quantity.known_variance() {
            scalar.start(variance);
        }
        scalar
    }

    /// Fixes ε.
    fn start(&mut self, variance: f64) {
        let skipped = self.past.draws() as f64;
        let left = self.planned.map(|all| (all - skipped).max(1.0));
        let by_range = self.of_range.as_ref().filter(|_| self.quantity.ground.is_none());
        let finest = by_range.map_or(0.0, OfRange::finest);
        let chosen = |n: f64| gate::tolerance_of(variance, n).max(finest / n);
        let chosen = left.map_or(self.quantity.usual, chosen).min(self.quantity.cap);
        // The bets on a range need no narrow ε.
        let design = match self.quantity.tolerance {
            Some(requested) => Design::asked(variance, requested, self.quantity.floor),
            None if by_range.is_some() => Design::asked(variance, chosen, self.quantity.floor),
            None => Design::new(variance, chosen, self.quantity.floor),
        };
        let suffices = |n| design.draws() <= n * (1.0 + 1e-6);
        let can_promise = self.quantity.is_hard() && left.is_none_or(suffices);
        self.is_promised |= self.quantity.tolerance.is_some() || can_promise;
        self.design = Some(design);
    }

    /// Fixes ε where only a range is known: from the variance of the first draws, at most that of the range. This
    /// may take half of all draws, until the draws show their variance; a given ε is fixed at once.
    fn start_by_range(&mut self) {
        let Some(ground) = self.of_range.as_ref().filter(|_| self.design.is_none()) else { return };
        let (draws, carry) = (self.past.draws() as f64, self.past.effective_draws());
        let is_asked = self.quantity.tolerance.is_some();
        let is_due = draws >= 0.5 * self.planned.unwrap_or(UNPLANNED_PILOT);
        let is_reliable = carry >= RELIABLE || is_due && carry >= FAIRLY_RELIABLE;
        if !is_asked && !is_reliable && !is_due {
            return;
        }
        let shown = if is_reliable { self.past.upper_square() } else { f64::INFINITY };
        let variance = shown.min(ground.widest());
        // A very narrow range does not narrow the tolerance.
        let requested = self.quantity.tolerance.unwrap_or(self.quantity.cap);
        let variance = if variance > 0.0 { variance } else { 16.0 * requested * requested };
        if (draws > 0.0 || is_asked) && variance.is_finite() {
            self.start(variance);
        }
    }

    /// Adds a block of y.
    pub fn absorb(&mut self, y: &[f64]) {
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
                ground.absorb(y, first.with_variance(variance));
            }
            if let Some(ground) = &mut self.of_range {
                let variance = bound.or(ground.variance(&self.past));
                // Until ε is chosen, the largest one guides the bets against a correct mean.
                let is_provisional = self.design.is_none();
                let widest = self.quantity.tolerance.unwrap_or(self.quantity.cap);
                let tolerance = self.design.map_or(widest, |design| design.tolerance);
                let aim = variance.filter(|_| !is_provisional || self.past.draws() > 0);
                let aim = aim.map(|variance| Aim { tolerance, variance, is_provisional });
                ground.absorb(y, aim, self.quantity.floor);
            }
        }
        let sum = self.past.absorb(y);
        self.sums.push((sum, self.past.draws()));
        if block + 1 == self.look {
            self.decide();
            self.look = gate::next_look(self.look);
        }
    }

    /// Looks at the evidence; the last look comes when the draws end.
    pub fn decide(&mut self) {
        if self.decision == Decision::Failed || self.past.draws() == 0 {
            return;
        }
        let (mut ln_e, mut ln_change) = (Vec::new(), Vec::new());
        let mut ln_pass: [Vec<f64>; 2] = Default::default();
        let mut soft = f64::NEG_INFINITY;
        // A bound on V takes its share of all evidence that uses it.
        let mut ln_share: f64 = 0.0;
        let tolerance = self.design.map_or(0.0, |design| design.tolerance);
        let of_variance = self.of_variance.as_ref();
        let of_variance =
            of_variance.map(|g| (&g.capital, g.capital.ln_pass(), self.quantity.is_hard()));
        let of_range = self.of_range.as_ref();
        let of_range = of_range.map(|g| (&g.capital, g.ln_pass(tolerance), true));
        for (capital, sides, is_hard) in of_variance.into_iter().chain(of_range) {
            for (all, side) in ln_pass.iter_mut().zip(sides) {
                all.push(side);
            }
            if !is_hard {
                soft = capital.ln_e();
                continue;
            }
            ln_e.push(capital.ln_e());
            ln_change.push(capital.ln_change());
        }
        if let Some(ground) = self.of_variance.as_ref() {
            ln_share = ground.ln_share();
        }
        soft += ln_share;
        let ln_share = if self.quantity.is_hard() { ln_share } else { 0.0 };
        let mean = |values: &[f64]| if values.is_empty() { 0.0 } else { ln_mean_exp(values) };
        let evidence = Evidence {
            ln_e: mean(&ln_e) + ln_share,
            ln_pass: ln_pass.map(|side| ln_mean_exp(&side)),
        };
        let Levels { ln_fail, ln_pass } = self.levels;
        self.is_doubted |= soft >= ln_fail;
        self.ln_change = self.ln_change.max(mean(&ln_change) + ln_share);
        let decision = evidence.decision(ln_fail, ln_pass);
        if self.decision == Decision::Open || decision == Decision::Failed {
            (self.decision, self.evidence) = (decision, evidence);
            self.seen = (self.past.mean(), self.past.draws());
        }
    }

    /// Returns whether more draws may change the decision, which is then final.
    pub(super) fn is_open(&self) -> bool {
        let maximum = self.planned.unwrap_or(UNPLANNED);
        let limit = match &self.design {
            Some(design) if self.is_promised => design.draws() * gate::HORIZON / gate::PLANNED,
            _ => maximum,
        };
        self.decision == Decision::Open && (self.past.draws() as f64) < limit
    }

    pub(super) fn has_failed(&self) -> bool {
        self.decision == Decision::Failed
    }

    /// Returns whether it can fail at all.
    pub(super) fn has_ground(&self) -> bool {
        self.of_range.is_some() || self.quantity.is_hard()
    }

    /// Returns whether the draws do not contradict the assumptions about them.
    pub(super) fn is_founded(&self) -> bool {
        let ground = self.of_variance.as_ref();
        !ground.is_some_and(|ground| ground.is_contradicted(&self.past)) || self.of_range.is_some()
    }

    /// Returns whether the mean would also fail with the variance that the draws show.
    pub(super) fn is_off_by_itself(&self) -> bool {
        let (off, n) = self.seen;
        let by_range = self.of_range.as_ref().map_or(0.0, |ground| ground.capital.ln_e());
        let (spread, ln_fail) = (self.past.mean_square() - off * off, self.levels.ln_fail);
        gate::is_off_by_itself(off, spread, n as f64, ln_fail) || by_range >= ln_fail
    }

    /// The kurtosis that a judgement assumes, without a claim of the caller.
    pub(super) fn assumed(&self) -> Option<f64> {
        if self.quantity.ground != Some(VarianceBound::Shown) {
            return None;
        }
        self.of_variance.as_ref().and_then(|ground| ground.kurtosis)
    }
}
