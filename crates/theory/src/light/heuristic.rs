//! Weights of techniques that could have made the same path.
//!
//! ```text
//! w_i = p_i^β/Σ p_j^β,  β = 1 (balance) or 2 (power)
//! ```
//!
//! Source: E. Veach, L. Guibas, *Optimally Combining Sampling Techniques for Monte Carlo Rendering*, SIGGRAPH 1995.

use numeric::Lane;

/// The power of densities in a weight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Heuristic {
    /// In proportion to their densities.
    Balance,
    /// In proportion to the squares of their densities.
    Power,
}

impl Heuristic {
    /// A density to the power of β.
    #[inline(always)]
    pub fn raised<L: Lane>(self, density: L) -> L {
        if self == Self::Power { density * density } else { density }
    }

    /// `p_i/w_i` of one technique beside another one, `(p_i^β + p_j^β)/p_i^{β−1}`: the divisor of its samples.
    #[inline(always)]
    pub fn shared<L: Lane>(self, own: L, other: L) -> L {
        match self {
            Self::Balance => own + other,
            Self::Power => (own * own + other * other) / own,
        }
    }

    /// The weight of one of several techniques, given the densities of all of them for the same path, in any unit.
    /// The density of technique `own` is positive.
    #[inline(always)]
    pub fn weight<L: Lane, const N: usize>(self, own: usize, densities: [L; N]) -> L {
        let one = densities[own].each(1.0);
        let mut sum = one;
        for (technique, density) in densities.into_iter().enumerate() {
            // An infinite density stays infinite relative to its own.
            if technique != own {
                sum = sum + self.raised(density / densities[own]);
            }
        }
        one / sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_of_all_techniques_sum_to_one() {
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            for densities in [[1.0, 3.0, 0.25], [0.0, 2.0, 7.0], [1.0, 1.0, 0.0]] {
                let own = (0..3).filter(|&own| densities[own] > 0.0);
                let sum: f64 = own.map(|own| heuristic.weight(own, densities)).sum();
                assert!((sum - 1.0).abs() < 1e-15);
            }
            assert_eq!(heuristic.weight(0, [1.0, f64::INFINITY]), 0.0);
            assert_eq!(heuristic.weight(1, [1.0, f64::INFINITY]), 1.0);
        }
        assert!((Heuristic::Power.weight(1, [1.0, 3.0]) - 0.9).abs() < 1e-15);
    }
}
