//! Eight walks of heroes that are scattered, and their densities in all channels relative to the heroes'.
//!
//! ```text
//! an event multiplies f_λ by 1 − r_λ, r_λ (1 − a_λ) or r_λ a_λ p_λ(cos θ),  r_λ = σ_t/σ̂
//! ```

use fearless_simd::{Simd, SimdBase, f64x8, mask64x8};

use super::hero::{Media, or_of_hero};
use super::kept::Keep;
use crate::setup::walker::Walker;
use media::body::MOST_CHANNELS;
use media::phase::Phase;
use numeric::Lane;
use theory::ParticleRule;
use theory::spectral::chance::shares;

/// What happens in each channel where a walk collides.
pub struct Scatterers {
    /// a.
    pub albedos: [f64; MOST_CHANNELS],
    /// How light is scattered.
    pub phases: Vec<Phase>,
}

impl Scatterers {
    /// Those of channels, one after the other.
    pub fn new(channels: impl Iterator<Item = (f64, Phase)>) -> Self {
        let (mut albedos, mut phases) = ([0.0; MOST_CHANNELS], Vec::new());
        for (channel, (albedo, phase)) in channels.enumerate() {
            albedos[channel] = albedo;
            phases.push(phase);
        }
        Self { albedos, phases }
    }

    /// The cosines of scattering angles by the phase functions of heroes.
    #[inline(always)]
    pub fn cosine<S: Simd>(&self, hero: f64x8<S>, number: f64x8<S>) -> f64x8<S> {
        let mut cosine = number;
        for (channel, phase) in self.phases.iter().enumerate() {
            cosine = or_of_hero(hero, channel, cosine, phase.cosine(number));
        }
        cosine
    }
}

/// What becomes of eight walks: which are scattered, which go straight on, and which had a collision at all.
#[derive(Clone, Copy)]
pub struct Events<S: Simd> {
    /// Which are scattered.
    pub scattered: mask64x8<S>,
    /// Which pass a null collision.
    pub null: mask64x8<S>,
    /// Which collided; those that did neither are absorbed.
    pub collided: mask64x8<S>,
}

/// The densities of eight walks.
#[derive(Clone, Copy)]
pub struct Densities<S: Simd> {
    /// Relative to the heroes'.
    pub weights: [f64x8<S>; MOST_CHANNELS],
    /// What they are to be.
    next: [f64x8<S>; MOST_CHANNELS],
    /// `σ_t/σ̂` of each channel.
    ratios: [f64x8<S>; MOST_CHANNELS],
    keep: Keep<S>,
}

impl<S: Simd> Densities<S> {
    /// Of walks that begin.
    #[inline(always)]
    pub fn new(simd: S) -> Self {
        let ones = [f64x8::splat(simd, 1.0); MOST_CHANNELS];
        Self { weights: ones, next: ones, ratios: ones, keep: Keep::new(simd) }
    }

    /// Some walks begin anew.
    #[inline(always)]
    pub fn begin(&mut self, count: usize, which: mask64x8<S>) {
        for weight in &mut self.weights[..count] {
            self.keep.put(weight, which, weight.each(1.0));
        }
    }

    /// Notes σ_t of all channels; answers the heroes' own ratios.
    #[inline(always)]
    pub fn look(&mut self, media: &Media, hero: f64x8<S>, found: &[f64x8<S>]) -> f64x8<S> {
        let mut own = hero;
        for (channel, &found) in found[..media.count].iter().enumerate() {
            let ratio = found / hero.each(media.majorants[channel]);
            self.ratios[channel] = ratio;
            own = or_of_hero(hero, channel, own, ratio);
        }
        own
    }

    /// The chances to go straight on, to be scattered and to be absorbed, where all channels walk together, or of heroes,
    /// given their own ratios and albedos.
    #[inline(always)]
    pub fn chances(
        &self,
        (scatterers, walker): (&Scatterers, &Walker),
        [own, albedo]: [f64x8<S>; 2],
    ) -> [f64x8<S>; 3] {
        let count = scatterers.phases.len();
        if let Some(chances) = walker.together() {
            return chances.of_events(
                count,
                #[inline(always)]
                |channel| shares(self.ratios[channel], scatterers.albedos[channel]),
                &self.weights,
            );
        }
        let odds = ParticleRule::Analog.odds(own, albedo);
        [odds.transmit, odds.scatter, own]
    }

    /// What events make of them; those that are scattered turn by a cosine. They stay relative to those of heroes or,
    /// where all channels walk together, to the chances of what happened.
    #[inline(always)]
    pub fn weigh(
        &mut self,
        (scatterers, walker): (&Scatterers, &Walker),
        hero: f64x8<S>,
        (events, [passes, scatters, ends]): (Events<S>, [f64x8<S>; 3]),
        cosine: f64x8<S>,
    ) {
        let (count, one, mut own) = (scatterers.phases.len(), hero.each(1.0), hero);
        for channel in 0..count {
            let (ratio, albedo) = (self.ratios[channel], one.each(scatterers.albedos[channel]));
            let density = scatterers.phases[channel].value(cosine);
            let scattered = ratio * albedo * density;
            let absorbed = ratio * (one - albedo);
            let real = Lane::select(events.scattered, scattered, absorbed);
            let next = self.weights[channel] * Lane::select(events.null, one - ratio, real);
            self.next[channel] = next;
            own = or_of_hero(hero, channel, own, next);
        }
        if walker.together().is_some() {
            let scattered = scatters * scatterers.phases[0].value(cosine);
            own =
                Lane::select(events.scattered, scattered, Lane::select(events.null, passes, ends));
        }
        let scale = Lane::select(one.each(0.0).below(own), own, one);
        for channel in 0..count {
            let next = self.next[channel] / scale;
            self.keep.put(&mut self.weights[channel], events.collided, next);
        }
    }
}

/// Makes scores of densities by the balance heuristic; answers by how much their mean over heroes is not 1.
#[inline(always)]
pub fn balance<S: Simd>(media: &Media, found: &mut [f64x8<S>]) -> f64x8<S> {
    let zero = found[0].each(0.0);
    let (mut density, mut sum) = (zero, zero);
    for (channel, found) in found.iter().enumerate() {
        density += *found * media.chances[channel];
    }
    let scale = Lane::select(zero.below(density), zero.each(1.0) / density, zero);
    for (channel, found) in found.iter_mut().enumerate() {
        *found *= scale;
        sum += *found * media.chances[channel];
    }
    (sum - 1.0).size()
}

/// Makes scores of walks that score for their heroes alone.
#[inline(always)]
pub fn alone<S: Simd>(media: &Media, hero: f64x8<S>, found: &mut [f64x8<S>]) {
    for (channel, found) in found.iter_mut().enumerate() {
        let (number, chance) = (hero.each(channel as f64), media.chances[channel]);
        let is_hero = hero.at_most(number) & number.at_most(hero);
        *found = Lane::select(is_hero, hero.each(1.0) / hero.each(chance), hero.each(0.0));
    }
}
