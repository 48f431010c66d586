//! Walks of heroes to an emitter side by side: the packet kernel of [`super::walk`].
//!
//! Specification: draw j is, bit for bit, the draw that [`super::walk::draw`] makes from stream j mod 16.
//!
//! A lane flies as a walk or as a shadow ray. Where a walk is scattered its place is kept; its shadow ray flies on from
//! there, with the weights of the path, and when it has ended the walk does. All channels are looked up at every collision.
//!
//! Loops over channels count: a kernel does not inline iterators of two slices, and would lose its registers to the call.

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::walk::{Found, Steps};
use crate::estimators::space::packet::collect;
use crate::estimators::{DrawBuffer, Setup};
use crate::kernels::hero::{LastPiece, Weighing};
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::{self, Numbers, Particles, Slots};
use crate::kernels::packet::hero::{Law, number_of_hero, of_hero};
use crate::media::Lookups;
use crate::media::body::MOST_CHANNELS;
use crate::numeric::Lane;
use crate::numeric::pack::{self, Task};
use crate::problems::SpectralLitRod;
use crate::theory::ParticleRule;

/// Numbers of all channels.
type Channels = [f64; MOST_CHANNELS];

/// The draws of a page, on the hardware of a level; a request is handed back where the hardware is too narrow.
pub fn walks<'a>(
    level: Level,
    steps: &impl Steps,
    setup: &Setup<SpectralLitRod>,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let page = Page::new(steps, setup);
    pack::on_wide(level, Walks { page: &page, medium, request }).err().map(|task| task.request)
}

/// What all walks share.
struct Page<'a> {
    setup: &'a Setup<SpectralLitRod>,
    count: usize,
    /// Whether all channels have the same σ̂: lengths and collisions then tell nothing.
    is_common: bool,
    law: Law,
    casts: bool,
    /// How hits and shadow rays are weighted.
    hit: Weighing,
    connected: Weighing,
    /// σ̂, 1/σ̂, ln σ̂ and the probability of each channel.
    majorants: Channels,
    paths: Channels,
    logarithms: Channels,
    chances: Channels,
    /// The chance to keep the direction by channel and hero.
    forward: [Channels; MOST_CHANNELS],
}

impl<'a> Page<'a> {
    fn new(steps: &impl Steps, setup: &'a Setup<SpectralLitRod>) -> Self {
        let none = [0.0; MOST_CHANNELS];
        let count = setup.channels.len();
        let mut page = Self {
            setup,
            count,
            is_common: setup.channels.iter().all(|c| c.majorant == setup.channels[0].majorant),
            law: Law::new(steps.heroes(), count),
            casts: steps.casts(),
            hit: steps.weighing(Found::Hit),
            connected: steps.weighing(Found::Connected),
            majorants: none,
            paths: none,
            logarithms: none,
            chances: none,
            forward: [none; MOST_CHANNELS],
        };
        for (channel, own) in setup.channels.iter().enumerate() {
            page.majorants[channel] = own.majorant;
            page.paths[channel] = 1.0 / own.majorant;
            page.logarithms[channel] = own.ln_majorant;
            page.chances[channel] = steps.heroes().probability(count, channel);
            for hero in 0..count {
                let forward = setup.problem.forward[steps.phase_of(channel, hero)];
                page.forward[channel][hero] = forward;
            }
        }
        page
    }
}

struct Walks<'a, 'r> {
    page: &'a Page<'a>,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl Task for Walks<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { page, medium, request } = self;
        let support = page.setup.mesh.support();
        let (zero, one) = (f64x8::splat(simd, 0.0), f64x8::splat(simd, 1.0));
        let all = mask64x8::splat(simd, true);
        let begin = Place { way: zero.each(support.from), length: zero, collisions: zero };
        let fresh = InLitRod {
            page,
            begin,
            end: zero.each(support.to),
            here: begin,
            vertex: begin,
            before: zero,
            number: zero,
            inside: all,
            casts: !all,
            keeps: all,
            goes_on: all,
            is_forward: all,
            unscattered: all,
            hero: zero,
            path: one,
            majorant: one,
            logarithm: zero,
            forward: [one; MOST_CHANNELS],
            weights: [one; MOST_CHANNELS],
            phases: [one; MOST_CHANNELS],
            nulls: [one; MOST_CHANNELS],
            scores: [zero; MOST_CHANNELS],
            lookups: zero,
        };
        bank::run(
            simd,
            #[inline(always)]
            |numbers| {
                let mut fresh = fresh;
                fresh.choose(all, numbers);
                fresh
            },
            [[zero; MOST_CHANNELS]; 2],
            #[inline(always)]
            |places, found| bank::of_channels(simd, medium, page.count, places, found),
            request,
        );
    }
}

