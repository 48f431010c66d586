//! Estimators of the light of an emitter at the end of a chromatic rod, all channels by one draw.

pub mod as_printed;
pub mod independent;
pub mod next_event_mis;
pub mod packet;
pub mod spectral_mis;
pub mod spectral_tracking;
pub mod walk;

use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::{Refusal, Setup, estimators};
use theory::lit_rod;
use theory::problems::SpectralLitRod;
use theory::spectral_lit_rod::{Spectrum, Tracker};

/// One hero probability and a constant σ̂ ≥ σ_t for each channel, on rods within the reach of theory.
fn realisable(setup: &Setup<SpectralLitRod>, heroes: &Heroes) -> Result<(), Refusal> {
    heroes.require(setup.channels.len())?;
    channels::require_constants(&setup.channels)?;
    channels::require_majorants(&setup.channels)?;
    for (number, (channel, rod)) in (1..).zip(setup.channels.iter().zip(&setup.problem.rods)) {
        if !lit_rod::is_within_reach(&channel.mesh, rod, &channel.sampling) {
            let found = format!("σ̂ or σ_t of channel {number} is too large on it");
            return Err(Refusal::mismatch("a rod that theory can cut into 1e4 steps", found));
        }
    }
    Ok(())
}

/// For theory.
fn spectrum<'a>(
    setup: &'a Setup<SpectralLitRod>,
    heroes: &Heroes,
    tracker: Tracker,
) -> Spectrum<'a> {
    let media = setup.channels.iter().map(|channel| (&*channel.mesh, &channel.sampling));
    let heroes = heroes.of(setup.channels.len());
    Spectrum::new(&setup.problem, media.collect(), heroes, tracker)
}

/// The plumbing of a page whose [`walk::Steps`] it is: what differs are the law of the hero and what theory calls it.
macro_rules! pages {
    ($this:ident => $heroes:expr, $tracker:expr) => {
        const INPUTS: $crate::Inputs = $crate::Inputs::SAMPLING;
        const IN_PACKETS: bool = true;

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
            spectrum.predict(setup.laws)
        }

        #[inline(always)]
        fn draw(
            &$this,
            setup: &$crate::Setup<SpectralLitRod>,
            medium: &media::Lookups,
            rng: &mut numeric::rng::Stream,
        ) -> $crate::Draw<theory::problems::spectral_lit_rod::Values> {
            $crate::spectral_lit_rod::walk::draw($this, setup, medium, rng)
        }

        fn draw_packets<'a>(
            &$this,
            level: fearless_simd::Level,
            setup: &$crate::Setup<SpectralLitRod>,
            medium: &media::Lookups,
            request: $crate::kernels::packet::Request<'a>,
        ) -> Option<$crate::kernels::packet::Request<'a>> {
            $crate::spectral_lit_rod::packet::walks(level, $this, setup, medium, request)
        }
    };
}
use pages;

estimators! {
    SpectralLitRod:
    independent::Independent,
    spectral_mis::SpectralMis,
    spectral_tracking::SpectralTracking,
    next_event_mis::NextEventMis,
    as_printed::AsPrinted,
}
