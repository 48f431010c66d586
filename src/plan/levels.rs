//! How the questions of a run share its error rate: 4/5 of α go to the gate, by e-Bonferroni, 1/5 to
//! the p-values, by Holm.

use gate::session;
use gate::stats::gate::ln_fail;
use gate::stats::normal;
use gate::stats::verdict::MISS;

/// The share of the error rate that goes to tests of whole laws.
const LAW_SHARE: f64 = 0.2;

/// The levels that the run's questions share, fixed before the first draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    /// How many scalars go through the gate.
    pub scalars: usize,
    /// How many p-values there are.
    pub laws: usize,
    /// How many experiments are declared biased: they have an α of their own.
    pub biased: usize,
    /// A scalar fails at `ln E ≥ ln(K/(0.8 α))`.
    pub ln_fail: f64,
    /// A declared bias is shown at `ln E ≥ ln(K_biased/α)`.
    pub ln_biased: f64,
    /// A scalar passes at `ln P± ≥ ln(1/β)`.
    pub ln_pass: f64,
    /// What the p-values share, by Holm.
    pub law_alpha: f64,
    /// The z-score that the gate's level corresponds to, for plots.
    pub z: f64,
}

impl Levels {
    /// The levels at which so many scalars, laws and declared biases share α.
    pub fn new(alpha: f64, [scalars, laws, biased]: [usize; 3]) -> Self {
        let share = alpha * (1.0 - LAW_SHARE) / scalars.max(1) as f64;
        Self {
            scalars,
            laws,
            biased,
            ln_fail: ln_fail(alpha * (1.0 - LAW_SHARE), scalars),
            ln_biased: ln_fail(alpha, biased),
            ln_pass: -MISS.ln(),
            law_alpha: alpha * LAW_SHARE,
            z: normal::two_sided(share),
        }
    }

    /// The levels of a quantity, or of one with a bias that must be shown.
    pub fn of(&self, expects_bias: bool) -> session::Levels {
        let ln_fail = if expects_bias { self.ln_biased } else { self.ln_fail };
        session::Levels { ln_fail, ln_pass: self.ln_pass }
    }
}
