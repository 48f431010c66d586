//! What the pages that score all channels share: a walk scatters once, and its weights are relative to the density of the
//! walker, or of all heroes.

use fearless_simd::Level;

use super::walk::draw_all;
use super::{Shadow, packet, predict, realisable};
use crate::kernels::packet::Request;
use crate::setup::walker::Walker;
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::Lookups;
use media::catalogue::Settings;
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::ChannelValues as Values;
use theory::problems::SpectralSingleScattering;

/// A walk that scores all channels, of a kind of walker.
#[derive(Debug, Clone)]
pub struct AllChannels<const KIND: u8> {
    /// Whose walk it is.
    pub walker: Walker,
    /// How shadow rays are tracked.
    pub shadow: Shadow,
}

impl<const KIND: u8> Estimator<SpectralSingleScattering> for AllChannels<KIND> {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const IN_PACKETS: bool = true;

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

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SpectralSingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<Values> {
        draw_all((&self.walker, self.shadow), setup, medium, rng)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<SpectralSingleScattering>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        packet::walks::<true>(level, (&self.walker, self.shadow), setup, medium, request)
    }
}
