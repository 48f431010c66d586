//! The heroes of eight walks: the channels whose σ̂ or albedo they have.

use fearless_simd::{Simd, f64x8};

use crate::media::body::MOST_CHANNELS;
use crate::numeric::Lane;
use crate::setup::heroes::Heroes;

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

/// Of numbers of all channels those of the heroes.
#[inline(always)]
pub fn number_of_hero<S: Simd>(hero: f64x8<S>, numbers: &[f64]) -> f64x8<S> {
    let mut own = hero.each(numbers[0]);
    for (channel, &number) in numbers.iter().enumerate().skip(1) {
        own = Lane::select(hero.below(hero.each(channel as f64)), own, hero.each(number));
    }
    own
}
