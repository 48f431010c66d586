//! Walks through a body under light from all sides.

pub mod particle;
pub mod splitting;

use crate::space::tally::{Collision, Departure};
use crate::space::{self, Particle, Tally, Walked};
use crate::{Draw, Refusal, Setup, estimators};
use numeric::rng::Random;
use numeric::{Known, Lane};
use theory::problems::lambertian::Values;
use theory::problems::{Lambertian, Scene};
use theory::space::content;
use theory::{Channel, Moments, ParticleRule, Prediction, Tails};

/// Maximum relative error of `∫σ_t dV` that draws are compared with.
const BLURRED: f64 = 1e-3;

/// Channels of an experiment, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Channels {
    energy: bool,
    white: bool,
    tentative: bool,
}

impl Channels {
    fn of(setup: &Setup<Lambertian>, particle: &Particle) -> Self {
        let (scene, majorants) = (&setup.problem.scene, &*setup.fields);
        let walks = space::walks(scene, majorants, particle);
        // Where a = 0 and r = 1 a particle keeps no weight: that ends its walk even by this rule.
        let goes_on = *particle == Particle::of(ParticleRule::NonTerminating)
            && scene.albedo.range()[0] > 0.0;
        Self {
            energy: walks.is_tame(),
            white: scene.albedo.even() == Some(1.0) && walks.never_grows(),
            tentative: goes_on && majorants.content().is_some(),
        }
    }

    fn any(self) -> bool {
        self.energy || self.white || self.tentative
    }
}

/// `∫σ_t dV`, if its error is small enough.
fn held(setup: &Setup<Lambertian>) -> Option<Known> {
    let held = setup.problem.content(|| content::content(&*setup.problem.scene.volume));
    held.filter(|known| known.error <= BLURRED * known.value && known.value > 0.0)
}

/// A channel of unknown variance, with light tails.
fn piloted(name: &str, truth: Known) -> Channel {
    let certain = Channel::unbiased(truth, Moments::certain(truth.value), Tails::LIGHT);
    Channel { name: name.to_owned(), moments: None, pilot_variance_allowed: true, ..certain }
}

impl Walked for Lambertian {
    type Tally<'a> = Entering<'a>;

    fn domain(setup: &Setup<Self>, particle: &Particle) -> Result<(), Refusal> {
        space::realisable(setup, particle)?;
        let has = Channels::of(setup, particle);
        if has.white && held(setup).is_none() {
            let needs = "a volume whose ∫σ_t dV is known to 1e-3";
            return Err(Refusal::mismatch(
                needs,
                "cubature over its chords does not settle, or it is empty",
            ));
        }
        if has.any() {
            return Ok(());
        }
        space::energy(&space::walks(&setup.problem.scene, &setup.fields, particle)).map(|_| ())
    }

    fn predict(setup: &Setup<Self>, particle: &Particle) -> Prediction {
        let (problem, has) = (&setup.problem, Channels::of(setup, particle));
        let mut channels = Vec::new();
        let walks = space::walks(&problem.scene, &setup.fields, particle);
        let bound = walks.energy_variance().filter(|_| has.energy);
        let named = |bound| Channel {
            name: "energy".to_owned(),
            ..space::energy_channel(bound, walks.depth)
        };
        channels.extend(bound.map(named));
        let over = problem.four_over_surface();
        let times = |known: Known| {
            let scaled = known * over;
            scaled.blurred(4.0 * f64::EPSILON * scaled.value)
        };
        if has.white {
            channels.push(piloted("path length", times(Known::exact(problem.bounds().content()))));
            channels.push(piloted("collisions", times(held(setup).unwrap_or(Known::UNKNOWN))));
        }
        if let Some(content) = setup.fields.content().filter(|_| has.tentative) {
            channels.push(piloted("tentative collisions", times(Known::exact(content))));
        }
        if channels.is_empty() {
            // The setup is refused, or its draws are made in spite of that and have no prediction.
            channels.push(space::energy_channel(f64::INFINITY, 0.0));
        }
        Prediction { channels, ..Prediction::default() }
    }

    fn scene(&self) -> &Scene {
        &self.scene
    }

    fn tally<'a>(
        setup: &'a Setup<Self>,
        particle: &Particle,
    ) -> Result<Entering<'a>, Draw<Values>> {
        Ok(Entering::new(&setup.problem, Channels::of(setup, particle)))
    }
}

/// Particles that enter from all sides, and the sums over their collisions.
pub struct Entering<'a> {
    problem: &'a Lambertian,
    channels: [usize; 4],
    count: usize,
}

impl<'a> Entering<'a> {
    fn new(problem: &'a Lambertian, has: Channels) -> Self {
        let mut entering = Self { problem, channels: [0; 4], count: 0 };
        let has = [has.energy, has.white, has.white, has.tentative];
        for (sum, _) in has.into_iter().enumerate().filter(|(_, has)| *has) {
            entering.channels[entering.count] = sum;
            entering.count += 1;
        }
        entering
    }
}

/// Energy, path length, collisions, tentative collisions.
impl Tally for Entering<'_> {
    type Found<L: Lane> = [L; 4];

    #[inline(always)]
    fn nothing<L: Lane>(&self, zero: L) -> [L; 4] {
        [zero; 4]
    }

    #[inline(always)]
    fn channels(&self) -> usize {
        self.count
    }

    #[inline(always)]
    fn value<L: Lane>(&self, sums: &[L; 4], channel: usize) -> L {
        L::one_of(sums, self.channels[channel])
    }

    #[inline(always)]
    fn begin<L: Lane>(&self, _: L, which: L::Mask, random: &mut impl Random<L>) -> [[L; 3]; 2] {
        let (u, v) = (random.uniform_where(which), random.uniform_where(which));
        let problem = self.problem;
        u.outlined_if_narrow(
            #[inline(always)]
            move || problem.boundary_lanes([u, v]),
        )
    }

    fn begins_turned(&self) -> bool {
        true
    }

    #[inline(always)]
    fn first_cosine<L: Lane>(&self, number: L) -> L {
        number.one_minus().root()
    }

    #[inline(always)]
    fn flown<L: Lane>(&self, sums: &mut [L; 4], length: L, weight: L) {
        sums[1] = sums[1] + weight * length;
    }

    #[inline(always)]
    fn collided<L: Lane>(&self, sums: &mut [L; 4], at: &Collision<L>) {
        let [energy, _, collisions, tentative] = sums;
        let real = at.weight * at.ratio;
        tentative.count_where(at.inside);
        collisions.add_where(at.inside, real);
        energy.add_where(at.inside, real * at.albedo.one_minus());
    }

    #[inline(always)]
    fn escaped<L: Lane>(&self, [energy, ..]: &mut [L; 4], at: &Departure<L>) {
        energy.add_where(at.left, at.weight);
    }
}

estimators! {
    Lambertian on Space:
    particle::Walker,
    splitting::Splitter,
}
