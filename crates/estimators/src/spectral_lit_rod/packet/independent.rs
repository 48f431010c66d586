//! Walks of one channel each, eight side by side in media of their own: the packet kernel of [`super::super::independent`].
//!
//! Specification: draw j is, bit for bit, the draw that the page makes from stream j mod 16. A lane walks as in
//! [`crate::lit_rod::walk`], through the medium of its hero; its steps and those of its shadow rays take the
//! same random numbers.

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::Page;
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::{self, Numbers, Particles, Slots};
use crate::kernels::packet::hero::{number_of_hero, or_of_hero};
use crate::kernels::packet::kept::Keep;
use crate::kernels::packet::left;
use crate::setup::heroes::Heroes;
use crate::{DrawBuffer, Setup};
use media::Lookups;
use media::body::MOST_CHANNELS;
use numeric::Lane;
use numeric::pack::{self, Task};
use theory::ParticleRule;
use theory::lit_rod::Techniques;
use theory::problems::SpectralLitRod;

/// The draws of techniques, on the hardware of a level; a request is handed back where the hardware is too narrow.
pub fn walks<'a>(
    level: Level,
    (techniques, heroes): (Techniques, &Heroes),
    setup: &Setup<SpectralLitRod>,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let page = Page::of_channels(heroes, setup);
    let task = Walks { page: &page, techniques, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct Walks<'a, 'r> {
    page: &'a Page<'a>,
    techniques: Techniques,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl Task for Walks<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { page, techniques, medium, request } = self;
        let support = page.setup.mesh.support();
        let (zero, one) = (f64x8::splat(simd, 0.0), f64x8::splat(simd, 1.0));
        let all = mask64x8::splat(simd, true);
        let from = zero.each(support.from);
        let fresh = Alone {
            page,
            techniques,
            keep: Keep::new(simd),
            from,
            to: zero.each(support.to),
            way: from,
            vertex: from,
            number: zero,
            inside: all,
            casts: !all,
            goes_on: all,
            is_forward: all,
            unscattered: all,
            hero: zero,
            path: one,
            forward: one,
            ratio: one,
            phase: zero,
            found: one,
            score: zero,
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
            |places, found| bank::of_channels(simd, medium, page.media.count, places, found),
            request,
        );
    }
}

/// Eight walks.
#[derive(Clone, Copy)]
struct Alone<'a, S: Simd> {
    page: &'a Page<'a>,
    techniques: Techniques,
    keep: Keep<S>,
    from: f64x8<S>,
    to: f64x8<S>,
    way: f64x8<S>,
    /// Where those that cast were scattered.
    vertex: f64x8<S>,
    number: f64x8<S>,
    inside: mask64x8<S>,
    /// Which fly as shadow rays.
    casts: mask64x8<S>,
    goes_on: mask64x8<S>,
    /// The direction of the walk; a shadow ray flies forward.
    is_forward: mask64x8<S>,
    unscattered: mask64x8<S>,
    /// The number of each hero, its mean free path through σ̂ and its chance to keep the direction.
    hero: f64x8<S>,
    path: f64x8<S>,
    forward: f64x8<S>,
    /// ρ.
    ratio: f64x8<S>,
    /// p(ω) towards the emitter at the last scattering.
    phase: f64x8<S>,
    /// The transmittance of the shadow ray so far.
    found: f64x8<S>,
    score: f64x8<S>,
    lookups: f64x8<S>,
}

impl<S: Simd> Alone<'_, S> {
    /// Chooses the heroes of walks that begin.
    #[inline(always)]
    fn choose(&mut self, which: mask64x8<S>, numbers: &mut Numbers<S>) {
        let (Page { law, media, paths, setup, .. }, keep) = (self.page, self.keep);
        let hero = law.choose(numbers.uniform_where(which));
        keep.put(&mut self.hero, which, hero);
        keep.put(&mut self.path, which, number_of_hero(hero, &paths[..media.count]));
        let forward = number_of_hero(hero, &setup.problem.forward[..media.count]);
        keep.put(&mut self.forward, which, forward);
    }

    /// Shadow rays on their way, and those of walks that are scattered here.
    #[inline(always)]
    fn cast(&mut self, is_scattered: mask64x8<S>, phase: f64x8<S>, real: f64x8<S>) {
        let Self { keep, casts, inside, .. } = *self;
        let one = real.each(1.0);
        let ends = casts & !inside;
        let score = self.score + self.techniques.of_shadow_ray(self.phase, self.found);
        keep.put(&mut self.score, ends, score);
        let found = self.found * (one - real);
        keep.put(&mut self.found, casts & inside, found);
        keep.put(&mut self.found, is_scattered, one);
        keep.put(&mut self.phase, is_scattered, phase);
        let (way, vertex) = (self.way, self.vertex);
        keep.put(&mut self.way, ends, vertex);
        keep.put(&mut self.vertex, is_scattered, way);
        self.casts = (casts & inside) | is_scattered;
    }
}

