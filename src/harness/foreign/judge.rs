//! The gate over another program's draws.
//!
//! ```text
//! mean      y = (X − T)/u,     variance V/u²   u = |T|; for T = 0 it is 1, and ε is absolute
//! variance  y = (X − T)²/V − 1, variance κ − 1
//! ε         as asked; else √(27 V/n) for n draws, at most 5 % for the mean and 20 % for the variance;
//!           else 1 % for the mean, and for the variance what as many draws see
//! levels    fail at ln E ≥ ln(K/α), K = 1 or 2 scalars;  pass at both ln P ≥ ln(1/β), β = 0.01
//! ```
//!
//! Draws are read block by block (2¹⁴ draws) in constant memory; looks come at block ends, growing
//! by 1.15, and where the draws end. Reading stops at a decision. The designs are those of
//! `stats::gate`, so the same draws get the same verdict as in a run.
//!
//! With T, V and κ known, correct draws fail with chance at most α, whatever their law, and draws
//! whose mean is off by ε pass with chance at most β, as long as their variance is at most 1.1 V. The
//! check of the variance passes below 1 + its own ε: at 1.2 V the chance is 1.2 %, at 2 V 6 %. Where V or κ is not known, it is estimated from the draws
//! before each block (`scalar`): the promises then hold only for many draws, and not at all where
//! rare events, unseen so far, carry the variance; such a verdict says `variance estimated` or
//! `kurtosis estimated`. Draws without spread must all be the truth to rounding. A draw that is not
//! a finite number fails, and so does one whose distance from the truth overflows.

use super::claim::{Claim, ClaimError};
use super::judgement::Judgement;
use super::scalar::{Ask, Levels, Scalar};
use super::{Draws, ForeignError};
use crate::harness::checks::mean::FURTHEST;
use crate::harness::plan::{BLOCK, MISS};
use crate::harness::record::Verdict;
use crate::stats::Powers;
use crate::stats::gate;

/// The widest ε of a mean that is chosen without being asked for.
const MEAN_CAP: f64 = 0.05;
/// The same of a variance.
const VARIANCE_CAP: f64 = 0.2;
/// ε of a mean where neither the caller nor a number of draws says.
const USUAL: f64 = 0.01;
/// A kurtosis this near to 1 leaves nothing of the variance to test.
const TWO_POINT: f64 = 1.0 + 1e-6;
/// How many draws are read at a time: a block.
#[allow(clippy::cast_possible_truncation)] // 2¹⁴
const BUFFER: usize = BLOCK as usize;

/// What is wanted of the verdict.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// ε of the mean, in units of u.
    pub tolerance: Option<f64>,
    /// ε of the variance, relative to it.
    pub variance_tolerance: Option<f64>,
    /// The chance that correct draws fail.
    pub alpha: f64,
    /// Whether to read on after the decision.
    pub all: bool,
}

impl Default for Wanted {
    fn default() -> Self {
        Self { tolerance: None, variance_tolerance: None, alpha: 1e-3, all: false }
    }
}

/// A claim with what is wanted, ready for draws.
#[derive(Debug, Clone, Copy)]
pub struct Trial {
    claim: Claim,
    wanted: Wanted,
    length: Option<u64>,
}

impl Trial {
    /// Checks what is wanted before anything is read; `length` is the number of draws, if known.
    ///
    /// # Errors
    ///
    /// A tolerance or α makes no sense for this claim.
    pub fn new(claim: Claim, wanted: Wanted, length: Option<u64>) -> Result<Self, ClaimError> {
        let positive = |what, value: Option<f64>| match value {
            Some(value) if !(value > 0.0 && value.is_finite()) => {
                Err(ClaimError::Number { what, value, wanted: "a finite number above 0" })
            }
            _ => Ok(()),
        };
        positive("tolerance", wanted.tolerance)?;
        positive("variance tolerance", wanted.variance_tolerance)?;
        if !(wanted.alpha > 0.0 && wanted.alpha < 1.0) {
            let (what, value) = ("alpha", wanted.alpha);
            let wanted = "a probability above 0 and below 1";
            return Err(ClaimError::Number { what, value, wanted });
        }
        let trial = Self { claim, wanted, length };
        if claim.truth == 0.0 && wanted.tolerance.is_none() && !trial.is_certain() {
            return Err(ClaimError::NoUnit);
        }
        let blurred = |what, tolerance: Option<f64>, floor: f64| match tolerance {
            Some(tolerance) if tolerance < 4.0 * floor && !trial.is_certain() => {
                Err(ClaimError::Blurred { what, tolerance, floor })
            }
            _ => Ok(()),
        };
        blurred("mean", wanted.tolerance, claim.floor())?;
        // Without a tolerance of the caller's, one above the cap would be chosen.
        if wanted.tolerance.is_none() && claim.truth != 0.0 {
            blurred("mean", Some(MEAN_CAP), claim.floor())?;
        }
        if let Some(variance) = claim.variance.filter(|&variance| variance > 0.0) {
            blurred("variance", wanted.variance_tolerance, claim.variance_floor(variance))?;
        }
        Ok(trial)
    }

