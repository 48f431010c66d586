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

use crate::space::{self, Particle, Walked};
use crate::{Draw, Refusal, Setup, estimators};
use numeric::Known;
use numeric::digits::rounded;
use theory::problems::Sphere;
use theory::problems::ball::{Light, Sought};
use theory::single::Tracking;
use theory::sphere::{Answer, Lights, Observable, Scene, Spread, Spreads, Techniques, cached};
use theory::{Channel, Distribution, Moments, ParticleRule, Prediction, Tails, problems};

pub use connect::Seeker;
pub use page::Page;
pub use sharing::Honest;

/// Maximum relative error of an exact answer that draws are compared with.
pub const BLURRED: f64 = 1e-4;
/// Maximum optical depth from the surface to the centre for which the equation is solved.
const DEEPEST: f64 = 30.0;
/// Maximum second moment of a tracked transmittance, relative to that of an untracked one.
const WILDEST: f64 = 1e3;
/// Relative increase of bounds on σ_t, because lookups are rounded.
const SLACK: f64 = 1e-9;
/// Maximum expected number of tentative collisions on a shadow ray; more are a mistake in the case.
const MOST_COLLISIONS: f64 = 1e4;

/// The exact answer; `None` where the equation is not solved, or the error of the answer is too large.
fn truth(sphere: &Sphere) -> Option<Answer> {
    answer(sphere).filter(|answer| blur(answer) <= BLURRED)
}

/// The relative error of an answer.
fn blur(answer: &Answer) -> f64 {
    answer.value.error / answer.value.value.abs()
}

/// The answer with its error; `None` where the equation is not solved.
fn answer(sphere: &Sphere) -> Option<Answer> {
    if sphere.majorant() * sphere.radius > DEEPEST {
        return None;
    }
    let (core, lights) = match sphere.light {
        Light::BlackSphere(radius) => (Some(radius), Lights { environment: 0.0, core: 1.0 }),
        Light::Environment | Light::Distant(_) => (None, Lights { environment: 1.0, core: 0.0 }),
    };
    let observable = match sphere.sought {
        Sought::Radiance => Observable::Radiance { offset: sphere.offset(), from: sphere.begins() },
        Sought::MeanIntensity => Observable::Mean(sphere.distance()),
    };
    let scene = Scene {
        radius: sphere.radius,
        core,
        albedo: sphere.scene.albedo.even()?,
        lights,
        is_distant: matches!(sphere.light, Light::Distant(_)),
        observable,
    };
    cached(&scene, &|r2| sphere.extinction(r2))
}

/// Reason why the expected value is unknown.
fn unknown(sphere: &Sphere) -> Refusal {
    let depth = sphere.majorant() * sphere.radius;
    if depth > DEEPEST {
        let found = format!("it may reach {}", rounded(depth));
        return Refusal::mismatch("σ_t R ≤ 30, up to which Peierls' equation is solved", found);
    }
    let needs = "an answer of Peierls' equation known to 1e-4";
    let Some(answer) = answer(sphere) else {
        return Refusal::mismatch(needs, "the equation is not solved for this medium");
    };
    let error = blur(&answer);
    if error.is_nan() || error > 1.0 {
        return Refusal::mismatch(needs, "it is lost in its own error");
    }
    Refusal::mismatch(needs, format!("it is known to {error:.0e} only"))
}

/// Checks that a rule is valid, that its variance has a bound, and that the expected value is known.
fn realisable(setup: &Setup<Sphere>, particle: &Particle) -> Result<(), Refusal> {
    let sphere = &setup.problem;
    space::realisable(setup, particle)?;
    let walks = space::walks(&sphere.scene, &setup.fields, particle);
    if !walks.never_grows() {
        let needs = "σ̂ ≥ σ_t, so that theory bounds the variance";
        let found = format!("σ_t may reach {:.6} times σ̂", walks.ratio());
        return Err(Refusal::mismatch(needs, found));
    }
    if truth(sphere).is_none() {
        return Err(unknown(sphere));
    }
    Ok(())
}

/// G, a bound on `E[T̂²]/T` of tracked shadow rays through σ_t up to a majorant and a length:
/// `E[T̂²] = T exp ∫((σ_t − σ_c)²/σ̂ − σ_t)`.
fn gain(majorant: f64, length: f64, shadow: Tracking) -> f64 {
    let Tracking::Ratio { sampling, control } = shadow else { return 1.0 };
    // It is convex in σ_t: largest at an end.
    let at = |sigma: f64| (sigma - control) * (sigma - control) / sampling - sigma;
    let worst = at(0.0).max(at(majorant)).max(0.0);
    (length * worst).exp()
}

/// Bound on `E[T̂²]/T` on any shadow ray through a ball, see [`gain`].
fn gain_in(sphere: &Sphere, shadow: Tracking) -> f64 {
    gain(sphere.majorant(), 2.0 * sphere.radius, shadow)
}

