//! What is said of one scalar of foreign draws.

use super::grounds::{self, EFFECTIVE, Spread};
use super::judgement::ScalarFinding;
use super::scalar::Scalar;
use super::trial::Trial;
use crate::catalogue::deviation::Deviation;
use crate::stats::gate::{self, Decision, Design};
use crate::stats::verdict::BLOCK;
use crate::stats::verdict::{GateFinding, Verdict};

impl Scalar {
    /// The scalar with the quantity that it stands for, by which messages tell it.
    pub(super) fn of(self, trial: &Trial) -> Self {
        let claim = &trial.claim;
        let lookups = claim.lookups.map_or(1.0, |claimed| claimed.mean);
        let (expected, scale) = match self.ask.check {
            "variance" => (claim.variance.unwrap_or(1.0), claim.variance.unwrap_or(1.0)),
            "lookups" => (lookups, lookups),
            _ => (claim.truth, claim.unit),
        };
        let unit = if trial.wanted.batch > 1 { "averages" } else { "draws" };
        Self { expected, scale, unit, ..self }
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
            "the kurtosis or the range"
        } else {
            "the variance, the range or the largest kurtosis"
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

    /// How far the quantity is from what is claimed, where y is `off` on average.
    fn deviation(&self, off: f64, draws: u64) -> Deviation {
        let &Self { expected, scale, unit, .. } = self;
        Deviation { unit, ..Deviation::new(expected + scale * off, expected, draws) }
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
            let z = if self.past.kurtosis().is_finite() { z } else { f64::NAN };
            let (found, limit) = (self.evidence.ln_e, self.levels.ln_fail);
            let told = self.deviation(off, n).with_z(z);
            let reason = format!("the {what} is off by {told} (ln E = {found:.1} ≥ {limit:.1})");
            return (Verdict::Fail, reason);
        }
        let looks_off = || {
            let told = self.deviation(self.past.mean(), self.past.draws());
            let cure = self.cure();
            format!(
                "the {what} looks off by {told}, but no number of draws can show that without {cure}"
            )
        };
        let Some(design) = self.design.filter(|_| is_founded) else {
            // Draws that are all alike show no spread, but they show where they are.
            let are_alike = self.past.draws() > BLOCK && self.past.kurtosis() == f64::INFINITY;
            if !self.ask.must_pass && are_alike && self.past.mean().abs() > self.ask.cap {
                return (Verdict::Inconclusive, looks_off());
            }
            let weak = if self.ask.must_pass { Verdict::Inconclusive } else { weak };
            return (weak, self.unknown());
        };
        match self.decision {
            _ if self.is_doubted && !relies_on_shown => (Verdict::Inconclusive, looks_off()),
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
