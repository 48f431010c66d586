//! Differences so large that no pass may stand beside them, and changes of the mean, in units of the draws' own
//! standard errors.
//!
//! ```text
//! z      (|ȳ| − δ)/√(s²/n), and with V for s² where it is known
//! limit  6(1 + 3/√ν),  ν = n over the sample kurtosis: how many draws carry s²
//! change of blocks a to b against all others:  z = (ȳ_in − ȳ_out)/√(s²(1/n_in + 1/n_out)),  ν for the smaller part
//! ```
//!
//! The limit is no level: it is where counts of rare events, the most skewed draws of a given ν, come with
//! probability 1e-9 or less (a Poisson number of mean λ that is k, ν = k: λ = 106 for k = 50, z = −7.9, limit 8.5). So
//! nothing fails by it. It takes back passes, and it tells a change from a mean that is off from the beginning.

use super::scalar::Scalar;

/// Limit in standard errors where many draws carry the variance.
const PLAIN: f64 = 6.0;
/// Coefficient of 1/√ν in that limit.
const FEW: f64 = 3.0;

/// Factor of the limit where evidence from some draw on refutes the claim, and that of all draws does not.
const HINTED: f64 = 0.6;
/// Factor of the limit for pairs of blocks.
const PAIRS: f64 = 1.1;
/// Maximum number of parts that changes are looked for between.
const MAX_PARTS: usize = 512;
/// Expected number of events of which none comes with probability e⁻²⁰.
const MISSED: f64 = 20.0;

/// A change of the mean.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change {
    /// The first draw of the part that differs most from the others.
    pub from: u64,
    /// The draw after its last one; `None` for the end.
    pub to: Option<u64>,
    /// Mean of y in that part.
    pub off: f64,
    /// Its distance from the mean of all other draws, in standard errors.
    pub z: f64,
}

/// Limit in standard errors, given ν.
fn limit(carry: f64) -> f64 {
    PLAIN * (1.0 + FEW / carry.sqrt())
}

impl Scalar {
    /// Distance of the mean of y from 0 in standard errors, if it is beyond the limit; infinite for draws that are all alike, where the
    /// range or the variance leaves no room for what was not drawn.
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
            let is_plain = n * rare > MISSED || known > limit(1.0);
            return is_plain.then(|| f64::INFINITY.copysign(off));
        }
        let shown = of(self.past.variance());
        (shown.max(known) > limit(carry)).then_some(shown.copysign(off))
    }

    /// The most significant change of the mean, if it is beyond the limit: from a block on, else between two blocks. Where the
    /// mean of all draws does not fail and that of later ones does, less is enough.
    pub(super) fn obvious_change(&self) -> Option<Change> {
        let (n, mean) = (self.past.draws() as f64, self.past.mean());
        let (carry, variance) = (self.past.effective_draws(), self.past.variance());
        let need = if self.has_failed() { 1.0 } else { HINTED };
        // The excess of the blocks so far over their share, beside their number of draws; of many blocks every k-th.
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
            let is_plain = z.abs() > need * limit(carry * share.min(1.0 - share));
            let to = (b < end).then_some(path[b].1);
            is_plain.then(|| Change { from: path[a].1, to, off: mean + excess / inside, z })
        };
        let larger = |a: &Change, b: &Change| a.z.abs().total_cmp(&b.z.abs());
        let from_one_on = (1..end).filter_map(|a| between(a, end, need)).max_by(larger);
        from_one_on.or_else(|| {
            // So many more pairs reach the limit a little more easily.
            let pairs = (1..end).flat_map(|a| (a + 1..end).map(move |b| (a, b)));
            pairs.filter_map(|(a, b)| between(a, b, PAIRS * need)).max_by(larger)
        })
    }
}
