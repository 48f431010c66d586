//! The estimators of problems in space: particles that walk by a rule, and particles that split.

use fearless_simd::Level;

use super::{By, Particle};
use crate::kernels::packet::Request;
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::Lookups;
use media::catalogue::Settings;
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::Problem;

/// A problem whose estimators are particles that walk in space.
pub trait Walked: Problem {
    /// Whether a rule exists here, and what it finds is known.
    ///
    /// # Errors
    ///
    /// What is needed, and what was found.
    fn domain(setup: &Setup<Self>, particle: &Particle) -> Result<(), Refusal>;

    /// What theory says of a draw.
    fn predict(setup: &Setup<Self>, particle: &Particle) -> Prediction;

    /// Makes a draw of a particle, whose steps may be those of a known bug.
    fn draw(
        by: By,
        particle: &Particle,
        setup: &Setup<Self>,
        rng: &mut Stream,
    ) -> Draw<Self::Value>;

    /// Makes draws by packets.
    fn draw_packets<'a>(
        level: Level,
        particle: &Particle,
        setup: &Setup<Self>,
        request: Request<'a>,
    ) -> Option<Request<'a>>;
}

/// A particle that walks; σ̂ in space is its input. With `SPLITS` it splits.
#[derive(Debug, Clone)]
pub struct Walker<const SPLITS: bool = false>(Particle);

/// A particle that walks and splits.
pub type Splitter = Walker<true>;

impl<P: Walked, const SPLITS: bool> Estimator<P> for Walker<SPLITS> {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const IN_PACKETS: bool = true;

    fn read(settings: &Settings) -> Option<Self> {
        let read = if SPLITS { Particle::read_splitting } else { Particle::read };
        read(settings).map(Self)
    }

    fn label(&self, _: bool) -> String {
        self.0.label()
    }

    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal> {
        P::domain(setup, &self.0)
    }

    fn predict(&self, setup: &Setup<P>) -> Prediction {
        P::predict(setup, &self.0)
    }

    #[inline]
    fn draw(&self, setup: &Setup<P>, _: &Lookups, rng: &mut Stream) -> Draw<P::Value> {
        P::draw(By::Rule(&self.0), &self.0, setup, rng)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<P>,
        _: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        P::draw_packets(level, &self.0, setup, request)
    }
}
