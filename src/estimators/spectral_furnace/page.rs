//! What both pages share: one hero walks, and the walk scores for the hero alone or, `BALANCED`, for all channels.

use fearless_simd::Level;

use super::walk::{self, Steps};
use super::{packet, realisable};
use crate::catalogue::Settings;
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup};
use crate::kernels::hero::Weighing;
use crate::kernels::packet::Request;
use crate::media::Lookups;
use crate::media::body::MOST_CHANNELS;
use crate::problems::SpectralFurnace;
use crate::problems::spectral_furnace::Values;
use crate::rng::Stream;
use crate::setup::heroes::Heroes;
use crate::theory::{Prediction, spectral_furnace as theory};

/// The walk of one hero.
#[derive(Debug, Clone)]
pub struct OneHero<const BALANCED: bool> {
    /// The law of the hero.
    pub heroes: Heroes,
}

impl<const BALANCED: bool> Steps for OneHero<BALANCED> {}

/// How the balance heuristic weights a walk: there are no shadow rays.
pub const WEIGHING: Weighing = Weighing { has_next_event: false, ..Weighing::RIGHT };

/// Makes one draw by the steps of a walk, weighted in some way over all heroes.
#[inline(always)]
pub fn balanced(
    steps: &impl Steps,
    (heroes, weighing): (&Heroes, Weighing),
    setup: &Setup<SpectralFurnace>,
    rng: &mut Stream,
) -> Draw<Values> {
    let count = setup.channels.len();
    let hero = heroes.choose(count, rng.uniform());
    let (path, lookups) = walk::walk(steps, setup, hero, rng);
    let scores = path.score(setup, heroes, weighing);
    let weighted = scores[..count].iter().enumerate();
    let sum: f64 = weighted.map(|(channel, x)| heroes.probability(count, channel) * x).sum();
    Draw { value: setup.problem.values(scores), lookups, defect: (sum - 1.0).abs() }
}

impl<const BALANCED: bool> Estimator<SpectralFurnace> for OneHero<BALANCED> {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const HAS_INVARIANT: bool = BALANCED;
    const IN_PACKETS: bool = true;

    fn read(settings: &Settings) -> Option<Self> {
        Some(Self { heroes: Heroes::read(settings)? })
    }

    fn label(&self, _: bool) -> String {
        self.heroes.label()
    }

    fn domain(&self, setup: &Setup<SpectralFurnace>) -> Result<(), Refusal> {
        realisable(setup, &self.heroes)
    }

    fn predict(&self, setup: &Setup<SpectralFurnace>) -> Prediction {
        let heroes = self.heroes.of(setup.channels.len());
        if BALANCED { theory::balanced(&heroes) } else { theory::independent(&heroes) }
    }

    #[inline(always)]
    fn draw(&self, setup: &Setup<SpectralFurnace>, _: &Lookups, rng: &mut Stream) -> Draw<Values> {
        if BALANCED {
            return balanced(self, (&self.heroes, WEIGHING), setup, rng);
        }
        let count = setup.channels.len();
        let hero = self.heroes.choose(count, rng.uniform());
        let (_, lookups) = walk::walk(self, setup, hero, rng);
        let mut scores = [0.0; MOST_CHANNELS];
        scores[hero] = 1.0 / self.heroes.probability(count, hero);
        Draw::free(setup.problem.values(scores), lookups)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<SpectralFurnace>,
        _: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        packet::walks::<BALANCED>(level, &self.heroes, setup, request)
    }
}
