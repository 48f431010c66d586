//! Heroes: the channels that give walks their σ̂ or albedo.

use crate::Estimated;
use crate::setup::heroes::Heroes;
use crate::setup::{ChannelMedia, Setup};
use media::body::MAX_CHANNELS;
use numeric::Lane;

/// The distribution of heroes.
#[derive(Clone, Copy)]
pub struct HeroDistribution {
    count: usize,
    /// The sum of the probabilities of the channels before each.
    before: [f64; MAX_CHANNELS],
}

impl HeroDistribution {
    /// Distribution of the heroes of `count` channels.
    #[inline(always)]
    pub fn new(heroes: &Heroes, count: usize) -> Self {
        let (mut before, mut sum) = ([0.0; MAX_CHANNELS], 0.0);
        for (channel, before) in before[..count].iter_mut().enumerate() {
            *before = sum;
            sum += heroes.probability(count, channel);
        }
        Self { count, before }
    }

    /// The numbers of the channels that uniform numbers choose.
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

/// Selects the heroes' lanes from the lanes of all channels.
#[inline(always)]
pub fn of_hero<L: Lane>(hero: L, lanes: &[L]) -> L {
    let mut own = lanes[0];
    for (channel, &lanes) in lanes.iter().enumerate().skip(1) {
        own = Lane::select(hero.below(hero.each(channel as f64)), own, lanes);
    }
    own
}

/// One step of [`of_hero`], for increasing channels: `lanes` unless the hero comes before `channel`, else
/// `earlier`.
#[inline(always)]
pub fn or_of_hero<L: Lane>(hero: L, channel: usize, earlier: L, lanes: L) -> L {
    Lane::select(hero.below(hero.each(channel as f64)), earlier, lanes)
}

/// Selects the heroes' numbers from the numbers of all channels.
#[inline(always)]
pub fn number_of_hero<L: Lane>(hero: L, numbers: &[f64]) -> L {
    let mut own = hero.each(numbers[0]);
    for (channel, &number) in numbers.iter().enumerate().skip(1) {
        own = Lane::select(hero.below(hero.each(channel as f64)), own, hero.each(number));
    }
    own
}

/// The channels of a medium, for the relative densities of heroes.
#[derive(Clone, Copy)]
pub struct Media {
    /// Number of channels.
    pub count: usize,
    /// True if all channels have the same σ̂: lengths and numbers of collisions then cancel.
    pub is_common: bool,
    /// σ̂.
    pub majorants: [f64; MAX_CHANNELS],
    /// `ln σ̂`.
    pub logarithms: [f64; MAX_CHANNELS],
    /// The probabilities of heroes.
    pub probabilities: [f64; MAX_CHANNELS],
}

impl Media {
    /// Channels of a setup, with the probabilities of heroes.
    #[inline(always)]
    pub fn new<P: Estimated<Fields = ChannelMedia>>(
        setup: &Setup<P>,
        probabilities: &[f64],
    ) -> Self {
        let (none, count) = ([0.0; MAX_CHANNELS], setup.fields.len());
        let is_common = setup.fields.iter().all(|c| c.majorant == setup.fields[0].majorant);
        let mut media =
            Self { count, is_common, majorants: none, logarithms: none, probabilities: none };
        for (channel, own) in setup.fields.iter().enumerate() {
            media.majorants[channel] = own.majorant;
            media.logarithms[channel] = own.ln_majorant;
            media.probabilities[channel] = probabilities[channel];
        }
        media
    }

    /// Multiplies weights by `q_λ/q_h` of paths, given their lengths and numbers of tentative collisions.
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

    /// Turns densities into scores by the balance heuristic over all heroes but the last `missing`. Returns the
    /// deviation from 1 of their mean over heroes.
    #[inline(always)]
    pub fn balance<L: Lane>(&self, missing: usize, values: &mut [L]) -> L {
        let zero = values[0].each(0.0);
        let (mut density, mut sum) = (zero, zero);
        for (channel, &values) in values[..self.count - missing].iter().enumerate() {
            density = density + values * self.probabilities[channel];
        }
        let scale = L::select(zero.below(density), zero.each(1.0) / density, zero);
        for (channel, values) in values.iter_mut().enumerate() {
            *values = *values * scale;
            sum = sum + *values * self.probabilities[channel];
        }
        (sum - 1.0).size()
    }

    /// Sets the scores of walks that score for their heroes alone.
    #[inline(always)]
    pub fn alone<L: Lane>(&self, hero: L, values: &mut [L]) {
        for (channel, values) in values.iter_mut().enumerate() {
            let own = hero.each(1.0) / hero.each(self.probabilities[channel]);
            *values = L::select(hero.equals(channel as f64), own, hero.each(0.0));
        }
    }
}

/// Places of the transmittance of the last piece through σ̂.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LastPiece {
    /// Both f and the densities.
    Everywhere,
    /// Neither f nor the densities.
    Nowhere,
    /// Only f.
    InContribution,
}

/// The weighting of a path: right, or with a known bug.
#[derive(Debug, Clone, Copy)]
pub struct Weighing {
    /// Places of the transmittance of the last piece.
    pub last_piece: LastPiece,
    /// True if next-event estimation is among the techniques.
    pub has_next_event: bool,
    /// True if the null collisions of the last segment are in `p_uni`.
    pub has_nulls: bool,
    /// The number of the last channels that are missing among the heroes.
    pub missing: usize,
    /// The factor on the sum of the densities.
    pub share: f64,
}

impl Weighing {
    /// The right weighting.
    pub const RIGHT: Self = Self {
        last_piece: LastPiece::Everywhere,
        has_next_event: true,
        has_nulls: true,
        missing: 0,
        share: 1.0,
    };
}
