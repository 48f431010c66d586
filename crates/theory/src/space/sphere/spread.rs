//! Bounds on `E[X²]` of walks that find light by several techniques.
//!
//! A walk scores at each of its vertices x, which are scatterings and the place of a mean intensity. N is the score
//! of its shadow ray; C of its connection with a vertex of the light, if there are such; H of the hit that ends its
//! next flight. R is the score of all that comes later, H included. h̄ and J are the light that arrives at x
//! without a scattering, and in all. In units of the weight w, N, C and the walk are independent given x, hence
//!
//! ```text
//! E[X²] = unscattered + E[Σ w² (E[N²] + E[C²] + E[H²] + 2 n (J' − n) + 2 c (J' − n − c))]
//! n = E[N],  c = E[C],  J' = n + c + E[R] ≤ J,  n + E[H] ≤ h̄,  w² ≤ w
//! ```
//!
//! With q = Ω/4π the light's share of all directions as seen from x, and `E[T̂²] ≤ G T` of a tracked transmittance:
//!
//! | techniques | n | `E[N²] + E[H²]` | c |
//! |---|---|---|---|
//! | next event | h̄ | G q h̄ | 0 |
//! | directional | h̄/(1 + q^β) | `(G q + q^2β) h̄/(1 + q^β)²` | 0 |
//! | full | from `h̄/(1 + q^β)` to h̄ | `m(q) h̄` at most | 0 |
//! | bidirectional | up to h̄ | `m(q) h̄` at most, `E[C²] ≤ m(largest q) c` | up to J − h̄ |
//!
//! `m(q) = q/(1 + q^β)` is the maximum score of a sample of the walk or of its shadow ray in their combination.
//! With connections and the power heuristic it is half of `q/√(1 + q²)`. Unknown quantities take their worst
//! values. For walks of weight 0 or 1 the bounds of next event and directional with `G = 1` are equalities. All
//! sums are answers of Peierls' equation. A distant light is not uniform: `n ≤ q` there instead of h̄. It has
//! shadow rays only, and no bound for connections.

use crate::light::{Densities, Heuristic};

/// Techniques that find light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Techniques {
    /// Shadow rays, and unscattered light.
    NextEvent,
    /// Shadow rays and hits.
    Mis(Densities, Heuristic),
    /// Connections with vertices of the light, too, each with one of its own.
    Bidirectional(Heuristic),
}

use Heuristic::{Balance, Power};

impl Techniques {
    /// All techniques.
    pub const ALL: [Self; 7] = [
        Self::NextEvent,
        Self::Mis(Densities::Directional, Balance),
        Self::Mis(Densities::Directional, Power),
        Self::Mis(Densities::Full, Balance),
        Self::Mis(Densities::Full, Power),
        Self::Bidirectional(Balance),
        Self::Bidirectional(Power),
    ];

    /// Contribution of a vertex to `E[X²]`: the part of tracked shadow rays, to be multiplied by G, and the rest.
    pub(super) fn scores(self, at: &VertexBound) -> [f64; 2] {
        let &VertexBound { share, direct, all, .. } = at;
        let later = |n: f64| 2.0 * n * (all - n).max(0.0);
        match self {
            Self::NextEvent => [share * direct, later(direct)],
            Self::Mis(Densities::Directional, heuristic) => {
                let raised = heuristic.raised(share);
                let scale = direct / ((1.0 + raised) * (1.0 + raised));
                [share * scale, raised * raised * scale + later(direct / (1.0 + raised))]
            }
            Self::Mis(Densities::Full, heuristic) => {
                let raised = heuristic.raised(share);
                let n = (0.5 * all).clamp(direct / (1.0 + raised), direct);
                [0.0, share / (1.0 + raised) * direct + later(n)]
            }
            Self::Bidirectional(heuristic) => [0.0, connected(heuristic, at)],
        }
    }
}

/// Quantities of a vertex.
#[derive(Debug, Clone, Copy)]
pub(super) struct VertexBound {
    /// q, the solid angle of the light as a fraction of 4π.
    pub share: f64,
    /// The largest q anywhere.
    pub largest: f64,
    /// h̄, the light that arrives without a scattering.
    pub direct: f64,
    /// J, all light that arrives.
    pub all: f64,
}

/// Maximum score of one of several samples.
fn most(heuristic: Heuristic, share: f64) -> f64 {
    match heuristic {
        Balance => share / (1.0 + share),
        // p/(p² + 1 + 1/q²) is largest where its terms are equal.
        Power => 0.5 * share / (1.0 + share * share).sqrt(),
    }
}

