//! Findings of one quantity. No quantity passes with an obvious difference.
//!
//! ```text
//! z      (|ȳ| − δ)/√(s²/n), and with V for s² where it is known
//! limit  6(1 + 3/√ν),  ν = n over the sample kurtosis: the number of draws that carry s²
//! change of blocks a to b against all others:  z = (ȳ_in − ȳ_out)/√(s²(1/n_in + 1/n_out)),  ν for the smaller part
//! ```
//!
//! The limit is no level. Counts of rare events, the most skewed draws of a given ν, reach it with probability 1e-9
//! or less (a Poisson number of mean λ that is k, ν = k: λ = 106 for k = 50, z = −7.9, limit 8.5). Nothing fails by
//! it. It revokes passes, and it distinguishes a change from a mean that deviates from the beginning.

use super::ground;
use super::judgement::ScalarFinding;
use super::quantity::{Quantity, VarianceBound};
use super::reason::{Missing, Reason};
use super::scalar::Scalar;
use crate::deviation::Deviation;
use crate::stats::gate::{Decision, Design};
use crate::stats::verdict::{BLOCK, Verdict};

impl Scalar {
    /// The finding.
    pub(super) fn finding(&self) -> ScalarFinding {
        let (verdict, reason) = self.verdict();
        // Large bets may decide before ε is chosen.
        let decided = (self.decision != Decision::Open).then(|| match self.quantity.tolerance {
            Some(requested) => {
                Design::asked(self.past.mean_square(), requested, self.quantity.floor)
            }
            None => Design::new(self.past.mean_square(), self.quantity.cap, self.quantity.floor),
        });
        let gate = self
            .design
            .or(decided)
            .map(|design| self.levels.finding(&design, self.evidence, self.seen, self.decision));
        ScalarFinding {
            check: self.quantity.check,
            verdict,
            reason,
            is_estimated: !self.quantity.is_hard(),
            assumed_kurtosis: self.assumed(),
            is_promised: self.is_promised,
            gate,
        }
    }

    /// Reason where the draws do not show their own variance.
    fn unknown_spread(&self) -> Reason {
        let Quantity { check, what, ground, tolerance, .. } = self.quantity.clone();
        let (draws, carry) = (self.past.draws(), self.past.effective_draws().floor().max(0.0));
        let missing = match (ground, self.assumed()) {
            (None, _) => Missing::FirstDraws,
            (Some(VarianceBound::Kurtosis(kurtosis)), _) => {
                let needed = ground::draws_of_bound(kurtosis, self.levels.ln_fail);
                Missing::DrawsOfKurtosis { kurtosis, needed }
            }
            (_, Some(assumed)) if carry >= ground::EFFECTIVE => {
                Missing::LightTails { shown: self.past.kurtosis(), assumed }
            }
            _ => Missing::Carriers(carry),
        };
        Reason::UnknownSpread { check, what, draws, tolerance, missing }
    }

    /// Deviation over all draws, in z standard errors.
    fn deviation_of_all(&self, z: f64) -> Deviation {
        self.quantity.deviation(self.past.mean(), self.past.draws()).with_z(z)
    }

