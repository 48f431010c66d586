//! Walks of particles through volumes: common parts of all problems in space.

pub mod draws;
pub mod particle;
pub mod segment;
pub mod shadow;
mod splitting;
mod steps;
pub mod tally;
pub mod walk;
mod walker;

use super::{Refusal, Setup};
use media::Majorants;
use numeric::Known;
use numeric::geometry::Bounds;
use theory::problems::Scene;
use theory::space::Walks;
use theory::{Channel, Moments, Tails};

pub use numeric::geometry::exit;
pub use particle::{Particle, Splitting};
pub use steps::Steps;
pub use tally::Tally;
pub use walker::{Splitter, Walked, Walker, draw};

/// Relative rounding error of a sum over the collisions of a walk.
const ROUNDING: f64 = 1e-12;
/// Maximum expected number of collisions on a straight line through a volume; more are a mistake in the case.
const MOST_COLLISIONS: f64 = 1e4;

/// The arguments of bounds on the walks of a particle.
pub fn walks(scene: &Scene, majorants: &Majorants, particle: &Particle) -> Walks {
    let across = match majorants.bounds() {
        Bounds::Everywhere => f64::INFINITY,
        Bounds::Sphere { radius, .. } => 2.0 * radius,
        Bounds::Box(within) => (within.high - within.low).norm(),
    };
    Walks {
        rule: particle.rule,
        roulette: particle.roulette,
        splits: particle.splitting != Splitting::None,
        largest_ratio: majorants.largest_ratio(),
        albedo: scene.albedo.range(),
        depth: majorants.largest() * across,
    }
}

/// Checks that a rule is valid for a σ̂, and that its walks end within reason.
///
/// # Errors
///
/// The violated inequality.
pub fn realisable<P: Walked>(setup: &Setup<P>, particle: &Particle) -> Result<(), Refusal> {
    let walks = walks(setup.problem.scene(), &setup.fields, particle);
    if walks.depth > MOST_COLLISIONS {
        let needs = "∫σ̂ ≤ 1e4 straight through the volume";
        return Err(Refusal::mismatch(needs, format!("it may be {:e}", walks.depth)));
    }
    let limit = particle.rule.limits(walks.albedo[1])[1];
    if walks.ratio() > limit {
        let needs = particle.rule.needs();
        let found = format!("σ_t may reach {:.6} times σ̂ in the volume", walks.ratio());
        return Err(Refusal::mismatch(needs, found));
    }
    Ok(())
}

/// Prediction for the energy of a particle, 1 on average, where its variance is known or bounded.
///
/// # Errors
///
/// Why no bound is known, and what would help.
pub fn energy(walks: &Walks) -> Result<Channel, Refusal> {
    let Some(bound) = walks.energy_variance() else {
        let needs = "a variance that theory bounds: r < 2/(a + 1), or r ≤ 1 with roulette";
        let found =
            format!("σ_t may reach {:.6} times σ̂; raise σ̂, or take local majorants", walks.ratio());
        return Err(Refusal::mismatch(needs, found));
    };
    Ok(energy_channel(bound, walks.depth))
}

/// [`energy`], given the bound on its variance and `∫σ̂` straight through.
pub fn energy_channel(bound: f64, depth: f64) -> Channel {
    // A walk that nothing ends makes about depth² collisions, and each rounds.
    let rounding = ROUNDING + 4.0 * f64::EPSILON * depth * depth;
    let certain = Channel::unbiased(Known::new(1.0, rounding), Moments::certain(1.0), Tails::LIGHT);
    if bound == 0.0 {
        return certain;
    }
    Channel { moments: None, variance_bound: Some(bound), ..certain }
}
