//! Mistakes of single scattering, by points from the light and by delta tracking.
//!
//! ```text
//! points from the light     X = T̂ σ_t a p(cos θ) Φ/(4π r²) T̂_shadow / p(s),   p(s) = D/(Δθ r²),   shadow rays clipped
//! with delta tracking, too  X = Σ f(sᵢ) w_i/p_i,   q = a σ_t Π (1 − σ_t/σ̂),   w_i = p_i^β/(p^β + q^β)
//! ```
//!
//! Such mistakes made single scattering too bright in pbrt-v3 (issue 69).

use super::altered::{Altered, Change};
use super::{Mutant, MutantRow, On, family, on, one_by_one};
use estimators::single_scattering::points::{Absorption, Vertices};
use estimators::single_scattering::ray_setup::RaySetup;
use estimators::single_scattering::vertices::{Path, ToVertices, Vertex};
use estimators::space::shadow::ShadowRays;
use estimators::walks::{self, Route, TentativeCollision, Walk};
use estimators::{Draw, Setup};
use gate::CheckId;
use media::Lookups;
use media::sampling::BothWays;
use numeric::rng::{Random, Stream};
use numeric::{Lane, Span, elementary};
use theory::light::Heuristic;
use theory::problems::{Problem, SingleScattering};
use theory::single::{CameraTracking, Tracking};

/// The points of an estimator, and its shadow rays.
type MutantPlan = (Vertices, Tracking);

/// A homogeneous ball, light outside, exact transmittances.
const EXACT: On<MutantPlan> = on("single-scattering/known-bugs", 0, (EXACTLY, Tracking::Exact));
/// A ratio-tracked camera.
const RATIO: On<MutantPlan> = on("single-scattering/known-bugs", 1, (TRACKED, Tracking::Exact));
/// Ratio-tracked shadow rays, as in all that follow.
const SHADOW: On<MutantPlan> = on("single-scattering/known-bugs", 2, (EXACTLY, SHADOW_RAYS));
/// Equiangular points and delta tracking by null-scattering paths, `σ̂ = 1.2`.
const NULL_PATHS: On<MutantPlan> = on("single-scattering/known-bugs", 3, (BOTH, SHADOW_RAYS));
/// One of both.
const ONE_SAMPLE: On<MutantPlan> =
    on("single-scattering/known-bugs", 4, (Vertices { is_one: true, ..BOTH }, SHADOW_RAYS));
/// Both, by the power heuristic.
const POWER: On<MutantPlan> = on(
    "single-scattering/known-bugs",
    5,
    (Vertices { heuristic: Heuristic::Power, ..BOTH }, SHADOW_RAYS),
);

const SHADOW_RAYS: Tracking = Tracking::Ratio { sampling: 1.5, control: 0.0 };
const EXACTLY: Vertices = Vertices { camera: CameraTracking::Exact, ..Vertices::FROM_LIGHT };
const TRACKED: Vertices = Vertices { camera: CameraTracking::Ratio, ..Vertices::FROM_LIGHT };
const BOTH: Vertices = Vertices { collision: Some(Absorption::Analog), ..TRACKED };

#[derive(Debug, Clone, Copy, PartialEq)]
enum Bug {
    None,
    Unclipped,
    Reversed,
    PerAngle,
    PerSolidAngle,
    AlbedoTwice,
    NumberTwice,
    Unshadowed,
    NullsLeftOut,
    ByTransmittance,
    NothingScattered,
    WrongEnd,
    Averaged,
    ShadowTwice,
    AbsorbedGoOn,
    ScatteringIsNull,
    SquaredWeights,
}

