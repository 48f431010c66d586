//! Walks to the light behind a slab side by side: the packet kernel of [`super::walk`].
//!
//! Specification: draw j is, bit for bit, the draw that [`super::walk::draw`] makes from stream j mod 16.
//!
//! A lane flies as a camera ray, as a shadow ray or to a hit, and in every step all three take the same random numbers.
//! Where it is scattered its place and its next direction are kept until its shadow ray has ended.

use fearless_simd::{ExtractToken, Simd, SimdMask, f64x8, mask64x8};

use crate::kernels::packet::bank::{Numbers, Particles, Slots};
use crate::kernels::packet::line;
use crate::lit_rod::packet::Walks;
use crate::space::packet::collect;
use crate::{DrawBuffer, Setup};
use media::course::BothWays;
use numeric::Lane;
use theory::ParticleRule;
use theory::lit_rod::{Shadow, Techniques};
use theory::problems::LitSlab;

impl<'a> line::Walks for Walks<'a, LitSlab> {
    type Pack<S: Simd, C: BothWays<S> + Copy> = InLitSlab<'a, S, C>;

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
        InLitSlab {
            setup,
            techniques,
            from,
            course,
            vertex: course,
            number: zero,
            t: from,
            inside: all,
            casts: !all,
            seeks: !all,
            meets: !all,
            goes_on: all,
            cosine: one,
            drawn: one,
            ratio: zero,
            density: zero,
            found: one,
            score: zero,
            lookups: zero,
        }
    }
}

/// Eight walks.
#[derive(Clone, Copy)]
pub(crate) struct InLitSlab<'a, S: Simd, C> {
    setup: &'a Setup<LitSlab>,
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
    /// Which fly to a hit.
    seeks: mask64x8<S>,
    /// Whose drawn direction meets the light.
    meets: mask64x8<S>,
    goes_on: mask64x8<S>,
    /// That of the flight.
    cosine: f64x8<S>,
    /// That of the direction that was drawn.
    drawn: f64x8<S>,
    /// ρ of the hit.
    ratio: f64x8<S>,
    /// q of the shadow ray.
    density: f64x8<S>,
    /// The transmittance of the shadow ray so far.
    found: f64x8<S>,
    score: f64x8<S>,
    lookups: f64x8<S>,
}

impl<S: Simd, C: BothWays<S>> InLitSlab<'_, S, C> {
    /// Those that are scattered here choose a direction to the light, and draw one.
    #[inline(always)]
    fn scatter(&mut self, which: mask64x8<S>, numbers: &mut Numbers<S>) {
        let Self { setup, techniques, t, .. } = *self;
        let LitSlab { phase, light, .. } = &*setup.problem;
        let before = t.each(setup.problem.end()) - t;
        let is_exact = techniques.shadow == Some(Shadow::Exact);
        let mut chosen = t.each(1.0);
        if techniques.shadow.is_some() {
            let number =
                if light.can_be_hit() { numbers.uniform_where(which) } else { t.each(0.0) };
            let [cosine, spread] = light.chosen(number, before);
            let density = phase.value(cosine) * spread;
            chosen = cosine;
            self.density = Lane::select(which, density, self.density);
            self.found = Lane::select(which, t.each(1.0), self.found);
            if is_exact {
                let found = Walks::transmittances(setup, [t, chosen], which);
                let scored = self.score + techniques.of_shadow_ray(density, found);
                self.score = Lane::select(which, scored, self.score);
            }
        }
        if techniques.has_hits() {
            let drawn = phase.cosine(numbers.uniform_where(which));
            let meets = which & light.is_met(drawn, before);
            if techniques.shadow.is_some() && meets.any_true() {
                let density = phase.value(drawn) * light.spread(drawn, before);
                let found = if is_exact {
                    Walks::transmittances(setup, [t, drawn], meets)
                } else {
                    t.each(0.0)
                };
                self.ratio = Lane::select(meets, techniques.ratio(density, found), self.ratio);
            }
            self.drawn = Lane::select(which, drawn, self.drawn);
            self.meets = (self.meets & !which) | meets;
        }
        if techniques.shadow.is_none() || is_exact {
            self.seeks |= which & self.meets;
            self.cosine = Lane::select(which, self.drawn, self.cosine);
        } else {
            self.vertex.stand_as(which, &self.course);
            self.casts |= which;
            self.cosine = Lane::select(which, chosen, self.cosine);
        }
    }

    /// What becomes of tracked shadow rays here.
    #[inline(always)]
    fn shadow_rays(&mut self, real: f64x8<S>) {
        let Self { techniques, number, inside, casts, .. } = *self;
        let mut ends = casts & !inside;
        if ends.any_true() {
            let scored = self.score + techniques.of_shadow_ray(self.density, self.found);
            self.score = Lane::select(ends, scored, self.score);
        }
        if techniques.shadow == Some(Shadow::Delta) {
            ends |= casts & inside & number.below(real);
        } else {
            let found = self.found * (real.each(1.0) - real);
            self.found = Lane::select(casts & inside, found, self.found);
        }
        self.course.stand_as(ends, &self.vertex);
        self.casts = casts & !ends;
        self.seeks |= ends & self.meets;
        self.cosine = Lane::select(ends, self.drawn, self.cosine);
    }
}

