//! Bidirectional path tracing in a rod: the share of the light that each technique finds, and its moments.
//!
//! A path with r scatterings at the optical depths `u₁ … u_r` has the contribution f. The technique that makes its
//! first s vertices from the light and the others from the sensor has the density `p_s`. The lengths `d_j` are
//! those of the segments, `j = 0 … r`, and ρ is `p_f` or `1 − p_f` at each turn:
//!
//! ```text
//! f = ∏ᵢ a ρᵢ · ∏ⱼ e^{−d_j},   c_s = f/p_s = 1 for s = 0 and s = r + 2, else
//! c_s = T̂_{s−1} [a ρ_{s−1}]_{s≥2} [a ρ_s]_{s≤r},   T̂ⱼ = e^{−dⱼ}, or ∏ (1 − σ_t/σ̂) over its null vertices
//! X_s = w_s c_s,   E[X_s^k] = ∫ p_s X_s^k = ∫ f w_s^k c_s^{k−1},   Σ w_s = 1
//! ```
//!
//! | weights | `w_s ∝` |
//! |---|---|
//! | one technique | 1 for that, 0 for all others |
//! | directional | `c′_s^{−β}`, `c′_s` = `c_s` without a and T̂ |
//! | full | `c_s^{−β}` |
//!
//! β = 1 is the balance heuristic, β = 2 the power heuristic. Everything depends on the medium by its optical
//! depth only, as long as connections are exact or `σ_t/σ̂` is one number.
//!
//! Where a draw has an independent path for each technique, moments of sums follow from those of the techniques.
//! Renderers connect every vertex of one light subpath with every vertex of one camera subpath. The contribution of
//! a technique then has the same distribution. But the covariances of techniques that share vertices are not known,
//! nor is the variance of their sum. Its square root is at most the sum of the techniques' standard deviations.
//!
//! Source: E. Veach, L. Guibas, *Optimally Combining Sampling Techniques for Monte Carlo Rendering*, SIGGRAPH
//! 1995; B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light Transport*,
//! ACM Transactions on Graphics 38 (2019), sections 5.1, 5.2 and 5.5, Eqs. 42–44. The moments are derived here.

pub mod full;
pub mod grid;
pub mod lookups;
pub mod paths;
mod predict;

use std::ops::RangeInclusive;

use self::grid::NodeGrid;
use crate::light::Heuristic;
use crate::prediction::raw::{HIGHEST, Powers};
use numeric::{Known, Lane};

pub use predict::predict;

/// A rod, with the orders of its paths.
#[derive(Debug, Clone)]
pub struct RodScene {
    /// τ.
    pub depth: Known,
    /// a.
    pub albedo: f64,
    /// `p_f`.
    pub forward: f64,
    /// True if the sensor is at the end, not at the light.
    pub is_transmitted: bool,
    /// Numbers of scatterings.
    pub orders: RangeInclusive<usize>,
}

impl RodScene {
    /// ρ of a scattering that goes straight on or turns.
    pub fn phase(&self, turns: bool) -> f64 {
        if turns { 1.0 - self.forward } else { self.forward }
    }
}

/// Estimate of the transmittance of a connection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Connection {
    /// In closed form.
    Exact,
    /// By ratio tracking, with this value of `σ_t/σ̂`; weights depend on the null vertices of all segments.
    Ratio(f64),
}

impl Connection {
    /// The values of `1/T̂` over the null vertices of a segment of a path, each with its probability times
    /// `e^{−d}`.
    ///
    /// ```text
    /// T̂ = (1 − σ_t/σ̂)^m,   m Poisson of mean d (σ̂/σ_t − 1)
    /// ```
    fn transmittances(self, depth: f64) -> impl Iterator<Item = [f64; 2]> {
        let (nulls, first, step) = match self {
            Self::Exact => (0.0, depth.exp(), 1.0),
            Self::Ratio(ratio) => (depth * (1.0 - ratio) / ratio, 1.0, 1.0 / (1.0 - ratio)),
        };
        let all = std::iter::successors(
            Some((1.0, [(-depth - nulls).exp(), first])),
            move |&(m, [probability, inverse])| {
                Some((m + 1.0, [probability * nulls / m, inverse * step]))
            },
        );
        all.map(|(_, term)| term).take_while(|[probability, _]| *probability > 0.0)
    }

