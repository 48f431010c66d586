//! All channels by one draw: the page of a hero, of spectral tracking and of the balance heuristic, in all bodies.

use super::{By, Chromatic, WEIGHING, draw};
use crate::setup::heroes::Heroes;
use crate::setup::walker::{MIS, Walker};
use crate::{Estimator, Inputs, Kernel, Refusal, Request, Setup, walks};
use media::catalogue::Settings;
use theory::Prediction;
use theory::spectral::Chances;

/// A walk that scores all channels, of a kind of walker.
#[derive(Debug, Clone)]
pub struct AllChannels<const KIND: u8> {
    /// Walker that makes the walks.
    pub walker: Walker,
}

impl<P: Chromatic, const KIND: u8> Estimator<P> for AllChannels<KIND> {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const HAS_INVARIANT: bool = KIND == MIS;

    fn read(settings: &Settings) -> Option<Self> {
        Some(Self { walker: Walker::read(KIND, settings)? })
    }

    fn label(&self, _: bool) -> String {
        self.walker.label()
    }

    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal> {
        P::require(setup, &self.walker)?;
        match &self.walker {
            Walker::Hero(_) | Walker::SpectralTracking(Chances::Fixed(_)) => {
                P::second_moment_bounds(setup, &self.walker).map(|_| ())
            }
            Walker::Mis(_) | Walker::SpectralTracking(Chances::History) => Ok(()),
        }
    }

    fn predict(&self, setup: &Setup<P>) -> Prediction {
        let count = setup.channels.len();
        match &self.walker {
            Walker::Mis(heroes) => P::predict_balanced(setup, &heroes.of(count)),
            // Its scores are those of the balance heuristic with equal heroes, and its walks are the same.
            Walker::SpectralTracking(Chances::History) => {
                P::predict_balanced(setup, &Heroes::Uniform.of(count))
            }
            Walker::Hero(_) | Walker::SpectralTracking(Chances::Fixed(_)) => {
                let second_moment_bounds = P::second_moment_bounds(setup, &self.walker);
                let second_moment_bounds =
                    second_moment_bounds.unwrap_or_else(|_| vec![f64::INFINITY; count]);
                P::predict_relative(setup, &self.walker, &second_moment_bounds)
            }
        }
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<P>, request: Request) {
        walks::by(
            kernel,
            setup,
            request,
            |level, medium, request| {
                let by = By { walker: &self.walker, weighing: WEIGHING, scores_all: true };
                P::packets(level, by, setup, medium, request)
            },
            #[inline(always)]
            |medium, rng| draw(&self.walker, true, setup, medium, rng),
        );
    }
}
