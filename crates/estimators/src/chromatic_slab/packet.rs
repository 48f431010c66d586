//! Walks of heroes through a slab side by side: the packet kernel of [`super::walk`].
//!
//! Specification: draw j is, bit for bit, the draw that the page makes from stream j mod 16. What walks score is found when
//! all have ended.

use std::cell::RefCell;

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use crate::kernels::packet::Request;
use crate::kernels::packet::bank::{self, Numbers, Particles, Slots};
use crate::kernels::packet::colours::{Densities, Events, Scatterers, alone, balance};
use crate::kernels::packet::hero::{Law, Media, number_of_hero};
use crate::kernels::packet::kept::Keep;
use crate::kernels::packet::left::{Left, Made};
use crate::setup::walker::Walker;
use crate::slab::walk::turned;
use crate::{DrawBuffer, Setup};
use media::Lookups;
use media::body::MOST_CHANNELS;
use numeric::Lane;
use numeric::pack::{self, Task};
use theory::problems::ChromaticSlab;
use theory::problems::slab::Light;
use theory::problems::spectral_rod::{End, MOST};

/// What a walk leaves beside its weights: its hero, its length, its lookups, and where it left.
const REST: usize = 4;
/// Where a walk left, as a number.
const REFLECTED: f64 = 0.0;
const TRANSMITTED: f64 = 1.0;
/// Nowhere.
const ABSORBED: f64 = 2.0;

/// The draws of a page on the hardware of a level, which score all channels or the hero's alone; a request is handed back
/// where the hardware is too narrow.
pub fn walks<'a, const ALL: bool>(
    level: Level,
    walker: &Walker,
    setup: &Setup<ChromaticSlab>,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let (problem, media) =
        (&*setup.problem, Media::new(setup, &walker.probabilities(setup.channels.len())));
    let mut paths = [0.0; MOST_CHANNELS];
    for (channel, own) in setup.channels.iter().enumerate() {
        paths[channel] = 1.0 / own.majorant;
    }
    let albedos = problem.colours.albedos.iter().zip(&problem.incidences);
    let page = Page {
        setup,
        media,
        walker,
        law: walker.heroes().map(|heroes| Law::new(heroes, media.count)),
        paths,
        scatterers: Scatterers::new(albedos.map(|(albedo, own)| (*albedo, own.phase))),
    };
    let task = Walks::<ALL> { page: &page, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

/// What all walks share.
struct Page<'a> {
    setup: &'a Setup<ChromaticSlab>,
    media: Media,
    walker: &'a Walker,
    /// The law of the hero, if one is chosen.
    law: Option<Law>,
    /// 1/σ̂ of each channel.
    paths: [f64; MOST_CHANNELS],
    scatterers: Scatterers,
}

struct Walks<'a, 'r, const ALL: bool> {
    page: &'a Page<'a>,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl<const ALL: bool> Task for Walks<'_, '_, ALL> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { page, medium, request } = self;
        let Request { streams, count, buffer } = request;
        let (support, channels) = (page.setup.mesh.support(), page.media.count);
        let (zero, all) = (f64x8::splat(simd, 0.0), mask64x8::splat(simd, true));
        let left = RefCell::new(Left::new(REST + if ALL { channels } else { 0 }, count));
        let fresh = InSlab::<S, ALL> {
            page,
            left: &left,
            keep: Keep::new(simd),
            from: zero.each(support.from),
            to: zero.each(support.to),
            way: zero,
            before: zero,
            cosine: zero,
            depth: zero,
            inside: all,
            goes_on: all,
            hero: zero,
            path: zero,
            majorant: zero,
            albedo: zero,
            length: zero,
            lookups: zero,
            densities: Densities::new(simd),
        };
        bank::run(
            simd,
            #[inline(always)]
            |numbers| {
                let mut fresh = fresh;
                fresh.begin(all, numbers);
                fresh
            },
            [[zero; MOST_CHANNELS]; 2],
            #[inline(always)]
            |places, found| bank::of_channels(simd, medium, channels, places, found),
            Request { streams, count, buffer: &mut *buffer },
        );
        pack::outlined(
            simd,
            #[inline(always)]
            || page.score::<S, ALL>(simd, &left.borrow(), Made::new(buffer, count)),
        );
    }
}

impl Page<'_> {
    /// Makes draws of what walks have left.
    #[inline(always)]
    fn score<S: Simd, const ALL: bool>(&self, simd: S, left: &Left, mut made: Made) {
        let seen = &self.setup.problem.colours.seen;
        let zero = f64x8::splat(simd, 0.0);
        let (mut found, mut values) = ([zero; MOST_CHANNELS], [zero; MOST]);
        let found = &mut found[..self.media.count];
        for first in made.packs() {
            let (hero, length) = (left.row(simd, 0, first), left.row(simd, 1, first));
            let (lookups, end) = (left.row(simd, 2, first), left.row(simd, 3, first));
            let mut defects = zero;
            if ALL {
                for (channel, found) in found.iter_mut().enumerate() {
                    *found = left.row(simd, REST + channel, first);
                }
                self.media.common(hero, [length, lookups], found);
                if matches!(self.walker, Walker::Mis(_)) {
                    let defect = balance(&self.media, found);
                    defects = Lane::select(end.below(zero.each(ABSORBED)), defect, zero);
                }
            } else {
                alone(&self.media, hero, found);
            }
            for (number, &(seen, channel)) in seen.iter().enumerate() {
                let seen = zero.each(if seen == End::Reflected { REFLECTED } else { TRANSMITTED });
                let is_seen = end.at_most(seen) & seen.at_most(end);
                values[number] = Lane::select(is_seen, found[channel], zero);
            }
            made.write(first, &values[..seen.len()], [lookups, defects]);
        }
        made.end();
    }
}