    /// `e^{−d} E[T̂^{k−1}]`.
    fn power(self, depth: f64, k: usize) -> f64 {
        match self {
            Self::Exact => (-(k as f64) * depth).exp(),
            Self::Ratio(ratio) => {
                let kept = (1.0 - ratio).powf((k - 1) as f64);
                (-depth - depth * (1.0 - ratio) / ratio * (1.0 - kept)).exp()
            }
        }
    }
}

impl Heuristic {
    /// The share of technique s in a path of r scatterings, by `f/p` of each technique.
    #[inline(always)]
    pub fn share<L: Lane>(self, s: usize, order: usize, quotient: impl Fn(usize) -> L) -> L {
        let mut own = self.density(quotient(0));
        let mut all = own;
        for j in 1..order + 3 {
            let density = self.density(quotient(j));
            all = all + density;
            own = if j == s { density } else { own };
        }
        own / all
    }

    #[inline(always)]
    fn density<L: Lane>(self, quotient: L) -> L {
        self.raised(quotient.each(1.0) / quotient)
    }
}

/// `c_s`, by `T̂ⱼ` of each segment and `a ρᵢ` of each scattering, `i = 1 … r`.
#[inline(always)]
pub fn quotient<L: Lane>(
    s: usize,
    order: usize,
    transmittance: impl Fn(usize) -> L,
    scattered: impl Fn(usize) -> L,
) -> L {
    let one = transmittance(0).each(1.0);
    if s == 0 || s == order + 2 {
        return one;
    }
    let light = if s >= 2 { scattered(s - 1) } else { one };
    let camera = if s <= order { scattered(s) } else { one };
    transmittance(s - 1) * light * camera
}

/// Weights of techniques beside each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Combination {
    /// A single technique, with this number of light vertices.
    Technique(usize),
    /// All, by multiple importance sampling with densities of directions only.
    Directional(Heuristic),
    /// All, by multiple importance sampling with the densities of whole paths.
    Full(Heuristic),
}

impl Combination {
    /// The numbers of light vertices of its techniques at one order.
    pub fn techniques(self, order: usize) -> RangeInclusive<usize> {
        match self {
            Self::Technique(s) if s <= order + 2 => s..=s,
            #[allow(clippy::reversed_empty_ranges)] // there is none
            Self::Technique(_) => 1..=0,
            _ => 0..=order + 2,
        }
    }

    /// The weight of a technique, given the phase function at each scattering; 1 where the weight depends on more.
    #[inline(always)]
    pub fn weight(self, phase: &[f64], s: usize) -> f64 {
        let Self::Directional(heuristic) = self else { return 1.0 };
        let order = phase.len();
        heuristic.share(s, order, |j| quotient(j, order, |_| 1.0, |i| phase[i - 1]))
    }
}

/// Rules by which a draw is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawRules {
    /// Techniques and their weights.
    pub combination: Combination,
    /// Estimate of the transmittance of connections.
    pub connection: Connection,
    /// True if all techniques share one walk from the light and one from the sensor.
    pub is_shared: bool,
    /// True if techniques are channels beside their sum.
    pub has_shares: bool,
}

/// `E[0^k]`.
const NOTHING: Powers = {
    let mut powers = [0.0; HIGHEST + 1];
    powers[0] = 1.0;
    powers
};

/// `E[X_s^k]` of every technique that is drawn, order by order.
fn powers(scene: &RodScene, rules: &DrawRules, [size, step]: [f64; 2]) -> Vec<Powers> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a small whole number
    let grid = NodeGrid::new(scene.depth.value, size as usize);
    let none = |order: usize| vec![NOTHING; order + 3];
    let mut by_order: Vec<Vec<Powers>> = scene.orders.clone().map(none).collect();
    match rules.combination {
        Combination::Full(heuristic) => {
            full::add(scene, (rules.connection, heuristic), &grid, step, &mut by_order);
        }
        _ => paths::add(scene, rules, &grid, &mut by_order),
    }
    let drawn = |(order, powers): (usize, Vec<Powers>)| {
        let techniques = rules.combination.techniques(order);
        techniques.map(move |s| powers[s]).collect::<Vec<_>>()
    };
    scene.orders.clone().zip(by_order).flat_map(drawn).collect()
}
