//! Mistakes of single scattering, by source-driven points.
//!
//! ```text
//! X = T̂ σ_t a p(cos θ) Φ/(4π r²) T̂_shadow / p(s),   p(s) = D/(Δθ r²),   shadow rays clipped
//! ```

use super::target::{SINGLE_EXACT, SINGLE_RATIO, SINGLE_SHADOW};
use super::{About, Mutant, with};
use estimators::single_scattering::connection::{camera, shadow};
use estimators::{Draw, Setup};
use media::{Extinction, Lookups};
use numeric::Lane;
use numeric::rng::Stream;
use theory::problems::SingleScattering;
use theory::single::{CameraTracking, Tracking};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<SingleScattering>> {
    let exact = SourceDriven { bug: Bug::None, camera: CameraTracking::Exact, shadow: Tracking::Exact };
    let ratio = SourceDriven { camera: CameraTracking::Ratio, ..exact };
    let tracked = SourceDriven { shadow: Tracking::Ratio { sampling: 1.5, control: 0.0 }, ..exact };
    let of = |name, text, target, twin: SourceDriven, bug| {
        let about = About { name, bug: text, target, check: "mean" };
        Mutant::new(about, with(SourceDriven { bug, ..twin }, draw), with(twin, draw))
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

/// Source-driven scattering, see `estimators/single_scattering/source_driven.rs`.
#[derive(Clone, Copy)]
struct SourceDriven {
    bug: Bug,
    camera: CameraTracking,
    shadow: Tracking,
}

fn draw(
    technique: &SourceDriven,
    setup: &Setup<SingleScattering>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw {
    let problem = &setup.problem;
    let mut beginning = *rng;
    let angles = problem.angles();
    let s = problem.at_angle(angles.from + rng.uniform() * angles.length());
    let extinction = medium.extinction(s);
    if extinction <= 0.0 {
        return Draw::free([0.0], 1);
    }
    let numbers = if technique.bug == Bug::NumberTwice { &mut beginning } else { &mut *rng };
    let (transmittance, walked) = camera(setup, medium, technique.camera, s, numbers);
    if technique.camera == CameraTracking::Delta && transmittance == 0.0 {
        return Draw::free([0.0], 1 + walked);
    }
    let (lit, cast) = shadow(problem, technique.shadow, s, rng);
    let lit = match technique.bug {
        Bug::Unshadowed => 1.0,
        Bug::Unclipped => problem.shadow(s).map_or(1.0, |(ray, _)| {
            let whole = problem.volume().along(&ray, ray.span());
            Lane::exp(-whole.optical_depth(ray.span()).value)
        }),
        _ => lit,
    };
    let cosine = problem.cosine(s);
    let cosine = if technique.bug == Bug::Reversed { -cosine } else { cosine };
    let source = extinction * problem.scattered(s, cosine);
    let square = problem.distance() / (angles.length() * problem.equiangular_density(s));
    let density = match technique.bug {
        Bug::PerAngle => 1.0 / angles.length(),
        Bug::PerSolidAngle => problem.equiangular_density(s) * square,
        _ => problem.equiangular_density(s),
    };
    let factor = if technique.bug == Bug::AlbedoTwice { problem.albedo() } else { 1.0 };
    Draw::free([transmittance * source * lit / density * factor], 1 + walked + cast)
}
