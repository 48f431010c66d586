//! Eight walks of heroes side by side: the packet kernel of trackers that score several channels.
//!
//! Specification: draw j is, bit for bit, the draw that its page makes from stream j mod 16.
//!
//! All channels are looked up at every collision, and each lane flies through the σ̂ of its own hero. Walks that end leave
//! in the buffer what scores are made of, and when all have ended scores are made of that, eight draws at a time.
//!
//! Loops over channels count: a kernel does not inline iterators of two slices, and would lose its registers to the call.

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use crate::estimators::{DrawBuffer, Setup};
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::{self, Numbers, Particles, Slot, Slots};
use crate::kernels::packet::hero::{Law, number_of_hero, of_hero};
use crate::media::Lookups;
use crate::media::body::MOST_CHANNELS;
use crate::numeric::Lane;
use crate::numeric::pack::{self, Task, WIDTH};
use crate::problems::SpectralTransmittance;
use crate::setup::heroes::Heroes;
use crate::theory::spectral::{Chance, Tracker};

/// What collides and what is scored.
#[derive(Clone, Copy)]
pub struct Rule<'a> {
    /// The tracker; [`Tracker::Mis`] with delta tracking for the history-aware chance, too.
    pub tracker: Tracker,
    /// Whether one walk serves all channels through their common σ̂: nothing is chosen.
    pub is_common: bool,
    /// The law of the hero.
    pub heroes: &'a Heroes,
}

/// The draws of a rule, on the hardware of a level; a request is handed back where the hardware is too
/// narrow.
pub fn walks<'a>(
    level: Level,
    setup: &Setup<SpectralTransmittance>,
    rule: Rule,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    if setup.mesh.support().is_empty() {
        return Some(request);
    }
    pack::on_wide(level, Walks { setup, rule, medium, request }).err().map(|task| task.request)
}

struct Walks<'a, 'r> {
    setup: &'a Setup<SpectralTransmittance>,
    rule: Rule<'a>,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl Task for Walks<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { setup, rule, medium, request } = self;
        let count = setup.channels.len();
        let splat = |x: f64| f64x8::splat(simd, x);
        let support = setup.mesh.support();
        let (zero, one) = (splat(0.0), splat(1.0));
        let (mut majorants, mut paths) = ([one; MOST_CHANNELS], [1.0; MOST_CHANNELS]);
        for (number, channel) in setup.channels.iter().enumerate() {
            majorants[number] = splat(channel.majorant);
            paths[number] = 1.0 / channel.majorant;
        }
        let fresh = AlongRay {
            setup,
            rule,
            majorants,
            law: Law::new(rule.heroes, count),
            paths,
            from: splat(support.from),
            to: splat(support.to),
            way: splat(support.from),
            path: one,
            hero: zero,
            lookups: zero,
            inside: mask64x8::splat(simd, true),
            alive: mask64x8::splat(simd, true),
            ratios: [one; MOST_CHANNELS],
        };
        let Request { streams, count: draws, buffer } = request;
        bank::run(
            simd,
            #[inline(always)]
            |numbers| {
                let mut fresh = fresh;
                fresh.choose(mask64x8::splat(simd, true), numbers);
                fresh
            },
            [[zero; MOST_CHANNELS]; 2],
            #[inline(always)]
            |places, found| bank::of_channels(simd, medium, count, places, found),
            Request { streams, count: draws, buffer: &mut *buffer },
        );
        Scores::new(simd, setup, rule).of_all(buffer);
    }
}

/// Eight walks along the ray.
#[derive(Clone, Copy)]
struct AlongRay<'a, S: Simd> {
    setup: &'a Setup<SpectralTransmittance>,
    rule: Rule<'a>,
    majorants: [f64x8<S>; MOST_CHANNELS],
    law: Law,
    /// `1/σ̂` of each channel.
    paths: [f64; MOST_CHANNELS],
    from: f64x8<S>,
    to: f64x8<S>,
    way: f64x8<S>,
    /// The mean free path of each hero.
    path: f64x8<S>,
    /// The number of each hero.
    hero: f64x8<S>,
    lookups: f64x8<S>,
    inside: mask64x8<S>,
    alive: mask64x8<S>,
    /// `ρ_λ`, or the weights of spectral tracking.
    ratios: [f64x8<S>; MOST_CHANNELS],
}

