//! Eight particles side by side: the packet kernel of [`super::walk`], for the rules of
//! [`ParticleRule`] and a σ̂ of one value.
//!
//! Specification: draw j is, bit for bit, the draw that [`super::walk::draw`] makes from stream
//! j mod 16.
//!
//! A step has no branches: who is scattered, turns round or ends is a mask. The number of a new
//! direction is drawn for all; the streams of those that are not scattered stay where they were.

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::walk::Fate;
use crate::estimators::packet::Request;
use crate::estimators::places::{self, Place, Places};
use crate::estimators::{DrawBuffer, Setup};
use crate::media::even::Even;
use crate::media::{Extinction, Lookups};
use crate::numeric::Lane;
use crate::numeric::pack::{self, Task, WIDTH};
use crate::problems::Rod;
use crate::problems::rod::{MOST_PARTS, Quantity};
use crate::rng::LANES;
use crate::theory::ParticleRule;

/// The draws of a rule, on the hardware of a level; a request is handed back where the hardware is too
/// narrow or σ̂ has several values.
#[must_use]
pub fn walks<'a>(
    level: Level,
    setup: &Setup<Rod>,
    rule: ParticleRule,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let Some(sampling) = setup.sampling.even() else { return Some(request) };
    let task = Walks { setup, sampling, rule, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct Walks<'a, 'r> {
    setup: &'a Setup<Rod>,
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
        let rod = &*setup.problem;
        let begin = f64x8::splat(simd, sampling.from);
        let (end, path) = (begin.each(sampling.to), begin.each(1.0 / sampling.value));
        let (zero, one) = (begin.each(0.0), begin.each(1.0));
        let parts = Parts::of(rod, path);
        buffer.make_room(count);
        for (pack, lanes) in streams.packs().iter().enumerate() {
            let (mut way, mut is_forward) = (begin, mask64x8::splat(simd, true));
            let (mut weight, mut order) = (one, zero);
            let (mut absorbed, mut flux) = (zero, [zero; MOST_PARTS]);
            let mut numbers = lanes.awake(simd);
            let mut places = Places::new(count, streams.turn, pack);
            while places.are_open() {
                let (depth, number) = (-numbers.ln_uniform(), numbers.uniform());
                way = Lane::select(is_forward, depth, -depth).times_plus(path, way);
                let inside = (is_forward & way.below(end)) | (!is_forward & begin.below(way));
                // Beyond both ends there is no field to look at.
                let t = Lane::select(inside, sampling.spread(way), begin);
                let ratio = medium.extinction(t) * path;
                let albedo = rod.albedo.value(t);
                let taken = weight * ratio * (one - albedo);
                absorbed = Lane::select(inside, absorbed + taken, absorbed);
                parts.score(t, inside, weight, &mut flux);
                let odds = rule.odds(ratio, albedo);
                let is_scattered = inside & number.below(odds.scatter);
                let is_passed = inside & !is_scattered & number.below(odds.scatter + odds.transmit);
                let goes_on = is_scattered | is_passed;
                let ended = (!goes_on).to_bitmask();
                if ended != 0 {
                    let (inside, is_forward) = (inside.to_bitmask(), is_forward.to_bitmask());
                    let mut ends = Ends { inside, is_forward, ..Ends::default() };
                    weight.store_slice(&mut ends.weight);
                    order.store_slice(&mut ends.order);
                    absorbed.store_slice(&mut ends.absorbed);
                    for (end, flux) in ends.flux.iter_mut().zip(flux) {
                        flux.store_slice(end);
                    }
                    let over = ends.collect(&mut places, ended, rod, buffer);
                    places::leave(streams, pack, over, numbers);
                }
                places.step();
                let direction = numbers.uniform_where(is_scattered);
                let turns = is_scattered & !direction.below(rod.forward.value(t));
                is_forward = (is_forward ^ turns) | !goes_on;
                let factor = Lane::select(is_scattered, odds.scatter_weight, odds.transmit_weight);
                weight = Lane::select(goes_on, weight * factor, one);
                order = Lane::select(is_scattered, order + 1.0, order);
                order = Lane::select(goes_on, order, zero);
                absorbed = Lane::select(goes_on, absorbed, zero);
                for flux in &mut flux {
                    *flux = Lane::select(goes_on, *flux, zero);
                }
                way = Lane::select(goes_on, way, begin);
            }
        }
        streams.turn = (streams.turn + count) % LANES;
    }
}

/// The parts of a rod that see its flux.
struct Parts<L> {
    count: usize,
    begin: f64,
    width: f64,
    /// The score of a tentative collision of weight 1.
    score: L,
}

impl<L: Lane> Parts<L> {
    #[inline(always)]
    fn of(rod: &Rod, path: L) -> Self {
        let (begin, width) = (rod.begin(), rod.width());
        Self { count: rod.parts, begin, width, score: path * (1.0 / width) }
    }

    /// Scores where the walks are, as [`Rod::part`] finds them.
    #[inline(always)]
    fn score(&self, t: L, inside: L::Mask, weight: L, flux: &mut [L; MOST_PARTS]) {
        if self.count == 0 {
            return;
        }
        let at = (t - self.begin) / t.each(self.width);
        let score = weight * self.score;
        let (mut part, last) = (0.0, self.count - 1);
        for (number, flux) in flux.iter_mut().take(self.count).enumerate() {
            let mut is_here = inside;
            if number > 0 {
                is_here = is_here & t.each(part).at_most(at);
            }
            part += 1.0;
            if number < last {
                is_here = is_here & at.below(t.each(part));
            }
            *flux = L::select(is_here, *flux + score, *flux);
        }
    }
}

/// What eight walks have come to.
#[derive(Default)]
#[repr(align(64))]
struct Ends {
    /// Who ended inside, and who was going forward, as bits.
    inside: u64,
    is_forward: u64,
    weight: [f64; WIDTH],
    order: [f64; WIDTH],
    absorbed: [f64; WIDTH],
    flux: [[f64; WIDTH]; MOST_PARTS],
}

impl Ends {
    /// What became of one of them.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
    fn fate(&self, lane: usize) -> Fate {
        let left = match (self.inside >> lane & 1, self.is_forward >> lane & 1) {
            (0, 0) => Some(Quantity::Reflected),
            (0, _) => Some(Quantity::Transmitted),
            _ => None,
        };
        let flux = self.flux.each_ref().map(|row| row[lane]);
        let (weight, absorbed) = (self.weight[lane], self.absorbed[lane]);
        Fate { left, weight, order: self.order[lane] as usize, absorbed, flux }
    }

    /// Makes draws of those that ended.
    #[inline(never)]
    #[allow(clippy::cast_possible_truncation)] // one bit
    fn collect(&self, places: &mut Places, ended: u64, rod: &Rod, buffer: &mut DrawBuffer) -> u64 {
        places.fill(ended, |Place { lane, draw, steps }| {
            let values = self.fate(lane).values(&rod.channels);
            for (channel, value) in buffer.values.iter_mut().zip(values.as_ref()) {
                channel[draw] = *value;
            }
            buffer.defects[draw] = 0.0;
            // The step that leaves looks at nothing.
            buffer.lookups[draw] = steps + (self.inside >> lane & 1) as u32;
        })
    }
}
