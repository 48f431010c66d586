//! Eight walks of heroes side by side: the packet kernel of trackers that score several channels.
//!
//! Specification: draw j is, bit for bit, the draw that its page makes from stream j mod 16.
//!
//! All channels are looked up at every collision, and each lane flies through the σ̂ of its own hero. What a
//! survivor scores is made one by one at its end: densities relative to the hero's, which depend on the number
//! of collisions, stand in a table.

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::walk::relative_density;
use crate::estimators::{DrawBuffer, Setup};
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::{self, Numbers, Particles, Slot, Slots};
use crate::media::Lookups;
use crate::media::body::MOST_CHANNELS;
use crate::numeric::pack::{self, Task, WIDTH};
use crate::numeric::{Lane, Twin};
use crate::problems::SpectralTransmittance;
use crate::setup::heroes::Heroes;
use crate::theory::spectral::{Chance, Tracker};

/// Up to so many collisions densities stand in a table.
const TABLE: u32 = 64;

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

/// `q_λ/q_h` by channel, hero and number of collisions.
struct Densities<'a> {
    setup: &'a Setup<SpectralTransmittance>,
    table: Vec<f64>,
}

impl<'a> Densities<'a> {
    fn new(setup: &'a Setup<SpectralTransmittance>) -> Self {
        let count = setup.channels.len();
        let mut table = Vec::with_capacity(count * count * TABLE as usize);
        for channel in 0..count {
            for hero in 0..count {
                table.extend((0..TABLE).map(|n| relative_density(setup, channel, hero, n)));
            }
        }
        Self { setup, table }
    }

    fn relative(&self, channel: usize, hero: usize, collisions: u32) -> f64 {
        if collisions >= TABLE {
            return relative_density(self.setup, channel, hero, collisions);
        }
        let row = channel * self.setup.channels.len() + hero;
        self.table[row * TABLE as usize + collisions as usize]
    }
}

impl Task for Walks<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { setup, rule, medium, request } = self;
        let count = setup.channels.len();
        let splat = |x: f64| f64x8::splat(simd, x);
        let support = setup.mesh.support();
        let mut majorants = [splat(1.0); MOST_CHANNELS];
        for (majorant, channel) in majorants.iter_mut().zip(&setup.channels) {
            *majorant = splat(channel.majorant);
        }
        let densities = Densities::new(setup);
        let one = splat(1.0);
        let fresh = AlongRay {
            setup,
            rule,
            densities: &densities,
            majorants,
            from: splat(support.from),
            to: splat(support.to),
            way: splat(support.from),
            path: one,
            hero: splat(0.0),
            inside: mask64x8::splat(simd, true),
            alive: mask64x8::splat(simd, true),
            ratios: [one; MOST_CHANNELS],
        };
        bank::run(
            simd,
            #[inline(always)]
            |numbers| {
                let mut fresh = fresh;
                fresh.choose(mask64x8::splat(simd, true), numbers);
                fresh
            },
            #[inline(always)]
            |places| {
                let [mut first, mut second] = [[splat(0.0); MOST_CHANNELS]; 2];
                let both = first.iter_mut().zip(&mut second).take(count);
                for (channel, (first, second)) in both.enumerate() {
                    let Twin(here, there) = medium.channel(channel).pair(simd, places);
                    (*first, *second) = (here, there);
                }
                [first, second]
            },
            request,
        );
    }
}

/// Eight walks along the ray.
#[derive(Clone, Copy)]
struct AlongRay<'a, S: Simd> {
    setup: &'a Setup<SpectralTransmittance>,
    rule: Rule<'a>,
    densities: &'a Densities<'a>,
    majorants: [f64x8<S>; MOST_CHANNELS],
    from: f64x8<S>,
    to: f64x8<S>,
    way: f64x8<S>,
    /// The mean free path of each hero.
    path: f64x8<S>,
    /// The number of each hero.
    hero: f64x8<S>,
    inside: mask64x8<S>,
    alive: mask64x8<S>,
    /// `ρ_λ`, or the weights of spectral tracking.
    ratios: [f64x8<S>; MOST_CHANNELS],
}

