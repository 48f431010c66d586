//! Walks that gather the light of a sky.

pub mod particle;
pub mod splitting;

use fearless_simd::{Level, Simd, mask64x8};

use crate::kernels::packet::Request;
use crate::kernels::packet::bank::Numbers;
use crate::space::exit::{Points, splat};
use crate::space::packet::walks;
use crate::space::tally::{Departure, add_where};
use crate::space::{self, By, Particle, Start, Sums, Tally, Walked};
use crate::{Draw, Refusal, Setup, estimators};
use numeric::geometry::Point;
use numeric::rng::Stream;
use numeric::{Known, Lane};
use theory::problems::MultipleScattering;
use theory::{Channel, CountLaw, Moments, Prediction, Tails};

impl Walked for MultipleScattering {
    /// Its draws may be spread without bound all the same, see `furnace`.
    fn domain(setup: &Setup<Self>, particle: &Particle) -> Result<(), Refusal> {
        space::realisable(setup, &setup.problem.scene, particle)
    }

    /// What is seen beside the volume, and nothing else.
    fn predict(setup: &Setup<Self>, _: &Particle) -> Prediction {
        let problem = &setup.problem;
        if problem.entry().is_some() {
            let unknown = Known::new(0.0, f64::INFINITY);
            let certain = Channel::unbiased(unknown, Moments::certain(0.0), Tails::LIGHT);
            let channel = Channel { moments: None, ..certain };
            return Prediction::uncounted(channel);
        }
        let seen = problem.background();
        let channel = Channel::unbiased(Known::exact(seen), Moments::certain(seen), Tails::LIGHT);
        Prediction::single(channel, CountLaw::always(0.0))
    }

    fn draw(by: By, _: &Particle, setup: &Setup<Self>, rng: &mut Stream) -> Draw {
        let problem = &*setup.problem;
        let (Some([place, direction]), Some(majorants)) = (problem.entry(), setup.space.as_deref())
        else {
            return Draw::free([problem.background()], 0);
        };
        let start = Start { place, direction, weight: 1.0 };
        let mut sums = Sums::new(problem);
        let lookups = space::walk(by, &problem.scene, majorants, start, &mut sums, rng);
        Draw::free(sums.at, lookups)
    }

    fn draw_packets<'a>(
        level: Level,
        particle: &Particle,
        setup: &Setup<Self>,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        let problem = &*setup.problem;
        if problem.entry().is_none() {
            return Some(request);
        }
        walks(level, problem, particle, (&problem.scene, setup.space.as_ref()), request)
    }
}

/// The light of the sky that a walk gathers.
impl Tally<1> for MultipleScattering {
    #[inline(always)]
    fn begin<S: Simd>(&self, simd: S, _: &mut Numbers<S>, _: mask64x8<S>) -> [Points<S>; 2] {
        let [place, direction] = self.entry().unwrap_or([Point([0.0; 3]); 2]);
        [splat(simd, place), splat(simd, direction)]
    }

    #[inline(always)]
    fn escaped<L: Lane>(&self, [radiance]: &mut [L; 1], at: &Departure<L>) {
        add_where(radiance, at.left, at.weight * self.sky.radiance_lanes(at.direction));
    }

    fn channels(&self) -> &[usize] {
        &[0]
    }
}

estimators! {
    MultipleScattering:
    particle::Walker,
    splitting::Splitter,
}