/// Eight walks.
#[derive(Clone, Copy)]
struct InSlab<'a, S: Simd, const ALL: bool> {
    page: &'a Page<'a>,
    left: &'a RefCell<Left>,
    keep: Keep<S>,
    from: f64x8<S>,
    to: f64x8<S>,
    way: f64x8<S>,
    /// Where the flight began, its cosine with the normal, and how deep it goes in mean free paths.
    before: f64x8<S>,
    cosine: f64x8<S>,
    depth: f64x8<S>,
    inside: mask64x8<S>,
    goes_on: mask64x8<S>,
    /// The number of each hero, its mean free path through σ̂, its σ̂ and its albedo.
    hero: f64x8<S>,
    path: f64x8<S>,
    majorant: f64x8<S>,
    albedo: f64x8<S>,
    length: f64x8<S>,
    lookups: f64x8<S>,
    densities: Densities<S>,
}

impl<S: Simd, const ALL: bool> InSlab<'_, S, ALL> {
    /// Some walks begin.
    #[inline(always)]
    fn begin(&mut self, which: mask64x8<S>, numbers: &mut Numbers<S>) {
        let (Page { setup, media, law, paths, scatterers, .. }, keep) = (self.page, self.keep);
        let (zero, count) = (self.from.each(0.0), media.count);
        let hero = match law {
            Some(law) => law.choose(numbers.uniform_where(which)),
            None => zero,
        };
        keep.put(&mut self.hero, which, hero);
        keep.put(&mut self.path, which, number_of_hero(hero, &paths[..count]));
        keep.put(&mut self.majorant, which, number_of_hero(hero, &media.majorants[..count]));
        keep.put(&mut self.albedo, which, number_of_hero(hero, &scatterers.albedos[..count]));
        let cosine = match setup.problem.incidences[0].light {
            Light::Collimated(cosine) => zero.each(cosine),
            Light::Diffuse => (zero.each(1.0) - numbers.uniform_where(which)).root(),
        };
        keep.put(&mut self.cosine, which, cosine);
        keep.put(&mut self.way, which, self.from);
        keep.put(&mut self.length, which, zero);
        keep.put(&mut self.lookups, which, zero);
        if ALL {
            self.densities.begin(count, which);
        }
    }
}

impl<S: Simd, const ALL: bool> Particles<S> for InSlab<'_, S, ALL> {
    type Found = [f64x8<S>; MOST_CHANNELS];

    #[inline(always)]
    fn fly(&mut self, numbers: &mut Numbers<S>) -> f64x8<S> {
        self.before = self.way;
        self.depth = -numbers.ln_uniform() * self.cosine;
        let way = self.depth.times_plus(self.path, self.way);
        let is_down = self.cosine.each(0.0).below(self.cosine);
        self.inside = (is_down & way.below(self.to)) | (!is_down & self.from.below(way));
        self.way = way;
        // Beyond both faces there is no field to look at.
        Lane::select(self.inside, way, self.from)
    }

    #[inline(always)]
    fn collide(&mut self, found: &Self::Found, numbers: &mut Numbers<S>) -> u64 {
        let Self { page, keep, inside, cosine, .. } = *self;
        let (zero, one) = (cosine.each(0.0), cosine.each(1.0));
        let face = Lane::select(zero.below(cosine), self.to, self.from);
        let deep = Lane::select(inside, self.depth / self.majorant, face - self.before);
        self.length += deep / cosine;
        self.lookups += Lane::select(inside, one, zero);
        let own = self.densities.look(&page.media, self.hero, found);
        let by = (&page.scatterers, page.walker);
        let chances = self.densities.chances(by, [own, self.albedo]);
        let [passes, scatters, _] = chances;
        let number = numbers.uniform_where(inside);
        let scattered = inside & number.below(scatters);
        let null = inside & !scattered & number.below(scatters + passes);
        let mut deflection = one;
        if scattered.any_true() {
            deflection = page.scatterers.cosine(self.hero, numbers.uniform_where(scattered));
            let turns = numbers.uniform_where(scattered);
            let azimuth = Lane::cos(turns * std::f64::consts::TAU);
            keep.put(&mut self.cosine, scattered, turned(cosine, deflection, azimuth));
        }
        if ALL {
            let events = Events { scattered, null, collided: inside };
            self.densities.weigh(by, self.hero, (events, chances), deflection);
        }
        self.goes_on = scattered | null;
        (!self.goes_on).to_bitmask()
    }

    #[inline(always)]
    fn collect(&mut self, ended: u64, slots: &mut Slots, _: &mut DrawBuffer) -> u64 {
        let zero = self.cosine.each(0.0);
        let (reflected, transmitted) = (zero.each(REFLECTED), zero.each(TRANSMITTED));
        let face = Lane::select(zero.below(self.cosine), transmitted, reflected);
        let end = Lane::select(self.inside, zero.each(ABSORBED), face);
        let rest = [self.hero, self.length, self.lookups, end];
        let weights = if ALL { &self.densities.weights[..self.page.media.count] } else { &[] };
        self.left.borrow_mut().collect([&rest, weights], (ended, slots))
    }

    #[inline(always)]
    fn restart(&mut self, numbers: &mut Numbers<S>) {
        self.begin(!self.goes_on, numbers);
    }
}