    /// √V in units of u, by the claim.
    fn deviation(&self) -> Option<f64> {
        self.claim.variance.map(|variance| variance.sqrt() / self.claim.unit)
    }

    /// Whether the draws have no spread, by the claim.
    fn is_certain(&self) -> bool {
        self.deviation().is_some_and(|deviation| FURTHEST * deviation <= self.claim.floor())
    }

    /// Whether rounding spoils what the spread says.
    fn is_faint(&self) -> bool {
        self.deviation().is_some_and(|deviation| deviation <= 1e3 * self.claim.floor())
    }

    /// What no draw of a claim without spread may exceed, in units of u.
    fn bound(&self) -> f64 {
        self.claim.floor() + FURTHEST * self.deviation().unwrap_or(0.0)
    }

    /// Reads and judges.
    ///
    /// # Errors
    ///
    /// The draws cannot be read to where they are decided.
    pub fn judge(&self, draws: &mut Draws) -> Result<Judgement, ForeignError> {
        let mut bench = Bench::new(self);
        let mut block = Vec::with_capacity(BUFFER);
        while draws.read(&mut block, BUFFER)? > 0 {
            bench.absorb(&block);
            if bench.refuted.is_some() || !(bench.is_open() || self.wanted.all) {
                break;
            }
        }
        bench.scalars().for_each(Scalar::decide);
        Ok(bench.close())
    }
}

/// A draw that refutes the claim by itself.
struct Refuted {
    index: u64,
    value: f64,
}

struct Bench<'t> {
    trial: &'t Trial,
    powers: Powers,
    mean: Option<Scalar>,
    variance: Option<Scalar>,
    refuted: Option<Refuted>,
    read: u64,
    y: Vec<f64>,
    squares: Vec<f64>,
}

impl<'t> Bench<'t> {
    fn new(trial: &'t Trial) -> Self {
        let Trial { claim, wanted, length } = trial;
        let known = claim.variance.map(|v| v / (claim.unit * claim.unit));
        let known = known.map(|v| v * (1.0 + claim.variance_error));
        let kurtosis = claim.kurtosis.map(|k| (k - 1.0) * (1.0 + 4.0 * claim.variance_error));
        let is_certain = trial.is_certain();
        let asks_variance = claim.variance.is_some()
            && !trial.is_faint()
            && claim.kurtosis.is_none_or(|kurtosis| kurtosis > TWO_POINT);
        let count = if asks_variance { 2.0 } else { 1.0 };
        let levels = Levels { ln_fail: (count / wanted.alpha).ln(), ln_pass: -MISS.ln() };
        let planned = planned(known, kurtosis, wanted, *length);
        let mean = Ask {
            check: "mean",
            variance: known,
            tolerance: wanted.tolerance,
            usual: USUAL,
            cap: MEAN_CAP,
            floor: claim.floor(),
            must_pass: true,
        };
        let variance = claim.variance.filter(|_| asks_variance).map(|variance| Ask {
            check: "variance",
            variance: kurtosis,
            tolerance: wanted.variance_tolerance,
            usual: VARIANCE_CAP,
            cap: VARIANCE_CAP,
            floor: claim.variance_floor(variance),
            must_pass: false,
        });
        let scalar = |ask| Scalar::new(ask, planned, levels);
        Self {
            trial,
            powers: Powers::default(),
            mean: (!is_certain).then(|| scalar(mean)),
            variance: variance.map(scalar),
            refuted: None,
            read: 0,
            y: Vec::with_capacity(BUFFER),
            squares: Vec::with_capacity(BUFFER),
        }
    }

    fn scalars(&mut self) -> impl Iterator<Item = &mut Scalar> {
        self.mean.iter_mut().chain(&mut self.variance)
    }

    fn absorb(&mut self, block: &[f64]) {
        let claim = &self.trial.claim;
        let (truth, scale) = (claim.truth, 1.0 / claim.unit);
        let is_finite = block.iter().map(|x| zero_or_nan((x - truth) * scale)).sum::<f64>() == 0.0;
        let bound = self.trial.bound();
        let is_wrong = |x: &f64| {
            let y = (x - truth) * scale;
            zero_or_nan(y) != 0.0 || (self.mean.is_none() && y.abs() > bound)
        };
        let suspicious = !is_finite || self.mean.is_none();
        if let Some(at) = suspicious.then(|| block.iter().position(is_wrong)).flatten() {
            self.refuted = Some(Refuted { index: self.read + at as u64, value: block[at] });
        }
        self.read += block.len() as u64;
        if !is_finite {
            return;
        }
        self.y.clear();
        self.y.extend(block.iter().map(|x| (x - truth) * scale));
        self.powers.absorb(&self.y);
        if let Some(mean) = &mut self.mean {
            mean.absorb(&self.y);
        }
        if let (Some(scalar), Some(variance)) = (&mut self.variance, claim.variance) {
            let scale = claim.unit * claim.unit / variance;
            self.squares.clear();
            self.squares.extend(self.y.iter().map(|y| y * y * scale - 1.0));
            scalar.absorb(&self.squares);
        }
    }

