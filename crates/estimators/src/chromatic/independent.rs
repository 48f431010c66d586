//! Analog walks of one channel a draw, each through its own medium: the page of all bodies.

use super::{By, Chromatic, WEIGHING, draw};
use crate::setup::heroes::Heroes;
use crate::setup::walker::Walker;
use crate::{Estimator, Inputs, Kernel, Refusal, Request, Setup, walks};
use media::catalogue::Settings;
use theory::Prediction;

/// Analog walks of one channel a draw.
#[derive(Debug, Clone)]
pub struct Independent {
    heroes: Heroes,
    /// The walk of its hero.
    walker: Walker,
}

impl<P: Chromatic> Estimator<P> for Independent {
    const INPUTS: Inputs = Inputs::SAMPLING;

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

    fn fill(&self, kernel: Kernel, setup: &Setup<P>, request: Request) {
        walks::by(
            kernel,
            setup,
            request,
            |level, medium, request| {
                let by = By { walker: &self.walker, weighing: WEIGHING, scores_all: false };
                P::packets(level, by, setup, medium, request)
            },
            #[inline(always)]
            |medium, rng| draw(&self.walker, false, setup, medium, rng),
        );
    }
}
