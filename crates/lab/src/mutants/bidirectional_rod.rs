//! Wrong bidirectional path tracing in a rod.
//!
//! ```text
//! X = Σ_s w_s c_s,   c_s = f/p_s = T̂_{s−1} [a ρ_{s−1}]_{s≥2} [a ρ_s]_{s≤r},   w_s = c_s⁻¹/Σⱼ cⱼ⁻¹
//! ```
//!
//! Connections through media were 12 % off in pbrt-v3 (issue 179), and wrong in pbrt-v4 (issues 83, 325). Numbers of equations are those of B. Miller, I. Georgiev,
//! W. Jarosz, *A null-scattering path integral formulation of light transport*, ACM Transactions on Graphics 38 (2019).

use super::{Mutant, MutantRow, On, family, on, one_by_one};
use estimators::bidirectional_rod::Method;
use estimators::bidirectional_rod::path::Path;
use estimators::bidirectional_rod::subpath::RodTracker;
use estimators::bidirectional_rod::walk::{OneLane, make_paths};
use estimators::{Draw, Setup};
use gate::CheckId;
use media::Lookups;
use media::sampling::FlightWithGaps;
use numeric::fused::compiled_once;
use numeric::rng::Stream;
use numeric::{Lane, Span};
use theory::light::Heuristic;
use theory::problems::bidirectional_rod::{BidirectionalValues, MAX_CHANNELS};
use theory::problems::{BidirectionalRod, Problem};
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
const LINES: &[MutantRow<Method, Bug>] = &[
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
        one_by_one(move |setup, medium, random| {
            compiled_once(
                #[inline(always)]
                || wrong.draw(setup, medium, random),
            )
        })
    })
}

/// An estimator with one bug.
#[derive(Clone, Copy)]
struct Wrong {
    page: Method,
    bug: Bug,
}

impl Wrong {
    /// Makes a draw: the values of all techniques, and their sum.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
    fn draw(
        &self,
        setup: &Setup<BidirectionalRod>,
        medium: &Lookups,
        random: &mut Stream,
    ) -> Draw<BidirectionalValues> {
        let (problem, beginning) = (&*setup.problem, *random);
        let mut values = BidirectionalValues { at: [0.0; MAX_CHANNELS], count: 0 };
        // σ̂ of the case has one value.
        let Some(sampling) = setup.fields.sampling.with_gaps() else {
            return Draw::free(values, 0);
        };
        let begin = FlightWithGaps::new(0.0, sampling);
        let mut tracker = RodTracker::new(setup, 0.0, [begin, begin.from_end()], OneLane(medium));
        for order in problem.orders.clone() {
            for s in self.page.combination.techniques(order) {
                if self.bug == Bug::SameNumbers {
                    *random = beginning;
                }
                let has_path = make_paths(self.page, &mut tracker, [order, s], true, random);
                if self.bug == Bug::WrongSegment && s >= 2 {
                    let [a, b] = [tracker.path.at[s - 2], tracker.path.at[s]];
                    let passed = problem.medium().optical_depth(Span::new(a.min(b), a.max(b)));
                    tracker.path.transmittance[s - 1] = Lane::exp(-passed.value);
                }
                if has_path {
                    values.at[values.count] = self.value(&tracker.path);
                }
                values.count += 1;
            }
        }
        let each = &values.at[..values.count];
        let sum: f64 = each.iter().sum();
        let sum = match self.bug {
            Bug::Twice => sum + each[1],
            Bug::Averaged => sum / each.len() as f64,
            _ => sum,
        };
        values.at[values.count] = sum;
        values.count += 1;
        Draw::free(values, tracker.lookups as u32)
    }

    /// The value of a path.
    fn value(&self, path: &Path<f64>) -> f64 {
        let (value, s) = (self.page.value(path), path.light);
        let is_hit = |j: usize| j == 0 || j == path.order + 2;
        let techniques = 0..path.order + 3;
        let connection = if is_hit(s) { 1.0 } else { path.transmittance[s - 1] };
        match self.bug {
            Bug::VertexCount if (1..=path.order).contains(&s) => {
                value / (path.phase[s - 1] * path.albedo)
            }
            Bug::Reversed if (1..=path.order).contains(&s) => {
                value * path.phase[s - 1].one_minus() / path.phase[s - 1]
            }
            Bug::HitsWithoutDensity => {
                1.0 / techniques
                    .filter(|&j| !is_hit(j))
                    .map(|j| 1.0 / path.quotient(j))
                    .sum::<f64>()
            }
            Bug::NullsInOne => {
                // The inverse of `cⱼ` with null vertices in the path's own technique only.
                let nulls = |i: usize| if i + 1 == s { path.transmittance[i] } else { 1.0 };
                let scattered = |i: usize| path.phase[i - 1] * path.albedo;
                let density = |j| 1.0 / quotient(j, path.order, nulls, scattered);
                density(s) / techniques.map(density).sum::<f64>() * path.quotient(s)
            }
            Bug::TrackedTwice => value * connection,
            Bug::DirectionalDensity => value / connection,
            _ => value,
        }
    }
}