    fn is_open(&mut self) -> bool {
        if self.mean.is_none() {
            return true;
        }
        !self.scalars().any(|scalar| scalar.has_failed())
            && self.scalars().any(|scalar| scalar.is_open())
    }

    fn close(self) -> Judgement {
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
        let findings = self.mean.iter().chain(&self.variance);
        let mut judgement = Judgement {
            verdict: Verdict::Pass,
            reason: String::new(),
            guarantees: Vec::new(),
            alpha: wanted.alpha,
            beta: MISS,
            draws: self.read,
            length: *length,
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
            refuted_by: self.refuted.as_ref().map(|refuted| refuted.index),
            findings: findings.map(|scalar| scalar.finding(self.read)).collect(),
        };
        self.decide(&mut judgement);
        judgement
    }

    /// The verdict of the whole, and what it promises.
    fn decide(&self, judgement: &mut Judgement) {
        let claim = &self.trial.claim;
        let worst = [Verdict::Fail, Verdict::Inconclusive]
            .into_iter()
            .find(|verdict| judgement.findings.iter().any(|found| found.verdict == *verdict));
        judgement.verdict = worst.unwrap_or(Verdict::Pass);
        let reasons = judgement.findings.iter().filter(|found| Some(found.verdict) == worst);
        judgement.reason =
            reasons.map(|found| found.reason.as_str()).collect::<Vec<_>>().join("; ");
        if let Some(Refuted { index, value }) = self.refuted {
            judgement.verdict = Verdict::Fail;
            let is_far = zero_or_nan((value - claim.truth) / claim.unit) != 0.0;
            judgement.reason = if value.is_finite() && is_far {
                format!(
                    "numeric: draw {index} is {value:e}, beyond measure for a truth of {:e}",
                    claim.truth
                )
            } else if value.is_finite() {
                let (truth, bound) = (claim.truth, self.trial.bound() * claim.unit);
                format!("draw {index} is {value:e}, not {truth:e}; {bound:.1e} is rounding")
            } else {
                format!("numeric: draw {index} is {value}, counted from 0")
            };
        }
        judgement.guarantees = guarantees(claim, judgement);
    }
}

/// 0 for numbers whose square is finite, and not a number otherwise.
#[inline(always)]
fn zero_or_nan(y: f64) -> f64 {
    y * y * 0.0
}

/// n: the draws that the tolerances asked for need, at most those that there are.
fn planned(
    variance: Option<f64>,
    kurtosis: Option<f64>,
    wanted: &Wanted,
    length: Option<u64>,
) -> Option<f64> {
    let needs = |variance: Option<f64>, tolerance: Option<f64>| {
        let variance = variance.filter(|&variance| variance > 0.0)?;
        // A design never has a wider ε than a quarter of the spread.
        Some(gate::draws_of(variance, tolerance?.min(0.25 * variance.sqrt())))
    };
    let asked = [(variance, wanted.tolerance), (kurtosis, wanted.variance_tolerance)];
    let asked = asked.into_iter().filter_map(|(v, tolerance)| needs(v, tolerance));
    let length = length.map(|length| length as f64);
    match asked.reduce(f64::max) {
        Some(needed) => Some(length.map_or(needed, |length| needed.min(length))),
        None => length.or_else(|| needs(variance, Some(USUAL))),
    }
}

/// What the verdict promises, and what it does not.
fn guarantees(claim: &Claim, judgement: &Judgement) -> Vec<String> {
    let mut said = Vec::new();
    let Some(mean) = judgement.finding("mean") else {
        said.push(
            "no spread: every draw read is the truth to rounding, or the verdict is fail".into(),
        );
        return said;
    };
    let (alpha, beta) = (judgement.alpha, judgement.beta);
    if mean.is_estimated {
        said.push(format!(
            "variance estimated: the error rates (correct draws fail with chance {alpha}, draws off by \
             the tolerance pass with chance {beta}) hold for many draws only, not where rare events \
             that were not drawn carry the variance; the variance itself is not tested"
        ));
        return said;
    }
    let is_bounded = claim.kurtosis.is_some() || judgement.finding("variance").is_none();
    let failing = if is_bounded { "correct draws fail" } else { "a correct mean fails" };
    said.push(format!("{failing} with chance {alpha} at most"));
    let miss = format!("a mean off by the tolerance passes with chance {beta} at most");
    let variance = judgement.finding("variance");
    match variance {
        None => said.push(miss),
        Some(found) if found.verdict == Verdict::Pass => {
            said.push(format!("{miss}; the variance it relies on passes"));
        }
        Some(_) if mean.verdict == Verdict::Pass => {
            said.push(format!("variance assumed: {miss}, if the variance is right"));
        }
        Some(_) => {}
    }
    if claim.kurtosis.is_none() && variance.is_some() {
        said.push(
            "kurtosis estimated: the error rates of the variance hold for many draws only, not where \
             rare events that were not drawn carry it"
                .into(),
        );
    }
    said
}
