//! Walks into a furnace.

pub mod particle;
pub mod splitting;

use fearless_simd::{Level, Simd, mask64x8};

use crate::kernels::packet::Request;
use crate::kernels::packet::bank::Numbers;
use crate::space::exit::{Points, splat};
use crate::space::packet::walks;
use crate::space::tally::{Collision, Departure, add_where};
use crate::space::{self, By, Particle, Start, Sums, Tally, Walked};
use crate::{Draw, Refusal, Setup, estimators};
use numeric::Lane;
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::Furnace;

impl Walked for Furnace {
    fn domain(setup: &Setup<Self>, particle: &Particle) -> Result<(), Refusal> {
        let scene = &setup.problem.scene;
        space::realisable(setup, scene, particle)?;
        space::energy(&space::walks(scene, space::majorants(setup)?, particle)).map(|_| ())
    }

    /// Every draw is 1 on average.
    fn predict(setup: &Setup<Self>, particle: &Particle) -> Prediction {
        let majorants = setup.space.as_ref();
        let walks = majorants.map(|all| space::walks(&setup.problem.scene, all, particle));
        let bound = walks.and_then(|walks| walks.energy_variance());
        // Without a bound the walk is refused, or forced: then only the truth is kept.
        let depth = walks.map_or(0.0, |walks| walks.depth);
        Prediction::uncounted(space::energy_channel(bound.unwrap_or(f64::INFINITY), depth))
    }

    fn draw(by: By, _: &Particle, setup: &Setup<Self>, rng: &mut Stream) -> Draw {
        let furnace = &*setup.problem;
        let Some(majorants) = setup.space.as_deref() else {
            // Without σ̂ there is nothing to draw; such an experiment is refused.
            return Draw::free([f64::NAN], 0);
        };
        let start = Start { place: furnace.entry, direction: furnace.direction, weight: 1.0 };
        let mut sums = Sums::new(furnace);
        let lookups = space::walk(by, &furnace.scene, majorants, start, &mut sums, rng);
        Draw::free(sums.at, lookups)
    }

    fn draw_packets<'a>(
        level: Level,
        particle: &Particle,
        setup: &Setup<Self>,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        let furnace = &*setup.problem;
        walks(level, furnace, particle, (&furnace.scene, setup.space.as_ref()), request)
    }
}

/// The energy that a particle brings.
impl Tally<1> for Furnace {
    #[inline(always)]
    fn begin<S: Simd>(&self, simd: S, _: &mut Numbers<S>, _: mask64x8<S>) -> [Points<S>; 2] {
        [splat(simd, self.entry), splat(simd, self.direction)]
    }

    #[inline(always)]
    fn collided<L: Lane>(&self, [energy]: &mut [L; 1], at: &Collision<L>) {
        let rest = at.albedo.each(1.0) - at.albedo;
        add_where(energy, at.inside, at.weight * at.ratio * rest);
    }

    #[inline(always)]
    fn escaped<L: Lane>(&self, [energy]: &mut [L; 1], at: &Departure<L>) {
        add_where(energy, at.left, at.weight);
    }

    fn channels(&self) -> &[usize] {
        &[0]
    }
}

estimators! {
    Furnace:
    particle::Walker,
    splitting::Splitter,
}
