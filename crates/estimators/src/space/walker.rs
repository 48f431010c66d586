//! The estimators of problems in space: particles that walk by a rule, and particles that split.

use super::{ParticleSettings, Tally, draws};
use crate::setup::Space;
use crate::{Draw, Estimated, Estimator, Inputs, Kernel, Refusal, Request, Setup, Traits, walks};
use media::catalogue::Settings;
use theory::Prediction;
use theory::problems::{Channels, Scene};

/// A problem with particles that walk in space as its estimators.
pub trait Walked: Estimated<Fields = Space, Value: Channels> {
    /// The beginning of walks, and their values.
    type Tally<'a>: Tally;

    /// Checks that a rule is valid for the setup, and that the expected value is known.
    ///
    /// # Errors
    ///
    /// The requirement, and the value that violates it.
    fn domain(setup: &Setup<Self>, particle: &ParticleSettings) -> Result<(), Refusal>;

    /// The prediction for a draw.
    fn predict(setup: &Setup<Self>, particle: &ParticleSettings) -> Prediction;

    /// The medium.
    fn scene(&self) -> &Scene;

    /// The beginning of walks, and their values.
    ///
    /// # Errors
    ///
    /// All draws, if no walk is needed.
    fn tally<'a>(
        setup: &'a Setup<Self>,
        particle: &ParticleSettings,
    ) -> Result<Self::Tally<'a>, Draw<Self::Value>>;
}

/// A particle that walks; σ̂ in space is its input. With `SPLITS` it splits.
#[derive(Debug, Clone)]
pub struct Walker<const SPLITS: bool = false>(ParticleSettings);

/// A particle that walks and splits.
pub type Splitter = Walker<true>;

impl<P: Walked, const SPLITS: bool> Estimator<P> for Walker<SPLITS> {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Self> {
        let read = if SPLITS { ParticleSettings::read_splitting } else { ParticleSettings::read };
        read(settings).map(Self)
    }

    fn traits(&self) -> Traits {
        Traits { settings: self.0.label(), ..Traits::of(Inputs::SAMPLING) }
    }

    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal> {
        P::domain(setup, &self.0)
    }

    fn predict(&self, setup: &Setup<P>) -> Prediction {
        P::predict(setup, &self.0)
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<P>, request: Request) {
        let tally = match P::tally(setup, &self.0) {
            Ok(tally) => tally,
            Err(draw) => return walks::one_by_one(setup, request, |_, _| draw),
        };
        let world = (setup.problem.scene(), &*setup.fields);
        let left = match kernel {
            Kernel::Single => Some(request),
            Kernel::Packets(level) => draws::packets(level, &tally, &self.0, world, request),
        };
        if let Some(request) = left {
            draws::in_turn::<P::Value, _, SPLITS>(&tally, &self.0, world, request);
        }
    }
}
