//! Eight walks, step by step.

use std::cell::RefCell;

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::Page;
use crate::DrawBuffer;
use crate::kernels::hero::LastPiece;
use crate::kernels::packet::bank::{Numbers, Particles, Slot, Slots};
use crate::kernels::packet::hero::{number_of_hero, of_hero, or_of_hero};
use crate::kernels::packet::kept::Keep;
use crate::kernels::packet::paths::{Events, Last, NOTHING};
use media::body::MOST_CHANNELS;
use numeric::Lane;
use theory::ParticleRule;

/// Where walks are, and how far they have come.
#[derive(Clone, Copy)]
pub struct Place<S: Simd> {
    pub way: f64x8<S>,
    pub length: f64x8<S>,
    pub collisions: f64x8<S>,
}

impl<S: Simd> Place<S> {
    /// Some are elsewhere.
    #[inline(always)]
    fn stand_as(&mut self, keep: Keep<S>, which: mask64x8<S>, other: &Self) {
        keep.put(&mut self.way, which, other.way);
        keep.put(&mut self.length, which, other.length);
        keep.put(&mut self.collisions, which, other.collisions);
    }
}

/// Eight walks.
#[derive(Clone, Copy)]
pub struct InLitRod<'a, S: Simd> {
    pub page: &'a Page<'a>,
    /// Those that came to the emitter.
    pub events: &'a RefCell<Events>,
    pub last: Last,
    pub keep: Keep<S>,
    pub begin: Place<S>,
    pub end: f64x8<S>,
    pub here: Place<S>,
    /// Where those that cast were scattered.
    pub vertex: Place<S>,
    /// Where the flight began.
    pub before: f64x8<S>,
    pub number: f64x8<S>,
    pub inside: mask64x8<S>,
    /// Which fly as shadow rays.
    pub casts: mask64x8<S>,
    /// Which of them kept their direction.
    pub keeps: mask64x8<S>,
    pub goes_on: mask64x8<S>,
    /// The direction of the walk; a shadow ray flies forward.
    pub is_forward: mask64x8<S>,
    pub unscattered: mask64x8<S>,
    /// The number of each hero, its mean free path, and by channel its chance to keep the direction.
    pub hero: f64x8<S>,
    pub path: f64x8<S>,
    pub forward: [f64x8<S>; MOST_CHANNELS],
    /// As in a [`Path`](crate::kernels::hero::Path).
    pub weights: [f64x8<S>; MOST_CHANNELS],
    pub phases: [f64x8<S>; MOST_CHANNELS],
    pub nulls: [f64x8<S>; MOST_CHANNELS],
    pub lookups: f64x8<S>,
    /// `σ_t/σ̂` and a of each channel where they are.
    pub real: [f64x8<S>; MOST_CHANNELS],
    pub albedos: [f64x8<S>; MOST_CHANNELS],
    /// What the weights are to be.
    pub next: [f64x8<S>; MOST_CHANNELS],
}

impl<S: Simd> InLitRod<'_, S> {
    /// Chooses the heroes of walks that begin.
    #[inline(always)]
    pub fn choose(&mut self, which: mask64x8<S>, numbers: &mut Numbers<S>) {
        let (Page { law, media, paths, forward, .. }, keep) = (self.page, self.keep);
        let count = media.count;
        let hero = law.choose(numbers.uniform_where(which));
        keep.put(&mut self.hero, which, hero);
        keep.put(&mut self.path, which, number_of_hero(hero, &paths[..count]));
        for (channel, forward) in forward[..count].iter().enumerate() {
            keep.put(&mut self.forward[channel], which, number_of_hero(hero, &forward[..count]));
        }
    }

    /// Begins segments in directions that were kept or not.
    #[inline(always)]
    fn turn(&mut self, which: mask64x8<S>, keeps: mask64x8<S>) {
        let (one, keep) = (self.path.each(1.0), self.keep);
        for (channel, &forward) in self.forward[..self.page.media.count].iter().enumerate() {
            let phase = Lane::select(keeps, forward, one - forward);
            keep.put(&mut self.phases[channel], which, phase);
            keep.put(&mut self.nulls[channel], which, one);
        }
    }

    /// Scatters: the segment joins the path.
    #[inline(always)]
    fn scatter(&mut self, which: mask64x8<S>, numbers: &mut Numbers<S>) {
        let (page, keep, count) = (self.page, self.keep, self.page.media.count);
        let (one, mut own) = (self.path.each(1.0), self.path);
        for channel in 0..count {
            let next = self.weights[channel] * (self.real[channel] * self.albedos[channel]);
            let next = next * (self.phases[channel] * self.nulls[channel]);
            self.next[channel] = next;
            own = or_of_hero(self.hero, channel, own, next);
        }
        let own = Lane::select(one.each(0.0).below(own), own, one);
        for channel in 0..count {
            let next = self.next[channel] / own;
            keep.put(&mut self.weights[channel], which, next);
        }
        // Whoever's phase functions count, the hero's own is among them.
        let own = of_hero(self.hero, &self.forward[..count]);
        let keeps = numbers.uniform_where(which).below(own);
        if page.casts {
            self.turn(which, self.is_forward);
            let here = self.here;
            self.vertex.stand_as(keep, which, &here);
            self.casts |= which;
            self.keeps = (which & keeps) | (!which & self.keeps);
        } else {
            self.turn(which, keeps);
        }
        self.is_forward ^= which & !keeps;
        self.unscattered &= !which;
    }

    /// Some score: those that were connected, and others by a hit.
    #[inline(always)]
    fn score(&mut self, which: mask64x8<S>, connected: mask64x8<S>) {
        let Page { media, hit, connected: by, .. } = self.page;
        let (Place { length, collisions, .. }, count) = (self.here, media.count);
        let (zero, one) = (length.each(0.0), length.each(1.0));
        let last =
            if by.last_piece == LastPiece::Everywhere { zero } else { self.end - self.before };
        let length = length - Lane::select(connected, last, zero);
        // What was never scattered no shadow ray finds.
        let by_hit = one.each(f64::from(u8::from(hit.has_next_event)));
        let by_ray = one.each(f64::from(u8::from(by.has_next_event)));
        let next_event = Lane::select(connected, by_ray, by_hit);
        let next_event = Lane::select(self.unscattered, zero, next_event);
        let share = Lane::select(connected, one.each(by.share), one.each(hit.share));
        let rest = [self.hero, length, collisions, next_event, share];
        let [weights, phases, nulls] =
            [&self.weights[..count], &self.phases[..count], &self.nulls[..count]];
        let groups = [&rest, weights, phases, nulls];
        self.events.borrow_mut().push(which.to_bitmask(), &mut self.last, groups);
    }
}

