//! Mistakes of hits, shadow rays and connections in a ball, and of their combinations.
//!
//! ```text
//! next event alone  X = [light met before the first scattering] + Σ w Ω/4π T̂,   w with the albedo in it, T̂ up to the light
//! combined          X = Σ f/p w,   w = p/Σ p,   p = 1, 1/(q Π ν), 4 d²/(a ρ² Π ν) of a hit, a shadow ray, a connection
//! ```

use super::{Mutant, MutantRow, On, family, on, one_by_one};
use estimators::space::shadow::VisibleLight;
use estimators::space::{ParticleSettings, Splitting};
use estimators::sphere::sharing::{Link, SharedTechniques, Subpaths, WalkEvents};
use estimators::sphere::{Correct, Method};
use gate::CheckId;
use numeric::{Lane, Mask};
use theory::ParticleRule;
use theory::light::{Densities, Heuristic};
use theory::problems::{Sphere, ball};
use theory::single::Tracking;
use theory::space::sphere::Techniques;

/// A weighted walk, ratio-tracked shadow rays to a black light sphere.
const NEXT_EVENT: On<Method> = on("ball/known-bugs", 0, next_event(RATIO));
/// A weighted walk, exact shadow rays to a black light sphere.
const NEXT_EVENT_EXACT: On<Method> = on("ball/known-bugs", 1, next_event(Tracking::Exact));
/// Next-event estimation in an environment.
const NEXT_EVENT_SKY: On<Method> = on("ball/environment", 0, next_event(RATIO));
/// A black light sphere in a ball that thins out, by directions.
const DIRECTIONAL: On<Method> = on("ball/known-bugs-paths", 0, {
    let techniques = Techniques::Mis(Densities::Directional, Heuristic::Balance);
    page(ParticleRule::Analog, techniques, Some(Tracking::Delta { sampling: 2.5 }), None)
});
/// Null-scattering paths.
const FULL: On<Method> = on("ball/known-bugs-paths", 1, full(Heuristic::Balance));
/// Null-scattering paths, by the power heuristic.
const POWER: On<Method> = on("ball/known-bugs-paths", 2, full(Heuristic::Power));
/// Bidirectional paths, with connections.
const BIDIRECTIONAL: On<Method> = on("ball/known-bugs-paths", 3, CONNECTED);
/// Null-scattering paths in an environment.
const FULL_SKY: On<Method> = on("ball/techniques", 3, full(Heuristic::Balance));
/// Bidirectional paths in an environment, with connections.
const BIDIRECTIONAL_SKY: On<Method> = on("ball/techniques", 6, CONNECTED);

const RATIO: Tracking = Tracking::Ratio { sampling: 2.0, control: 0.0 };

const CONNECTED: Method = page(
    ParticleRule::Analog,
    Techniques::Bidirectional(Heuristic::Balance),
    None,
    Some(Subpaths::Independent),
);

const fn page(
    rule: ParticleRule,
    techniques: Techniques,
    shadow: Option<Tracking>,
    subpaths: Option<Subpaths>,
) -> Method {
    let particle = ParticleSettings { rule, roulette: None, splitting: Splitting::None };
    Method { particle, sharing: SharedTechniques { techniques, shadow, subpaths } }
}

const fn next_event(shadow: Tracking) -> Method {
    page(ParticleRule::Weighted, Techniques::NextEvent, Some(shadow), None)
}

