//! Eight walks of heroes side by side: the packet kernel of trackers that score several channels.
//!
//! Specification: draw j is, bit for bit, the draw that its page makes from stream j mod 16.
//!
//! All channels are looked up at every collision, and each lane flies through the σ̂ of its own hero. Walks that end leave
//! in the buffer what scores are made of, and when all have ended scores are made of that, eight draws at a time.
//!
//! Loops over channels count: a kernel does not inline iterators of two slices, and would lose its registers to the call.

mod score;

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use self::score::Scores;
use crate::kernels::DrawBuffer;
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::{self, Numbers, Particles, Slot, Slots};
use crate::kernels::packet::hero::{Law, number_of_hero, of_hero};
use crate::kernels::packet::kept::Keep;
use crate::setup::Setup;
use crate::setup::heroes::Heroes;
use media::Lookups;
use media::body::MOST_CHANNELS;
use numeric::Lane;
use numeric::pack::{self, Task};
use theory::problems::SpectralTransmittance;
use theory::spectral::{Chance, Tracker};

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
            majorant: one,
            ratios: [one; MOST_CHANNELS],
            shares: [one; MOST_CHANNELS],
            keep: Keep::new(simd),
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
        pack::outlined(
            simd,
            #[inline(always)]
            move || Scores::new(simd, setup, rule).of_all(buffer),
        );
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
    /// The σ̂ of each hero, where it walks for itself alone.
    majorant: f64x8<S>,
    /// `ρ_λ`, or the weights of spectral tracking; of walks for the hero alone its own is the first.
    ratios: [f64x8<S>; MOST_CHANNELS],
    /// `1 − σ_t/σ̂` of each channel.
    shares: [f64x8<S>; MOST_CHANNELS],
    keep: Keep<S>,
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
        let count = self.setup.channels.len();
        let path = number_of_hero(hero, &self.paths[..count]);
        self.keep.put(&mut self.hero, which, hero);
        self.keep.put(&mut self.path, which, path);
        if self.is_alone() {
            let majorant = of_hero(hero, &self.majorants[..count]);
            self.keep.put(&mut self.majorant, which, majorant);
        }
    }

    /// Whether a walk scores for its hero only.
    #[inline(always)]
    fn is_alone(&self) -> bool {
        matches!(self.rule.tracker, Tracker::Independent { .. })
    }

    /// What becomes of walks that score for their heroes alone; answers who goes on.
    #[inline(always)]
    fn collide_alone(
        &mut self,
        found: &[f64x8<S>],
        delta: bool,
        numbers: &mut Numbers<S>,
    ) -> mask64x8<S> {
        let share = self.from.each(1.0) - of_hero(self.hero, found) / self.majorant;
        if delta {
            return numbers.uniform().below(share) & self.inside;
        }
        let ratio = self.ratios[0] * share;
        self.keep.put(&mut self.ratios[0], self.inside, ratio);
        self.inside
    }

    /// The chance that a collision is null, by the shares of all channels; none where all are.
    #[inline(always)]
    fn survival(&self) -> Option<f64x8<S>> {
        let (one, shares) = (self.from.each(1.0), &self.shares[..self.setup.channels.len()]);
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
            Tracker::Hero { delta: true } | Tracker::Mis { delta: true } => {
                Some(of_hero(self.hero, shares))
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
        let (one, keep, inside) = (self.from.each(1.0), self.keep, self.inside);
        let count = self.setup.channels.len();
        let lookups = self.lookups + 1.0;
        keep.put(&mut self.lookups, inside, lookups);
        if let Tracker::Independent { delta } = self.rule.tracker {
            self.alive = self.collide_alone(&found[..count], delta, numbers);
            return (!self.alive).to_bitmask();
        }
        for (channel, &found) in found[..count].iter().enumerate() {
            self.shares[channel] = one - found / self.majorants[channel];
        }
        let survival = self.survival();
        self.alive = inside;
        if let Some(survival) = survival {
            self.alive = numbers.uniform().below(survival) & inside;
        }
        let is_tracked = self.rule.is_common && survival.is_some();
        for channel in 0..count {
            let share = self.shares[channel];
            let factor = match survival {
                Some(survival) if is_tracked => share / survival,
                _ => share,
            };
            let ratio = self.ratios[channel] * factor;
            keep.put(&mut self.ratios[channel], inside, ratio);
        }
        (!self.alive).to_bitmask()
    }

    #[inline(always)]
    fn collect(&mut self, ended: u64, slots: &mut Slots, buffer: &mut DrawBuffer) -> u64 {
        // Who ends inside is killed.
        let hero = Lane::select(self.inside, self.hero.each(KILLED), self.hero);
        let count = self.setup.channels.len();
        collect(&self.ratios[..count], [&hero, &self.lookups], (ended, slots), buffer)
    }

    #[inline(always)]
    fn restart(&mut self, numbers: &mut Numbers<S>) {
        let (ended, keep, one) = (!self.alive, self.keep, self.from.each(1.0));
        keep.put(&mut self.way, ended, self.from);
        let count = if self.is_alone() { 1 } else { self.setup.channels.len() };
        for ratio in &mut self.ratios[..count] {
            keep.put(ratio, ended, one);
        }
        keep.put(&mut self.lookups, ended, one.each(0.0));
        self.choose(ended, numbers);
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
