//! Which constant σ̂ is best.
//!
//! The figure of merit is `1/(V · E[M])`. An estimator that may end early has a finite optimum,
//! found by a one-dimensional search on log σ̂. The double particle has none: its figure of merit
//! rises towards the limit `1/(T² S ∫residual²)`, and what is reported is where it reaches 90 %.
//!
//! Source: Szirmay-Kalos et al. 2017, section 3.4, with the cost of the walk added.

use super::Prediction;
use crate::numeric::roots;

/// The best constant σ̂ and the figure of merit there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Optimum {
    /// σ̂, 1/length.
    pub sampling: f64,
    /// `1/(V · E[M])` there.
    pub figure_of_merit: f64,
}

/// Steps of the first, coarse search over σ̂/scale from 1e-2 to 1e3.
const COARSE: usize = 51;

/// Searches the constant σ̂ with the largest figure of merit around `scale`, the largest residual.
///
/// `predict` answers `None` where the estimator is refused. Where the figure of merit still rises
/// at the upper end, it is followed by factors of ten until it gains less than 0.1 %, and the answer
/// is the σ̂ that reaches 90 % of that limit.
pub fn best_constant(scale: f64, predict: impl Fn(f64) -> Option<Prediction>) -> Option<Optimum> {
    if scale.is_nan() || scale <= 0.0 {
        return None;
    }
    let merit =
        |log: f64| predict(scale * log.exp()).and_then(|p| p.figure_of_merit()).unwrap_or(0.0);
    let (low, high) = (1e-2f64.ln(), 1e3f64.ln());
    let step = (high - low) / (COARSE - 1) as f64;
    let coarse: Vec<f64> = (0..COARSE).map(|i| merit(low + step * i as f64)).collect();
    let (best, &largest) = coarse.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    if largest <= 0.0 {
        return None;
    }
    let at = |i: usize| low + step * i as f64;
    let log = if best == COARSE - 1 {
        let (far, limit) = limit(high, largest, merit);
        let below = coarse.iter().rposition(|&fom| fom < 0.9 * limit)?;
        let above = if below + 1 < COARSE { at(below + 1) } else { far };
        roots::root(at(below), above, |log| merit(log) - 0.9 * limit)
    } else {
        // A refused neighbour (figure of merit 0) is a cliff that golden sections walk up to.
        roots::minimum(at(best.saturating_sub(1)), at(best + 1), 1e-7, |log| -merit(log))
    };
    Some(Optimum { sampling: scale * log.exp(), figure_of_merit: merit(log) })
}

/// Follows a rising figure of merit to its limit.
fn limit(from: f64, reached: f64, merit: impl Fn(f64) -> f64) -> (f64, f64) {
    let (mut log, mut best) = (from, reached);
    for _ in 0..8 {
        let further = merit(log + 10f64.ln());
        if further <= best * 1.001 {
            break;
        }
        (log, best) = (log + 10f64.ln(), further);
    }
    (log, best)
}
