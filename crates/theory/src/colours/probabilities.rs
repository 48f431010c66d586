//! Event probabilities of spectral tracking: a collision has one outcome for all channels.
//!
//! ```text
//! P_e = mean_λ μ_e,λ/μ̄,   P_e ∝ max_λ μ_e,λ,   P_e ∝ Σ_λ w_λ μ_e,λ,   events e null, scattered, absorbed
//! ```
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), sections 5.1.1 and 5.1.2.

use numeric::Lane;

/// Choice of the next event of spectral tracking, independent of earlier events.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Chance {
    /// In transmittance: `P_n` = mean over the channels of `n/μ̄`.
    Average,
    /// In transmittance: `P_n = max n/(max n + max σ)`.
    Maximum,
}

impl Chance {
    /// `P_n`, given `n/μ̄` of each channel.
    #[inline(always)]
    pub fn of_null<L: Lane>(self, shares: &[L]) -> L {
        let (zero, one) = (shares[0].each(0.0), shares[0].each(1.0));
        match self {
            Self::Average => {
                let mut sum = zero;
                for &share in shares {
                    sum = sum + share;
                }
                sum / one.each(shares.len() as f64)
            }
            Self::Maximum => {
                let (mut maximum, mut minimum) = (zero, one);
                for &share in shares {
                    maximum = maximum.or_more(share);
                    minimum = minimum.or_less(share);
                }
                maximum / (maximum + (one - minimum))
            }
        }
    }
}

/// Choice of the event at a collision of spectral tracking.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Chances {
    /// Probabilities that do not depend on earlier events.
    Fixed(Chance),
    /// Means over the channels, weighted by the present weight of each.
    History,
}

impl Chances {
    /// The word in case files and tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Fixed(Chance::Average) => "average",
            Self::Fixed(Chance::Maximum) => "maximum",
            Self::History => "history",
        }
    }

    /// Probabilities of events, given `μ_e/μ̄` and the weight of each of `count` channels: to go straight on, to be
    /// scattered and to be absorbed.
    #[inline(always)]
    #[expect(
        clippy::needless_range_loop,
        reason = "loops of kernels count: iterators may not be inlined there"
    )]
    pub fn of_events<L: Lane>(
        self,
        count: usize,
        shares: impl Fn(usize) -> [L; 3],
        weights: &[L],
    ) -> [L; 3] {
        let [mut null, mut scattered, mut absorbed] = [weights[0].each(0.0); 3];
        for channel in 0..count {
            let [n, s, a] = shares(channel);
            match self {
                Self::Fixed(Chance::Average) => {
                    (null, scattered, absorbed) = (null + n, scattered + s, absorbed + a);
                }
                Self::Fixed(Chance::Maximum) => {
                    (null, scattered) = (null.or_more(n), scattered.or_more(s));
                    absorbed = absorbed.or_more(a);
                }
                Self::History => {
                    let weight = weights[channel];
                    (null, scattered) = (null + weight * n, scattered + weight * s);
                    absorbed = absorbed + weight * a;
                }
            }
        }
        let sum = null + scattered + absorbed;
        [null / sum, scattered / sum, absorbed / sum]
    }
}

/// `μ_e/μ̄` of a channel, given `σ_t/σ̂` and the albedo: null, scattered, absorbed.
#[inline(always)]
pub fn shares<L: Lane>(ratio: L, albedo: f64) -> [L; 3] {
    let (one, albedo) = (ratio.each(1.0), ratio.each(albedo));
    [one - ratio, ratio * albedo, ratio * (one - albedo)]
}
