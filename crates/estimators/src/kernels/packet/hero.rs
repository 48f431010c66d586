//! The heroes of eight walks: the channels whose σ̂ or albedo they have.

use fearless_simd::{Simd, f64x8};

use crate::setup::Setup;
use crate::setup::heroes::Heroes;
use media::body::MOST_CHANNELS;
use numeric::Lane;

/// The law of heroes.
#[derive(Clone, Copy)]
pub struct Law {
    count: usize,
    /// The probability of all channels before each.
    before: [f64; MOST_CHANNELS],
}

impl Law {
    /// That of heroes of so many channels.
    pub fn new(heroes: &Heroes, count: usize) -> Self {
        let (mut before, mut sum) = ([0.0; MOST_CHANNELS], 0.0);
        for (channel, before) in before[..count].iter_mut().enumerate() {
            *before = sum;
            sum += heroes.probability(count, channel);
        }
        Self { count, before }
    }

    /// The numbers of the channels that uniform numbers choose, as [`Heroes::choose`] does.
    #[inline(always)]
    pub fn choose<S: Simd>(&self, number: f64x8<S>) -> f64x8<S> {
        let mut hero = number.each(0.0);
        for channel in 1..self.count {
            let earlier = number.below(number.each(self.before[channel]));
            hero = Lane::select(earlier, hero, number.each(channel as f64));
        }
        hero
    }
}

/// Of lanes of all channels those of the heroes.
#[inline(always)]
pub fn of_hero<S: Simd>(hero: f64x8<S>, lanes: &[f64x8<S>]) -> f64x8<S> {
    let mut own = lanes[0];
    for (channel, &lanes) in lanes.iter().enumerate().skip(1) {
        own = Lane::select(hero.below(hero.each(channel as f64)), own, lanes);
    }
    own
}

/// In lanes of all channels, one after the other, those of the heroes: the earlier, or those of this channel.
#[inline(always)]
pub fn or_of_hero<S: Simd>(
    hero: f64x8<S>,
    channel: usize,
    earlier: f64x8<S>,
    lanes: f64x8<S>,
) -> f64x8<S> {
    Lane::select(hero.below(hero.each(channel as f64)), earlier, lanes)
}

/// Of numbers of all channels those of the heroes.
#[inline(always)]
pub fn number_of_hero<S: Simd>(hero: f64x8<S>, numbers: &[f64]) -> f64x8<S> {
    let mut own = hero.each(numbers[0]);
    for (channel, &number) in numbers.iter().enumerate().skip(1) {
        own = Lane::select(hero.below(hero.each(channel as f64)), own, hero.each(number));
    }
    own
}

/// The channels of a medium as densities of heroes are made of them: [`Path`](crate::kernels::hero::Path) for lanes.
#[derive(Clone, Copy)]
pub struct Media {
    /// How many there are.
    pub count: usize,
    /// Whether all have the same σ̂: lengths and collisions then tell nothing.
    pub is_common: bool,
    /// σ̂.
    pub majorants: [f64; MOST_CHANNELS],
    /// `ln σ̂`.
    pub logarithms: [f64; MOST_CHANNELS],
    /// The probabilities of heroes.
    pub chances: [f64; MOST_CHANNELS],
}

impl Media {
    /// Those of a setup.
    pub fn new<P>(setup: &Setup<P>, probabilities: &[f64]) -> Self {
        let (none, count) = ([0.0; MOST_CHANNELS], setup.channels.len());
        let is_common = setup.channels.iter().all(|c| c.majorant == setup.channels[0].majorant);
        let mut media = Self { count, is_common, majorants: none, logarithms: none, chances: none };
        for (channel, own) in setup.channels.iter().enumerate() {
            media.majorants[channel] = own.majorant;
            media.logarithms[channel] = own.ln_majorant;
            media.chances[channel] = probabilities[channel];
        }
        media
    }

    /// Makes `q_λ/q_h` of the weights of paths of lengths with so many tentative collisions.
    #[inline(always)]
    pub fn common<S: Simd>(
        &self,
        hero: f64x8<S>,
        [length, collisions]: [f64x8<S>; 2],
        weights: &mut [f64x8<S>],
    ) {
        if self.is_common {
            return;
        }
        let majorant = number_of_hero(hero, &self.majorants[..self.count]);
        let logarithm = number_of_hero(hero, &self.logarithms[..self.count]);
        for (channel, weight) in weights.iter_mut().enumerate() {
            let log = collisions * (hero.each(self.logarithms[channel]) - logarithm);
            let rate = hero.each(self.majorants[channel]) - majorant;
            *weight *= Lane::exp(log - rate * length);
        }
    }
}
