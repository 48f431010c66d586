//! What is found of one quantity.

use super::ground;
use super::judgement::ScalarFinding;
use super::quantity::{Ground, Quantity};
use super::reason::Reason;
use super::scalar::Scalar;
use crate::deviation::Deviation;
use crate::stats::gate::{Decision, Design, HORIZON, PLANNED};
use crate::stats::verdict::{BLOCK, GateFinding, Verdict};

impl Scalar {
    /// The finding.
    pub(super) fn finding(&self) -> ScalarFinding {
        let (verdict, reason) = self.verdict();
        // Bold bets may decide before ε is chosen.
        let decided = (self.decision != Decision::Open).then(|| match self.quantity.tolerance {
            Some(asked) => Design::asked(self.past.mean_square(), asked, self.quantity.floor),
            None => Design::new(self.past.mean_square(), self.quantity.cap, self.quantity.floor),
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
            check: self.quantity.check.to_owned(),
            verdict,
            reason,
            is_estimated: !self.quantity.is_hard(),
            assumed_kurtosis: self.assumed(),
            is_promised: self.is_promised,
            gate,
        }
    }

    /// Reason where the draws do not show their own spread.
    fn unknown_spread(&self) -> Reason {
        let Quantity { what, ground, tolerance, .. } = self.quantity.clone();
        let (draws, carry) = (self.past.draws(), self.past.effective_draws().floor().max(0.0));
        match (ground, self.assumed()) {
            (None, _) => Reason::NoTolerance { what, draws, tolerance },
            (Some(Ground::Kurtosis(kurtosis)), _) => {
                let needed = ground::draws_of_bound(kurtosis, self.levels.ln_fail);
                Reason::FewForKurtosis { what, kurtosis, needed, draws, tolerance }
            }
            (_, Some(assumed)) if carry >= ground::EFFECTIVE => {
                Reason::HeavyTails { what, shown: self.past.kurtosis(), assumed, tolerance }
            }
            _ => Reason::FewCarry { what, carry, draws, tolerance },
        }
    }

    /// Deviation of the quantity from the claim, where y is `off` on average.
    pub(super) fn deviation(&self, off: f64, draws: u64) -> Deviation {
        let Quantity { expected, scale, unit, .. } = self.quantity;
        Deviation { unit, ..Deviation::new(expected + scale * off, expected, draws) }
    }

    /// Deviation over all draws, in z standard errors.
    fn deviation_of_all(&self, z: f64) -> Deviation {
        self.deviation(self.past.mean(), self.past.draws()).with_z(z)
    }

    /// The draws that a pass is planned for; by a range alone, with the variance that the draws show.
    fn planned_draws(&self, design: &Design) -> f64 {
        let Some(ground) = self.of_range.as_ref().filter(|_| self.quantity.ground.is_none()) else {
            return design.draws();
        };
        let by_range = ground.finest() / design.tolerance;
        let variance = ground.variance(&self.past);
        variance.map_or(by_range, |v| design.with_variance(v).draws().max(by_range))
    }

    /// An obvious deviation of z standard errors that does not fail.
    fn looks_off(&self, z: f64, excluded: Option<f64>) -> Reason {
        Reason::LooksOff {
            what: self.quantity.what.clone(),
            off: self.deviation_of_all(z),
            are_alike: z.is_infinite(),
            ground: self.quantity.ground,
            excluded,
        }
    }

    /// A pass; taken back where the mean of all draws is plainly off, unless that is within a tolerance asked for.
    fn passed(&self) -> (Verdict, Option<Reason>) {
        let Some(z) = self.obvious_z() else { return (Verdict::Pass, None) };
        match self.quantity.tolerance {
            Some(tolerance) if self.past.mean().abs() < tolerance => {
                let (what, off) = (self.quantity.what.clone(), self.deviation_of_all(z));
                (Verdict::Pass, Some(Reason::Tolerated { what, off, tolerance }))
            }
            _ => {
                let excluded = self.design.map_or(0.0, |design| design.tolerance);
                (Verdict::Inconclusive, Some(self.looks_off(z, Some(excluded))))
            }
        }
    }

    /// A failure.
    fn failed(&self) -> Reason {
        let (off, n) = self.seen;
        // Where V is only bounded, the draws' own spread says more.
        let known = self.quantity.known_variance().unwrap_or(self.past.variance());
        let z = off / (known / n as f64).sqrt();
        let z = if self.past.kurtosis().is_finite() { z } else { f64::NAN };
        Reason::Off {
            what: self.quantity.what.clone(),
            off: self.deviation(off, n).with_z(z),
            remark: String::new(),
            ln_e: self.evidence.ln_e,
            limit: self.levels.ln_fail,
            tolerance: self.quantity.tolerance.filter(|asked| off.abs() < *asked),
        }
    }

    fn undecided(&self, design: &Design) -> Reason {
        let (what, draws) = (self.quantity.what.clone(), self.seen.1);
        let planned = self.planned_draws(design);
        let needed = if planned > draws as f64 { planned } else { planned * HORIZON / PLANNED };
        let undecided = Reason::Undecided { what, draws, tolerance: design.tolerance, needed };
        match self.obvious_z() {
            Some(z) => Reason::Both(Box::new(self.looks_off(z, None)), Box::new(undecided)),
            None => undecided,
        }
    }

    fn verdict(&self) -> (Verdict, Option<Reason>) {
        let weak = if self.is_promised { Verdict::Inconclusive } else { Verdict::Underpowered };
        let ground = self.of_variance.as_ref();
        let relies_on_shown = ground.is_some_and(|ground| ground.is_contradicted(&self.past));
        let is_founded = self.is_founded();
        if self.decision == Decision::Failed && is_founded {
            return (Verdict::Fail, Some(self.failed()));
        }
        let Some(design) = self.design.filter(|_| is_founded) else {
            // Draws that are all alike show no spread, but they show where they are.
            let are_alike = self.past.draws() > BLOCK && self.past.kurtosis() == f64::INFINITY;
            let Quantity { must_pass, cap, .. } = self.quantity;
            if !must_pass && are_alike && self.past.mean().abs() > cap {
                return (Verdict::Inconclusive, Some(self.looks_off(f64::NAN, None)));
            }
            let weak = if must_pass { Verdict::Inconclusive } else { weak };
            return (weak, Some(self.unknown_spread()));
        };
        match self.decision {
            _ if self.is_doubted && !relies_on_shown => {
                (Verdict::Inconclusive, Some(self.looks_off(f64::NAN, None)))
            }
            Decision::Passed if relies_on_shown && !self.quantity.is_hard() => {
                (weak, Some(self.unknown_spread()))
            }
            Decision::Passed => self.passed(),
            Decision::Open | Decision::Failed => (weak, Some(self.undecided(&design))),
        }
    }
}