impl<S: Simd> AlongRay<'_, S> {
    /// Chooses the heroes of walks that begin.
    #[inline(always)]
    fn choose(&mut self, which: mask64x8<S>, numbers: &mut Numbers<S>) {
        if self.rule.is_common {
            self.path = self.from.each(self.paths[0]);
            return;
        }
        let hero = self.law.choose(numbers.uniform_where(which));
        let path = number_of_hero(hero, &self.paths[..self.setup.channels.len()]);
        self.hero = Lane::select(which, hero, self.hero);
        self.path = Lane::select(which, path, self.path);
    }

    /// The chance that a collision is null, given the shares of all channels; 1 where all are.
    #[inline(always)]
    fn survival(&self, shares: &[f64x8<S>]) -> Option<f64x8<S>> {
        let one = self.from.each(1.0);
        match self.rule.tracker {
            Tracker::Tracking(Chance::Average) => {
                let mut sum = one.each(0.0);
                for &share in shares {
                    sum += share;
                }
                Some(sum / shares.len() as f64)
            }
            Tracker::Tracking(Chance::Maximum) => {
                let (mut most, mut least) = (one.each(0.0), one);
                for &share in shares {
                    most = most.or_more(share);
                    least = least.or_less(share);
                }
                Some(most / (most + (one - least)))
            }
            Tracker::Mis { delta: true } if self.rule.is_common => {
                let (mut nulls, mut all) = (one.each(0.0), one.each(0.0));
                for (channel, &share) in shares.iter().enumerate() {
                    nulls += self.ratios[channel] * share;
                    all += self.ratios[channel];
                }
                Some(nulls / all)
            }
            Tracker::Independent { delta: true }
            | Tracker::Hero { delta: true }
            | Tracker::Mis { delta: true } => {
                let survival = of_hero(self.hero, shares);
                Some(survival)
            }
            _ => None,
        }
    }
}

impl<S: Simd> Particles<S> for AlongRay<'_, S> {
    type Found = [f64x8<S>; MOST_CHANNELS];

    #[inline(always)]
    fn fly(&mut self, numbers: &mut Numbers<S>) -> f64x8<S> {
        self.way = (-numbers.ln_uniform()).times_plus(self.path, self.way);
        self.inside = self.way.below(self.to);
        // Beyond the end there is no field to look at.
        Lane::select(self.inside, self.way, self.from)
    }

    #[inline(always)]
    fn collide(&mut self, found: &Self::Found, numbers: &mut Numbers<S>) -> u64 {
        let one = self.from.each(1.0);
        let count = self.setup.channels.len();
        let mut shares = [one; MOST_CHANNELS];
        for channel in 0..count {
            shares[channel] = one - found[channel] / self.majorants[channel];
        }
        let shares = &shares[..count];
        let survival = self.survival(shares);
        self.alive = self.inside;
        if let Some(survival) = survival {
            self.alive = numbers.uniform().below(survival) & self.inside;
        }
        let is_tracked = self.rule.is_common && survival.is_some();
        for (channel, &share) in shares.iter().enumerate() {
            let factor = match survival {
                Some(survival) if is_tracked => share / survival,
                _ => share,
            };
            let ratio = self.ratios[channel];
            self.ratios[channel] = Lane::select(self.inside, ratio * factor, ratio);
        }
        self.lookups = Lane::select(self.inside, self.lookups + 1.0, self.lookups);
        (!self.alive).to_bitmask()
    }

    #[inline(always)]
    fn collect(&self, ended: u64, slots: &mut Slots, buffer: &mut DrawBuffer) -> u64 {
        // Who ends inside is killed.
        let hero = Lane::select(self.inside, self.hero.each(KILLED), self.hero);
        let count = self.setup.channels.len();
        collect(&self.ratios[..count], [&hero, &self.lookups], (ended, slots), buffer)
    }

    #[inline(always)]
    fn restart(&mut self, numbers: &mut Numbers<S>) {
        let (alive, one) = (self.alive, self.from.each(1.0));
        self.way = Lane::select(alive, self.way, self.from);
        let count = self.setup.channels.len();
        for ratio in &mut self.ratios[..count] {
            *ratio = Lane::select(alive, *ratio, one);
        }
        self.lookups = Lane::select(alive, self.lookups, one.each(0.0));
        self.choose(!alive, numbers);
    }
}

/// What stands in the place of the hero of a walk that was killed.
const KILLED: f64 = -1.0;

/// Leaves in the buffer what the scores of walks that ended are made of: their ratios as values, their heroes as defects.
#[inline(never)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
fn collect<S: Simd>(
    ratios: &[f64x8<S>],
    [hero, lookups]: [&f64x8<S>; 2],
    (ended, slots): (u64, &mut Slots),
    buffer: &mut DrawBuffer,
) -> u64 {
    slots.fill(ended, |Slot { lane, draw, .. }| {
        for (channel, ratio) in ratios.iter().enumerate() {
            buffer.values[channel][draw] = ratio.as_slice()[lane];
        }
        buffer.defects[draw] = hero.as_slice()[lane];
        buffer.lookups[draw] = lookups.as_slice()[lane] as u32;
    })
}

/// Makes scores of what walks have left, as the pages do.
struct Scores<'a, S: Simd> {
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
    fn new(simd: S, setup: &'a Setup<SpectralTransmittance>, rule: Rule<'a>) -> Self {
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
    fn of_all(&self, buffer: &mut DrawBuffer) {
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
                for (channel, found) in found.iter_mut().enumerate() {
                    let number = zero.each(channel as f64);
                    let is_hero = hero.at_most(number) & number.at_most(hero);
                    let value = if delta { one } else { *found };
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
