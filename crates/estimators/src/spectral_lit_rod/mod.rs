//! Estimators of the light of an emitter at the end of a chromatic rod, all channels by one draw.

pub mod as_printed;
pub mod events;
pub mod independent;
pub mod next_event_mis;
pub mod page;
pub mod spectral_mis;
pub mod spectral_tracking;
pub mod walk;

use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::{Refusal, Setup, estimators};
use media::body::MAX_CHANNELS;
use numeric::Lane;
use theory::problems::SpectralLitRod;
use theory::rod::lit;
use theory::rod::lit::spectral::{LitTracker, RodSpectrum};

/// Checks that each channel has one hero probability and a constant σ̂ ≥ σ_t, and that theory covers the rod.
fn realisable(setup: &Setup<SpectralLitRod>, heroes: &Heroes) -> Result<(), Refusal> {
    heroes.require(setup.fields.len())?;
    channels::require_majorants(&setup.fields)?;
    for (number, (channel, rod)) in (1..).zip(setup.fields.iter().zip(&setup.problem.rods)) {
        if !lit::is_within_reach(&channel.mesh, rod, &channel.sampling) {
            let actual = format!("σ̂ or σ_t of channel {number} is too large on it");
            return Err(Refusal::mismatch("a rod that theory can cut into 5000 panels", actual));
        }
    }
    Ok(())
}

/// The rod as theory describes it.
fn spectrum<'a>(
    setup: &'a Setup<SpectralLitRod>,
    heroes: &Heroes,
    tracker: LitTracker,
) -> RodSpectrum<'a> {
    let media = setup.fields.iter().map(|channel| (&*channel.mesh, &channel.sampling));
    let heroes = heroes.of(setup.fields.len());
    RodSpectrum::new(&setup.problem, media.collect(), heroes, tracker)
}

/// Albedos of all channels.
#[derive(Clone, Copy)]
struct Albedos<'a> {
    problem: &'a SpectralLitRod,
    /// Albedos, if they are known to be constant along the rod.
    numbers: Option<[f64; MAX_CHANNELS]>,
}

impl<'a> Albedos<'a> {
    #[inline(always)]
    fn of(setup: &'a Setup<SpectralLitRod>) -> Self {
        Self { problem: &setup.problem, numbers: None }
    }

    /// Albedos for many draws: stores them if they are constant.
    fn found(setup: &'a Setup<SpectralLitRod>) -> Self {
        let numbers = setup.problem.albedos().map(|albedos| {
            let mut numbers = [0.0; MAX_CHANNELS];
            numbers[..albedos.len()].copy_from_slice(&albedos);
            numbers
        });
        Self { numbers, ..Self::of(setup) }
    }

    /// a of a channel at distances.
    #[inline(always)]
    fn at<L: Lane>(&self, channel: usize, t: L) -> L {
        match &self.numbers {
            Some(albedos) => t.each(albedos[channel]),
            None => self.problem.albedo(channel, t),
        }
    }
}

/// Implements the trait of estimators for a page that implements [`events::WalkEvents`], given the distribution of the
/// hero and theory's tracker.
macro_rules! pages {
    ($this:ident => $heroes:expr, $tracker:expr) => {
        const INPUTS: $crate::Inputs = $crate::Inputs::SAMPLING;

        fn domain(
            &$this,
            setup: &$crate::Setup<SpectralLitRod>,
        ) -> Result<(), $crate::Refusal> {
            $crate::spectral_lit_rod::realisable(setup, &$heroes)
        }

        fn predict(
            &$this,
            setup: &$crate::Setup<SpectralLitRod>,
        ) -> theory::Prediction {
            let tracker = $tracker;
            let spectrum = $crate::spectral_lit_rod::spectrum(setup, &$heroes, tracker);
            spectrum.predict(setup.distributions)
        }

        $crate::walks::drawn!($this, setup: SpectralLitRod =>
            $crate::spectral_lit_rod::walk::ToEmitter::of($this, setup),
            $crate::spectral_lit_rod::walk::ToEmitter::prepared($this, setup)
        );
    };
}
use pages;

estimators! {
    SpectralLitRod on ChannelMedia:
    independent::Independent,
    spectral_mis::SpectralMis,
    spectral_tracking::SpectralTracking,
    next_event_mis::NextEventMis,
    as_printed::AsPrinted,
}