#[rustfmt::skip] // one mutant, one entry
const LINES: &[MutantRow<MutantPlan, Bug>] = &[
    ("single-shadow-not-clipped", "the shadow ray goes on through the field beyond the bounds of the volume", EXACT, CheckId::Mean, Bug::Unclipped),
    ("single-cosine-reversed", "the cosine in the phase function has the wrong sign", EXACT, CheckId::Mean, Bug::Reversed),
    ("single-pdf-per-angle", "the density is per angle, 1/Δθ, and the integrand per distance", EXACT, CheckId::Mean, Bug::PerAngle),
    ("single-pdf-per-solid-angle", "1/r² is counted twice: in the source and as if the density were per solid angle", EXACT, CheckId::Mean, Bug::PerSolidAngle),
    ("single-albedo-twice", "the albedo is applied in the source and once more in the draw", EXACT, CheckId::Mean, Bug::AlbedoTwice),
    ("single-number-twice", "the walk begins again with the random number that found the point", RATIO, CheckId::Mean, Bug::NumberTwice),
    ("single-shadow-from-light-only", "the shadow ray's transmittance is left out", SHADOW, CheckId::Mean, Bug::Unshadowed),
    ("null-paths-nulls-left-out", "the density of delta tracking leaves out its null collisions where it was sampled", NULL_PATHS, CheckId::Mean, Bug::NullsLeftOut),
    ("null-paths-by-transmittance", "weights take transmittances for null collisions: unbiased, but another estimator", NULL_PATHS, CheckId::Variance, Bug::ByTransmittance),
    ("null-paths-nothing-scattered", "a point from the light is worth what it is without σ_t there: no event was sampled", NULL_PATHS, CheckId::Mean, Bug::NothingScattered),
    ("null-paths-wrong-end", "the angles of the ray's ends are measured from the wrong one", NULL_PATHS, CheckId::Mean, Bug::WrongEnd),
    ("null-paths-averaged", "both techniques are sampled and added, and their average is taken", NULL_PATHS, CheckId::Mean, Bug::Averaged),
    ("null-paths-shadow-twice", "the shadow ray's transmittance is a weight twice", NULL_PATHS, CheckId::Mean, Bug::ShadowTwice),
    ("null-paths-albedo-twice", "the albedo is the chance to scatter and a factor of what is scattered", NULL_PATHS, CheckId::Mean, Bug::AlbedoTwice),
    ("null-paths-absorbed-go-on", "a walk that is absorbed goes on as after a null collision", NULL_PATHS, CheckId::Mean, Bug::AbsorbedGoOn),
    ("null-paths-scattering-is-null", "the scattering multiplies its own 1 − σ_t/σ̂ to those of the null collisions", NULL_PATHS, CheckId::Mean, Bug::ScatteringIsNull),
    ("null-paths-one-not-doubled", "one technique is chosen and not divided by its chance", ONE_SAMPLE, CheckId::Mean, Bug::Averaged),
    ("null-paths-squared-weights", "the power heuristic squares weights that sum to 1", POWER, CheckId::Mean, Bug::SquaredWeights),
];

/// The family.
pub fn mutants() -> Vec<Mutant<SingleScattering>> {
    family(LINES, &Bug::None, |&plan, &bug| {
        one_by_one(move |setup, medium, random| {
            let wrong = Wrong { bug, setup };
            match plan.0.collision {
                Some(_) => wrong.draw::<true>(plan, medium, random),
                None => wrong.draw::<false>(plan, medium, random),
            }
        })
    })
}

/// A walk with a bug.
#[derive(Clone, Copy)]
struct Wrong<'a> {
    bug: Bug,
    setup: &'a Setup<SingleScattering>,
}

