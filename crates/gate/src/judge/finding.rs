//! What is said of one scalar of foreign draws.

use super::grounds::{self, EFFECTIVE, Spread};
use super::judgement::ScalarFinding;
use super::scalar::Scalar;
use super::trial::Trial;
use crate::deviation::Deviation;
use crate::stats::gate::{Decision, Design, HORIZON, PLANNED};
use crate::stats::verdict::BLOCK;
use crate::stats::verdict::{GateFinding, Verdict};

impl Scalar {
    /// The scalar with the quantity that it stands for, by which messages tell it.
    pub fn of(self, trial: &Trial) -> Self {
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
    pub fn finding(&self) -> ScalarFinding {
        let (verdict, reason) = self.verdict();
        // Bold bets may decide before ε is chosen.
        let decided = (self.decision != Decision::Open).then(|| match self.ask.tolerance {
            Some(asked) => Design::asked(self.past.mean_square(), asked, self.ask.floor),
            None => Design::new(self.past.mean_square(), self.ask.cap, self.ask.floor),
        });
        let gate = self.design.or(decided).map(|design| GateFinding {
            tolerance: design.tolerance,
            variance: design.variance,
            mean: self.seen.0,
            planned: design.draws(),
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
        let unused = self.ask.tolerance.map_or(String::new(), |asked| {
            format!("; the tolerance of {asked:.1e} is not tested without that")
        });
        self.missing() + &unused
    }

    fn missing(&self) -> String {
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

    /// Deviation of the quantity from the claim, where y is `off` on average.
    pub fn deviation(&self, off: f64, draws: u64) -> Deviation {
        let &Self { expected, scale, unit, .. } = self;
        Deviation { unit, ..Deviation::new(expected + scale * off, expected, draws) }
    }

    /// The draws that a pass is planned for; by a range alone, with the variance that the draws show.
    fn planned_draws(&self, design: &Design) -> f64 {
        let Some(ground) = self.of_range.as_ref().filter(|_| self.ask.spread.is_none()) else {
            return design.draws();
        };
        let by_range = ground.finest() / design.tolerance;
        let variance = ground.variance(&self.past);
        variance.map_or(by_range, |v| design.with_variance(v).draws().max(by_range))
    }

    /// By how much y looks off.
    fn looks_off(&self, z: f64) -> String {
        let what = self.ask.what;
        let told = self.deviation(self.past.mean(), self.past.draws()).with_z(z);
        let alike = if z.is_finite() { "" } else { ", and all draws are alike" };
        format!("the {what} looks off by {told}{alike}")
    }

    /// Reason why an obvious difference does not fail, with what would let it.
    fn what_shows(&self) -> String {
        let n = self.past.draws();
        match self.ask.spread {
            Some(Spread::Known(_)) => format!("{n} draws of the variance given do not show it"),
            Some(Spread::Kurtosis(_)) => format!("{n} draws of the kurtosis given do not show it"),
            Some(Spread::Shown) => format!("no number of draws shows it without {}", self.cure()),
            None => {
                format!("{n} draws of the range given do not show it: give more, or the variance")
            }
        }
    }

    /// A pass; taken back where the mean of all draws is plainly off, unless that is within a tolerance asked for.
    fn passed(&self) -> (Verdict, String) {
        let Some(z) = self.obvious_z() else { return (Verdict::Pass, String::new()) };
        let off = self.past.mean();
        match self.ask.tolerance {
            Some(asked) if off.abs() < asked => {
                let what = self.ask.what;
                let told = self.deviation(off, self.past.draws()).with_z(z);
                let reason = format!(
                    "the {what} is off by {told}, within the tolerance of {asked:.1e} that was asked for"
                );
                (Verdict::Pass, reason)
            }
            _ => {
                let tolerance = self.design.map_or(0.0, |design| design.tolerance);
                let reason = format!(
                    "{}, but {}; a bias of {tolerance:.2e} is excluded: give a tolerance to accept a smaller one",
                    self.looks_off(z),
                    self.what_shows(),
                );
                (Verdict::Inconclusive, reason)
            }
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
            let known = self.known_variance().unwrap_or(self.past.variance());
            let z = off / (known / n as f64).sqrt();
            let z = if self.past.kurtosis().is_finite() { z } else { f64::NAN };
            let (found, limit) = (self.evidence.ln_e, self.levels.ln_fail);
            let told = self.deviation(off, n).with_z(z);
            let below = match self.ask.tolerance {
                Some(asked) if off.abs() < asked => format!(
                    "; below the tolerance of {asked:.1e}, which is what a pass must exclude: a bias that is \
                     shown fails"
                ),
                _ => String::new(),
            };
            let reason =
                format!("the {what} is off by {told} (ln E = {found:.1} ≥ {limit:.1}){below}");
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
            Decision::Passed => self.passed(),
            Decision::Open | Decision::Failed => {
                let planned = self.planned_draws(&design);
                let longest = planned * HORIZON / PLANNED;
                let needed = if planned > n as f64 { planned } else { longest };
                let plain = self.obvious_z().map_or(String::new(), |z| {
                    format!("{}, but {}; ", self.looks_off(z), self.what_shows())
                });
                let reason = format!(
                    "{plain}the {what} is undecided after {n} draws; a tolerance of {:.2e} needs {needed:.1e}",
                    design.tolerance
                );
                (weak, reason)
            }
        }
    }
}
