//! Wrong bidirectional path tracing in a rod.
//!
//! ```text
//! X = Σ_s w_s c_s,   c_s = f/p_s = T̂_{s−1} [a ρ_{s−1}]_{s≥2} [a ρ_s]_{s≤r},   w_s = c_s⁻¹/Σⱼ cⱼ⁻¹
//! ```
//!
//! Connections through media were 12 % off in pbrt-v3 (issue 179), and wrong in pbrt-v4 (issues 83, 325). Numbers of equations are those of B. Miller, I. Georgiev,
//! W. Jarosz, *A null-scattering path integral formulation of light transport*, ACM Transactions on Graphics 38 (2019).

use super::{Line, Mutant, On, family, on, one_by_one};
use estimators::bidirectional_rod::Method;
use estimators::bidirectional_rod::path::Path;
use estimators::bidirectional_rod::walk::{self, WalkEvents};
use gate::CheckId;
use numeric::Lane;
use theory::light::Heuristic;
use theory::problems::BidirectionalRod;
use theory::rod::bidirectional::{Combination, quotient};

/// Both orders of a rod by all techniques, exact connections.
const FULL: On<Method> =
    on("rod/bidirectional-known-bugs", 0, page(Combination::Full(Heuristic::Balance), false));
/// Ratio-tracked connections.
const TRACKED: On<Method> =
    on("rod/bidirectional-known-bugs", 1, page(Combination::Full(Heuristic::Balance), true));
/// Directional weights.
const DIRECTIONAL: On<Method> = on(
    "rod/bidirectional-known-bugs",
    2,
    page(Combination::Directional(Heuristic::Balance), false),
);
/// One technique: a connection between two scatterings.
const TECHNIQUE: On<Method> =
    on("rod/bidirectional-known-bugs", 3, page(Combination::Technique(2), false));

const fn page(combination: Combination, is_tracked: bool) -> Method {
    Method { combination, is_tracked, is_shared: false }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Bug {
    None,
    VertexCount,
    Reversed,
    WrongSegment,
    HitsWithoutDensity,
    Twice,
    Averaged,
    SameNumbers,
    NullsInOne,
    TrackedTwice,
    DirectionalDensity,
}

#[rustfmt::skip] // one mutant, one entry
const LINES: &[Line<Method, Bug>] = &[
    ("bidirectional-vertex-count", "the density of a technique counts one camera vertex too many: a ρ_s is left out", TECHNIQUE, CheckId::Mean, Bug::VertexCount),
    ("bidirectional-connection-reversed", "the phase function at the camera's end takes the connection the wrong way round (Eq. 43)", TECHNIQUE, CheckId::Mean, Bug::Reversed),
    ("bidirectional-wrong-segment", "the connection is tracked from the light's last vertex but one (middle factor of Eq. 44)", TECHNIQUE, CheckId::Mean, Bug::WrongSegment),
    ("bidirectional-hits-without-density", "weights take the densities of the hits, s = 0 and s = r + 2, for zero, and hits score all the same", FULL, CheckId::Mean, Bug::HitsWithoutDensity),
    ("bidirectional-technique-twice", "one technique is counted twice in the sum", FULL, CheckId::Mean, Bug::Twice),
    ("bidirectional-averaged", "techniques are averaged instead of added", FULL, CheckId::Mean, Bug::Averaged),
    ("bidirectional-same-numbers", "all techniques of a draw begin with the same random numbers", FULL, CheckId::Covariance, Bug::SameNumbers),
    ("bidirectional-nulls-in-one-density", "null vertices are in the density of a path's own technique only", TRACKED, CheckId::Mean, Bug::NullsInOne),
    ("bidirectional-tracked-twice", "the tracked transmittance of a connection multiplies its worth twice", TRACKED, CheckId::Mean, Bug::TrackedTwice),
    ("bidirectional-directional-density", "paths are divided by their directional densities, too: the transmittance of a connection cancels", DIRECTIONAL, CheckId::Mean, Bug::DirectionalDensity),
];

/// The family.
pub fn mutants() -> Vec<Mutant<BidirectionalRod>> {
    family(LINES, &Bug::None, |&page, &bug| {
        let wrong = Wrong { page, bug };
        one_by_one(move |setup, medium, random| walk::draw(&wrong, setup, medium, random))
    })
}

/// An estimator with one bug.
#[derive(Clone, Copy)]
struct Wrong {
    page: Method,
    bug: Bug,
}

impl Wrong {
    /// `a ρ` at the camera's end of the connection.
    fn camera<L: Lane>(path: &Path<L>) -> L {
        let s = path.light;
        let one = path.at[0].each(1.0);
        if (1..=path.order).contains(&s) { path.phase[s - 1] * path.albedo } else { one }
    }

    /// `T̂` of the connection.
    fn connection<L: Lane>(path: &Path<L>) -> L {
        let s = path.light;
        let one = path.at[0].each(1.0);
        if (1..=path.order + 1).contains(&s) { path.transmittance[s - 1] } else { one }
    }

    /// The inverse of `cⱼ` with null vertices in the path's own technique only.
    fn density<L: Lane>(path: &Path<L>, j: usize) -> L {
        let one = path.at[0].each(1.0);
        let of = |i: usize| if i + 1 == path.light { path.transmittance[i] } else { one };
        one / quotient(j, path.order, of, |i| path.phase[i - 1] * path.albedo)
    }

    fn sum<L: Lane>(path: &Path<L>, terms: impl Iterator<Item = L>) -> L {
        terms.fold(path.at[0].each(0.0), |sum, term| sum + term)
    }
}

impl WalkEvents for Wrong {
    fn combination(&self) -> Combination {
        self.page.combination
    }

    fn is_tracked(&self) -> bool {
        self.page.is_tracked
    }

    fn is_shared(&self) -> bool {
        self.page.is_shared
    }

    fn begin<R: Copy>(&self, random: &mut R, beginning: &R) {
        if self.bug == Bug::SameNumbers {
            *random = *beginning;
        }
    }

    fn joined<L: Lane>(&self, path: &Path<L>) -> usize {
        let is_wrong = self.bug == Bug::WrongSegment && path.light >= 2;
        path.light - if is_wrong { 2 } else { 1 }
    }

    fn weight<L: Lane>(&self, path: &Path<L>) -> L {
        let (weight, s) = (self.page.weight(path), path.light);
        let is_hit = |j: usize| j == 0 || j == path.order + 2;
        let one = weight.each(1.0);
        match self.bug {
            Bug::VertexCount => weight / Self::camera(path),
            Bug::Reversed if (1..=path.order).contains(&s) => {
                weight * path.phase[s - 1].one_minus() / path.phase[s - 1]
            }
            Bug::HitsWithoutDensity => {
                let others = (0..path.order + 3).filter(|&j| !is_hit(j));
                one / Self::sum(path, others.map(|j| one / path.quotient(j)))
            }
            Bug::NullsInOne => {
                let all = Self::sum(path, (0..path.order + 3).map(|j| Self::density(path, j)));
                Self::density(path, s) / all * path.quotient(s)
            }
            Bug::TrackedTwice => weight * Self::connection(path),
            Bug::DirectionalDensity => weight / Self::connection(path),
            _ => weight,
        }
    }

    fn together<L: Lane>(&self, each: &[L]) -> L {
        let sum = self.page.together(each);
        match self.bug {
            Bug::Twice => sum + each[1],
            Bug::Averaged => sum / sum.each(each.len() as f64),
            _ => sum,
        }
    }
}
