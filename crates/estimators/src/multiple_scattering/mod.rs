//! Walks that gather the light of a sky.

pub mod particle;
pub mod splitting;

use crate::space::tally::Departure;
use crate::space::{self, ParticleSettings, Tally, Walked};
use crate::{Draw, Refusal, Setup, estimators};
use numeric::Lane;
use numeric::geometry::Point;
use numeric::rng::Random;
use theory::Prediction;
use theory::problems::{MultipleScattering, Scene, Sky};
use theory::space::predict;

impl Walked for MultipleScattering {
    type Tally<'a> = Gathering<'a>;

    /// Checks σ̂ and the rule; the variance of draws may be infinite all the same, see `furnace`.
    fn domain(setup: &Setup<Self>, particle: &ParticleSettings) -> Result<(), Refusal> {
        space::realisable(setup, particle)
    }

    /// Prediction of the light that is seen beside the volume; through the volume the mean is unknown.
    fn predict(setup: &Setup<Self>, _: &ParticleSettings) -> Prediction {
        predict::sky(&setup.problem)
    }

    fn scene(&self) -> &Scene {
        &self.scene
    }

    fn tally<'a>(setup: &'a Setup<Self>, _: &ParticleSettings) -> Result<Gathering<'a>, Draw> {
        let problem = &*setup.problem;
        match problem.entry() {
            Some(entry) => Ok(Gathering { sky: &problem.sky, entry }),
            None => Err(Draw::free([problem.background()], 0)),
        }
    }
}

/// The light of the sky that a walk gathers.
pub struct Gathering<'a> {
    sky: &'a Sky,
    /// The place where walks begin, and the direction.
    entry: [Point; 2],
}

impl Tally for Gathering<'_> {
    type Found<L: Lane> = [L; 1];

    #[inline(always)]
    fn nothing<L: Lane>(&self, zero: L) -> [L; 1] {
        [zero]
    }

    #[inline(always)]
    fn value<L: Lane>(&self, [light]: &[L; 1], _: usize) -> L {
        *light
    }

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> [[L; 3]; 2] {
        let [place, direction] = self.entry;
        [place.each(one), direction.each(one)]
    }

    #[inline(always)]
    fn escaped<L: Lane>(&self, [radiance]: &mut [L; 1], at: &Departure<L>) {
        radiance.add_where(at.left, at.weight * self.sky.radiance_lanes(at.direction));
    }
}

estimators! {
    MultipleScattering on Space:
    particle::Walker,
    splitting::Splitter,
}
