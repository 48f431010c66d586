//! Walks from an eye in or before a ball to its light.

pub mod bidirectional;
pub mod combined;
pub mod connect;
pub mod directional_mis;
pub mod emission;
pub mod full_mis;
pub mod next_event;
pub mod page;
pub mod particle;
pub mod sharing;

use crate::space::{self, ParticleSettings, Walked};
use crate::{Draw, Refusal, Setup, estimators};
use numeric::digits::rounded;
use theory::problems::ball::BallLight;
use theory::problems::{self, Sphere};
use theory::single::Tracking;
use theory::space::sphere::predict;
use theory::{ParticleRule, Prediction};

pub use connect::Seeker;
pub use page::Method;
pub use sharing::Correct;

/// Maximum second moment of a tracked transmittance, relative to that of an untracked one.
const WILDEST: f64 = 1e3;
/// Relative increase of bounds on σ_t, because lookups are rounded.
const SLACK: f64 = 1e-9;
/// Maximum expected number of tentative collisions on a shadow ray; more are a mistake in the case.
const MAX_COLLISIONS: f64 = 1e4;

/// Reason why the expected value is unknown.
fn unknown(sphere: &Sphere) -> Refusal {
    let depth = sphere.majorant() * sphere.radius;
    if depth > predict::DEEPEST {
        let actual = format!("it may reach {}", rounded(depth));
        return Refusal::mismatch("σ_t R ≤ 30, up to which Peierls' equation is solved", actual);
    }
    let needs = "an answer of Peierls' equation known to 1e-4";
    let Some(answer) = predict::answer(sphere) else {
        return Refusal::mismatch(needs, "the equation is not solved for this medium");
    };
    let error = predict::blur(&answer);
    if error.is_nan() || error > 1.0 {
        return Refusal::mismatch(needs, "it is lost in its own error");
    }
    Refusal::mismatch(needs, format!("it is known to {error:.0e} only"))
}

/// Checks that a rule is valid, that its variance has a bound, and that the expected value is known.
fn realisable(setup: &Setup<Sphere>, particle: &ParticleSettings) -> Result<(), Refusal> {
    let sphere = &setup.problem;
    space::realisable(setup, particle)?;
    let walks = space::walks(&sphere.scene, &setup.fields, particle);
    if !walks.never_grows() {
        let needs = "σ̂ ≥ σ_t, so that theory bounds the variance";
        let actual = format!("σ_t may reach {:.6} times σ̂", walks.ratio());
        return Err(Refusal::mismatch(needs, actual));
    }
    if predict::truth(sphere).is_none() {
        return Err(unknown(sphere));
    }
    Ok(())
}

/// Checks that shadow rays are unbiased and end, and that the walk is realisable.
///
/// # Errors
///
/// The violated inequality.
fn connected(
    setup: &Setup<Sphere>,
    particle: &ParticleSettings,
    shadow: Tracking,
) -> Result<(), Refusal> {
    realisable(setup, particle)?;
    let sphere = &setup.problem;
    if let Tracking::Ratio { sampling, .. } | Tracking::Delta { sampling } = shadow {
        let collisions = 2.0 * sampling * sphere.radius;
        if collisions.is_nan() || collisions > MAX_COLLISIONS {
            let needs = "a shadow's σ̂ of at most 1e4 collisions across the ball";
            return Err(Refusal::mismatch(needs, format!("there would be {collisions:e}")));
        }
    }
    if let Tracking::Delta { sampling } = shadow
        && sampling < sphere.majorant() * (1.0 - SLACK)
    {
        let actual = format!("σ̄ = {sampling} and σ_t is bounded by {:.6} only", sphere.majorant());
        return Err(Refusal::mismatch("σ̄ ≥ σ_t on every shadow ray", actual));
    }
    let gain = predict::gain(sphere, shadow);
    if gain > WILDEST {
        let needs = "a shadow's σ̂ and σ_c that keep E[T̂²] below 1e3 T";
        return Err(Refusal::mismatch(needs, format!("it is bounded by {gain:.3e} T only")));
    }
    Ok(())
}

impl Walked for Sphere {
    type Tally<'a> = Seeker<'a>;

    /// Requires a light that a walk can hit.
    fn domain(setup: &Setup<Self>, particle: &ParticleSettings) -> Result<(), Refusal> {
        if matches!(setup.problem.light, BallLight::Distant(_)) {
            let needs = "a light that a walk can meet";
            return Err(Refusal::mismatch(needs, "a distant light is met with chance 0"));
        }
        realisable(setup, particle)
    }

    fn predict(setup: &Setup<Self>, particle: &ParticleSettings) -> Prediction {
        let is_chance = matches!(particle.rule, ParticleRule::Analog | ParticleRule::Terminating);
        predict::hits(&setup.problem, is_chance && particle.roulette.is_none())
    }

    fn scene(&self) -> &problems::Scene {
        &self.scene
    }

    fn tally<'a>(setup: &'a Setup<Self>, _: &ParticleSettings) -> Result<Self::Tally<'a>, Draw> {
        Ok(Seeker { sphere: &setup.problem })
    }
}

estimators! {
    Sphere on Space:
    particle::Walker,
    next_event::NextEvent,
    directional_mis::DirectionalMis,
    full_mis::FullMis,
    bidirectional::Bidirectional,
}
