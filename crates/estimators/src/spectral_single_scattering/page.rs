//! Common parts of the pages that score all channels: a walk scatters once, and its weights are relative to the
//! density of the walker, or of all heroes.

use super::walk::{self, Right};
use super::{Shadow, predict, realisable};
use crate::setup::walker::Walker;
use crate::{Draw, Estimator, Inputs, Kernel, Refusal, Request, Setup, walks};
use media::Lookups;
use media::catalogue::Settings;
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::ChannelValues as Values;
use theory::problems::SpectralSingleScattering;

/// A walk that scores all channels, of a kind of walker.
#[derive(Debug, Clone)]
pub struct AllChannels<const KIND: u8> {
    /// Walker that makes the walks.
    pub walker: Walker,
    /// Tracking of shadow rays.
    pub shadow: Shadow,
}

impl<const KIND: u8> Estimator<SpectralSingleScattering> for AllChannels<KIND> {
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
        self.walker.require_on_ray(&setup.channels)?;
        realisable(setup, self.shadow)
    }

    fn predict(&self, setup: &Setup<SpectralSingleScattering>) -> Prediction {
        predict(setup, &self.walker, self.shadow)
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<SpectralSingleScattering>, request: Request) {
        walks::by(
            kernel,
            setup,
            request,
            |level, medium, request| {
                walk::packets::<true>(level, (&self.walker, self.shadow), setup, medium, request)
            },
            #[inline(always)]
            |medium, rng| draw((&self.walker, self.shadow), setup, medium, rng),
        );
    }
}

/// Makes one draw: compiled once for all walkers.
#[inline(never)]
fn draw(
    by: (&Walker, Shadow),
    setup: &Setup<SpectralSingleScattering>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    walk::draw::<true>(Right, by, setup, medium, rng)
}
