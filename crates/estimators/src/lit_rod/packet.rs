//! Walks to an emitter side by side: the packet kernel of [`super::walk`].
//!
//! Specification: draw j is, bit for bit, the draw that [`super::walk::draw`] makes from stream j mod 16.
//!
//! A lane flies as a walk or as a shadow ray, and in every step both take the same random numbers. Where a walk is
//! scattered its place is kept; its shadow ray flies on from there, and when it has ended the walk does.

use fearless_simd::{ExtractToken, Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::walk::log_transmittance;
use crate::kernels::packet::bank::{Numbers, Particles, Slots};
use crate::kernels::packet::{Request, line};
use crate::space::packet::collect;
use crate::{DrawBuffer, Setup};
use media::Lookups;
use media::course::BothWays;
use numeric::Lane;
use numeric::pack::WIDTH;
use theory::ParticleRule;
use theory::lit_rod::{Shadow, Techniques};
use theory::problems::{LitRod, Problem};

/// The draws of techniques on the hardware of a level; a request is handed back where the hardware is too narrow
/// or one draw after the other is faster.
pub(crate) fn walks<'a, P: Problem>(
    level: Level,
    setup: &Setup<P>,
    techniques: Techniques,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>>
where
    for<'s> Walks<'s, P>: line::Walks,
{
    // Lanes that turn from walks to shadow rays and back take other pieces of σ̂ to hand each time.
    if setup.sampling.even().is_none() && !medium.is_costly() {
        return Some(request);
    }
    line::walks(level, &Walks { setup, techniques }, &setup.sampling, medium, request)
}

/// Walks of a problem by techniques.
pub(crate) struct Walks<'a, P: Problem> {
    /// Where they walk.
    pub setup: &'a Setup<P>,
    /// What finds the light.
    pub techniques: Techniques,
}

impl<P: Problem> Walks<'_, P> {
    /// The exact transmittances from where some are to the end, along directions of these cosines; those of the
    /// others mean nothing.
    #[inline(always)]
    pub fn transmittances<S: Simd>(
        setup: &Setup<P>,
        [t, cosines]: [f64x8<S>; 2],
        which: mask64x8<S>,
    ) -> f64x8<S> {
        let (mut row, mut along) = ([0.0; WIDTH], [0.0; WIDTH]);
        let bits = which.to_bitmask();
        if bits == 0 {
            return t.each(0.0);
        }
        t.store_slice(&mut row);
        cosines.store_slice(&mut along);
        for (lane, t) in row.iter_mut().enumerate() {
            let is_asked = bits >> lane & 1 == 1;
            *t = if is_asked { log_transmittance(setup, *t, along[lane]) } else { 0.0 };
        }
        f64x8::from_slice(t.token(), &row).exp()
    }
}

impl<'a> line::Walks for Walks<'a, LitRod> {
    type Pack<S: Simd, C: BothWays<S> + Copy> = InLitRod<'a, S, C>;

    #[inline(always)]
    fn begin<S: Simd, C: BothWays<S> + Copy>(
        &self,
        course: C,
        from: f64x8<S>,
        _: &mut Numbers<S>,
    ) -> Self::Pack<S, C> {
        let Self { setup, techniques } = *self;
        let (zero, one) = (from.each(0.0), from.each(1.0));
        let all = mask64x8::splat(from.token(), true);
        InLitRod {
            setup,
            techniques,
            from,
            course,
            vertex: course,
            number: zero,
            t: from,
            inside: all,
            casts: !all,
            goes_on: all,
            is_forward: all,
            unscattered: all,
            ratio: one,
            phase: zero,
            found: one,
            score: zero,
            lookups: zero,
        }
    }
}

/// Eight walks.
#[derive(Clone, Copy)]
pub(crate) struct InLitRod<'a, S: Simd, C> {
    setup: &'a Setup<LitRod>,
    techniques: Techniques,
    from: f64x8<S>,
    course: C,
    /// Where those that cast were scattered.
    vertex: C,
    number: f64x8<S>,
    t: f64x8<S>,
    inside: mask64x8<S>,
    /// Which fly as shadow rays.
    casts: mask64x8<S>,
    goes_on: mask64x8<S>,
    /// The direction of the walk; a shadow ray flies forward.
    is_forward: mask64x8<S>,
    unscattered: mask64x8<S>,
    /// ρ.
    ratio: f64x8<S>,
    /// p(ω) towards the emitter at the last scattering.
    phase: f64x8<S>,
    /// The transmittance of the shadow ray so far.
    found: f64x8<S>,
    score: f64x8<S>,
    lookups: f64x8<S>,
}

