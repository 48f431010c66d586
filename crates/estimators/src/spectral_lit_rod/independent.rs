//! Independent tracking: one channel a draw, by hits and shadow rays of its own.
//!
//! Unbiased for: a constant σ̂ ≥ σ_t in each channel; refused elsewhere.
//!
//! ```text
//! X_h = x_h/w_h, the others 0,  h of probability w_h,  x_h a draw of `full-mis` in `lit-rod`
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `technique` | `"full-mis"`: hits and shadow rays, weighted by null-scattering paths; `"unidirectional"`: hits alone | `"full-mis"` |
//! | `hero` | the law of the channel: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel | required here or in the case |
//!
//! The colours are as noisy as they can be. All moments are known.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light
//! transport*, ACM Transactions on Graphics 38 (2019), section 6.

use fearless_simd::Level;

use super::{packet, realisable, spectrum};
use crate::kernels::packet::Request;
use crate::lit_rod::walk::ToEmitter;
use crate::setup::heroes::Heroes;
use crate::walks;
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::Lookups;
use media::body::MOST_CHANNELS;
use media::catalogue::Settings;
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::SpectralLitRod;
use theory::problems::spectral_lit_rod::Values;
use theory::spectral_lit_rod::{FULL, HITS, Tracker};

/// Independent tracking.
#[derive(Debug, Clone)]
pub struct Independent {
    is_full: bool,
    heroes: Heroes,
}

impl Estimator<SpectralLitRod> for Independent {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const IN_PACKETS: bool = true;

    fn read(settings: &Settings) -> Option<Self> {
        let technique = settings.word_or("technique", &["full-mis", "unidirectional"], "full-mis");
        let heroes = Heroes::read(settings);
        Some(Self { is_full: technique? == "full-mis", heroes: heroes? })
    }

    fn label(&self, _: bool) -> String {
        let technique = if self.is_full { "full-mis" } else { "unidirectional" };
        let heroes = self.heroes.label();
        if heroes.is_empty() { technique.into() } else { format!("{technique}, {heroes}") }
    }

    fn domain(&self, setup: &Setup<SpectralLitRod>) -> Result<(), Refusal> {
        realisable(setup, &self.heroes)
    }

    fn predict(&self, setup: &Setup<SpectralLitRod>) -> Prediction {
        let tracker = Tracker::Independent { casts: self.is_full };
        spectrum(setup, &self.heroes, tracker).predict(setup.laws)
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SpectralLitRod>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<Values> {
        let count = setup.channels.len();
        let hero = self.heroes.choose(count, rng.uniform());
        let own = &setup.channels[hero];
        let rod = &setup.problem.rods[hero].rod;
        let techniques = if self.is_full { FULL } else { HITS };
        let walk = ToEmitter::new(rod, &own.sampling, own.mesh.support().to, techniques);
        let drawn: Draw = walks::draw(&walk, &own.sampling, medium.channel(hero), rng);
        let mut scores = [0.0; MOST_CHANNELS];
        scores[hero] = drawn.value[0] / self.heroes.probability(count, hero);
        Draw::free(setup.problem.values(scores), drawn.lookups)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<SpectralLitRod>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        let techniques = if self.is_full { FULL } else { HITS };
        let page = (techniques, &self.heroes);
        packet::independent::walks(level, page, setup, medium, request)
    }
}