const fn full(heuristic: Heuristic) -> Method {
    page(ParticleRule::Analog, Techniques::Mis(Densities::Full, heuristic), None, None)
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Bug {
    None,
    Through,
    Twice,
    PerArea,
    WithoutAlbedo,
    HitsAlone,
    PhaseAlone,
    ShadowTwice,
    Averaged,
    NullsInOne,
    NullsOfAll,
    Unscattered,
    TwoHeuristics,
    WithoutDistance,
    AlbedoMissing,
    TrackedTwice,
    ThroughLight,
    EvenEmission,
    Added,
    GeometryInOne,
}

#[rustfmt::skip] // one mutant, one entry
const LINES: &[MutantRow<Method, Bug>] = &[
    ("sphere-shadow-not-clipped", "the shadow ray goes on through the light to the far side", NEXT_EVENT_EXACT, CheckId::Mean, Bug::Through),
    ("sphere-light-twice", "light that the walk meets counts beside the shadow rays", NEXT_EVENT_SKY, CheckId::Mean, Bug::Twice),
    ("sphere-pdf-per-area", "the visible area of the light stands for its solid angle", NEXT_EVENT, CheckId::Mean, Bug::PerArea),
    ("sphere-albedo-missing", "a shadow ray has the weight from before the scattering", NEXT_EVENT, CheckId::Mean, Bug::WithoutAlbedo),
    ("sphere-mis-hits-alone", "hits are not divided by p_uni + p_nee", DIRECTIONAL, CheckId::Mean, Bug::HitsAlone),
    ("sphere-mis-phase-alone", "a hit is weighted as if p_nee were 1 per steradian", DIRECTIONAL, CheckId::Mean, Bug::PhaseAlone),
    ("sphere-mis-shadow-twice", "the transmittance of a shadow ray is a weight twice", FULL, CheckId::Mean, Bug::ShadowTwice),
    ("sphere-mis-averaged", "samples of both techniques are weighted, added, and divided by their number", FULL, CheckId::Mean, Bug::Averaged),
    ("sphere-mis-nulls-in-one", "null collisions are left out of the density of hits only", FULL_SKY, CheckId::Mean, Bug::NullsInOne),
    ("sphere-mis-nulls-of-all", "ρ does not begin anew at a scattering: null collisions of all segments are in it", FULL_SKY, CheckId::Mean, Bug::NullsOfAll),
    ("sphere-mis-unscattered", "light that was never scattered is weighted as if shadow rays could find it", FULL_SKY, CheckId::Mean, Bug::Unscattered),
    ("sphere-mis-two-heuristics", "hits are weighted by the balance heuristic, shadow rays by the power heuristic", POWER, CheckId::Mean, Bug::TwoHeuristics),
    ("sphere-connection-without-distance", "1/d² is left out of a connection", BIDIRECTIONAL, CheckId::Mean, Bug::WithoutDistance),
    ("sphere-connection-albedo-missing", "a connection leaves out the albedo at the vertex of the light", BIDIRECTIONAL, CheckId::Mean, Bug::AlbedoMissing),
    ("sphere-connection-tracked-twice", "the tracked transmittance of a connection multiplies its worth twice", BIDIRECTIONAL, CheckId::Mean, Bug::TrackedTwice),
    ("sphere-connection-through-light", "connections go through the black sphere", BIDIRECTIONAL, CheckId::Mean, Bug::ThroughLight),
    ("sphere-connection-even-emission", "light leaves its surface in all directions alike, without the law of Lambert", BIDIRECTIONAL_SKY, CheckId::Mean, Bug::EvenEmission),
    ("sphere-connection-added", "weights of hits and shadow rays do not know of connections, which are added", BIDIRECTIONAL_SKY, CheckId::Mean, Bug::Added),
    ("sphere-connection-geometry-in-one", "d² is left out of the density of connections for the paths that others made", BIDIRECTIONAL_SKY, CheckId::Mean, Bug::GeometryInOne),
    ("sphere-connection-nulls-missing", "null collisions are left out of the densities of what walks, from the eye and from the light", BIDIRECTIONAL_SKY, CheckId::Mean, Bug::NullsInOne),
];

/// The family.
pub fn mutants() -> Vec<Mutant<Sphere>> {
    family(LINES, &Bug::None, |&page, &bug| {
        one_by_one(move |setup, _, random| page.draw_for(bug, setup, random))
    })
}

impl WalkEvents for Bug {
    fn probability<L: Lane>(&self, right: L) -> L {
        if *self == Self::NullsInOne { right.each(1.0) } else { right }
    }

    fn segment<L: Lane>(&self, before: L) -> L {
        if *self == Self::NullsOfAll { before } else { before.each(1.0) }
    }

    #[inline(always)] // the step that is made most often
    fn weight<L: Lane, const N: usize>(
        &self,
        heuristic: Heuristic,
        own: usize,
        mut densities: [L; N],
    ) -> L {
        let one = densities[own].each(1.0);
        let right = heuristic.weight(own, densities);
        match self {
            Self::HitsAlone if own == 0 => one,
            Self::PhaseAlone if own == 0 => {
                densities[1] = one.each(4.0 * std::f64::consts::PI);
                heuristic.weight(0, densities)
            }
            Self::Averaged => right * 0.5,
            Self::TwoHeuristics if own == 0 => Heuristic::Balance.weight(0, densities),
            Self::Added if own < 2 => {
                densities.iter_mut().skip(2).for_each(|connection| *connection = one.each(0.0));
                heuristic.weight(own, densities)
            }
            _ => right,
        }
    }

    fn unscattered(&self) -> f64 {
        if *self == Self::Unscattered { 0.5 } else { 1.0 }
    }

    fn lit<L: Lane>(&self, right: L, transmittance: L) -> L {
        if *self == Self::ShadowTwice { right * transmittance } else { right }
    }

    fn linked<L: Lane>(&self, right: L, square: L) -> L {
        if *self == Self::GeometryInOne { right / square } else { right }
    }

    fn connected<L: Lane>(&self, right: L, link: &Link<L>) -> L {
        match self {
            Self::WithoutDistance => right * link.distance * link.distance,
            Self::AlbedoMissing => right / link.albedo,
            Self::TrackedTwice => right * link.transmittance,
            _ => right,
        }
    }

    fn is_hidden<M: Mask>(&self, right: M) -> M {
        if *self == Self::ThroughLight { right & !right } else { right }
    }

    fn cosine<L: Lane>(&self, number: L) -> L {
        if *self == Self::EvenEmission { number.one_minus() } else { Correct.cosine(number) }
    }

    fn light<L: Lane>(
        &self,
        sphere: &Sphere,
        place: [L; 3],
        right: VisibleLight<L>,
    ) -> VisibleLight<L> {
        let one = right.share.each(1.0);
        match (self, sphere.light) {
            (Self::Through, _) => VisibleLight { distance: one.each(f64::INFINITY), ..right },
            (Self::PerArea, ball::BallLight::BlackSphere(core)) => {
                // 2πρ²(1 − ρ/r)/4π, the visible area of the sphere.
                let distance = sphere.centre.square_to(place, 1.0).root();
                let share = (one - one.each(core) / distance) * (0.5 * core * core);
                VisibleLight { share, ..right }
            }
            (Self::WithoutAlbedo, _) => {
                let albedo = sphere.scene.albedo.even().unwrap_or(1.0);
                VisibleLight { share: right.share / one.each(albedo), ..right }
            }
            _ => right,
        }
    }

    fn counts<M: Mask>(&self, right: M) -> M {
        if *self == Self::Twice { right | !right } else { right }
    }
}