/// `m(q) h̄ + m(largest) c + 2 n (J − n) + 2 c (J − n − c)` where it is largest, a concave function on a rectangle.
fn connected(heuristic: Heuristic, at: &VertexBound) -> f64 {
    let &VertexBound { share, largest, direct, all } = at;
    // Without a connection a shadow ray may score more.
    let of_shadow = share / (1.0 + heuristic.raised(share));
    let of_connection = most(heuristic, largest);
    let (mut n, mut c) = (direct, 0.0);
    // Each step leaves a quarter of the distance to the top.
    for _ in 0..30 {
        n = (0.5 * (all - c)).clamp(0.0, direct);
        c = (0.5 * (all - n) + 0.25 * of_connection).clamp(0.0, (all - direct).max(0.0));
    }
    let later = 2.0 * n * (all - n) + 2.0 * c * (all - n - c);
    of_shadow * direct + of_connection * c + later.max(0.0)
}

/// Parts of a bound on `E[X²]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Unscattered light.
    pub unscattered: f64,
    /// Contribution of shadow rays alone, with untracked transmittances.
    pub lit: f64,
    /// All other contributions.
    pub rest: f64,
}

impl Spread {
    /// The bound on `E[X²]`, given a bound on `E[T̂²]/T`.
    pub fn square(&self, gain: f64) -> f64 {
        self.unscattered + gain * self.lit + self.rest
    }
}

/// Bounds for all techniques.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spreads(pub [Spread; Techniques::ALL.len()]);

impl Spreads {
    /// Joins the bounds of three solutions, number by number.
    pub(super) fn joined(three: &[Self; 3], join: impl Fn([f64; 3]) -> f64) -> Self {
        Self(std::array::from_fn(|i| {
            let number = |of: fn(&Spread) -> f64| join(three.each_ref().map(|each| of(&each.0[i])));
            Spread {
                unscattered: number(|spread| spread.unscattered),
                lit: number(|spread| spread.lit),
                rest: number(|spread| spread.rest),
            }
        }))
    }

    /// Bound for some techniques.
    pub fn of(&self, techniques: Techniques) -> Spread {
        let index = Techniques::ALL.iter().position(|&each| each == techniques);
        self.0[index.unwrap_or_default()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thin_medium_under_an_even_sky_is_a_hand_value() {
        // All light arrives unscattered: h̄ = J = 1 and q = 1, half by hits and half by shadow rays.
        let at = VertexBound { share: 1.0, largest: 1.0, direct: 1.0, all: 1.0 };
        let square = |techniques: Techniques| techniques.scores(&at).iter().sum::<f64>();
        assert!((square(Techniques::NextEvent) - 1.0).abs() < 1e-15);
        for heuristic in [Balance, Power] {
            // X = ½ + ½ in every draw.
            for densities in [Densities::Directional, Densities::Full] {
                assert!((square(Techniques::Mis(densities, heuristic)) - 1.0).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn the_worst_split_is_found() {
        let at = VertexBound { share: 0.4, largest: 0.5, direct: 0.3, all: 0.9 };
        for heuristic in [Balance, Power] {
            let result = connected(heuristic, &at);
            let (shadow, connection) = (0.4 / (1.0 + heuristic.raised(0.4)), most(heuristic, 0.5));
            let mut largest = 0.0f64;
            for i in 0..=300 {
                for j in 0..=300 {
                    let (n, c) = (0.3 * f64::from(i) / 300.0, 0.6 * f64::from(j) / 300.0);
                    let later = 2.0 * n * (0.9 - n) + 2.0 * c * (0.9 - n - c);
                    largest = largest.max(shadow * 0.3 + connection * c + later);
                }
            }
            assert!(
                (result - largest).abs() < 1e-4 && result > largest - 1e-12,
                "{result} {largest}"
            );
        }
    }

    #[test]
    fn what_a_sample_is_worth_has_its_top() {
        for share in [0.1, 0.5, 1.0] {
            let power = |p: f64| p / (p * p + 1.0 + 1.0 / (share * share));
            let largest = (1..100_000).map(|i| power(0.001 * f64::from(i))).fold(0.0, f64::max);
            assert!((most(Power, share) - largest).abs() < 1e-6);
            let balance = 1.0 / (1.0 + 1.0 / share);
            assert!((most(Balance, share) - balance).abs() < 1e-15);
        }
    }
}