/// Where walks are, and how far they have come.
#[derive(Clone, Copy)]
struct Place<S: Simd> {
    way: f64x8<S>,
    length: f64x8<S>,
    collisions: f64x8<S>,
}

impl<S: Simd> Place<S> {
    /// Some are elsewhere.
    #[inline(always)]
    fn stand_as(&mut self, which: mask64x8<S>, other: &Self) {
        self.way = Lane::select(which, other.way, self.way);
        self.length = Lane::select(which, other.length, self.length);
        self.collisions = Lane::select(which, other.collisions, self.collisions);
    }
}

/// Eight walks.
#[derive(Clone, Copy)]
struct InLitRod<'a, S: Simd> {
    page: &'a Page<'a>,
    begin: Place<S>,
    end: f64x8<S>,
    here: Place<S>,
    /// Where those that cast were scattered.
    vertex: Place<S>,
    /// Where the flight began.
    before: f64x8<S>,
    number: f64x8<S>,
    inside: mask64x8<S>,
    /// Which fly as shadow rays.
    casts: mask64x8<S>,
    /// Which of them kept their direction.
    keeps: mask64x8<S>,
    goes_on: mask64x8<S>,
    /// The direction of the walk; a shadow ray flies forward.
    is_forward: mask64x8<S>,
    unscattered: mask64x8<S>,
    /// The number of each hero, its mean free path, its σ̂ and ln σ̂, and by channel its chance to keep the direction.
    hero: f64x8<S>,
    path: f64x8<S>,
    majorant: f64x8<S>,
    logarithm: f64x8<S>,
    forward: [f64x8<S>; MOST_CHANNELS],
    /// As in a [`Path`](crate::kernels::hero::Path).
    weights: [f64x8<S>; MOST_CHANNELS],
    phases: [f64x8<S>; MOST_CHANNELS],
    nulls: [f64x8<S>; MOST_CHANNELS],
    scores: [f64x8<S>; MOST_CHANNELS],
    lookups: f64x8<S>,
}