    /// The number of draws that a pass is planned for; with a range alone, for the variance that the draws show.
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
            check: self.quantity.check,
            what: self.quantity.what.clone(),
            off: self.deviation_of_all(z),
            are_alike: z.is_infinite(),
            ground: self.quantity.ground,
            excluded,
        }
    }

    /// A pass; revoked where the mean of all draws plainly deviates, unless within a given tolerance.
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
        // Where V is only bounded, the draws' own variance is more informative.
        let known = self.quantity.known_variance().unwrap_or(self.past.variance());
        let z = off / (known / n as f64).sqrt();
        let z = if self.past.kurtosis().is_finite() { z } else { f64::NAN };
        Reason::Off {
            what: self.quantity.what.clone(),
            off: self.quantity.deviation(off, n).with_z(z),
            remark: String::new(),
            ln_e: self.evidence.ln_e,
            limit: self.levels.ln_fail,
            tolerance: self.quantity.tolerance.filter(|requested| off.abs() < *requested),
        }
    }

    fn undecided(&self, design: &Design) -> Reason {
        let planned = self.planned_draws(design);
        let undecided = self.quantity.undecided(self.seen.1, design.tolerance, planned);
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
            // Draws that are all equal show no variance, but they show their value.
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

/// Limit in standard errors where many draws carry the variance.
const PLAIN: f64 = 6.0;
/// Coefficient of 1/√ν in the limit.
const FEW: f64 = 3.0;

/// Factor of the limit where evidence from some draw on refutes the claim, and that of all draws does not.
const HINTED: f64 = 0.6;
/// Factor of the limit for pairs of blocks.
const PAIRS: f64 = 1.1;
/// Maximum number of parts between which changes are searched.
const MAX_PARTS: usize = 512;
/// Expected number of events at which the probability of none is e⁻²⁰.
const MISSED: f64 = 20.0;

/// A change of the mean.
#[derive(Debug, Clone, Copy)]
pub(super) struct MeanChange {
    /// The first draw of the part that differs most from the others.
    pub from: u64,
    /// The draw after its last one; `None` for the end.
    pub to: Option<u64>,
    /// Mean of y in that part.
    pub off: f64,
    /// Distance from the mean of all other draws, in standard errors.
    pub z: f64,
}

/// Returns the number of standard errors of an obvious deviation, where ν draws carry the variance.
pub fn plain_limit(carry: f64) -> f64 {
    PLAIN * (1.0 + FEW / carry.sqrt())
}

impl Scalar {
    /// Distance of the mean of y from 0 in standard errors, if it is beyond the limit. It is infinite for draws
    /// that are all equal, where the range or the variance excludes that rare draws make up for the difference.
    pub(super) fn obvious_z(&self) -> Option<f64> {
        let (n, off) = (self.past.draws() as f64, self.past.mean());
        let excess = off.abs() - self.quantity.floor;
        if n < 2.0 || excess <= 0.0 {
            return None;
        }
        let carry = self.past.effective_draws();
        let of = |variance: f64| excess / (variance / n).sqrt();
        let known = self.quantity.known_variance().map_or(0.0, of);
        if carry <= 0.0 {
            let [low, high] = self.quantity.range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
            let rare = excess / (excess + if off < 0.0 { high } else { -low });
            let is_plain = n * rare > MISSED || known > plain_limit(1.0);
            return is_plain.then(|| f64::INFINITY.copysign(off));
        }
        let shown = of(self.past.variance());
        (shown.max(known) > plain_limit(carry)).then_some(shown.copysign(off))
    }

    /// The most significant change of the mean, if it is beyond the limit: from a block on, else between two
    /// blocks. The limit is smaller where the mean of all draws does not fail and that of later ones does.
    pub(super) fn obvious_change(&self) -> Option<MeanChange> {
        let (n, mean) = (self.past.draws() as f64, self.past.mean());
        let (carry, variance) = (self.past.effective_draws(), self.past.variance());
        let need = if self.has_failed() { 1.0 } else { HINTED };
        // The excess of the blocks so far over their share, and their number of draws; of many blocks every k-th.
        let every = self.sums.len().div_ceil(MAX_PARTS).max(1);
        let (mut sum, mut path) = (0.0, vec![(0.0, 0u64)]);
        for (&(block, draws), index) in self.sums.iter().zip(1..) {
            sum += block;
            if index % every == 0 || index == self.sums.len() {
                path.push((sum - mean * draws as f64, draws));
            }
        }
        let end = path.len() - 1;
        let between = |a: usize, b: usize, need: f64| {
            let (excess, inside) = (path[b].0 - path[a].0, (path[b].1 - path[a].1) as f64);
            let share = inside / n;
            let z = excess / (variance * inside * (1.0 - share)).sqrt();
            let is_plain = z.abs() > need * plain_limit(carry * share.min(1.0 - share));
            let to = (b < end).then_some(path[b].1);
            is_plain.then(|| MeanChange { from: path[a].1, to, off: mean + excess / inside, z })
        };
        let larger = |a: &MeanChange, b: &MeanChange| a.z.abs().total_cmp(&b.z.abs());
        let from_one_on = (1..end).filter_map(|a| between(a, end, need)).max_by(larger);
        from_one_on.or_else(|| {
            // With this number of pairs the limit is reached a little more easily.
            let pairs = (1..end).flat_map(|a| (a + 1..end).map(move |b| (a, b)));
            pairs.filter_map(|(a, b)| between(a, b, PAIRS * need)).max_by(larger)
        })
    }
}
