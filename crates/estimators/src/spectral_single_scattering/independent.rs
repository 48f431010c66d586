//! Independent tracking: one channel a draw, by analog delta tracking through its own medium.
//!
//! Unbiased for: a constant σ̂ ≥ σ_t in each channel; refused elsewhere.
//!
//! ```text
//! X_h = p_h(cos θ) Φ/(4π r²) T̂_h/w_h where the walk scatters, the others 0,  h of probability w_h
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `shadow` | `"exact"`, or `"ratio"`: ratio tracking through the same σ̂ | `"exact"` |
//! | `hero` | the law of the channel: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel, on shadow rays too where they are tracked | required here or in the case |
//!
//! All moments are known: `E[X_λ^k] = w_λ^{1−k} E[x_λ^k]`, x a draw of `delta-tracking` in that channel.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*,
//! ACM Transactions on Graphics 38 (2019), section 6.

use fearless_simd::Level;

use super::walk::{self, Steps};
use super::{Shadow, alone, packet, realisable};
use crate::kernels::packet::Request;
use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::setup::walker::Walker;
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use ::theory::problems::ChannelValues as Values;
use ::theory::problems::SpectralSingleScattering;
use ::theory::{Prediction, spectral_single_scattering as theory};
use media::Lookups;
use media::body::MOST_CHANNELS;
use media::catalogue::Settings;
use numeric::rng::Stream;

/// One channel a draw.
#[derive(Debug, Clone)]
pub struct Independent {
    /// The law of the channel.
    heroes: Heroes,
    /// Its walk.
    walker: Walker,
    /// How shadow rays are tracked.
    shadow: Shadow,
}

impl Steps for Independent {}

impl Estimator<SpectralSingleScattering> for Independent {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const IN_PACKETS: bool = true;

    fn read(settings: &Settings) -> Option<Self> {
        let (heroes, shadow) = (Heroes::read(settings), Shadow::read(settings));
        let heroes = heroes?;
        Some(Self { walker: Walker::Hero(heroes.clone()), heroes, shadow: shadow? })
    }

    fn label(&self, _: bool) -> String {
        self.shadow.label(&self.heroes.label())
    }

    fn needs(&self) -> Option<&'static str> {
        self.shadow.needs()
    }

    fn domain(&self, setup: &Setup<SpectralSingleScattering>) -> Result<(), Refusal> {
        self.walker.require(&setup.channels)?;
        channels::require_majorants(&setup.channels)?;
        realisable(setup, self.shadow)
    }

    fn predict(&self, setup: &Setup<SpectralSingleScattering>) -> Prediction {
        theory::independent(&alone(setup, self.shadow), &self.heroes.of(setup.channels.len()))
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SpectralSingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<Values> {
        let count = setup.channels.len();
        let hero = self.heroes.choose(count, rng.uniform());
        let (lit, mut scores) = (&setup.problem.channels[hero], [0.0; MOST_CHANNELS]);
        let walker = (&self.walker, hero);
        let (s, mut path, mut lookups) = walk::scattering(self, setup, walker, medium, rng);
        if let Some(s) = s {
            let asked = (setup, hero..hero + 1);
            let (through, cast) = walk::cast(self, self.shadow, asked, &mut path, s, rng);
            let chance = self.heroes.probability(count, hero);
            scores[hero] = lit.source(s) / lit.albedo() * through[hero] / chance;
            lookups += cast;
        }
        Draw::free(setup.problem.values(scores), lookups)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<SpectralSingleScattering>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        packet::walks::<false>(level, (&self.walker, self.shadow), setup, medium, request)
    }
}
