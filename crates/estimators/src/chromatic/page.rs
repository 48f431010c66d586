//! The page of all walkers in all bodies: their settings, domain, prediction and draws.

use super::{Chromatic, WalkerWeights, fill};
use crate::setup::heroes::Heroes;
use crate::setup::walker::{INDEPENDENT, MIS, Walker};
use crate::{Estimator, Inputs, Kernel, Refusal, Request, Setup, Traits};
use media::catalogue::Settings;
use theory::Prediction;
use theory::colours::Chances;

/// An estimator of a kind.
#[derive(Debug, Clone)]
pub struct OfKind<const KIND: u8>(Walker);

impl<const KIND: u8> OfKind<KIND> {
    /// True if draws score all channels, false if they score the hero's alone.
    const SCORES_ALL: bool = KIND != INDEPENDENT;

    /// True if draws are relative to the density of one walker, so that their second moments need a bound.
    fn is_relative(&self) -> bool {
        let is_fixed =
            matches!(self.0, Walker::Hero(_) | Walker::SpectralTracking(Chances::Fixed(_)));
        Self::SCORES_ALL && is_fixed
    }
}

impl<P: Chromatic, const KIND: u8> Estimator<P> for OfKind<KIND> {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Self> {
        Walker::read(KIND, settings).map(Self)
    }

    fn traits(&self) -> Traits {
        let traits = Traits::of(Inputs::SAMPLING);
        Traits { settings: self.0.label(), has_invariant: KIND == MIS, ..traits }
    }

    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal> {
        P::require(setup, &self.0)?;
        if self.is_relative() {
            P::second_moment_bounds(setup, &self.0)?;
        }
        Ok(())
    }

    fn predict(&self, setup: &Setup<P>) -> Prediction {
        let count = setup.fields.len();
        if self.is_relative() {
            let bounds = P::second_moment_bounds(setup, &self.0);
            let bounds = bounds.unwrap_or_else(|_| vec![f64::INFINITY; count]);
            return P::predict_relative(setup, &self.0, &bounds);
        }
        // Chances that depend on the weights score what equal heroes score by the balance heuristic.
        let heroes = self.0.heroes().unwrap_or(&Heroes::Uniform).of(count);
        if Self::SCORES_ALL {
            P::predict_balanced(setup, &heroes)
        } else {
            P::predict_independent(setup, &heroes)
        }
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<P>, request: Request) {
        fill(WalkerWeights::new(&self.0, Self::SCORES_ALL), kernel, setup, request);
    }
}
