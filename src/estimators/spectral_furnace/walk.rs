//! The walk of a hero through a volume in several channels, until it is absorbed or leaves.
//!
//! ```text
//! the hero h flies −ln u/σ̂_h;  beyond the bounds the walk has left
//! at a tentative collision, r = σ_t/σ̂ of each channel, a null, an absorption or a scattering by the hero's chances:
//!   f_λ ← f_λ (1 − r_λ),   f_λ r_λ (1 − a_λ),   f_λ r_λ a_λ p_λ(cos θ)
//! ```
//!
//! The furnace shines wherever a walk ends, so that f is the density of the walk itself. f is kept relative to the hero's,
//! see [`Path`]. A flight takes one random number, a collision one, a scattering one for θ and one for the azimuth, the
//! choice of the hero one.

use crate::estimators::Setup;
use crate::geometry::{Point, Ray, frame};
use crate::kernels::hero::Path;
use crate::media::body::MOST_CHANNELS;
use crate::problems::SpectralFurnace;
use crate::rng::Stream;
use crate::theory::ParticleRule;
use crate::theory::particle::Event;

/// The steps of a walk that a known bug may replace.
pub trait Steps {
    /// What an event multiplies f by in a channel: the ratio `σ_t/σ̂`, the albedo, and the density of the new
    /// direction are those of this channel.
    #[inline(always)]
    fn factor(&self, event: Event, ratio: f64, albedo: f64, density: f64) -> f64 {
        match event {
            Event::Transmitted => 1.0 - ratio,
            Event::Scattered => ratio * albedo * density,
            Event::Absorbed => ratio * (1.0 - albedo),
        }
    }

    /// The channel whose σ̂ counts in a channel's ratio.
    #[inline(always)]
    fn majorant_of(&self, channel: usize, hero: usize) -> usize {
        let _ = hero;
        channel
    }

    /// The channel whose phase function counts in a channel.
    #[inline(always)]
    fn phase_of(&self, channel: usize, hero: usize) -> usize {
        let _ = hero;
        channel
    }
}

/// Walks; answers the path with its weights, and the lookups.
#[inline(always)]
pub fn walk(
    steps: &impl Steps,
    setup: &Setup<SpectralFurnace>,
    hero: usize,
    rng: &mut Stream,
) -> (Path, u32) {
    let problem = &*setup.problem;
    let (own, majorant) = (&problem.channels[hero], setup.channels[hero].majorant);
    let mut path = Path::begin(hero);
    let (mut place, mut direction, mut lookups) = (problem.entry, problem.direction, 0);
    loop {
        let flight = -rng.ln_uniform() / majorant;
        let ray = Ray { origin: place, direction, length: f64::INFINITY };
        let end = problem.bounds.clip(&ray).to;
        if flight >= end {
            path.go_on(end.max(0.0));
            return (path, lookups);
        }
        path.go_on(flight);
        path.collisions += 1;
        lookups += 1;
        place = ray.at(flight);
        let ratios = ratios(steps, setup, hero, place);
        let odds = ParticleRule::Analog.odds(ratios[hero], own.albedo);
        let event = odds.decide(rng.uniform());
        let mut cosine = 1.0;
        if event == Event::Scattered {
            cosine = own.phase.cosine(rng.uniform());
            direction = frame::turned(direction, cosine, rng.uniform());
        }
        for (channel, medium) in problem.channels.iter().enumerate() {
            let phase = &problem.channels[steps.phase_of(channel, hero)].phase;
            let factor = steps.factor(event, ratios[channel], medium.albedo, phase.value(cosine));
            path.weights[channel] *= factor;
        }
        // Relative to the hero's, which only a bug can make 0.
        let scale = path.weights[hero];
        if scale > 0.0 {
            path.weights.iter_mut().for_each(|weight| *weight /= scale);
        }
        if event == Event::Absorbed {
            return (path, lookups);
        }
    }
}

/// `σ_t/σ̂` of each channel at a place.
#[inline(always)]
fn ratios(
    steps: &impl Steps,
    setup: &Setup<SpectralFurnace>,
    hero: usize,
    place: Point,
) -> [f64; MOST_CHANNELS] {
    let mut ratios = [0.0; MOST_CHANNELS];
    for (channel, medium) in setup.problem.channels.iter().enumerate() {
        let majorant = setup.channels[steps.majorant_of(channel, hero)].majorant;
        ratios[channel] = medium.volume.points().extinction(place) / majorant;
    }
    ratios
}