impl<S: Simd> Particles<S> for Alone<'_, S> {
    type Found = [f64x8<S>; MOST_CHANNELS];

    #[inline(always)]
    fn fly(&mut self, numbers: &mut Numbers<S>) -> f64x8<S> {
        let depth = -numbers.ln_uniform();
        self.number = numbers.uniform();
        let is_forward = self.is_forward | self.casts;
        let way = Lane::select(is_forward, depth, -depth).times_plus(self.path, self.way);
        self.inside = (is_forward & way.below(self.to)) | (!is_forward & self.from.below(way));
        self.way = way;
        // Beyond both ends there is no field to look at.
        Lane::select(self.inside, way, self.from)
    }

    #[inline(always)]
    fn collide(&mut self, found: &Self::Found, numbers: &mut Numbers<S>) -> u64 {
        let Self { page, techniques, keep, inside, casts, number, .. } = *self;
        let (count, one) = (page.media.count, number.each(1.0));
        let lookups = self.lookups + 1.0;
        keep.put(&mut self.lookups, inside, lookups);
        let t = Lane::select(inside, self.way, self.from);
        let (mut own, mut albedo) = (one, one);
        for (channel, &found) in found[..count].iter().enumerate() {
            own = or_of_hero(self.hero, channel, own, found);
            albedo = or_of_hero(self.hero, channel, albedo, page.albedo(channel, t));
        }
        let real = own * self.path;
        let odds = ParticleRule::Analog.odds(real, albedo);
        let walks = inside & !casts;
        let is_scattered = walks & number.below(odds.scatter);
        let is_null = walks & !is_scattered & number.below(odds.scatter + odds.transmit);
        let hits = self.is_forward & !inside & !casts;
        let weight = Lane::select(self.unscattered, one, techniques.of_hit(self.ratio));
        let score = self.score + weight;
        keep.put(&mut self.score, hits, score);
        if techniques.has_nulls() {
            let ratio = self.ratio * (one - real);
            keep.put(&mut self.ratio, is_null, ratio);
        }
        let direction = numbers.uniform_where(is_scattered);
        let phase = Lane::select(self.is_forward, self.forward, one - self.forward);
        if techniques.shadow.is_some() {
            self.cast(is_scattered, phase, real);
        }
        keep.put(&mut self.ratio, is_scattered, techniques.ratio(phase, one));
        self.is_forward ^= is_scattered & !direction.below(self.forward);
        self.unscattered &= !is_scattered;
        self.goes_on = casts | is_scattered | is_null;
        (!self.goes_on).to_bitmask()
    }

    #[inline(always)]
    fn collect(&mut self, ended: u64, slots: &mut Slots, buffer: &mut DrawBuffer) -> u64 {
        let (media, zero) = (&self.page.media, self.score.each(0.0));
        let score = self.score / number_of_hero(self.hero, &media.chances[..media.count]);
        let mut scores = [zero; MOST_CHANNELS];
        for (channel, own) in scores[..media.count].iter_mut().enumerate() {
            let number = zero.each(channel as f64);
            let is_hero = self.hero.at_most(number) & number.at_most(self.hero);
            *own = Lane::select(is_hero, score, zero);
        }
        left::draws(&scores[..media.count], &self.lookups, (ended, slots), buffer)
    }

    #[inline(always)]
    fn restart(&mut self, numbers: &mut Numbers<S>) {
        let (ended, keep, zero) = (!self.goes_on, self.keep, self.score.each(0.0));
        keep.put(&mut self.way, ended, self.from);
        keep.put(&mut self.score, ended, zero);
        keep.put(&mut self.lookups, ended, zero);
        self.is_forward |= ended;
        self.unscattered |= ended;
        self.choose(ended, numbers);
    }
}
