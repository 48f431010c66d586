//! One channel a draw, by an analog walk through its own medium: the page of all bodies.

use fearless_simd::Level;

use super::{By, Chromatic, WEIGHING, draw};
use crate::kernels::packet::Request;
use crate::setup::heroes::Heroes;
use crate::setup::walker::Walker;
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::Lookups;
use media::catalogue::Settings;
use numeric::rng::Stream;
use theory::Prediction;

/// One channel a draw.
#[derive(Debug, Clone)]
pub struct Independent {
    heroes: Heroes,
    /// The walk of its hero.
    walker: Walker,
}

impl<P: Chromatic> Estimator<P> for Independent {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const IN_PACKETS: bool = true;

    fn read(settings: &Settings) -> Option<Self> {
        let heroes = Heroes::read(settings)?;
        Some(Self { walker: Walker::Hero(heroes.clone()), heroes })
    }

    fn label(&self, _: bool) -> String {
        self.heroes.label()
    }

    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal> {
        P::require(setup, &self.walker)
    }

    fn predict(&self, setup: &Setup<P>) -> Prediction {
        P::predict_independent(setup, &self.heroes.of(setup.channels.len()))
    }

    #[inline(always)]
    fn draw(&self, setup: &Setup<P>, medium: &Lookups, rng: &mut Stream) -> Draw<P::Value> {
        draw(&self.walker, false, setup, medium, rng)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<P>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        let by = By { walker: &self.walker, weighing: WEIGHING, scores_all: false };
        P::packets(level, by, setup, medium, request)
    }
}