/// Checks that shadow rays are unbiased and end, and that the walk is realisable.
///
/// # Errors
///
/// The violated inequality.
fn connected(setup: &Setup<Sphere>, particle: &Particle, shadow: Tracking) -> Result<(), Refusal> {
    realisable(setup, particle)?;
    let sphere = &setup.problem;
    if let Tracking::Ratio { sampling, .. } | Tracking::Delta { sampling } = shadow {
        let collisions = 2.0 * sampling * sphere.radius;
        if collisions.is_nan() || collisions > MOST_COLLISIONS {
            let needs = "a shadow's σ̂ of at most 1e4 collisions across the ball";
            return Err(Refusal::mismatch(needs, format!("there would be {collisions:e}")));
        }
    }
    if let Tracking::Delta { sampling } = shadow
        && sampling < sphere.majorant() * (1.0 - SLACK)
    {
        let found = format!("σ̄ = {sampling} and σ_t is bounded by {:.6} only", sphere.majorant());
        return Err(Refusal::mismatch("σ̄ ≥ σ_t on every shadow ray", found));
    }
    let gain = gain_in(sphere, shadow);
    if gain > WILDEST {
        let needs = "a shadow's σ̂ and σ_c that keep E[T̂²] below 1e3 T";
        return Err(Refusal::mismatch(needs, format!("it is bounded by {gain:.3e} T only")));
    }
    Ok(())
}

/// The answer of a refused setup, which is not predicted.
const UNKNOWN: Answer = Answer {
    value: Known::estimated(f64::NAN, f64::INFINITY),
    spreads: Spreads(
        [Spread { unscattered: f64::NAN, lit: f64::NAN, rest: f64::NAN }; Techniques::ALL.len()],
    ),
};

fn prediction(value: Known, square: f64) -> Prediction {
    Prediction::uncounted(Channel::bounded(value, square))
}

/// Prediction for a draw that is 1 with the probability `value`, else 0.
fn all_or_nothing(value: Known) -> Prediction {
    let chance = value.value;
    // E[Xᵏ] is the same for every k: the moments of a product whose losses are all −ln E[X].
    let error = 4.0 * value.error / (chance * (1.0 - chance));
    let moments = Moments::of_product(chance, [-chance.ln(); 4], error).graded(value.grade);
    let tails = Tails { rare_event_size: 1.0 / chance, eighth_moment_ratio: 1.0 / chance };
    let channel = Channel::unbiased(value, moments, tails);
    let distribution = Some(Distribution::Atoms(vec![(0.0, 1.0 - chance), (1.0, chance)]));
    Prediction { distribution, ..Prediction::uncounted(channel) }
}

/// Prediction for a combination of techniques, with shadow rays that are tracked somehow.
fn predict_together(setup: &Setup<Sphere>, techniques: Techniques, shadow: Tracking) -> Prediction {
    let answer = truth(&setup.problem).unwrap_or(UNKNOWN);
    let spread = answer.spreads.of(techniques);
    prediction(answer.value, spread.square(gain_in(&setup.problem, shadow)))
}

/// Prediction for a combination with an unknown variance: that of pilot draws stands in for it.
fn predict_by_pilots(setup: &Setup<Sphere>) -> Prediction {
    let value = truth(&setup.problem).unwrap_or(UNKNOWN).value;
    let channel = Channel::unbiased(value, None, Tails::LIGHT);
    Prediction::uncounted(Channel { pilot_variance_allowed: true, ..channel })
}

impl Walked for Sphere {
    type Tally<'a> = Seeker<'a>;

    /// Requires a light that a walk can hit.
    fn domain(setup: &Setup<Self>, particle: &Particle) -> Result<(), Refusal> {
        if matches!(setup.problem.light, Light::Distant(_)) {
            let needs = "a light that a walk can meet";
            return Err(Refusal::mismatch(needs, "a distant light is met with chance 0"));
        }
        realisable(setup, particle)
    }

    /// Prediction for a walk that hits the light: draws from 0 to 1, `E[X²] ≤ E[X]`. Draws are 0 or 1 where the
    /// walk has no weight. Where nothing is absorbed and light is everywhere, every draw is 1.
    fn predict(setup: &Setup<Self>, particle: &Particle) -> Prediction {
        let sphere = &setup.problem;
        if sphere.light == Light::Environment && sphere.scene.albedo.even() == Some(1.0) {
            return Prediction::uncounted(space::energy_channel(0.0, 0.0));
        }
        let value = truth(sphere).unwrap_or(UNKNOWN).value;
        let is_chance = matches!(particle.rule, ParticleRule::Analog | ParticleRule::Terminating);
        if is_chance && particle.roulette.is_none() {
            all_or_nothing(value)
        } else {
            prediction(value, value.value)
        }
    }

    fn scene(&self) -> &problems::Scene {
        &self.scene
    }

    fn tally<'a>(setup: &'a Setup<Self>, _: &Particle) -> Result<Self::Tally<'a>, Draw> {
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
