//! Heroes: the channels whose σ̂ or albedo walks have.

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
    #[inline(always)]
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
    pub fn choose<L: Lane>(&self, number: L) -> L {
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
pub fn of_hero<L: Lane>(hero: L, lanes: &[L]) -> L {
    let mut own = lanes[0];
    for (channel, &lanes) in lanes.iter().enumerate().skip(1) {
        own = Lane::select(hero.below(hero.each(channel as f64)), own, lanes);
    }
    own
}

/// In lanes of all channels, one after the other, those of the heroes: the earlier, or those of this channel.
#[inline(always)]
pub fn or_of_hero<L: Lane>(hero: L, channel: usize, earlier: L, lanes: L) -> L {
    Lane::select(hero.below(hero.each(channel as f64)), earlier, lanes)
}

/// Of numbers of all channels those of the heroes.
#[inline(always)]
pub fn number_of_hero<L: Lane>(hero: L, numbers: &[f64]) -> L {
    let mut own = hero.each(numbers[0]);
    for (channel, &number) in numbers.iter().enumerate().skip(1) {
        own = Lane::select(hero.below(hero.each(channel as f64)), own, hero.each(number));
    }
    own
}

/// The channels of a medium as densities of heroes are made of them, relative to each other.
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
    #[inline(always)]
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
    pub fn common<L: Lane>(&self, hero: L, [length, collisions]: [L; 2], weights: &mut [L]) {
        if self.is_common {
            return;
        }
        let majorant = number_of_hero(hero, &self.majorants[..self.count]);
        let logarithm = number_of_hero(hero, &self.logarithms[..self.count]);
        for (channel, weight) in weights.iter_mut().enumerate() {
            let log = collisions * (hero.each(self.logarithms[channel]) - logarithm);
            let rate = hero.each(self.majorants[channel]) - majorant;
            *weight = *weight * Lane::exp(log - rate * length);
        }
    }

    /// Makes scores of densities by the balance heuristic over all heroes but the last few; answers by how much their mean over
    /// heroes is not 1.
    #[inline(always)]
    pub fn balance<L: Lane>(&self, missing: usize, found: &mut [L]) -> L {
        let zero = found[0].each(0.0);
        let (mut density, mut sum) = (zero, zero);
        for (channel, &found) in found[..self.count - missing].iter().enumerate() {
            density = density + found * self.chances[channel];
        }
        let scale = L::select(zero.below(density), zero.each(1.0) / density, zero);
        for (channel, found) in found.iter_mut().enumerate() {
            *found = *found * scale;
            sum = sum + *found * self.chances[channel];
        }
        (sum - 1.0).size()
    }

    /// Makes scores of walks that score for their heroes alone.
    #[inline(always)]
    pub fn alone<L: Lane>(&self, hero: L, found: &mut [L]) {
        for (channel, found) in found.iter_mut().enumerate() {
            let own = hero.each(1.0) / hero.each(self.chances[channel]);
            *found = L::select(hero.equals(channel as f64), own, hero.each(0.0));
        }
    }
}

/// Where the transmittance of the last piece through σ̂ is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LastPiece {
    /// In f and in the densities.
    Everywhere,
    /// In neither.
    Nowhere,
    /// In f only.
    InContribution,
}

/// The weighting of a path: right, or with a known bug.
#[derive(Debug, Clone, Copy)]
pub struct Weighing {
    /// Where the transmittance of the last piece is.
    pub last_piece: LastPiece,
    /// Whether next-event estimation is among the techniques.
    pub has_next_event: bool,
    /// Whether the null collisions of the last segment are in `p_uni`.
    pub has_nulls: bool,
    /// The number of the last channels that are missing among the heroes.
    pub missing: usize,
    /// The factor on the sum of the densities.
    pub share: f64,
}

impl Weighing {
    /// As it should be.
    pub const RIGHT: Self = Self {
        last_piece: LastPiece::Everywhere,
        has_next_event: true,
        has_nulls: true,
        missing: 0,
        share: 1.0,
    };
}
