//! Wrong ways to share what a point from the light and delta tracking find.
//!
//! ```text
//! p = D/(Δθ r²),  q = a σ_t Π (1 − σ_t/σ̂),   X = Σ f(sᵢ) w_i/p_i,   w_i = p_i^β/(p^β + q^β)
//! ```

use super::target::{SINGLE_NULL_PATHS, SINGLE_ONE_SAMPLE, SINGLE_POWER};
use super::{About, Mutant, with};
use estimators::Setup;
use estimators::single_scattering::plan::{Absorption, Vertices};
use estimators::single_scattering::vertices::{Right, Steps, Vertex};
use numeric::{Lane, Span};
use theory::Heuristic;
use theory::problems::{Problem, SingleScattering};
use theory::single::{CameraTracking, Tracking};

/// Shadow rays of all targets.
const SHADOW: Tracking = Tracking::Ratio { sampling: 1.5, control: 0.0 };

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<SingleScattering>> {
    let both = Vertices { camera: CameraTracking::Ratio, collision: Some(Absorption::Analog), ..Vertices::FROM_LIGHT };
    let one = Vertices { is_one: true, ..both };
    let power = Vertices { heuristic: Heuristic::Power, ..both };
    let of = |name, text, target, check, plan: Vertices, bug| {
        let about = About { name, bug: text, target, check };
        let draws = |bug| with(bug, move |&bug, setup, medium, rng| plan.draw((Wrong { bug, setup }, SHADOW), setup, medium, rng));
        Mutant::new(about, draws(bug), draws(Bug::None))
    };
    vec![
        of("null-paths-nulls-left-out", "the density of delta tracking leaves out its null collisions where it was sampled", SINGLE_NULL_PATHS, "mean", both, Bug::NullsLeftOut),
        of("null-paths-by-transmittance", "weights take transmittances for null collisions: unbiased, but another estimator", SINGLE_NULL_PATHS, "variance", both, Bug::ByTransmittance),
        of("null-paths-nothing-scattered", "a point from the light is worth what it is without σ_t there: no event was sampled", SINGLE_NULL_PATHS, "mean", both, Bug::NothingScattered),
        of("null-paths-wrong-end", "the angles of the ray's ends are measured from the wrong one", SINGLE_NULL_PATHS, "mean", both, Bug::WrongEnd),
        of("null-paths-averaged", "both techniques are sampled and added, and their average is taken", SINGLE_NULL_PATHS, "mean", both, Bug::Averaged),
        of("null-paths-shadow-twice", "the shadow ray's transmittance is a weight twice", SINGLE_NULL_PATHS, "mean", both, Bug::ShadowTwice),
        of("null-paths-albedo-twice", "the albedo is the chance to scatter and a factor of what is scattered", SINGLE_NULL_PATHS, "mean", both, Bug::AlbedoTwice),
        of("null-paths-absorbed-go-on", "a walk that is absorbed goes on as after a null collision", SINGLE_NULL_PATHS, "mean", both, Bug::AbsorbedGoOn),
        of("null-paths-scattering-is-null", "the scattering multiplies its own 1 − σ_t/σ̂ to those of the null collisions", SINGLE_NULL_PATHS, "mean", both, Bug::ScatteringIsNull),
        of("null-paths-one-not-doubled", "one technique is chosen and not divided by its chance", SINGLE_ONE_SAMPLE, "mean", one, Bug::Averaged),
        of("null-paths-squared-weights", "the power heuristic squares weights that sum to 1", SINGLE_POWER, "mean", power, Bug::SquaredWeights),
    ]
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Bug {
    None,
    NullsLeftOut,
    ByTransmittance,
    NothingScattered,
    WrongEnd,
    Averaged,
    ShadowTwice,
    AlbedoTwice,
    AbsorbedGoOn,
    ScatteringIsNull,
    SquaredWeights,
}

/// Steps of null-scattering paths with analog absorption, of which a bug makes one wrong.
#[derive(Clone, Copy)]
struct Wrong<'a> {
    bug: Bug,
    setup: &'a Setup<SingleScattering>,
}

impl Steps for Wrong<'_> {
    #[inline(always)]
    fn point<L: Lane>(&self, problem: &SingleScattering, number: L) -> L {
        if self.bug == Bug::WrongEnd {
            let angles = problem.angles();
            return problem.at_angle(-(number * angles.length() + angles.from));
        }
        Right.point(problem, number)
    }

    #[inline(always)]
    fn ends<L: Lane>(&self, real: L::Mask, scattered: L::Mask) -> L::Mask {
        if self.bug == Bug::AbsorbedGoOn { scattered } else { real }
    }

    #[inline(always)]
    fn light<L: Lane>(&self, right: L, _: L) -> L {
        if self.bug == Bug::ShadowTwice { right * right } else { right }
    }

    #[inline(always)]
    fn score<L: Lane>(&self, vertex: Vertex<L>, score: impl Fn(Vertex<L>) -> L) -> L {
        let (Vertex { s, extinction, kept, is_chosen, .. }, problem) =
            (vertex, &*self.setup.problem);
        let one = s.each(1.0);
        let of_collisions =
            |other: L| score(Vertex { kept: L::select(is_chosen, kept, other), ..vertex });
        match self.bug {
            Bug::NullsLeftOut => of_collisions(one),
            Bug::ScatteringIsNull => {
                let sampling = self.setup.sampling.single_value().unwrap_or(f64::NAN);
                of_collisions(kept * (extinction / s.each(sampling)).one_minus())
            }
            Bug::ByTransmittance => {
                let from = problem.medium().support().from;
                let known =
                    s.map(|s| Lane::exp(-problem.medium().optical_depth(Span::new(from, s)).value));
                // The densities take it; a point from the light is worth what was tracked.
                let worth = L::select(is_chosen, kept / known, one);
                score(Vertex { kept: known, ..vertex }) * worth
            }
            Bug::NothingScattered => score(vertex) / L::select(is_chosen, extinction, one),
            Bug::Averaged => score(vertex) * 0.5,
            Bug::AlbedoTwice => score(vertex) * problem.albedo(),
            Bug::SquaredWeights => {
                let collision = extinction * problem.albedo() * kept;
                let point = problem.equiangular_density(s);
                let own = L::select(is_chosen, point, collision);
                let other = L::select(is_chosen, collision, point);
                let sum = own + other;
                score(vertex) * Heuristic::Power.shared(own, other) * own / (sum * sum)
            }
            _ => score(vertex),
        }
    }
}