impl Wrong<'_> {
    fn draw<const COLLIDES: bool>(
        self,
        (points, shadow): MutantPlan,
        medium: &Lookups,
        random: &mut Stream,
    ) -> Draw {
        let Self { setup, .. } = self;
        let volume = setup.problem.volume();
        let rays = ShadowRays::new(volume, volume.bounds(), shadow);
        let ground = RaySetup::new(setup, medium, &rays, &[]);
        let walk = ToVertices::<true, COLLIDES>::new(ground, points);
        let altered = Altered { walk, change: self };
        walks::draw(&altered, &setup.fields.sampling, medium, random)
    }

    /// The optical depth by the random number that chose a point.
    fn depth_of_point<L: Lane>(&self, s: L) -> L {
        let (problem, angles) = (&*self.setup.problem, self.setup.problem.angles());
        let number = s.map(|s| {
            let angle = elementary::atan((s - problem.foot()) / problem.distance());
            (angle - angles.from) / angles.length()
        });
        -L::ln(number.one_minus().or_more(s.each(f64::EPSILON)))
    }

    /// The transmittance from points to the light, through the field beyond the bounds of the volume, too.
    fn beyond_bounds<L: Lane>(&self, s: L) -> L {
        let problem = &self.setup.problem;
        s.map(|s| {
            problem.shadow(s).map_or(1.0, |(ray, _)| {
                let whole = problem.volume().along(&ray, ray.span());
                Lane::exp(-whole.optical_depth(ray.span()).value)
            })
        })
    }

    /// The score of a vertex, given a function with the right one of any.
    fn score<L: Lane>(&self, vertex: Vertex<L>, right: impl Fn(Vertex<L>) -> L) -> L {
        let Vertex { s, extinction, kept, is_chosen, light } = vertex;
        let (problem, one, score) = (&*self.setup.problem, s.each(1.0), right(vertex));
        let density = problem.equiangular_density(s);
        let of_collisions =
            |other: L| right(Vertex { kept: L::select(is_chosen, kept, other), ..vertex });
        let of_shadow = |light: L| right(Vertex { light, ..vertex });
        match self.bug {
            Bug::ShadowTwice => of_shadow(light * light),
            Bug::Unshadowed => of_shadow(one),
            Bug::Unclipped => of_shadow(self.beyond_bounds(s)),
            Bug::Reversed => score * (problem.scattered(s, -problem.cosine(s)) / problem.source(s)),
            Bug::PerAngle => score * density * problem.angles().length(),
            // r² is D/(Δθ p).
            Bug::PerSolidAngle => {
                score * density * problem.angles().length() / s.each(problem.distance())
            }
            Bug::AlbedoTwice => score * problem.albedo(),
            Bug::NullsLeftOut => of_collisions(one),
            Bug::ScatteringIsNull => {
                let sampling = self.setup.fields.sampling.single_value().unwrap_or(f64::NAN);
                of_collisions(kept * (extinction / s.each(sampling)).one_minus())
            }
            Bug::ByTransmittance => {
                let from = problem.medium().support().from;
                let known =
                    s.map(|s| Lane::exp(-problem.medium().optical_depth(Span::new(from, s)).value));
                // The densities take it; a point from the light is worth what was tracked.
                let worth = L::select(is_chosen, kept / known, one);
                right(Vertex { kept: known, ..vertex }) * worth
            }
            Bug::NothingScattered => score / L::select(is_chosen, extinction, one),
            Bug::Averaged => score * 0.5,
            Bug::SquaredWeights => {
                let collision = extinction * problem.albedo() * kept;
                let own = L::select(is_chosen, density, collision);
                let other = L::select(is_chosen, collision, density);
                let sum = own + other;
                score * Heuristic::Power.shared(own, other) * own / (sum * sum)
            }
            _ => score,
        }
    }
}

impl<const COLLIDES: bool> Change<ToVertices<'_, true, COLLIDES>> for Wrong<'_> {
    fn numbers<L: Lane>(
        &self,
        walk: &ToVertices<true, COLLIDES>,
        path: &mut Path<L>,
        random: &mut impl Random<L>,
    ) -> [L; 2] {
        let begins = path.begins;
        let numbers = walk.numbers(path, random);
        if self.bug == Bug::WrongEnd {
            // At the opposite angle.
            path.s.set_where(begins, -path.s + 2.0 * self.setup.problem.foot());
        }
        numbers
    }

    fn fly<L: Lane>(
        &self,
        walk: &ToVertices<true, COLLIDES>,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        mut depth: L,
    ) -> L::Mask {
        if self.bug == Bug::NumberTwice {
            depth.set_where(path.sets_out, self.depth_of_point(path.s));
        }
        walk.fly(path, route, depth)
    }

    fn collide<L: Lane>(
        &self,
        walk: &ToVertices<true, COLLIDES>,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let (before, mut extinctions, one) = (*path, *extinctions, extinctions.t.each(1.0));
        if self.bug == Bug::AbsorbedGoOn {
            let threshold = extinctions.number * route.here.sampling();
            let scatters = threshold.below(extinctions.extinction * self.setup.problem.albedo());
            extinctions.number.set_where(path.flies & !path.is_chosen & !scatters, one);
        }
        path.score = one.each(0.0);
        let goes_on = walk.collide(path, route, &extinctions, random);
        let scored = !path.score.equals(0.0);
        // What scored may have set out for its collision.
        let mut scoring = *path;
        scoring.is_chosen = before.is_chosen;
        let vertex = walk.vertex(&scoring, scored, path.to_light.light);
        path.score = before.score;
        path.score.add_where(scored, self.score(vertex, |vertex| walk.value(vertex)));
        goes_on
    }
}