impl<S: Simd> Particles<S> for InLitRod<'_, S> {
    type Found = [f64x8<S>; MOST_CHANNELS];

    #[inline(always)]
    fn fly(&mut self, numbers: &mut Numbers<S>) -> f64x8<S> {
        let depth = -numbers.ln_uniform();
        self.number = numbers.uniform_where(!self.casts);
        self.before = self.here.way;
        let is_forward = self.is_forward | self.casts;
        let way = Lane::select(is_forward, depth, -depth).times_plus(self.path, self.before);
        self.inside =
            (is_forward & way.below(self.end)) | (!is_forward & self.begin.way.below(way));
        self.here.way = way;
        // Beyond both ends there is no field to look at.
        Lane::select(self.inside, way, self.begin.way)
    }

    #[inline(always)]
    fn collide(&mut self, found: &Self::Found, numbers: &mut Numbers<S>) -> u64 {
        let Self { page, keep, inside, casts, number, .. } = *self;
        let (one, count) = (number.each(1.0), page.media.count);
        let piece = Lane::select(inside, self.here.way, self.end) - self.before;
        self.here.length += piece.size();
        let more = Lane::select(inside, one, one.each(0.0));
        self.here.collisions += more;
        self.lookups += more;
        let t = Lane::select(inside, self.here.way, self.begin.way);
        let (mut own, mut albedo) = (one, one);
        for (channel, &found) in found[..count].iter().enumerate() {
            let real = found / one.each(page.media.majorants[channel]);
            own = or_of_hero(self.hero, channel, own, real);
            self.real[channel] = real;
            let here = page.albedo(channel, t);
            albedo = or_of_hero(self.hero, channel, albedo, here);
            self.albedos[channel] = here;
        }
        let odds = ParticleRule::Analog.odds(own, albedo);
        let walks = inside & !casts;
        let is_scattered = walks & number.below(odds.scatter);
        let is_null = walks & !is_scattered & number.below(odds.scatter + odds.transmit);
        let passes = is_null | (casts & inside);
        for channel in 0..count {
            let passed = self.nulls[channel] * (one - self.real[channel]);
            keep.put(&mut self.nulls[channel], passes, passed);
        }
        let arrives = self.is_forward & !inside & !casts;
        let connected = casts & !inside;
        if (arrives | connected).any_true() {
            self.score(arrives | connected, connected);
        }
        if page.casts && connected.any_true() {
            let vertex = self.vertex;
            self.here.stand_as(keep, connected, &vertex);
            self.turn(connected, self.keeps);
            self.casts &= inside;
        }
        if is_scattered.any_true() {
            self.scatter(is_scattered, numbers);
        }
        self.goes_on = casts | is_scattered | is_null;
        (!self.goes_on).to_bitmask()
    }

    #[inline(always)]
    fn collect(&mut self, ended: u64, slots: &mut Slots, buffer: &mut DrawBuffer) -> u64 {
        collect(&self.lookups, &self.last, (ended, slots), buffer, &mut self.events.borrow_mut())
    }

    #[inline(always)]
    fn restart(&mut self, numbers: &mut Numbers<S>) {
        let (ended, keep) = (!self.goes_on, self.keep);
        let (zero, one) = (self.path.each(0.0), self.path.each(1.0));
        for channel in 0..self.page.media.count {
            keep.put(&mut self.weights[channel], ended, one);
            keep.put(&mut self.phases[channel], ended, one);
            keep.put(&mut self.nulls[channel], ended, one);
        }
        let bits = ended.to_bitmask();
        for (lane, last) in self.last.iter_mut().enumerate() {
            *last = if bits >> lane & 1 == 1 { NOTHING[lane] } else { *last };
        }
        keep.put(&mut self.lookups, ended, zero);
        let begin = self.begin;
        self.here.stand_as(keep, ended, &begin);
        self.is_forward |= ended;
        self.unscattered |= ended;
        self.choose(ended, numbers);
    }
}

/// Makes draws of walks that ended, as bits, without their scores; answers whose last ones these are.
#[inline(never)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
fn collect<S: Simd>(
    lookups: &f64x8<S>,
    last: &Last,
    (ended, slots): (u64, &mut Slots),
    buffer: &mut DrawBuffer,
    events: &mut Events,
) -> u64 {
    slots.fill(ended, |Slot { lane, draw, .. }| {
        buffer.lookups[draw] = lookups.as_slice()[lane] as u32;
        buffer.defects[draw] = 0.0;
        events.belong(last[lane], draw);
    })
}