impl<S: Simd> AlongRay<'_, S> {
    /// Chooses the heroes of walks that begin.
    #[inline(always)]
    fn choose(&mut self, which: mask64x8<S>, numbers: &mut Numbers<S>) {
        let one = self.from.each(1.0);
        if self.rule.is_common {
            self.path = one / self.majorants[0];
            return;
        }
        let count = self.setup.channels.len();
        let number = numbers.uniform_where(which);
        let mut sum = self.rule.heroes.probability(count, 0);
        let (mut hero, mut majorant) = (one.each(0.0), self.majorants[0]);
        for channel in 1..count {
            let later = !number.below(number.each(sum));
            hero = Lane::select(later, one.each(channel as f64), hero);
            majorant = Lane::select(later, self.majorants[channel], majorant);
            sum += self.rule.heroes.probability(count, channel);
        }
        self.hero = Lane::select(which, hero, self.hero);
        self.path = Lane::select(which, one / majorant, self.path);
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
                for (&weight, &share) in self.ratios.iter().zip(shares) {
                    nulls += weight * share;
                    all += weight;
                }
                Some(nulls / all)
            }
            Tracker::Independent { delta: true }
            | Tracker::Hero { delta: true }
            | Tracker::Mis { delta: true } => {
                let mut survival = one;
                for (channel, &share) in shares.iter().enumerate() {
                    let number = one.each(channel as f64);
                    let is_hero = self.hero.at_most(number) & number.at_most(self.hero);
                    survival = Lane::select(is_hero, share, survival);
                }
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
    fn collide(&mut self, found: Self::Found, numbers: &mut Numbers<S>) -> u64 {
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
        for (ratio, &share) in self.ratios.iter_mut().zip(shares) {
            let factor = match survival {
                Some(survival) if is_tracked => share / survival,
                _ => share,
            };
            *ratio = Lane::select(self.inside, *ratio * factor, *ratio);
        }
        (!self.alive).to_bitmask()
    }

    #[inline(always)]
    fn collect(&self, ended: u64, slots: &mut Slots, buffer: &mut DrawBuffer) -> u64 {
        let mut ends = Ends::default();
        let count = self.setup.channels.len();
        for (row, ratio) in ends.ratios.iter_mut().zip(&self.ratios[..count]) {
            ratio.store_slice(row);
        }
        self.hero.store_slice(&mut ends.hero);
        ends.escaped = (!self.inside).to_bitmask();
        ends.collect((self.setup, self.rule, self.densities), slots, ended, buffer)
    }

    #[inline(always)]
    fn restart(&mut self, numbers: &mut Numbers<S>) {
        let (alive, one) = (self.alive, self.from.each(1.0));
        self.way = Lane::select(alive, self.way, self.from);
        let count = self.setup.channels.len();
        for ratio in &mut self.ratios[..count] {
            *ratio = Lane::select(alive, *ratio, one);
        }
        self.choose(!alive, numbers);
    }
}

/// What eight walks have come to.
#[derive(Default)]
#[repr(align(64))]
struct Ends {
    ratios: [[f64; WIDTH]; MOST_CHANNELS],
    hero: [f64; WIDTH],
    /// Who reached the end, as bits.
    escaped: u64,
}

impl Ends {
    /// Makes draws of those that ended.
    #[inline(never)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // the number of a channel
    fn collect(
        &self,
        (setup, rule, densities): (&Setup<SpectralTransmittance>, Rule, &Densities),
        slots: &mut Slots,
        ended: u64,
        buffer: &mut DrawBuffer,
    ) -> u64 {
        let count = setup.channels.len();
        slots.fill(ended, |Slot { lane, draw, steps }| {
            let escaped = self.escaped >> lane & 1 == 1;
            let hero = self.hero[lane] as usize;
            let mut found = [0.0; MOST_CHANNELS];
            if escaped {
                let ratio = |channel: usize| self.ratios[channel][lane];
                score(rule, densities, (hero, steps), count, &ratio, &mut found);
            }
            let values = setup.problem.values(&found[..count]);
            for (channel, value) in buffer.values.iter_mut().zip(values.as_ref()) {
                channel[draw] = *value;
            }
            buffer.defects[draw] = 0.0;
            // The step that leaves looks at nothing.
            buffer.lookups[draw] = steps + u32::from(!escaped);
        })
    }
}

/// What a survivor scores after so many collisions, in the order in which the pages compute it.
fn score(
    rule: Rule,
    densities: &Densities,
    (hero, collisions): (usize, u32),
    count: usize,
    ratio: &dyn Fn(usize) -> f64,
    found: &mut [f64; MOST_CHANNELS],
) {
    let relative = |channel: usize| densities.relative(channel, hero, collisions);
    match rule.tracker {
        _ if rule.is_common => {
            for (channel, found) in found[..count].iter_mut().enumerate() {
                *found = ratio(channel);
            }
        }
        Tracker::Independent { delta } => {
            let value = if delta { 1.0 } else { ratio(hero) };
            found[hero] = value * (1.0 / rule.heroes.probability(count, hero));
        }
        Tracker::Hero { delta } => {
            let density = if delta { ratio(hero) } else { 1.0 };
            for (channel, found) in found[..count].iter_mut().enumerate() {
                *found = relative(channel) * ratio(channel) / density;
            }
        }
        Tracker::Mis { delta } => {
            let mut density = 0.0;
            for (channel, found) in found[..count].iter_mut().enumerate() {
                let relative = relative(channel);
                *found = relative * ratio(channel);
                let by_hero = if delta { *found } else { relative };
                density += rule.heroes.probability(count, channel) * by_hero;
            }
            for found in &mut found[..count] {
                *found /= density;
            }
        }
        Tracker::InTurn { .. } | Tracker::Tracking(_) => {}
    }
}
