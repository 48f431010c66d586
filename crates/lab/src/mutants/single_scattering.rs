//! Mistakes of single scattering, by source-driven points.
//!
//! ```text
//! X = T̂ σ_t a p(cos θ) Φ/(4π r²) T̂_shadow / p(s),   p(s) = D/(Δθ r²),   shadow rays clipped
//! ```

use super::target::{SINGLE_EXACT, SINGLE_RATIO, SINGLE_SHADOW};
use super::{About, Mutant, with};
use estimators::single_scattering::plan::Vertices;
use estimators::single_scattering::vertices::{Steps, Vertex};
use numeric::{Lane, elementary};
use theory::problems::{Problem, SingleScattering};
use theory::single::{CameraTracking, Tracking};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<SingleScattering>> {
    let by = |camera, shadow| (Vertices { camera, ..Vertices::FROM_LIGHT }, shadow);
    let exact = by(CameraTracking::Exact, Tracking::Exact);
    let ratio = by(CameraTracking::Ratio, Tracking::Exact);
    let tracked = by(CameraTracking::Exact, Tracking::Ratio { sampling: 1.5, control: 0.0 });
    let of = |name, text, target, (vertices, shadow): (Vertices, Tracking), bug| {
        let about = About { name, bug: text, target, check: "mean" };
        let draws = |bug| with(bug, move |&bug, setup, medium, rng| vertices.draw((Wrong { bug, problem: &setup.problem }, shadow), setup, medium, rng));
        Mutant::new(about, draws(bug), draws(Bug::None))
    };
    vec![
        of("single-shadow-not-clipped", "the shadow ray goes on through the field beyond the bounds of the volume", SINGLE_EXACT, exact, Bug::Unclipped),
        of("single-cosine-reversed", "the cosine in the phase function has the wrong sign", SINGLE_EXACT, exact, Bug::Reversed),
        of("single-pdf-per-angle", "the density is per angle, 1/Δθ, and the integrand per distance", SINGLE_EXACT, exact, Bug::PerAngle),
        of("single-pdf-per-solid-angle", "1/r² is counted twice: in the source and as if the density were per solid angle", SINGLE_EXACT, exact, Bug::PerSolidAngle),
        of("single-albedo-twice", "the albedo is applied in the source and once more in the draw", SINGLE_EXACT, exact, Bug::AlbedoTwice),
        of("single-number-twice", "the walk begins again with the random number that found the point", SINGLE_RATIO, ratio, Bug::NumberTwice),
        of("single-shadow-from-light-only", "the shadow ray's transmittance is left out", SINGLE_SHADOW, tracked, Bug::Unshadowed),
    ]
}

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
}

/// Steps of source-driven scattering, of which a bug makes one wrong.
#[derive(Clone, Copy)]
struct Wrong<'a> {
    bug: Bug,
    problem: &'a SingleScattering,
}

impl Steps for Wrong<'_> {
    #[inline(always)]
    fn depth<L: Lane>(&self, right: L, here: L, s: L) -> L {
        let problem = self.problem;
        let (angles, begin) = (problem.angles(), problem.medium().support().from);
        if self.bug != Bug::NumberTwice {
            return right;
        }
        // The number that chose the point.
        let number = s.map(|s| {
            let angle = elementary::atan((s - problem.foot()) / problem.distance());
            (angle - angles.from) / angles.length()
        });
        let again = -L::ln(number.one_minus().or_more(s.each(f64::EPSILON)));
        L::select(here.equals(begin), again, right)
    }

    #[inline(always)]
    fn light<L: Lane>(&self, right: L, s: L) -> L {
        match self.bug {
            Bug::Unshadowed => right.each(1.0),
            Bug::Unclipped => s.map(|s| {
                self.problem.shadow(s).map_or(1.0, |(ray, _)| {
                    let whole = self.problem.volume().along(&ray, ray.span());
                    Lane::exp(-whole.optical_depth(ray.span()).value)
                })
            }),
            _ => right,
        }
    }

    #[inline(always)]
    fn score<L: Lane>(&self, vertex: Vertex<L>, score: impl Fn(Vertex<L>) -> L) -> L {
        let (problem, s, right) = (self.problem, vertex.s, score(vertex));
        let density = problem.equiangular_density(s);
        let width = problem.angles().length();
        match self.bug {
            Bug::Reversed => right * (problem.scattered(s, -problem.cosine(s)) / problem.source(s)),
            Bug::PerAngle => right * density * width,
            // r² is D/(Δθ p).
            Bug::PerSolidAngle => right * density * width / s.each(problem.distance()),
            Bug::AlbedoTwice => right * problem.albedo(),
            _ => right,
        }
    }
}
