//! How techniques that could have made the same path share it.
//!
//! ```text
//! w_i = p_i^β/Σ p_j^β,  β = 1 (balance) or 2 (power)
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `heuristic` | `"balance"` or `"power"` | `"balance"` |
//!
//! Source: E. Veach, L. Guibas, *Optimally Combining Sampling Techniques for Monte Carlo Rendering*, SIGGRAPH 1995.

use crate::catalogue::Settings;
use crate::numeric::Lane;

/// The power of densities in a weight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Heuristic {
    /// In proportion to their densities.
    Balance,
    /// In proportion to the squares of their densities.
    Power,
}

impl Heuristic {
    /// Reads `heuristic`.
    pub fn read(settings: &Settings) -> Option<Self> {
        let word = settings.word_or("heuristic", &["balance", "power"], "balance")?;
        Some(if word == "power" { Self::Power } else { Self::Balance })
    }

    /// A density to the power of β.
    #[inline(always)]
    pub fn raised<L: Lane>(self, density: L) -> L {
        if self == Self::Power { density * density } else { density }
    }

    /// `p_i/w_i` of one technique beside another one, `(p_i^β + p_j^β)/p_i^{β−1}`: what its samples are divided by.
    #[inline(always)]
    pub fn shared<L: Lane>(self, own: L, other: L) -> L {
        match self {
            Self::Balance => own + other,
            Self::Power => (own * own + other * other) / own,
        }
    }
}
