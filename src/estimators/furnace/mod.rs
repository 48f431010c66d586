//! Walks into a furnace.

pub mod particle;
pub mod splitting;

use fearless_simd::{Level, Simd, f64x8, mask64x8};

use crate::estimators::packet::Request;
use crate::estimators::space::exit::{Points, splat};
use crate::estimators::space::packet::{Collisions, Departures, Numbers, add_where, walks};
use crate::estimators::space::{self, Collision, Particle, Sink, Start, Steps, Tally};
use crate::estimators::{Draw, Refusal, Setup, estimators};
use crate::geometry::Point;
use crate::numeric::Lane;
use crate::problems::Furnace;
use crate::rng::Stream;
use crate::theory::{CountLaw, Prediction};

/// What a particle has brought.
#[derive(Debug, Clone, Copy, Default)]
struct Energy(f64);

impl Sink for Energy {
    fn collided(&mut self, at: &Collision) {
        self.0 += at.weight * at.ratio * (1.0 - at.albedo);
    }

    fn escaped(&mut self, _: Point, _: Point, weight: f64, _: u32) {
        self.0 += weight;
    }
}

/// Whether a rule exists here, and its spread has a bound.
pub(super) fn domain(setup: &Setup<Furnace>, particle: &Particle) -> Result<(), Refusal> {
    let scene = &setup.problem.scene;
    space::realisable(setup, scene, particle)?;
    space::energy(&space::walks(scene, space::majorants(setup)?, particle)).map(|_| ())
}

/// What theory says: every draw is 1 on average.
pub(super) fn predict(setup: &Setup<Furnace>, particle: &Particle) -> Prediction {
    let walks = setup
        .space
        .as_ref()
        .map(|majorants| space::walks(&setup.problem.scene, majorants, particle));
    let bound = walks.and_then(|walks| walks.energy_variance());
    // Without a bound the walk is refused, or forced: then only the truth is kept.
    let depth = walks.map_or(0.0, |walks| walks.depth);
    let channel = space::energy_channel(bound.unwrap_or(f64::INFINITY), depth);
    let prediction = Prediction::single(channel, CountLaw::always(0.0));
    Prediction { lookups: None, ..prediction }
}

/// Makes a draw by the honest walk.
pub(super) fn draw(
    particle: &Particle,
    setup: &Setup<Furnace>,
    rng: &mut Stream,
) -> Draw<[f64; 1]> {
    draw_by(setup, |scene, majorants, start, energy| {
        space::walk(particle, scene, majorants, start, energy, rng)
    })
}

impl Tally<1> for Furnace {
    #[inline(always)]
    fn begin<S: Simd>(&self, simd: S, _: &mut Numbers<S>, _: mask64x8<S>) -> [Points<S>; 2] {
        [splat(simd, self.entry), splat(simd, self.direction)]
    }

    #[inline(always)]
    fn collided<S: Simd>(&self, [energy]: &mut [f64x8<S>; 1], at: &Collisions<S>) {
        let rest = at.albedo.each(1.0) - at.albedo;
        add_where(energy, at.inside, at.weight * at.ratio * rest);
    }

    #[inline(always)]
    fn escaped<S: Simd>(&self, [energy]: &mut [f64x8<S>; 1], at: &Departures<S>) {
        add_where(energy, at.left, at.weight);
    }

    fn channels(&self) -> &[usize] {
        &[0]
    }
}

/// Makes draws by packets.
pub(super) fn draw_packets<'a>(
    level: Level,
    particle: &Particle,
    setup: &Setup<Furnace>,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let Some(majorants) = setup.space.as_deref() else { return Some(request) };
    let furnace = &*setup.problem;
    walks(level, furnace, particle, (&furnace.scene, majorants), request)
}

/// Makes a draw by any steps.
pub fn draw_with(steps: &dyn Steps, setup: &Setup<Furnace>, rng: &mut Stream) -> Draw<[f64; 1]> {
    draw_by(setup, |scene, majorants, start, energy| {
        space::walk_by(steps, scene, majorants, start, energy, rng)
    })
}

fn draw_by(
    setup: &Setup<Furnace>,
    walk: impl FnOnce(&crate::problems::Scene, &crate::media::Majorants, Start, &mut Energy) -> u32,
) -> Draw<[f64; 1]> {
    let furnace = &*setup.problem;
    let Some(majorants) = setup.space.as_deref() else {
        // Without σ̂ there is nothing to draw; such an experiment is refused.
        return Draw::free([f64::NAN], 0);
    };
    let start = Start { place: furnace.entry, direction: furnace.direction, weight: 1.0 };
    let mut energy = Energy::default();
    let lookups = walk(&furnace.scene, majorants, start, &mut energy);
    Draw::free([energy.0], lookups)
}

estimators! {
    Furnace:
    particle::Walker,
    splitting::Splitter,
}
