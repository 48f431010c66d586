//! Densities of walks in all channels, relative to the heroes', as events change them.
//!
//! ```text
//! an event multiplies f_λ by 1 − r_λ, r_λ (1 − a_λ) or r_λ a_λ p_λ(cos θ),  r_λ = σ_t/σ̂
//! ```

use super::WalkEvents;
use crate::setup::walker::Walker;
use crate::walks::hero::{Media, number_of_hero, of_hero, or_of_hero};
use media::body::MAX_CHANNELS;
use media::phase::Phase;
use numeric::{Lane, kept};
use theory::ParticleRule;
use theory::collisions::particle::Event;
use theory::colours::probabilities::shares;

/// Channels of a body, and the walker that goes through it.
#[derive(Clone, Copy)]
pub struct Scatterers<'a, S> {
    /// σ̂ of each channel, and probabilities of heroes.
    pub media: Media,
    /// a of each channel.
    pub albedos: &'a [f64],
    /// The phase function of each channel.
    pub phases: [Phase; MAX_CHANNELS],
    /// The walker.
    pub walker: &'a Walker,
    /// The steps, which a known bug may replace.
    pub steps: S,
}

/// Results of a step: lanes that are scattered, that pass a null collision, and that collided at all.
#[derive(Clone, Copy)]
pub struct Events<M> {
    /// Lanes that are scattered.
    pub scattered: M,
    /// Lanes at a null collision.
    pub null: M,
    /// Lanes at any collision; those that are not in the other two are absorbed.
    pub collided: M,
}

kept! {
    /// Densities of walks, kept in memory.
    pub struct Densities<L> {
        /// Densities relative to those of the heroes.
        pub weights: [L; MAX_CHANNELS],
        /// Densities after the current step.
        next: [L; MAX_CHANNELS],
        /// `σ_t/σ̂` of each channel.
        ratios: [L; MAX_CHANNELS],
    }
}

impl<L: Lane> Densities<L> {
    /// Densities of new walks: 1 in every channel.
    #[inline(always)]
    pub fn new(one: L) -> Self {
        let ones = [one; MAX_CHANNELS];
        Self { weights: ones, next: ones, ratios: ones }
    }

    /// Restarts the lanes in `which`.
    #[inline(always)]
    pub fn restart(&mut self, count: usize, which: L::Mask, one: L) {
        for weight in &mut self.weights[..count] {
            weight.keep_where(which, one);
        }
    }

    /// Stores `σ_t/σ̂` of all channels; returns the heroes' own ratios.
    #[inline(always)]
    pub fn look<S: WalkEvents>(&mut self, among: &Scatterers<'_, S>, hero: L, values: &[L]) -> L {
        let (media, mut own) = (&among.media, hero);
        for (channel, &extinction) in values.iter().enumerate() {
            let mut majorant = hero.each(media.majorants[channel]);
            if among.steps.has_heros_majorant() {
                majorant = number_of_hero(hero, &media.majorants[..media.count]);
            }
            let ratio = extinction / majorant;
            self.ratios[channel] = ratio;
            own = or_of_hero(hero, channel, own, ratio);
        }
        own
    }

    /// Probabilities to go straight on, to be scattered and to be absorbed, where all channels walk together. For
    /// heroes, given their own ratios and albedos: the probabilities to go straight on and to be scattered, and the
    /// own ratio.
    #[inline(always)]
    pub fn probabilities<S: WalkEvents>(
        &self,
        among: &Scatterers<'_, S>,
        [own, albedo]: [L; 2],
    ) -> [L; 3] {
        if let Some(probabilities) = among.walker.together() {
            return probabilities.of_events(
                among.media.count,
                #[inline(always)]
                |channel| shares(self.ratios[channel], among.albedos[channel]),
                &self.weights,
            );
        }
        let probabilities = ParticleRule::Analog.probabilities(own, albedo);
        [probabilities.transmit, probabilities.scatter, own]
    }

    /// Multiplies by the factors of events; scattered lanes turn by `cosine`. Densities stay relative to those of
    /// heroes or, where all channels walk together, to the probabilities of the events.
    #[inline(always)]
    pub fn weigh<S: WalkEvents>(
        &mut self,
        among: &Scatterers<'_, S>,
        hero: L,
        (events, [passes, scatters, ends]): (Events<L::Mask>, [L; 3]),
        cosine: L,
    ) {
        let Scatterers { media, albedos, phases, steps, .. } = among;
        let (count, one, mut own) = (media.count, hero.each(1.0), hero);
        let mut heros_density = one;
        if steps.has_heros_phase() {
            let mut densities = [one; MAX_CHANNELS];
            for channel in 0..count {
                densities[channel] = phases[channel].value(cosine);
            }
            heros_density = of_hero(hero, &densities[..count]);
        }
        for channel in 0..count {
            let (ratio, albedo) = (self.ratios[channel], one.each(albedos[channel]));
            let mut density = phases[channel].value(cosine);
            if steps.has_heros_phase() {
                density = heros_density;
            }
            let scattered = steps.factor(Event::Scattered, ratio, albedo, density);
            let absorbed = steps.factor(Event::Absorbed, ratio, albedo, density);
            let passed = steps.factor(Event::Transmitted, ratio, albedo, density);
            let real = L::select(events.scattered, scattered, absorbed);
            let next = self.weights[channel] * L::select(events.null, passed, real);
            self.next[channel] = next;
            own = or_of_hero(hero, channel, own, next);
        }
        if among.walker.together().is_some() {
            let scattered = scatters * phases[0].value(cosine);
            own = L::select(events.scattered, scattered, L::select(events.null, passes, ends));
        }
        let scale = L::select(one.each(0.0).below(own), own, one);
        for channel in 0..count {
            let next = self.next[channel] / scale;
            self.weights[channel].keep_where(events.collided, next);
        }
    }
}

impl<S> Scatterers<'_, S> {
    /// The cosines of scattering angles by the phase functions of heroes.
    #[inline(always)]
    pub fn cosine<L: Lane>(&self, hero: L, number: L) -> L {
        let mut cosine = number;
        for channel in 0..self.media.count {
            cosine = or_of_hero(hero, channel, cosine, self.phases[channel].cosine(number));
        }
        cosine
    }
}
