//! Particles in a rod side by side: the packet kernel of [`super::walk`], for the rules of [`ParticleRule`] with
//! or without roulette.
//!
//! Specification: draw j is, bit for bit, the draw that [`super::walk::draw`] makes from stream
//! j mod 16.
//!
//! A step has no branches: who is scattered, turns round or ends is a mask. Numbers that only some need are
//! drawn for all; the streams of the others stay where they were.

use fearless_simd::{ExtractToken, Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::walk::Fate;
use crate::kernels::packet::bank::{Numbers, Particles, Slot, Slots};
use crate::kernels::packet::{Request, line};
use crate::{DrawBuffer, Setup};
use media::Lookups;
use media::course::BothWays;
use numeric::Lane;
use numeric::pack::WIDTH;
use theory::ParticleRule;
use theory::problems::Rod;
use theory::problems::rod::{MOST_PARTS, Quantity};

/// The draws of a rule, with roulette on weights below a number where one is given, on the hardware of a level;
/// a request is handed back where the hardware is too narrow or one draw after the other is faster.
pub fn walks<'a>(
    level: Level,
    setup: &Setup<Rod>,
    (rule, roulette): (ParticleRule, Option<f64>),
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let walks = Walks { rod: &setup.problem, rule, roulette };
    line::walks(level, &walks, &setup.sampling, medium, request)
}

struct Walks<'a> {
    rod: &'a Rod,
    rule: ParticleRule,
    roulette: Option<f64>,
}

impl<'a> line::Walks for Walks<'a> {
    type Pack<S: Simd, C: BothWays<S> + Copy> = InRod<'a, S, C>;

    #[inline(always)]
    fn begin<S: Simd, C: BothWays<S> + Copy>(
        &self,
        course: C,
        from: f64x8<S>,
        _: &mut Numbers<S>,
    ) -> Self::Pack<S, C> {
        let Self { rod, rule, roulette } = *self;
        let (zero, one) = (from.each(0.0), from.each(1.0));
        let all = mask64x8::splat(from.token(), true);
        InRod {
            rod,
            rule,
            roulette,
            parts: Parts::of(rod),
            from,
            course,
            number: zero,
            t: from,
            inside: all,
            goes_on: all,
            is_forward: all,
            weight: one,
            order: zero,
            absorbed: zero,
            flux: [zero; MOST_PARTS],
        }
    }
}

/// Eight particles in a rod.
#[derive(Clone, Copy)]
struct InRod<'a, S: Simd, C> {
    rod: &'a Rod,
    rule: ParticleRule,
    /// w₀, the weight below which roulette is played.
    roulette: Option<f64>,
    parts: Parts,
    from: f64x8<S>,
    course: C,
    number: f64x8<S>,
    t: f64x8<S>,
    inside: mask64x8<S>,
    goes_on: mask64x8<S>,
    is_forward: mask64x8<S>,
    weight: f64x8<S>,
    order: f64x8<S>,
    absorbed: f64x8<S>,
    flux: [f64x8<S>; MOST_PARTS],
}