impl<S: Simd, C: BothWays<S>> Particles<S> for InLitSlab<'_, S, C> {
    type Found = f64x8<S>;

    #[inline(always)]
    fn fly(&mut self, numbers: &mut Numbers<S>) -> f64x8<S> {
        let depth = -numbers.ln_uniform();
        self.number = numbers.uniform();
        self.inside = self.course.fly(depth * self.cosine);
        // Behind the slab there is no field to look at.
        self.t = Lane::select(self.inside, self.course.reached(), self.from);
        self.t
    }

    #[inline(always)]
    fn collide(&mut self, &extinction: &f64x8<S>, numbers: &mut Numbers<S>) -> u64 {
        let Self { techniques, number, t, inside, casts, seeks, .. } = *self;
        let one = t.each(1.0);
        self.lookups = Lane::select(inside, self.lookups + 1.0, self.lookups);
        let real = extinction * self.course.mean_free_path();
        let odds = ParticleRule::Analog.odds(real, t.each(self.setup.problem.albedo));
        let collides = inside & !casts & !seeks;
        let is_scattered = collides & number.below(odds.scatter);
        let is_null = collides & !is_scattered & number.below(odds.scatter + odds.transmit);
        let hits = seeks & !inside;
        if hits.any_true() {
            let scored = self.score + techniques.of_hit(self.ratio);
            self.score = Lane::select(hits, scored, self.score);
        }
        self.seeks = seeks & inside & !number.below(real);
        if techniques.has_nulls() {
            self.ratio = Lane::select(self.seeks, self.ratio * (one - real), self.ratio);
        }
        if casts.any_true() {
            self.shadow_rays(real);
        }
        if is_scattered.any_true() {
            self.scatter(is_scattered, numbers);
        }
        self.goes_on = is_null | self.casts | self.seeks;
        (!self.goes_on).to_bitmask()
    }

    #[inline(always)]
    fn collect(&self, ended: u64, slots: &mut Slots, buffer: &mut DrawBuffer) -> u64 {
        collect(&[self.score], &self.lookups, &[0], (ended, slots), buffer)
    }

    #[inline(always)]
    fn restart(&mut self, _: &mut Numbers<S>) {
        let goes_on = self.goes_on;
        let (zero, one) = (self.from.each(0.0), self.from.each(1.0));
        self.cosine = Lane::select(goes_on, self.cosine, one);
        self.score = Lane::select(goes_on, self.score, zero);
        self.lookups = Lane::select(goes_on, self.lookups, zero);
        self.course.restart(!goes_on);
    }
}
