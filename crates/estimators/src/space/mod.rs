//! Walks of particles through volumes: common parts of all problems in space.

pub mod connection;
pub mod draws;
pub mod particle;
pub mod segment;
pub mod shadow;
mod splitting;
pub mod tally;
pub mod walk;
mod walker;

use super::{Refusal, Setup};
use crate::recipes::inequality;
use media::Majorants;
use theory::problems::Scene;
use theory::space::WalkBound;

pub use numeric::geometry::exit;
pub use particle::{ParticleSettings, Splitting};
pub use tally::Tally;
pub use walker::{Splitter, Walked, Walker};

/// Maximum expected number of collisions on a straight line through a volume; more are a mistake in the case.
const MAX_COLLISIONS: f64 = 1e4;

/// The arguments of bounds on the walks of a particle.
pub fn walks(scene: &Scene, majorants: &Majorants, particle: &ParticleSettings) -> WalkBound {
    WalkBound {
        rule: particle.rule,
        roulette: particle.roulette,
        splits: particle.splitting != Splitting::None,
        largest_ratio: majorants.largest_ratio(),
        albedo: scene.albedo.range(),
        depth: majorants.largest() * majorants.bounds().diameter(),
    }
}

/// Checks that a rule is valid for a σ̂, and that its walks end within reason.
///
/// # Errors
///
/// The violated inequality.
pub fn realisable<P: Walked>(setup: &Setup<P>, particle: &ParticleSettings) -> Result<(), Refusal> {
    let walks = walks(setup.problem.scene(), &setup.fields, particle);
    if walks.depth > MAX_COLLISIONS {
        let needs = "∫σ̂ ≤ 1e4 straight through the volume";
        return Err(Refusal::mismatch(needs, format!("it may be {:e}", walks.depth)));
    }
    let limit = particle.rule.limits(walks.albedo[1])[1];
    if walks.ratio() > limit {
        let needs = inequality(particle.rule.range());
        let actual = format!("σ_t may reach {:.6} times σ̂ in the volume", walks.ratio());
        return Err(Refusal::mismatch(needs, actual));
    }
    Ok(())
}

/// Checks that the variance of the energy of a particle has a bound.
///
/// # Errors
///
/// Why no bound is known, and what would help.
pub fn bounded(walks: &WalkBound) -> Result<(), Refusal> {
    if walks.energy_variance().is_some() {
        return Ok(());
    }
    let needs = "a variance that theory bounds: r < 2/(a + 1), or r ≤ 1 with roulette";
    let actual =
        format!("σ_t may reach {:.6} times σ̂; raise σ̂, or take local majorants", walks.ratio());
    Err(Refusal::mismatch(needs, actual))
}
