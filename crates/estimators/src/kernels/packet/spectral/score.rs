//! Scores of what walks have left, eight draws at a time.

use fearless_simd::{Simd, SimdBase, f64x8};

use super::Rule;
use crate::kernels::DrawBuffer;
use crate::kernels::packet::hero::{number_of_hero, of_hero};
use crate::setup::Setup;
use media::body::MOST_CHANNELS;
use numeric::Lane;
use numeric::pack::WIDTH;
use theory::problems::SpectralTransmittance;
use theory::spectral::Tracker;

/// Makes scores of what walks have left, as the pages do.
pub struct Scores<'a, S: Simd> {
    simd: S,
    rule: Rule<'a>,
    luminance: &'a [f64],
    count: usize,
    /// `ln σ̂`, `∫σ̂` and the probability of each channel.
    logarithms: [f64; MOST_CHANNELS],
    collisions: [f64; MOST_CHANNELS],
    chances: [f64; MOST_CHANNELS],
}

impl<'a, S: Simd> Scores<'a, S> {
    #[inline(always)]
    pub fn new(simd: S, setup: &'a Setup<SpectralTransmittance>, rule: Rule<'a>) -> Self {
        let none = [0.0; MOST_CHANNELS];
        let (mut logarithms, mut collisions, mut chances) = (none, none, none);
        let count = setup.channels.len();
        for (number, channel) in setup.channels.iter().enumerate() {
            logarithms[number] = channel.ln_majorant;
            collisions[number] = channel.collisions;
            chances[number] = rule.heroes.probability(count, number);
        }
        let luminance = &setup.problem.luminance;
        Self { simd, rule, luminance, count, logarithms, collisions, chances }
    }

    /// Of all draws of a buffer.
    #[inline(always)]
    pub fn of_all(&self, buffer: &mut DrawBuffer) {
        let (simd, draws) = (self.simd, buffer.lookups.len());
        buffer.make_room(draws.next_multiple_of(WIDTH));
        for first in (0..draws).step_by(WIDTH) {
            let pack = first..first + WIDTH;
            let mut lookups = [0.0; WIDTH];
            for (lane, lookups) in lookups.iter_mut().enumerate() {
                *lookups = f64::from(buffer.lookups[first + lane]);
            }
            let lookups = f64x8::from_slice(simd, &lookups);
            let hero = f64x8::from_slice(simd, &buffer.defects[pack.clone()]);
            buffer.defects[pack.clone()].fill(0.0);
            let mut found = [lookups; MOST_CHANNELS];
            let found = &mut found[..self.count];
            for (channel, found) in found.iter_mut().enumerate() {
                *found = f64x8::from_slice(simd, &buffer.values[channel][pack.clone()]);
            }
            self.of_pack(hero, lookups, found);
            for (channel, found) in found.iter().enumerate() {
                found.store_slice(&mut buffer.values[channel][pack.clone()]);
            }
            // Pictures ask for the channels alone.
            let luminance = buffer.values.get_mut(self.count);
            if let ([first, rest @ ..], Some(luminance)) = (self.luminance, luminance) {
                let mut sum = found[0] * *first;
                for (channel, &weight) in rest.iter().enumerate() {
                    sum += found[channel + 1] * weight;
                }
                sum.store_slice(&mut luminance[pack]);
            }
        }
        buffer.make_room(draws);
    }

    /// Replaces the ratios of eight walks by their scores.
    #[inline(always)]
    fn of_pack(&self, hero: f64x8<S>, lookups: f64x8<S>, found: &mut [f64x8<S>]) {
        let (zero, one) = (hero.each(0.0), hero.each(1.0));
        match self.rule.tracker {
            _ if self.rule.is_common => {}
            Tracker::Independent { delta } => {
                let value = if delta { one } else { found[0] };
                for (channel, found) in found.iter_mut().enumerate() {
                    let number = zero.each(channel as f64);
                    let is_hero = hero.at_most(number) & number.at_most(hero);
                    *found = Lane::select(is_hero, value * (1.0 / self.chances[channel]), zero);
                }
            }
            Tracker::Hero { delta } => {
                let density = if delta { of_hero(hero, found) } else { one };
                for (channel, found) in found.iter_mut().enumerate() {
                    *found = self.relative(channel, hero, lookups) * *found / density;
                }
            }
            Tracker::Mis { delta } => {
                let mut density = zero;
                for (channel, found) in found.iter_mut().enumerate() {
                    let relative = self.relative(channel, hero, lookups);
                    *found = relative * *found;
                    let by_hero = if delta { *found } else { relative };
                    density += by_hero * self.chances[channel];
                }
                for found in found.iter_mut() {
                    *found /= density;
                }
            }
            Tracker::InTurn { .. } | Tracker::Tracking(_) => {}
        }
        let lives = zero.at_most(hero);
        for found in found {
            *found = Lane::select(lives, *found, zero);
        }
    }

    /// `q_λ/q_h`.
    #[inline(always)]
    fn relative(&self, channel: usize, hero: f64x8<S>, lookups: f64x8<S>) -> f64x8<S> {
        let Self { logarithms, collisions, count, .. } = self;
        let logarithm = number_of_hero(hero, &logarithms[..*count]);
        let log = lookups * (hero.each(logarithms[channel]) - logarithm);
        let expected = number_of_hero(hero, &collisions[..*count]);
        Lane::exp(log - (hero.each(collisions[channel]) - expected))
    }
}
