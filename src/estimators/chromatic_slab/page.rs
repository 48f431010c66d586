//! What both pages share: one hero walks, and where it leaves scores for itself alone or, `BALANCED`, for all channels.

use fearless_simd::Level;

use super::walk::{self, Left, Steps};
use super::{packet, realisable, spectrum};
use crate::catalogue::Settings;
use crate::estimators::spectral_furnace::page::WEIGHING;
use crate::estimators::spectral_furnace::walk::Steps as Collide;
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup};
use crate::kernels::hero::Weighing;
use crate::kernels::packet::Request;
use crate::media::Lookups;
use crate::media::body::MOST_CHANNELS;
use crate::problems::ChromaticSlab;
use crate::problems::spectral_rod::Values;
use crate::rng::Stream;
use crate::setup::heroes::Heroes;
use crate::theory::Prediction;

/// The walk of one hero.
#[derive(Debug, Clone)]
pub struct OneHero<const BALANCED: bool> {
    /// The law of the hero.
    pub heroes: Heroes,
}

impl<const BALANCED: bool> Collide for OneHero<BALANCED> {}
impl<const BALANCED: bool> Steps for OneHero<BALANCED> {}

/// Makes one draw by the steps of a walk, weighted in some way over all heroes.
#[inline(always)]
pub fn balanced(
    steps: &impl Steps,
    (heroes, weighing): (&Heroes, Weighing),
    setup: &Setup<ChromaticSlab>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    let (problem, count) = (&setup.problem, setup.channels.len());
    let hero = heroes.choose(count, rng.uniform());
    let Left { end, path, lookups } = walk::walk(steps, setup, medium, hero, rng);
    if end.is_none() {
        return Draw::free(problem.colours.values(None, &[0.0; MOST_CHANNELS]), lookups);
    }
    let scores = path.score(setup, heroes, weighing);
    let weighted = scores[..count].iter().enumerate();
    let sum: f64 = weighted.map(|(channel, x)| heroes.probability(count, channel) * x).sum();
    Draw { value: problem.colours.values(end, &scores), lookups, defect: (sum - 1.0).abs() }
}

impl<const BALANCED: bool> Estimator<ChromaticSlab> for OneHero<BALANCED> {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const HAS_INVARIANT: bool = BALANCED;
    const IN_PACKETS: bool = true;

    fn read(settings: &Settings) -> Option<Self> {
        Some(Self { heroes: Heroes::read(settings)? })
    }

    fn label(&self, _: bool) -> String {
        self.heroes.label()
    }

    fn domain(&self, setup: &Setup<ChromaticSlab>) -> Result<(), Refusal> {
        realisable(setup, &self.heroes)
    }

    fn predict(&self, setup: &Setup<ChromaticSlab>) -> Prediction {
        let heroes = self.heroes.of(setup.channels.len());
        let spectrum = spectrum(setup);
        if BALANCED { spectrum.balanced(&heroes) } else { spectrum.independent(&heroes) }
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<ChromaticSlab>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<Values> {
        if BALANCED {
            return balanced(self, (&self.heroes, WEIGHING), setup, medium, rng);
        }
        let count = setup.channels.len();
        let hero = self.heroes.choose(count, rng.uniform());
        let Left { end, lookups, .. } = walk::walk(self, setup, medium, hero, rng);
        let mut scores = [0.0; MOST_CHANNELS];
        scores[hero] = 1.0 / self.heroes.probability(count, hero);
        Draw::free(setup.problem.colours.values(end, &scores), lookups)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<ChromaticSlab>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        packet::walks::<BALANCED>(level, &self.heroes, setup, medium, request)
    }
}
