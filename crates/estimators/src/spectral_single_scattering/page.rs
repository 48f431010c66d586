//! Common parts of the pages that score all channels: a walk scatters once, and its weights are relative to the
//! density of the walker, or of all heroes.

use super::walk::{self, Right};
use super::{Shadow, predict, predict_independent, realisable};
use crate::setup::channels;
use crate::setup::walker::{INDEPENDENT, Walker};
use crate::{Draw, Estimator, Inputs, Kernel, Refusal, Request, Setup, walks};
use media::Lookups;
use media::catalogue::Settings;
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::ChannelValues as Values;
use theory::problems::SpectralSingleScattering;

/// An estimator of a kind.
#[derive(Debug, Clone)]
pub struct Page<const KIND: u8> {
    walker: Walker,
    /// Tracking of shadow rays.
    shadow: Shadow,
}

impl<const KIND: u8> Estimator<SpectralSingleScattering> for Page<KIND> {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Self> {
        let (walker, shadow) = (Walker::read(KIND, settings), Shadow::read(settings));
        Some(Self { walker: walker?, shadow: shadow? })
    }

    fn label(&self, _: bool) -> String {
        self.shadow.label(&self.walker.label())
    }

    fn needs(&self) -> Option<&'static str> {
        self.shadow.needs()
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
        walks::by(
            kernel,
            setup,
            request,
            |level, medium, request| {
                if KIND == INDEPENDENT {
                    walk::packets::<false>(level, by, setup, medium, request)
                } else {
                    walk::packets::<true>(level, by, setup, medium, request)
                }
            },
            #[inline(always)]
            |medium, random| {
                if KIND == INDEPENDENT {
                    draw::<false>(by, setup, medium, random)
                } else {
                    draw::<true>(by, setup, medium, random)
                }
            },
        );
    }
}

/// Makes one draw: compiled once for all walkers.
#[inline(never)]
fn draw<const ALL: bool>(
    by: (&Walker, Shadow),
    setup: &Setup<SpectralSingleScattering>,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw<Values> {
    walk::draw::<ALL>(Right, by, setup, medium, random)
}
