//! Eight particles side by side: the packet kernel of [`super::walk`], for the rules of
//! [`ParticleRule`] and a σ̂ of one value.
//!
//! Specification: draw j is, bit for bit, the draw that [`super::walk::draw`] makes from stream
//! j mod 16.
//!
//! A step has no branches: who is scattered or ends is a mask. The numbers of a new direction are drawn
//! for all; the streams of those that are not scattered stay where they were.

use std::f64::consts::TAU;

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8, u64x8};

use super::walk::turned;
use crate::estimators::packet::Request;
use crate::estimators::places::{self, Place, Places};
use crate::estimators::{DrawBuffer, Setup};
use crate::media::even::Even;
use crate::media::{Extinction, Lookups};
use crate::numeric::Lane;
use crate::numeric::pack::{self, Task, WIDTH};
use crate::phase::Phase;
use crate::phase::isotropic::Isotropic;
use crate::problems::Slab;
use crate::problems::slab::Light;
use crate::rng::{LANES, Xoshiro};
use crate::theory::ParticleRule;

/// The draws of a rule, on the hardware of a level; a request is handed back where the hardware is too
/// narrow or σ̂ has several values.
#[must_use]
pub fn walks<'a>(
    level: Level,
    setup: &Setup<Slab>,
    rule: ParticleRule,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let Some(sampling) = setup.sampling.even() else { return Some(request) };
    let task = Walks { setup, sampling, rule, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct Walks<'a, 'r> {
    setup: &'a Setup<Slab>,
    sampling: &'a Even,
    rule: ParticleRule,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl Task for Walks<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { setup, sampling, rule, medium, request } = self;
        let Request { streams, count, buffer } = request;
        let slab = &*setup.problem;
        let incidence = &slab.incidence;
        let begin = f64x8::splat(simd, sampling.from);
        let (end, path) = (begin.each(sampling.to), begin.each(1.0 / sampling.value));
        let (zero, one) = (begin.each(0.0), begin.each(1.0));
        let albedo = begin.each(slab.albedo);
        buffer.make_room(count);
        for (pack, lanes) in streams.packs().iter().enumerate() {
            let mut numbers = lanes.awake(simd);
            let (mut way, mut weight) = (begin, one);
            let mut cosine = entering(incidence.light, &mut numbers, zero.at_most(one), one);
            let mut places = Places::new(count, streams.turn, pack);
            while places.are_open() {
                let (length, number) = (-numbers.ln_uniform(), numbers.uniform());
                let depth = length * cosine.size();
                let is_down = zero.below(cosine);
                way = Lane::select(is_down, depth, -depth).times_plus(path, way);
                let inside = (is_down & way.below(end)) | (!is_down & begin.below(way));
                // Above and below there is no field to look at.
                let t = Lane::select(inside, sampling.spread(way), begin);
                let odds = rule.odds(medium.extinction(t) * path, albedo);
                let is_scattered = inside & number.below(odds.scatter);
                let is_passed = inside & !is_scattered & number.below(odds.scatter + odds.transmit);
                let goes_on = is_scattered | is_passed;
                let ended = (!goes_on).to_bitmask();
                if ended != 0 {
                    let mut ends = Ends { inside: inside.to_bitmask(), ..Ends::default() };
                    let left = Lane::select(inside, zero, weight);
                    Lane::select(is_down, zero, left).store_slice(&mut ends.values[0]);
                    Lane::select(is_down, left, zero).store_slice(&mut ends.values[1]);
                    let over = ends.collect(&mut places, ended, buffer);
                    places::leave(streams, pack, over, numbers);
                }
                places.step();
                let deflection = incidence.phase.cosine(numbers.uniform_where(is_scattered));
                let direction = if incidence.phase == Phase::Isotropic(Isotropic) {
                    deflection
                } else {
                    let azimuth = (numbers.uniform_where(is_scattered) * TAU).cos();
                    turned(cosine, deflection, azimuth)
                };
                let factor = Lane::select(is_scattered, odds.scatter_weight, odds.transmit_weight);
                weight = Lane::select(goes_on, weight * factor, one);
                way = Lane::select(goes_on, way, begin);
                cosine = Lane::select(is_scattered, direction, cosine);
                let fresh = entering(incidence.light, &mut numbers, !goes_on, one);
                cosine = Lane::select(goes_on, cosine, fresh);
            }
        }
        streams.turn = (streams.turn + count) % LANES;
    }
}

/// The cosines with which particles enter; those that a mask names take a number for it where light is
/// diffuse.
#[inline(always)]
fn entering<S: Simd>(
    light: Light,
    numbers: &mut Xoshiro<u64x8<S>>,
    which: mask64x8<S>,
    one: f64x8<S>,
) -> f64x8<S> {
    match light {
        Light::Collimated(cosine) => one.each(cosine),
        Light::Diffuse => (one - numbers.uniform_where(which)).root(),
    }
}

/// What eight walks have come to.
#[derive(Default)]
#[repr(align(64))]
struct Ends {
    /// Who ended inside, as bits.
    inside: u64,
    /// What leaves at the top, and at the bottom.
    values: [[f64; WIDTH]; 2],
}

impl Ends {
    /// Makes draws of those that ended.
    #[inline(never)]
    #[allow(clippy::cast_possible_truncation)] // one bit
    fn collect(&self, places: &mut Places, ended: u64, buffer: &mut DrawBuffer) -> u64 {
        places.fill(ended, |Place { lane, draw, steps }| {
            for (channel, values) in buffer.values.iter_mut().zip(&self.values) {
                channel[draw] = values[lane];
            }
            buffer.defects[draw] = 0.0;
            // The step that leaves looks at nothing.
            buffer.lookups[draw] = steps + (self.inside >> lane & 1) as u32;
        })
    }
}
