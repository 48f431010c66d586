//! What both pages share: one hero scatters once, and that scores for the hero alone or, `BALANCED`, for all channels.

use fearless_simd::Level;

use super::walk::{self, Steps};
use super::{Shadow, alone, packet, realisable};
use crate::catalogue::Settings;
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup};
use crate::kernels::packet::Request;
use crate::media::Lookups;
use crate::media::body::MOST_CHANNELS;
use crate::problems::SpectralSingleScattering;
use crate::problems::spectral_single_scattering::Values;
use crate::rng::Stream;
use crate::setup::heroes::Heroes;
use crate::theory::{Prediction, spectral_single_scattering as theory};

/// The walk of one hero.
#[derive(Debug, Clone)]
pub struct OneHero<const BALANCED: bool> {
    /// The law of the hero.
    pub heroes: Heroes,
    /// How shadow rays are tracked.
    pub shadow: Shadow,
}

impl<const BALANCED: bool> Steps for OneHero<BALANCED> {}

impl<const BALANCED: bool> Estimator<SpectralSingleScattering> for OneHero<BALANCED> {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const IN_PACKETS: bool = true;

    fn read(settings: &Settings) -> Option<Self> {
        let (heroes, shadow) = (Heroes::read(settings), Shadow::read(settings));
        Some(Self { heroes: heroes?, shadow: shadow? })
    }

    fn label(&self, _: bool) -> String {
        self.shadow.label(&self.heroes)
    }

    fn domain(&self, setup: &Setup<SpectralSingleScattering>) -> Result<(), Refusal> {
        realisable(setup, &self.heroes, self.shadow)
    }

    fn predict(&self, setup: &Setup<SpectralSingleScattering>) -> Prediction {
        let (alone, heroes) = (alone(setup, self.shadow), self.heroes.of(setup.channels.len()));
        let predict = if BALANCED { theory::balanced } else { theory::independent };
        predict(&alone, &heroes)
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SpectralSingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<Values> {
        if BALANCED {
            return walk::balanced(self, (&self.heroes, self.shadow), setup, medium, rng);
        }
        let count = setup.channels.len();
        let hero = self.heroes.choose(count, rng.uniform());
        let (lit, mut scores) = (&setup.problem.channels[hero], [0.0; MOST_CHANNELS]);
        let (s, mut path, mut lookups) = walk::scattering(self, setup, hero, medium, rng);
        if let Some(s) = s {
            let asked = (setup, hero..hero + 1);
            let (through, cast) = walk::cast(self, self.shadow, asked, &mut path, s, rng);
            let chance = self.heroes.probability(count, hero);
            scores[hero] = lit.source(s) / lit.albedo() * through[hero] / chance;
            lookups += cast;
        }
        Draw::free(setup.problem.values(scores), lookups)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<SpectralSingleScattering>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        packet::walks::<BALANCED>(level, (&self.heroes, self.shadow), setup, medium, request)
    }
}
