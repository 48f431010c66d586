//! Common parts of the pages that score all channels: a walk scatters once, and its weights are relative to the
//! density of the walker, or of all heroes.

use super::walk;
use super::{Shadow, predict, predict_independent, realisable};
use crate::setup::channels;
use crate::setup::walker::{INDEPENDENT, Walker};
use crate::{Estimator, Inputs, Kernel, Refusal, Request, Setup, Traits};
use media::catalogue::Settings;
use theory::Prediction;
use theory::problems::SpectralSingleScattering;

/// An estimator of a kind.
#[derive(Debug, Clone)]
pub struct OfKind<const KIND: u8> {
    walker: Walker,
    /// Tracking of shadow rays.
    shadow: Shadow,
}

impl<const KIND: u8> Estimator<SpectralSingleScattering> for OfKind<KIND> {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Self> {
        let (walker, shadow) = (Walker::read(KIND, settings), Shadow::read(settings));
        Some(Self { walker: walker?, shadow: shadow? })
    }

    fn traits(&self) -> Traits {
        let settings = self.shadow.label(&self.walker.label());
        Traits { settings, needs: self.shadow.needs(), ..Traits::of(Self::INPUTS) }
    }

    fn domain(&self, setup: &Setup<SpectralSingleScattering>) -> Result<(), Refusal> {
        if KIND == INDEPENDENT {
            self.walker.require(&setup.fields)?;
            channels::require_majorants(&setup.fields)?;
        } else {
            self.walker.require_on_ray(&setup.fields)?;
        }
        realisable(setup, self.shadow)
    }

    fn predict(&self, setup: &Setup<SpectralSingleScattering>) -> Prediction {
        if KIND == INDEPENDENT {
            predict_independent(setup, &self.walker, self.shadow)
        } else {
            predict(setup, &self.walker, self.shadow)
        }
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<SpectralSingleScattering>, request: Request) {
        let by = (&self.walker, self.shadow);
        if KIND == INDEPENDENT {
            walk::fill::<false>(by, kernel, setup, request);
        } else {
            walk::fill::<true>(by, kernel, setup, request);
        }
    }
}
