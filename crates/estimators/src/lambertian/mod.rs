//! Walks through a body under light from all sides.

pub mod particle;
pub mod splitting;

use crate::space::tally::{CollisionTally, Departure};
use crate::space::{self, ParticleSettings, Tally, Walked};
use crate::{Draw, Refusal, Setup, estimators};
use numeric::Lane;
use numeric::rng::Random;
use theory::problems::lambertian::Values;
use theory::problems::{Lambertian, Scene};
use theory::space::WalkBound;
use theory::space::predict::{self, WalkChannels};
use theory::{ParticleRule, Prediction};

/// Bounds on the walks of an experiment, and its channels.
fn channels(setup: &Setup<Lambertian>, particle: &ParticleSettings) -> (WalkBound, WalkChannels) {
    let (scene, majorants) = (&setup.problem.scene, &*setup.fields);
    let walks = space::walks(scene, majorants, particle);
    // Where a = 0 and r = 1 a particle keeps no weight: that ends its walk even by this rule.
    let goes_on = *particle == ParticleSettings::of(ParticleRule::NonTerminating)
        && scene.albedo.range()[0] > 0.0;
    let channels = WalkChannels {
        energy: walks.is_tame(),
        white: scene.albedo.even() == Some(1.0) && walks.never_grows(),
        tentative: goes_on && majorants.content().is_some(),
    };
    (walks, channels)
}

impl Walked for Lambertian {
    type Tally<'a> = Entering<'a>;

    fn domain(setup: &Setup<Self>, particle: &ParticleSettings) -> Result<(), Refusal> {
        space::realisable(setup, particle)?;
        let (walks, has) = channels(setup, particle);
        if has.white && predict::held(&setup.problem).is_none() {
            let needs = "a volume whose ∫σ_t dV is known to 1e-3";
            let actual = "cubature over its chords does not settle, or it is empty";
            return Err(Refusal::mismatch(needs, actual));
        }
        if has.any() { Ok(()) } else { space::bounded(&walks) }
    }

    fn predict(setup: &Setup<Self>, particle: &ParticleSettings) -> Prediction {
        let (walks, has) = channels(setup, particle);
        predict::lambertian(&setup.problem, &walks, has, setup.fields.content())
    }

    fn scene(&self) -> &Scene {
        &self.scene
    }

    fn tally<'a>(
        setup: &'a Setup<Self>,
        particle: &ParticleSettings,
    ) -> Result<Entering<'a>, Draw<Values>> {
        Ok(Entering::new(&setup.problem, channels(setup, particle).1))
    }
}

/// Particles that enter from all sides, and the sums over their collisions.
pub struct Entering<'a> {
    problem: &'a Lambertian,
    channels: [usize; 4],
    count: usize,
}

impl<'a> Entering<'a> {
    fn new(problem: &'a Lambertian, has: WalkChannels) -> Self {
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
    fn collided<L: Lane>(&self, sums: &mut [L; 4], at: &CollisionTally<L>) {
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
