//! The gate over another program's draws.
//!
//! ```text
//! mean      y = (X − T)/u,     variance V/u²   u = |T|; for T = 0 it is 1, and ε is absolute
//! variance  y = (X − T)²/V − 1, variance κ − 1
//! lookups   y = M/E[M] − 1,    variance Var[M]/E[M]²
//! drift     the mean from any later block on, against T and against all other draws
//! ε         as asked; else √(27 V/n) for n draws, at most 5 % for the mean, 20 % for the variance and
//!           2 % for the lookups, by a range alone not below 12 R/n, R its further part; else 1 % for the mean, and
//!           for the others what as many draws see
//! levels    fail at ln E ≥ ln(K/0.8α), K the first three as far as they are asked; drift at ln(1/0.2α);
//!           with the theory of a case ln(K/0.6α), and the p-values of the distribution (`theory`) share 0.2α;
//!           pass at both ln P ≥ ln(1/β), β = 0.01;  dependence has an α of its own
//! ```
//!
//! Draws are read block by block (2¹⁴ draws) in constant memory, to the end unless the caller wants
//! less. A scalar fails only on grounds that hold (`grounds`): a known variance, a range, a bound on
//! the kurtosis; without any of them it can pass, on an assumption that the verdict names, but not fail. All of it is for draws
//! that are independent of each other: where `stats::independence`, `stats::replays`, `stats::sequences` or `stats::runs` finds that they
//! are not, the verdict says so, and nothing is said of the mean. No pass stands beside an obvious difference (`obvious`). Draws without spread must all be the
//! truth to rounding. A draw that is not a finite number fails, and so does one whose distance from the
//! truth overflows, or one out of the promised range.

use super::asks::VARIANCE_CAP;
use super::claim::{Claim, ClaimError};
use super::judgement::{Judgement, Stop};
use super::reading::Reading;
use crate::stats::verdict::{BLOCK, FURTHEST};

/// The widest ε of a mean that is chosen without being asked for.
pub const MEAN_CAP: f64 = 0.05;
/// How many draws are read at a time: a block.
#[allow(clippy::cast_possible_truncation)] // 2¹⁴
pub const BUFFER: usize = BLOCK as usize;

/// What is wanted of the verdict.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// ε of the mean, in units of u.
    pub tolerance: Option<f64>,
    /// ε of the variance, relative to it.
    pub variance_tolerance: Option<f64>,
    /// The chance that correct draws fail.
    pub alpha: f64,
    /// How many consecutive draws are averaged before they are judged; the claim is then of averages.
    pub batch: u64,
    /// Whether to stop reading as soon as all is decided.
    pub stop_early: bool,
    /// How many draws are read at most.
    pub most: Option<u64>,
}

impl Default for Wanted {
    fn default() -> Self {
        Self {
            tolerance: None,
            variance_tolerance: None,
            alpha: 1e-3,
            batch: 1,
            stop_early: false,
            most: None,
        }
    }
}

/// A claim with what is wanted, ready for draws.
#[derive(Debug, Clone, Copy)]
pub struct Trial {
    /// What is claimed of a draw.
    pub claim: Claim,
    /// Error rate, tolerances and number of draws.
    pub wanted: Wanted,
    /// Number of draws, if known.
    pub length: Option<u64>,
}

impl Trial {
    /// Checks what is wanted before anything is read; `length` is the number of draws, if known.
    ///
    /// # Errors
    ///
    /// A tolerance, a number of draws or α makes no sense for this claim.
    pub fn new(claim: Claim, wanted: Wanted, length: Option<u64>) -> Result<Self, ClaimError> {
        let positive = |what, value: Option<f64>| match value {
            Some(value) if !(value > 0.0 && value.is_finite()) => {
                Err(ClaimError::Number { what, value, wanted: "a finite number above 0" })
            }
            _ => Ok(()),
        };
        positive("tolerance", wanted.tolerance)?;
        positive("variance tolerance", wanted.variance_tolerance)?;
        positive("batch", Some(wanted.batch as f64))?;
        positive("number of draws", wanted.most.map(|most| most as f64))?;
        if !(wanted.alpha > 0.0 && wanted.alpha < 1.0) {
            let (what, value) = ("alpha", wanted.alpha);
            let wanted = "a probability above 0 and below 1";
            return Err(ClaimError::Number { what, value, wanted });
        }
        let trial = Self { claim, wanted, length };
        if wanted.variance_tolerance.is_some() {
            let why = match claim.variance {
                None => Some("none is claimed"),
                Some(_) if trial.is_certain() || trial.is_faint() => Some("rounding hides it"),
                Some(_) => None,
            };
            why.map_or(Ok(()), |why| Err(ClaimError::NoVariance { why }))?;
        }
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
    pub fn deviation(&self) -> Option<f64> {
        self.claim.variance.map(|variance| variance.sqrt() / self.claim.unit)
    }

    /// Whether the draws have no spread, by the claim.
    pub fn is_certain(&self) -> bool {
        self.deviation().is_some_and(|deviation| FURTHEST * deviation <= self.claim.floor())
    }

    /// Whether rounding hides what the spread says: the variance cannot be tested to its widest tolerance.
    pub fn is_faint(&self) -> bool {
        let variance = self.claim.variance.filter(|&variance| variance > 0.0);
        variance.is_some_and(|v| self.claim.variance_floor(v) > 0.25 * VARIANCE_CAP)
    }

    /// What no draw of a claim without spread may exceed, in units of u.
    pub fn bound(&self) -> f64 {
        self.claim.floor() + FURTHEST * self.deviation().unwrap_or(0.0)
    }

    /// Judges draws that are in memory; there are no lookups with them.
    pub fn judge_all(&self, draws: &[f64]) -> Judgement {
        let length = draws.len() as u64;
        let most = usize::try_from(self.wanted.most.unwrap_or(length)).unwrap_or(usize::MAX);
        let seen = &draws[..draws.len().min(most)];
        let mut stopped = (seen.len() < draws.len()).then_some(Stop::Limit);
        let mut reading = Reading::new(*self);
        for block in seen.chunks(BUFFER) {
            reading.absorb(block, &[]);
            if self.wanted.stop_early && !reading.is_open() {
                stopped = (reading.draws() < length).then_some(Stop::Decided);
                break;
            }
        }
        reading.close(stopped)
    }
}
