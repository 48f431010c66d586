//! Walks of heroes to an emitter side by side: the packet kernel of [`super::walk`].
//!
//! Specification: draw j is, bit for bit, the draw that [`super::walk::draw`] makes from stream j mod 16.
//!
//! A lane flies as a walk or as a shadow ray. Where a walk is scattered its place is kept; its shadow ray flies on from
//! there, with the weights of the path, and when it has ended the walk does. All channels are looked up at every collision.
//! What paths score is found when all walks have ended, eight paths at a time.
//!
//! Loops over channels count: a kernel does not inline iterators of two slices, and would lose its registers to the call.

pub mod independent;
mod lanes;
pub mod tracking;

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};
use std::cell::RefCell;

use self::lanes::{InLitRod, Place};
use super::walk::{Found, Steps};
use crate::Setup;
use crate::kernels::hero::Weighing;
use crate::kernels::packet::Request;
use crate::kernels::packet::bank;
use crate::kernels::packet::hero::{Law, Media};
use crate::kernels::packet::kept::Keep;
use crate::kernels::packet::paths::{Events, NOTHING};
use crate::setup::heroes::Heroes;
use media::Lookups;
use media::body::MOST_CHANNELS;
use numeric::Lane;
use numeric::pack::{self, Task};
use theory::problems::SpectralLitRod;

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
    media: Media,
    law: Law,
    casts: bool,
    /// How hits and shadow rays are weighted.
    hit: Weighing,
    connected: Weighing,
    /// 1/σ̂ of each channel.
    paths: Channels,
    /// Albedos that are the same everywhere.
    albedos: Option<Vec<f64>>,
    /// The chance to keep the direction by channel and hero.
    forward: [Channels; MOST_CHANNELS],
}

impl<'a> Page<'a> {
    /// Of walks of one channel each.
    fn of_channels(heroes: &Heroes, setup: &'a Setup<SpectralLitRod>) -> Self {
        let media = Media::new(setup, &heroes.of(setup.channels.len()));
        let mut paths = [0.0; MOST_CHANNELS];
        for (channel, own) in setup.channels.iter().enumerate() {
            paths[channel] = 1.0 / own.majorant;
        }
        Self {
            setup,
            media,
            law: Law::new(heroes, media.count),
            casts: false,
            hit: Weighing::RIGHT,
            connected: Weighing::RIGHT,
            paths,
            albedos: setup.problem.albedos(),
            forward: [[0.0; MOST_CHANNELS]; MOST_CHANNELS],
        }
    }

    fn new(steps: &impl Steps, setup: &'a Setup<SpectralLitRod>) -> Self {
        let alone = Self::of_channels(steps.heroes(), setup);
        let mut page = Self {
            casts: steps.casts(),
            hit: steps.weighing(Found::Hit),
            connected: steps.weighing(Found::Connected),
            ..alone
        };
        for channel in 0..page.media.count {
            for hero in 0..page.media.count {
                let forward = setup.problem.forward[steps.phase_of(channel, hero)];
                page.forward[channel][hero] = forward;
            }
        }
        page
    }

    /// a of a channel.
    #[inline(always)]
    fn albedo<L: Lane>(&self, channel: usize, t: L) -> L {
        match &self.albedos {
            Some(albedos) => t.each(albedos[channel]),
            None => self.setup.problem.albedo(channel, t),
        }
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
        let Request { streams, count, buffer } = request;
        let events = RefCell::new(Events::new(page.media.count, count));
        let fresh = InLitRod {
            page,
            events: &events,
            last: NOTHING,
            keep: Keep::new(simd),
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
            forward: [one; MOST_CHANNELS],
            weights: [one; MOST_CHANNELS],
            phases: [one; MOST_CHANNELS],
            nulls: [one; MOST_CHANNELS],
            lookups: zero,
            real: [one; MOST_CHANNELS],
            albedos: [one; MOST_CHANNELS],
            next: [zero; MOST_CHANNELS],
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
            Request { streams, count, buffer: &mut *buffer },
        );
        pack::outlined(
            simd,
            #[inline(always)]
            || events.borrow().score(simd, &page.media, buffer),
        );
    }
}
