//! Effect of one tentative collision on a particle.

pub mod kernel;
pub mod particle;
pub mod rules;

/// Distribution of the factor `W` at a tentative collision: the particle survives with probability `survival` and
/// its weight is multiplied by `weight`; otherwise the walk ends with `X = 0`.
///
/// Unbiased where `survival · weight = 1 − r`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome<L = f64> {
    /// `q_tran`, in `[0, 1]`.
    pub survival: L,
    /// `1 − q_tran`, formed without cancellation.
    pub death: L,
    /// The factor of a survivor, `(1 − r)/q_tran`.
    pub weight: L,
    /// `1 − weight`, formed without cancellation.
    pub loss: L,
}

impl Outcome {
    /// `E[(1 − W)^k]`.
    pub fn mean_loss(&self, k: i32) -> f64 {
        self.death + self.survival * self.loss.powi(k)
    }
}

/// The rule of a product estimator at one collision.
pub trait Rule: Send + Sync {
    /// Outcome of a collision with ratio `r = (σ_t − σ_c)/σ̂`.
    fn outcome(&self, ratio: f64) -> Outcome;

    /// The ratios at which [`Rule::outcome`] or one of its derivatives jumps: panels end there.
    fn kinks(&self) -> Vec<f64>;
}

/// Rule of an estimator that multiplies a factor at every collision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Collisions {
    /// A weight at every collision: ratio tracking and the double particle. The losses `J_k = ∫ ρ^k/σ̂^{k−1}` at one σ̂, ρ the
    /// residual, give those at all multiples of it.
    Weight,
    /// The single particle.
    Single(rules::Single),
}

impl Collisions {
    /// Returns the rule.
    pub fn rule(&self) -> &dyn Rule {
        match self {
            Self::Weight => &rules::Weight,
            Self::Single(rule) => rule,
        }
    }
}