impl<S: Simd, C: BothWays<S>> InLitRod<'_, S, C> {
    /// What shadow rays find, those on their way and those of walks that are scattered here.
    #[inline(always)]
    fn shadow_rays(&mut self, is_scattered: mask64x8<S>, phase: f64x8<S>, real: f64x8<S>) {
        let Self { techniques, number, inside, casts, .. } = *self;
        let mut exact = phase.each(0.0);
        match techniques.shadow {
            None => {}
            Some(Shadow::Exact) => {
                exact = Walks::transmittances(self.setup, [self.t, exact.each(1.0)], is_scattered);
                let scored = self.score + techniques.of_shadow_ray(phase, exact);
                self.score = Lane::select(is_scattered, scored, self.score);
            }
            Some(shadow) => {
                let mut ends = casts & !inside;
                let scored = self.score + techniques.of_shadow_ray(self.phase, self.found);
                self.score = Lane::select(ends, scored, self.score);
                if shadow == Shadow::Delta {
                    ends |= casts & inside & number.below(real);
                } else {
                    let found = self.found * (real.each(1.0) - real);
                    self.found = Lane::select(casts & inside, found, self.found);
                }
                self.course.stand_as(ends, &self.vertex);
                self.vertex.stand_as(is_scattered, &self.course);
                self.casts = (casts & !ends) | is_scattered;
                self.phase = Lane::select(is_scattered, phase, self.phase);
                self.found = Lane::select(is_scattered, phase.each(1.0), self.found);
            }
        }
        let ratio = techniques.ratio(phase, exact);
        self.ratio = Lane::select(is_scattered, ratio, self.ratio);
    }
}

impl<S: Simd, C: BothWays<S>> Particles<S> for InLitRod<'_, S, C> {
    type Found = f64x8<S>;

    #[inline(always)]
    fn fly(&mut self, numbers: &mut Numbers<S>) -> f64x8<S> {
        let depth = -numbers.ln_uniform();
        self.number = numbers.uniform();
        self.inside = self.course.fly_either_way(depth, self.is_forward | self.casts);
        // Beyond both ends there is no field to look at.
        self.t = Lane::select(self.inside, self.course.reached(), self.from);
        self.t
    }

    #[inline(always)]
    fn collide(&mut self, &extinction: &f64x8<S>, numbers: &mut Numbers<S>) -> u64 {
        let Self { techniques, number, t, inside, casts, .. } = *self;
        let rod = &self.setup.problem.rod;
        let one = t.each(1.0);
        self.lookups = Lane::select(inside, self.lookups + 1.0, self.lookups);
        let real = extinction * self.course.mean_free_path();
        let odds = ParticleRule::Analog.odds(real, rod.albedo.value(t));
        let collides = inside & !casts;
        let is_scattered = collides & number.below(odds.scatter);
        let is_null = collides & !is_scattered & number.below(odds.scatter + odds.transmit);
        let hits = self.is_forward & !inside & !casts;
        let weight = Lane::select(self.unscattered, one, techniques.of_hit(self.ratio));
        self.score = Lane::select(hits, self.score + weight, self.score);
        if techniques.has_nulls() {
            self.ratio = Lane::select(is_null, self.ratio * (one - real), self.ratio);
        }
        let direction = numbers.uniform_where(is_scattered);
        let forward = rod.forward.value(t);
        let phase = Lane::select(self.is_forward, forward, one - forward);
        self.shadow_rays(is_scattered, phase, real);
        self.is_forward ^= is_scattered & !direction.below(forward);
        self.unscattered &= !is_scattered;
        self.goes_on = casts | is_scattered | is_null;
        (!self.goes_on).to_bitmask()
    }

    #[inline(always)]
    fn collect(&self, ended: u64, slots: &mut Slots, buffer: &mut DrawBuffer) -> u64 {
        collect(&[self.score], &self.lookups, &[0], (ended, slots), buffer)
    }

    #[inline(always)]
    fn restart(&mut self, _: &mut Numbers<S>) {
        let goes_on = self.goes_on;
        let zero = self.from.each(0.0);
        self.is_forward |= !goes_on;
        self.unscattered |= !goes_on;
        self.score = Lane::select(goes_on, self.score, zero);
        self.lookups = Lane::select(goes_on, self.lookups, zero);
        self.course.restart(!goes_on);
    }
}
