//! Walks into a furnace.

pub mod particle;
pub mod splitting;

use crate::space::tally::{CollisionTally, Departure};
use crate::space::{self, ParticleSettings, Tally, Walked};
use crate::{Draw, Refusal, Setup, estimators};
use numeric::Lane;
use numeric::rng::Random;
use theory::Prediction;
use theory::problems::{Furnace, Scene};
use theory::space::predict;

impl Walked for Furnace {
    type Tally<'a> = Energy<'a>;

    fn domain(setup: &Setup<Self>, particle: &ParticleSettings) -> Result<(), Refusal> {
        space::realisable(setup, particle)?;
        space::bounded(&space::walks(&setup.problem.scene, &setup.fields, particle))
    }

    /// Prediction: every draw is 1 on average.
    fn predict(setup: &Setup<Self>, particle: &ParticleSettings) -> Prediction {
        predict::furnace(&space::walks(&setup.problem.scene, &setup.fields, particle))
    }

    fn scene(&self) -> &Scene {
        &self.scene
    }

    fn tally<'a>(setup: &'a Setup<Self>, _: &ParticleSettings) -> Result<Energy<'a>, Draw> {
        Ok(Energy(&setup.problem))
    }
}

/// The energy of a particle.
pub struct Energy<'a>(&'a Furnace);

impl Tally for Energy<'_> {
    type Found<L: Lane> = [L; 1];

    #[inline(always)]
    fn nothing<L: Lane>(&self, zero: L) -> [L; 1] {
        [zero]
    }

    #[inline(always)]
    fn value<L: Lane>(&self, [energy]: &[L; 1], _: usize) -> L {
        *energy
    }

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> [[L; 3]; 2] {
        [self.0.entry.each(one), self.0.direction.each(one)]
    }

    #[inline(always)]
    fn collided<L: Lane>(&self, [energy]: &mut [L; 1], at: &CollisionTally<L>) {
        energy.add_where(at.inside, at.weight * at.ratio * at.albedo.one_minus());
    }

    #[inline(always)]
    fn escaped<L: Lane>(&self, [energy]: &mut [L; 1], at: &Departure<L>) {
        energy.add_where(at.left, at.weight);
    }
}

estimators! {
    Furnace on Space:
    particle::Walker,
    splitting::Splitter,
}