impl<S: Simd, C: BothWays<S>> Particles<S> for InRod<'_, S, C> {
    type Found = f64x8<S>;

    #[inline(always)]
    fn fly(&mut self, numbers: &mut Numbers<S>) -> f64x8<S> {
        let depth = -numbers.ln_uniform();
        self.number = numbers.uniform();
        self.inside = self.course.fly_either_way(depth, self.is_forward);
        // Beyond both ends there is no field to look at.
        self.t = Lane::select(self.inside, self.course.reached(), self.from);
        self.t
    }

    #[inline(always)]
    fn collide(&mut self, &extinction: &f64x8<S>, numbers: &mut Numbers<S>) -> u64 {
        let Self { rod, rule, number, t, inside, weight, .. } = *self;
        let one = t.each(1.0);
        let path = self.course.mean_free_path();
        let ratio = extinction * path;
        let albedo = rod.albedo.value(t);
        let taken = weight * ratio * (one - albedo);
        self.absorbed = Lane::select(inside, self.absorbed + taken, self.absorbed);
        self.parts.score(t, inside, weight, path, &mut self.flux);
        let odds = rule.odds(ratio, albedo);
        let is_scattered = inside & number.below(odds.scatter);
        let is_passed = inside & !is_scattered & number.below(odds.scatter + odds.transmit);
        let mut goes_on = is_scattered | is_passed;
        let factor = Lane::select(is_scattered, odds.scatter_weight, odds.transmit_weight);
        let mut left = weight * factor;
        let direction = numbers.uniform_where(is_scattered);
        let turns = is_scattered & !direction.below(rod.forward.value(t));
        self.is_forward ^= turns;
        self.order = Lane::select(is_scattered, self.order + 1.0, self.order);
        if let Some(below) = self.roulette {
            let least = one.each(below);
            let plays = goes_on & left.size().below(least);
            let drawn = numbers.uniform_where(plays);
            goes_on &= !plays | (drawn * least).below(left.size());
            let kept = Lane::select(left.below(one.each(0.0)), -least, least);
            left = Lane::select(plays, kept, left);
        }
        self.weight = Lane::select(goes_on, left, weight);
        self.goes_on = goes_on;
        (!goes_on).to_bitmask()
    }

    #[inline(always)]
    fn collect(&self, ended: u64, slots: &mut Slots, buffer: &mut DrawBuffer) -> u64 {
        let (inside, is_forward) = (self.inside.to_bitmask(), self.is_forward.to_bitmask());
        let mut ends = Ends { inside, is_forward, ..Ends::NONE };
        self.weight.store_slice(&mut ends.weight);
        self.order.store_slice(&mut ends.order);
        self.absorbed.store_slice(&mut ends.absorbed);
        for (part, end) in ends.flux.iter_mut().enumerate() {
            self.flux[part].store_slice(end);
        }
        ends.collect(slots, ended, self.rod, buffer)
    }

    #[inline(always)]
    fn restart(&mut self, _: &mut Numbers<S>) {
        let goes_on = self.goes_on;
        let (zero, one) = (self.from.each(0.0), self.from.each(1.0));
        self.is_forward |= !goes_on;
        self.weight = Lane::select(goes_on, self.weight, one);
        self.order = Lane::select(goes_on, self.order, zero);
        self.absorbed = Lane::select(goes_on, self.absorbed, zero);
        for flux in &mut self.flux {
            *flux = Lane::select(goes_on, *flux, zero);
        }
        self.course.restart(!goes_on);
    }
}

/// The parts of a rod that see its flux.
#[derive(Clone, Copy)]
struct Parts {
    count: usize,
    begin: f64,
    width: f64,
}

impl Parts {
    #[inline(always)]
    fn of(rod: &Rod) -> Self {
        Self { count: rod.parts, begin: rod.begin(), width: rod.width() }
    }

    /// Scores where the walks are, as [`Rod::part`] finds them.
    #[inline(always)]
    fn score<L: Lane>(
        &self,
        t: L,
        inside: L::Mask,
        weight: L,
        path: L,
        flux: &mut [L; MOST_PARTS],
    ) {
        if self.count == 0 {
            return;
        }
        let at = (t - self.begin) / t.each(self.width);
        let score = weight * (path * (1.0 / self.width));
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
    const NONE: Self = Self {
        inside: 0,
        is_forward: 0,
        weight: [0.0; WIDTH],
        order: [0.0; WIDTH],
        absorbed: [0.0; WIDTH],
        flux: [[0.0; WIDTH]; MOST_PARTS],
    };

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
    fn collect(&self, slots: &mut Slots, ended: u64, rod: &Rod, buffer: &mut DrawBuffer) -> u64 {
        slots.fill(ended, |Slot { lane, draw, steps }| {
            let values = self.fate(lane).values(&rod.channels);
            for (number, channel) in buffer.values.iter_mut().enumerate() {
                channel[draw] = values.at[number];
            }
            buffer.defects[draw] = 0.0;
            // The step that leaves looks at nothing.
            buffer.lookups[draw] = steps + (self.inside >> lane & 1) as u32;
        })
    }
}