impl<S: Simd> InLitRod<'_, S> {
    /// Chooses the heroes of walks that begin.
    #[inline(always)]
    fn choose(&mut self, which: mask64x8<S>, numbers: &mut Numbers<S>) {
        let Page { law, paths, majorants, logarithms, forward, count, .. } = self.page;
        let hero = law.choose(numbers.uniform_where(which));
        self.hero = Lane::select(which, hero, self.hero);
        self.path = Lane::select(which, number_of_hero(hero, &paths[..*count]), self.path);
        let majorant = number_of_hero(hero, &majorants[..*count]);
        self.majorant = Lane::select(which, majorant, self.majorant);
        let logarithm = number_of_hero(hero, &logarithms[..*count]);
        self.logarithm = Lane::select(which, logarithm, self.logarithm);
        for (channel, forward) in forward[..*count].iter().enumerate() {
            let forward = number_of_hero(hero, &forward[..*count]);
            self.forward[channel] = Lane::select(which, forward, self.forward[channel]);
        }
    }

    /// Begins segments in directions that were kept or not.
    #[inline(always)]
    fn turn(&mut self, which: mask64x8<S>, keeps: mask64x8<S>) {
        let one = self.path.each(1.0);
        for (channel, &forward) in self.forward[..self.page.count].iter().enumerate() {
            let phase = Lane::select(keeps, forward, one - forward);
            self.phases[channel] = Lane::select(which, phase, self.phases[channel]);
            self.nulls[channel] = Lane::select(which, one, self.nulls[channel]);
        }
    }

    /// Scatters: the segment joins the path.
    #[inline(always)]
    fn scatter(
        &mut self,
        which: mask64x8<S>,
        (real, albedos): (&[f64x8<S>], &[f64x8<S>]),
        numbers: &mut Numbers<S>,
    ) {
        let (page, count) = (self.page, self.page.count);
        let one = self.path.each(1.0);
        let mut weights = self.weights;
        for (channel, weight) in weights[..count].iter_mut().enumerate() {
            let own = *weight * (real[channel] * albedos[channel]);
            *weight = own * (self.phases[channel] * self.nulls[channel]);
        }
        let hero = of_hero(self.hero, &weights[..count]);
        let hero = Lane::select(one.each(0.0).below(hero), hero, one);
        for (channel, &weight) in weights[..count].iter().enumerate() {
            self.weights[channel] = Lane::select(which, weight / hero, self.weights[channel]);
        }
        // Whoever's phase functions count, the hero's own is among them.
        let own = of_hero(self.hero, &self.forward[..count]);
        let keeps = numbers.uniform_where(which).below(own);
        if page.casts {
            self.turn(which, self.is_forward);
            self.vertex.stand_as(which, &self.here);
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
        let Page { count, is_common, majorants, logarithms, chances, hit, connected: by, .. } =
            self.page;
        let Place { length, collisions, .. } = self.here;
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
        let (mut found, mut density) = ([zero; MOST_CHANNELS], zero);
        for (channel, found) in found[..*count].iter_mut().enumerate() {
            let mut common = self.weights[channel];
            if !is_common {
                let log = collisions * (one.each(logarithms[channel]) - self.logarithm);
                let rate = one.each(majorants[channel]) - self.majorant;
                common *= Lane::exp(log - rate * length);
            }
            *found = common * self.phases[channel] * self.nulls[channel];
            density += *found * chances[channel];
            density += common * chances[channel] * next_event;
        }
        let scale = one / (density * share);
        let scale = Lane::select(zero.below(density), scale, zero);
        for (channel, &found) in found[..*count].iter().enumerate() {
            let score = self.scores[channel] + found * scale;
            self.scores[channel] = Lane::select(which, score, self.scores[channel]);
        }
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
        let Self { page, inside, casts, number, .. } = *self;
        let (one, count) = (number.each(1.0), page.count);
        let piece = Lane::select(inside, self.here.way, self.end) - self.before;
        self.here.length += piece.size();
        let more = Lane::select(inside, one, one.each(0.0));
        self.here.collisions += more;
        self.lookups += more;
        let t = Lane::select(inside, self.here.way, self.begin.way);
        let (mut real, mut albedos) = ([one; MOST_CHANNELS], [one; MOST_CHANNELS]);
        for (channel, &found) in found[..count].iter().enumerate() {
            real[channel] = found / one.each(page.majorants[channel]);
            albedos[channel] = page.setup.problem.albedo(channel, t);
        }
        let (real, albedos) = (&real[..count], &albedos[..count]);
        let odds = ParticleRule::Analog.odds(of_hero(self.hero, real), of_hero(self.hero, albedos));
        let walks = inside & !casts;
        let is_scattered = walks & number.below(odds.scatter);
        let is_null = walks & !is_scattered & number.below(odds.scatter + odds.transmit);
        let passes = is_null | (casts & inside);
        for (channel, &real) in real.iter().enumerate() {
            let nulls = self.nulls[channel];
            self.nulls[channel] = Lane::select(passes, nulls * (one - real), nulls);
        }
        let connected = casts & !inside;
        let arrives = connected | (self.is_forward & !inside & !casts);
        if arrives.any_true() {
            self.score(arrives, connected);
        }
        if connected.any_true() {
            self.here.stand_as(connected, &self.vertex);
            self.turn(connected, self.keeps);
            self.casts &= inside;
        }
        if is_scattered.any_true() {
            self.scatter(is_scattered, (real, albedos), numbers);
        }
        self.goes_on = casts | is_scattered | is_null;
        (!self.goes_on).to_bitmask()
    }

    #[inline(always)]
    fn collect(&self, ended: u64, slots: &mut Slots, buffer: &mut DrawBuffer) -> u64 {
        const EACH: [usize; MOST_CHANNELS] = [0, 1, 2, 3, 4, 5, 6, 7];
        collect(&self.scores, &self.lookups, &EACH[..self.page.count], (ended, slots), buffer)
    }

    #[inline(always)]
    fn restart(&mut self, numbers: &mut Numbers<S>) {
        let ended = !self.goes_on;
        let (zero, one) = (self.path.each(0.0), self.path.each(1.0));
        for channel in 0..self.page.count {
            self.weights[channel] = Lane::select(ended, one, self.weights[channel]);
            self.phases[channel] = Lane::select(ended, one, self.phases[channel]);
            self.nulls[channel] = Lane::select(ended, one, self.nulls[channel]);
            self.scores[channel] = Lane::select(ended, zero, self.scores[channel]);
        }
        self.lookups = Lane::select(ended, zero, self.lookups);
        let begin = self.begin;
        self.here.stand_as(ended, &begin);
        self.is_forward |= ended;
        self.unscattered |= ended;
        self.choose(ended, numbers);
    }
}
