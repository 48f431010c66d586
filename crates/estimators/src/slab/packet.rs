//! Particles in a slab side by side: the packet kernel of [`super::walk`], for the rules of [`ParticleRule`].
//!
//! Specification: draw j is, bit for bit, the draw that [`super::walk::draw`] makes from stream
//! j mod 16.
//!
//! A step has no branches: who is scattered or ends is a mask. The numbers of a new direction are drawn
//! for all; the streams of those that are not scattered stay where they were.

use std::f64::consts::TAU;

use fearless_simd::{ExtractToken, Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::walk::turned;
use crate::kernels::packet::bank::{Numbers, Particles, Slot, Slots};
use crate::kernels::packet::{Request, line};
use crate::{DrawBuffer, Setup};
use media::Lookups;
use media::course::BothWays;
use media::phase::Phase;
use media::phase::isotropic::Isotropic;
use numeric::Lane;
use numeric::pack::WIDTH;
use theory::ParticleRule;
use theory::problems::Slab;
use theory::problems::slab::Light;

/// The draws of a rule, on the hardware of a level; a request is handed back where the hardware is too
/// narrow or one draw after the other is faster.
pub fn walks<'a>(
    level: Level,
    setup: &Setup<Slab>,
    rule: ParticleRule,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let walks = Walks { slab: &setup.problem, rule };
    line::walks(level, &walks, &setup.sampling, medium, request)
}

struct Walks<'a> {
    slab: &'a Slab,
    rule: ParticleRule,
}

impl<'a> line::Walks for Walks<'a> {
    type Pack<S: Simd, C: BothWays<S> + Copy> = InSlab<'a, S, C>;

    #[inline(always)]
    fn begin<S: Simd, C: BothWays<S> + Copy>(
        &self,
        course: C,
        from: f64x8<S>,
        numbers: &mut Numbers<S>,
    ) -> Self::Pack<S, C> {
        let all = mask64x8::splat(from.token(), true);
        let one = from.each(1.0);
        InSlab {
            slab: self.slab,
            rule: self.rule,
            from,
            course,
            number: from,
            inside: all,
            is_down: all,
            goes_on: all,
            weight: one,
            cosine: entering(self.slab.incidence.light, numbers, all, one),
        }
    }
}

/// The cosines with which particles enter; those that a mask names take a number for it where light is
/// diffuse.
#[inline(always)]
pub fn entering<S: Simd>(
    light: Light,
    numbers: &mut Numbers<S>,
    which: mask64x8<S>,
    one: f64x8<S>,
) -> f64x8<S> {
    match light {
        Light::Collimated(cosine) => one.each(cosine),
        Light::Diffuse => (one - numbers.uniform_where(which)).root(),
    }
}

/// Eight particles in a slab.
struct InSlab<'a, S: Simd, C> {
    slab: &'a Slab,
    rule: ParticleRule,
    from: f64x8<S>,
    course: C,
    number: f64x8<S>,
    inside: mask64x8<S>,
    is_down: mask64x8<S>,
    goes_on: mask64x8<S>,
    weight: f64x8<S>,
    cosine: f64x8<S>,
}

impl<S: Simd, C: BothWays<S>> Particles<S> for InSlab<'_, S, C> {
    type Found = f64x8<S>;

    #[inline(always)]
    fn fly(&mut self, numbers: &mut Numbers<S>) -> f64x8<S> {
        let length = -numbers.ln_uniform();
        self.number = numbers.uniform();
        self.is_down = length.each(0.0).below(self.cosine);
        self.inside = self.course.fly_either_way(length * self.cosine.size(), self.is_down);
        // Above and below there is no field to look at.
        Lane::select(self.inside, self.course.reached(), self.from)
    }

    #[inline(always)]
    fn collide(&mut self, &extinction: &f64x8<S>, numbers: &mut Numbers<S>) -> u64 {
        let Self { number, inside, cosine, .. } = *self;
        let incidence = &self.slab.incidence;
        let albedo = extinction.each(self.slab.albedo);
        let odds = self.rule.odds(extinction * self.course.mean_free_path(), albedo);
        let is_scattered = inside & number.below(odds.scatter);
        let is_passed = inside & !is_scattered & number.below(odds.scatter + odds.transmit);
        let deflection = incidence.phase.cosine(numbers.uniform_where(is_scattered));
        let direction = if incidence.phase == Phase::Isotropic(Isotropic) {
            deflection
        } else {
            let azimuth = (numbers.uniform_where(is_scattered) * TAU).cos();
            turned(cosine, deflection, azimuth)
        };
        self.cosine = Lane::select(is_scattered, direction, cosine);
        self.goes_on = is_scattered | is_passed;
        let factor = Lane::select(is_scattered, odds.scatter_weight, odds.transmit_weight);
        self.weight = Lane::select(self.goes_on, self.weight * factor, self.weight);
        (!self.goes_on).to_bitmask()
    }

    #[inline(always)]
    fn collect(&self, ended: u64, slots: &mut Slots, buffer: &mut DrawBuffer) -> u64 {
        let mut ends = Ends { inside: self.inside.to_bitmask(), values: [[0.0; WIDTH]; 2] };
        let zero = self.from.each(0.0);
        let left = Lane::select(self.inside, zero, self.weight);
        Lane::select(self.is_down, zero, left).store_slice(&mut ends.values[0]);
        Lane::select(self.is_down, left, zero).store_slice(&mut ends.values[1]);
        ends.collect(slots, ended, buffer)
    }

    #[inline(always)]
    fn restart(&mut self, numbers: &mut Numbers<S>) {
        let (goes_on, one) = (self.goes_on, self.from.each(1.0));
        let fresh = entering(self.slab.incidence.light, numbers, !goes_on, one);
        self.cosine = Lane::select(goes_on, self.cosine, fresh);
        self.weight = Lane::select(goes_on, self.weight, one);
        self.course.restart(!goes_on);
    }
}

/// What eight walks have come to.
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
    fn collect(&self, slots: &mut Slots, ended: u64, buffer: &mut DrawBuffer) -> u64 {
        slots.fill(ended, |Slot { lane, draw, steps }| {
            for (number, channel) in buffer.values.iter_mut().enumerate() {
                channel[draw] = self.values[number][lane];
            }
            buffer.defects[draw] = 0.0;
            // The step that leaves looks at nothing.
            buffer.lookups[draw] = steps + (self.inside >> lane & 1) as u32;
        })
    }
}
